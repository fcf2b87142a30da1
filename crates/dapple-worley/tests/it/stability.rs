//! Pinned values of the crate, which must not change unintentionally.
//!
//! Each test writes its numbers as lines of text, floating-point numbers as their bits. To pin new values, copy the
//! lines that a failing test prints.

use super::oracle::SCATTERS;
use dapple_hash::Seed;
use dapple_worley::{
    Combination, Dimensions, Feature, FeatureSet, Metric, OctaveSeeds, Octaves, Radial,
    RadialCells, Scatter, Space, Vector, Worley, WorleyError,
};

fn line<const N: usize>(features: &[Feature<Vector<N>>; 4]) -> String
where
    Dimensions: Space<N>,
{
    let distances = features.map(|feature| format!("{:08x}", feature.distance.to_bits()));
    format!(
        "{} {:016x} {:016x}",
        distances.join(" "),
        features[0].id,
        features[3].id
    )
}

fn bits(values: impl IntoIterator<Item = f32>) -> String {
    let words = values
        .into_iter()
        .map(|value| format!("{:08x}", value.to_bits()));
    words.collect::<Vec<_>>().join(" ")
}

const POSITIONS: [[f64; 4]; 3] = [
    [0.25, 0.75, -3.5, 1.125],
    [-1e9 + 0.375, 12.5, 1e6, -7.0625],
    [1234.5625, -0.03125, 0.5, 77.0],
];

fn position<const N: usize>(index: usize) -> Vector<N>
where
    Dimensions: Space<N>,
{
    Vector::<N>::from(core::array::from_fn(|axis| POSITIONS[index][axis]))
}

fn samples<const N: usize>() -> Vec<String>
where
    Dimensions: Space<N>,
{
    let worley = Worley::<N>::new(Seed(7));
    (0..3)
        .map(|index| line::<N>(&worley.sample(position::<N>(index))))
        .collect()
}

#[test]
fn value_stability_sample2() {
    let pinned: [&str; 3] = [
        "3e72c42c 3e9bbd57 3ee8520e 3f0691ee a532589fee092c92 9c08978fc4965589",
        "3ec7e627 3f0743a1 3f3a4264 3f40c387 f8d764e931ed4286 796e68bb1f184131",
        "3e768da0 3f512816 3f57914d 3f6e366e 4c54bb1e624cdf81 4e1e28d34a425b3b",
    ];
    assert_eq!(samples::<2>(), pinned);
}

#[test]
fn value_stability_sample3() {
    let pinned: [&str; 3] = [
        "3e1f33f1 3eeeae1b 3ef43e40 3f0777ce c87fc84fd2b800fa 1dc1d902606a09c3",
        "3e933c8d 3f078e34 3f10b601 3f1733dc 1603aed9921eebb3 6efa08639527ceee",
        "3e9f0240 3eb1b0d3 3ec6607c 3efcd0ad c982f5af4a473e54 efae8253354c9823",
    ];
    assert_eq!(samples::<3>(), pinned);
}

#[test]
fn value_stability_sample4() {
    let pinned: [&str; 3] = [
        "3e89198d 3f07ce22 3f0e5ad0 3f106deb a584ce9e4bf7a3f3 a2dd4201337fc2c4",
        "3ea3d307 3f01468c 3f1a318d 3f33da24 9a4df88307ec63c2 16f70a616ed34b69",
        "3f17e7c4 3f275135 3f3807c1 3f3be75c 3175cdbdba5a65a0 8fc739e71f3eed8d",
    ];
    assert_eq!(samples::<4>(), pinned);
}

#[test]
fn value_stability_sample_by_metric_and_scatter() -> Result<(), WorleyError> {
    let mut lines = Vec::new();
    for (metric, scatter) in [
        (Metric::Euclidean, SCATTERS[1]),
        (Metric::Manhattan, SCATTERS[2]),
        (Metric::Chebyshev, SCATTERS[3]),
        (Metric::Minkowski(3.0), SCATTERS[4]),
        (Metric::Minkowski(10.0), SCATTERS[5]),
    ] {
        let worley = Worley::<2>::new(Seed(7))
            .with_metric(metric)?
            .with_scatter(scatter)?;
        lines.push(line::<2>(&worley.sample(position::<2>(0))));
    }
    let periodic = Worley::<2>::new(Seed(7)).with_period([Some(3), Some(1)])?;
    lines.push(line::<2>(&periodic.sample(position::<2>(2))));
    let varying = Worley::<2>::new(Seed(7)).with_varying_density(|at| at.y);
    lines.push(line::<2>(&varying.sample(position::<2>(1))));
    let pinned: [&str; 7] = [
        "3e72c42c 3f5ffc4c 3f81b5b1 3f84f61c a532589fee092c92 dd05d82f6ed0983b",
        "3e8d3570 3f042028 3f398170 3f60a518 a532589fee092c92 5dad8f2f77f67f8b",
        "3f4d5c60 3fab595c 3fc5b5d4 3fc9f610 24e82620c8f07808 667e82bbce99bd4c",
        "3e6f4d7f 3f52dd2a 3f74eeac 3f77ad6a a532589fee092c92 dd05d82f6ed0983b",
        "3e7c8e78 3f4401a8 3f4e2350 3f50bc95 a532589fee092c92 dd05d82f6ed0983b",
        "3eeaefaa 3f188583 3f607f47 3f699b17 a3aaf2f9064ced7f 43a0b8dcc3ec0034",
        "3e15c193 3e1c687e 3e7e499b 3ec7e627 1bf3536eedb4d28f f8d764e931ed4286",
    ];
    assert_eq!(lines, pinned);
    Ok(())
}

