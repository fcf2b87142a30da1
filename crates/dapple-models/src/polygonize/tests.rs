//! Tests that meshes of solids are closed, manifold, and on the surface.

use super::{TOLERANCE, polygonize, polygonize_n};
use crate::ModelErrorKind;
use crate::solid::{Ball, RoundBox, Solid, Torus};
use core::f64::consts::PI;
use dapple_mesh::Mesh;
use glam::DVec3;
use std::collections::BTreeMap;

/// Returns the Euler characteristic of a mesh. Checks that the mesh is closed, manifold, consistently wound and
/// connected.
pub(crate) fn euler(mesh: &Mesh) -> i64 {
    let mut edges = BTreeMap::new();
    let mut after = vec![BTreeMap::new(); mesh.positions().len()];
    for &[a, b, c] in mesh.faces() {
        for [from, to, third] in [[a, b, c], [b, c, a], [c, a, b]] {
            let first = edges.insert((from, to), ()).is_none();
            assert!(first, "two faces go from {from:?} to {to:?}");
            after[from.index()].insert(to, third);
        }
    }
    let paired = edges
        .keys()
        .all(|&(from, to)| edges.contains_key(&(to, from)));
    assert!(paired, "an edge has one face");
    for fan in &after {
        let (&start, &second) = fan.first_key_value().expect("every vertex has a face");
        let (mut at, mut steps) = (second, 1);
        while at != start && steps <= fan.len() {
            at = fan[&at];
            steps += 1;
        }
        assert_eq!(steps, fan.len(), "a vertex has two fans");
    }
    assert_eq!(pieces(mesh), 1, "pieces");
    (mesh.positions().len() + mesh.faces().len()) as i64 - (edges.len() / 2) as i64
}

fn pieces(mesh: &Mesh) -> usize {
    let mut label: Vec<usize> = (0..mesh.positions().len()).collect();
    let mut changed = true;
    while changed {
        changed = false;
        for face in mesh.faces() {
            let least = face.iter().map(|vertex| label[vertex.index()]).min();
            for vertex in face {
                changed |= Some(label[vertex.index()]) != least;
                label[vertex.index()] = least.unwrap_or_default();
            }
        }
    }
    (0..label.len())
        .filter(|&vertex| label[vertex] == vertex)
        .count()
}

fn volume(mesh: &Mesh) -> f64 {
    let corners = mesh
        .faces()
        .iter()
        .map(|face| face.map(|at| mesh.positions()[at.index()]));
    corners.map(|[a, b, c]| a.dot(b.cross(c)) / 6.0).sum()
}

/// Returns the smallest angle of each face in degrees, sorted.
fn least_angles(mesh: &Mesh) -> Vec<f64> {
    let angle = |[a, b, c]: [DVec3; 3]| libm::acos((b - a).normalize().dot((c - a).normalize()));
    let mut least: Vec<f64> = mesh
        .faces()
        .iter()
        .map(|face| face.map(|at| mesh.positions()[at.index()]))
        .map(|[a, b, c]| angle([a, b, c]).min(angle([b, c, a])).min(angle([c, a, b])) * 180.0 / PI)
        .collect();
    least.sort_by(f64::total_cmp);
    least
}

const BALL: Ball = Ball {
    center: DVec3::new(0.3, -0.2, 0.1),
    radius: 1.0,
};
const TORUS: Torus = Torus {
    center: DVec3::ZERO,
    axis: DVec3::Y,
    ring: 0.7,
    tube: 0.3,
};

#[test]
fn a_ball_and_a_torus_have_their_topology_and_volume_at_every_side() {
    for step in 0..24 {
        let side = 0.4 - 0.0147 * f64::from(step);
        let solids: [(&dyn Solid, i64, f64); 2] = [
            (&BALL, 2, 4.0 / 3.0 * PI),
            (&TORUS, 0, 2.0 * PI * PI * 0.7 * 0.3 * 0.3),
        ];
        for (solid, characteristic, exact) in solids {
            let mesh = polygonize(solid, side).expect("the side is good");
            assert_eq!(euler(&mesh), characteristic, "side {side}");
            // Flat triangles cut off about a quarter of the squared side over the radius, which is at least 0.3.
            let part = volume(&mesh) / exact;
            let least = 1.0 - 2.0 * side * side / 0.3;
            assert!(least < part && part < 1.0, "side {side}: {part}");
        }
    }
}

#[test]
fn vertices_lie_on_the_surface_to_the_tolerance() {
    for side in [0.3, 0.1, 0.05] {
        let mesh = polygonize(&TORUS, side).expect("the side is good");
        for &position in mesh.positions() {
            let distance = TORUS.distance(position).abs();
            assert!(distance <= TOLERANCE * side, "{distance} at {position}");
        }
    }
}

