//! Tests of domains of extreme sizes. A wrapping domain much thinner than the distance between its points gets a graph
//! or an error within a short time. Tiny and huge domains get the same graphs as others.

use dapple_graph::glam::DVec2;
use dapple_graph::points::hash::{Seed, rand_core::Rng, unit_f64};
use dapple_graph::points::{Domain, PointSet};
use dapple_graph::{EdgeDirection, Graph, GraphError, GraphErrorKind};
use dapple_graph::{delaunay, gabriel, k_nearest, yao};

/// Returns `n` random points on a torus of width 1 and the given height.
fn points(n: usize, height: f64) -> PointSet {
    let size = DVec2::new(1.0, height);
    let mut stream = Seed(7).stream();
    let mut unit = || unit_f64(stream.next_u64());
    let positions = (0..n).map(|_| DVec2::new(unit(), unit()) * size).collect();
    PointSet::new(Domain::torus(DVec2::ZERO, size), positions).unwrap()
}

fn graphs(points: &PointSet) -> [Result<Graph, GraphError>; 4] {
    [
        delaunay(points),
        gabriel(points),
        k_nearest(points, 6, EdgeDirection::Directed),
        yao(points, 7, EdgeDirection::Directed),
    ]
}

#[test]
fn tori_down_to_a_tenth_of_the_spacing_have_graphs() {
    for (n, height) in [(1, 1e-4), (2, 1e-3), (10, 1e-3), (100, 1e-3), (1000, 1e-4)] {
        for (index, graph) in graphs(&points(n, height)).into_iter().enumerate() {
            let graph = graph.unwrap_or_else(|error| panic!("{n} {height} {index}: {error}"));
            graph.sanity_check().unwrap();
        }
    }
}

#[test]
fn tori_that_need_too_many_copies_are_refused() {
    for n in [1, 2, 100] {
        for height in [1e-9, 1e-300] {
            let points = points(n, height);
            let [delaunay, gabriel, _, yao] = graphs(&points);
            for graph in [delaunay, gabriel, yao] {
                let error = graph.expect_err("it is too thin");
                let GraphErrorKind::Thin { size, limit } = *error.kind() else {
                    // Below the last digit of the lattice, all points lie in one row, and some at one place.
                    assert!(
                        matches!(error.kind(), GraphErrorKind::Coincident { .. }),
                        "{n} {height}: {error}"
                    );
                    continue;
                };
                assert_eq!(size.y, height, "{error}");
                let text = error.to_string();
                assert!(text.contains(&limit.to_string()), "{text}");
            }
        }
    }
}

#[test]
fn graphs_of_tiny_and_huge_domains_are_sane() {
    for scale in [f64::MIN_POSITIVE, 1e-300, 1e-160, 1e160, 1e300] {
        let unit = points(30, 0.7);
        let domain = Domain::torus(DVec2::ZERO, unit.domain().size * scale);
        let positions = unit.positions().iter().map(|&at| at * scale).collect();
        let scaled = PointSet::new(domain, positions).unwrap();
        for graph in graphs(&scaled).into_iter().flatten() {
            assert_eq!(graph.sanity_check(), Ok(()), "{scale:e}");
        }
        let single = PointSet::new(domain, vec![DVec2::ZERO]).unwrap();
        let graph = delaunay(&single).unwrap();
        assert_eq!(graph.sanity_check(), Ok(()), "{scale:e}");
    }
}
