//! Tests of charts on small meshes.

use super::{MANY, n_components, padding};
use crate::SynthErrorKind;
use crate::atlas::{Atlas, report::pieces, tangents::center, weights};
use crate::shapes::{
    cap, geodesic_sphere, moved, plane, scraps, sheet, sheets, sphere, torus, tube, two_squares,
};
use core::ops::ControlFlow;
use dapple_mesh::{FaceIdx, Mesh, Surface};
use glam::{DVec2, DVec3};
use proptest::prelude::*;
use std::collections::BTreeSet;
use std::sync::Mutex;

/// Returns the unit cube.
fn cube() -> Mesh {
    let bits = (0..8).map(|corner| [0, 1, 2].map(|axis| f64::from(corner >> axis & 1)));
    let sides = [
        [0, 2, 3, 1],
        [4, 5, 7, 6],
        [0, 1, 5, 4],
        [2, 6, 7, 3],
        [0, 4, 6, 2],
        [1, 3, 7, 5],
    ];
    let faces = sides.map(|[a, b, c, d]| [[a, b, c], [a, c, d]]).concat();
    Mesh::new(bits.map(DVec3::from).collect(), &faces).unwrap()
}

/// Returns surfaces with and without borders, handles and creases, in one and in several components.
fn surfaces() -> Vec<Surface> {
    let meshes = [cube(), sphere(), cap(), tube(), two_squares()];
    let meshes = meshes.into_iter().map(|mesh| Surface::new(mesh).unwrap());
    let others = [plane(), torus(64, 32), geodesic_sphere(3), scraps(12)];
    meshes
        .chain(others)
        .chain([sheets(&[0.0, 0.5, 1.0])])
        .collect()
}

/// Asserts that every face is not mirrored, lies within the map, and covers all texels whose centers are inside of it.
fn assert_apart(atlas: &Atlas) {
    let size = DVec2::from(atlas.size().map(f64::from));
    for (face, corners) in (0..).map(FaceIdx).zip(&atlas.corners) {
        let [a, b, c] = *corners;
        if !a.is_finite() {
            continue;
        }
        assert!((b - a).perp_dot(c - a) < 0.0, "{face:?} is mirrored");
        let (low, high) = (a.min(b).min(c), a.max(b).max(c));
        assert!(
            low.min_element() >= 0.0 && high.cmple(size).all(),
            "{face:?} is outside"
        );
        for row in low.y as u32..(high.y.ceil() as u32).min(atlas.size()[1]) {
            for column in low.x as u32..(high.x.ceil() as u32).min(atlas.size()[0]) {
                let at = weights(*corners, center([column, row]));
                // A center on an edge belongs to both faces.
                if at.iter().all(|&weight| weight > 1e-6) {
                    assert_eq!(atlas.face([column, row]), Some(face), "{column}, {row}");
                }
            }
        }
    }
}

#[test]
fn charts_are_in_the_map_not_mirrored_and_apart() {
    for surface in surfaces() {
        let atlas = Atlas::charts(&surface, 256).unwrap();
        assert!(
            atlas
                .corners
                .iter()
                .flatten()
                .all(|corner| corner.is_finite())
        );
        assert_eq!(atlas.coverage(), 1.0, "all texels continue some chart");
        assert_apart(&atlas);
    }
}

#[test]
fn charts_are_as_far_apart_as_twice_their_padding() {
    for surface in surfaces() {
        for padding in [1, 2, 4] {
            let atlas = Atlas::charts_padded(&surface, 256, padding).unwrap();
            let pieces = pieces(&atlas, &surface);
            let reach = i64::from(padding);
            for [column, row] in texels(&atlas) {
                let Some(face) = atlas.face([column, row]) else {
                    continue;
                };
                let at = weights(atlas.corners[face.index()], center([column, row]));
                if at.iter().any(|&weight| weight < 0.0) {
                    continue;
                }
                for near in [
                    [-reach, 0],
                    [reach, 0],
                    [0, -reach],
                    [0, reach],
                    [reach, reach],
                ] {
                    let [x, y] = [i64::from(column) + near[0], i64::from(row) + near[1]];
                    let Some(other) = atlas.face([x as u32, y as u32]) else {
                        continue;
                    };
                    let same = pieces[other.index()] == pieces[face.index()];
                    assert!(same, "{near:?} from {column}, {row}, padding {padding}");
                }
            }
        }
    }
}

/// Returns the texels that are not at the border of the map.
fn texels(atlas: &Atlas) -> impl Iterator<Item = [u32; 2]> {
    let [width, height] = atlas.size();
    (5..height - 5).flat_map(move |row| (5..width - 5).map(move |column| [column, row]))
}

