"""The rooms of the benchmark: each written into a folder, as scene files that both programs read."""

import os
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path

import sunpeak as sp
from sunpeak.demo import DEMO_ROOM
from sunpeak.rooms.surfaces import box, glass, inside, panes, plastic, upright

ROOT = Path(__file__).resolve().parents[2]
SHARED = Path(os.environ.get("SUNPEAK_SHARED", ROOT.parent / "shared"))

CLEAR_SKY = sp.Sky.perez((40.0, 200.0), direct_normal_w_m2=600, diffuse_horizontal_w_m2=110)


@dataclass(frozen=True)
class BenchRoom:
    """A room and how it is looked at."""

    name: str
    write: Callable[[Path], list[Path]]
    """Write it into a folder; give the scene files."""
    view: str
    peak: str = "split"
    """Our rule for the peaks of `aBSDF` materials."""
    rad_peak: str = "split"
    """The rule under which ours computes what Radiance does: its own where the room has a peak."""
    sun: tuple[float, float, float] | None = None
    """Where the eye sees the sun; blocks around it are left out."""
    files_in: Path | None = field(default=None)
    """Folder from which the scene's files are named, if not the one they are written into."""


def demo(basis: str, material: str) -> Callable[[Path], list[Path]]:
    """Write the demo's room with a fabric of this basis."""

    def write(folder: Path) -> list[Path]:
        return [*DEMO_ROOM.write(folder), DEMO_ROOM.hang(folder, basis, material)]  # type: ignore[arg-type]

    return write


def deep(folder: Path) -> list[Path]:
    """A room of 12 m depth, side-lit through clear glass."""
    text = "".join(
        [
            plastic("wall", 0.6, 0.6, 0.6),
            plastic("ceiling", 0.8, 0.8, 0.8),
            plastic("floor", 0.25, 0.22, 0.2),
            plastic("wood", 0.45, 0.35, 0.25),
            glass("clear_glass", 0.92),
            inside((-2.5, 2.5), (0.0, 12.0), 3.0),
            upright("wall", "parapet", 0.0, (-2.5, 2.5), (0, 0.9)),
            upright("wall", "lintel", 0.0, (-2.5, 2.5), (2.6, 3)),
            panes((0.0,), (-2.5, 2.5), (0.9, 2.6)),
            *(box("wood", f"desk_{n}", (-1.6, 2.0 + 3 * n, 0.7), (0.2, 2.8 + 3 * n, 0.74)) for n in range(3)),
        ]
    )
    return scene(folder, text)


def two_facades(folder: Path) -> list[Path]:
    """A corner room with a fabric before the windows to the south and to the west."""
    fabric = sp.Fabric()
    fabric.write(folder / "fabric.xml", "t3-1024")
    west = "\n{0} polygon {1}\n0\n0\n12 {2} 5.5 0.9 {2} 0.5 0.9 {2} 0.5 2.8 {2} 5.5 2.8\n"
    text = "".join(
        [
            plastic("wall", 0.6, 0.6, 0.6),
            plastic("ceiling", 0.8, 0.8, 0.8),
            plastic("floor", 0.25, 0.22, 0.2),
            glass("clear_glass", 0.92),
            "void aBSDF fabric\n5 fabric.xml 0 0 1 .\n0\n0\n",
            inside((-3.0, 3.0), (0.0, 6.0), 3.0).replace("wall polygon west", "void polygon west"),
            upright("wall", "parapet", 0.0, (-3, 3), (0, 0.9)),
            upright("wall", "lintel", 0.0, (-3, 3), (2.8, 3)),
            panes((-0.05,), (-3, 3), (0.9, 2.8)),
            upright("fabric", "south", 0.0, (-3, 3), (0.9, 2.8)),
            # The west wall with its hole, one polygon with a seam.
            "\nwall polygon west_wall\n0\n0\n30\n"
            "-3 0 0 -3 0 3 -3 6 3 -3 6 0 -3 0 0\n-3 .5 .9 -3 5.5 .9 -3 5.5 2.8 -3 .5 2.8 -3 .5 .9\n",
            west.format("clear_glass", "west_pane", -3.05),
            west.format("fabric", "west_fabric", -3),
        ]
    )
    return scene(folder, text)


