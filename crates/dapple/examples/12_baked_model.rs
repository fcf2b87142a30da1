//! A texture grown over a mesh from a small example, baked to a texture map and written as a model: a GLB file that
//! viewers and engines open.
//!
//! The mesh is one of the library's own; `dapple::mesh_io::read_model` reads yours.
//!
//! ```sh
//! cargo run -p dapple --example 12_baked_model
//! ```

mod out;

use dapple::color::LinearRgb;
use dapple::image::{Depth, Transfer, encode_png, write_color_png};
use dapple::mesh::{CREASE, EncodedImage, HierarchyOptions, glam::DVec3, models};
use dapple::mesh_io::write_model;
use dapple::preview::{
    Camera, Light, Material, Mesh, Object, Scene, Shape, Supersampling, Surface,
};
use dapple::raster::{Raster, Window, Wrap};
use dapple::synth::{
    Atlas, Direction, Edges, Exemplar, Options, bake_colors, synthesize, textured_model,
};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    // Stripes, slightly bent, that run down the example, and on the animal from the back to the belly.
    let stripes = Raster::from_window(&Window::unit([48, 48])?, |at| {
        let across = 5.0 * at.x + 0.6 * (at.y - at.y * at.y);
        LinearRgb::gray(if across - across.floor() < 0.5 {
            0.02
        } else {
            0.8
        })
    })?;
    let exemplar = Exemplar::new(&stripes, Edges::Cut)?;
    let back = Direction {
        at: models::zebra::BACK,
        vector: DVec3::X,
    };
    let sites = HierarchyOptions {
        n_sites: 6_000,
        ..HierarchyOptions::default()
    };
    let zebra = models::zebra(4_000)?;
    let (zebra, texture) = synthesize(zebra, &exemplar, &[back], &sites, &Options::default())?;

    // The texture map: the triangles of the mesh, packed into a square with room for mip levels.
    let atlas = Atlas::by_area(zebra.surface(), 1024)?;
    let map = bake_colors(&zebra, &texture.transfer(&stripes)?, &atlas)?;
    let png = encode_png(
        map.map(|color| color.to_srgb::<u8>()).view(),
        Transfer::Srgb,
    )?;
    let shading = zebra.surface().mesh().corner_normals(CREASE);
    let model = textured_model(zebra.surface(), &atlas, shading, EncodedImage::new(png)?)?;
    let path = out::path("12_baked_model.glb")?;
    write_model(&path, &model)?;
    out::wrote(&path);

    // A picture of it: a ray meets a triangle, whose corners have texture coordinates.
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
    let shape = Shape::mesh(Mesh::from_mesh(zebra.surface().mesh().clone()));
    let scene = Scene::new(Camera::look_at(DVec3::new(4.0, 1.0, 2.6), DVec3::ZERO).with_fov(0.5))
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
