"""Files with a visible and a solar band, and the exact split beside them."""

from os import PathLike

from sunpeak import _core
from sunpeak.files import write_text
from sunpeak.scattering import Bsdf


def write_bands(
    visible: Bsdf, solar: Bsdf | None, path: str | PathLike[str], split: str | PathLike[str] | None = None
) -> None:
    """Write an LBNL XML file of one or both bands, whole or not at all; the visible one's split to a folder."""
    text = _core.bsdf_xml(visible._core) if solar is None else _core.two_band_xml(visible._core, solar._core)
    if split is not None:
        visible.save_split(split)
    write_text(path, text)
