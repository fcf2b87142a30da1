//! The Delaunay graph, in the plane and on domains that wrap.
//!
//! Reference: Boris Delaunay, "Sur la sphère vide", Izvestia Akademii Nauk SSSR, 1934. The crate `spade` computes the
//! triangulations.
//!
//! On a wrapping domain, the graph connects the points and all of their images (periodic copies), restricted to the
//! points in the domain. Only a few images are needed: first those in a margin around the domain, then, circle by
//! circle, those inside the circumcircle of a triangle at a point of the domain. When no such circumcircle contains
//! another image, all of these triangles belong to the true triangulation. Any number of points is accepted, including
//! one or two, and points may be connected to their own images.
//!
//! If four or more points (including images) are on one empty circle, the triangulation is not unique. The diagonals
//! in that circle are dropped, by exact predicates. The remaining graph is unique: it connects the pairs of points
//! whose Voronoi cells share a side of positive length. It is the same for all images and does not depend on the
//! origin of the domain.

mod hull;
mod images;
mod line;
mod order;
mod patch;
mod star;
mod tiles;
pub(crate) mod triangles;
mod triangulate;

pub use triangles::{Triangle, delaunay_triangles, delaunay_triangles_cancellable};

use crate::grid::{Budget, LazyGrid, TooThin};
use crate::lattice::{Lattice, check_distinct};
use crate::{Graph, GraphError, GraphErrorKind, IsCancelled};
use dapple_points::{PointIdx, PointSet};
use glam::DVec2;
use images::Cover;
use patch::{Patch, Rows};
use tiles::Tiles;
use triangulate::MANY;

/// Creates the Delaunay graph of the points: two points are connected if some circle through both has no other point
/// (or image of a point) on it or inside it.
///
/// Equivalently, their Voronoi cells share a side of positive length: diagonals of squares and other co-circular
/// points are omitted. The graph is symmetric, bit for bit. Without wrapping, collinear points are connected to a
/// path; on a wrapped axis, a single point is connected to its own images.
///
#[cfg_attr(doc, doc = include_str!("../docs/delaunay.md"))]
///
/// # Errors
///
/// [`GraphErrorKind::Coincident`](crate::GraphErrorKind::Coincident) if two points coincide;
/// [`GraphErrorKind::Thin`](crate::GraphErrorKind::Thin) on a wrapping domain that is too thin for the distance
/// between its points.
///
/// # Examples
///
/// ```
/// use dapple_graph::{PointIdx, PointSet, delaunay, glam::DVec2, points::Domain};
///
/// let square = [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)];
/// let positions = square.map(DVec2::from).to_vec();
/// let points = PointSet::new(Domain::torus(DVec2::ZERO, DVec2::splat(2.0)), positions)?;
/// let graph = delaunay(&points)?;
/// let neighbors: Vec<u32> = graph.axes(PointIdx(0)).iter().map(|axis| axis.to.0).collect();
/// assert_eq!(neighbors, [1, 3, 1, 3], "right, up, left, down");
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn delaunay(points: &PointSet) -> Result<Graph, GraphError> {
    delaunay_cancellable(points, &|| false)
}

/// Same as [`delaunay`], but fails if `is_cancelled` returns true.
///
/// The callback is called about once per 8192 points, possibly from several threads. Points are divided into tiles, which
/// are triangulated at once. More than 50,000 points in one tile, such as points on a circle or in few places, are
/// inserted one by one, which takes longer.
///
/// # Errors
///
/// Same as [`delaunay`], plus [`GraphErrorKind::Cancelled`](crate::GraphErrorKind::Cancelled).
///
/// # Examples
///
/// ```
/// use dapple_graph::{GraphErrorKind, delaunay_cancellable};
/// use dapple_graph::{glam::DVec2, points::{Domain, hash::Seed, white_noise}};
///
/// let points = white_noise(Domain::torus(DVec2::ZERO, DVec2::ONE), 1000, Seed(1))?;
/// assert_eq!(delaunay_cancellable(&points, &|| true).unwrap_err().kind(), &GraphErrorKind::Cancelled);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn delaunay_cancellable(
    points: &PointSet,
    is_cancelled: &IsCancelled,
) -> Result<Graph, GraphError> {
    let lattice = Lattice::new(points.domain());
    let sites = lattice.sites(points);
    let rows = match rows(&lattice, &sites, is_cancelled) {
        Ok(rows) => rows,
        Err(Refusal::Cancelled) => return Err(GraphError::new(GraphErrorKind::Cancelled)),
        Err(refusal) => {
            check_distinct(&sites)?;
            return Err(match refusal {
                // Images of different sites never coincide, so this is unreachable.
                Refusal::Coincident => GraphError::coincident(PointIdx(0), PointIdx(0)),
                Refusal::Thin | Refusal::Cancelled => GraphError::thin(points),
            });
        }
    };
    Ok(Graph {
        lattice,
        sites,
        offsets: rows.offsets,
        axes: rows.axes,
        symmetric: true,
        delaunay: true,
    })
}

