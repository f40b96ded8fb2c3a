"""All problems of scene files at once."""

import os
from collections.abc import Iterable
from dataclasses import dataclass
from os import PathLike

from sunpeak import _core
from sunpeak.rad_input import scene_files
from sunpeak.scenes import StrPath, strings


@dataclass(frozen=True)
class SceneCheck:
    """What is wrong with scene files; each message begins with file, line and column."""

    errors: list[str]
    """Mistakes: the scene cannot be rendered."""
    warnings: list[str]
    """Oddities: what is left out, put right or used by nothing."""
    surfaces: int
    """How many could be read."""


def check_scene(
    files: StrPath | Iterable[StrPath], *, search_path: Iterable[StrPath] = (), allow_commands: bool = False
) -> SceneCheck:
    """Read scene files to their end, as `Scene.load` does, and gather all mistakes; then load what materials name."""
    names = [files] if isinstance(files, str | PathLike) else list(files)
    paths = scene_files(os.fspath(name) for name in names)
    scene, errors, warnings = _core.Scene.check(paths, strings(search_path), allow_commands)
    if not errors:
        try:
            _core.World.compile(scene, "split")
        except (_core.InputError, OSError) as error:
            errors = [str(error)]
    return SceneCheck(errors, warnings, len(scene.surface_names))
