"""`getinfo`: headers of files, read and changed."""

import re
import subprocess
import sys
from collections.abc import Callable, Iterable
from pathlib import Path
from typing import BinaryIO

from sunpeak._core import InputError
from sunpeak.compat import header

CHUNK = 1 << 20
CUBE_MARGIN = 1e-5
"""What `oconv` leaves around the geometry [m]."""


def run(arguments: list[str]) -> int:
    """Do what the first option says."""
    match arguments:
        case ["-a", *added]:
            return edit(lambda lines: [*lines, *added])
        case ["-r", *replaced]:
            return edit(lambda lines: replace(lines, replaced))
        case ["-c", *command] if command:
            return through_command(command)
        case ["-d", *names]:
            return each(names, show_dimensions)
        case ["-"]:
            header.read(sys.stdin.buffer, "standard input")
            copy_body()
            return 0
        case [option, *_] if option.startswith("-"):
            raise InputError(
                f"unknown option '{option}': expected -d files, -a lines, -r VARIABLE=value, -c command, -, files"
            )
    return each(arguments, show_header)


def each(names: list[str], show: Callable[[BinaryIO, str], None]) -> int:
    """Show files one by one; those that cannot be read are said and passed over, and are no failure, as in Radiance."""
    for name in names or [""]:
        try:
            if name:
                with Path(name).open("rb") as file:
                    sys.stdout.write(f"{name}:{' ' if show is show_dimensions else chr(10)}")
                    show(file, name)
            else:
                show(sys.stdin.buffer, "standard input")
        except OSError as error:
            sys.stderr.write(f"{name}: cannot open: {error.strerror}\n")
        except InputError as error:
            sys.stderr.write(f"{error}\n")
    return 0


def show_header(file: BinaryIO, name: str) -> None:
    """Print a header."""
    lines = header.read(file, name)
    indent = "" if file is sys.stdin.buffer else "\t"
    sys.stdout.writelines(f"{indent}{line}\n" for line in [*lines, ""])


def show_dimensions(file: BinaryIO, name: str) -> None:
    """Print the resolution of a picture, the rows and columns that a header states, or the cube of an octree."""
    lines = header.read(file, name)
    form = header.value(lines, "FORMAT") or ""
    if form.endswith("_octree"):
        show_cube(header_bytes(lines) + file.read(), name)
        return
    if form.startswith("32-bit_rle_"):
        sys.stdout.write(f"{file.readline(256).decode('ascii', 'replace').strip()}\n")
        return
    counts = [header.value(lines, key) for key in ("NROWS", "NCOLS", "NCOMP")]
    if counts[0] is None or counts[1] is None:
        raise InputError(f"{name}: neither a picture nor a matrix: no dimensions")
    sys.stdout.write(f"{counts[0]} rows by {counts[1]} columns of {counts[2] or 1} components\n")


def header_bytes(lines: list[str]) -> bytes:
    """Give the lines of a header as they stand in a file."""
    return "\n".join([*lines, "", ""]).encode()


def show_cube(data: bytes, name: str) -> None:
    """Print the lowest corner and the edge of the cube around an octree's scene."""
    from sunpeak.compat import octree  # noqa: PLC0415 (nothing else here needs the compiled core)

    bounds = octree.decode(data, name).scene().bounds()
    if bounds is None:
        raise InputError(f"{name}: an octree without surfaces: no dimensions")
    lows, highs = [low - CUBE_MARGIN for low in bounds[0]], [high + CUBE_MARGIN for high in bounds[1]]
    spans = [high - low for low, high in zip(lows, highs, strict=True)]
    edge = max(spans)
    corner = [low - (edge - span) / 2 for low, span in zip(lows, spans, strict=True)]
    sys.stdout.write(f"{' '.join(f'{number:.12g}' for number in [*corner, edge])}\n")


def replace(lines: list[str], assignments: Iterable[str]) -> list[str]:
    """Give a header in which variables have other values; those that it has not are added."""
    changed = list(lines)
    for assignment in assignments:
        key, equals, _ = assignment.partition("=")
        if not equals or not re.fullmatch(r"\S+", key):
            raise InputError(f"-r {assignment!r}: expected VARIABLE=value")
        kept = [line for line in changed if not line.startswith(f"{key}=")]
        changed = [*kept, assignment]
    return changed


def edit(change: Callable[[list[str]], list[str]]) -> int:
    """Copy standard input to standard output with another header."""
    lines = header.read(sys.stdin.buffer, "standard input")
    is_format = [line.startswith("FORMAT=") for line in lines]
    formats = [line for line, there in zip(lines, is_format, strict=True) if there]
    others = [line for line, there in zip(lines, is_format, strict=True) if not there]
    # The format stays the last line, where readers look for it.
    new = [*change(others), *formats]
    header.write_stdout(header_bytes(new))
    copy_body()
    return 0


def through_command(command: list[str]) -> int:
    """Copy the header and let a program work on the body."""
    lines = header.read(sys.stdin.buffer, "standard input")
    header.write_stdout(header_bytes([*lines, header.command_line(command[0], command[1:])]))
    body = sys.stdin.buffer.read()
    return subprocess.run(command, input=body, check=False).returncode


def copy_body() -> None:
    """Copy the rest of standard input."""
    while chunk := sys.stdin.buffer.read(CHUNK):
        header.write_stdout(chunk)
