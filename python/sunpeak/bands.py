"""Files with a visible and a solar band, and the exact split beside them."""

from os import PathLike
from typing import NamedTuple

from sunpeak.scattering import Bsdf


class Label(NamedTuple):
    """What a file says of its product, where it is not to say what its maker here says of itself."""

    name: str | None = None
    manufacturer: str | None = None
    thickness_m: float | None = None


UNLABELLED = Label()
"""Nothing is said otherwise."""


def write_bands(
    visible: Bsdf,
    solar: Bsdf | None,
    path: str | PathLike[str],
    split: str | PathLike[str] | None = None,
    *,
    comments: str | None = None,
    label: Label = UNLABELLED,
) -> None:
    """Write an LBNL XML file of one or both bands, whole or not at all; the visible one's split to a folder."""
    if split is not None:
        visible.save_split(split)
    visible.save(path, solar=solar, comments=comments, **label._asdict())
