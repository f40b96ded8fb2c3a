"""Panes of glass: from IGSDB, from files of LBNL's Optics, from an index and a thickness, from a datasheet's values."""

import json
import math
import re
from dataclasses import dataclass, field, replace
from os import PathLike
from pathlib import Path
from typing import Any, Literal

from sunpeak import _core

Curve = Literal["fresnel", "coated", "clear", "bronze"]
"""Whose angular curve stands for a pane's: Fresnel's equations (no coating), or for coatings regressions of LBL-33943:
`coated` takes that of clear glass at wavelengths of more than 64.5 % transmittance and that of bronze glass at others,
`clear` and `bronze` take the one."""

VISIBLE_UM = (0.38, 0.78)
"""Where visible values hold."""

SOLAR_UM = (0.3, 2.5)
"""Where solar values hold."""

LARGEST_FILE = 64 << 20
"""Files of panes have some kilobytes; more is something else [bytes]."""


@dataclass(frozen=True)
class Pane:
    """A pane by its values at normal incidence."""

    wavelengths_um: tuple[float, ...]
    """Wavelengths [um], ascending."""
    transmittance: tuple[float, ...]
    """Normal transmittance at each [-]."""
    front_reflectance: tuple[float, ...]
    """Normal reflectance of the outer side at each [-]."""
    back_reflectance: tuple[float, ...]
    """Normal reflectance of the inner side at each [-]."""
    curve: Curve = "fresnel"
    """How it goes on at other angles."""
    name: str = "pane"
    """What it is called."""
    thickness_mm: float | None = None
    """Thickness [mm], where it is known; the optics do not need it."""
    _layer: _core.Layer = field(init=False, repr=False, compare=False)

    def __post_init__(self) -> None:
        """Refuse what no pane can be."""
        layer = _core.Layer.pane(
            list(self.wavelengths_um),
            list(self.transmittance),
            list(self.front_reflectance),
            list(self.back_reflectance),
            self.curve,
        )
        object.__setattr__(self, "_layer", layer)

    @classmethod
    def load(cls, path: str | PathLike[str]) -> "Pane":
        """Read a product of IGSDB (JSON, either version of its interface) or a file of LBNL's Optics (text).

        Raises `InputError` where the file is not one, `OSError` where it cannot be read.
        """
        path = Path(path)
        if path.stat().st_size > LARGEST_FILE:
            raise _core.InputError(f"{path}: more than {LARGEST_FILE >> 20} MB; expected the file of a pane")
        text = path.read_text(encoding="utf-8", errors="replace")
        try:
            is_json = re.match(r'\s*\{\s*"', text) is not None
            return _from_igsdb(text, path) if is_json else _from_optics(text, path)
        except _core.InputError as error:
            raise _core.InputError(f"{path}: {error}") from error

    @classmethod
    def from_index(cls, index: float, thickness_mm: float, absorption_per_m: float = 0.0) -> "Pane":
        """Clear or tinted glass: index [-], thickness [mm], absorption [1/m], the same at all wavelengths."""
        if not (1.0 <= index <= 5.0 and 0.0 < thickness_mm <= 1000.0 and 0.0 <= absorption_per_m <= 1e6):
            raise _core.InputError(
                f"pane of index {index}, {thickness_mm} mm, {absorption_per_m} 1/m; expected an index of 1 to 5, a "
                "thickness above 0, an absorption of 0 or more"
            )
        transmittance, reflectance = _core.slab_optics(index, math.exp(-absorption_per_m * thickness_mm / 1e3), 1.0)
        return cls(
            (0.55,),
            (transmittance,),
            (reflectance,),
            (reflectance,),
            name=f"glass of index {index:g}, {thickness_mm:g} mm",
            thickness_mm=thickness_mm,
        )

    @classmethod
    def from_values(
        cls,
        visible: tuple[float, float, float],
        solar: tuple[float, float, float] | None = None,
        curve: Curve = "fresnel",
    ) -> "Pane":
        """From the values of a datasheet: transmittance, front and back reflectance [-], visible and solar.

        The solar values are shared out over the visible and the rest of the sun's spectrum, so that both come back.
        """
        if solar is None:
            light = [(value,) for value in visible]
            return cls((0.55,), light[0], light[1], light[2], curve=curve, name="glass by its visible values")
        share = _core.visible_share()
        low, high = VISIBLE_UM
        edge = 1e-6

        def spread(light: float, whole: float) -> tuple[float, ...]:
            rest = min(max((whole - share * light) / (1 - share), 0.0), 1.0)
            return rest, rest, light, light, rest, rest

        wavelengths = (SOLAR_UM[0], low - edge, low, high, high + edge, SOLAR_UM[1])
        curves = [spread(light, whole) for light, whole in zip(visible, solar, strict=True)]
        name = "glass by its visible and solar values"
        return cls(wavelengths, curves[0], curves[1], curves[2], curve, name)

    def flipped(self) -> "Pane":
        """Give the same pane with its inner side outside."""
        return replace(self, front_reflectance=self.back_reflectance, back_reflectance=self.front_reflectance)