/// Returns whether the axes of a graph equal the Delaunay graph of its points.
#[cfg(feature = "serde")]
pub(crate) fn is_delaunay(graph: &Graph) -> bool {
    let expected = rows(&graph.lattice, &graph.sites, &|| false);
    expected.is_ok_and(|rows| rows.offsets == graph.offsets && rows.axes == graph.axes)
}

/// Reason why a graph could not be computed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Refusal {
    /// Two sites coincide.
    Coincident,
    /// Too many images would be needed.
    Thin,
    /// The caller canceled the operation.
    Cancelled,
}

/// Fails if the caller canceled the operation.
pub(crate) fn check(is_cancelled: &IsCancelled) -> Result<(), Refusal> {
    match is_cancelled() {
        true => Err(Refusal::Cancelled),
        false => Ok(()),
    }
}

impl From<TooThin> for Refusal {
    fn from(_: TooThin) -> Self {
        Self::Thin
    }
}

/// Computes the axes of all points, in tiles if there are enough points.
fn rows(lattice: &Lattice, sites: &[DVec2], is_cancelled: &IsCancelled) -> Result<Rows, Refusal> {
    if let Some(rows) = line::rows(lattice, sites, is_cancelled)? {
        return Ok(rows);
    }
    let margin = MARGIN * (lattice.size.x * (lattice.size.y / sites.len().max(1) as f64)).sqrt();
    if is_long_line(sites) {
        return whole(lattice, sites, margin, is_cancelled);
    }
    if let Some(tiles) = Tiles::new(lattice, sites.len(), margin) {
        match tiles.rows(sites, is_cancelled) {
            // A single triangulation accepts all points that are not too thin.
            Err(Refusal::Thin) => {}
            result => return result,
        }
    }
    whole(lattice, sites, margin, is_cancelled)
}

/// Computes the axes of all points from a single triangulation.
fn whole(
    lattice: &Lattice,
    sites: &[DVec2],
    margin: f64,
    is_cancelled: &IsCancelled,
) -> Result<Rows, Refusal> {
    check(is_cancelled)?;
    let is_line = is_long_line(sites);
    let margin = match lattice.wrap {
        // Images next to a line of sites make most triangles correct.
        [true, false] if is_line => lattice.size.x,
        [false, true] if is_line => lattice.size.y,
        _ if is_line => lattice.size.min_element(),
        _ => margin,
    };
    let cover = Cover::new(lattice, DVec2::ZERO, lattice.size, margin);
    let mut images = cover.images(lattice, sites)?;
    if is_line {
        images.extend(cover.images_outside(lattice, sites[0]));
    }
    let mut patch = Patch::new(lattice, cover, &images, sites.len(), is_cancelled)?;
    check(is_cancelled)?;
    let (grid, budget) = (LazyGrid::new(lattice, sites), Budget::new(sites.len()));
    patch.rows(&grid, None, budget, is_cancelled)
}

/// Returns whether there are many sites, all on a straight line.
fn is_long_line(sites: &[DVec2]) -> bool {
    sites.len() > MANY && line::are_collinear(sites)
}

/// Initial margin of images around the domain, in multiples of the mean point spacing (the square root of the area
/// per point).
const MARGIN: f64 = 1.6;

#[cfg(test)]
mod tests {
    use super::{
        MARGIN, Refusal, Tiles, delaunay_cancellable, delaunay_triangles_cancellable, rows, whole,
    };
    use crate::GraphErrorKind;
    use crate::lattice::Lattice;
    use crate::{PointIdx, PointSet, delaunay};
    use core::sync::atomic::{AtomicUsize, Ordering::Relaxed};
    use dapple_points::Domain;
    use dapple_points::hash::{Seed, rand_core::Rng, unit_f64};
    use glam::{DVec2, Vec2Swizzles};

    /// Returns random points; `power` above one concentrates them near the origin.
    fn random(n: usize, power: i32, size: DVec2) -> PointSet {
        let mut stream = Seed(n as u64).stream();
        let mut unit = || {
            (0..power)
                .map(|_| unit_f64(stream.next_u64()))
                .product::<f64>()
        };
        let positions = (0..n).map(|_| DVec2::new(unit(), unit()) * size).collect();
        PointSet::new(Domain::torus(DVec2::ZERO, size), positions).unwrap()
    }

