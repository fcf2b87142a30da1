//! Tests of concave polygons against their shoelace areas and their edges.

use super::*;
use crate::{obj, off, ply};
use dapple_mesh::Model;

/// An L-shaped polygon with six corners and area 3. The triangle fan around its first corner has area 4.
const L: [[f64; 2]; 6] = [
    [0.0, 0.0],
    [2.0, 0.0],
    [2.0, 1.0],
    [1.0, 1.0],
    [1.0, 2.0],
    [0.0, 2.0],
];

fn flat(corners: &[[f64; 2]]) -> Vec<DVec3> {
    let corners = corners.iter();
    corners.map(|&[x, y]| DVec3::new(x, y, 0.0)).collect()
}

/// Returns the triangles of a polygon, and whether it is reported as self-intersecting.
fn triangles(corners: &[DVec3]) -> (Vec<[u32; 3]>, bool) {
    let (mut polygons, mut faces) = (Polygons::default(), Vec::new());
    let numbers: Vec<_> = (0..corners.len() as u32).collect();
    polygons.push(&numbers, &mut faces);
    let ears = polygons.ears(&faces, corners, |vertex| vertex);
    ears.apply(&mut faces);
    (faces, ears.left_out().next().is_some())
}

/// Returns the vector area of a polygon, times two.
fn shoelace(corners: &[DVec3]) -> DVec3 {
    let pairs = (0..corners.len()).map(|i| corners[i].cross(corners[(i + 1) % corners.len()]));
    pairs.sum()
}

/// Checks that the triangles cover the polygon once, use all of its corners, and have its edges.
fn check(corners: &[DVec3], what: &str) {
    let (faces, is_named) = triangles(corners);
    assert!(!is_named, "{what}");
    let n = corners.len() as u32;
    assert_eq!(faces.len() as u32, n - 2, "{what}");
    let whole = shoelace(corners);
    let areas = faces
        .iter()
        .map(|face| shoelace(&face.map(|vertex| corners[vertex as usize])));
    let areas: Vec<_> = areas.collect();
    let sum: f64 = areas.iter().map(|area| area.length()).sum();
    // Tolerance: sums of a few products of small numbers.
    assert!(
        (sum - whole.length()).abs() < 1e-9 * whole.length(),
        "{what}: {sum} {whole}"
    );
    assert!(
        areas.iter().all(|area| area.dot(whole) > 0.0),
        "{what}: none is turned over"
    );
    let mut sides: Vec<_> = faces
        .iter()
        .flat_map(|&[a, b, c]| [(a, b), (b, c), (c, a)])
        .collect();
    sides.sort_unstable();
    let n_sides = sides.len();
    sides.dedup();
    assert_eq!(sides.len(), n_sides, "{what}: a side twice");
    for i in 0..n {
        assert!(sides.contains(&(i, (i + 1) % n)), "{what}: side {i}");
    }
}

#[test]
fn concave_polygons_are_covered_once_in_every_plane_and_direction() {
    let comb: Vec<_> = (0..40)
        .map(|i| [f64::from(i), f64::from(i % 2) * 5.0])
        .chain(
            (0..40)
                .rev()
                .map(|i| [f64::from(i), f64::from(i % 2) * 5.0 + 1.0]),
        )
        .collect();
    let star: Vec<_> = (0..30)
        .map(|i| {
            let angle = f64::from(i) / 30.0 * core::f64::consts::TAU;
            let radius = if i % 2 == 0 { 1.0 } else { 0.2 };
            [radius * libm::cos(angle), radius * libm::sin(angle)]
        })
        .collect();
    let dart = [[0.0, 0.0], [2.0, 1.0], [0.0, 2.0], [0.5, 1.0]];
    // Corners on straight sides, whose vertices belong to neighbors.
    let straight = [
        [0.0, 0.0],
        [1.0, 0.0],
        [2.0, 0.0],
        [2.0, 0.5],
        [2.0, 1.0],
        [1.0, 1.0],
        [1.0, 1.5],
        [1.0, 2.0],
        [0.0, 2.0],
        [0.0, 1.0],
    ];
    // A square with a hole that is connected by a bridge.
    let hole = [
        [0.0, 0.0],
        [4.0, 0.0],
        [4.0, 4.0],
        [0.0, 4.0],
        [0.0, 0.0],
        [1.0, 1.0],
        [1.0, 3.0],
        [3.0, 3.0],
        [3.0, 1.0],
        [1.0, 1.0],
    ];
    let shapes: [(&str, &[[f64; 2]]); 6] = [
        ("L", &L),
        ("comb", &comb),
        ("star", &star),
        ("dart", &dart),
        ("straight sides", &straight),
        ("hole", &hole),
    ];
    let turns: [fn(f64, f64) -> DVec3; 4] = [
        |x, y| DVec3::new(x, y, 0.0),
        |x, y| DVec3::new(y, x, 3.0),
        |x, y| DVec3::new(500_000.0 + x, 0.5 * x - y, y),
        |x, y| DVec3::new(x + y, 2.0 * x, y - x),
    ];
    for (name, shape) in shapes {
        for first in 0..shape.len() {
            for (turn, place) in turns.iter().enumerate() {
                let mut corners: Vec<_> = shape.iter().map(|&[x, y]| place(x, y)).collect();
                corners.rotate_left(first);
                check(&corners, &format!("{name} from {first} in plane {turn}"));
                corners.reverse();
                check(
                    &corners,
                    &format!("{name} backward from {first} in plane {turn}"),
                );
            }
        }
    }
}

