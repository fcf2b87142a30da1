//! Tests of moving points that are stuck between others.

use super::unstick;
use crate::shapes::{plane, scraps};
use crate::sites::share::Pieces;
use crate::{Sites, evenness, repel, scatter};
use dapple_hash::Seed;

#[test]
fn a_point_beside_another_goes_to_the_hole() {
    let surface = plane();
    let mut points = scatter(&surface, 300, Seed(3));
    repel(&surface, &mut points, 0, 60);
    // Move the last point next to the first one, which leaves a hole.
    let hole = surface.position(points[299]);
    points[299] = points[0];
    points[299].flat += glam::DVec2::splat(1e-3);
    let before = points.clone();
    unstick(&surface, &Pieces::new(&surface), &mut points, 299, Seed(1));
    assert_eq!(points[..299], before[..299]);
    let spacing = crate::hexagonal_spacing(surface.area(), 300);
    let distance = surface.position(points[299]).distance(hole);
    assert!(
        distance < 0.5 * spacing,
        "it is {distance} off, at a spacing of {spacing}"
    );
}

#[test]
fn points_stay_on_their_pieces_and_even_ones_stay_where_they_are() {
    let surface = scraps(3);
    let pieces = Pieces::new(&surface);
    let mut points = scatter(&surface, 200, Seed(5));
    let faces: Vec<_> = points.iter().map(|point| point.face).collect();
    let before = evenness(&surface, &Sites::new(&surface, points.clone()), 200);
    unstick(&surface, &pieces, &mut points, 0, Seed(1));
    assert!(
        points.iter().map(|point| point.face).eq(faces),
        "each piece is one face here"
    );
    let after = evenness(&surface, &Sites::new(&surface, points.clone()), 200);
    assert!(after.mean > before.mean + 0.1, "{before:?}, then {after:?}");
    repel(&surface, &mut points, 0, 60);
    unstick(&surface, &pieces, &mut points, 0, Seed(1));
    let settled = points.clone();
    unstick(&surface, &pieces, &mut points, 200, Seed(2));
    assert_eq!(points, settled);
}
