//! Normal maps on planes, where the normals are known, and on a sphere, compared with vectors interpolated
//! individually.

use super::*;
use crate::SynthErrorKind;
use crate::shapes::{pixel_per_site, row, sphere, square, synthesizer};
use dapple_mesh::{CREASE, Mesh};
use glam::DVec2;

const N: usize = 400;
const TILTED: Normal = Normal {
    x: 0.48,
    y: 0.36,
    z: 0.8,
};

/// The unit square with a field at an angle to down, and a layout of the whole square, optionally mirrored.
fn plane(angle: f64, mirrored: bool) -> (Synthesizer, Atlas) {
    let down = DVec3::new(libm::sin(angle), -libm::cos(angle), 0.0);
    let plane = synthesizer(square(), N, |_, _| down);
    let place = |at: DVec3| DVec2::new(if mirrored { 1.0 - at.x } else { at.x }, 1.0 - at.y);
    let mesh = plane.surface().mesh();
    let faces = mesh.faces().iter();
    let uvs: Vec<[DVec2; 3]> = faces
        .map(|face| face.map(|vertex| place(mesh.positions()[vertex.index()])))
        .collect();
    let atlas = Atlas::from_uvs(plane.surface(), &uvs, [40, 30], 0).unwrap();
    (plane, atlas)
}

/// Bakes one normal per site, interpolated between sites.
fn baked(
    synthesizer: &Synthesizer,
    normals: &[Normal],
    y: NormalY,
    atlas: &Atlas,
    shading: &[[DVec3; 3]],
) -> Result<Raster<Normal>, SynthError> {
    let texture = pixel_per_site(normals.len());
    bake_normals(synthesizer, &texture, &row(normals), y, atlas, shading)
}

/// Shading normals without creases.
fn smooth(synthesizer: &Synthesizer) -> Vec<[DVec3; 3]> {
    synthesizer
        .surface()
        .mesh()
        .corner_normals(core::f64::consts::PI)
}

fn assert_all(map: &Raster<Normal>, want: [f64; 3], what: &str) {
    for normal in map.pixels() {
        for (got, want) in normal.to_array().into_iter().zip(want) {
            // Tolerance: some roundings to `f32`.
            assert!(
                (f64::from(got) - want).abs() < 1e-6,
                "{what}: {normal:?} for {want}"
            );
        }
    }
}

#[test]
fn rotated_field_rotates_the_normals() {
    for angle in [0.0, 0.3, 1.5, 3.0, -2.0] {
        let (plane, atlas) = plane(angle, false);
        let map = baked(
            &plane,
            &[TILTED; N],
            NormalY::OpenGl,
            &atlas,
            &smooth(&plane),
        )
        .unwrap();
        let (sin, cos) = (libm::sin(angle), libm::cos(angle));
        let (x, y) = (0.48, 0.36);
        // The normal rotates counterclockwise with the field.
        let want = [x * cos - y * sin, x * sin + y * cos, 0.8];
        assert_all(&map, want, &format!("angle {angle}"));
    }
}

#[test]
fn mirrored_layout_mirrors_the_normals() {
    let (plane, atlas) = plane(0.0, true);
    let map = baked(
        &plane,
        &[TILTED; N],
        NormalY::OpenGl,
        &atlas,
        &smooth(&plane),
    )
    .unwrap();
    assert_all(&map, [-0.48, 0.36, 0.8], "mirrored");
}

#[test]
fn green_points_down_for_directx() {
    let (plane, atlas) = plane(0.3, false);
    let down = Normal {
        y: -TILTED.y,
        ..TILTED
    };
    let up = baked(
        &plane,
        &[TILTED; N],
        NormalY::OpenGl,
        &atlas,
        &smooth(&plane),
    )
    .unwrap();
    let down = baked(
        &plane,
        &[down; N],
        NormalY::DirectX,
        &atlas,
        &smooth(&plane),
    )
    .unwrap();
    for (up, down) in up.pixels().iter().zip(down.pixels()) {
        assert_eq!((up.x, up.y, up.z), (down.x, -down.y, down.z));
    }
}

