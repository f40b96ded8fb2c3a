"""The office behind its blind at noon in February, without and with peak extraction.

usage: python compare.py        (writes shade.xml and two pictures beside itself)
"""

from datetime import datetime
from pathlib import Path

import sunpeak as sp

HERE = Path(__file__).parent


def main() -> None:
    """Render and judge both pictures."""
    sp.Fabric(openness=0.03, scattered=0.03, reflectance=0.2).write(HERE / "shade.xml", "t3-4096")
    noon = datetime.fromisoformat("2024-02-10T12:30+01:00")
    sun = sp.sun_position(sp.Place(latitude_deg=47.3, longitude_deg=11.4), noon)
    (HERE / "sky.rad").write_text(sp.Sky.perez(sun, direct_normal_w_m2=500, diffuse_horizontal_w_m2=110).to_radiance())

    scene = sp.Scene.load([HERE / name for name in ("room.rad", "sky.rad", "shade.rad")])
    view = sp.View.load(HERE / "desk.vf")
    for peak in ("off", "split"):
        picture = sp.render(scene, view, size=(400, 400), peak=peak, samples=16, progress=True)
        picture.save(HERE / f"office_{peak}.hdr")
        report = sp.glare(picture)
        print(f"peak {peak:>5}: Ev {report.ev_lux:.0f} lx, DGP {report.dgp:.3f} ({report.glare_class})")


if __name__ == "__main__":
    main()