#[test]
fn charts_of_what_is_flat_or_rolled_are_not_stretched() {
    for (surface, pieces) in [
        (Surface::new(cube()).unwrap(), 6),
        (plane(), 1),
        (Surface::new(two_squares()).unwrap(), 2),
    ] {
        let report = Atlas::charts(&surface, 256).unwrap().report(&surface);
        assert_eq!(report.pieces, pieces, "pieces");
        assert!((report.stretch - 1.0).abs() < 1e-6, "{}", report.stretch);
    }
    // A tube unrolls to a rectangle; its triangles are chords of the circle.
    let tube = Surface::new(tube()).unwrap();
    let report = Atlas::charts(&tube, 256).unwrap().report(&tube);
    assert!((report.stretch - 1.0).abs() < 1e-4, "{}", report.stretch);
    assert!(report.pieces <= 9, "{} pieces", report.pieces);
}

#[test]
fn charts_share_vertices_and_texels_are_even() {
    let surface = torus(64, 32);
    let atlas = Atlas::charts(&surface, 512).unwrap();
    let report = atlas.report(&surface);
    assert!(report.stretch < 1.01, "{}", report.stretch);
    assert!(report.pieces < 40, "{} pieces", report.pieces);
    let corners = surface.mesh().faces().iter().zip(&atlas.corners);
    let mut vertices: Vec<(u32, [u64; 2])> = corners
        .flat_map(|(face, places)| [0, 1, 2].map(|at| (face[at].0, places[at])))
        .map(|(vertex, place)| (vertex, place.to_array().map(f64::to_bits)))
        .collect();
    vertices.sort_unstable();
    vertices.dedup();
    let n_vertices = surface.mesh().positions().len();
    assert!(
        vertices.len() * 10 < n_vertices * 15,
        "{} vertices of {n_vertices}",
        vertices.len()
    );
    let tiles = Atlas::by_area(&surface, 512).unwrap().report(&surface);
    assert!(tiles.stretch > 1.05, "{} with tiles", tiles.stretch);
    assert!(tiles.used < report.used, "{} with tiles", tiles.used);
}

#[test]
fn charts_do_not_depend_on_the_scale_of_a_mesh() {
    let mesh = sphere();
    let uvs = |mesh: Mesh| {
        let surface = Surface::new(mesh).unwrap();
        Atlas::charts(&surface, 128).unwrap().uvs()
    };
    let want = uvs(mesh.clone());
    let large = (1_u64 << 60) as f64;
    for scale in [large, 1.0 / large] {
        assert_eq!(uvs(moved(&mesh, |at| at * scale)), want, "times {scale}");
    }
}

#[test]
fn charts_without_room_are_refused() {
    let surface = Surface::new(sphere()).unwrap();
    for side in [0, 1, 2, 1 << 15] {
        assert!(Atlas::charts(&surface, side).is_err(), "side {side}");
    }
    for padding in [0, 64, 1025, u32::MAX] {
        let atlas = Atlas::charts_padded(&surface, 64, padding);
        assert!(atlas.is_err(), "padding {padding}");
    }
    assert_eq!([1, 511, 512, 2048, 4096].map(padding), [1, 1, 2, 2, 4]);
}

#[test]
fn charts_report_their_progress_and_stop() {
    let surface = Surface::new(torus(64, 32).mesh().clone()).unwrap();
    let mut parts = Vec::new();
    let heard = Atlas::charts_with(&surface, 256, None, |part| {
        parts.push(part);
        ControlFlow::Continue(())
    });
    assert_eq!(heard.unwrap(), Atlas::charts(&surface, 256).unwrap());
    assert!(parts.is_sorted() && parts.last() == Some(&1.0), "{parts:?}");
    assert!(
        parts.iter().any(|part| (0.1..0.9).contains(part)),
        "{parts:?}"
    );
    let mut calls = 0;
    let stopped = Atlas::charts_with(&surface, 256, None, |part| {
        calls += 1;
        if part > 0.0 {
            ControlFlow::Break(())
        } else {
            ControlFlow::Continue(())
        }
    });
    let error = stopped.unwrap_err();
    assert!(matches!(error.kind(), SynthErrorKind::Cancelled), "{error}");
    assert!(calls < parts.len(), "{calls} of {}", parts.len());
}

