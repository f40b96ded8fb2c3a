"""The compiled core: arrays are (n, 3) float64 and contiguous; the classes of `sunpeak` say the rest."""

from collections.abc import Callable
from os import PathLike
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

__version__: str

_Floats = npt.NDArray[np.float64]

class InputError(ValueError):
    """The input is wrong: the message says where (file:line:column), what was found, what was expected."""

class Bsdf:
    @staticmethod
    def load(
        path: str | PathLike[str], instrument_fwhm_deg: float | None = None, find_instrument: bool = False
    ) -> Bsdf: ...
    def evaluate(self, w_in: _Floats, w_out: _Floats, colour: bool, residual: bool) -> _Floats: ...
    def through(self, w_in: _Floats, peak: str, colour: bool) -> _Floats: ...
    def hemispherical(self, w_in: _Floats, mode: str, colour: bool, residual: bool) -> _Floats: ...
    def sample(
        self, w_in: _Floats, u: _Floats, peak: str
    ) -> tuple[_Floats, _Floats, _Floats, npt.NDArray[np.bool_]]: ...
    def describe(self) -> dict[str, Any]: ...
    def peak_evidence(self, w_in: _Floats) -> _Floats: ...
    def pdf(self, w_in: _Floats, w_out: _Floats, peak: str) -> _Floats: ...

def synthetic_bsdf(
    kind: str,
    numbers: dict[str, float],
    basis: str,
    rays: int | None,
    value_noise: float,
    fwhm_deg: float,
    seed: int,
) -> Bsdf: ...
def synthetic_through(kind: str, numbers: dict[str, float], w_in: _Floats) -> _Floats: ...
def bsdf_xml(bsdf: Bsdf) -> str: ...
def bsdf_report(bsdf: Bsdf) -> dict[str, Any]: ...
def save_split(bsdf: Bsdf, folder: str | PathLike[str]) -> list[Path]: ...
def exit_cells(
    bsdf: Bsdf, w_in: _Floats, mode_name: str, edge_points: int
) -> tuple[_Floats, _Floats, npt.NDArray[np.bool_]]: ...
def incident_cells(bsdf: Bsdf, front: bool, edge_points: int) -> tuple[_Floats, dict[str, _Floats]]: ...
def through_interval(bsdf: Bsdf, w_in: _Floats) -> _Floats: ...
def probe_directions(bsdf: Bsdf, w_in: _Floats) -> _Floats: ...

class Sky:
    @staticmethod
    def perez(
        sun_altitude_deg: float,
        sun_azimuth_deg: float,
        direct_normal_w_m2: float,
        diffuse_horizontal_w_m2: float,
        day_of_year: int,
        ground_reflectance: float,
        dew_point_c: float | None,
    ) -> Sky: ...
    @staticmethod
    def cie(
        kind: str,
        sun_altitude_deg: float,
        sun_azimuth_deg: float,
        with_sun: bool,
        turbidity: float | None,
        diffuse_horizontal_w_m2: float | None,
        direct_normal_w_m2: float | None,
        ground_reflectance: float,
    ) -> Sky: ...
    def to_radiance(self) -> str: ...
    @property
    def sun(self) -> tuple[list[float], list[float], float] | None: ...
    @property
    def direct_normal_lux(self) -> float: ...
    @property
    def diffuse_horizontal_lux(self) -> float: ...
    def brightness(self, direction: tuple[float, float, float]) -> float: ...

class Scene:
    @staticmethod
    def load(files: list[str], search_path: list[str], allow_commands: bool) -> Scene: ...
    @staticmethod
    def parse(text: str, name: str, search_path: list[str], allow_commands: bool) -> Scene: ...
    @property
    def surface_names(self) -> list[str]: ...
    @property
    def modifier_names(self) -> list[str]: ...
    @property
    def warnings(self) -> list[str]: ...

class View:
    @staticmethod
    def load(path: str | PathLike[str]) -> View: ...
    @staticmethod
    def parse(options: str) -> View: ...
    def options(self) -> str: ...
    def fields(self) -> dict[str, Any]: ...
    def fit_size(self, max_width: int, max_height: int) -> tuple[int, int]: ...
    def rays(self, width: int, height: int) -> tuple[_Floats, _Floats]: ...
    def solid_angles(self, width: int, height: int) -> _Floats: ...
    def project(self, towards: _Floats) -> tuple[_Floats, _Floats]: ...

class Picture:
    @staticmethod
    def load(path: str | PathLike[str]) -> Picture: ...
    @staticmethod
    def from_pixels(
        pixels: npt.NDArray[np.float32], view: View | None, header: list[str], sources: _Floats
    ) -> Picture: ...
    def save(self, path: str | PathLike[str]) -> None: ...
    @property
    def shape(self) -> tuple[int, int]: ...
    def pixels(self) -> npt.NDArray[np.float32]: ...
    def luminance(self) -> _Floats: ...
    @property
    def view(self) -> View | None: ...
    @property
    def header(self) -> list[str]: ...
    def sources(self) -> _Floats: ...

def glare(
    picture: Picture,
    threshold: float,
    threshold_kind: str,
    task: tuple[tuple[float, float, float], float] | None,
    search_angle_rad: float,
    peak_cd_m2: float | None,
    ev_lux: float | None,
    low_light: bool,
    below_sight: str,
    relative_error: float,
) -> dict[str, Any]: ...
def fabric_xml(
    basis: str,
    openness: float,
    cutoff_deg: float,
    exponent: float,
    scattered: float,
    lobe_share: float,
    lobe_sigma: float,
    reflectance: float,
) -> str: ...

class World:
    @staticmethod
    def compile(scene: Scene, peak: str) -> World: ...

def render(
    world: World,
    view: View,
    width: int,
    height: int,
    samples: int | None,
    time_s: float | None,
    error: float | None,
    seed: int,
    threads: int | None,
    max_bounces: int | None,
    progress: Callable[[int, int], None] | None,
) -> Picture: ...
def trace(
    world: World,
    origins: _Floats,
    directions: _Floats,
    irradiance: bool,
    samples: int | None,
    time_s: float | None,
    error: float | None,
    seed: int,
    threads: int | None,
    max_bounces: int | None,
    progress: Callable[[int, int], None] | None,
) -> _Floats: ...
