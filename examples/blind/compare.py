"""The office behind a venetian blind: its slats alone, its BSDF alone, and the BSDF as a proxy for the slats.

usage: python compare.py        (writes blind.xml, flat.rad, sky.rad and three pictures beside itself)

The slats are level. Alone, the light that they scatter has to find its way between them (Ev at the desk 7.8 klx, DGP
0.66). With the BSDF alone one sees a veil where they are, and the sun's stripes are smeared over the floor (8.6 klx,
0.70). With the proxy one sees slats, and they throw their shadows, but what they scatter into the room comes from the
table (8.1 klx, 0.67).
"""

from pathlib import Path

import sunpeak as sp

HERE = Path(__file__).parent
OFFICE = HERE.parent / "office"

# A table in the place of the slats: the same polygon, without thickness.
FLAT = """
void BSDF blind
6 0 blind.xml 0 0 1 .
0
0
blind polygon inside
0
0
12 0.3 0.055 0.9  0.3 0.055 2.5  3.3 0.055 2.5  3.3 0.055 0.9
"""


def main() -> None:
    """Render and judge all three."""
    sp.Blind(width=1.0, tilt_deg=0.0, scattered=0.25).write(HERE / "blind.xml")
    sky = sp.Sky.perez((35.0, 190.0), direct_normal_w_m2=600, diffuse_horizontal_w_m2=110)
    (HERE / "sky.rad").write_text(sky.to_radiance())
    (HERE / "flat.rad").write_text(FLAT)
    room = [OFFICE / "room.rad", HERE / "sky.rad"]
    variants = {"slats": ["slats.rad"], "flat": ["flat.rad"], "proxy": ["slats.rad", "proxy.rad"]}
    view = sp.View.load(OFFICE / "desk.vf")
    for name, files in variants.items():
        scene = sp.Scene.load([*room, *(HERE / file for file in files)])
        picture = sp.render(scene, view, size=(400, 400), samples=16, progress=True)
        picture.save(HERE / f"blind_{name}.hdr")
        report = sp.glare(picture)
        print(f"{name:>5}: Ev {report.ev_lux:.0f} lx, DGP {report.dgp:.3f} ({report.glare_class})")


if __name__ == "__main__":
    main()
