"""BSDFs converted and made from formulas, against Radiance and quadratures: `convert.json`, tables of `convert.md`.

usage: python validation/convert.py [SCHEMA.xsd] [times others bsdf2klems coarse albedo radiance peaks]
(a quarter of an hour)

Needs pyradiance, the real files (`../shared/data`), and, for the files as others read them, pywincalc and xmlschema
with LBNL's schema 1.7.5; what is missing is left out. Times are processor seconds.
"""

import json
import math
import os
import re
import subprocess
import sys
import tempfile
from collections.abc import Callable
from importlib.util import find_spec
from pathlib import Path
from typing import Any

import numpy as np
import pyradiance

import sunpeak as sp

HERE = Path(__file__).parent
sys.path.insert(0, str(HERE.parent / "tests"))

from parity.test_bsdf import angles, ask  # noqa: E402
from test_convert import klems_areas, matrices  # noqa: E402

DATA = Path(os.environ.get("SUNPEAK_SHARED", HERE.parents[1] / "shared")) / "data" / "bsdf"
RADIANCE = Path(pyradiance.__file__).parent
NOT_GRAZING = math.sin(math.radians(0.1))

Row = dict[str, Any]

BASES = [("klems-full", None), ("klems-half", None), ("klems-quarter", None), ("t3", 64), ("t4", 32)]

MODELS = [
    sp.Formula("lambert", reflectance=0.5, transmittance=0.3),
    sp.Formula("phong", diffuse=0.3, specular=0.4, exponent=50),
    sp.Formula("ward", diffuse=0.1, specular=0.5, roughness=0.2),
    sp.Formula("wgmd", diffuse=0.1, specular=0.5, roughness=0.2),
    sp.Formula("cook-torrance", diffuse=0.2, specular=0.8, roughness=0.25),
    sp.Formula("ggx", index=1.5, roughness=0.3),
    sp.Formula("rough-dielectric", index=1.5, roughness=0.3),
]


def seconds(work: Callable[[], Any]) -> tuple[Any, float]:
    """A result, and the processor time that it took [s]."""
    before = os.times()
    result = work()
    after = os.times()
    return result, sum(after[:2]) - sum(before[:2])


def radiance(folder: Path, *command: object) -> tuple[bytes, float]:
    """What a program of Radiance prints, and its processor time [s]."""
    env = os.environ | {"PATH": f"{RADIANCE / 'bin'}:{os.environ['PATH']}", "RAYPATH": f".:{RADIANCE / 'lib'}"}
    before = os.times()
    done = subprocess.run([str(c) for c in command], cwd=folder, env=env, capture_output=True, check=True)
    after = os.times()
    return done.stdout, sum(after[2:4]) - sum(before[2:4])


def bsdf2klems(folder: Path) -> list[Row]:
    """Trees to Klems, against bsdf2klems with more and more random pairs for each pair of patches."""
    lobe, blind = sp.Formula("phong", diffuse=0.2, specular=0.5, exponent=12), sp.Blind(tilt_deg=30.0)
    for side in (16, 64):
        lobe.write(folder / f"lobe{side}.xml", "t4", side)
    blind.write(folder / "blind.xml", "t4-4096")
    files = [
        ("lobe, t4 16 x 16", folder / "lobe16.xml", (100,)),
        ("louvre, t4 16 x 16", DATA / "louvre_t4-256.xml", (60, 240)),
        ("lobe, t4 64 x 64", folder / "lobe64.xml", (400,)),
        ("blind, t4 64 x 64", folder / "blind.xml", (1000,)),
    ]
    return against_bsdf2klems(folder, files)


def coarse_blind(folder: Path) -> list[Row]:
    """A blind in cells so wide that bsdf2klems's noise comes below a percent; one side of its transmission alone."""
    path = folder / "coarse.xml"
    sp.Blind(tilt_deg=30.0).write(path, "t4-256")
    blocks = re.compile(r"\t<WavelengthData>.*?</WavelengthData>\n", re.DOTALL)
    text = path.read_text(encoding="utf-8")
    path.write_text(
        blocks.sub(lambda block: block[0] if "Transmission Back" in block[0] else "", text), encoding="utf-8"
    )
    return against_bsdf2klems(folder, [("blind, t4 16 x 16", path, (750, 3000))])


def against_bsdf2klems(folder: Path, files: list[tuple[str, Path, tuple[int, ...]]]) -> list[Row]:
    """Each table by ours once, and by theirs with so many random pairs."""
    areas = klems_areas()
    weights = np.outer(areas, areas)
    rows: list[Row] = []
    for name, path, counts in files:
        tree = sp.Bsdf.load(path)
        converted, own_time = seconds(lambda tree=tree: tree.convert("klems-full"))
        converted.save(folder / "ours.xml")
        ours = matrices(folder / "ours.xml")
        for count in counts:
            text, their_time = radiance(folder, "bsdf2klems", "-n", count, path)
            (folder / "theirs.xml").write_bytes(text)
            for side, theirs in matrices(folder / "theirs.xml").items():
                if side not in ours:
                    continue
                own, their = areas @ ours[side], areas @ theirs
                values = (weights * np.abs(ours[side] - theirs)).sum() / (weights * theirs).sum()
                rows.append(
                    {
                        "table": name,
                        "side": side,
                        "pairs": count,
                        "flux": float(own @ areas / (their @ areas) - 1),
                        "hemispherical_rms": float(np.sqrt(np.mean((own / their - 1) ** 2))),
                        "values": float(values),
                        "cpu_s": own_time,
                        "their_cpu_s": their_time,
                    }
                )
    return rows


