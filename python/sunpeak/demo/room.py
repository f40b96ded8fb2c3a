"""The room of the demo: a box whose south side is glazed from wall to wall, with a fabric inside the glass.

World axes are Radiance's: x east, y north, z up, in metres. The facade lies in the plane y = 0, the room north of it.
"""

from sunpeak.rooms import Glazing, Room
from sunpeak.rooms.surfaces import box, glass, inside, panes, plastic, polygon, upright
from sunpeak.skies import SunPosition

X_M = (-2.0, 2.0)
DEPTH_M = 6.0
HEIGHT_M = 3.0

PANES_Y_M = (-0.05, -0.07)
"""Two panes of clear glass outside the fabric."""

GLAZING = Glazing(panes=len(PANES_Y_M), transmissivity=0.96)
"""With the reflections at its faces a pane transmits 0.88 at normal incidence, as clear float glass."""


def room_text() -> str:
    """Write walls, ceiling, floor, a table, the panes, and a neighbour to see through the fabric, away from the sun."""
    parts = [
        "# A box room whose south side is glazed from wall to wall\n\n",
        plastic("wall", 0.5, 0.5, 0.5),
        plastic("ceiling", 0.8, 0.8, 0.8),
        plastic("floor", 0.2, 0.2, 0.2),
        plastic("table_top", 0.4, 0.33, 0.25),
        plastic("plaster", 0.45, 0.4, 0.36),
        glass("clear_glass", GLAZING.transmissivity),
        inside(X_M, (min(PANES_Y_M) - 0.01, DEPTH_M), HEIGHT_M),
        polygon("table_top", "table", (-0.8, 0.5, 0.74), (0.8, 0.5, 0.74), (0.8, 1.3, 0.74), (-0.8, 1.3, 0.74)),
        box("plaster", "neighbour", (3, -34, -0.5), (12, -26, 10.5)),
        panes(PANES_Y_M, X_M, (0, HEIGHT_M)),
    ]
    return "".join(parts)


DEMO_ROOM = Room(
    text=room_text(),
    shade=upright("fabric", "shade", 0.0, X_M, (0, HEIGHT_M)),
    glazing=GLAZING,
    extent_m=40.0,
    # Seen through the fabric at 35.4 degrees from its normal: 52 % of the cut-off angle.
    sun=SunPosition(altitude_deg=32.0, azimuth_deg=196.0),
    # A hazy day.
    direct_normal_w_m2=280.0,
    diffuse_horizontal_w_m2=150.0,
    # A seated person, two metres from the facade, who looks straight at it.
    eye_m=(0.0, 2.0, 1.2),
    sight=(0.0, -1.0, 0.0),
)
