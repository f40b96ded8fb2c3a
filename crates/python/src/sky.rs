//! `Sky`: sun, sky and ground from numbers, as Radiance text.

use crate::error::{InputError, OrRaise};
use pyo3::prelude::*;
use sunpeak_core::Vec3;
use sunpeak_sky::{CieSky, CieWeather, PerezWeather, Sky, sun_direction};

/// A sky made from numbers.
#[pyclass(frozen, name = "Sky", module = "sunpeak._core")]
pub struct PySky(Sky);

fn cie_kind(name: &str) -> PyResult<CieSky> {
    match name {
        "clear" => Ok(CieSky::Clear),
        "intermediate" => Ok(CieSky::Intermediate),
        "overcast" => Ok(CieSky::Overcast),
        "uniform" => Ok(CieSky::Uniform),
        _ => Err(InputError::new_err(format!(
            "kind of sky: {name:?}; expected clear, intermediate, overcast or uniform"
        ))),
    }
}

#[pymethods]
impl PySky {
    #[staticmethod]
    fn perez(
        sun_altitude_deg: f64,
        sun_azimuth_deg: f64,
        direct_normal_w_m2: f64,
        diffuse_horizontal_w_m2: f64,
        day_of_year: u32,
        ground_reflectance: f64,
        dew_point_c: Option<f64>,
    ) -> PyResult<Self> {
        let standard = PerezWeather::default();
        let weather = PerezWeather {
            sun_direction: sun_direction(sun_altitude_deg, sun_azimuth_deg),
            direct_normal_w_m2,
            diffuse_horizontal_w_m2,
            day_of_year,
            ground_reflectance,
            dew_point_c: dew_point_c.unwrap_or(standard.dew_point_c),
        };
        Ok(Self(Sky::perez(&weather).or_raise()?))
    }

    #[staticmethod]
    #[expect(clippy::too_many_arguments, reason = "keywords of the Python face")]
    fn cie(
        kind: &str,
        sun_altitude_deg: f64,
        sun_azimuth_deg: f64,
        with_sun: bool,
        turbidity: Option<f64>,
        diffuse_horizontal_w_m2: Option<f64>,
        direct_normal_w_m2: Option<f64>,
        ground_reflectance: f64,
    ) -> PyResult<Self> {
        let standard = CieWeather::default();
        let weather = CieWeather {
            kind: cie_kind(kind)?,
            sun_direction: sun_direction(sun_altitude_deg, sun_azimuth_deg),
            with_sun,
            turbidity: turbidity.unwrap_or(standard.turbidity),
            diffuse_horizontal_w_m2,
            direct_normal_w_m2,
            ground_reflectance,
        };
        Ok(Self(Sky::cie(&weather).or_raise()?))
    }

    fn to_radiance(&self) -> String {
        self.0.to_radiance_text()
    }

    /// Unit vector towards the sun, radiance (three channels) and full angle [deg]; `None` without a sun.
    #[getter]
    fn sun(&self) -> Option<([f64; 3], [f64; 3], f64)> {
        self.0.sun.map(|sun| (sun.direction.to_array(), sun.radiance.to_array(), sun.angle_deg))
    }

    #[getter]
    fn direct_normal_lux(&self) -> f64 {
        self.0.direct_normal_lux()
    }

    #[getter]
    fn diffuse_horizontal_lux(&self) -> f64 {
        self.0.diffuse_horizontal_lux()
    }

    /// Radiance [W sr⁻¹ m⁻²] of sky or ground towards a unit vector, without the sun.
    fn brightness(&self, direction: [f64; 3]) -> f64 {
        self.0.distribution.brightness(Vec3::from_array(direction))
    }
}
