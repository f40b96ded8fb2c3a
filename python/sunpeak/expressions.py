"""The expression language of Radiance's `.cal` files."""

from collections.abc import Sequence

import numpy as np
import numpy.typing as npt

from sunpeak import _core


def evaluate(
    expressions: Sequence[str],
    channels: npt.ArrayLike,
    *,
    definitions: str = "",
    arguments: Sequence[float] = (),
) -> npt.NDArray[np.float64]:
    """Evaluate expressions for rows of numbers, as `rcalc` does.

    Args:
        expressions: m expressions; `$1`, `$2`, … are the columns of `channels`.
        channels: (n, k) numbers.
        definitions: The text of `.cal` files.
        arguments: What `A1`, `A2`, … and `arg(n)` mean.

    Returns:
        (n, m) values; not a number where a function is out of its domain or something is divided by zero.

    Raises:
        InputError: The text is not in the language, a name is not defined, or a recursion does not end.

    """
    rows = np.ascontiguousarray(np.atleast_2d(np.asarray(channels, dtype=np.float64)))
    return _core.evaluate(definitions, list(expressions), rows, [float(a) for a in arguments])
