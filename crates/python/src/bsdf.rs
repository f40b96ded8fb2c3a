//! `Bsdf`: a scattering table with arrays of directions.

use crate::arrays::{Numbers, Rows, colours, directions, numbers, rows, vectors};
use crate::error::{InputError, OrRaise};
use numpy::{PyArray1, PyArray2, PyReadonlyArray2};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use rayon::prelude::*;
use std::path::PathBuf;
use std::sync::Arc;
use sunpeak_bsdf::{Bsdf, ColumnPeak, Instrument, Mode, PeakRule, table::Table};
use sunpeak_core::{Rgb, Vec3, luminance};

/// One product: front and back, reflection and transmission. Arrays are (n, 3) in the BSDF's frame.
#[pyclass(frozen, name = "Bsdf", module = "sunpeak._core")]
pub struct PyBsdf(pub Arc<Bsdf>);

/// A peak rule by its name.
pub fn peak_rule(name: &str) -> PyResult<PeakRule> {
    match name {
        "off" => Ok(PeakRule::Off),
        "paper" => Ok(PeakRule::Paper),
        "radiance" => Ok(PeakRule::Radiance),
        "split" => Ok(PeakRule::Split),
        _ => Err(InputError::new_err(format!("peak: {name:?}; expected split, radiance, paper or off"))),
    }
}

/// Reflection or transmission by its name.
pub fn mode(name: &str) -> PyResult<Mode> {
    match name {
        "transmission" => Ok(Mode::Transmission),
        "reflection" => Ok(Mode::Reflection),
        _ => Err(InputError::new_err(format!("mode: {name:?}; expected transmission or reflection"))),
    }
}

/// What an instrument did, by its width or to be found.
pub fn instrument(fwhm_deg: Option<f64>, find: bool) -> Instrument {
    match fwhm_deg {
        _ if find => Instrument::Find,
        Some(fwhm) => Instrument::FwhmDeg(fwhm),
        None => Instrument::None,
    }
}

/// One draw from both lobes.
struct Draw {
    w_out: Vec3,
    weight: Rgb,
    pdf: f64,
    straight: bool,
}

#[pymethods]
impl PyBsdf {
    #[staticmethod]
    #[pyo3(signature = (path, instrument_fwhm_deg=None, find_instrument=false))]
    fn load(
        py: Python<'_>,
        path: PathBuf,
        instrument_fwhm_deg: Option<f64>,
        find_instrument: bool,
    ) -> PyResult<Self> {
        let instrument = instrument(instrument_fwhm_deg, find_instrument);
        let bsdf = py.detach(|| Bsdf::load_measured(&path, instrument)).or_raise()?;
        Ok(Self(Arc::new(bsdf)))
    }

