//! Pinned values of the crate, which must not change by accident.
//!
//! Each test writes its numbers as lines of text, floating-point numbers as their bits. To pin new values, copy the
//! lines that a failing test prints.

use super::oracle::SCATTERS;
use dapple_hash::Seed;
use dapple_worley::{
    Axes, Combination, Feature, FeatureSet, Metric, OctaveSeeds, Octaves, Radial, RadialCells,
    Scatter, Space, Vector, Worley, WorleyError,
};

fn line<const N: usize>(features: &[Feature<Vector<N>>; 4]) -> String
where
    Axes: Space<N>,
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
    Axes: Space<N>,
{
    Vector::<N>::from(core::array::from_fn(|axis| POSITIONS[index][axis]))
}

fn samples<const N: usize>() -> Vec<String>
where
    Axes: Space<N>,
{
    let worley = Worley::<N>::new(Seed(7));
    (0..3)
        .map(|index| line::<N>(&worley.sample(position::<N>(index))))
        .collect()
}

#[test]
fn value_stability_sample2() {
    let pinned: [&str; 3] = [
        "3ec59e52 3ef55dc5 3f24258f 3f470d86 a326155d0385fa4e 8f74756a752a1fd3",
        "3e765ddd 3e7f54c4 3ec7cb50 3f0a5464 e9c478d67849001e 6ef96eec6d1f59bb",
        "3ebe90fb 3ee6b844 3ee85d41 3f047b13 708ba23c066742b9 8d9978bab6747855",
    ];
    assert_eq!(samples::<2>(), pinned);
}

#[test]
fn value_stability_sample3() {
    let pinned: [&str; 3] = [
        "3ea41148 3f255edf 3f2e5c8d 3f315eb7 33d1c5fb6eb4a1f8 78a7fe2178ffb50e",
        "3ee88c9e 3f03598a 3f397bb1 3f3b0b57 6fbec6112713285c aeef5fc299b5feae",
        "3ed899df 3f222bc3 3f2acada 3f3d5f68 9884783c33413e33 ed8630eeb38ec853",
    ];
    assert_eq!(samples::<3>(), pinned);
}

#[test]
fn value_stability_sample4() {
    let pinned: [&str; 3] = [
        "3ee89c1d 3f06fa40 3f1b5b8f 3f22a89a 7a88ef7b99594b0c c034b07c8a439c17",
        "3ecf188c 3f311506 3f32f863 3f36821c 930b28d2f7789ace c48e65450a2fce63",
        "3ef541c5 3f0fbd10 3f1da37e 3f229f8f e51026e944c01dcb cc8a330fe78bd283",
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
        "3f4d3286 3f6a736c 3f7e2eb8 3f8a4892 ce416b55e659cfd6 273e550aac7661f2",
        "3f364cf0 3f4b9b40 3f79bd78 3f7a04c8 52db6b0fb6de7717 d5408f84e73aef39",
        "3fe704d8 3feed690 40008b0e 4008c568 f4a3091f884cebb4 f1bb01c582b1774a",
        "3f3a43e4 3f69f0c0 3f6c5563 3f810bbf ce416b55e659cfd6 133bb181e2a09948",
        "3ec2b315 3f4a85c6 3f5900b2 3f61d658 ce416b55e659cfd6 3b70f8ced95e5d13",
        "3ef9a346 3efbbdb2 3f2835b5 3f300eb4 636be2fbb9fdff63 3112a833849aa00f",
        "3d543500 3e765ddd 3e7f54c4 3ea5c2d2 3ad65b0bf1e103e6 dda1d6b1067a2881",
    ];
    assert_eq!(lines, pinned);
    Ok(())
}

#[test]
fn value_stability_cell_points() -> Result<(), WorleyError> {
    fn lines<const N: usize>(worley: &Worley<N>, cell: [i64; N]) -> Vec<String>
    where
        Axes: Space<N>,
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
            "1022443 1917839 e15c1ee4f65b806a",
            "94083 274558 eeaf559abcc359ca",
        ],
        &[
            "1436410 1678511 643391 3701ff80dafa9649",
            "576134 1554070 1234963 beed7b206ea105b0",
        ],
        &[
            "51536 1215152 813744 1697136 719c6822037bb544",
            "393680 218224 677808 902032 7ed5b1f6c0f172e3",
        ],
        &["1250386 609887 ce416b55e659cfd6"],
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
        "3ec59e52 3ef55dc5 3f24258f 3f470d86 3dbefdcc 3f5d7e0c 3e25dab2 3ed59a24 be34219c"
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
        "3eddfc75 3e8ac05d 3dd262f9 3e3c1286 3e8638d4 3f06130d"
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
        "3ee2ec90 3efc5fd0 3f12cb78"
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
        "3d3f26e4 3e2bb2ee 3ea2c23a 3e6a8a1e 3bb7f540 3e439601 3e0122fb 3e7c6185 3d53b19f 3e1e95ac 3e7a01cb 3e4007f1"
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
