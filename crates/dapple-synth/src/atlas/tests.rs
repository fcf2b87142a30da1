//! Tests of layouts on small meshes.

use super::{Atlas, NONE, Tangents, weights};
use crate::SynthErrorKind;
use crate::shapes::{cap, moved, square};
use dapple_mesh::{FaceIdx, Mesh, Surface};
use glam::{DVec2, DVec3};

/// Returns a box with three different side lengths and twelve faces.
fn cuboid() -> Surface {
    let positions: Vec<DVec3> = (0..8)
        .map(|corner| {
            let bit = |at: u32| f64::from((corner >> at) & 1);
            DVec3::new(bit(0), 2.0 * bit(1), 5.0 * bit(2))
        })
        .collect();
    let quads = [
        [0, 2, 3, 1],
        [4, 5, 7, 6],
        [0, 1, 5, 4],
        [2, 6, 7, 3],
        [0, 4, 6, 2],
        [1, 3, 7, 5],
    ];
    let faces: Vec<[u32; 3]> = quads
        .iter()
        .flat_map(|[a, b, c, d]| [[*a, *b, *c], [*a, *c, *d]])
        .collect();
    Surface::new(Mesh::new(positions, &faces).unwrap()).unwrap()
}

/// Asserts that all texels read by bilinear sampling inside of a face show that face.
fn assert_padded(atlas: &Atlas) {
    for (face, corners) in (0..).map(FaceIdx).zip(&atlas.corners) {
        for step_b in 0..=20 {
            for step_c in 0..=20 - step_b {
                let [b, c] = [step_b, step_c].map(|step| f64::from(step) / 20.0);
                let at = corners[0] + (corners[1] - corners[0]) * b + (corners[2] - corners[0]) * c;
                let low = (at - 0.5 + 1e-9).floor();
                for near in [DVec2::ZERO, DVec2::X, DVec2::Y, DVec2::ONE] {
                    let texel = low + near;
                    // Texels with zero weight do not count.
                    let read = (at - 0.5 - texel).abs().max_element() < 1.0 - 1e-6;
                    if read {
                        let texel = [texel.x as u32, texel.y as u32];
                        assert_eq!(atlas.face(texel), Some(face), "{texel:?} beside {at}");
                    }
                }
            }
        }
    }
}

#[test]
fn tiles_keep_their_faces_apart() {
    for side in [32, 64, 100] {
        assert_padded(&Atlas::uniform(&cuboid(), side).unwrap());
        assert_padded(&Atlas::by_area(&cuboid(), side).unwrap());
    }
}

#[test]
fn uniform_tiles_are_right_triangles_of_one_size_with_the_longest_edge_across() {
    let surface = cuboid();
    let atlas = Atlas::uniform(&surface, 64).unwrap();
    for (face, corners) in (0..).map(FaceIdx).zip(&atlas.corners) {
        let lengths = |[a, b, c]: [f64; 3]| (a.max(b).max(c), a.min(b).min(c));
        let [a, b, c] = *corners;
        let (long, short) = lengths([a.distance(b), b.distance(c), c.distance(a)]);
        // Twelve faces take six tiles, three per row, of 21 texels each. The frame of a tile takes 4 paddings of 1 and
        // one texel more.
        assert_eq!(short, f64::from(21 - 4 - 1), "legs of {face:?}");
        assert!(
            (long - short * 2.0_f64.sqrt()).abs() < 1e-9,
            "not right: {face:?}"
        );
        let [pa, pb, pc] = surface.mesh().corners(face);
        let sides = [pa.distance(pb), pb.distance(pc), pc.distance(pa)];
        let texels = [a.distance(b), b.distance(c), c.distance(a)];
        let longest = |sides: [f64; 3]| (0..3).max_by(|&i, &j| sides[i].total_cmp(&sides[j]));
        assert_eq!(longest(sides), longest(texels), "the long edge of {face:?}");
    }
}

#[test]
fn tiles_by_area_give_larger_faces_more_texels() {
    let surface = cuboid();
    let atlas = Atlas::by_area(&surface, 128).unwrap();
    let leg = |face: u32| {
        let [a, b, c] = atlas.corners[face as usize];
        a.distance(b).min(b.distance(c)).min(c.distance(a))
    };
    // The faces of 1 x 2 come first, the faces of 2 x 5 last.
    assert!(leg(11) >= 1.9 * leg(0), "{} beside {}", leg(11), leg(0));
}

