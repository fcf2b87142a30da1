//! Synthesizes a texture on a mesh from a small exemplar, bakes it to a texture map and writes the model as a GLB
//! file that viewers and engines open.
//!
//! The mesh is a torus built here; use `dapple::mesh_io::read_model` to read your own.
//!
//! ```sh
//! cargo run -p dapple --example 12_baked_model
//! ```

mod out;

use dapple::color::LinearRgb;
use dapple::image::{Depth, Transfer, encode_png, write_color_png};
use dapple::mesh::{self, CREASE, EncodedImage, MeshError, glam::DVec3, rotation};
use dapple::mesh_io::write_model;
use dapple::preview::{
    Camera, Light, Material, Mesh, Object, Scene, Shape, Supersampling, Surface,
};
use dapple::raster::{Raster, Window, Wrap};
use dapple::synth::{
    Atlas, Direction, Edges, Exemplar, HierarchyOptions, Options, bake_colors, synthesize,
    textured_model,
};
use std::f64::consts::TAU;

/// Returns a torus around the y axis with radii of 0.7 and 0.28, with 48 by 24 quadrilaterals.
fn ring() -> Result<mesh::Mesh, MeshError> {
    let [columns, rows] = [48, 24];
    let turn = |part: u32, of: u32| TAU * f64::from(part) / f64::from(of);
    let at = |column: u32, row: u32| (row % rows) * columns + column % columns;
    let (mut positions, mut faces) = (Vec::new(), Vec::new());
    for row in 0..rows {
        for column in 0..columns {
            let out = rotation(DVec3::Z, turn(row, rows)) * DVec3::X;
            positions
                .push(rotation(DVec3::Y, turn(column, columns)) * (0.7 * DVec3::X + 0.28 * out));
            let [a, b] = [at(column, row), at(column + 1, row)];
            let [c, d] = [at(column + 1, row + 1), at(column, row + 1)];
            faces.extend([[a, b, c], [a, c, d]]);
        }
    }
    mesh::Mesh::new(positions, &faces)
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    // Slightly bent stripes, which run down the exemplar and around the tube of the torus.
    let stripes = Raster::from_window(&Window::unit([48, 48])?, |at| {
        let across = 5.0 * at.x + 0.6 * (at.y - at.y * at.y);
        LinearRgb::gray(if across - across.floor() < 0.5 {
            0.02
        } else {
            0.8
        })
    })?;
    let exemplar = Exemplar::new(&stripes, Edges::Cut)?;
    let down = [DVec3::X, DVec3::Z, DVec3::NEG_X, DVec3::NEG_Z].map(|out| Direction {
        at: 0.98 * out,
        vector: DVec3::NEG_Y,
    });
    let sites = HierarchyOptions {
        n_sites: 12_000,
        ..HierarchyOptions::default()
    };
    let (ring, texture) = synthesize(ring()?, &exemplar, &down, &sites, &Options::default())?;

    // Texture map: a few pieces of the mesh, flattened and packed into a square, with gaps for mip levels.
    let atlas = Atlas::charts(ring.surface(), 1024)?;
    let map = bake_colors(&ring, &texture, &stripes, &atlas)?;
    let png = encode_png(
        map.map(|color| color.to_srgb::<u8>()).view(),
        Transfer::Srgb,
    )?;
    let shading = ring.surface().mesh().corner_normals(CREASE);
    let model = textured_model(ring.surface(), &atlas, shading, EncodedImage::new(png)?)?;
    let path = out::path("12_baked_model.glb")?;
    write_model(&path, &model)?;
    out::wrote(&path);

    // Render an image: a ray hits a triangle, whose corners have texture coordinates.
    let uvs = atlas.uvs();
    let look = |surface: &Surface| {
        let color = surface.triangle().map_or(LinearRgb::BLACK, |hit| {
            let corners = uvs[hit.index as usize].into_iter().zip(hit.weights);
            map.sample_bilinear(
                corners.map(|(uv, weight)| uv * weight).sum(),
                [Wrap::Clamp; 2],
            )
        });
        Material::matte(color)
    };
    let shape = Shape::mesh(Mesh::from_mesh(ring.surface().mesh().clone()));
    let scene = Scene::new(Camera::look_at(DVec3::new(3.6, 2.6, 2.4), DVec3::ZERO).with_fov(0.5))
        .with_object(Object::new(shape, look))
        .with_light(Light::directional(
            DVec3::new(1.0, 1.0, 1.0),
            LinearRgb::gray(0.8),
        ))
        .with_ambient(LinearRgb::gray(0.25));
    let path = out::path("12_baked_model.png")?;
    write_color_png(
        &path,
        &scene.render([480, 480], Supersampling(2))?,
        Depth::Eight,
    )?;
    out::wrote(&path);
    Ok(())
}