def as_radiance_reads(folder: Path) -> list[Row]:
    """Files written here, and what Radiance's library finds in them."""
    grate = sp.Bsdf.load(DATA / "metal-grate_t4-256.xml")
    lobe = sp.Formula("wgmd", roughness=0.2)
    rows: list[Row] = []
    for basis, resolution in (
        ("klems-full", None),
        ("klems-half", None),
        ("klems-quarter", None),
        ("t3", 64),
        ("t4", 32),
    ):
        made = (("grate", grate.convert(basis, resolution=resolution)), ("wgmd", lobe.tabulate(basis, resolution)))
        for name, bsdf in made:
            path = folder / "asked.xml"
            bsdf.save(path)
            pairs = angles(1000, seed=11)
            theirs = ask(path, pairs)
            w_in, w_out = sp.direction(*pairs[:, :2].T), sp.direction(*pairs[:, 2:].T)
            seen = np.abs(w_in[:, 2]) > NOT_GRAZING
            values, found = bsdf.evaluate(w_in, w_out), theirs["values"][:, 1]
            lit = found > 1e-6
            off = []
            for column, mode in enumerate(("transmission", "reflection")):
                there = theirs["hemispherical"][:, column]
                full = seen & (there > 1e-6)
                if full.any():
                    off.append(float(np.abs(bsdf.hemispherical(w_in, mode)[full] / there[full] - 1).max()))
            rows.append(
                {
                    "table": name,
                    "basis": basis if resolution is None else f"{basis} {resolution}",
                    "values": float(np.abs(values[lit] / found[lit] - 1).max()),
                    "hemispherical": max(off),
                }
            )
    return rows


def quadrature(model: sp.Formula, light: np.ndarray, reflection: bool) -> float:
    """What a model gives out of light on its front: Gauss in theta, equal steps in azimuth."""
    nodes, weights = np.polynomial.legendre.leggauss(240)
    theta, phi = (nodes + 1) * math.pi / 4, (np.arange(960) + 0.5) * math.pi / 480
    t, p = np.meshgrid(theta, phi, indexing="ij")
    up = 1.0 if reflection else -1.0
    out = np.stack([np.sin(t) * np.cos(p), np.sin(t) * np.sin(p), up * np.cos(t)], axis=-1).reshape(-1, 3)
    areas = (weights[:, None] * math.pi / 4 * np.sin(t) * np.cos(t) * math.pi / 480).reshape(-1)
    return float(model.value(light, out) @ areas)


def albedos() -> list[Row]:
    """Tables of the models against quadratures over the hemisphere, for rings of an isotropic tree."""
    side, rings = 64, (6, 14, 22, 31)
    nodes, weights = np.polynomial.legendre.leggauss(3)
    rows: list[Row] = []
    for model in MODELS:
        bsdf, time = seconds(lambda model=model: model.tabulate("t3", side))
        for reflection in (True, False):
            if not reflection and model.model not in ("lambert", "rough-dielectric"):
                continue
            off = []
            for ring in rings:
                edges = 1 - 2 * np.array([ring + 1, ring]) / side
                radii = edges.mean() + 0.5 * (edges[1] - edges[0]) * nodes
                lights = [np.array([r, 0.0, math.sqrt(1 - r * r)]) for r in radii]
                truth = np.average([quadrature(model, w, reflection) for w in lights], weights=weights * radii)
                w_in = np.array([edges.mean(), 0.0, -math.sqrt(1 - edges.mean() ** 2)])
                found = bsdf.hemispherical(w_in, "reflection" if reflection else "transmission")[0]
                off.append(abs(found / truth - 1))
            mode = "reflection" if reflection else "transmission"
            rows.append({"model": model.model, "mode": mode, "worst": float(max(off)), "cpu_s": time})
    return rows


def peaks() -> list[Row]:
    """T of a fabric that is known, after conversions with the cells' flux and with its peak kept."""
    formula = sp.Fabric()
    rows: list[Row] = []
    theta = np.random.default_rng(5).uniform(0, 0.9 * formula.cut_off_deg, 60)
    phi = np.random.default_rng(6).uniform(0, 360, 60)
    truth = np.array([formula.through(t) for t in np.radians(theta)])
    with tempfile.TemporaryDirectory() as name:
        for start in ("t3-1024", "t3-4096"):
            formula.write(Path(name) / "fabric.xml", start)
            fabric = sp.Bsdf.load(Path(name) / "fabric.xml")
            for basis, resolution in (("t3", 128), ("t4", 32), ("klems-full", None)):
                for keep in (False, True):
                    made = fabric.convert(basis, resolution=resolution, keep_peak=keep)
                    found = made.through(sp.direction(theta, phi))
                    off = np.abs(found / truth - 1)
                    rows.append(
                        {
                            "from": start,
                            "to": basis if resolution is None else f"{basis} {resolution}",
                            "keep_peak": keep,
                            "mean_error": float(off[found > 0].mean()) if (found > 0).any() else None,
                            "misses": int((found <= 0).sum()),
                        }
                    )
    return rows


