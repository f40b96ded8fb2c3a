"""A compiled scene, and what rays meet in it."""

from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from sunpeak import _core
from sunpeak.compat.octree import Octree
from sunpeak.compat.quality import Quality

Floats = npt.NDArray[np.float64]


class First(NamedTuple):
    """What rays meet first."""

    distance: Floats
    """(n,) [m], infinity where nothing is met but a source."""
    point: Floats
    """(n, 3), NaN where there is none."""
    normal: Floats
    """Of the front, as a mesh smooths it (n, 3)."""
    flat_normal: Floats
    """The same without smoothing (n, 3)."""
    bent_normal: Floats
    """As textures and smoothing bend it (n, 3)."""
    local: Floats
    """Local coordinates of a mesh, and 0 (n, 3)."""
    surface: npt.NDArray[np.int64]
    """Index (n,), -1 where nothing is met."""


class CompiledScene:
    """A scene ready for rays."""

    def __init__(self, octree: Octree, peak: str) -> None:
        """Read and compile the scene of an octree."""
        self.scene = octree.scene()
        self.world = _core.World.compile(self.scene, peak)

    def first(self, origins: Floats, directions: Floats) -> First:
        """Say what rays meet first."""
        distance, point, (normal, flat, bent), local, surface = self.world.first_surfaces(origins, directions)
        return First(distance, point, normal, flat, bent, local, surface)

    def radiance(self, origins: Floats, directions: Floats, quality: Quality) -> Floats:
        """Radiance along rays (n, 3) [W sr⁻¹ m⁻²]."""
        return self._trace(origins, directions, quality, irradiance=False)

    def irradiance(self, points: Floats, normals: Floats, quality: Quality) -> Floats:
        """Irradiance of sensors (n, 3) [W m⁻²]."""
        return self._trace(points, normals, quality, irradiance=True)

    def irradiance_of_surfaces(self, origins: Floats, directions: Floats, quality: Quality) -> Floats:
        """Irradiance on what rays meet, on the side that they meet; radiance where that shines or is nothing (`-i`)."""
        first = self.first(origins, directions)
        shines = np.array([label[3] for label in self.scene.surface_labels()] + [True])
        is_lit = ~shines[first.surface]
        values = np.zeros((len(origins), 3))
        towards = np.where((first.normal * directions).sum(axis=1, keepdims=True) > 0, -first.normal, first.normal)
        if is_lit.any():
            values[is_lit] = self.irradiance(first.point[is_lit], towards[is_lit], quality)
        if not is_lit.all():
            values[~is_lit] = self.radiance(origins[~is_lit], directions[~is_lit], quality)
        return values

    def _trace(self, origins: Floats, directions: Floats, quality: Quality, irradiance: bool) -> Floats:
        if len(origins) == 0:
            return np.zeros((0, 3))
        q = quality
        values, _ = _core.trace(
            self.world, np.ascontiguousarray(origins), np.ascontiguousarray(directions), irradiance, q.samples, q.time,
            q.error, q.seed, q.threads, q.max_bounces, q.ambient, q.error_of_each, None,
        )  # fmt: skip
        return values