#[test]
fn convex_polygons_stay_fans() {
    let circle = |i: u32| {
        let angle = f64::from(i) / 9.0 * core::f64::consts::TAU;
        // Six digits, as in many files
        [libm::cos(angle), libm::sin(angle)].map(|part| libm::round(part * 1e6) / 1e6)
    };
    let circle: Vec<_> = (0..9).map(circle).collect();
    // A corner on a slanted side, which rounding moves inside by 1e-17.
    let slanted = [[0.0, 0.0], [0.1, 0.3], [0.2, 0.6], [-1.0, 1.0]].map(|[x, y]| [-x, y]);
    for shape in [
        &circle[..],
        &slanted,
        &[[0.0, 0.0]; 4],
        &[[0.0, 0.0], [1.0, 0.0], [2.0, 0.0], [1.0, 0.0]],
    ] {
        let (faces, is_named) = triangles(&flat(shape));
        let want: Vec<_> = (1..shape.len() as u32 - 1).map(|i| [0, i, i + 1]).collect();
        assert_eq!((faces, is_named), (want, false), "{shape:?}");
    }
}

#[test]
fn polygons_that_cross_themselves_stay_fans_and_are_named() {
    let bow = [[0.0, 0.0], [1.0, 1.0], [1.0, 0.0], [0.0, 1.0]];
    let pentagram = [0.0, 0.8, 1.6, 0.4, 1.2].map(|turn: f64| {
        let angle = turn * core::f64::consts::PI;
        [libm::cos(angle), libm::sin(angle)]
    });
    let spiral = [
        [0.0, 0.0],
        [4.0, 0.0],
        [4.0, 3.0],
        [1.0, 3.0],
        [1.0, -1.0],
        [2.0, -1.0],
        [2.0, 2.0],
        [3.0, 2.0],
        [3.0, 1.0],
        [0.0, 1.0],
    ];
    for shape in [&bow[..], &pentagram, &spiral] {
        let (faces, is_named) = triangles(&flat(shape));
        let want: Vec<_> = (1..shape.len() as u32 - 1).map(|i| [0, i, i + 1]).collect();
        assert_eq!((faces, is_named), (want, true), "{shape:?}");
    }
}

#[test]
fn large_polygons_are_covered_once_or_stay_fans() {
    // A comb with teeth of random lengths below a straight chain, which every ear test sees as a whole.
    let comb = |n: u32| {
        let teeth = (0..n).map(|i| {
            let length = f64::from(i.wrapping_mul(2_654_435_761) >> 16) / 65536.0;
            [f64::from(i), if i % 2 == 0 { -length } else { 1.0 }]
        });
        flat(
            &teeth
                .chain([[f64::from(n), 9.0], [0.0, 9.0]])
                .collect::<Vec<_>>(),
        )
    };
    check(&comb(100_000), "comb");
    // Every side of this polygon overlaps all others. The number of tests is bounded for any input.
    let side = |i: u32| [f64::from(i % 2), f64::from(i)];
    let zigzag: Vec<_> = (0..40_000).map(side).chain([[-1.0, 0.0]]).collect();
    let (faces, is_named) = triangles(&flat(&zigzag));
    assert_eq!(
        (faces[0], faces[9], is_named),
        ([0, 1, 2], [0, 10, 11], true)
    );
}

fn area_of(model: &Model) -> f64 {
    let faces = (0..model.mesh.faces().len()).map(|face| {
        let [a, b, c] = model.mesh.corners(dapple_mesh::FaceIdx(face as u32));
        0.5 * (b - a).cross(c - a).length()
    });
    faces.sum()
}

#[test]
fn every_format_triangulates_concave_polygons_with_their_columns() {
    let row = |[x, y]: [f64; 2]| format!("{x} {y} 0\n");
    let rows: String = L.into_iter().map(row).collect();
    let uvs: String = L.map(|[x, y]| format!(" {x} {y}")).concat();
    let objects: String = L
        .map(|[x, y]| format!("v {x} {y} 0\nvt {x} {y}\n"))
        .concat();
    // The face precedes its vertices, which OBJ allows.
    let early = format!("f 1/1 2/2 3/3 4/4 5/5 6/6\n{objects}");
    let late = format!("{objects}f -6/-6 -5/-5 -4/-4 -3/-3 -2/-2 -1/-1\n");
    let ply = format!(
        "ply\nformat ascii 1.0\nelement face 1\nproperty list uchar int vertex_indices\nproperty list uchar float texcoord\nelement vertex 6\nproperty float x\nproperty float y\nproperty float z\nend_header\n6 0 1 2 3 4 5 12{uvs}\n{rows}"
    );
    let off = format!("OFF\n6 1 0\n{rows}6 0 1 2 3 4 5\n");
    let models = [
        ("OBJ before", obj::read(early.as_bytes())),
        ("OBJ", obj::read(late.as_bytes())),
        ("PLY", ply::read(ply.as_bytes())),
        ("OFF", off::read(off.as_bytes())),
    ];
    for (name, model) in models {
        let model = model.expect(name);
        assert_eq!(area_of(&model), 3.0, "{name}");
        assert!(model.left_out.is_empty(), "{name}: {:?}", model.left_out);
        for (face, uvs) in (0..).zip(model.uvs.iter().flatten()) {
            let corners = model.mesh.corners(dapple_mesh::FaceIdx(face));
            let at = uvs.map(|uv| DVec3::new(uv.x, 1.0 - uv.y, 0.0));
            assert_eq!(
                at, corners,
                "{name}: texture coordinates go with their corners"
            );
        }
    }
    let bow = "v 0 0 0\nv 1 1 0\nv 1 0 0\nv 0 1 0\nf 1 2 3 4\n";
    let left_out = obj::read(bow.as_bytes()).expect("it is valid").left_out;
    assert_eq!(
        left_out,
        ["the shape of a polygon that crosses itself; it is a fan"]
    );
}
