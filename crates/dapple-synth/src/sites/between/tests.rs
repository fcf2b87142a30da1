//! Tests of edge midpoints, against a Delaunay triangulation by spade.

use super::{CENTER_REACH, REACH, edges};
use crate::shapes::{geodesic_sphere, plane};
use crate::sites::evenness::hexagonal_spacing;
use crate::{repel, scatter};
use dapple_hash::Seed;
use dapple_mesh::{Surface, SurfacePoint};
use glam::{DVec2, DVec3};
use spade::{DelaunayTriangulation, HasPosition, Point2, Triangulation};

struct Site {
    position: DVec2,
}

impl HasPosition for Site {
    type Scalar = f64;

    fn position(&self) -> Point2<f64> {
        Point2::new(self.position.x, self.position.y)
    }
}

/// Returns the midpoints of the edges of a Delaunay triangulation that satisfy the limits on length and circle center.
fn middles_by_spade(positions: &[DVec2], spacing: f64) -> Vec<[f64; 2]> {
    let mut triangulation = DelaunayTriangulation::<Site>::new();
    for &position in positions {
        triangulation.insert(Site { position }).unwrap();
    }
    let mut middles = Vec::new();
    for edge in triangulation.undirected_edges() {
        let [a, b] = edge.positions().map(|point| DVec2::new(point.x, point.y));
        let middle = 0.5 * (a + b);
        // Empty circles through both points are centered between the circumcenters of the two triangles.
        let across = (b - a).perp().normalize();
        let mut span = [f64::NEG_INFINITY, f64::INFINITY];
        let directed = edge.as_directed();
        for (side, face) in [directed.face(), directed.rev().face()]
            .into_iter()
            .enumerate()
        {
            if let Some(face) = face.as_inner() {
                let center = face.circumcenter();
                let at = (DVec2::new(center.x, center.y) - middle).dot(across);
                span[1 - side] = at;
            }
        }
        let [low, high] = span;
        let allowed = low < CENTER_REACH * spacing && high > -CENTER_REACH * spacing;
        if allowed && a.distance(b) < REACH * spacing {
            middles.push(middle.to_array());
        }
    }
    middles
}

fn rounded(mut middles: Vec<[f64; 2]>) -> Vec<[i64; 2]> {
    let mut rounded: Vec<[i64; 2]> = middles
        .drain(..)
        .map(|middle| middle.map(|part| (part * 1e9).round() as i64))
        .collect();
    rounded.sort_unstable();
    rounded
}

fn even(surface: &Surface, n: usize) -> Vec<SurfacePoint> {
    let mut points = scatter(surface, n, Seed(3));
    repel(surface, &mut points, 0, 40);
    points
}

#[test]
fn edges_are_those_of_the_triangulation() {
    let surface = plane();
    let points = even(&surface, 700);
    let position = |point: SurfacePoint| -> DVec3 { surface.position(point) };
    let positions: Vec<DVec2> = points
        .iter()
        .map(|&point| position(point).truncate())
        .collect();
    let found = edges(&surface, &points)
        .iter()
        .map(|edge| position(edge.middle).truncate().to_array())
        .collect();
    let spade = middles_by_spade(&positions, hexagonal_spacing(surface.area(), 700));
    assert_eq!(rounded(found), rounded(spade));
}

#[test]
fn a_closed_surface_has_three_edges_for_each_point() {
    let surface = geodesic_sphere(3);
    let n_edges = edges(&surface, &even(&surface, 2000)).len();
    // Euler: 3 n - 6 edges, except for a few that neighbors disagree about.
    assert!((5990..=6000).contains(&n_edges), "{n_edges} edges");
}

#[test]
fn edges_of_few_points_are_few() {
    let surface = plane();
    for n in 0..4 {
        let n_edges = edges(&surface, &scatter(&surface, n, Seed(1))).len();
        assert!(
            n_edges <= n * n.saturating_sub(1) / 2,
            "{n_edges} edges of {n} points"
        );
    }
    let point = scatter(&surface, 1, Seed(1))[0];
    assert!(
        edges(&surface, &[point; 200]).is_empty(),
        "points in one place have no edges"
    );
}

#[test]
fn thirds_lie_on_the_edge() {
    let surface = plane();
    let points = even(&surface, 50);
    for edge in edges(&surface, &points) {
        let [a, b] = edge.thirds(&surface).map(|point| surface.position(point));
        let middle = surface.position(edge.middle);
        // Tolerance: rounding of walks over unit lengths.
        assert!((0.5 * (a + b)).distance(middle) < 1e-12, "{edge:?}");
        assert!(
            (a.distance(b) * 3.0 - edge.length).abs() < 1e-12,
            "{edge:?}"
        );
    }
}
