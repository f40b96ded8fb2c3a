"""Radiance's input files for `rad` (`.rif`): which files make a scene, and from where it is looked at."""

import glob
import re
import shlex
from collections.abc import Iterable
from dataclasses import dataclass, field
from pathlib import Path

from sunpeak._core import InputError

SUFFIX = ".rif"
SCENE_VARIABLES = ("mat", "ill", "sce")
"""What makes the scene, in `rad`'s order: materials, illum, scene; three letters of a name suffice."""
VIEWS = "vie"


@dataclass(frozen=True)
class RadInput:
    """What Sunpeak takes of such a file."""

    files: list[str]
    """Scene files and `!commands`, in order; relative to the current folder, as for `rad`."""
    views: dict[str, list[str]] = field(default_factory=dict)
    """View options by name, in the file's order."""

    @classmethod
    def load(cls, path: str | Path) -> "RadInput":
        """Read a file.

        What says how to render (QUALITY, RENDER, EXPOSURE …) is not taken. An `illum` file counts as it is, without
        `mkillum`.

        Raises `InputError` with file and line.
        """
        values: dict[str, list[str]] = {key: [] for key in SCENE_VARIABLES}
        views: dict[str, list[str]] = {}
        for number, line in logical_lines(Path(path).read_text(encoding="utf-8", errors="replace")):
            name, equals, value = line.partition("=")
            try:
                words = shlex.split(value)
            except ValueError as error:
                raise InputError(f"{path}:{number}: {error}: expected words, those with blanks in quotes") from error
            if not equals or not re.fullmatch(r"\s*\w+\s*", name):
                raise InputError(f"{path}:{number}: expected NAME= value, found {line.strip()!r}")
            key = name.strip().lower()[:3]
            if key in values:
                values[key] += words
            elif VIEWS.startswith(key) and words:
                label, options = (words[0], words[1:]) if not words[0].startswith("-") else (str(len(views) + 1), words)
                views[label] = options
        files = [file for key in SCENE_VARIABLES for word in values[key] for file in expanded(word)]
        if not files:
            raise InputError(f"{path}: no scene: expected scene= FILES, and materials= FILES before them")
        return cls(files, views)

    def view(self, name: str | None = None) -> list[str]:
        """Give the options of a view, the first without a name.

        Raises `InputError` where there is none.
        """
        if name is None and self.views:
            return next(iter(self.views.values()))
        if name not in self.views:
            raise InputError(f"no view {name or ''!r}: the file has {', '.join(self.views) or 'none'}")
        return self.views[name]


def logical_lines(text: str) -> Iterable[tuple[int, str]]:
    """Lines with their numbers, without comments; a backslash at the end joins the next one."""
    whole, start = "", 0
    for number, line in enumerate(text.splitlines(), start=1):
        start = start or number
        if whole == "" and line.lstrip().startswith("#"):
            start = 0
            continue
        whole += line.removesuffix("\\")
        if line.endswith("\\"):
            continue
        if whole.strip():
            yield start, whole
        whole, start = "", 0
    if whole.strip():
        yield start, whole


def expanded(word: str) -> list[str]:
    """Names that a word with wildcards stands for; the word itself without, or if it is a command."""
    is_pattern = not word.startswith("!") and glob.has_magic(word)
    return sorted(glob.glob(word)) if is_pattern else [word]  # noqa: PTH207 (it may be absolute)


def is_rad_input(name: str) -> bool:
    """Say whether a name is one of these files."""
    return not name.startswith("!") and name.endswith(SUFFIX)


def scene_files(names: Iterable[str]) -> list[str]:
    """Give scene files, those of `.rif` files in their place."""
    return [file for name in names for file in (RadInput.load(name).files if is_rad_input(name) else [name])]