def obstructed(folder: Path) -> list[Path]:
    """The demo's room with a house of five storeys eight metres before its window, hiding half of the sky."""
    files = [*DEMO_ROOM.write(folder), DEMO_ROOM.hang(folder, "t3-4096")]
    house = folder / "house.rad"
    house.write_text(plastic("brick", 0.35, 0.25, 0.2) + box("brick", "house", (-15, -16, -1), (1, -8, 9)))
    return [*files, house]


def office(variant: str) -> Callable[[Path], list[Path]]:
    """Write the office of the examples behind a venetian blind: its slats, or a table of them."""

    def write(folder: Path) -> list[Path]:
        for file in ("room.rad", "desk.vf"):
            (folder / file).write_text((ROOT / "examples/office" / file).read_text())
        for file in ("slats.rad", "slat.rad"):
            (folder / file).write_text((ROOT / "examples/blind" / file).read_text())
        sp.Blind(width=1.0, tilt_deg=0.0, scattered=0.25).write(folder / "blind.xml")
        (folder / "flat.rad").write_text(
            "void BSDF blind\n6 0 blind.xml 0 0 1 .\n0\n0\nblind polygon inside\n0\n0\n"
            "12 0.3 0.055 0.9  0.3 0.055 2.5  3.3 0.055 2.5  3.3 0.055 0.9\n"
        )
        sky = folder / "sky.rad"
        sky.write_text(CLEAR_SKY.to_radiance())
        return [folder / "room.rad", sky, folder / f"{variant}.rad"]

    return write


def frads(folder: Path) -> list[Path]:
    """Give the furnished office of the shared scenes, under a sky of ours."""
    room = SHARED / "data/scenes/frads-room"
    sky = folder / "sky.rad"
    sky.write_text(CLEAR_SKY.to_radiance())
    names = ("walls", "ceiling", "floor", "windowframe", "extwalls", "ground", "desks")
    return [
        room / "Objects/materials.mat",
        *(room / f"Objects/{n}.rad" for n in names),
        room / "Resources/ec60.rad",
        sky,
    ]


def scene(folder: Path, text: str) -> list[Path]:
    """Write a room and the clear sky."""
    files = [folder / "room.rad", folder / "sky.rad"]
    files[0].write_text(text)
    files[1].write_text(CLEAR_SKY.to_radiance())
    return files


def rooms() -> list[BenchRoom]:
    """Give all rooms."""
    eye, sun = DEMO_ROOM.view_options(), DEMO_ROOM.sun_direction
    clear = CLEAR_SKY.sun_direction
    fisheye = "-vta -vh 180 -vv 180 -vu 0 0 1"
    found = [
        BenchRoom("demo, t3, PE", demo("t3-4096", "aBSDF"), eye, rad_peak="radiance", sun=sun),
        BenchRoom("demo, Klems, PE", demo("klems", "aBSDF"), eye, rad_peak="radiance", sun=sun),
        BenchRoom("demo, t3", demo("t3-4096", "BSDF"), eye, "off", "off", sun=sun),
        BenchRoom("demo, Klems", demo("klems", "BSDF"), eye, "off", "off", sun=sun),
        BenchRoom("deep", deep, f"{fisheye} -vp 0 8 1.2 -vd 0.3 -1 0", sun=clear),
        BenchRoom("blind, table", office("flat"), f"{fisheye} -vp 1.8 3 1.2 -vd 0.2 -1 0", "off", "off", sun=clear),
        BenchRoom("blind, slats", office("slats"), f"{fisheye} -vp 1.8 3 1.2 -vd 0.2 -1 0", sun=clear),
        BenchRoom("two facades", two_facades, f"{fisheye} -vp 1 4 1.2 -vd -1 -1 0", rad_peak="radiance", sun=clear),
        BenchRoom("obstruction", obstructed, eye, rad_peak="radiance", sun=sun),
    ]
    room = SHARED / "data/scenes/frads-room"
    if room.exists():
        view = (room / "Resources/view1.vf").read_text().removeprefix("rvu").strip()
        furnished = BenchRoom("furnished", frads, view, rad_peak="radiance", sun=clear, files_in=room)
        found.append(furnished)
    return found
