"""Numbers on standard input and output: text (`a`), floats (`f`), doubles (`d`), Radiance's colours (`c`)."""

import sys
from typing import Any

import numpy as np
import numpy.typing as npt

from sunpeak._core import InputError

Floats = npt.NDArray[np.float64]
BINARY: dict[str, np.dtype[Any]] = {"f": np.dtype(np.float32), "d": np.dtype(np.float64)}
FORMAT_NAMES = {"a": "ascii", "f": "float", "d": "double", "c": "32-bit_rle_rgbe"}
"""After `FORMAT=` in a header."""


def read_stdin(form: str, columns: int) -> Floats:
    """Read all rows (n, columns) of standard input; a last row that is not whole is left out, as in Radiance."""
    data = sys.stdin.buffer.read()
    if form == "a":
        try:
            values = np.array(data.split(), dtype=np.float64)
        except ValueError:
            raise first_wrong_word(data) from None
    else:
        kind = BINARY[form]
        values = np.frombuffer(data[: len(data) // kind.itemsize * kind.itemsize], dtype=kind).astype(np.float64)
    whole = len(values) // columns * columns
    return values[:whole].reshape(-1, columns)


def first_wrong_word(data: bytes) -> InputError:
    """Say which word of a text is no number."""
    for number, line in enumerate(data.splitlines(), start=1):
        for word in line.split():
            try:
                float(word)
            except ValueError:
                return InputError(
                    f"standard input:{number}: expected a number, found {word.decode('utf-8', 'replace')!r}"
                )
    return InputError("standard input: expected numbers")


def encode(rows: Floats, form: str) -> bytes:
    """Rows of numbers as bytes."""
    if form == "a":
        return text(rows, "%.6e\t").encode()
    if form == "c":
        return rgbe(rows)
    return rows.astype(BINARY[form]).tobytes()


def text(rows: Floats, number: str) -> str:
    """Rows as lines of text, each number as a `%` format says."""
    line = number * rows.shape[1] + "\n"
    lines: str = (line * len(rows)) % tuple(rows.ravel().tolist())
    return lines


def rgbe(colours: Floats) -> bytes:
    """Three channels as Radiance's four bytes: mantissas and one exponent."""
    largest = colours.max(axis=1, initial=0.0)
    is_dark = largest <= 1e-32
    fraction, exponent = np.frexp(np.where(is_dark, 1.0, largest))
    mantissas = np.clip(colours, 0.0, None) * (fraction * 256.0 / np.where(is_dark, 1.0, largest))[:, None]
    pixels = np.empty((len(colours), 4), dtype=np.uint8)
    pixels[:, :3] = np.clip(mantissas, 0, 255).astype(np.uint8)
    pixels[:, 3] = np.clip(exponent + 128, 0, 255).astype(np.uint8)
    pixels[is_dark] = 0
    return pixels.tobytes()
