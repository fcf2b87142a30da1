//! Compares textures at many scattered positions with single evaluations.

use super::oracle::{METRICS, SCATTERS, position};
use dapple_hash::Seed;
use dapple_raster::{Field, FieldExt as _};
use dapple_worley::{Combination, OctaveSeeds, Octaves, Worley, Worley2, WorleyError};
use glam::DVec2;

/// Returns positions near and far, some on borders of cells and some out of range. Their number is not a multiple of a
/// group.
fn positions() -> Vec<DVec2> {
    let mut positions: Vec<DVec2> = (0..301)
        .map(|index| position::<2>(Seed(4), index, [3.0, 1e3, 1e9][index as usize % 3]).into())
        .collect();
    positions[7] = DVec2::new(3.0, -2.0);
    positions[100] = DVec2::new(f64::NAN, 0.5);
    positions[200] = DVec2::new(0.5, f64::INFINITY);
    positions
}

fn ways_agree(field: &dyn Field, what: &str) {
    let positions = positions();
    let mut values = vec![-1.0; positions.len()];
    field.sample_many(&positions, &mut values).unwrap();
    for (value, &at) in values.iter().zip(&positions) {
        assert_eq!(
            value.to_bits(),
            field.sample(at).to_bits(),
            "{what} at {at}"
        );
    }
    assert!(
        field.sample_many(&positions, &mut values[1..]).is_err(),
        "memory of another length is refused"
    );
}

#[test]
fn sample_many_equals_sample_bit_for_bit() -> Result<(), WorleyError> {
    let octaves = Octaves {
        count: 3,
        lacunarity: 2.5,
        gain: -0.5,
        seeds: OctaveSeeds::Own,
    };
    for (scatter, metric) in SCATTERS.into_iter().flat_map(|s| METRICS.map(|m| (s, m))) {
        let worley: Worley2 = Worley::new(Seed(5)).with_scatter(scatter)?;
        let worley = worley.with_metric(metric)?;
        let what = format!("{scatter:?}, {metric:?}");
        for combination in [
            Combination::F1,
            Combination::F2_MINUS_F1,
            Combination::F4_MINUS_F1,
        ] {
            let texture = worley.combine(combination);
            ways_agree(&texture, &what);
            ways_agree(&texture.fractal(octaves)?, &what);
        }
        ways_agree(&worley.cell_values(), &what);
        ways_agree(&worley.edge_distances(), &what);
    }
    let varying = Worley2::new(Seed(5)).with_varying_density(|at| 1.0 + at.x.abs());
    ways_agree(&varying.combine(Combination::F1), "varying density");
    Ok(())
}
