"""What an instrumented build is exercised with, so that the final one is laid out for it (`make wheel`).

usage: profile_training.py

Pictures and sensors in the demo's room and in the example's office, with tables of either kind, without and with peak
extraction, behind glass or a blind: what rendering spends its time with. Of the benchmarks' rooms the
demo's is among them, and the office, there behind slats.
"""

import tempfile
from pathlib import Path

import sunpeak as sp
from sunpeak.demo import DEMO_ROOM

OFFICE = Path(__file__).parents[1] / "examples" / "office"
SIZE = (128, 128)

FURNITURE = """
void plastic lacquer 0 0 5 .5 .35 .2 .03 .08
void metal steel 0 0 5 .6 .6 .6 .8 .15
void light tube 0 0 3 40 40 38
!genbox lacquer top 1.6 .8 .03 | xform -t 1 1 .72
!genbox steel leg .04 .04 .72 | xform -a 2 -t 1.5 0 0 -t 1 1.4 0
!genbox lacquer shelf 1.2 .35 .02 | xform -a 6 -t 0 0 .35 -t 2.2 4.6 .1
!genbox lacquer seat .45 .45 .05 | xform -t 1.6 2 .45
!genbox lacquer back .45 .04 .5 | xform -t 1.6 2.45 .5
steel sphere globe 0 0 4 1.8 1.3 .9 .14
tube polygon lamp 0 0 12 1.5 2 2.6 1.5 3.2 2.6 1.7 3.2 2.6 1.7 2 2.6
"""

SKIES = (
    sp.Sky.perez(sp.SunPosition(35.0, 185.0), direct_normal_w_m2=600, diffuse_horizontal_w_m2=120),
    sp.Sky.perez(sp.SunPosition(20.0, 220.0), direct_normal_w_m2=60, diffuse_horizontal_w_m2=150),
)


def office(folder: Path, sky: sp.Sky, basis: str | None) -> sp.Scene:
    """The furnished office, with a blind of this basis or none."""
    (folder / "sky.rad").write_text(sky.to_radiance())
    (folder / "furniture.rad").write_text(FURNITURE)
    files = [OFFICE / "room.rad", folder / "furniture.rad", folder / "sky.rad"]
    if basis is not None:
        sp.Fabric(openness=0.03, scattered=0.05, reflectance=0.3).write(folder / "shade.xml", basis)
        files.append(OFFICE / "shade.rad")
    return sp.Scene.load(files, search_path=[folder])


def exercise(world: sp.World, eye: sp.View, samples: int) -> None:
    """A picture, its glare, and sensors on a desk."""
    picture = sp.render(world, eye, SIZE, samples=samples)
    sp.glare(picture)
    desk = [[0.5 + 0.2 * i, 2.0, 0.75] for i in range(8)]
    sp.trace(world, desk, [[0.0, 0.0, 1.0]] * len(desk), irradiance=True, samples=256)


def main() -> None:
    """Rooms with glass count most: most rooms have it."""
    with tempfile.TemporaryDirectory() as temporary:
        folder = Path(temporary)
        eye = sp.View.load(OFFICE / "desk.vf")
        for sky in SKIES:
            exercise(sp.World.compile(office(folder, sky, None)), eye, 12)
            for basis in ("klems", "t3-1024"):
                exercise(sp.World.compile(office(folder, sky, basis)), eye, 6)
        files = DEMO_ROOM.write(folder)
        eye = sp.View.load(folder / "eye.vf")
        for basis in ("klems", "t3-1024"):
            scene = sp.Scene.load([*files, DEMO_ROOM.hang(folder, basis)])
            for peak in ("off", "split"):
                exercise(sp.World.compile(scene, peak), eye, 6)


if __name__ == "__main__":
    main()