#[test]
fn texels_inside_of_a_face_are_on_it_and_those_in_the_padding_beside_it() {
    let surface = cuboid();
    for atlas in [
        Atlas::uniform(&surface, 64).unwrap(),
        Atlas::by_area(&surface, 64).unwrap(),
    ] {
        for row in 0..64 {
            for column in 0..64 {
                let Some(face) = atlas.face([column, row]) else {
                    assert_eq!(atlas.point(&surface, [column, row]), None, "free texel");
                    continue;
                };
                let point = atlas.point(&surface, [column, row]).unwrap();
                let center = DVec2::new(f64::from(column) + 0.5, f64::from(row) + 0.5);
                let inside = weights(atlas.corners[face.index()], center)
                    .iter()
                    .all(|&w| w >= 0.0);
                if inside {
                    assert_eq!(point.face, face, "inside");
                }
                let weights = surface.weights(point);
                // The walk ends on a face, up to rounding.
                assert!(weights.iter().all(|&w| w > -1e-9), "outside: {weights:?}");
            }
        }
    }
}

#[test]
fn own_layout_shows_each_face_where_its_uv_are() {
    let positions = vec![DVec3::ZERO, DVec3::X, DVec3::new(1.0, 1.0, 0.0), DVec3::Y];
    let mesh = Mesh::new(positions, &[[0, 1, 2], [0, 2, 3]]).unwrap();
    let surface = Surface::new(mesh).unwrap();
    let uv = |x: f64, y: f64| DVec2::new(x, y);
    // The lower face is offset by one unit, which is removed.
    let uvs = [
        [uv(0.25, 0.25), uv(0.75, 0.25), uv(0.75, 0.75)],
        [uv(1.25, 0.25), uv(1.75, 0.75), uv(1.25, 0.75)],
    ];
    let atlas = Atlas::from_uvs(&surface, &uvs, [16, 16], 1).unwrap();
    assert_eq!(atlas.face([10, 5]), Some(FaceIdx(0)), "upper right half");
    assert_eq!(atlas.face([5, 10]), Some(FaceIdx(1)), "lower left half");
    assert_eq!(atlas.face([3, 8]), Some(FaceIdx(1)), "padding");
    assert_eq!(atlas.face([2, 8]), None, "beyond the padding");
    let point = atlas.point(&surface, [9, 6]).unwrap();
    let at = surface.position(point);
    assert!(
        at.distance(DVec3::new(5.5 / 8.0, 2.5 / 8.0, 0.0)) < 1e-12,
        "{at}"
    );
}

#[test]
fn bad_layouts_are_refused() {
    let surface = cuboid();
    for side in [0, 1, 17, 1 << 15] {
        assert!(Atlas::uniform(&surface, side).is_err(), "uniform {side}");
        assert!(Atlas::by_area(&surface, side).is_err(), "by area {side}");
    }
    let error = Atlas::from_uvs(&surface, &[], [8, 8], 1).unwrap_err();
    assert!(
        matches!(error.kind(), SynthErrorKind::Count { count: 0, .. }),
        "{error}"
    );
    let nowhere = [[DVec2::NAN; 3]; 12];
    let atlas = Atlas::from_uvs(&surface, &nowhere, [8, 8], 1).unwrap();
    assert_eq!(atlas.coverage(), 0.0, "uv that are not finite show nothing");
}

/// Returns the set of faces that each texel of the next mipmap level mixes, which is the union over 2 × 2 texels.
fn halved(level: &[Vec<Vec<u32>>]) -> Vec<Vec<Vec<u32>>> {
    let side = level.len() / 2;
    let faces = |row: usize, column: usize| {
        let parts = [[0, 0], [0, 1], [1, 0], [1, 1]];
        let mut faces: Vec<u32> = parts
            .iter()
            .flat_map(|[down, right]| &level[2 * row + down][2 * column + right])
            .copied()
            .collect();
        faces.sort_unstable();
        faces.dedup();
        faces
    };
    (0..side)
        .map(|row| (0..side).map(|column| faces(row, column)).collect())
        .collect()
}

