"""The figure of `docs/generate.md`: what goes straight through products, traced and in closed form; a blind's exits.

usage: python validation/generate_figure.py      (seconds; writes docs/pictures/generate.png)
"""

import tempfile
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np

import sunpeak as sp
from sunpeak.periodic import Screen, Sheet, Slats

TARGET = Path(__file__).parents[1] / "docs" / "pictures" / "generate.png"

RAYS = 1 << 14
PRODUCTS = (("slats, tilted by 30°", Slats()), ("sheet, 38 % open", Sheet()), ("screen of yarns, 16 % open", Screen()))
EXIT_RAYS, RESOLUTION = 1 << 14, 300
INCIDENCE_DEG = 45.0


def loaded(product: Slats | Sheet | Screen, folder: Path) -> sp.World:
    """The product's geometry, compiled."""
    path = folder / "product.rad"
    path.write_text(product.radiance(), encoding="utf-8")
    return sp.World.compile(sp.Scene.load([path]))


def profiles(axes: plt.Axes, folder: Path) -> None:
    """Through transmittance in the plane of y: lines in closed form, points traced."""
    fine, coarse = np.linspace(-89, 89, 357), np.linspace(-85, 85, 35)
    for name, product in PRODUCTS:
        directions = [np.column_stack([0 * a, np.sin(a), np.cos(a)]) for a in (np.radians(fine), np.radians(coarse))]
        axes.plot(fine, product.through(directions[0]), lw=1, label=name)
        traced = sp.straight_transmittance(
            loaded(product, folder), directions[1], box=product.box, periodic=True, samples=RAYS
        )
        axes.plot(coarse, traced.through, "o", ms=3, color=axes.lines[-1].get_color())
    axes.set_xlabel("incidence in the plane of y [deg], rising if positive")
    axes.set_ylabel("through transmittance")
    axes.set_title("Straight through: closed forms (lines), traced (points)", fontsize=9)
    axes.legend(fontsize=8)


def exits(axes: plt.Axes, folder: Path) -> None:
    """Where light leaves slats, by the table's cells."""
    slats = Slats()
    made = sp.generate_bsdf(loaded(slats, folder), "klems", box=slats.box, periodic=True, samples=EXIT_RAYS, error=1.0)
    x = np.linspace(-1, 1, RESOLUTION)
    grid = np.stack(np.meshgrid(x, x), axis=-1).reshape(-1, 2)
    inside = (grid**2).sum(1) < 1
    w_out = np.column_stack([grid[inside], np.sqrt(1 - (grid[inside] ** 2).sum(1))])
    angle = np.radians(INCIDENCE_DEG)
    # Light that falls from outside: the side of the traced ray is opposite to where it runs.
    w_in = np.array([0.0, np.sin(angle), -np.cos(angle)])
    values = np.full(len(grid), np.nan)
    values[inside] = made.bsdf.evaluate(w_in, w_out, residual=True)
    picture = axes.imshow(values.reshape(RESOLUTION, -1), origin="lower", extent=(-1, 1, -1, 1), cmap="viridis")
    axes.figure.colorbar(picture, ax=axes, label="scattered BTDF [1/sr]", shrink=0.8)
    axes.set_title(f"Slats, light falling at {INCIDENCE_DEG:g}°: scattered into the room", fontsize=9)
    axes.set_xlabel("x of the exit")
    axes.set_ylabel("y, up")


def main() -> None:
    """Draw both."""
    figure, (left, right) = plt.subplots(1, 2, figsize=(10, 4), layout="constrained")
    with tempfile.TemporaryDirectory() as folder:
        profiles(left, Path(folder))
        exits(right, Path(folder))
    figure.savefig(TARGET, dpi=110)


if __name__ == "__main__":
    main()
