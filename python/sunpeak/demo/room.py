"""The room of the demo: a box whose south side is glazed from wall to wall, with a fabric inside the glass.

World axes are Radiance's: x east, y north, z up, in metres. The facade lies in the plane y = 0, the room north of it.
"""

from pathlib import Path

from sunpeak.skies import Sky, SunPosition

WIDTH_M = 4.0
DEPTH_M = 6.0
HEIGHT_M = 3.0

EYE_M = (0.0, 2.0, 1.2)
"""A seated person, two metres from the facade, who looks straight at it."""

VIEW = f"rvu -vta -vp {EYE_M[0]} {EYE_M[1]} {EYE_M[2]} -vd 0 -1 0 -vu 0 0 1 -vh 180 -vv 180"
"""180-degree equidistant fisheye."""

SUN = SunPosition(altitude_deg=32.0, azimuth_deg=196.0)
"""Seen through the fabric at 35.4 degrees from its normal: 52 % of the cut-off angle."""

DIRECT_NORMAL_W_M2 = 280.0
DIFFUSE_HORIZONTAL_W_M2 = 150.0
"""A hazy day: with the fabric's 2 % openness the eye receives some 400 lx, as in the paper's example."""

NEIGHBOUR_M = (3.0, -34.0)
"""South-east of the room, away from the sun: something to see through the fabric."""

PANES_Y_M = (-0.05, -0.07)
"""Two panes of clear glass outside the fabric."""

PANE_TRANSMISSIVITY = 0.96
"""Of one crossing of a pane: with the reflections at its faces 0.88 at normal incidence, a clear float glass."""

MATERIALS = f"""\
void plastic wall
0
0
5 0.5 0.5 0.5 0 0

void plastic ceiling
0
0
5 0.8 0.8 0.8 0 0

void plastic floor
0
0
5 0.2 0.2 0.2 0 0

void plastic table_top
0
0
5 0.4 0.33 0.25 0 0

void plastic plaster
0
0
5 0.45 0.4 0.36 0 0

void glass clear_glass
0
0
3 {PANE_TRANSMISSIVITY} {PANE_TRANSMISSIVITY} {PANE_TRANSMISSIVITY}
"""

Point = tuple[float, float, float]


def polygon(material: str, name: str, *corners: Point) -> str:
    """Radiance text of a polygon; its front is where the corners turn counter-clockwise."""
    numbers = "\n".join(f"    {x:g} {y:g} {z:g}" for x, y, z in corners)
    return f"\n{material} polygon {name}\n0\n0\n{3 * len(corners)}\n{numbers}\n"


def room_text() -> str:
    """Write walls, ceiling, floor, a table and the panes; all polygons but the panes face the inside."""
    x0, x1 = -WIDTH_M / 2, WIDTH_M / 2
    y0, y1 = min(PANES_Y_M) - 0.01, DEPTH_M
    z1 = HEIGHT_M
    parts = [
        "# A box room whose south side is glazed from wall to wall\n\n",
        MATERIALS,
        polygon("floor", "floor_1", (x0, y0, 0), (x1, y0, 0), (x1, y1, 0), (x0, y1, 0)),
        polygon("ceiling", "ceiling_1", (x0, y0, z1), (x0, y1, z1), (x1, y1, z1), (x1, y0, z1)),
        polygon("wall", "west", (x0, y0, 0), (x0, y1, 0), (x0, y1, z1), (x0, y0, z1)),
        polygon("wall", "east", (x1, y0, 0), (x1, y0, z1), (x1, y1, z1), (x1, y1, 0)),
        polygon("wall", "north", (x0, y1, 0), (x1, y1, 0), (x1, y1, z1), (x0, y1, z1)),
        polygon("table_top", "table", (-0.8, 0.5, 0.74), (0.8, 0.5, 0.74), (0.8, 1.3, 0.74), (-0.8, 1.3, 0.74)),
    ]
    parts.append(f"\n!genbox plaster neighbour 9 8 11 | xform -t {NEIGHBOUR_M[0]:g} {NEIGHBOUR_M[1]:g} -0.5\n")
    parts += [facade("clear_glass", f"pane_{number}", y) for number, y in enumerate(PANES_Y_M, start=1)]
    return "".join(parts)


def facade(material: str, name: str, y: float) -> str:
    """Write a sheet from wall to wall; it faces the room."""
    x0, x1 = -WIDTH_M / 2, WIDTH_M / 2
    return polygon(material, name, (x1, y, 0), (x0, y, 0), (x0, y, HEIGHT_M), (x1, y, HEIGHT_M))


def fabric_text(bsdf_file: Path) -> str:
    """Write the fabric over the whole facade, inside the glass."""
    return f"void aBSDF fabric\n5 {bsdf_file.name} 0 0 1 .\n0\n0\n" + facade("fabric", "shade", 0.0)


def sky() -> Sky:
    """Make the Perez sky of the demo."""
    return Sky.perez(SUN, DIRECT_NORMAL_W_M2, DIFFUSE_HORIZONTAL_W_M2)
