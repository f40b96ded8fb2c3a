//! Cells as they are drawn: outlines on the disk of directions, with what is in them.

use crate::{
    bsdf::{Bsdf, Mode},
    incident::Incident,
    peak::ColumnPeak,
    proposal::Oriented,
    table::{Cell, Columns, Table, turned_back},
};
use glam::DVec2;
use sunpeak_core::{Vec3, luminance};

/// An exiting cell for one direction of incidence.
#[derive(Clone, Debug, PartialEq)]
pub struct ExitCell {
    /// Border: (x, y) of exiting directions, once around.
    pub outline: Vec<DVec2>,
    /// Luminous BSDF [1/sr] as it is in the table.
    pub value: f64,
    /// What the split left of it [1/sr].
    pub residual: f64,
    /// Projected solid angle [sr].
    pub projected_solid_angle: f64,
    /// Lowered by the split?
    pub is_peak: bool,
}

/// An incident cell of transmission.
#[derive(Clone, Debug, PartialEq)]
pub struct IncidentCell {
    /// Border: (x, y) of the rays' directions, once around; rings give their outer circle, those further in come later.
    pub outline: Vec<DVec2>,
    /// Where it lies.
    pub incident: Incident,
    /// What the split found.
    pub peak: ColumnPeak,
}

impl Bsdf {
    /// The cells that light which is traced from `w_in` is scattered to, `4 * edge_points` points around each. Where the table is
    /// met by reciprocity, its incident cells.
    pub fn exit_cells(&self, w_in: Vec3, mode: Mode, edge_points: usize) -> Vec<ExitCell> {
        let Some(oriented) = self.distribution(w_in, mode) else { return Vec::new() };
        let p_in = -w_in.truncate();
        if oriented.reversed {
            return against(oriented, p_in, edge_points);
        }
        let d = &oriented.distribution;
        let (table, column) = (d.luminous(), d.columns().index(p_in));
        let place = |p: DVec2| if table.is_isotropic() { turned_back(p_in, p) } else { p };
        let drawn = |cell: &Cell| {
            let rest = d.split().surround(column, cell.index);
            let value = luminance(d.at_index(cell.index));
            ExitCell {
                outline: table.outline(cell, edge_points).into_iter().map(place).collect(),
                value,
                residual: rest.map_or(value, luminance),
                projected_solid_angle: cell.projected_solid_angle,
                is_peak: rest.is_some(),
            }
        };
        table.cells(d.columns(), column).iter().map(drawn).collect()
    }

    /// The columns of transmission that rays meet at the front or at the back, `4 * edge_points` points around each.
    pub fn incident_cells(&self, front: bool, edge_points: usize) -> Vec<IncidentCell> {
        let w_in = if front { Vec3::Z } else { -Vec3::Z };
        let Some(oriented) = self.distribution(w_in, Mode::Transmission) else { return Vec::new() };
        let d = &oriented.distribution;
        // A table's incident point is the ray's own direction; against the table it is minus that.
        let sign = if oriented.reversed { -1.0 } else { 1.0 };
        let all = Incident::all(oriented, front).into_iter().zip(d.split().columns());
        all.map(|(incident, peak)| {
            let outline = d.columns().outline(incident.column, edge_points);
            IncidentCell { outline: outline.into_iter().map(|p| sign * p).collect(), incident, peak }
        })
        .collect()
    }
}

/// Against the table its incident cells are met; in an isotropic tree, which has rings there, a grid as fine as its own.
fn against(oriented: &Oriented, p_in: DVec2, edge_points: usize) -> Vec<ExitCell> {
    let d = &oriented.distribution;
    let (cells, sign) = match (d.luminous(), d.columns()) {
        (Table::Matrix(_), columns) => (columns.clone(), -1.0),
        (Table::Tree(_), Columns::Radial { side } | Columns::Square { side }) => {
            (Columns::Square { side: *side }, 1.0)
        }
        (Table::Tree(_), columns) => (columns.clone(), 1.0),
    };
    let drawn = |number: usize| {
        let p_out = sign * cells.point(number, [0.5, 0.5]);
        let (value, residual) =
            (luminance(oriented.value(p_in, p_out, false)), luminance(oriented.value(p_in, p_out, true)));
        let outline = cells.outline(number, edge_points).into_iter().map(|p| sign * p).collect();
        let projected_solid_angle = cells.projected_solid_angle(number);
        ExitCell { outline, value, residual, projected_solid_angle, is_peak: residual < value }
    };
    (0..cells.len()).map(drawn).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{peak::PeakRule, synthetic::Fabric};

    fn inside(outline: &[DVec2]) -> DVec2 {
        outline.iter().sum::<DVec2>() / outline.len() as f64
    }

    #[test]
    fn cells_hold_what_evaluation_gives_and_add_up() {
        for name in ["klems-quarter", "t3-256", "t4-64"] {
            let bsdf = Fabric::default().tabulate(name.parse().unwrap()).unwrap();
            for w_in in [Vec3::new(0.31, 0.2, 0.0), Vec3::new(-0.1, 0.43, 0.0)]
                .map(|v| v.truncate().extend((1.0 - v.length_squared()).sqrt()))
            {
                let cells = bsdf.exit_cells(w_in, Mode::Transmission, 4);
                let (mut flux, mut rest) = (0.0, 0.0);
                for cell in &cells {
                    flux += cell.value * cell.projected_solid_angle;
                    rest += cell.residual * cell.projected_solid_angle;
                    let p = inside(&cell.outline);
                    let w_out = p.extend(-(1.0 - p.length_squared()).sqrt());
                    assert_eq!(luminance(bsdf.evaluate(w_in, w_out)), cell.value, "{name} {p}");
                }
                let whole = luminance(bsdf.hemispherical_smooth(w_in, Mode::Transmission, PeakRule::Off));
                assert!((flux - whole).abs() < 1e-6, "{name}: {flux} {whole}");
                assert!(rest < flux && cells.iter().any(|c| c.is_peak), "{name}");
            }
            let columns = bsdf.incident_cells(true, 4);
            assert_eq!(columns.len(), bsdf.incident_columns(true).len());
        }
    }
}
