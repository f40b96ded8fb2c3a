"""The command line: `sunpeak COMMAND …`."""

import sys

__all__ = ["main"]


def main() -> None:
    """Run the command line. Radiance's programs start without the rest of it: scripts call them many times."""
    words = sys.argv[1:]
    if words[:1] == ["compat"] and len(words) > 1 and words[1] != "install" and not words[1].startswith("-"):
        from sunpeak.compat.programs import main as run  # noqa: PLC0415

        sys.exit(run(words[1:]))
    from sunpeak.cli.app import main as run_all  # noqa: PLC0415

    run_all()