    #[pyo3(signature = (w_in, w_out, colour, residual))]
    fn evaluate<'py>(
        &self,
        py: Python<'py>,
        w_in: PyReadonlyArray2<'py, f64>,
        w_out: PyReadonlyArray2<'py, f64>,
        colour: bool,
        residual: bool,
    ) -> PyResult<Bound<'py, PyAny>> {
        let rule = if residual { PeakRule::Split } else { PeakRule::Off };
        let pairs = pairs(&w_in, &w_out)?;
        let values = py.detach(|| {
            pairs.par_iter().map(|&(a, b)| self.0.evaluate_smooth(a, b, rule)).collect::<Vec<_>>()
        });
        Ok(colours(py, &values, colour))
    }

    fn through<'py>(
        &self,
        py: Python<'py>,
        w_in: PyReadonlyArray2<'py, f64>,
        peak: &str,
        colour: bool,
    ) -> PyResult<Bound<'py, PyAny>> {
        let rule = peak_rule(peak)?;
        let incident = directions(&w_in, "w_in")?;
        let values = py.detach(|| incident.par_iter().map(|&w| self.0.through(w, rule)).collect::<Vec<_>>());
        Ok(colours(py, &values, colour))
    }

    fn hemispherical<'py>(
        &self,
        py: Python<'py>,
        w_in: PyReadonlyArray2<'py, f64>,
        mode: &str,
        colour: bool,
        residual: bool,
    ) -> PyResult<Bound<'py, PyAny>> {
        let rule = if residual { PeakRule::Split } else { PeakRule::Off };
        let mode = self::mode(mode)?;
        let incident = directions(&w_in, "w_in")?;
        let values = py.detach(|| {
            incident.par_iter().map(|&w| self.0.hemispherical_smooth(w, mode, rule)).collect::<Vec<_>>()
        });
        Ok(colours(py, &values, colour))
    }

    fn sample<'py>(
        &self,
        py: Python<'py>,
        w_in: PyReadonlyArray2<'py, f64>,
        u: PyReadonlyArray2<'py, f64>,
        peak: &str,
    ) -> PyResult<(Rows<'py>, Rows<'py>, Numbers<'py>, Bound<'py, PyArray1<bool>>)> {
        let rule = peak_rule(peak)?;
        let incident = directions(&w_in, "w_in")?;
        let numbers_in = vectors(&u, "u")?;
        same_length(incident.len(), numbers_in.len(), "u")?;
        let draws: Vec<Draw> = py.detach(|| {
            incident.par_iter().zip(&numbers_in).map(|(&w, u)| self.draw(w, u.to_array(), rule)).collect()
        });
        let [outgoing, weights] = [|draw: &Draw| draw.w_out, |draw: &Draw| draw.weight]
            .map(|part| rows(py, &draws.iter().map(part).collect::<Vec<_>>()));
        let densities = numbers(py, draws.iter().map(|draw| draw.pdf).collect());
        let straight = PyArray1::from_vec(py, draws.iter().map(|draw| draw.straight).collect());
        Ok((outgoing, weights, densities, straight))
    }

    /// Name, manufacturer, structure, warnings and components of the file.
    fn describe<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let mut components = Vec::new();
        for mode in [Mode::Transmission, Mode::Reflection] {
            for front in [true, false] {
                components.extend(self.component(py, front, mode)?);
            }
        }
        let about = PyDict::new(py);
        about.set_item("name", &self.0.name)?;
        about.set_item("manufacturer", &self.0.manufacturer)?;
        about.set_item("thickness_m", self.0.thickness_m)?;
        about.set_item("comments", &self.0.comments)?;
        about.set_item("bands", &self.0.bands)?;
        about.set_item("structure", &self.0.structure)?;
        about.set_item("warnings", &self.0.warnings)?;
        about.set_item("components", components)?;
        Ok(about)
    }

    /// For each direction the split's column: through transmittance, contrast, detection limit, interval (low and high) and
    /// the smooth lobe's width; NaN where nothing is transmitted.
    fn peak_evidence<'py>(&self, py: Python<'py>, w_in: PyReadonlyArray2<'py, f64>) -> PyResult<Rows<'py>> {
        let found = directions(&w_in, "w_in")?.into_iter().map(|w| self.column_peak(w));
        let rows: Vec<Vec<f64>> = found
            .map(|column| match column {
                Some(c) => {
                    let [low, high] = c.interval;
                    vec![luminance(c.through), c.contrast, c.detection_limit, low, high, c.lobe_sigma]
                }
                None => vec![f64::NAN; 6],
            })
            .collect();
        PyArray2::from_vec2(py, &rows).map_err(|error| InputError::new_err(error.to_string()))
    }

    fn pdf<'py>(
        &self,
        py: Python<'py>,
        w_in: PyReadonlyArray2<'py, f64>,
        w_out: PyReadonlyArray2<'py, f64>,
        peak: &str,
    ) -> PyResult<Numbers<'py>> {
        let rule = peak_rule(peak)?;
        let pairs = pairs(&w_in, &w_out)?;
        let values = py.detach(|| {
            pairs
                .par_iter()
                .map(|&(a, b)| (1.0 - self.straight_probability(a, rule)) * self.0.pdf_smooth(a, b, rule))
                .collect()
        });
        Ok(numbers(py, values))
    }
}

