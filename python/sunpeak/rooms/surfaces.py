"""Surfaces in Radiance's language."""

Point = tuple[float, float, float]


def plastic(name: str, red: float, green: float, blue: float) -> str:
    """Write a matt material by its reflectances."""
    return f"void plastic {name}\n0\n0\n5 {red:g} {green:g} {blue:g} 0 0\n\n"


def glass(name: str, transmissivity: float) -> str:
    """Write a clear glass by the transmissivity of one crossing."""
    return f"void glass {name}\n0\n0\n3 {transmissivity:g} {transmissivity:g} {transmissivity:g}\n\n"


def polygon(material: str, name: str, *corners: Point) -> str:
    """Write a polygon; its front is where the corners turn counter-clockwise."""
    numbers = "\n".join(f"    {x:g} {y:g} {z:g}" for x, y, z in corners)
    return f"\n{material} polygon {name}\n0\n0\n{3 * len(corners)}\n{numbers}\n"


def sphere(material: str, name: str, centre: Point, radius_m: float) -> str:
    """Write a sphere."""
    return f"\n{material} sphere {name}\n0\n0\n4 {centre[0]:g} {centre[1]:g} {centre[2]:g} {radius_m:g}\n"


def box(material: str, name: str, low: Point, high: Point) -> str:
    """Write a box by two of its corners."""
    size = " ".join(f"{b - a:g}" for a, b in zip(low, high, strict=True))
    return f"\n!genbox {material} {name} {size} | xform -t {low[0]:g} {low[1]:g} {low[2]:g}\n"


def upright(material: str, name: str, y: float, x: tuple[float, float], z: tuple[float, float]) -> str:
    """Write a rectangle of constant y, whose front faces north."""
    return polygon(material, name, (x[1], y, z[0]), (x[0], y, z[0]), (x[0], y, z[1]), (x[1], y, z[1]))


def panes(y_m: tuple[float, ...], x: tuple[float, float], z: tuple[float, float]) -> str:
    """Write panes of clear glass, one behind the other."""
    return "".join(upright("clear_glass", f"pane_{n}", y, x, z) for n, y in enumerate(y_m, start=1))


def inside(x: tuple[float, float], y: tuple[float, float], height_m: float) -> str:
    """Write floor, ceiling and the west, east and north walls of a room, which face its inside."""
    (x0, x1), (y0, y1), z1 = x, y, height_m
    parts = [
        polygon("floor", "floor_1", (x0, y0, 0), (x1, y0, 0), (x1, y1, 0), (x0, y1, 0)),
        polygon("ceiling", "ceiling_1", (x0, y0, z1), (x0, y1, z1), (x1, y1, z1), (x1, y0, z1)),
        polygon("wall", "west", (x0, y0, 0), (x0, y1, 0), (x0, y1, z1), (x0, y0, z1)),
        polygon("wall", "east", (x1, y0, 0), (x1, y0, z1), (x1, y1, z1), (x1, y1, 0)),
        polygon("wall", "north", (x0, y1, 0), (x1, y1, 0), (x1, y1, z1), (x0, y1, z1)),
    ]
    return "".join(parts)


def reveals(y: tuple[float, float], x: tuple[float, float], z: tuple[float, float]) -> str:
    """Write the four sides of an opening of the facade, black, so that no light comes in beside the panes.

    Their material is `black`: where a surface reflects, Radiance's ambient cache takes what it finds between glass and
    fabric for what is inside the room next to it.
    """
    (y0, y1), (x0, x1), (z0, z1) = y, x, z
    parts = [
        polygon("black", "reveal_west", (x0, y0, z0), (x0, y1, z0), (x0, y1, z1), (x0, y0, z1)),
        polygon("black", "reveal_east", (x1, y0, z0), (x1, y0, z1), (x1, y1, z1), (x1, y1, z0)),
        polygon("black", "reveal_below", (x0, y0, z0), (x1, y0, z0), (x1, y1, z0), (x0, y1, z0)),
        polygon("black", "reveal_above", (x0, y0, z1), (x0, y1, z1), (x1, y1, z1), (x1, y0, z1)),
    ]
    return "".join(parts)
