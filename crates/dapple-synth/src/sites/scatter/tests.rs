//! Tests of random points: uniform by area, and uniform within each face.

use super::scatter;
use crate::shapes::{scraps, torus};
use dapple_hash::Seed;

#[test]
fn fewer_points_are_the_first_of_more() {
    let torus = torus(48, 24);
    assert_eq!(
        scatter(&torus, 1000, Seed(3))[..100],
        scatter(&torus, 100, Seed(3))[..]
    );
    assert!(
        scatter(&torus, 0, Seed(3)).is_empty(),
        "none were asked for"
    );
}

#[test]
fn points_lie_inside_of_their_faces() {
    let torus = torus(48, 24);
    for point in scatter(&torus, 2000, Seed(5)) {
        let least = torus.weights(point).into_iter().fold(1.0, f64::min);
        // Tolerance: rounding in the plane of the face.
        assert!(least >= -1e-12, "{point:?} has a weight of {least}");
    }
}

#[test]
fn faces_get_points_by_area() {
    // Areas relative to the first face: 1, 1/4, 1/16, ...
    let surface = scraps(4);
    let n = 100_000;
    let mut counts = [0_u32; 4];
    for point in scatter(&surface, n, Seed(7)) {
        counts[point.face.index()] += 1;
    }
    for (face, &count) in (0..).map(dapple_mesh::FaceIdx).zip(&counts) {
        let part = surface.face_area(face) / surface.area();
        let deviation = (n as f64 * part * (1.0 - part)).sqrt();
        let off = (f64::from(count) - n as f64 * part).abs() / deviation;
        assert!(off < 4.0, "face {face:?} is {off} standard deviations off");
    }
}

#[test]
fn points_are_even_inside_of_a_face() {
    // The weights of uniform points have a mean of 1/3 each, and their squares a mean of 1/6.
    let surface = scraps(1);
    let n = 50_000;
    let points = scatter(&surface, n, Seed(9));
    for corner in 0..3 {
        let mean = |power: i32| {
            points
                .iter()
                .map(|&point| libm::pow(surface.weights(point)[corner], f64::from(power)))
                .sum::<f64>()
                / n as f64
        };
        // Tolerance: five standard errors; the standard deviations of one point are 0.24 and 0.20.
        assert!((mean(1) - 1.0 / 3.0).abs() < 0.0053, "mean {}", mean(1));
        assert!(
            (mean(2) - 1.0 / 6.0).abs() < 0.0045,
            "mean square {}",
            mean(2)
        );
    }
}

#[test]
fn value_stability_scatter() {
    let torus = torus(48, 24);
    let positions: Vec<[f64; 3]> = scatter(&torus, 3, Seed(1))
        .into_iter()
        .map(|point| torus.position(point).to_array())
        .collect();
    assert_eq!(positions, PINNED);
}

const PINNED: [[f64; 3]; 3] = [
    [0.6066560720844334, 0.45605446544873685, -0.315266150625509],
    [
        -0.009597215844131337,
        0.6338791466258413,
        -0.15393280463524237,
    ],
    [
        -0.44345722951841626,
        -1.1997879757154595,
        0.2839469658421354,
    ],
];
