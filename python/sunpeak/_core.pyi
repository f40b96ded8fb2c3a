"""The compiled core: arrays are (n, 3) float64 and contiguous; the classes of `sunpeak` say the rest."""

from os import PathLike

import numpy as np
import numpy.typing as npt

__version__: str

_Floats = npt.NDArray[np.float64]

class InputError(ValueError):
    """The input is wrong: the message says where (file:line:column), what was found, what was expected."""

class Bsdf:
    @staticmethod
    def load(path: str | PathLike[str]) -> Bsdf: ...
    def evaluate(self, w_in: _Floats, w_out: _Floats, colour: bool, residual: bool) -> _Floats: ...
    def through(self, w_in: _Floats, peak: str, colour: bool) -> _Floats: ...
    def hemispherical(self, w_in: _Floats, mode: str, colour: bool, residual: bool) -> _Floats: ...
    def sample(
        self, w_in: _Floats, u: _Floats, peak: str
    ) -> tuple[_Floats, _Floats, _Floats, npt.NDArray[np.bool_]]: ...
    def pdf(self, w_in: _Floats, w_out: _Floats, peak: str) -> _Floats: ...

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
