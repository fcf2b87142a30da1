//! A smooth periodic displacement of the plane.

use core::f64::consts::TAU;
use glam::DVec2;

/// A wave over the unit square: its number of periods along each axis, its height and its phase.
#[derive(Clone, Copy, Debug)]
pub(super) struct Wave {
    /// Number of periods along x and y, as integers so that the wave repeats.
    pub(super) periods: [i32; 2],
    /// Height from the mean to the crest.
    pub(super) height: f64,
    /// Phase from 0 to 1, in periods.
    pub(super) phase: f64,
}

/// Returns the sum of the waves at a position. It has the same value in every copy of the unit square.
pub(super) fn wobble(waves: &[Wave], at: DVec2) -> f64 {
    let height = |wave: &Wave| {
        let [x, y] = wave.periods.map(f64::from);
        wave.height * libm::sin(TAU * (x * at.x + y * at.y + wave.phase))
    };
    waves.iter().map(height).sum()
}

#[cfg(test)]
mod tests {
    use super::{Wave, wobble};
    use glam::DVec2;

    #[test]
    fn wobble_repeats_and_stays_within_its_heights() {
        let wave = |periods, height| Wave {
            periods,
            height,
            phase: 0.3,
        };
        let waves = [wave([3, -2], 0.5), wave([0, 5], 0.25)];
        for step in 0..50 {
            let at = DVec2::new(0.37 * f64::from(step), 0.11 * f64::from(step));
            let here = wobble(&waves, at);
            assert!(here.abs() <= 0.75, "{here} at {at}");
            // Sines of large arguments lose a few of their last bits.
            let there = wobble(&waves, at + DVec2::new(3.0, -2.0));
            assert!((here - there).abs() < 1e-12, "{here} and {there} at {at}");
        }
    }
}
