"""Scans of products in closed form, by ours and by Radiance: `validation/measured.md` says what came out.

    python validation/measured.py [-o validation/measured.json]

The same scans go through `measured_bsdf` and through pabopto2bsdf with bsdf2klems and bsdf2ttree (pyradiance), and both
tables are held against the means of the closed form over the same cells. A few minutes on two cores.
"""

import argparse
import json
import os
import subprocess
import sys
import tempfile
import time
from pathlib import Path
from typing import Any

import numpy as np
import pyradiance

import sunpeak as sp

sys.path.insert(0, str(Path(__file__).parents[1] / "tests"))
import scans as synthetic

ROOT = Path(pyradiance.__file__).parent
THETAS = (0, 10, 20, 30, 40, 50, 60, 70, 80)
BETWEEN = np.array([5.0, 15, 25, 35, 45, 55, 65, 75])
FWHM_DEG = 1.5
WARD = {"diffuse": 0.2, "specular": 0.2}
REFLECTING: dict[str, tuple[sp.Formula, tuple[float, ...]]] = {
    "Lambert 0.6": (sp.Formula("lambert", reflectance=0.6), (0.0,)),
    "Phong, exponent 60": (sp.Formula("phong", diffuse=0.2, specular=0.5, exponent=60), (0.0,)),
    "Ward 0.12": (sp.Formula("wgmd", roughness=0.12, **WARD), (0.0,)),
    "Ward 0.1 by 0.25": (sp.Formula("wgmd", roughness_x=0.1, roughness_y=0.25, **WARD), (0.0, 30.0, 60.0, 90.0)),
}


def radiance(folder: Path, scans: list[sp.Scan], command: list[str]) -> tuple[sp.Bsdf, float]:
    """A table of Radiance's, and the CPU time that it took [s]."""
    files = [synthetic.write_pabopto(folder / f"scan_{k}.txt", scan).name for k, scan in enumerate(scans)]
    env = os.environ | {"PATH": f"{ROOT / 'bin'}:{os.environ['PATH']}", "RAYPATH": f".:{ROOT / 'lib'}"}
    before = os.times()
    for words, out in ((["pabopto2bsdf", *files], "sir"), ([*command, "sir"], "out.xml")):
        done = subprocess.run(words, cwd=folder, env=env, capture_output=True, check=True)
        (folder / out).write_bytes(done.stdout)
    after = os.times()
    return sp.Bsdf.load(folder / "out.xml"), after.children_user - before.children_user


def ours(scans: list[sp.Scan], basis: str, **options: Any) -> tuple[sp.Bsdf, float]:
    """Our table, and the CPU time that it took [s]."""
    before = time.process_time()
    made = sp.measured_bsdf(scans, basis, **options)
    return made.bsdf, time.process_time() - before


def spread() -> np.ndarray:
    """Exits even in projected solid angle (n, 3)."""
    radius = np.sqrt((np.arange(150) + 0.5) / 150)[:, None]
    turn = (2 * np.pi * (np.arange(300) + 0.5) / 300)[None, :]
    parts = np.broadcast_arrays(radius * np.cos(turn), radius * np.sin(turn), np.sqrt(1 - radius**2))
    return np.stack(parts, axis=-1).reshape(-1, 3)


def peak(values: np.ndarray, out: np.ndarray) -> np.ndarray:
    """The mean direction of what stands above the floor, by flux."""
    mean = ((values - values.min())[:, None] * out).sum(axis=0)
    return mean / np.linalg.norm(mean)


def against(table: sp.Bsdf, truth: sp.Bsdf, phi_deg: float) -> dict[str, float | None]:
    """Differences from the closed form's table half way between measured incidences; a diffuser has no lobe."""
    out = spread()
    whole, apart, shape = [], [], []
    for light in sp.direction(BETWEEN, phi_deg):
        found, expected = table.evaluate(light, out), truth.evaluate(light, out)
        whole.append(found.mean() / expected.mean() - 1.0)
        shape.append(np.abs(found - expected).mean() / expected.mean())
        if np.ptp(expected) > 1e-6:
            apart.append(np.degrees(np.arccos(np.clip(peak(found, out) @ peak(expected, out), -1.0, 1.0))))
    return {
        "hemispherical_percent": float(100 * np.abs(whole).max()),
        "lobe_deg": float(np.max(apart)) if apart else None,
        "values_percent": float(100 * np.mean(shape)),
    }


