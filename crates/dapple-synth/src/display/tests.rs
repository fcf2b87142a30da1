//! Models that fit together, also as files.

use super::*;
use crate::shapes::{sphere, square, synthesizer};
use crate::{bake_colors, displaced_sites};
use dapple_color::LinearRgb;
use dapple_image::{Transfer, encode_png};
use dapple_mesh::io::gltf;
use glam::DVec3;

const N: usize = 300;

/// Shading without a crease.
fn smooth(surface: &Surface) -> Vec<[DVec3; 3]> {
    surface.mesh().corner_normals(core::f64::consts::PI)
}

fn png() -> EncodedImage {
    EncodedImage::new(b"\x89PNG\r\n\x1a\n and more".to_vec()).unwrap()
}

#[test]
fn sites_are_the_vertices_of_both_models() {
    let sphere = synthesizer(sphere(), N, |_, _| DVec3::NEG_Y);
    let color = |at: usize| LinearRgba::opaque(LinearRgb::gray(at as f32));
    let colors: Vec<LinearRgba> = (0..N).map(color).collect();
    let triangles = site_model(&sphere, colors.clone()).unwrap();
    let points = point_model(&sphere, colors.clone()).unwrap();
    for model in [&triangles, &points] {
        model.check().unwrap();
        assert_eq!(
            model.mesh.positions(),
            sphere.hierarchy().sites().positions()
        );
        assert_eq!(
            model.normals.as_deref(),
            Some(sphere.hierarchy().sites().normals())
        );
        assert_eq!(model.colors.as_ref(), Some(&colors));
    }
    assert_eq!(points.mesh.faces().len(), 0, "points");
    // Euler: a closed surface of N vertices has 2 N - 4 triangles.
    assert_eq!(triangles.mesh.faces().len(), 2 * N - 4);
    for colors in [vec![], vec![color(0); N + 1]] {
        assert!(site_model(&sphere, colors.clone()).is_err(), "triangles");
        assert!(point_model(&sphere, colors).is_err(), "points");
    }
    let mut displaced = triangles;
    displaced.mesh = displaced_sites(&sphere, &[1.0; N], 0.1).unwrap();
    displaced.check().unwrap();
}

#[test]
fn textured_model_comes_back_from_its_file() {
    let sphere = synthesizer(sphere(), N, |_, _| DVec3::NEG_Y);
    let atlas = Atlas::uniform(sphere.surface(), 256).unwrap();
    let map = bake_colors(&sphere, &[LinearRgb::new(1.0, 0.5, 0.0); N], &atlas).unwrap();
    let codes = map.map(|color| color.to_srgb::<u8>());
    let png = EncodedImage::new(encode_png(codes.view(), Transfer::Srgb).unwrap()).unwrap();
    let model = textured_model(
        sphere.surface(),
        &atlas,
        smooth(sphere.surface()),
        png.clone(),
    )
    .unwrap();
    model.check().unwrap();
    let read = gltf::read(&gltf::write(&model).unwrap()).unwrap();
    assert_eq!(read.material.base_color, Some(png));
    assert_eq!(read.mesh.faces().len(), model.mesh.faces().len());
    for (read, uvs) in read.uvs.unwrap().iter().zip(atlas.uvs()) {
        for (read, uv) in read.iter().zip(uvs) {
            // The file has `f32`.
            assert!(read.distance(uv) < 1e-6, "{read} for {uv}");
        }
    }
}

#[test]
fn faces_without_a_place_have_texture_coordinates_all_the_same() {
    let plane = synthesizer(square(), N, |_, _| DVec3::NEG_Y);
    let nowhere = vec![[DVec2::NAN; 3]; plane.surface().mesh().faces().len()];
    let atlas = Atlas::from_uvs(plane.surface(), &nowhere, [8, 8], 1).unwrap();
    let model = textured_model(plane.surface(), &atlas, smooth(plane.surface()), png()).unwrap();
    model.check().unwrap();
    assert_eq!(model.uvs.unwrap()[3], [DVec2::ZERO; 3]);
}

#[test]
fn atlas_of_another_mesh_is_refused() {
    let plane = synthesizer(square(), N, |_, _| DVec3::NEG_Y);
    let other = synthesizer(sphere(), N, |_, _| DVec3::NEG_Y);
    let atlas = Atlas::uniform(other.surface(), 256).unwrap();
    let shading = smooth(plane.surface());
    let error = textured_model(plane.surface(), &atlas, shading, png()).unwrap_err();
    assert!(
        matches!(error.kind(), SynthErrorKind::Count { .. }),
        "{error}"
    );
}
