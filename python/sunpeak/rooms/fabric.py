"""The fabric of the rooms: its through transmittance is a formula, so that what must come out is known."""

from pathlib import Path

from sunpeak.fabrics import Fabric

FABRIC = Fabric(openness=0.02, cut_off_deg=68.0, exponent=0.6, scattered=0.015, reflectance=0.1)
"""Two per cent open, of dark yarn: little light comes through but by the holes."""

BASES = ("klems", "t3-1024", "t3-4096", "t3-16384")
"""Klems' 145 patches, and isotropic tensor trees by their number of cells."""

LABELS = {
    "klems": "Klems 145 × 145",
    "t3-1024": "tensor tree, max. 1024 × 1024",
    "t3-4096": "tensor tree, max. 4096 × 4096",
    "t3-16384": "tensor tree, max. 16384 × 16384",
}
"""How people call the bases."""


def write_fabric(folder: Path, basis: str) -> Path:
    """Tabulate the fabric and write it as an LBNL XML file."""
    path = folder / f"fabric_{basis}.xml"
    FABRIC.write(path, basis)
    return path
