//! Control nets for the tests.

use dapple_graph::{EdgeDirection, Graph, GraphError, delaunay, k_nearest, yao};
use dapple_hash::{Seed, hash1, unit_f32, unit_f64};
use dapple_points::{Domain, PointIdx, PointSet, poisson_disk, white_noise};
use dapple_pups::{AxialWeight, Orientation, Pups, PupsOptions, Texture};
use glam::{DVec2, DVec3};

/// A test case: a name, points, a graph over them, and options.
pub(super) struct Case {
    pub(super) name: String,
    pub(super) points: PointSet,
    pub(super) graph: Graph,
    pub(super) options: PupsOptions,
    /// Whether the graph contains the Delaunay graph.
    pub(super) is_delaunay: bool,
}

impl Case {
    pub(super) fn pups(&self) -> Pups {
        Pups::new(&self.points, &self.graph, self.options.clone()).unwrap()
    }

    pub(super) fn values(&self) -> Vec<f32> {
        values(self.points.len())
    }

    pub(super) fn texture(&self) -> Texture {
        self.pups().texture(self.values()).unwrap()
    }
}

/// Returns random values in `[0, 1)`.
pub(super) fn values(count: usize) -> Vec<f32> {
    let random = |index| unit_f32((hash1(Seed(11), [index], 0) >> 32) as u32);
    (0..).map(random).take(count).collect()
}

/// Returns random positions in and around a domain.
pub(super) fn positions(domain: &Domain, count: i64) -> impl Iterator<Item = DVec2> {
    let Domain { origin, size, .. } = *domain;
    (0..count).map(move |index| {
        let random = |lane| unit_f64(hash1(Seed(13), [index], lane)) * 1.4 - 0.2;
        origin + size * DVec2::new(random(0), random(1))
    })
}

/// Returns random unit vectors, some of them along an axis.
pub(super) fn orientations(count: usize) -> Vec<DVec3> {
    let random = |index: i64, lane| unit_f64(hash1(Seed(17), [index], lane)) * 2.0 - 1.0;
    let vector = |index: i64| match index % 5 {
        0 => DVec3::Z,
        1 => DVec3::X,
        _ => DVec3::new(random(index, 0), random(index, 1), random(index, 2)),
    };
    (0..).map(vector).take(count).collect()
}

/// Returns nets of one to many points on domains with every kind of wrapping, with every option, and on other graphs.
pub(super) fn cases() -> Vec<Case> {
    let mut cases = Vec::new();
    for wrap in [[true, true], [false, true], [true, false], [false, false]] {
        for (count, size) in [
            (1, [1.0, 1.0]),
            (2, [1.0, 3.0]),
            (3, [2.0, 0.5]),
            (7, [1.0, 1.0]),
            (60, [1.5, 1.0]),
        ] {
            let domain = Domain {
                origin: DVec2::new(-0.3, 7.0),
                size: DVec2::from(size),
                wrap,
            };
            let points = white_noise(domain, count, Seed(count as u64)).unwrap();
            let graph = delaunay(&points).unwrap();
            for (label, options) in options(count as usize) {
                let name = format!("{count} points, wrap {wrap:?}, {label}");
                cases.push(Case {
                    name,
                    points: points.clone(),
                    graph: graph.clone(),
                    options,
                    is_delaunay: true,
                });
            }
        }
    }
    cases.push(hub());
    cases.extend(other_graphs());
    cases
}

/// Returns nets of graphs that close every support but are not Delaunay graphs.
fn other_graphs() -> Vec<Case> {
    let points = poisson_disk(Domain::paper_torus(), 0.3, Seed(2)).unwrap();
    let graphs = [
        ("a Yao graph", yao(&points, 12, EdgeDirection::Symmetric)),
        (
            "a directed Yao graph",
            yao(&points, 8, EdgeDirection::Directed),
        ),
        (
            "nearest neighbors",
            k_nearest(&points, 12, EdgeDirection::Directed),
        ),
    ];
    let case = |(name, graph): (&str, Result<Graph, GraphError>)| {
        let options = PupsOptions::default();
        Case {
            name: name.into(),
            points: points.clone(),
            graph: graph.unwrap(),
            options,
            is_delaunay: false,
        }
    };
    graphs.map(case).into()
}

/// Returns a net with one point that has 40 axes, which fill five blocks.
fn hub() -> Case {
    let rim = (0..40).map(|index| f64::from(index) * core::f64::consts::TAU / 40.0);
    let mut positions: Vec<DVec2> = rim
        .map(|angle| DVec2::new(libm::cos(angle), libm::sin(angle)) * 0.4)
        .collect();
    positions.push(DVec2::ZERO);
    let domain = Domain::rectangle(DVec2::splat(-0.5), DVec2::ONE);
    let points = PointSet::new(domain, positions).unwrap();
    let mut rows: Vec<Vec<PointIdx>> = (0..40)
        .map(|at| [(at + 39) % 40, (at + 1) % 40, 40].map(PointIdx).to_vec())
        .collect();
    rows.push((0..40).map(PointIdx).collect());
    let graph = Graph::from_adjacency(&points, &rows).unwrap();
    Case {
        name: "a hub".into(),
        points,
        graph,
        options: PupsOptions::default(),
        is_delaunay: true,
    }
}

fn options(count: usize) -> Vec<(String, PupsOptions)> {
    let orientation =
        |strength| Some(Orientation::new(orientations(count)).with_strength(strength));
    let plain = PupsOptions::default();
    vec![
        ("plain".into(), plain.clone()),
        (
            "axis scale 2".into(),
            PupsOptions {
                axis_scale: 2.0,
                ..plain.clone()
            },
        ),
        (
            "axis scale 0.6".into(),
            PupsOptions {
                axis_scale: 0.6,
                ..plain.clone()
            },
        ),
        (
            "oriented by 0.5".into(),
            PupsOptions {
                orientation: orientation(0.5),
                ..plain.clone()
            },
        ),
        (
            "oriented by 0.9".into(),
            PupsOptions {
                orientation: orientation(0.9),
                ..plain.clone()
            },
        ),
        (
            "quintic".into(),
            PupsOptions {
                weight: AxialWeight::Quintic,
                ..plain.clone()
            },
        ),
        (
            "fading".into(),
            PupsOptions {
                fade: 0.25,
                ..plain.clone()
            },
        ),
        (
            "fading, oriented by 0.4".into(),
            PupsOptions {
                fade: 1.0,
                weight: AxialWeight::Quintic,
                orientation: orientation(0.4),
                ..plain.clone()
            },
        ),
        (
            "oscillating".into(),
            PupsOptions {
                weight: AxialWeight::Oscillating {
                    dips: 3,
                    depth: 0.8,
                },
                orientation: orientation(0.3),
                ..plain
            },
        ),
    ]
}