    #[test]
    fn tiles_equal_the_whole_for_any_number_of_threads() {
        for power in [1, 2] {
            let points = random(40_000, power, DVec2::new(2.0, 1.5));
            let lattice = Lattice::new(points.domain());
            let sites = lattice.sites(&points);
            let expected = whole(&lattice, &sites, MARGIN * 1e13, &|| false).unwrap();
            let same = || {
                let tiled = rows(&lattice, &sites, &|| false).unwrap();
                tiled.offsets == expected.offsets && tiled.axes == expected.axes
            };
            #[cfg(feature = "rayon")]
            for threads in [1, 2, 7] {
                let pool = rayon::ThreadPoolBuilder::new().num_threads(threads);
                assert!(
                    pool.build().unwrap().install(same),
                    "power {power}, {threads} threads"
                );
            }
            assert!(same(), "power {power}");
        }
    }

    /// Returns sets of 40,000 to 50,000 points in the plane, with many points on circles, on the border of the hull, and in clusters.
    fn flat_sets() -> Vec<(&'static str, Vec<DVec2>)> {
        let uniform = random(50_000, 1, DVec2::ONE).positions().to_vec();
        let grid = |x: i32, y: i32| DVec2::new(f64::from(x), f64::from(y)) / 256.0;
        let grid: Vec<_> = (0..40_000).map(|i| grid(i % 200, i / 200)).collect();
        // Turn by a Pythagorean angle, so that the border is not along the axes.
        let turned = grid
            .iter()
            .map(|at| DVec2::new(0.5 * at.x - 0.25 * at.y, 0.25 * at.x + 0.5 * at.y));
        let turned = turned.map(|at| at + DVec2::X * 0.25).collect();
        let disc = uniform
            .iter()
            .copied()
            .filter(|at| (at - 0.5).length() < 0.5)
            .collect();
        let clustered = uniform.iter().map(|at| at * at).collect();
        let with_far_corners = (uniform.iter().map(|at| 0.25 + 0.5 * at))
            .chain([DVec2::ZERO, DVec2::X, DVec2::ONE])
            .collect();
        vec![
            ("uniform", uniform),
            ("grid", grid),
            ("turned grid", turned),
            ("disc", disc),
            ("clustered", clustered),
            ("far corners", with_far_corners),
        ]
    }

    #[test]
    fn tiles_in_the_plane_equal_the_whole() {
        let mut refused = Vec::new();
        for (name, positions) in flat_sets() {
            for size in [DVec2::ONE, DVec2::new(4.0, 0.25)] {
                let positions = positions.iter().map(|&at| at * size).collect();
                let points =
                    PointSet::new(Domain::rectangle(DVec2::ZERO, size), positions).unwrap();
                let lattice = Lattice::new(points.domain());
                let sites = lattice.sites(&points);
                let expected = whole(&lattice, &sites, 1.0, &|| false).unwrap();
                let margin = MARGIN * lattice.vector(lattice.size).element_product().sqrt();
                let margin = lattice.steps(DVec2::splat(margin / 200.0)).x;
                let tiles = Tiles::new(&lattice, sites.len(), margin).unwrap();
                let Ok(tiled) = tiles.rows(&sites, &|| false) else {
                    refused.push((name, size.x));
                    continue;
                };
                assert!(
                    tiled.offsets == expected.offsets && tiled.axes == expected.axes,
                    "{name}, {size}"
                );
            }
        }
        // Sites whose neighbors are far beyond the margin of most tiles
        assert_eq!(refused, [("grid", 4.0), ("clustered", 1.0)]);
    }

    #[test]
    fn points_in_the_plane_that_tiles_refuse_are_one_triangulation() {
        let on_circle = |i: i32| {
            // Rational points of the unit circle
            let t = f64::from(i) / 20_000.0 - 1.0;
            0.5 + 0.5 * DVec2::new(1.0 - t * t, 2.0 * t) / (1.0 + t * t)
        };
        let circle: Vec<DVec2> = (0..40_000).map(on_circle).collect();
        let points = PointSet::new(Domain::rectangle(DVec2::ZERO, DVec2::ONE), circle).unwrap();
        let lattice = Lattice::new(points.domain());
        let sites = lattice.sites(&points);
        let tiles = Tiles::new(&lattice, sites.len(), MARGIN * 1e12).unwrap();
        assert_eq!(tiles.rows(&sites, &|| false).unwrap_err(), Refusal::Thin);
        let expected = whole(&lattice, &sites, 1.0, &|| false).unwrap();
        assert_eq!(delaunay(&points).unwrap().axes, expected.axes);
    }