#[test]
fn many_charts_are_packed_in_rows_and_refused_early() {
    // Loose squares, one chart per square: more charts than are packed by shape.
    let squares = |n: u32| {
        let corner = |x: u32, y: u32| DVec3::new(x.into(), y.into(), 0.0);
        let square = |at: u32| {
            let [x, y] = [3 * (at % 40), 3 * (at / 40)];
            [[0, 0], [2, 0], [2, 2], [0, 2]].map(|[i, j]| corner(x + i, y + j))
        };
        let faces: Vec<_> = (0..n)
            .flat_map(|at| {
                [
                    [4 * at, 4 * at + 1, 4 * at + 2],
                    [4 * at, 4 * at + 2, 4 * at + 3],
                ]
            })
            .collect();
        let positions = (0..n).flat_map(square).collect();
        Surface::new(Mesh::new(positions, &faces).unwrap()).unwrap()
    };
    let surface = squares(MANY as u32 + 100);
    let atlas = Atlas::charts(&surface, 256).unwrap();
    assert_apart(&atlas);
    assert_eq!(atlas.report(&surface).pieces, MANY + 100);
    let calls_of = |surface: &Surface, side: u32| {
        let mut n_calls = 0;
        let atlas = Atlas::charts_with(surface, side, None, |_| {
            n_calls += 1;
            ControlFlow::Continue(())
        });
        (atlas, n_calls)
    };
    // Each chart is cut once: a first attempt to pack by shape would report more than 512 charts twice.
    let (_, n_calls) = calls_of(&surface, 256);
    assert!(n_calls < 2 * MANY, "{n_calls} calls");
    // A chart with a padding of 1 takes at least 5 texels, so 64 × 64 texels hold at most 819 charts. More components
    // are rejected before any is cut.
    let (refused, n_calls) = calls_of(&squares(820), 64);
    let error = refused.unwrap_err();
    assert!(
        matches!(error.kind(), SynthErrorKind::Range { .. }),
        "{error}"
    );
    assert_eq!(n_calls, 0, "refused before it is cut");
}

#[test]
fn components_are_counted_over_vertices_at_one_position() {
    let positions = [
        [0.0, 0.0, 0.0],
        [1.0, 0.0, 0.0],
        [0.0, 1.0, 0.0],
        [-0.0, 0.0, 0.0],
        [2.0, 0.0, 1.0],
        [2.0, 1.0, 1.0],
        [3.0, 3.0, 3.0],
    ];
    // The second face touches the first one, the third has no area.
    assert_eq!(n_components(&positions, &[0, 1, 2, 3, 4, 5, 6, 6, 6]), 1);
    assert_eq!(n_components(&positions, &[0, 1, 2, 4, 5, 6]), 2);
    assert_eq!(n_components(&positions, &[0, 1, 2, 4, 5, 6, 2, 5, 1]), 1);
    assert_eq!(n_components(&[], &[]), 0);
}

#[test]
fn charts_are_flattened_on_the_threads_of_the_caller_with_the_same_bits() {
    let surface = torus(96, 48);
    let with = |n_threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(n_threads);
        let pools = Mutex::new(BTreeSet::new());
        let atlas = pool.build().unwrap().install(|| {
            Atlas::charts_with(&surface, 512, None, |_| {
                pools.lock().unwrap().insert(rayon::current_num_threads());
                ControlFlow::Continue(())
            })
        });
        (atlas.unwrap(), pools.into_inner().unwrap())
    };
    let (want, _) = with(1);
    for n_threads in [1, 2, 7] {
        let (atlas, pools) = with(n_threads);
        assert!(atlas == want, "{n_threads} threads");
        assert_eq!(pools, BTreeSet::from([n_threads]), "the pool of the caller");
    }
}

#[test]
fn value_stability_charts() {
    let atlas = Atlas::charts(&torus(24, 12), 256).unwrap();
    let corners = atlas.corners.iter().flatten().flat_map(|at| at.to_array());
    let bits = corners.fold(0_u64, |hash, part| hash.rotate_left(5) ^ part.to_bits());
    assert_eq!(bits, 0x6d53_8c17_2df8_f54c, "{bits:#x}");
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    #[test]
    fn charts_of_any_soup_are_apart(
        corners in prop::collection::vec(prop::array::uniform3(0_i8..4), 3..12),
        faces in prop::collection::vec(prop::array::uniform3(0_u32..12), 1..40),
    ) {
        let n = corners.len() as u32;
        let positions = corners.into_iter().map(|at| DVec3::from(at.map(f64::from))).collect();
        let faces: Vec<[u32; 3]> = faces.iter().map(|face| face.map(|vertex| vertex % n)).collect();
        let (mesh, _) = Mesh::new(positions, &faces).unwrap().repair();
        if let Ok(surface) = Surface::new(mesh) {
            let atlas = Atlas::charts(&surface, 512).unwrap();
            prop_assert!(atlas.corners.iter().flatten().all(|corner| corner.is_finite()));
            assert_apart(&atlas);
        }
    }

    #[test]
    fn charts_of_any_bent_sheet_are_apart(
        heights in prop::collection::vec(0_i8..5, 49),
        open in prop::array::uniform2(any::<bool>()),
    ) {
        let mesh = sheet([6, 6], open, |u, v| {
            let at = [u, v].map(|part| (part * 6.0) as usize);
            let [x, y] = [u, v].map(|part| part * core::f64::consts::TAU);
            let out = 1.0 + 0.2 * f64::from(heights[at[1] * 7 + at[0]]);
            DVec3::new(libm::cos(x) * out, libm::sin(x) * out, libm::cos(y))
        });
        if let Ok(surface) = Surface::new(mesh.repair().0) {
            assert_apart(&Atlas::charts(&surface, 256).unwrap());
        }
    }
}