Columns = tuple[tuple[float, ...], tuple[float, ...], tuple[float, ...], tuple[float, ...]]
"""Wavelengths, transmittance, front and back reflectance."""


def _spectrum(rows: list[tuple[float, ...]]) -> Columns:
    if not rows:
        raise _core.InputError("no spectrum; expected wavelengths with transmittance, front and back reflectance")
    ordered = sorted({row[0]: row for row in rows}.values())
    wavelengths, transmittance, front, back = zip(*ordered, strict=True)
    return wavelengths, transmittance, front, back


def _from_optics(text: str, path: Path) -> Pane:
    """Read the text of an Optics file: `{ key } value` lines, then wavelength [um], T, Rf, Rb."""
    about: dict[str, str] = {}
    rows: list[tuple[float, ...]] = []
    for number, line in enumerate(text.splitlines(), 1):
        if match := re.match(r"\{\s*([^:}]+?)\s*(?::\s*([^}]*?)\s*)?\}\s*(.*)", line):
            about[match[1].lower()] = (match[2] or match[3]).strip()
        elif line.strip():
            try:
                row = tuple(float(word) for word in line.split())
            except ValueError:
                row = ()
            if len(row) != 4:
                raise _core.InputError(f"line {number}: {line[:60]!r}; expected wavelength, T, Rf, Rb")
            rows.append(row)
    thickness = float(about["thickness"]) if re.fullmatch(r"[\d.]+", about.get("thickness", "")) else None
    coated = about.get("coated side", "").lower() in {"front", "back", "both"}
    wavelengths, transmittance, front, back = _spectrum(rows)
    return Pane(
        wavelengths,
        transmittance,
        front,
        back,
        curve="coated" if coated else "fresnel",
        name=about.get("product name") or path.stem,
        thickness_mm=thickness,
    )


def _from_igsdb(text: str, path: Path) -> Pane:
    """Read a product of IGSDB: its first version has `spectral_data`, its second `physical_properties`."""
    try:
        product: Any = json.loads(text)
        if "spectral_data" in product:
            spectrum = product["spectral_data"]
            points = spectrum["spectral_data"] if isinstance(spectrum, dict) else spectrum
            rows = [tuple(float(point[key]) for key in ("wavelength", "T", "Rf", "Rb")) for point in points]
            thickness = (product.get("measured_data") or {}).get("thickness")
        else:
            properties = product["physical_properties"]
            blocks = properties["optical_properties"]["optical_data"]["angle_blocks"]
            normal = min(blocks, key=lambda block: abs(float(block.get("incidence_angle") or 0.0)))
            rows = [
                (float(point["w"]), *(float(point["specular"][key]) for key in ("tf", "rf", "rb")))
                for point in normal["wavelength_data"]
                if point.get("specular")
            ]
            thickness = properties.get("thickness")
    except (ValueError, KeyError, TypeError, AttributeError, RecursionError) as error:
        what = f"no {error}" if isinstance(error, KeyError) else str(error)
        raise _core.InputError(f"not a product of IGSDB ({what}); expected its JSON with a spectrum") from error
    coated = str(product.get("coated_side") or "").lower() in {"front", "back", "both"}
    wavelengths, transmittance, front, back = _spectrum(rows)
    return Pane(
        wavelengths,
        transmittance,
        front,
        back,
        curve="coated" if coated else "fresnel",
        name=str(product.get("name") or path.stem),
        thickness_mm=None if thickness is None else float(thickness),
    )