def times() -> list[Row]:
    """How long things take."""
    shade = sp.Bsdf.load(DATA / "escreen-3pct-charcoal_klems-full.xml")
    rows: list[Row] = []

    def timed(what: str, work: Callable[[], Any]) -> Any:
        result, cpu = seconds(work)
        rows.append({"what": what, "cpu_s": cpu})
        return result

    with tempfile.TemporaryDirectory() as name:
        path = Path(name) / "fabric.xml"
        timed("fabric from a formula, t3 64 x 64, written", lambda: sp.Fabric().write(path, "t3-4096"))
        isotropic = sp.Bsdf.load(path)
    tree = timed("Klems full to t4 64 x 64", lambda: shade.convert("t4", resolution=64))
    timed("t4 64 x 64 to Klems full", lambda: tree.convert("klems-full"))
    timed("t4 64 x 64 turned by 20 degrees", lambda: tree.convert(rotate_deg=20))
    timed("t3 64 x 64 to Klems full", lambda: isotropic.convert("klems-full"))
    timed("t3 64 x 64 to t4 32 x 32", lambda: isotropic.convert("t4", resolution=32))
    timed("wgmd, roughness 0.1, t4 32 x 32", lambda: sp.Formula("wgmd", roughness=0.1).tabulate("t4", 32))
    return rows


def others(folder: Path, schema: str | None) -> list[Row]:
    """Files as WINDOW's own code reads them, and by LBNL's schema."""
    rows: list[Row] = []
    shade = sp.Bsdf.load(DATA / "escreen-3pct-charcoal_klems-full.xml")
    solar = sp.Bsdf.load_solar(DATA / "escreen-3pct-charcoal_klems-full.xml")
    for basis in ("klems-full", "klems-half", "klems-quarter"):
        path = folder / f"{basis}.xml"
        shade.convert(basis).save(path, solar=solar.convert(basis), name=basis, thickness_m=0.00043)
        row: Row = {"file": basis}
        if schema is not None and find_spec("xmlschema"):
            import xmlschema  # noqa: PLC0415

            text = re.sub(r"<WindowElement [^>]*>", "<WindowElement>", path.read_text(encoding="utf-8"), count=1)
            row["schema_errors"] = len(list(xmlschema.XMLSchema(schema).iter_errors(text)))
        if find_spec("pywincalc"):
            import pywincalc  # noqa: PLC0415

            product = pywincalc.parse_bsdf_xml_file(str(path))
            row |= {"name": product.product_name, "thickness_mm": product.thickness}
        rows.append(row)
    return rows


def table(rows: list[Row]) -> str:
    """Rows as Markdown."""

    def shown(value: Any) -> str:
        return f"{value:.2g}" if isinstance(value, float) else str(value)

    head = list(rows[0])
    lines = ["| " + " | ".join(head) + " |", "|" + "---|" * len(head)]
    lines += ["| " + " | ".join(shown(row.get(key, "-")) for key in head) + " |" for row in rows]
    return "\n".join(lines)


def main() -> None:
    """Measure the parts that are asked for, and write their numbers into both files."""
    asked = sys.argv[1:]
    schema = next((word for word in asked if word.endswith(".xsd")), None)
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        parts: dict[str, Callable[[], list[Row]]] = {
            "times": times,
            "others": lambda: others(folder, schema),
            "bsdf2klems": lambda: bsdf2klems(folder),
            "coarse": lambda: coarse_blind(folder),
            "albedo": albedos,
            "radiance": lambda: as_radiance_reads(folder),
            "peaks": peaks,
        }
        for part, measure in parts.items():
            if part in asked or all(word.endswith(".xsd") for word in asked):
                keep(part, measure())


def keep(part: str, rows: list[Row]) -> None:
    """Write a part's numbers beside those of the others."""
    numbers, page = HERE / "convert.json", HERE / "convert.md"
    known = json.loads(numbers.read_text(encoding="utf-8")) if numbers.exists() else {}
    numbers.write_text(json.dumps(known | {part: rows}, indent=1) + "\n", encoding="utf-8")
    begin, end = f"<!-- {part}: made by convert.py -->\n", f"<!-- end of {part} -->"
    before, _, rest = page.read_text(encoding="utf-8").partition(begin)
    page.write_text(before + begin + table(rows) + "\n" + end + rest.partition(end)[2], encoding="utf-8")


if __name__ == "__main__":
    main()
