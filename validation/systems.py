"""Glazing systems against LBNL's pyWinCalc, patch by patch: `validation/systems.md` says what came out.

    python validation/systems.py PRODUCTS SHADE [-o validation/systems.json]

PRODUCTS is a folder with pane files of LBNL's Optics: CLEAR_3.DAT, CLEAR_6.DAT, CSR42_3.afg, LOW-E_5.LOF as they
come with the examples of pyWinCalc. SHADE is a BSDF file in Klems's full basis with a visible and a solar band. Neither
is part of this project. pyWinCalc takes a minute of CPU and more for each system with a shade, by the wavelengths of
the panes' files: of the low-e pane, which has 496, both read every fifth.
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
    """The panes' files with as many of their wavelengths as `EVERY` says, in another folder."""
    for pane, name in FILES.items():
        lines = (products / name).read_bytes().splitlines(keepends=True)
        readings = [k for k, line in enumerate(lines) if line[:1].isdigit()]
        left_out = set(readings[:-1]) - set(readings[:: EVERY.get(pane, 1)])
        (folder / name).write_bytes(b"".join(line for k, line in enumerate(lines) if k not in left_out))
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
    """All rings of Klems's basis from both sides."""
    ours, theirs = [], []
    for name in names:
        if name in files:
            ours.append(sp.Shade.load(files[name]))
            theirs.append(wincalc.shade(files[name]))
        else:
            ours.append(pane(products, name))
            theirs.append(wincalc.pywincalc.parse_optics_file(str(products / FILES[name])))
    start = time.process_time()
    system = sp.System(ours)
    bsdf = system.bsdf("klems", band, panes="middle")
    middle = time.process_time()
    found = wincalc.results(theirs, band, matrices=True)
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


def main() -> None:
    """Compare, print a line each, write all of it."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("products", type=Path)
    parser.add_argument("shade", type=Path)
    parser.add_argument("-o", "--output", type=Path)
    given = parser.parse_args()
    rows: list[dict[str, Any]] = []

    def add(row: dict[str, Any]) -> None:
        rows.append(row)
        print(json.dumps(row), flush=True)

    for names in PANES:
        for band in ("visible", "solar"):
            add(panes_alone(given.products, names, band))
    with tempfile.TemporaryDirectory() as folder:
        fabric = Path(folder) / "fabric.xml"
        sp.RollerBlind(0.05, 0.15, 0.5, 0.4).write(fabric, solar=sp.RollerBlind(0.05, 0.25, 0.45, 0.35))
        for names, band in SHADED:
            products = thinned(given.products, Path(folder))
            add(with_shade(products, {"shade": given.shade, "fabric": fabric}, names, band))
    if given.output:
        given.output.write_text(json.dumps(rows, indent=1) + "\n")


if __name__ == "__main__":
    main()