#[test]
fn padding_keeps_levels_of_a_mipmap_apart() {
    let surface = cuboid();
    for (padding, n_levels) in [(1, 1), (2, 2), (4, 3)] {
        for atlas in [
            Atlas::uniform_padded(&surface, 160, padding).unwrap(),
            Atlas::by_area_padded(&surface, 192, padding).unwrap(),
        ] {
            let side = atlas.size()[0];
            let face = |column, row| vec![atlas.face([column, row]).map_or(NONE, |face| face.0)];
            let mut level: Vec<Vec<Vec<u32>>> = (0..side)
                .map(|row| (0..side).map(|column| face(column, row)).collect())
                .collect();
            for number in 0..n_levels {
                let scale = f64::from(1 << number);
                for (face, &[a, b, c]) in (0..).zip(&atlas.corners) {
                    for (to_b, to_c) in [(0.0, 0.0), (1.0, 0.0), (0.0, 1.0), (0.5, 0.5), (0.3, 0.7)]
                    {
                        let at = (a + (b - a) * to_b + (c - a) * to_c) / scale - 0.5;
                        let texel = at.floor();
                        for near in [DVec2::ZERO, DVec2::X, DVec2::Y, DVec2::ONE] {
                            let read = texel + near;
                            if (at - read).abs().max_element() < 1.0 - 1e-9 {
                                let faces = &level[read.y as usize][read.x as usize];
                                assert_eq!(faces, &[face], "level {number}, padding {padding}");
                            }
                        }
                    }
                }
                level = halved(&level);
            }
        }
    }
    for padding in [0, 1025, u32::MAX] {
        assert!(
            Atlas::uniform_padded(&surface, 160, padding).is_err(),
            "uniform {padding}"
        );
        assert!(
            Atlas::by_area_padded(&surface, 160, padding).is_err(),
            "by area {padding}"
        );
    }
}

#[test]
fn tiles_are_not_mirrored() {
    let surface = cuboid();
    for atlas in [
        Atlas::uniform(&surface, 64).unwrap(),
        Atlas::by_area(&surface, 64).unwrap(),
    ] {
        for [a, b, c] in atlas.uvs() {
            // Counterclockwise in the map, where rows go down.
            assert!((b - a).perp_dot(c - a) < 0.0, "{a} {b} {c}");
        }
    }
}

#[test]
fn padding_of_an_own_layout_ends_where_the_map_is_full() {
    let surface = cuboid();
    let mut uvs = vec![[DVec2::NAN; 3]; 12];
    uvs[4] = [
        DVec2::new(0.4, 0.4),
        DVec2::new(0.6, 0.4),
        DVec2::new(0.4, 0.6),
    ];
    let atlas = Atlas::from_uvs(&surface, &uvs, [32, 20], u32::MAX).unwrap();
    assert_eq!(atlas.coverage(), 1.0);
    uvs[4] = [DVec2::NAN; 3];
    let atlas = Atlas::from_uvs(&surface, &uvs, [32, 20], u32::MAX).unwrap();
    assert_eq!(atlas.coverage(), 0.0);
}

#[test]
fn own_layout_has_no_gap_where_an_edge_goes_through_the_center_of_a_texel() {
    // By rounding, the center of texel (3, 3) is slightly outside of both faces.
    let [p, q] = [
        DVec2::new(0.32, 0.53),
        DVec2::new(0.5549999999999999, 0.345),
    ];
    let above = DVec2::new(0.53, 0.5549999999999999);
    let below = DVec2::new(0.345, 0.32000000000000006);
    let center = DVec2::splat(3.5);
    for face in [[above, p, q], [q, p, below]] {
        let least = weights(face.map(|uv| uv * 8.0), center).map(|weight| weight < 0.0);
        assert!(least.contains(&true), "the case: {face:?}");
    }
    let positions = [above, p, q, below].map(|uv| DVec3::new(uv.x, 1.0 - uv.y, 0.0));
    let mesh = Mesh::new(positions.to_vec(), &[[0, 1, 2], [2, 1, 3]]).unwrap();
    let surface = Surface::new(mesh).unwrap();
    let atlas = Atlas::from_uvs(&surface, &[[above, p, q], [q, p, below]], [8, 8], 0).unwrap();
    assert_eq!(atlas.face([3, 3]), Some(FaceIdx(0)));
}

#[test]
fn texels_beside_a_sliver_are_on_the_surface() {
    let surface = cuboid();
    let mut uvs = vec![[DVec2::NAN; 3]; 12];
    // A face with the size of rounding errors, around the center of a texel.
    for size in [1e-12, 1e-15] {
        let center = DVec2::splat(4.5 / 8.0);
        uvs[0] = [
            center + DVec2::new(-size, -size),
            center + DVec2::new(size, -size),
            center + DVec2::new(0.0, size),
        ];
        let atlas = Atlas::from_uvs(&surface, &uvs, [8, 8], 8).unwrap();
        assert_eq!(atlas.coverage(), 1.0, "all is padding");
        for texel in [[0, 0], [4, 4], [7, 3]] {
            let point = atlas.point(&surface, texel).unwrap();
            assert!(surface.position(point).is_finite(), "{point:?}");
            let weights = surface.weights(point);
            assert!(weights.iter().all(|&weight| weight > -1e-6), "{weights:?}");
        }
    }
}

