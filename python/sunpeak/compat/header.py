"""Information headers: lines of text, an empty one, then the body."""

import shlex
import sys
from collections.abc import Sequence
from datetime import UTC, datetime
from typing import BinaryIO

from sunpeak._core import InputError, __version__

MAGIC = "#?RADIANCE"
LONGEST = 1 << 22
"""Bytes in which a header must end; none is near it."""


def command_line(program: str, arguments: Sequence[str]) -> str:
    """Give the line that says how a file was made."""
    return " ".join([program, *(word if word and word.isprintable() and " " not in word else shlex.quote(word)
                                for word in arguments)])  # fmt: skip


def history(earlier: Sequence[str], program: str, arguments: Sequence[str]) -> list[str]:
    """Give the lines before the format: what came before, then this program."""
    now = datetime.now(UTC)
    local = now.astimezone()
    return [
        *earlier,
        command_line(program, arguments),
        f"SOFTWARE= Sunpeak {__version__}",
        f"CAPDATE= {local:%Y:%m:%d %H:%M:%S}",
        f"GMT= {now:%Y:%m:%d %H:%M:%S}",
    ]


def text(lines: Sequence[str]) -> bytes:
    """Give a whole header."""
    return "\n".join([MAGIC, *lines, "", ""]).encode()


def read(file: BinaryIO, name: str) -> list[str]:
    """Read the lines of a header, the first one included; the file stands at its body then."""
    lines: list[str] = []
    taken = 0
    while True:
        line = file.readline(LONGEST)
        taken += len(line)
        if not line.endswith(b"\n") or taken > LONGEST:
            raise InputError(f"{name}: bad header: expected lines of text and an empty one at their end")
        if line in (b"\n", b"\r\n"):
            return lines
        lines.append(line.rstrip(b"\r\n").decode("utf-8", "replace"))
        if len(lines) == 1 and not lines[0].startswith("#?"):
            raise InputError(f"{name}: bad header: expected {MAGIC} at its beginning")


def value(lines: Sequence[str], key: str) -> str | None:
    """Give the last value of `KEY=` in a header."""
    found = [line.split("=", 1)[1].strip() for line in lines if line.startswith(f"{key}=")]
    return found[-1] if found else None


def write_stdout(data: bytes) -> None:
    """Write bytes to standard output."""
    sys.stdout.flush()
    sys.stdout.buffer.write(data)
    sys.stdout.buffer.flush()