    #[test]
    fn cancelled_graphs_stop_at_the_next_tile() {
        let points = random(100_000, 1, DVec2::ONE);
        let n_calls = AtomicUsize::new(0);
        // The third call cancels.
        let error = delaunay_cancellable(&points, &|| n_calls.fetch_add(1, Relaxed) >= 2);
        assert_eq!(error.unwrap_err().kind(), &GraphErrorKind::Cancelled);
        // There are two calls before the 9 tiles. After the third call, each remaining tile makes one call and does no
        // other work.
        assert_eq!(n_calls.load(Relaxed), 11);
        let same = delaunay_cancellable(&points, &|| false).unwrap();
        assert_eq!(same, delaunay(&points).unwrap());
        let flat = PointSet::new(
            Domain::rectangle(DVec2::ZERO, DVec2::ONE),
            points.positions().to_vec(),
        );
        let n_calls = AtomicUsize::new(0);
        let cancel = || n_calls.fetch_add(1, Relaxed) >= 2;
        let error = delaunay_cancellable(&flat.unwrap(), &cancel).unwrap_err();
        assert_eq!(error.kind(), &GraphErrorKind::Cancelled);
        assert_eq!(n_calls.load(Relaxed), 11);
    }

    /// Returns sets of points that are not divided into tiles of 8192: in one place, on lines, and on a circle, which only
    /// the plane accepts within a short time.
    fn undivided_sets() -> Vec<(&'static str, bool, Vec<DVec2>)> {
        let on_circle = |i: i32| {
            let t = f64::from(i) / 30_000.0 - 1.0;
            0.5 + 0.4 * DVec2::new(1.0 - t * t, 2.0 * t) / (1.0 + t * t)
        };
        let uniform = random(60_000, 1, DVec2::ONE).positions().to_vec();
        // Multiples of powers of two are exactly collinear.
        let on_line = |i: i32| DVec2::new(f64::from(i * 7919 % 3000) / 4096.0, 0.5);
        let line = || (0..3000).map(on_line);
        let turned = line().map(|at| DVec2::new(at.y, at.x));
        let beside = [DVec2::new(0.75, 0.9)];
        vec![
            (
                "cluster",
                true,
                uniform.iter().map(|at| at / 64.0).collect(),
            ),
            ("level line", true, line().collect()),
            (
                "slanted line",
                true,
                line().map(|at| DVec2::splat(at.x)).collect(),
            ),
            ("line and a point", false, turned.chain(beside).collect()),
            ("circle", false, (0..60_000).map(on_circle).collect()),
        ]
    }

    #[test]
    fn sets_that_are_not_divided_can_be_cancelled_on_every_domain() {
        for (name, wraps, positions) in undivided_sets() {
            for wrap in [[false; 2], [true, false], [false, true], [true; 2]] {
                if !wraps && wrap != [false; 2] {
                    continue;
                }
                let torus = Domain::torus(DVec2::ZERO, DVec2::ONE);
                let points = PointSet::new(Domain { wrap, ..torus }, positions.clone()).unwrap();
                let made_until = |last: usize| {
                    let n_calls = AtomicUsize::new(0);
                    let cancel = || n_calls.fetch_add(1, Relaxed) >= last;
                    let made = delaunay_triangles_cancellable(&points, &cancel);
                    (made.map(|triangles| triangles.len()), n_calls.into_inner())
                };
                let (made, n_calls) = made_until(usize::MAX);
                let n_triangles = made.unwrap();
                // Each 4096 of many points have a call.
                let least = 3 + points.len().saturating_sub(3001) / 4096;
                assert!(n_calls >= least, "{n_calls} calls, {name}, {wrap:?}");
                for last in [0, n_calls / 2, n_calls - 1] {
                    let error = made_until(last).0.unwrap_err();
                    let message = format!("call {last} of {n_calls}, {name}, {wrap:?}");
                    assert_eq!(error.kind(), &GraphErrorKind::Cancelled, "{message}");
                }
                match wrap {
                    [true, true] => assert_eq!(n_triangles, 2 * points.len(), "{name}"),
                    [false, false] if name.ends_with("line") => assert_eq!(n_triangles, 0),
                    _ => assert!(n_triangles <= 2 * points.len(), "{name}, {wrap:?}"),
                }
            }
        }
    }

