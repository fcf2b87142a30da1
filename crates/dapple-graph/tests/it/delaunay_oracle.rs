//! Compares the Delaunay graph with a brute-force search over all pairs of images, in exact arithmetic.

use dapple_graph::glam::DVec2;
use dapple_graph::points::hash::{Seed, rand_core::Rng};
use dapple_graph::points::{Domain, PointIdx, PointSet};
use dapple_graph::{Graph, GraphErrorKind, delaunay};

/// An edge: from, to, and the vector.
type Edge = (u32, u32, i64, i64);

/// Points with integer coordinates relative to the origin. They are below 2^20, so that sums of two products are exact
/// in an `f64`.
struct Case {
    size: DVec2,
    wrap: [bool; 2],
    sites: Vec<DVec2>,
}

impl Case {
    fn points(&self) -> PointSet {
        let domain = Domain {
            origin: DVec2::new(-3.0, 16.0),
            size: self.size,
            wrap: self.wrap,
        };
        let position = |site: &DVec2| domain.origin + *site;
        PointSet::new(domain, self.sites.iter().map(position).collect()).unwrap()
    }

    /// Returns the Delaunay edges by brute force. Two images are connected if a circle through both has no other image
    /// on it or in it. The centers of circles through both are on the bisector, at a parameter t, and each other image
    /// excludes a half-line of them.
    fn oracle(&self) -> Vec<Edge> {
        let diagonal = self.size.x + self.size.y;
        let reach = |axis: usize| {
            let periods = (2.0 * diagonal / self.size[axis]) as i32 + 2;
            if self.wrap[axis] { periods } else { 0 }
        };
        let mut images = Vec::new();
        for y in -reach(1)..=reach(1) {
            for x in -reach(0)..=reach(0) {
                for (to, &site) in (0..).zip(&self.sites) {
                    images.push((
                        to,
                        site + self.size * DVec2::new(f64::from(x), f64::from(y)),
                    ));
                }
            }
        }
        let mut edges = Vec::new();
        for (from, &p) in (0..).zip(&self.sites) {
            // Nearest first, so that hopeless pairs are found out early.
            images.sort_by(|a, b| {
                (a.1 - p)
                    .length_squared()
                    .total_cmp(&(b.1 - p).length_squared())
            });
            for &(to, q) in &images {
                if q != p && is_edge(p, q, &images) {
                    edges.push(edge(from, to, q - p));
                }
            }
        }
        edges.sort_unstable();
        edges
    }
}

fn edge(from: u32, to: u32, vector: DVec2) -> Edge {
    (from, to, vector.x as i64, vector.y as i64)
}

fn is_edge(p: DVec2, q: DVec2, images: &[(u32, DVec2)]) -> bool {
    // Fractions with a positive denominator: t lies above `low` and below `high`.
    let (mut low, mut high) = (None, None);
    let less =
        |a: (f64, f64), b: (f64, f64)| a.0 as i128 * b.1 as i128 - (b.0 as i128 * a.1 as i128) < 0;
    for &(_, r) in images {
        if r == p || r == q {
            continue;
        }
        let dot = (r - p).dot(r - q);
        let cross = (q - p).perp_dot(r - p);
        if cross == 0.0 {
            if dot < 0.0 {
                return false;
            }
        } else if cross > 0.0 {
            let t = (dot, cross);
            high = Some(high.map_or(t, |best| if less(t, best) { t } else { best }));
        } else {
            let t = (-dot, -cross);
            low = Some(low.map_or(t, |best| if less(best, t) { t } else { best }));
        }
        if let (Some(low), Some(high)) = (low, high)
            && !less(low, high)
        {
            return false;
        }
    }
    true
}

fn edges(graph: &Graph) -> Vec<Edge> {
    let mut edges = Vec::new();
    for from in (0..graph.n_points() as u32).map(PointIdx) {
        for axis in graph.axes(from) {
            assert_eq!(axis.vector, axis.vector.floor(), "whole numbers stay whole");
            edges.push(edge(from.0, axis.to.0, axis.vector));
        }
    }
    edges.sort_unstable();
    edges
}

fn check(case: &Case, name: &str) {
    let graph = delaunay(&case.points()).unwrap();
    let what = format!(
        "{name}, {} on {} {:?}: {:?}",
        case.sites.len(),
        case.size,
        case.wrap,
        case.sites
    );
    assert_eq!(edges(&graph), case.oracle(), "{what}");
}

