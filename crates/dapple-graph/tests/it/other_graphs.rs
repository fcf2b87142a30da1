//! Compares nearest-neighbor, Yao and Gabriel graphs with a brute-force search over all images of points.

use dapple_graph::glam::DVec2;
use dapple_graph::points::hash::{Seed, rand_core::Rng};
use dapple_graph::points::{Domain, PointIdx, PointSet};
use dapple_graph::{EdgeDirection, Graph, GraphErrorKind, delaunay, gabriel, k_nearest, yao};

type Edge = (u32, u32, i64, i64);

/// Returns `n` random points with integer coordinates.
fn points(seed: u64, n: usize, wrap: [bool; 2], size: DVec2) -> PointSet {
    let mut stream = Seed(seed).stream();
    let mut positions: Vec<DVec2> = Vec::new();
    while positions.len() < n {
        let mut below = |side: f64| f64::from(stream.next_u32() % side as u32);
        let next = DVec2::new(below(size.x), below(size.y));
        if !positions.contains(&next) {
            positions.push(next);
        }
    }
    let domain = Domain {
        origin: DVec2::ZERO,
        size,
        wrap,
    };
    PointSet::new(domain, positions).unwrap()
}

/// Returns all images within six periods except the point itself, sorted by distance, index and angle.
fn neighbors(points: &PointSet, from: PointIdx) -> Vec<(u32, DVec2)> {
    let domain = points.domain();
    let reach = domain.wrap.map(|wraps| if wraps { 6 } else { 0 });
    let mut found = Vec::new();
    for y in -reach[1]..=reach[1] {
        for x in -reach[0]..=reach[0] {
            let image = domain.size * DVec2::new(f64::from(x), f64::from(y));
            for (to, position) in points.iter() {
                let vector = position + image - points.position(from);
                if vector != DVec2::ZERO {
                    found.push((to.0, vector));
                }
            }
        }
    }
    let key = |v: DVec2| {
        (
            v.length_squared(),
            libm::atan2(v.y, v.x).rem_euclid(core::f64::consts::TAU),
        )
    };
    found.sort_by(|a, b| {
        let ((a_sq, a_angle), (b_sq, b_angle)) = (key(a.1), key(b.1));
        (a_sq.total_cmp(&b_sq))
            .then(a.0.cmp(&b.0))
            .then(a_angle.total_cmp(&b_angle))
    });
    found
}

fn edge(from: PointIdx, to: u32, vector: DVec2) -> Edge {
    (from.0, to, vector.x as i64, vector.y as i64)
}

fn edges(graph: &Graph) -> Vec<Edge> {
    graph.sanity_check().unwrap();
    let mut edges = Vec::new();
    for from in (0..graph.n_points() as u32).map(PointIdx) {
        edges.extend(
            graph
                .axes(from)
                .iter()
                .map(|axis| edge(from, axis.to.0, axis.vector)),
        );
    }
    edges.sort_unstable();
    edges
}

/// Returns the edges from each point to the neighbors that `choose` returns.
fn oracle(points: &PointSet, choose: impl Fn(Vec<(u32, DVec2)>) -> Vec<(u32, DVec2)>) -> Vec<Edge> {
    let mut edges = Vec::new();
    for (from, _) in points.iter() {
        let chosen = choose(neighbors(points, from));
        edges.extend(
            chosen
                .into_iter()
                .map(|(to, vector)| edge(from, to, vector)),
        );
    }
    edges.sort_unstable();
    edges
}

/// Returns sets of 1 to 16 points on domains with every kind of wrapping.
fn sets() -> impl Iterator<Item = PointSet> {
    let wraps = [[false, false], [true, false], [false, true], [true, true]];
    [1, 2, 3, 7, 16].into_iter().flat_map(move |n| {
        wraps.into_iter().flat_map(move |wrap| {
            let sizes = [DVec2::new(9.0, 8.0), DVec2::new(300.0, 500.0)];
            sizes.map(|size| points(n as u64, n, wrap, size))
        })
    })
}

#[test]
fn k_nearest_equals_a_search_through_all_images() {
    for points in sets() {
        for k in [1, 2, 3, 6] {
            let limit = if points.domain().wrap == [false; 2] {
                points.len() as u32 - 1
            } else {
                6
            };
            if k > limit {
                continue;
            }
            let graph = k_nearest(&points, k, EdgeDirection::Directed).unwrap();
            let first = |mut all: Vec<_>| {
                all.truncate(k as usize);
                all
            };
            assert_eq!(edges(&graph), oracle(&points, first), "{k} of {points:?}");
        }
    }
}