#[test]
fn value_stability_cell_points() -> Result<(), WorleyError> {
    fn lines<const N: usize>(worley: &Worley<N>, cell: [i64; N]) -> Vec<String>
    where
        Dimensions: Space<N>,
    {
        let points = worley.cell_points(cell).into_iter().take(2);
        let line = |point: dapple_worley::CellPoint<Vector<N>>| {
            let offset: [f64; N] = point.offset.into();
            // Steps of a cell.
            let steps = offset.map(|part| (part * f64::from(1 << 21)).to_string());
            format!("{} {:016x}", steps.join(" "), point.id)
        };
        points.map(line).collect()
    }
    let jittered = Scatter::Jittered { jitter: 0.5 };
    let found = [
        lines(&Worley::<2>::new(Seed(7)), [3, -5]),
        lines(&Worley::<3>::new(Seed(7)), [3, -5, 1 << 40]),
        lines(&Worley::<4>::new(Seed(7)), [3, -5, 1 << 40, 0]),
        lines(&Worley::<2>::new(Seed(7)).with_scatter(jittered)?, [0, 0]),
    ];
    let pinned: [&[&str]; 4] = [
        &[
            "1304776 1250463 d2803661b071306f",
            "1324959 1416505 c01ce24997c7bd82",
        ],
        &[
            "1276639 1033674 1511345 6adf6c8d6058d7f1",
            "547426 1466961 300682 9155f055f902b22c",
        ],
        &["82416 1530864 1858640 143952 d9d7061b7835e67f"],
        &["831076 1066169 a532589fee092c92"],
    ];
    assert_eq!(found, pinned);
    Ok(())
}

#[test]
fn value_stability_combinations() {
    let worley = Worley::<2>::new(Seed(7));
    let combinations = [
        Combination::F1,
        Combination::F2,
        Combination::F3,
        Combination::F4,
        Combination::F2_MINUS_F1,
        Combination::F1_PLUS_F2,
        Combination::F3_MINUS_F2,
        Combination::TWO_F3_MINUS_F2_MINUS_F1,
        Combination::new([0.1, -0.2, 0.3, -0.4]),
    ];
    let values = combinations.map(|combination| worley.combine(combination).value([0.25, 0.75]));
    assert_eq!(
        bits(values),
        "3e72c42c 3e9bbd57 3ee8520e 3f0691ee 3d896d04 3f0a8fb6 3e19296e 3ebb84b0 bde3e0be"
    );
}

#[test]
fn value_stability_fractal() -> Result<(), WorleyError> {
    let texture = Worley::<3>::new(Seed(7)).combine(Combination::F2_MINUS_F1);
    let own = Octaves {
        count: 3,
        lacunarity: 2.5,
        gain: 0.75,
        seeds: OctaveSeeds::Own,
    };
    let same = texture.fractal(Octaves::paper())?;
    let own = texture.fractal(own)?;
    let values = (0..3).map(position::<3>);
    let values = values.flat_map(|at| [same.value(at), own.value(at)]);
    assert_eq!(
        bits(values),
        "3f01448e 3e9dca28 3ec65af5 3dccc782 3e1beeb7 3e84a895"
    );
    Ok(())
}

#[test]
fn value_stability_radial() -> Result<(), WorleyError> {
    let hull = Worley::<3>::new(Seed(7)).with_metric(Metric::Manhattan)?;
    let cells = RadialCells {
        around: 24,
        polar: 12.0,
        radial: 0.5,
    };
    let star = Radial::new(hull.combine(Combination::F1), cells)?;
    let values = [[0.5, -0.25, 0.75], [-3.0, 0.125, -2.0], [0.0, 0.0, 1.0]];
    assert_eq!(
        bits(values.map(|at| star.value(at))),
        "3e74e600 3ed7f820 3f27d888"
    );
    Ok(())
}

#[test]
fn value_stability_voronoi() -> Result<(), WorleyError> {
    let [plane, space] = [Worley::<2>::new(Seed(7)), Worley::<2>::new(Seed(8))];
    let mut values = Vec::new();
    for at in (0..3).map(position::<2>) {
        values.push(plane.edge_distance(at));
        values.push(plane.sphere_radius(at));
        values.push(plane.smooth_f1(at, 0.5)?);
        values.push(space.edge_distance(at));
    }
    assert_eq!(
        bits(values),
        "3d0c6742 3e815b06 3e1c0c2f 3d885647 3da91ac9 3ec47b50 3eaf085b 3e5c5708 3ea2ff4e 3ece89d2 3e768da0 3c052a4d"
    );
    Ok(())
}

#[test]
fn value_stability_feature_set() -> Result<(), WorleyError> {
    let points: Vec<glam::DVec2> = (0..20)
        .map(|index| glam::DVec2::new(f64::from(index * 7 % 20), f64::from(index * index % 13)))
        .collect();
    let set = FeatureSet::new(&points, [Some(20.0), None])?;
    let lines = [[0.25, 0.75], [-33.0, 4.5], [9.5, 1e3]].map(|at| line::<2>(&set.sample(at)));
    let pinned: [&str; 3] = [
        "3f4a62c2 4010e2dc 4024bae7 40636719 0000000000000000 0000000000000009",
        "3fe6c15a 4003f07b 40600000 4088b43d 0000000000000004 0000000000000009",
        "44770066 447700fb 4477015e 447705e7 0000000000000012 0000000000000008",
    ];
    assert_eq!(lines, pinned);
    Ok(())
}