#[test]
fn flat_normals_stay_flat() {
    let sphere = synthesizer(sphere(), N, |_, _| DVec3::NEG_Y);
    for atlas in [
        Atlas::uniform(sphere.surface(), 200).unwrap(),
        Atlas::by_area(sphere.surface(), 300).unwrap(),
    ] {
        for y in [NormalY::OpenGl, NormalY::DirectX] {
            // Flat normals as images of 8 and 16 bits store them; no code has the value 0.
            let read = [
                Normal::FLAT,
                Normal::from_codes([128_u8, 128, 255]),
                Normal::from_codes([127_u8, 128, 255]),
                Normal::from_codes([32768_u16, 32768, 65535]),
                Normal::from_codes([32768_u16, 32767, 65535]),
            ];
            for flat in read {
                let map = baked(&sphere, &[flat; N], y, &atlas, &smooth(&sphere)).unwrap();
                assert!(map.pixels().iter().all(|&normal| normal == Normal::FLAT));
            }
        }
    }
}

#[test]
fn normals_cancel_to_flat() {
    let (plane, atlas) = plane(0.0, false);
    let inward = [Normal {
        x: 0.0,
        y: 0.0,
        z: 0.0,
    }; N];
    let map = baked(&plane, &inward, NormalY::OpenGl, &atlas, &smooth(&plane)).unwrap();
    assert_all(&map, [0.0, 0.0, 1.0], "nothing");
}

/// A program that reads the map and computes its own tangents sees the interpolated vectors of the sites.
#[test]
fn decoded_normals_are_the_mixed_vectors_of_the_sites() {
    let sphere = synthesizer(sphere(), N, |at, _| DVec3::Y.cross(at) + DVec3::splat(0.2));
    let surface = sphere.surface();
    let atlas = Atlas::uniform(surface, 300).unwrap();
    let map = baked(
        &sphere,
        &[TILTED; N],
        NormalY::OpenGl,
        &atlas,
        &smooth(&sphere),
    )
    .unwrap();
    let (sites, downs) = (sphere.hierarchy().sites(), sphere.orientation().vectors());
    let along: Vec<DVec3> = sites
        .normals()
        .iter()
        .zip(downs)
        .map(|(&out, &down)| out.cross(down) * 0.48 - down * 0.36)
        .collect();
    let uvs = atlas.uvs();
    let mut shown = 0;
    for row in (0..300).step_by(3) {
        for column in (0..300).step_by(5) {
            let Some(point) = atlas.point(surface, [column, row]) else {
                continue;
            };
            let face = atlas.face([column, row]).unwrap();
            if point.face != face {
                continue;
            }
            shown += 1;
            let out = surface.normal(point);
            // Solve for the tangent: the edges of the face are their steps in u and v times two vectors.
            let [a, b, c] = surface.mesh().corners(face);
            let [ua, ub, uc] = uvs[face.index()];
            let steps = glam::DMat2::from_cols(ub - ua, uc - ua).inverse();
            let tangent = (b - a) * steps.x_axis.x + (c - a) * steps.x_axis.y;
            let bottom = (b - a) * steps.y_axis.x + (c - a) * steps.y_axis.y;
            let tangent = (tangent - out * tangent.dot(out)).normalize();
            let up = out.cross(tangent);
            let up = if up.dot(bottom) < 0.0 { up } else { -up };
            let [x, y, z] = map.row(row)[column as usize].to_array().map(f64::from);
            let seen = tangent * x + up * y + out * z;
            let at = surface.position(point);
            let normal = surface.face_normal(face);
            let mixed = sphere.hierarchy().interpolate(0, &along, at, normal);
            let mixed = mixed.unwrap().unwrap();
            let want = (mixed - out * mixed.dot(out) + out * 0.8).normalize();
            // Tangents of corners are interpolated here, without the face's rotation: an error of second order in the
            // mesh's angles.
            assert!(seen.distance(want) < 0.01, "{seen} beside {want}");
        }
    }
    assert!(shown > 2000, "only {shown} texels");
}