def reflecting(folder: Path) -> list[dict[str, Any]]:
    """Formulas that reflect: Klems and a tree."""
    found = []
    for name, (model, phis) in REFLECTING.items():
        thetas = THETAS if len(phis) == 1 else THETAS[::2]
        scans = synthetic.scans(synthetic.formula(model), thetas, phis, reflection=True)
        tree = "t3-1024" if len(phis) == 1 else "t4-256"
        commands = {
            "klems": ["bsdf2klems", "-n", "200"],
            tree: ["bsdf2ttree", "-g", "5" if len(phis) == 1 else "4", "-t", "0"],
        }
        for basis, command in commands.items():
            truth = model.tabulate(basis)
            for who, (table, cpu_s) in (("ours", ours(scans, basis)), ("Radiance", radiance(folder, scans, command))):
                row = {"product": name, "basis": basis, "by": who, "cpu_s": cpu_s}
                found.append(row | against(table, truth, 0.0 if len(phis) == 1 else 17.0))
                print(found[-1], flush=True)
    return found


def fabric(folder: Path) -> list[dict[str, Any]]:
    """A fabric seen by an instrument: T between the incidences, with and without noise."""
    found = []
    theta = np.array([3.0, 8, 13, 18, 23, 28, 33, 38, 43, 48, 53, 58])
    light = sp.direction(theta, 77.0)
    truth = np.array([synthetic.FABRIC.through(t) for t in np.radians(theta)])
    rest = np.array([synthetic.hemispherical(synthetic.fabric_scatters, w, reflection=False) for w in light])
    for noise in (0.0, 0.03):
        scans = synthetic.scans(
            synthetic.fabric(FWHM_DEG), (0, 10, 20, 30, 40, 50, 60, 66), (180.0,), reflection=False, noise=noise
        )
        for basis, command in (
            ("klems", ["bsdf2klems", "-n", "200"]),
            ("t3-4096", ["bsdf2ttree", "-g", "6", "-t", "0"]),
        ):
            for who in ("ours", "Radiance"):
                if who == "ours":
                    table, cpu_s = ours(scans, basis, instrument_fwhm_deg=FWHM_DEG)
                else:
                    made, cpu_s = radiance(folder, scans, command)
                    made.save(folder / "theirs.xml")
                    table = sp.Bsdf.load(folder / "theirs.xml", instrument_fwhm_deg=FWHM_DEG)
                found.append(
                    {
                        "basis": basis,
                        "by": who,
                        "noise_percent": 100 * noise,
                        "cpu_s": cpu_s,
                        "T_mean_percent": float(100 * np.abs(table.through(light) / truth - 1).mean()),
                        "T_worst_percent": float(100 * np.abs(table.through(light) / truth - 1).max()),
                        "whole_worst_percent": float(
                            100 * np.abs(table.hemispherical(light) / (truth + rest) - 1).max()
                        ),
                    }
                )
                print(found[-1], flush=True)
    return found


def markdown(rows: list[dict[str, Any]]) -> str:
    """A table of rows with the same keys."""
    keys = list(rows[0])
    lines = ["| " + " | ".join(keys) + " |", "|" + "---|" * len(keys)]
    for row in rows:
        lines.append("| " + " | ".join(f"{v:.2g}" if isinstance(v, float) else str(v) for v in row.values()) + " |")
    return "\n".join(lines)


def main() -> None:
    """Run all of it."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("-o", "--output", type=Path, default=Path(__file__).with_suffix(".json"))
    arguments = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        found = {"fabric": fabric(Path(folder)), "reflecting": reflecting(Path(folder))}
    arguments.output.write_text(json.dumps(found, indent=1) + "\n")
    print("\n\n".join(markdown(rows) for rows in found.values()))


if __name__ == "__main__":
    main()