impl PyBsdf {
    /// What the file holds for the traced ray's `side` and `mode`.
    fn component<'py>(
        &self,
        py: Python<'py>,
        front: bool,
        mode: Mode,
    ) -> PyResult<Option<Bound<'py, PyDict>>> {
        let w_in = if front { Vec3::Z } else { Vec3::NEG_Z };
        let Some(oriented) = self.0.distribution(w_in, mode) else { return Ok(None) };
        let distribution = &oriented.distribution;
        let about = PyDict::new(py);
        about.set_item("mode", if mode == Mode::Transmission { "transmission" } else { "reflection" })?;
        about.set_item("side", if front { "front" } else { "back" })?;
        about.set_item("basis", basis_name(distribution.luminous()))?;
        about.set_item("incident_cells", distribution.columns().len())?;
        about.set_item("values", distribution.luminous().values().len())?;
        about.set_item("smallest_cell_sr", distribution.luminous().smallest_projected_solid_angle())?;
        about.set_item("isotropic", distribution.luminous().is_isotropic())?;
        about.set_item("colour", distribution.color().is_some())?;
        about.set_item("by_reciprocity", oriented.reversed)?;
        about.set_item("has_peak", distribution.split().has_peak())?;
        about.set_item("instrument_fwhm_deg", distribution.split().instrument_fwhm_deg())?;
        Ok(Some(about))
    }

    /// What the split found in the column of the table that `w_in` falls into.
    fn column_peak(&self, w_in: Vec3) -> Option<ColumnPeak> {
        let oriented = self.0.distribution(w_in, Mode::Transmission)?;
        let straight = -w_in.truncate();
        let (incident, _) = oriented.points(straight, straight);
        let column = oriented.distribution.columns().index(incident);
        oriented.distribution.split().column(column)
    }

    /// Share of the samples that go straight: the peak's flux over all of it.
    fn straight_probability(&self, w_in: Vec3, rule: PeakRule) -> f64 {
        let through = luminance(self.0.through(w_in, rule));
        if through <= 0.0 {
            return 0.0;
        }
        let smooth = [Mode::Transmission, Mode::Reflection]
            .map(|mode| luminance(self.0.hemispherical_smooth(w_in, mode, rule)));
        through / (through + smooth[0] + smooth[1])
    }

    /// Choose a lobe with the first number, then sample it; nothing to sample gives weight and density 0.
    fn draw(&self, w_in: Vec3, u: [f64; 3], rule: PeakRule) -> Draw {
        let probability = self.straight_probability(w_in, rule);
        if u[0] < probability {
            let weight = self.0.through(w_in, rule) / probability;
            return Draw { w_out: -w_in, weight, pdf: probability, straight: true };
        }
        let rest = 1.0 - probability;
        let stretched = if rest > 0.0 { (u[0] - probability) / rest } else { u[0] };
        match self.0.sample_smooth(w_in, [stretched, u[1], u[2]], rule) {
            Some(sample) => Draw {
                w_out: sample.w_out,
                weight: sample.weight / rest,
                pdf: sample.pdf * rest,
                straight: false,
            },
            None => Draw { w_out: -w_in, weight: Rgb::ZERO, pdf: 0.0, straight: false },
        }
    }
}

fn basis_name(table: &Table) -> String {
    match table {
        Table::Matrix(matrix) if matrix.incident.name() == matrix.exiting.name() => {
            matrix.incident.name().to_owned()
        }
        Table::Matrix(matrix) => format!("{} by {}", matrix.incident.name(), matrix.exiting.name()),
        Table::Tree(tree) => format!("TensorTree{}", tree.rank()),
    }
}

fn pairs(w_in: &PyReadonlyArray2<'_, f64>, w_out: &PyReadonlyArray2<'_, f64>) -> PyResult<Vec<(Vec3, Vec3)>> {
    let incident = directions(w_in, "w_in")?;
    let outgoing = directions(w_out, "w_out")?;
    same_length(incident.len(), outgoing.len(), "w_out")?;
    Ok(incident.into_iter().zip(outgoing).collect())
}

fn same_length(expected: usize, found: usize, name: &str) -> PyResult<()> {
    if expected == found {
        Ok(())
    } else {
        Err(InputError::new_err(format!("{name}: expected {expected} rows, as in w_in, found {found}")))
    }
}
