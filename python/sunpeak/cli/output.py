"""What commands write: results on standard output or whole files, the rest on standard error."""

import json
import sys
from pathlib import Path
from typing import Any

from sunpeak.files import write_text


def emit(text: str, output: Path | None = None) -> None:
    """Write a result to a file, or to standard output where none is named."""
    if output is None:
        sys.stdout.write(text)
    else:
        write_text(output, text)


def emit_json(value: Any) -> None:
    """Write one JSON value to standard output."""
    sys.stdout.write(json.dumps(value, indent=2, ensure_ascii=False) + "\n")


def note(text: str, quiet: bool = False) -> None:
    """Say something beside the result, on standard error."""
    if not quiet:
        sys.stderr.write(text + "\n")
