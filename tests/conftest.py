"""What the tests share: where foreign data is, how to ask Radiance, how to call the command line."""

import os
import subprocess
import sys
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import numpy.typing as npt
import pytest

ROOT = Path(__file__).resolve().parents[1]
SHARED = Path(os.environ.get("SUNPEAK_SHARED", ROOT.parent / "shared"))


@pytest.fixture(scope="session")
def shared() -> Path:
    """The folder `data` with real files of others, which do not belong to the project."""
    if not (SHARED / "data").is_dir():
        pytest.skip(f"no real files in {SHARED / 'data'}: set SUNPEAK_SHARED to the folder that holds data/")
    return SHARED / "data"


@dataclass(frozen=True)
class Radiance:
    """The programs of Radiance, from pyradiance."""

    programs: Path
    library: Path

    def run(self, *command: object, data: str | bytes = b"", folder: Path | None = None) -> bytes:
        """What a program prints."""
        env = os.environ | {"PATH": f"{self.programs}:{os.environ['PATH']}", "RAYPATH": f".:{self.library}"}
        given = data.encode() if isinstance(data, str) else data
        done = subprocess.run(
            [str(part) for part in command], input=given, env=env, cwd=folder, capture_output=True, check=False
        )
        assert done.returncode == 0, f"{command[0]}: {done.stderr.decode()}"
        return done.stdout

    def octree(self, target: Path, *files: Path | str, text: str = "", folder: Path | None = None) -> Path:
        """Compile scene files, and `text` after them."""
        target.write_bytes(self.run("oconv", "-w", *files, *(["-"] if text else []), data=text, folder=folder))
        return target

    def rtrace(
        self, octree: Path, rays: npt.ArrayLike, *options: str, folder: Path | None = None
    ) -> npt.NDArray[np.float64]:
        """Three channels for each row `x y z dx dy dz`."""
        lines = "\n".join(" ".join(f"{number:.9g}" for number in ray) for ray in np.asarray(rays)) + "\n"
        answer = self.run("rtrace", "-h", *options, octree, data=lines, folder=folder)
        return np.array([line.split() for line in answer.decode().splitlines()], dtype=np.float64)


@pytest.fixture(scope="session")
def radiance() -> Radiance:
    """Radiance as the oracle."""
    pyradiance = pytest.importorskip("pyradiance", reason="the oracle pyradiance is not installed")
    root = Path(pyradiance.__file__).parent
    return Radiance(root / "bin", root / "lib")


@dataclass(frozen=True)
class Answer:
    """How a run of the command line ended."""

    status: int
    out: str
    err: str


class CommandLine:
    """`sunpeak`, as users call it: another process."""

    def __call__(
        self, *arguments: object, data: str = "", folder: Path | None = None, expect: int | None = 0
    ) -> Answer:
        """Run it; `expect` is the exit status that the test needs (None: any)."""
        command = [sys.executable, "-m", "sunpeak", *map(str, arguments)]
        done = subprocess.run(command, input=data, cwd=folder, capture_output=True, text=True, check=False)
        answer = Answer(done.returncode, done.stdout, done.stderr)
        assert "Traceback" not in answer.err, answer.err
        assert expect is None or answer.status == expect, f"{answer.status} instead of {expect}: {answer.err}"
        return answer


@pytest.fixture(scope="session")
def sunpeak() -> CommandLine:
    """The command line."""
    return CommandLine()


def luminance(rgb: Sequence[float] | npt.NDArray[np.float64]) -> npt.NDArray[np.float64]:
    """Luminance [cd/m²] of three channels, with the numbers of Radiance's manual."""
    return 179.0 * (np.asarray(rgb) @ np.array([0.265, 0.670, 0.065]))
