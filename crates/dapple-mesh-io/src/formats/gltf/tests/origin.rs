//! Tests of meshes far from the origin.

use super::*;

/// Returns a cube whose minimum corner is at `corner`, with edges of length `edge`.
fn cube_at(corner: DVec3, edge: f64) -> Model {
    let unit = cube();
    let positions = unit.positions().iter();
    let positions = positions.map(|at| corner + edge * (at - unit.positions()[0]));
    let faces: Vec<_> = unit
        .faces()
        .iter()
        .map(|face| face.map(|vertex| vertex.0))
        .collect();
    Model::from(dapple_mesh::Mesh::new(positions.collect(), &faces).expect("it is in range"))
}

#[test]
fn positions_far_from_zero_keep_their_differences() {
    for (corner, edge) in [
        (DVec3::new(500_000.0, 4_649_776.0, 120.0), 0.1),
        (DVec3::new(-4.6e6, 5e5, 0.0), 0.1),
        (DVec3::splat(1e9), 1.0),
        (DVec3::new(1e9, 0.0, 0.0), 1e-3),
        (DVec3::new(0.0, 4.6e6, 0.0), 10_000.0),
    ] {
        let model = cube_at(corner, edge);
        let once = read(&write(&model).expect("it is valid")).expect("it is valid");
        let twice = read(&write(&once).expect("it is valid")).expect("it is valid");
        for (what, back) in [("read", &once), ("read twice", &twice)] {
            let pairs = back.mesh.positions().iter().zip(model.mesh.positions());
            let moved = pairs.map(|(at, other)| (at - other).abs().max_element());
            let moved = moved.fold(0.0, f64::max);
            // Half a step of f32 at the extent, plus a step of f64 at the coordinate.
            let limit = edge / f64::from(1 << 24) + corner.abs().max_element() * f64::EPSILON;
            assert!(moved <= limit, "{what}: {corner} moved by {moved:e}");
            assert_eq!(back.mesh.report().degenerate_faces, 0, "{what}: {corner}");
        }
    }
}

#[test]
fn origin_is_the_translation_of_the_node_and_bounds_are_relative_to_it() {
    let model = cube_at(DVec3::new(500_000.0, 4_649_776.0, 120.0), 0.1);
    let bytes = write(&model).expect("it is valid");
    let file = ::gltf::Gltf::from_slice(&bytes).expect("it is valid");
    let node = file.nodes().next().expect("it has one");
    // The center 500000.05, 4649776.05, 120.05 in steps of 2^-4, the power of two below the extent.
    let translation = node.transform().decomposed().0;
    assert_eq!(translation, [500_000.06, 4_649_776.0, 120.0625]);
    let mesh = node.mesh().expect("it has one");
    let bounds = mesh.primitives().next().expect("it has one").bounding_box();
    assert!(bounds.max.iter().all(|part| part.abs() < 0.2), "{bounds:?}");
}

#[test]
fn meshes_that_single_precision_can_hold_have_no_origin() {
    for model in [
        cube_at(DVec3::splat(-0.5), 1.0),
        cube_at(DVec3::new(15.0, 0.0, 0.0), 1.0 / 3.0 * 3.0),
        cube_at(DVec3::new(3.3, 1.1, 0.7), 0.3),
        // Far from the origin, but exact in f32.
        cube_at(DVec3::splat(65536.0), 0.5),
    ] {
        let bytes = write(&model).expect("it is valid");
        let file = ::gltf::Gltf::from_slice(&bytes).expect("it is valid");
        let node = file.nodes().next().expect("it has one");
        assert_eq!(node.transform().decomposed().0, [0.0; 3]);
    }
}