#[test]
fn triangles_are_nearly_equilateral() {
    for solid in [&BALL as &dyn Solid, &TORUS] {
        let angles = least_angles(&polygonize_n(solid, 0.1, 6000).expect("the side is good"));
        // Measured: 34 degrees or more, 52 on average.
        assert!(angles[0] > 25.0, "least {}", angles[0]);
        let mean = angles.iter().sum::<f64>() / angles.len() as f64;
        assert!(mean > 50.0, "mean {mean}");
    }
}

#[test]
fn the_number_of_triangles_is_met() {
    for wanted in [100, 1000, 1001, 9999, 20_000] {
        let mesh = polygonize_n(&TORUS, 0.1, wanted).expect("the side is good");
        assert_eq!(mesh.faces().len(), wanted / 2 * 2, "wanted {wanted}");
        assert_eq!(euler(&mesh), 0, "wanted {wanted}");
    }
}

#[test]
fn points_of_the_lattice_on_the_surface_leave_no_slivers() {
    // All faces of this box pass through points of the lattice.
    let solid = RoundBox {
        center: DVec3::ZERO,
        half: DVec3::splat(1.0),
        rounding: 0.25,
    };
    let mesh = polygonize(&solid, 0.125).expect("the side is good");
    assert_eq!(euler(&mesh), 2, "a ball's");
    let angles = least_angles(&mesh);
    assert!(angles[0] > 15.0, "least {}", angles[0]);
}

/// A solid given by its distance function and half the side of its bounding cube.
struct Odd(fn(DVec3) -> f64, f64);

impl Solid for Odd {
    fn distance(&self, at: DVec3) -> f64 {
        self.0(at)
    }

    fn bounds(&self) -> [DVec3; 2] {
        [DVec3::splat(-self.1), DVec3::splat(self.1)]
    }
}

#[test]
fn a_solid_beyond_its_bounds_is_cut_there() {
    let mesh = polygonize(&Odd(|at| at.y, 1.0), 0.2).expect("the side is good");
    assert_eq!(euler(&mesh), 2, "half a cube");
    // The lattice does not follow the sharp edges.
    let part = volume(&mesh) / 4.0;
    assert!((0.9..1.0).contains(&part), "{part}");
}

#[test]
fn odd_solids_and_numbers_are_refused() {
    let ball: fn(DVec3) -> f64 = |at| at.length() - 1.0;
    let good = Odd(ball, 1.5);
    for side in [0.0, -1.0, f64::NAN, f64::INFINITY, 1e-4] {
        let error = polygonize(&good, side).expect_err("the side is bad");
        assert!(
            matches!(error.kind(), ModelErrorKind::Range { .. }),
            "{error}"
        );
    }
    for wanted in [0, 15, usize::MAX] {
        let error = polygonize_n(&good, 0.2, wanted).expect_err("the number is bad");
        assert!(
            matches!(error.kind(), ModelErrorKind::Range { .. }),
            "{error}"
        );
    }
    for bound in [f64::NAN, f64::INFINITY, 1e200] {
        let error = polygonize(&Odd(ball, bound), 0.2).expect_err("the bounds are bad");
        assert!(
            matches!(error.kind(), ModelErrorKind::Range { .. }),
            "{error}"
        );
    }
    let nothing: [fn(DVec3) -> f64; 3] = [|_| 1.0, |_| f64::NAN, |_| f64::INFINITY];
    for distance in nothing {
        let error = polygonize(&Odd(distance, 1.0), 0.2).expect_err("there is no surface");
        assert_eq!(error.kind(), &ModelErrorKind::NoSurface, "{error}");
    }
}

#[test]
fn a_distance_that_changes_too_fast_gives_a_closed_mesh_or_an_error() {
    let wild: [fn(DVec3) -> f64; 3] = [
        |at| 40.0 * (at.length() - 1.0),
        |at| {
            if at.x > 0.1 {
                f64::NAN
            } else {
                at.length() - 1.0
            }
        },
        |at| {
            if (at * 2.0).floor().element_sum() % 2.0 == 0.0 {
                -1e-3
            } else {
                1e-3
            }
        },
    ];
    for distance in wild {
        for side in [0.31, 0.23] {
            match polygonize(&Odd(distance, 1.5), side) {
                Ok(mesh) => assert!(!mesh.faces().is_empty(), "no faces"),
                Err(error) => assert!(
                    matches!(
                        error.kind(),
                        ModelErrorKind::Open { .. } | ModelErrorKind::NoSurface
                    ),
                    "{error}"
                ),
            }
        }
    }
}

#[test]
fn value_stability_of_a_torus() {
    let mesh = polygonize_n(&TORUS, 0.2, 500).expect("the side is good");
    let sum: DVec3 = mesh.positions().iter().map(|at| at.abs()).sum();
    let first = mesh.faces()[0].map(|vertex| vertex.0);
    assert_eq!(
        (first, sum.to_array()),
        (
            [0, 15, 12],
            [
                119.847_616_148_021_84,
                47.067_346_556_063_98,
                120.761_029_576_211_4
            ]
        ),
        "the bits"
    );
}
