"""Glazing systems against LBNL's pyWinCalc, patch by patch: `validation/systems.md` says what came out.

    python validation/systems.py PRODUCTS SHADE [-o validation/systems.json] [--only low-e]

PRODUCTS is a folder with pane files of LBNL's Optics: CLEAR_3.DAT, CLEAR_6.DAT, CSR42_3.afg, LOW-E_5.LOF as they
come with the examples of pyWinCalc. SHADE is a BSDF file in Klems's full basis with a visible and a solar band. Neither
is part of this project. `--only` runs the systems with one pane or shade and leaves the other rows of the output.

pyWinCalc takes a minute of CPU and more for each system with a shade, by the wavelengths of the panes' files: of the
low-e pane, which has 496, both read every fifth. So that both see the same shade in the solar band:

- pyWinCalc 3.3.1 (WinCalc 2.4.1) finds a shade's invisible values as (solar - 0.49 visible) / 0.51, whatever share of
  the sun it then counts as visible; we take the share of the sun's table, 0.4949. It gets a file with such solar values
  that it finds the same invisible ones.
- It joins the results at the wavelengths of the panes' files by straight lines, also over the edges of the visible,
  where a shade's values jump. The files of the panes, for both, and its sun get wavelengths 0.1 nm beside the edges.
"""

import argparse
import json
import sys
import tempfile
import time
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

import sunpeak as sp
from sunpeak import _core
from sunpeak.systems import Band

sys.path.insert(0, str(Path(__file__).parents[1] / "tests/parity"))
import wincalc

THETA_DEG = np.arange(0.0, 90.0, 10.0)
FILES = {"clear 3": "CLEAR_3.DAT", "clear 6": "CLEAR_6.DAT", "low-e": "CSR42_3.afg", "hard low-e": "LOW-E_5.LOF"}
PANES = [
    ["clear 3"],
    ["clear 3", "clear 3"],
    ["low-e"],
    ["hard low-e", "clear 3"],
    ["low-e", "clear 3"],
    ["clear 6", "clear 3", "clear 6"],
]
SHADED = [
    (["clear 3", "shade"], "visible"),
    (["shade", "clear 3"], "visible"),
    (["clear 3", "shade", "low-e"], "visible"),
    (["clear 3", "fabric"], "visible"),
    (["low-e", "clear 3", "fabric"], "solar"),
]
EVERY = {"low-e": 5}
"""Of the wavelengths of a pane's file beside a shade, which ones both programs read; all where nothing is said."""

MIDDLES_DEG = np.array([0.0, 10, 20, 30, 40, 50, 60, 70, 82.5])
RINGS = np.cumsum([0, 1, 8, 16, 20, 24, 24, 24, 16])


def pane(products: Path, name: str) -> sp.Pane:
    """Read a pane; coated ones by the curve that pyWinCalc 3.3.1 takes for all of them."""
    found = sp.Pane.load(products / FILES[name])
    return replace(found, curve="bronze") if found.curve == "coated" else found


def thinned(products: Path, folder: Path) -> Path:
    """Panes' files in another folder: the wavelengths that `EVERY` leaves, and those at the edges of the visible."""
    for name, file in FILES.items():
        lines = (products / file).read_text(errors="replace").splitlines()
        first = next(k for k, line in enumerate(lines) if line[:1].isdigit())
        um, *columns = np.loadtxt(lines[first:], usecols=range(4)).T
        kept = [*um[: -1 : EVERY.get(name, 1)], um[-1]]
        kept = np.union1d(kept, [0.38, 0.78, *wincalc.BESIDE_VISIBLE_UM])
        rows = zip(kept, *(np.interp(kept, um, column) for column in columns), strict=True)
        text = [*lines[:first], *("{:.4f} {:.6f} {:.6f} {:.6f}".format(*row) for row in rows)]
        (folder / file).write_text("\n".join(text) + "\n")
    return folder


def worst(ours: Any, theirs: Any) -> float:
    """Largest relative difference."""
    return float(np.max(np.abs(np.asarray(ours) / np.asarray(theirs) - 1.0)))


def panes_alone(products: Path, names: list[str], band: Band) -> dict[str, Any]:
    """Direct values at nine angles from both sides, and the hemisphere's means."""
    layers = [wincalc.pywincalc.parse_optics_file(str(products / FILES[name])) for name in names]
    system = sp.System([pane(products, name) for name in names])
    found = [wincalc.results(layers, band, theta) for theta in THETA_DEG]
    row: dict[str, Any] = {"system": names, "band": band}
    for side, sign in (("front", 1.0), ("back", -1.0)):
        straight = system.straight(sp.direction(THETA_DEG) * [1, 1, sign], band)
        theirs = [getattr(f, side) for f in found]
        row[f"direct T {side}"] = worst(straight.transmittance, [t.transmittance.direct_direct for t in theirs])
        row[f"direct R {side}"] = worst(straight.reflectance, [t.reflectance.direct_direct for t in theirs])
    first = found[0].front.transmittance.diffuse_diffuse
    ours = system.straight(sp.direction(THETA_DEG), band).transmittance
    in_tens = wincalc.by_ten_degrees(np.append(THETA_DEG, 90.0), np.append(ours, 0.0))
    row["diffuse T, in their steps of 10 degrees"] = worst(in_tens, first)
    row["diffuse T, ours over theirs"] = float(system.diffuse(band).transmittance[0] / first - 1.0)
    cosines, weights = wincalc.fine_hemisphere(24)
    fine = [wincalc.results(layers, band, theta) for theta in np.degrees(np.arccos(cosines))]
    for side, inside in (("front", False), ("back", True)):
        for kind in ("transmittance", "reflectance"):
            theirs = [getattr(getattr(f, side), kind).direct_direct for f in fine]
            ours = getattr(system.diffuse(band, inside=inside), kind)
            row[f"diffuse {kind} {side}, theirs integrated finely"] = worst(ours, weights @ theirs)
    return row


