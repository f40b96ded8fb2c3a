//! Simplified daylight glare probability.

/// `DGPs = 6.22e-5 Ev + 0.184`, not above 1: right where no direct sun and no sharp reflection is in view (Wienold 2009, "Dynamic daylight
/// glare evaluation", Building Simulation 2009; Wienold 2007, "Dynamic simulation of blind control strategies for visual
/// comfort and energy balance analysis").
///
/// The *enhanced* simplified DGP of the same paper is DGP with Ev from elsewhere and the sources of a simplified picture: state Ev.
pub(crate) fn dgps(ev_lux: f64) -> f64 {
    (6.22e-5 * ev_lux + 0.184).min(1.0)
}

#[cfg(test)]
mod tests {
    use super::dgps;

    #[test]
    fn a_line_up_to_one() {
        assert!((dgps(2000.0) - 0.3084).abs() < 1e-12);
        assert_eq!(dgps(1e5), 1.0);
    }
}