const WRAPS: [[bool; 2]; 4] = [[false, false], [true, false], [false, true], [true, true]];

/// Returns `n` distinct positions drawn from `site`.
fn distinct(n: usize, mut site: impl FnMut() -> DVec2) -> Vec<DVec2> {
    let mut sites: Vec<DVec2> = Vec::new();
    while sites.len() < n {
        let next = site();
        if !sites.contains(&next) {
            sites.push(next);
        }
    }
    sites
}

#[test]
fn delaunay_of_random_points_equals_the_oracle() {
    let mut stream = Seed(1).stream();
    let mut below = |n: u32| f64::from(stream.next_u32() % n);
    for round in 0..6 {
        for n in (1..=9).chain([17]) {
            for wrap in WRAPS {
                let size = DVec2::new(600.0 + below(200), 500.0 + below(700));
                let sites = distinct(n, || DVec2::new(below(size.x as u32), below(size.y as u32)));
                check(
                    &Case { size, wrap, sites },
                    &format!("random, round {round}"),
                );
            }
        }
    }
}

#[test]
fn delaunay_of_co_circular_points_equals_the_oracle() {
    // On a coarse grid, most circles through three points go through a fourth.
    let mut stream = Seed(2).stream();
    let mut below = |n: u32| f64::from(stream.next_u32() % n);
    for round in 0..12 {
        for n in 1..=8 {
            for wrap in WRAPS {
                let size = DVec2::new(3.0 + below(3), 3.0 + below(4));
                let sites = distinct(n, || DVec2::new(below(size.x as u32), below(size.y as u32)));
                check(
                    &Case { size, wrap, sites },
                    &format!("coarse, round {round}"),
                );
            }
        }
    }
}

#[test]
fn delaunay_of_clusters_and_lines_equals_the_oracle() {
    let mut stream = Seed(3).stream();
    let mut below = |n: u32| f64::from(stream.next_u32() % n);
    let size = DVec2::new(1000.0, 700.0);
    for n in [1, 2, 3, 5, 12] {
        for wrap in WRAPS {
            let clustered = distinct(n, || DVec2::new(10.0 + below(9), 650.0 + below(9)));
            let horizontal = distinct(n, || DVec2::new(below(1000), 30.0));
            let vertical = distinct(n, || DVec2::new(999.0, below(700)));
            let diagonal = distinct(n, || DVec2::splat(below(700)));
            let borders = distinct(n, || DVec2::new(below(2) * 999.0, below(700)));
            let flat = distinct(n, || DVec2::new(below(3), below(700)));
            for sites in [clustered, horizontal, vertical, diagonal, borders, flat] {
                check(&Case { size, wrap, sites }, "special");
            }
        }
    }
}

#[test]
fn delaunay_on_a_long_domain_equals_the_oracle() {
    let mut stream = Seed(4).stream();
    let mut below = |n: u32| f64::from(stream.next_u32() % n);
    for n in [1, 2, 3, 4] {
        for wrap in WRAPS {
            for size in [DVec2::new(200.0, 17.0), DVec2::new(13.0, 150.0)] {
                let sites = distinct(n, || DVec2::new(below(size.x as u32), below(size.y as u32)));
                check(&Case { size, wrap, sites }, "long");
            }
        }
    }
}

#[test]
fn delaunay_refuses_points_at_the_same_place() {
    for wrap in WRAPS {
        let sites = [(1, 1), (5, 2), (3, 0), (5, 2), (1, 1), (1, 1)];
        let sites = sites.map(|(x, y)| DVec2::new(f64::from(x), f64::from(y)));
        let case = Case {
            size: DVec2::splat(10.0),
            wrap,
            sites: sites.to_vec(),
        };
        let error = delaunay(&case.points()).unwrap_err();
        let kind = GraphErrorKind::Coincident {
            first: PointIdx(0),
            second: PointIdx(4),
        };
        assert_eq!(error.kind(), &kind, "{error}");
    }
}

#[test]
fn delaunay_of_no_points_is_empty() {
    for wrap in WRAPS {
        let case = Case {
            size: DVec2::ONE,
            wrap,
            sites: Vec::new(),
        };
        let graph = delaunay(&case.points()).unwrap();
        assert_eq!((graph.n_points(), graph.n_axes()), (0, 0), "{wrap:?}");
    }
}