#[test]
fn yao_equals_a_search_through_all_images() {
    for points in sets() {
        for cones in [1, 2, 4, 6, 7, 12] {
            let graph = yao(&points, cones, EdgeDirection::Directed).unwrap();
            let first_per_cone = |all: Vec<(u32, DVec2)>| {
                let mut taken = vec![false; cones as usize];
                let is_first = |&(_, v): &(u32, DVec2)| {
                    let angle = libm::atan2(v.y, v.x).rem_euclid(core::f64::consts::TAU);
                    // No border but those in the directions of the axes, which are exact, comes closer than 1e-9 to
                    // a direction between these whole numbers; others lie on the near side of rounding.
                    let cone = (angle / core::f64::consts::TAU * f64::from(cones) + 1e-12) as usize;
                    !core::mem::replace(&mut taken[cone % cones as usize], true)
                };
                all.into_iter().filter(is_first).collect()
            };
            assert_eq!(
                edges(&graph),
                oracle(&points, first_per_cone),
                "{cones} on {points:?}"
            );
        }
    }
}

#[test]
fn gabriel_equals_a_search_through_all_images() {
    for points in sets() {
        let graph = gabriel(&points).unwrap();
        let empty_circle = |all: Vec<(u32, DVec2)>| {
            let is_empty = |&(_, v): &(u32, DVec2)| {
                let outside = |other: &(u32, DVec2)| other.1 == v || other.1.dot(other.1 - v) > 0.0;
                all.iter().all(outside)
            };
            all.iter().copied().filter(is_empty).collect()
        };
        assert_eq!(edges(&graph), oracle(&points, empty_circle), "{points:?}");
        assert!(graph.is_symmetric(), "{points:?}");
    }
}

#[test]
fn symmetric_graphs_are_symmetric() {
    for points in sets() {
        let graph = yao(&points, 6, EdgeDirection::Symmetric).unwrap();
        assert!(graph.is_symmetric(), "yao of {points:?}");
        graph.sanity_check().unwrap();
        if points.len() > 3 {
            let graph = k_nearest(&points, 3, EdgeDirection::Symmetric).unwrap();
            assert!(graph.is_symmetric(), "3 nearest of {points:?}");
            graph.sanity_check().unwrap();
        }
    }
}

#[test]
fn adjacency_of_a_graph_makes_the_graph_again() {
    // With many points, all edges are the shortest way around.
    let points = points(5, 200, [true, true], DVec2::new(1000.0, 700.0));
    let graph = delaunay(&points).unwrap();
    graph.sanity_check().unwrap();
    let rows: Vec<Vec<PointIdx>> = (0..200)
        .map(|from| {
            graph
                .axes(PointIdx(from))
                .iter()
                .map(|axis| axis.to)
                .collect()
        })
        .collect();
    assert_eq!(Graph::from_adjacency(&points, &rows).unwrap(), graph);
}

#[test]
fn bad_input_is_refused() {
    let rectangle = points(1, 5, [false, false], DVec2::splat(100.0));
    let kind = |result: Result<Graph, dapple_graph::GraphError>| result.unwrap_err().kind().clone();
    for k in [0, 5] {
        let expected = GraphErrorKind::Neighbors { k, limit: 4 };
        assert_eq!(
            kind(k_nearest(&rectangle, k, EdgeDirection::Directed)),
            expected
        );
    }
    for cones in [0, 33] {
        let expected = GraphErrorKind::Cones { cones, limit: 32 };
        assert_eq!(
            kind(yao(&rectangle, cones, EdgeDirection::Directed)),
            expected
        );
    }
    let (from, to, n_points) = (PointIdx(0), PointIdx(9), 5);
    let mut rows = vec![vec![to]; 5];
    let expected = GraphErrorKind::NoSuchPoint { from, to, n_points };
    assert_eq!(kind(Graph::from_adjacency(&rectangle, &rows)), expected);
    rows[0] = vec![PointIdx(0)];
    let expected = GraphErrorKind::Coincident {
        first: from,
        second: from,
    };
    assert_eq!(kind(Graph::from_adjacency(&rectangle, &rows)), expected);
    let expected = GraphErrorKind::Rows {
        rows: 1,
        n_points: 5,
    };
    assert_eq!(
        kind(Graph::from_adjacency(&rectangle, &rows[..1])),
        expected
    );
}

#[test]
fn points_closer_than_a_step_of_the_lattice_coincide_and_the_error_says_so() {
    let domain = Domain {
        origin: DVec2::ZERO,
        size: DVec2::splat(1e13),
        wrap: [false; 2],
    };
    // 1e13 is between 2^43 and 2^44, so that the step is 2^-6.
    let graph = |x: f64| {
        let positions = [[0.0, 0.0], [x, 0.0], [0.0, 1.0], [9e12, 0.0]];
        let points = PointSet::new(domain, positions.map(DVec2::from).to_vec()).unwrap();
        delaunay(&points).map(|_| ())
    };
    let error = graph(0.005).unwrap_err().to_string();
    assert!(error.contains("points 0 and 1 coincide"), "{error}");
    assert!(error.contains("2^-50"), "{error}");
    assert_eq!(graph(0.02), Ok(()));
}