def with_shade(products: Path, files: dict[str, Path], names: list[str], band: Band) -> dict[str, Any]:
    """All rings of Klems's basis from both sides; `products` is a folder that can be written."""
    ours, theirs, options = [], [], {}
    if band == "solar":
        options["optical_standard"] = wincalc.sharp_sun(products)
    for name in names:
        if name in files:
            ours.append(sp.Shade.load(files[name]))
            path = files[name]
            if band == "solar":
                path = wincalc.as_they_share(path, products / f"their {name}.xml", _core.visible_share())
            theirs.append(wincalc.shade(path))
        else:
            ours.append(pane(products, name))
            theirs.append(wincalc.pywincalc.parse_optics_file(str(products / FILES[name])))
    start = time.process_time()
    system = sp.System(ours)
    bsdf = system.bsdf("klems", band, panes="middle")
    middle = time.process_time()
    found = wincalc.results(theirs, band, matrices=True, **options)
    end = time.process_time()
    row: dict[str, Any] = {
        "system": names,
        "band": band,
        "every": {name: EVERY[name] for name in names if name in EVERY},
        "CPU s": middle - start,
        "their CPU s": end - middle,
    }
    bounds = np.sin(np.radians([0, 5, 15, 25, 35, 45, 55, 65, 75, 90])) ** 2
    counts = np.array([1, 8, 16, 20, 24, 24, 24, 16, 12])
    area = np.repeat(np.pi * np.diff(bounds) / counts, counts)
    for side, sign in (("front", -1.0), ("back", 1.0)):
        w_in = sp.direction(MIDDLES_DEG) * [1, 1, sign]
        for kind, mode in (("transmittance", "transmission"), ("reflectance", "reflection")):
            matrix = wincalc.matrix(getattr(found, side), kind)
            hemispherical = (matrix * area[:, None]).sum(axis=0)
            row[f"hemispherical {kind} {side}"] = worst(bsdf.hemispherical(w_in, mode), hemispherical[RINGS])
            if kind == "transmittance":
                straight = matrix.diagonal()[RINGS]
                row[f"direct T {side}"] = worst(bsdf.evaluate(w_in, -w_in), straight)
                every = [bsdf.hemispherical(sp.direction(t) * [1, 1, sign], mode)[0] for t in MIDDLES_DEG]
                by_ring = np.sum(np.array(every) * np.diff(bounds))
                row[f"diffuse T {side}"] = worst(by_ring, np.sum(hemispherical * area) / np.pi)
    mean = system.bsdf("klems", band)
    w_in = sp.direction(MIDDLES_DEG) * [1, 1, -1]
    row["hemispherical T by means over patches"] = worst(mean.hemispherical(w_in), bsdf.hemispherical(w_in))
    return row


def key(row: dict[str, Any]) -> str:
    """What tells a row from others."""
    return f"{' + '.join(row['system'])}, {row['band']}"


def main() -> None:
    """Compare, print a line each, write all of it."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("products", type=Path)
    parser.add_argument("shade", type=Path)
    parser.add_argument("-o", "--output", type=Path)
    parser.add_argument("--only", metavar="PANE", help="systems with this pane or shade; other rows stay in the output")
    given = parser.parse_args()
    rows: dict[str, dict[str, Any]] = {}
    if given.only and given.output:
        rows = {key(row): row for row in json.loads(given.output.read_text())}

    def wanted(names: list[str]) -> bool:
        return given.only is None or given.only in names

    def add(row: dict[str, Any]) -> None:
        rows[key(row)] = row
        print(json.dumps(row), flush=True)

    for names in filter(wanted, PANES):
        for band in ("visible", "solar"):
            add(panes_alone(given.products, names, band))
    with tempfile.TemporaryDirectory() as folder:
        products = thinned(given.products, Path(folder))
        fabric = Path(folder) / "fabric.xml"
        sp.RollerBlind(0.05, 0.15, 0.5, 0.4).write(fabric, solar=sp.RollerBlind(0.05, 0.25, 0.45, 0.35))
        for names, band in SHADED:
            if wanted(names):
                add(with_shade(products, {"shade": given.shade, "fabric": fabric}, names, band))
    if given.output:
        given.output.write_text(json.dumps(list(rows.values()), indent=1) + "\n")


if __name__ == "__main__":
    main()
