"""Compute the converged reference of `tests/parity/test_room.py` with Radiance, and write it beside that test.

usage: python validation/room_reference.py [AMBIENT_RAYS]      (a quarter of an hour on two cores)
"""

import json
import sys
import tempfile
from pathlib import Path

import numpy as np
import pyradiance

ROOT = Path(__file__).resolve().parents[1]
sys.path[:0] = [str(ROOT / "tests"), str(ROOT / "tests/parity")]

from test_room import FILES, REFERENCE_FILE, choose_sensors, reference_options, sky_without_penumbra  # noqa: E402

from conftest import SHARED, Radiance, luminance  # noqa: E402


def main() -> None:
    """Run `rtrace` without cache and without truncation."""
    rays = int(sys.argv[1]) if len(sys.argv) > 1 else 262_144
    package = Path(pyradiance.__file__).parent
    radiance = Radiance(package / "bin", package / "lib")
    folder = SHARED / "data/scenes/frads-room"
    sensors = choose_sensors(folder)
    with tempfile.TemporaryDirectory() as temporary:
        sky = Path(temporary, "sky.rad")
        sky.write_text(sky_without_penumbra())
        octree = radiance.octree(Path(temporary, "room.oct"), *FILES, sky, folder=folder)
        lux = luminance(radiance.rtrace(octree, sensors, *reference_options(rays), folder=folder))
    content = {
        "made_by": f"rtrace {' '.join(reference_options(rays))} (pyradiance {pyradiance.__version__})",
        "sensors": sensors.tolist(),
        "illuminance_lux": np.round(lux, 2).tolist(),
    }
    REFERENCE_FILE.write_text(json.dumps(content, indent=1) + "\n")


if __name__ == "__main__":
    main()
