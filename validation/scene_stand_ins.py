"""Files that the collection of scenes names and does not hold, made so that both programs can read the scenes.

They are simple, but of the right kind: a sky picture, pictures for patterns, meshes, an octree, a BSDF, a text, a
font, data.
"""

import math
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import numpy.typing as npt
import pyradiance
from matplotlib.font_manager import FontProperties
from matplotlib.textpath import TextPath

import sunpeak as sp
from conftest import Radiance

Floats = npt.NDArray[np.float64]


def make_stand_ins(folder: Path, radiance: Radiance) -> None:
    """Write them all into a folder, which is searched first."""
    sky_picture(folder / "sunset.hdr")
    for name in ("flower.hdr", "vase.hdr"):
        flower_picture(folder / name)
    spectral_picture(folder / "spfish.hsr")
    (folder / "test.txt").write_text("Light is\nwhat we see\nby.\n")
    (folder / "helvet.fnt").write_text(font())
    (folder / "sawtooth.dat").write_text(scattering_data())
    sp.Blind(width=1.1, tilt_deg=20.0, scattered=0.1).write(folder / "blinds20c.xml")
    (folder / "mesh.mat").write_text("void plastic cloth 0 0 5 .4 .2 .5 .03 .1\n")
    for name, scale, up in (("vase", 40.0, 1), ("woman", 0.25, 1)):
        (folder / f"{name}.obj").write_text(turned_body(scale, up))
        mesh = radiance.run("obj2mesh", "-a", "mesh.mat", f"{name}.obj", folder=folder)
        (folder / f"{name}.rtm").write_bytes(mesh)
    (folder / "car.rad").write_text(CAR)
    (folder / "porsche.octf").write_bytes(radiance.run("oconv", "-f", "car.rad", folder=folder))


def slats_table(blind: Path) -> bytes:
    """The BSDF of a blind's slats and the pane behind them, as Radiance finds it by rays: LBNL XML, Klems basis.

    The scene file has both, the pane at y = 0; they are turned so that the room is at the front. With the pane, since a
    proxy's rays start beyond it, and as in `blindsT3.xml` beside the scene file.
    """
    window = "\n".join(" ".join(primitive) for primitive in primitives(blind.read_text()))
    turned = pyradiance.Xform(window.encode()).rotatex(-90).rotatey(180).translate(0, 0, -SLATS_DEPTH)()
    # Ten of them, far from their ends; the pane is within.
    box = pyradiance.genbsdf.SamplingBox(-4, -3, 1.3, 1.3 + 10 * SLATS_SPACING, -SLATS_DEPTH - PANE_WITHIN, 0)
    table = pyradiance.genbsdf.generate_bsdf(turned, nsamp=600, dim=box, params=["-ab", "5", "-ad", "64"])
    xml: bytes = pyradiance.genbsdf.generate_xml(sol_results=table, vis_results=table)
    return xml


SLATS_DEPTH, SLATS_SPACING = 0.0487, 0.030099
"""Of the blind in `tutorial-room/blinds` [m]."""

PANE_WITHIN = 1e-3
"""How far behind the pane rays start [m]."""


def primitives(text: str) -> Iterator[list[str]]:
    """The words of each primitive of a scene file without commands."""
    words = iter("\n".join(line.split("#")[0] for line in text.splitlines()).split())
    for modifier in words:
        primitive = [modifier, next(words), next(words)]
        for _ in range(3):
            count = next(words)
            primitive += [count, *(next(words) for _ in range(int(count)))]
        yield primitive


CAR = """
void plastic paint 0 0 5 .5 .1 .05 .05 .05
void plastic rubber 0 0 5 .05 .05 .05 0 0
!genbox paint body 4 .8 1.7 | xform -t -2 .4 -.85
!genbox paint roof 2 .6 1.5 | xform -t -1.2 1.2 -.75
rubber cylinder front 0 0 7 1.2 .4 -.9 1.2 .4 .9 .4
rubber cylinder rear 0 0 7 -1.2 .4 -.9 -1.2 .4 .9 .4
"""


def sky_picture(path: Path) -> None:
    """A red horizon under a blue zenith, as a fisheye."""
    y, x = np.mgrid[1:-1:256j, -1:1:256j]
    height = np.sqrt(np.clip(1 - x**2 - y**2, 0, None))
    red = np.array([0.6, 0.25, 0.1]) * np.exp(-4 * np.abs(y))[..., None]
    pixels = red + np.array([0.05, 0.1, 0.25]) * (0.3 + height)[..., None]
    sp.Picture.of(pixels).save(path)


def flower_picture(path: Path) -> None:
    """Six petals."""
    y, x = np.mgrid[1:-1:128j, -1:1:128j]
    petal = np.hypot(x, y) < 0.6 + 0.3 * np.cos(6 * np.arctan2(y, x))
    sp.Picture.of(np.where(petal[..., None], [0.9, 0.4, 0.3], [0.1, 0.3, 0.1])).save(path)


