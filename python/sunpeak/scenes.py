"""Scenes and views, in Radiance's language."""

import os
from collections.abc import Iterable
from os import PathLike
from pathlib import Path
from typing import NamedTuple, Self

import numpy as np
import numpy.typing as npt

from sunpeak import _core
from sunpeak.rad_input import RadInput, is_rad_input, scene_files
from sunpeak.scattering import Floats, rows

StrPath = str | PathLike[str]


class Scene:
    """What scene files say: surfaces, sources and what they are made of. Immutable."""

    def __init__(self, core: _core.Scene) -> None:
        """Wrap the compiled scene; users call `load` or `parse`."""
        self._core = core

    @classmethod
    def load(
        cls, files: StrPath | Iterable[StrPath], *, search_path: Iterable[StrPath] = (), allow_commands: bool = False
    ) -> Self:
        """Read scene files, in order; a material serves the files after its own too.

        Files that a scene names (BSDFs, functions) are looked for in the current folder, beside the scene file, in
        `search_path` and in the folders of the environment variable RAYPATH. `!xform`, `!genbox`, `!gensky` and
        `!gendaylit` are done inside Sunpeak; other commands are refused by name unless `allow_commands`, and then run
        in a shell. A `.rif` file stands for the scene that it names (materials, illum, scene).

        Raises `InputError` with file, line and column, `OSError` for a file that cannot be read.
        """
        names = [files] if isinstance(files, str | PathLike) else list(files)
        return cls(
            _core.Scene.load(scene_files(os.fspath(name) for name in names), strings(search_path), allow_commands)
        )

    @classmethod
    def parse(
        cls,
        text: str,
        *,
        name: str = "text",
        search_path: Iterable[StrPath] = (),
        allow_commands: bool = False,
    ) -> Self:
        """Read a scene from a text, as `load` does; messages call it `name`."""
        return cls(_core.Scene.parse(text, name, strings(search_path), allow_commands))

    def to_mgf(self, offset: tuple[float, float, float] = (0.0, 0.0, 0.0)) -> str:
        """Geometry and materials in the Materials and Geometry Format, in the same units, moved by `offset`.

        Patterns and textures have no words there and are left out; lights are black. Raises `InputError` with file and
        line of a material that has none.
        """
        return self._core.to_mgf(offset)

    @property
    def surfaces(self) -> list[str]:
        """Names of the surfaces and sources, in file order."""
        return self._core.surface_names

    @property
    def modifiers(self) -> list[str]:
        """Names of the materials and patterns, in file order; a name may come again."""
        return self._core.modifier_names

    @property
    def warnings(self) -> list[str]:
        """What was tolerated, each with its place."""
        return self._core.warnings

    def __repr__(self) -> str:
        return f"<Scene of {len(self.surfaces)} surfaces and {len(self.modifiers)} modifiers>"


class Rays(NamedTuple):
    """One ray for each pixel."""

    origins: Floats
    """Points (h, w, 3) [m]."""
    directions: Floats
    """Unit vectors (h, w, 3); NaN where the view does not reach, as outside a fisheye's circle."""


class View:
    """How directions are laid on a picture: the view options of Radiance's `rpict`."""

    def __init__(self, core: _core.View) -> None:
        """Wrap the compiled view; users call `load` or `parse`."""
        self._core = core

    @classmethod
    def load(cls, path: StrPath) -> Self:
        """Read the view of a `.vf` file, of a picture's header, or the first one of a `.rif` file."""
        if is_rad_input(os.fspath(path)):
            return cls(_core.View.parse(" ".join(RadInput.load(os.fspath(path)).view())))
        return cls(_core.View.load(path))

    @classmethod
    def parse(cls, options: str) -> Self:
        """Read view options, as `-vta -vp 0 2 1.2 -vd 0 -1 0 -vh 180 -vv 180`; the rest is as in Radiance."""
        return cls(_core.View.parse(options))

    @classmethod
    def of(cls, text: str) -> Self:
        """Read options if the text has any, else a file of that name."""
        return cls.parse(text) if text.lstrip().startswith("-") else cls.load(Path(text))

    @property
    def kind(self) -> str:
        """Option of the projection, as `-vta`."""
        return str(self._core.fields()["kind"])

    @property
    def position(self) -> Floats:
        """The eye (3,) [m]."""
        return np.array(self._core.fields()["position"])

    @property
    def direction(self) -> Floats:
        """Where it looks (3,)."""
        return np.array(self._core.fields()["direction"])

    @property
    def up(self) -> Floats:
        """Up vector (3,)."""
        return np.array(self._core.fields()["up"])

    @property
    def size(self) -> tuple[float, float]:
        """`-vh` and `-vv`: degrees, or metres for a parallel view."""
        fields = self._core.fields()
        return float(fields["horizontal_deg"]), float(fields["vertical_deg"])

    def fit_size(self, max_width: int, max_height: int) -> tuple[int, int]:
        """Give the largest picture with square pixels inside these limits, as `rpict -x -y` makes it."""
        return self._core.fit_size(max_width, max_height)

    def rays(self, width: int, height: int) -> Rays:
        """Rays through the middles of the pixels, top row first."""
        return Rays(*self._core.rays(width, height))

    def solid_angles(self, width: int, height: int) -> Floats:
        """Solid angle of each pixel (h, w) [sr]; 0 where the view does not reach."""
        return self._core.solid_angles(width, height)

    def project(self, directions: npt.ArrayLike) -> Floats:
        """Say where directions (n, 3) fall on the picture (n, 2): x rightwards, y upwards, 0 to 1; NaN off the view."""
        return np.stack(self._core.project(rows(directions)), axis=1)

    def __str__(self) -> str:
        """All options, as in a picture's header."""
        return self._core.options()

    def __repr__(self) -> str:
        return f"<View {self}>"


def strings(paths: Iterable[StrPath]) -> list[str]:
    """Paths as text."""
    return [os.fspath(path) for path in paths]