/// Returns texture coordinates for a mesh above the unit square, projected along z.
fn from_above(surface: &Surface) -> Vec<[DVec2; 3]> {
    let faces = 0..surface.mesh().faces().len() as u32;
    let place = |at: DVec3| DVec2::new(at.x, 1.0 - at.y);
    faces
        .map(|face| surface.mesh().corners(FaceIdx(face)).map(place))
        .collect()
}

#[test]
fn padding_continues_the_plane_up_to_its_border() {
    let surface = Surface::new(square()).unwrap();
    let atlas = Atlas::uniform_padded(&surface, 128, 3).unwrap();
    let mut met = 0;
    for row in 0..128 {
        for column in 0..128 {
            let Some(face) = atlas.face([column, row]) else {
                continue;
            };
            let [a, b, c] = surface.mesh().corners(face);
            let center = DVec2::new(f64::from(column) + 0.5, f64::from(row) + 0.5);
            let [of_a, of_b, of_c] = weights(atlas.corners[face.index()], center);
            let want = a * of_a + b * of_b + c * of_c;
            let point = atlas.point(&surface, [column, row]).unwrap();
            let at = surface.position(point);
            if want.min(DVec3::ONE - want).truncate().min_element() >= 0.0 {
                assert!(at.distance(want) < 1e-12, "{at} for {want}");
            } else {
                met += 1;
                let nearest = at.min(DVec3::ONE - at).truncate().min_element();
                assert!(
                    nearest.abs() < 1e-12,
                    "{at} for {want} is not on the border"
                );
            }
        }
    }
    assert!(met > 100, "only {met} texels lie past the border");
}

#[test]
fn tangents_do_not_jump_across_the_edges_of_a_continuous_layout() {
    let mesh = moved(&cap(), |at| at + DVec3::new(0.5, 0.5, 0.0));
    let surface = Surface::new(mesh).unwrap();
    let atlas = Atlas::from_uvs(&surface, &from_above(&surface), [200, 200], 0).unwrap();
    let smooth = surface.mesh().corner_normals(core::f64::consts::PI);
    let tangents = Tangents::new(&surface, &atlas, &smooth);
    let mut jumps = 0;
    for row in 0..200 {
        for column in 1..200 {
            let pair = [[column - 1, row], [column, row]];
            let [Some(left), Some(right)] = pair.map(|texel| atlas.face(texel)) else {
                continue;
            };
            let [[a, up], [b, _]] = pair.map(|texel| {
                let point = atlas.point(&surface, texel).unwrap();
                tangents.frame(&atlas, texel, surface.normal(point))
            });
            // A texel is 1/25 of a face of the cap, over which normals rotate by less than 0.2.
            assert!(a.distance(b) < 0.02, "{a} beside {b}");
            assert!(up.y > 0.5 && a.x > 0.5, "{a} and {up} are right and up");
            jumps += usize::from(left != right);
        }
    }
    assert!(jumps > 500, "only {jumps} edges are crossed");
}

#[test]
fn report_of_a_map_twice_as_wide_as_high_is_that_of_its_singular_values() {
    let surface = Surface::new(square()).unwrap();
    let mut uvs = from_above(&surface);
    for uv in uvs.iter_mut().flatten() {
        uv.y *= 0.5;
    }
    let report = Atlas::from_uvs(&surface, &uvs, [64, 64], 0)
        .unwrap()
        .report(&surface);
    // The lengths of a texel are 1 and 2 along its axes. A square of the same area has the length sqrt(2).
    assert!((report.stretch - (2.5_f64 / 2.0).sqrt()).abs() < 1e-12);
    assert_eq!((report.pieces, report.used), (1, 0.5));
    // First one face without a place, then the same face apart from the others.
    uvs[0] = [DVec2::NAN; 3];
    let atlas = Atlas::from_uvs(&surface, &uvs, [64, 64], 0).unwrap();
    assert_eq!(
        atlas
            .stretches(&surface)
            .iter()
            .filter(|s| s.is_nan())
            .count(),
        1
    );
    uvs[0] = [
        DVec2::new(0.0, 0.9),
        DVec2::new(0.1, 0.9),
        DVec2::new(0.0, 1.0),
    ];
    let atlas = Atlas::from_uvs(&surface, &uvs, [64, 64], 0).unwrap();
    assert_eq!(atlas.report(&surface).pieces, 2);
}
