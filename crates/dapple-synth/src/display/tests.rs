//! Tests that the maps and texture coordinates of exported models match, also after a round trip through files.

use super::*;
use crate::shapes::{pixel_per_site, row, sphere, square, synthesizer};
use crate::{bake_colors, bake_values, displaced_sites};
use dapple_color::LinearRgb;
use dapple_image::{Transfer, encode_png};
use dapple_mesh_io::gltf;
use dapple_raster::Raster;
use glam::DVec3;

const N: usize = 300;

/// Shading normals without creases.
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
    // By Euler's formula, a closed surface of N vertices has 2 N - 4 triangles.
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
    let map = bake_colors(
        &sphere,
        &pixel_per_site(N),
        &row(&[LinearRgb::new(1.0, 0.5, 0.0); N]),
        &atlas,
    )
    .unwrap();
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
            // The file stores `f32`.
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

/// The next mipmap level: each texel is the mean of 2 × 2 texels.
fn halved(level: &Raster<f32>) -> Raster<f32> {
    let size = level.size().map(|length| length / 2);
    let mean = |column: u32, row: u32| {
        let pair = |row: u32| &level.row(row)[2 * column as usize..][..2];
        let (above, below) = (pair(2 * row), pair(2 * row + 1));
        (above[0] + above[1] + below[0] + below[1]) / 4.0
    };
    Raster::from_fn(size, mean).unwrap()
}

/// The bilinear sample of a level that repeats.
fn bilinear(level: &Raster<f32>, uv: DVec2) -> f64 {
    let side = f64::from(level.width());
    let at = uv * side - 0.5;
    let (first, part) = (at.floor(), at - at.floor());
    let texel = |right: f64, down: f64| {
        let [column, row] = [first.x + right, first.y + down].map(|at| at.rem_euclid(side) as u32);
        f64::from(level.row(row)[column as usize])
    };
    let mix = |a: f64, b: f64, part: f64| a + (b - a) * part;
    mix(
        mix(texel(0.0, 0.0), texel(1.0, 0.0), part.x),
        mix(texel(0.0, 1.0), texel(1.0, 1.0), part.x),
        part.y,
    )
}

/// Asserts that mipmap levels show the unit square as the map itself does. The map's values rise by 1 over the side of
/// the square, which spans `texels` texels.
fn assert_shown(atlas: &Atlas, n_levels: u32, texels: f64) {
    let plane = synthesizer(square(), N, |_, _| DVec3::NEG_Y);
    let sites = plane.hierarchy().sites().positions().iter();
    let values: Vec<f32> = sites.map(|at| at.x as f32).collect();
    let map = bake_values(&plane, &pixel_per_site(values.len()), &row(&values), atlas).unwrap();
    let mut level = map.clone();
    for number in 0..n_levels {
        let texel = f64::from(1 << number) / texels;
        for [a, b, c] in atlas.uvs() {
            for step in 0..45_u32 {
                let [to_b, to_c] = [step % 9, step / 9].map(|step| f64::from(step) / 8.0);
                let uv = a + (b - a) * to_b * (1.0 - to_c) + (c - a) * to_c;
                let (shown, baked) = (bilinear(&level, uv), bilinear(&map, uv));
                // Tolerance: two texels of the level are mixed, and between sites values may rise faster than by 1 per
                // side.
                let off = (shown - baked).abs();
                assert!(
                    off < 3.0 * texel,
                    "level {number} at {uv}: {shown} for {baked}"
                );
            }
        }
        if number + 1 < n_levels {
            level = halved(&level);
        }
    }
}

#[test]
fn mesh_looks_the_same_at_every_level_that_its_sampler_allows() {
    let surface = Surface::new(square()).unwrap();
    let place = |at: DVec3| DVec2::new(0.2 + 0.6 * at.x, 0.8 - 0.6 * at.y);
    let mesh = surface.mesh();
    let faces = mesh.faces().iter();
    let uvs: Vec<[DVec2; 3]> = faces
        .map(|face| face.map(|vertex| place(mesh.positions()[vertex.index()])))
        .collect();
    let own = Atlas::from_uvs(&surface, &uvs, [256; 2], 256).unwrap();
    for (atlas, texels) in [
        // Four tiles of 128 texels per row. A padding of 8 leaves 95 texels for a quarter of the square.
        (Atlas::uniform(&surface, 512).unwrap(), 4.0 * 95.0),
        (Atlas::by_area(&surface, 512).unwrap(), 4.0 * 95.0),
        (own, 0.6 * 256.0),
    ] {
        let model = textured_model(&surface, &atlas, smooth(&surface), png()).unwrap();
        let n_levels = match model.material.mipmaps {
            true => atlas.size()[0].ilog2() + 1,
            false => 1,
        };
        assert_shown(&atlas, n_levels, texels);
    }
}

#[test]
fn padding_by_default_follows_from_the_size_and_the_number_of_faces() {
    let surface = Surface::new(square()).unwrap();
    // The default padding doubles with the side, which allows one more level.
    for (side, n_levels) in [(64, 1), (128, 2), (256, 3), (512, 4), (1024, 5)] {
        let padding = f64::from(1 << (n_levels - 1));
        let texels = 4.0 * (f64::from(side) / 4.0 - 4.0 * padding - 1.0);
        assert_shown(&Atlas::uniform(&surface, side).unwrap(), n_levels, texels);
        assert_shown(&Atlas::by_area(&surface, side).unwrap(), n_levels, texels);
    }
}
