"""Bases of tables by their names."""

from sunpeak._core import InputError

RESOLUTIONS = (8, 16, 32, 64, 128)
"""Cells a side that a tensor tree may have."""


def basis_name(basis: str, resolution: int | None = None) -> str:
    """`t4` with 64 cells a side as `t4-4096`; other names as they are."""
    if basis not in ("t3", "t4"):
        if resolution is not None:
            raise InputError(f"resolution {resolution} with basis {basis!r}; expected it with t3 or t4 alone")
        return basis
    if resolution not in RESOLUTIONS:
        found = "none" if resolution is None else str(resolution)
        raise InputError(f"resolution of {basis}: {found}; expected cells a side: 8, 16, 32, 64 or 128")
    return f"{basis}-{resolution**2}"
