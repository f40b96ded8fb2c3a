"""Files that the collection of scenes names and does not hold, made so that both programs can read the scenes.

They are simple, but of the right kind: a sky picture, pictures for patterns, meshes, an octree, a BSDF, a text.
"""

from pathlib import Path

import numpy as np

import sunpeak as sp
from conftest import Radiance


def make_stand_ins(folder: Path, radiance: Radiance) -> None:
    """Write them all into a folder, which is searched first."""
    sky_picture(folder / "sunset.hdr")
    for name in ("flower.hdr", "vase.hdr"):
        flower_picture(folder / name)
    (folder / "test.txt").write_text("Light is\nwhat we see\nby.\n")
    sp.Blind(width=1.1, tilt_deg=20.0, scattered=0.1).write(folder / "blinds20c.xml")
    (folder / "mesh.mat").write_text("void plastic cloth 0 0 5 .4 .2 .5 .03 .1\n")
    for name, scale, up in (("vase", 40.0, 1), ("woman", 0.25, 1)):
        (folder / f"{name}.obj").write_text(turned_body(scale, up))
        mesh = radiance.run("obj2mesh", "-a", "mesh.mat", f"{name}.obj", folder=folder)
        (folder / f"{name}.rtm").write_bytes(mesh)
    (folder / "car.rad").write_text(CAR)
    (folder / "porsche.octf").write_bytes(radiance.run("oconv", "-f", "car.rad", folder=folder))


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
