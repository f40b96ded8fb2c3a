"""The compiled core: arrays are (n, 3) float64 and contiguous; the classes of `sunpeak` say the rest."""

from collections.abc import Callable, Sequence
from os import PathLike
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

__version__: str

_Floats = npt.NDArray[np.float64]
# A file or `!command`, or a name, a text and a folder.
_Part = str | PathLike[str] | tuple[str, bytes, str]

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

class Kept:
    def __init__(self, path: str | PathLike[str] | None = None) -> None: ...
    def save(self, path: str | PathLike[str]) -> bool: ...

def synthetic_bsdf(
    kind: str,
    numbers: dict[str, float],
    basis: str,
    rays: int | None,
    value_noise: float,
    fwhm_deg: float,
    seed: int,
    kept: Kept | None = None,
    progress: Callable[[int, int], None] | None = None,
) -> Bsdf: ...
def exact_bsdf(
    kind: str,
    numbers: dict[str, float],
    basis: str,
    kept: Kept | None = None,
    progress: Callable[[int, int], None] | None = None,
) -> Bsdf: ...
def synthetic_through(kind: str, numbers: dict[str, float], w_in: _Floats) -> _Floats: ...
def instrument_seen(bsdf: Bsdf, front: bool) -> float | None: ...
def bsdf_xml(
    bsdf: Bsdf,
    solar: Bsdf | None = None,
    name: str | None = None,
    manufacturer: str | None = None,
    thickness_m: float | None = None,
    comments: str | None = None,
) -> str: ...
def model_bsdf(
    kind: str,
    numbers: dict[str, float],
    basis: str,
    kept: Kept | None = None,
    progress: Callable[[int, int], None] | None = None,
) -> Bsdf: ...
def model_value(kind: str, numbers_in: dict[str, float], to_light: _Floats, leaving: _Floats) -> _Floats: ...

class Scan:
    def __init__(self, name: str, to_light: _Floats, exits: _Floats, values: _Floats) -> None: ...
    @property
    def name(self) -> str: ...
    @property
    def to_light(self) -> _Floats: ...
    @property
    def exits(self) -> _Floats: ...
    @property
    def values(self) -> _Floats: ...
    def beam_fwhm_deg(self) -> float: ...

class Measured:
    def bsdf(self) -> Bsdf: ...
    def kinds(self) -> list[tuple[str, str, str, dict[str, _Floats]]]: ...
    @property
    def scaled(self) -> list[tuple[str, int, float, float]]: ...

def read_scans(path: str | PathLike[str]) -> list[Scan]: ...
def measured_bsdf(
    scans: list[Scan],
    basis: str,
    symmetry: str,
    instrument_fwhm_deg: float | None,
    energy: str,
    kept: Kept | None = None,
    progress: Callable[[int, int], None] | None = None,
) -> Measured: ...
def load_solar(path: str | PathLike[str]) -> Bsdf: ...
def convert_bsdf(
    bsdf: Bsdf,
    basis: str | None,
    rotate_deg: float,
    flip: bool,
    swap_sides: bool,
    reciprocal: bool,
    keep_peak: bool,
    kept: Kept | None = None,
    progress: Callable[[int, int], None] | None = None,
) -> Bsdf: ...
def bsdf_report(bsdf: Bsdf) -> dict[str, Any]: ...
def save_split(bsdf: Bsdf, folder: str | PathLike[str]) -> list[Path]: ...
def exit_cells(
    bsdf: Bsdf, w_in: _Floats, mode_name: str, edge_points: int
) -> tuple[_Floats, _Floats, npt.NDArray[np.bool_]]: ...
def incident_cells(bsdf: Bsdf, front: bool, edge_points: int) -> tuple[_Floats, dict[str, _Floats]]: ...
def through_interval(bsdf: Bsdf, w_in: _Floats) -> _Floats: ...
def probe_directions(bsdf: Bsdf, w_in: _Floats) -> _Floats: ...

_Corners = tuple[Sequence[float], Sequence[float]] | None

class Generated:
    def bsdf(self) -> Bsdf: ...
    def xml(self, comment: str, geometry: Scene | None = None) -> str: ...
    @property
    def corners(self) -> _Floats: ...
    @property
    def totals(self) -> tuple[int, int, float]: ...
    def sides(self) -> list[tuple[str, tuple[float, float], dict[str, _Floats]]]: ...
    def cell_errors(self) -> list[tuple[npt.NDArray[np.float32], npt.NDArray[np.float32]] | None]: ...

