//! Our evaluation at scattered positions, many at once or one at a time, compared with the fastest functions of other
//! crates for one position.
//!
//! The positions are spread over 1000×1000 or 1000×1000×1000 cells, in random order, so that consecutive positions do
//! not share a cell. Both sides get the same positions, the peer in single precision.

use crate::harness::{Bench, Done, Side};
use crate::noise::with_derivatives;
use crate::peers::noise;
use crate::row::{Case, Goal, Unit};
use crate::sets::{SEED, positions_in};
use anyhow::{Result, ensure};
use dapple_worley::{Combination, Dimensions, Feature, Scatter, Space, Vector, Worley};

const F1_AND_F2: Case = Case {
    group: "worley",
    case: "2-D, scattered positions, F1 and F2 with vectors and ids",
    peer: "noise-functions CellDistance, F1 alone",
    unit: Unit::NsPerPosition,
    must: Goal::CostAtMost(2.0),
    note: "positions anywhere in 1000 cells along each axis, in random order; the peer has one feature point per cell, \
           ours three on average",
};

const F1_AND_F2_IN_SPACE: Case = Case {
    case: "3-D, scattered positions, F1 and F2 with vectors and ids",
    ..F1_AND_F2
};

const JITTERED: Case = Case {
    case: "2-D, scattered positions, one jittered point per cell, F1",
    must: Goal::Faster(1.2),
    note: "positions anywhere in 1000 cells along each axis, in random order; both sides have one feature point per cell",
    ..F1_AND_F2
};

const JITTERED_IN_SPACE: Case = Case {
    case: "3-D, scattered positions, one jittered point per cell, F1",
    ..JITTERED
};

const ONE_POSITION: Case = Case {
    case: "2-D, one position, one jittered point per cell, F1",
    peer: "noise-functions CellDistance, one position",
    must: Goal::CostAtMost(2.5),
    note: "positions anywhere in 1000 cells along each axis, in random order; the peer looks at 9 cells and takes 32 bits, \
           ours is exact",
    ..F1_AND_F2
};

const ONE_POSITION_IN_SPACE: Case = Case {
    case: "3-D, one position, one jittered point per cell, F1",
    note: "positions anywhere in 1000 cells along each axis, in random order; the peer looks at 27 cells and takes 32 \
           bits, ours is exact",
    ..ONE_POSITION
};

const ONE_POSITION_F2: Case = Case {
    case: "2-D, one position, one jittered point per cell, F1 and F2",
    must: Goal::CostAtMost(3.0),
    ..ONE_POSITION
};

const ONE_POSITION_F2_IN_SPACE: Case = Case {
    case: "3-D, one position, one jittered point per cell, F1 and F2",
    must: Goal::CostAtMost(3.0),
    ..ONE_POSITION_IN_SPACE
};

const DERIVATIVES: Case = Case {
    case: "2-D, one position, F1 with its derivatives",
    peer: "ours, the value alone",
    must: Goal::CostAtMost(2.5),
    note: "one jittered point per cell; differences take one more sample for each axis",
    ..ONE_POSITION
};

const DERIVATIVES_IN_SPACE: Case = Case {
    case: "3-D, one position, F1 with its derivatives",
    ..DERIVATIVES
};

/// Number of positions per run.
const N_POSITIONS: usize = 1 << 16;

/// Number of cells along each axis.
const N_CELLS: f64 = 1000.0;

/// Number of turns per row. Each turn runs both sides.
const TURNS: u32 = 41;

pub(super) fn run(bench: &mut Bench) -> Result<()> {
    let (plane, space) = (noise::noise_functions_f1_2, noise::noise_functions_f1_3);
    // Mean F1: known for three points per cell, and measured for one with a plain loop over the neighbors.
    poisson::<2>(bench, &F1_AND_F2, 0.282, plane)?;
    poisson::<3>(bench, &F1_AND_F2_IN_SPACE, 0.381, space)?;
    jittered::<2>(bench, &JITTERED, 0.430, plane)?;
    jittered::<3>(bench, &JITTERED_IN_SPACE, 0.519, space)?;
    one_by_one::<2, 1>(bench, &ONE_POSITION, 0.430, plane)?;
    one_by_one::<3, 1>(bench, &ONE_POSITION_IN_SPACE, 0.519, space)?;
    one_by_one::<2, 2>(bench, &ONE_POSITION_F2, 0.430, plane)?;
    one_by_one::<3, 2>(bench, &ONE_POSITION_F2_IN_SPACE, 0.519, space)?;
    let scatter = Scatter::Jittered { jitter: 1.0 };
    let cells = Worley::<2>::new(SEED).with_scatter(scatter)?;
    with_derivatives(bench, &DERIVATIVES, &cells.combine(Combination::F1))?;
    let cells = Worley::<3>::new(SEED).with_scatter(scatter)?;
    with_derivatives(
        bench,
        &DERIVATIVES_IN_SPACE,
        &cells.combine(Combination::F1),
    )
}

