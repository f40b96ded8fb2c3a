"""A group whose first command need not be named: `sunpeak glare out.hdr` beside `sunpeak glare compare a.hdr b.hdr`."""

from typing import Any

from typer.core import TyperGroup

DEFAULT = "picture"
"""Name of the command that runs where none is named."""


class DefaultCommandGroup(TyperGroup):
    """Put the default command in front of arguments that do not begin with a command."""

    def parse_args(self, ctx: Any, args: list[str]) -> list[str]:
        """Take the arguments apart."""
        named = bool(args) and args[0] in self.commands
        return super().parse_args(ctx, args if named else [DEFAULT, *args])