#[test]
fn normals_keep_their_tilt_where_the_mesh_is_shaded_flat() {
    let roof = Mesh::new(
        vec![
            DVec3::ZERO,
            DVec3::new(2.0, 0.0, 0.0),
            DVec3::new(2.0, 1.0, 1.0),
            DVec3::new(0.0, 1.0, 1.0),
            DVec3::new(2.0, 2.0, 0.0),
            DVec3::new(0.0, 2.0, 0.0),
        ],
        &[[0, 1, 2], [0, 2, 3], [3, 2, 4], [3, 4, 5]],
    )
    .unwrap();
    // The exemplar's down points along the ridge, which lies on both sides.
    let roof = synthesizer(roof, N, |_, _| DVec3::X);
    let flat = roof.surface().mesh().corner_normals(CREASE);
    let atlas = Atlas::uniform(roof.surface(), 128).unwrap();
    let map = baked(&roof, &[TILTED; N], NormalY::OpenGl, &atlas, &flat).unwrap();
    let mut shown = 0;
    for row in 0..128 {
        for column in 0..128 {
            let texel = [column, row];
            let Some(point) = atlas.point(roof.surface(), texel) else {
                continue;
            };
            // Skip texels within reach of sites beyond the ridge, where the vectors of both sides are mixed.
            let from_ridge = 1.0 - roof.surface().position(point).z;
            if from_ridge > 0.25 {
                shown += 1;
                let z = map.row(row)[column as usize].z;
                // Normals of sites near the ridge are between the normals of both sides.
                assert!((z - TILTED.z).abs() < 0.02, "{z} at {texel:?}");
            }
        }
    }
    assert!(shown > 5000, "only {shown} texels");
}

#[test]
fn bad_normals_are_refused() {
    let (plane, atlas) = plane(0.0, false);
    let error = baked(
        &plane,
        &[TILTED; N + 1],
        NormalY::OpenGl,
        &atlas,
        &smooth(&plane),
    )
    .unwrap_err();
    assert!(
        matches!(error.kind(), SynthErrorKind::Count { count: 401, .. }),
        "{error}"
    );
    let normals = [TILTED; N];
    let error = baked(&plane, &normals, NormalY::OpenGl, &atlas, &[]).unwrap_err();
    assert!(
        matches!(error.kind(), SynthErrorKind::Count { count: 0, .. }),
        "{error}"
    );
    for bad in [f32::NAN, f32::INFINITY] {
        let normal = Normal { y: bad, ..TILTED };
        let error = baked(
            &plane,
            &[normal; N],
            NormalY::OpenGl,
            &atlas,
            &smooth(&plane),
        )
        .unwrap_err();
        assert!(
            matches!(error.kind(), SynthErrorKind::Range { .. }),
            "{error}"
        );
    }
}

#[test]
fn value_stability_bake_normals() {
    let (plane, atlas) = plane(0.3, false);
    let map = baked(
        &plane,
        &[TILTED; N],
        NormalY::OpenGl,
        &atlas,
        &smooth(&plane),
    )
    .unwrap();
    let bits = map.row(7)[9].to_array().map(f32::to_bits);
    assert_eq!(bits, [1_052_004_398, 1_056_487_156, 1_061_997_773]);
}

#[cfg(feature = "rayon")]
#[test]
fn normals_have_the_same_bits_on_any_number_of_threads() {
    let sphere = synthesizer(sphere(), N, |_, _| DVec3::NEG_Y);
    let atlas = Atlas::uniform(sphere.surface(), 200).unwrap();
    let bake = || {
        baked(
            &sphere,
            &[TILTED; N],
            NormalY::OpenGl,
            &atlas,
            &smooth(&sphere),
        )
        .unwrap()
    };
    let [one, two, seven] = crate::shapes::on_threads(bake);
    assert_eq!(one, two, "2 threads");
    assert_eq!(one, seven, "7 threads");
}
