"""The programs of Radiance, where pyradiance is installed; Sunpeak never needs them."""

import importlib.util
import os
import subprocess
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Self


class RadianceError(OSError):
    """A program of Radiance ended with an error."""


@dataclass(frozen=True)
class Radiance:
    """Where the programs and their library are."""

    programs: Path
    library: Path

    @classmethod
    def find(cls) -> Self | None:
        """Look for pyradiance."""
        found = importlib.util.find_spec("pyradiance")
        root = Path(found.origin).parent if found and found.origin else None
        return None if root is None else cls(root / "bin", root / "lib")

    def start(self, *command: object, folder: Path | None = None) -> "subprocess.Popen[bytes]":
        """Start a program; what it prints and its messages are to be read from it."""
        path = os.environ.get("PATH", "")
        env = os.environ | {"PATH": f"{self.programs}:{path}", "RAYPATH": f".:{self.library}"}
        words = [str(part) for part in command]
        # By its place: the search goes by our own PATH, not by that of the program.
        words[0] = str(self.programs / words[0])
        pipe = subprocess.PIPE
        return subprocess.Popen(words, stdin=pipe, stdout=pipe, stderr=pipe, env=env, cwd=folder)

    def run(self, *command: object, data: str = "", folder: Path | None = None) -> bytes:
        """What a program prints."""
        [answer] = self.run_together([command], data=data, folder=folder)
        return answer

    def run_together(
        self, commands: Sequence[tuple[object, ...]], *, data: str = "", folder: Path | None = None
    ) -> list[bytes]:
        """What programs print that run at the same time, all with the same input; none outlives this call."""
        started = [self.start(*command, folder=folder) for command in commands]
        try:
            answers = [process.communicate(data.encode()) for process in started]
        finally:
            for process in started:
                process.kill()
                process.wait()
        for command, process, (_, said) in zip(commands, started, answers, strict=True):
            if process.returncode != 0:
                raise RadianceError(f"{command[0]}: {said.decode(errors='replace').strip()}")
        return [printed for printed, _ in answers]