/// A peer's function that fills in values at the given positions.
type Fill<const N: usize> = fn(&[[f32; N]], &mut [f32]);

fn poisson<const N: usize>(bench: &mut Bench, case: &Case, mean: f64, fill: Fill<N>) -> Result<()>
where
    Dimensions: Space<N>,
{
    row::<N, 2>(bench, case, &Worley::new(SEED), mean, fill)
}

fn jittered<const N: usize>(bench: &mut Bench, case: &Case, mean: f64, fill: Fill<N>) -> Result<()>
where
    Dimensions: Space<N>,
{
    let worley = Worley::new(SEED).with_scatter(Scatter::Jittered { jitter: 1.0 })?;
    row::<N, 1>(bench, case, &worley, mean, fill)
}

fn row<const N: usize, const K: usize>(
    bench: &mut Bench,
    case: &Case,
    worley: &Worley<N>,
    mean: f64,
    fill: Fill<N>,
) -> Result<()>
where
    Dimensions: Space<N>,
{
    let positions: Vec<[f64; N]> = positions_in(N_POSITIONS, N_CELLS);
    let their_positions: Vec<[f32; N]> = positions
        .iter()
        .map(|at| at.map(|coordinate| coordinate as f32))
        .collect();
    let positions: Vec<Vector<N>> = positions.into_iter().map(Vector::<N>::from).collect();
    let none = [worley.sample::<1>([f64::NAN; N])[0]; K];
    let ours = Side::new(vec![none; N_POSITIONS], |features: &mut Vec<_>| {
        worley
            .sample_many::<K>(&positions, features)
            .expect("there is room for the features of each position");
    });
    let theirs = Side::new(vec![0.0; N_POSITIONS], |values: &mut Vec<f32>| {
        fill(&their_positions, values);
    });
    bench.beside(case, TURNS, ours, theirs, |features, values| {
        confirm(worley, mean, &positions, features)?;
        // F1 is at most 1.5, and the peer maps [0, 1] to [−1, 1].
        ensure!(
            values.iter().all(|value| (-1.0..=2.0).contains(value)),
            "a value of the peer is not in its range"
        );
        ensure!(
            values.iter().any(|&value| value < -0.5) && values.iter().any(|&value| value > 0.2),
            "the peer's values are flat"
        );
        Ok(Done::both(N_POSITIONS))
    })
}

/// Measures the distances, evaluated one position at a time.
fn one_by_one<const N: usize, const K: usize>(
    bench: &mut Bench,
    case: &Case,
    mean: f64,
    fill: Fill<N>,
) -> Result<()>
where
    Dimensions: Space<N>,
{
    let worley = Worley::new(SEED).with_scatter(Scatter::Jittered { jitter: 1.0 })?;
    let positions: Vec<[f64; N]> = positions_in(N_POSITIONS, N_CELLS);
    let their_positions: Vec<[f32; N]> = positions
        .iter()
        .map(|at| at.map(|coordinate| coordinate as f32))
        .collect();
    let ours = Side::new(vec![[0.0; K]; N_POSITIONS], |values: &mut Vec<_>| {
        for (value, &at) in values.iter_mut().zip(&positions) {
            for (value, feature) in value.iter_mut().zip(worley.sample::<K>(at)) {
                *value = feature.distance;
            }
        }
    });
    let theirs = Side::new(vec![0.0; N_POSITIONS], |values: &mut Vec<f32>| {
        fill(&their_positions, values);
    });
    bench.beside(case, TURNS, ours, theirs, |ours, theirs| {
        let sum: f64 = ours.iter().map(|found| f64::from(found[0])).sum();
        let found = sum / ours.len() as f64;
        // A hundredth is six standard deviations of the mean over this number of positions.
        ensure!(
            (found / mean - 1.0).abs() <= 0.01,
            "the mean of F1 is {found}, not {mean}"
        );
        ensure!(
            theirs.iter().any(|&value| value < -0.5) && theirs.iter().any(|&value| value > 0.2),
            "the peer's values are flat"
        );
        Ok(Done::both(N_POSITIONS))
    })
}

/// Checks that the features at all positions equal those of single evaluations. Also checks the mean of F1.
fn confirm<const N: usize, const K: usize>(
    worley: &Worley<N>,
    mean: f64,
    positions: &[Vector<N>],
    features: &[[Feature<Vector<N>>; K]],
) -> Result<()>
where
    Dimensions: Space<N>,
{
    for (&position, found) in positions.iter().zip(features).step_by(61) {
        let expected = worley.sample::<K>(position);
        ensure!(
            *found == expected,
            "{found:?} at {position:?}, and {expected:?} asked alone"
        );
    }
    let sum: f64 = features
        .iter()
        .map(|found| f64::from(found[0].distance))
        .sum();
    let found = sum / features.len() as f64;
    // A hundredth is six standard deviations of the mean over this number of positions.
    ensure!(
        (found / mean - 1.0).abs() <= 0.01,
        "a mean F1 of {found} is not known, {mean} is"
    );
    Ok(())
}