def turned_body(scale: float, up: int) -> str:
    """A bulb on a foot, smooth, with local coordinates; its axis is axis `up`."""
    rows, columns = 16, 24
    lines = ["usemtl cloth"]
    for i in range(rows + 1):
        t = i / rows
        radius, slope = 0.35 + 0.2 * np.sin(2 * np.pi * t), 0.4 * np.pi * np.cos(2 * np.pi * t)
        for j in range(columns + 1):
            phi = 2 * np.pi * j / columns
            place = np.array([radius * np.cos(phi), radius * np.sin(phi), 2.5 * t]) * scale
            normal = np.array([np.cos(phi), np.sin(phi), -slope / 2.5])
            normal /= np.linalg.norm(normal)
            if up == 1:
                place, normal = place[[1, 2, 0]], normal[[1, 2, 0]]
            lines.append("v {} {} {}".format(*place))
            lines.append("vn {} {} {}".format(*normal))
            lines.append(f"vt {0.01 + 0.98 * j / columns} {0.01 + 0.98 * t}")
    for i in range(rows):
        for j in range(columns):
            a = 1 + i * (columns + 1) + j
            corners = [a, a + 1, a + columns + 2, a + columns + 1]
            lines.append("f " + " ".join(f"{c}/{c}/{c}" for c in corners))
    return "\n".join(lines) + "\n"


LETTERS = "".join(map(chr, range(33, 127)))
FONT_GRID = 255


def font() -> str:
    """Characters of matplotlib's sans-serif font as polygons on Radiance's grid, holes by seams."""
    lines = ["# code, number of vertices, vertices", "32 0"]
    for letter in LETTERS:
        outlines = TextPath((0, 0), letter, size=1, prop=FontProperties(family="DejaVu Sans")).to_polygons()
        # Vertices of the first outline, then each of the others, and back.
        start = outlines[0][:1]
        seamed = np.vstack([np.vstack([outline, start]) for outline in outlines])
        # Room for what hangs below the line.
        raised = seamed + np.array([0.0, 0.25])
        grid = np.clip(np.rint(raised * FONT_GRID / 1.25), 0, FONT_GRID).astype(int)
        lines.append(f"{ord(letter)} {len(grid)}\n" + "\n".join(f"\t{x} {y}" for x, y in grid))
    return "\n".join(lines) + "\n"


def scattering_data() -> str:
    """A BSDF over Shirley and Chiu's squares of both directions, [1/sr].

    Brighter by up to 40 % towards where the light is mirrored, and darker on the other side, so that all of it leaves
    from every direction: what a renderer takes for diffuse is then as much as it is.
    """
    count = 13
    places = np.stack(np.meshgrid(*2 * [np.linspace(0, 1, count)], indexing="ij"), axis=-1).reshape(-1, 2)
    disc = np.array([on_disc(*place) for place in places])
    values = (1 + 0.4 * disc @ disc.T) / math.pi
    head = "4\n" + 4 * f"0 1 {count}\n"
    return head + "\n".join(" ".join(f"{value:.5f}" for value in row) for row in values) + "\n"


def on_disc(x: float, y: float) -> tuple[float, float]:
    """Place on the unit disc of a place on the unit square (Shirley and Chiu 1997)."""
    a, b = 2 * x - 1, 2 * y - 1
    if a == b == 0:
        return 0.0, 0.0
    if abs(a) > abs(b):
        radius, angle = a, math.pi / 4 * b / a
    else:
        radius, angle = b, math.pi / 2 - math.pi / 4 * a / b
    return radius * math.cos(angle), radius * math.sin(angle)


SPECTRAL_COMPONENTS = 12
LONGEST_NM, SHORTEST_NM = 780.0, 380.0


def spectral_picture(path: Path) -> None:
    """Stripes of smooth spectra, longest wavelength first, as a hyperspectral picture of Radiance's."""
    rows, columns = 40, 60
    y, x = np.mgrid[0 : 1 : rows * 1j, 0 : 1 : columns * 1j]
    step = (LONGEST_NM - SHORTEST_NM) / SPECTRAL_COMPONENTS
    wavelengths = LONGEST_NM - step * (np.arange(SPECTRAL_COMPONENTS) + 0.5)
    center = 430 + 250 * x[..., None]
    spectra = 0.1 + 0.8 * (0.4 + 0.6 * y[..., None]) * np.exp(-(((wavelengths - center) / 60) ** 2))
    path.write_bytes(spectral_bytes(spectra))


def spectral_bytes(spectra: Floats) -> bytes:
    """A hyperspectral picture (rows, columns, components), with a common exponent for the components of a pixel."""
    rows, columns, count = spectra.shape
    header = f"#?RADIANCE\nNCOMP={count}\nWAVELENGTH_SPLITS= {LONGEST_NM:g} 588 480 {SHORTEST_NM:g}\n"
    header += f"FORMAT=Radiance_spectra\n\n-Y {rows} +X {columns}\n"
    _, exponents = np.frexp(spectra.max(axis=2))
    mantissas = np.floor(spectra * 2.0 ** (8 - exponents[..., None])).clip(0, 255)
    return header.encode() + np.dstack([mantissas, exponents + 128]).astype(np.uint8).tobytes()