def generate_bsdf(
    world: World,
    name: str,
    manufacturer: str,
    basis: str,
    box_corners: _Corners,
    periodic: bool,
    sides: list[str],
    samples: int | None,
    error: float,
    tolerance: float,
    reciprocity: bool,
    colour: bool,
    cell_errors: bool,
    seed: int,
    threads: int | None,
    state: str | PathLike[str] | None,
    resume: bool,
    progress: Callable[[int, int], None] | None,
) -> Generated: ...
def straight_transmittance(
    world: World, directions: _Floats, box_corners: _Corners, periodic: bool, samples: int, seed: int
) -> tuple[_Floats, _Floats]: ...

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
    @staticmethod
    def load_parts(
        parts: Sequence[_Part], cwd: str | PathLike[str], search_path: list[str], allow_commands: bool
    ) -> Scene: ...
    @staticmethod
    def check(files: list[str], search_path: list[str], allow_commands: bool) -> tuple[Scene, list[str], list[str]]: ...
    def surface_labels(self) -> list[tuple[str, str, str, bool]]: ...
    def to_mgf(self, offset: tuple[float, float, float]) -> str: ...
    def bounds(self) -> tuple[tuple[float, float, float], tuple[float, float, float]] | None: ...
    @property
    def surface_names(self) -> list[str]: ...
    @property
    def modifier_names(self) -> list[str]: ...
    @property
    def warnings(self) -> list[str]: ...

def read_octree(data: bytes, name: str) -> tuple[list[str], Path, int | None, list[Path | tuple[str, bytes, Path]]]: ...
def write_octree(
    history: list[str], cwd: str | PathLike[str], surfaces: int | None, parts: Sequence[_Part]
) -> bytes: ...
def expanded_scene(
    parts: Sequence[_Part], cwd: str | PathLike[str], search_path: list[str], allow_commands: bool
) -> list[tuple[Path, str]]: ...

class View:
    @staticmethod
    def load(path: str | PathLike[str]) -> View: ...
    @staticmethod
    def parse(options: str) -> View: ...
    @staticmethod
    def parse_words(words: list[str]) -> View: ...
    @property
    def aspect(self) -> float: ...
    def rays_at(self, points: _Floats) -> tuple[_Floats, _Floats, _Floats]: ...
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
    def encode(self, header: list[str]) -> bytes: ...
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
    def block_errors(self) -> tuple[_Floats, int] | None: ...

def glare(picture: Picture, options: dict[str, Any]) -> dict[str, Any]: ...
def glare_sources(picture: Picture, options: dict[str, Any]) -> npt.NDArray[np.uint32]: ...
def position_indices(
    towards: _Floats, sight: tuple[float, float, float], up: tuple[float, float, float], below: str
) -> _Floats: ...
def roller_blind(
    basis: str,
    tau_nn: float,
    tau_nh: float,
    rho_front: float,
    rho_back: float,
    cutoff_deg: float | None,
    color: tuple[float, float, float] | None,
    kept: Kept | None = None,
    progress: Callable[[int, int], None] | None = None,
) -> Bsdf: ...
def roller_blind_transmittance(
    tau_nn: float,
    tau_nh: float,
    rho_front: float,
    rho_back: float,
    cutoff_deg: float | None,
    color: tuple[float, float, float] | None,
    incidence_rad: float,
) -> tuple[float, float, float]: ...

class Layer:
    @staticmethod
    def pane(
        wavelengths_um: list[float], transmittance: list[float], front: list[float], back: list[float], curve: str
    ) -> Layer: ...
    @staticmethod
    def shade(visible: Bsdf, solar: Bsdf | None, flipped: bool) -> Layer: ...

class System:
    def __init__(self, name: str, layers: list[Layer]) -> None: ...
    def lacks_solar(self) -> bool: ...
    def straight(self, w_in: _Floats, band: str) -> _Floats: ...
    def tabulate(
        self,
        basis: str,
        band: str,
        middle: bool,
        kept: Kept | None = None,
        progress: Callable[[int, int], None] | None = None,
    ) -> Bsdf: ...

def slab_optics(index: float, pass_: float, cosine: float) -> tuple[float, float]: ...
def visible_share() -> float: ...

class World:
    @staticmethod
    def compile(scene: Scene, peak: str, portals: Sequence[str] = ()) -> World: ...
    def first_surfaces(
        self, origins: _Floats, directions: _Floats
    ) -> tuple[_Floats, _Floats, tuple[_Floats, _Floats, _Floats], _Floats, npt.NDArray[np.int64]]: ...
    def first_deltas(
        self, origins: _Floats, directions: _Floats
    ) -> tuple[_Floats, _Floats, _Floats, _Floats, npt.NDArray[np.bool_]]: ...

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
    ambient: tuple[float, float, float],
    goal: tuple[str, float] | None,
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
    ambient: tuple[float, float, float],
    error_of_each: bool,
    progress: Callable[[int, int], None] | None,
) -> tuple[_Floats, _Floats | None]: ...
def evaluate(
    definitions: str, expressions: list[str], channels: npt.NDArray[np.float64], arguments: list[float]
) -> npt.NDArray[np.float64]: ...
