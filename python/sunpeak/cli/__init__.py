"""The command line: `sunpeak COMMAND …`."""

from sunpeak.cli.app import main

__all__ = ["main"]