    #[test]
    fn tiles_of_cylinders_and_thin_tori_equal_the_whole() {
        let thin = DVec2::new(0.1, 10.0);
        for (name, wrap, size) in [
            ("uniform", [true, false], DVec2::ONE),
            ("uniform", [false, true], DVec2::ONE),
            ("uniform", [true, false], thin),
            ("uniform", [true, true], thin),
            ("uniform", [true, true], thin.yx()),
            ("grid", [false, true], DVec2::ONE),
            ("disc", [true, false], DVec2::ONE),
        ] {
            let set = flat_sets().into_iter().find(|set| set.0 == name);
            let positions = set.unwrap().1.iter().map(|&at| at * size).collect();
            let torus = Domain::torus(DVec2::ZERO, size);
            let points = PointSet::new(Domain { wrap, ..torus }, positions).unwrap();
            let lattice = Lattice::new(points.domain());
            let sites = lattice.sites(&points);
            let margin = MARGIN * (lattice.size.x * (lattice.size.y / sites.len() as f64)).sqrt();
            let expected = whole(&lattice, &sites, margin, &|| false).unwrap();
            let tiles = Tiles::new(&lattice, sites.len(), margin).unwrap();
            let tiled = tiles.rows(&sites, &|| false).unwrap();
            assert!(
                tiled.offsets == expected.offsets && tiled.axes == expected.axes,
                "{name}, {wrap:?}, {size}"
            );
        }
    }

    #[test]
    fn lines_equal_the_triangulation_of_few_points() {
        for n in 1..8 {
            for (direction, wrap) in [
                // Powers of two are exactly collinear.
                (DVec2::new(0.125, 0.0625), [false; 2]),
                (DVec2::new(0.0, 0.125), [false; 2]),
                (DVec2::new(0.125, 0.0), [true, false]),
                (DVec2::new(0.0, 0.125), [false, true]),
            ] {
                let torus = Domain::torus(DVec2::ZERO, DVec2::ONE);
                let positions = (0..n).rev().map(|i| direction * f64::from(i + 1)).collect();
                let points = PointSet::new(Domain { wrap, ..torus }, positions).unwrap();
                let lattice = Lattice::new(points.domain());
                let sites = lattice.sites(&points);
                let expected = whole(&lattice, &sites, MARGIN, &|| false).unwrap();
                let line = super::line::rows(&lattice, &sites, &|| false).unwrap();
                let line = line.expect("the points are collinear");
                assert_eq!(line.offsets, expected.offsets, "{n}, {direction}, {wrap:?}");
                assert_eq!(line.axes, expected.axes, "{n}, {direction}, {wrap:?}");
            }
        }
    }

    #[test]
    fn graphs_are_sane_and_do_not_depend_on_where_the_domain_begins() {
        for (nx, ny) in [(1, 1), (2, 2), (4, 4), (10, 10), (3, 7)] {
            // Quarters are exact, so that the shifted points are equal.
            let size = DVec2::new(f64::from(nx), f64::from(ny)) * 0.25;
            let grid: Vec<DVec2> = (0..nx * ny)
                .map(|i| DVec2::new(f64::from(i % nx), f64::from(i / nx)) * 0.25)
                .collect();
            let graph = |shift: DVec2| {
                let moved = grid.iter().map(|&p| p + shift).collect();
                delaunay(&PointSet::new(Domain::torus(DVec2::ZERO, size), moved).unwrap()).unwrap()
            };
            let (here, there) = (graph(DVec2::ZERO), graph(DVec2::new(0.125, 0.0625)));
            assert_eq!(here.all_axes(), there.all_axes(), "{nx} by {ny}");
            here.sanity_check().unwrap();
            let four = |point| here.axes(PointIdx(point)).len() == 4;
            assert!((0..grid.len() as u32).all(four), "{nx} by {ny}");
        }
        delaunay(&random(500, 2, DVec2::new(3.0, 0.5)))
            .unwrap()
            .sanity_check()
            .unwrap();
    }

    #[test]
    fn value_stability_delaunay() {
        let graph = delaunay(&random(100, 1, DVec2::ONE)).unwrap();
        let mut sum = 0_u64;
        for axis in graph.all_axes() {
            let bits = [
                u64::from(axis.to.0),
                axis.vector.x.to_bits(),
                axis.vector.y.to_bits(),
            ];
            for part in bits {
                sum = sum.wrapping_mul(31).wrapping_add(part);
            }
        }
        assert_eq!((graph.n_axes(), sum), (600, 1133098715504001369));
    }
}
