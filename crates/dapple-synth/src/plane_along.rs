//! Synthesis in the plane along a direction field, with features of varying size.
//!
//! The plane is a rectangle. Sites are scattered over it as over any surface, the caller supplies the direction field,
//! and the texture is baked to an image of the plane's pixels. Neighborhoods rotate and scale with the field, and
//! sources are positions between the pixels of the exemplar. (Reference: Greg Turk, "Texture Synthesis on Surfaces",
//! SIGGRAPH 2001, <https://doi.org/10.1145/383259.383297>.)
//!
//! The rectangle is in the x-y plane, and pixels have unit side length. The top left corner of the image is at the
//! origin, and its rows extend down toward -y.

use crate::engine::Progress;
use crate::plane::check_pixels;
use crate::{
    Atlas, Exemplar, Hierarchy, HierarchyOptions, Options, Orientation, SurfaceTexture, SynthError,
    Synthesizer,
};
use core::ops::ControlFlow;
use dapple_mesh::{Mesh, Surface};
use dapple_raster::{Raster, Wrap};
use glam::{DVec2, DVec3};

/// A texture in the plane along a direction field. Use [`bake_colors`](crate::bake_colors) and similar functions to
/// render images of it.
#[derive(Clone, Debug)]
pub struct PlaneAlong {
    /// Synthesizer with the sites on the rectangle.
    pub synthesizer: Synthesizer,
    /// Synthesized texture: the sources of the sites.
    pub texture: SurfaceTexture,
    /// Atlas that maps the rectangle to its image.
    pub atlas: Atlas,
}

/// Size of an exemplar pixel, in texture pixels, from 1/8 to 8. Sizes below 1 lose detail.
#[derive(Clone, Copy, Debug)]
pub enum PlaneScales<'a> {
    /// Size at every pixel: a plane of the same size as the texture.
    Plane(&'a Raster<f32>),
    /// Sizes computed from the directions, clamped to the given minimum and maximum: see
    /// [`Synthesizer::with_conformal_scales`].
    Conformal([f32; 2]),
}

/// Synthesizes a texture that looks like an exemplar and follows `directions`. This plane is the same size as the
/// texture. The exemplar's pixels are scaled by `scales`.
///
/// Directions are angles in radians. At 0 the exemplar's down axis points down in the texture; at π / 2, a quarter
/// turn, it points right.
///
/// # Errors
///
/// Same as [`Synthesizer::synthesize_with`], or [`SynthErrorKind::Raster`](crate::SynthErrorKind::Raster) if the planes
/// have different sizes, or [`SynthErrorKind::Range`](crate::SynthErrorKind::Range) if there are too many pixels, an
/// angle is not finite, or a scale is out of range.
///
/// # Examples
///
/// ```
/// use core::ops::ControlFlow;
/// use dapple_raster::Raster;
/// use dapple_synth::{Edges, Exemplar, Options, PlaneScales, bake_values, synthesize_plane_along};
///
/// // Stripes that lie along the rows in the example, and stand twice as wide in the texture.
/// let stripes = Raster::from_fn([16, 16], |_, y| f32::from(y / 4 % 2 == 0))?;
/// let exemplar = Exemplar::from_planes(&[(&stripes, 1.0)], Edges::Wrap)?;
/// let right = Raster::filled([40, 30], core::f32::consts::FRAC_PI_2)?;
/// let twice = Raster::filled([40, 30], 2.0)?;
/// let options = Options { n_levels: 2, ..Options::default() };
/// let go_on = |_| ControlFlow::Continue(());
/// let twice = PlaneScales::Plane(&twice);
/// let along = synthesize_plane_along(&exemplar, &right, twice, &options, go_on)?;
/// let image = bake_values(&along.synthesizer, &along.texture, &stripes, &along.atlas)?;
/// assert_eq!(image.size(), [40, 30]);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn synthesize_plane_along(
    exemplar: &Exemplar,
    directions: &Raster<f32>,
    scales: PlaneScales<'_>,
    options: &Options,
    callback: impl FnMut(Progress) -> ControlFlow<()>,
) -> Result<PlaneAlong, SynthError> {
    let size = directions.size();
    if let PlaneScales::Plane(scales) = scales {
        scales.check_same_size(size)?;
    }
    check_pixels(size)?;
    for &angle in directions.pixels() {
        SynthError::check(
            angle.is_finite(),
            "angle of a direction",
            angle.into(),
            "finite",
        )?;
    }
    // Scatter sites over the rectangle and orient them.
    let surface = rectangle(size)?;
    let hierarchy = Hierarchy::new(&surface, &sites(size, options))?;
    let orientation = Orientation::from_fn(&hierarchy, |at, _| {
        let (sin, cos) = libm::sincos(f64::from(*pixel(directions, at)));
        // An angle of 0 is down in the image, toward -y; positive angles turn to the right.
        DVec3::new(sin, -cos, 0.0)
    });
    let synthesizer = Synthesizer::from_parts(surface, hierarchy, orientation, None)?;
    // Scale the neighborhoods.
    let synthesizer = match scales {
        PlaneScales::Plane(scales) => {
            let positions = synthesizer.hierarchy().sites().positions().iter();
            let scales = positions.map(|&at| *pixel(scales, at)).collect();
            synthesizer.with_scales(scales)?
        }
        PlaneScales::Conformal(bounds) => synthesizer.with_conformal_scales(bounds)?,
    };
    // Synthesize, and map the image's pixels to the rectangle.
    let texture = synthesizer.synthesize_with(exemplar, options, callback)?;
    let atlas = Atlas::from_uvs(synthesizer.surface(), &uvs(size, &synthesizer), size, 0)?;
    Ok(PlaneAlong {
        synthesizer,
        texture,
        atlas,
    })
}

/// Returns options for sites on a plane, with a spacing of one pixel.
fn sites(size: [u32; 2], options: &Options) -> HierarchyOptions {
    // In a hexagonal lattice with unit spacing, each site has the area sqrt(3/4).
    let n_sites = f64::from(size[0]) * f64::from(size[1]) * (4.0_f64 / 3.0).sqrt();
    HierarchyOptions {
        n_sites: n_sites.round() as usize,
        n_levels: options.n_levels,
        seed: options.seed.child("sites", 0),
        ..HierarchyOptions::default()
    }
}

/// Returns the surface of an image of `size` pixels: a rectangle of two triangles.
fn rectangle(size: [u32; 2]) -> Result<Surface, SynthError> {
    let [x, y] = size.map(f64::from);
    let corners = [[0.0, 0.0], [0.0, -y], [x, -y], [x, 0.0]];
    let corners = corners.map(|[x, y]| DVec3::new(x, y, 0.0));
    let mesh = Mesh::new(corners.to_vec(), &[[0, 1, 2], [0, 2, 3]])?;
    Ok(Surface::new(mesh)?)
}

/// Returns the texture coordinates of the rectangle's faces in its image, from 0 to 1.
fn uvs(size: [u32; 2], synthesizer: &Synthesizer) -> Vec<[DVec2; 3]> {
    let [width, height] = size.map(f64::from);
    let mesh = synthesizer.surface().mesh();
    let uv = |at: DVec3| DVec2::new(at.x / width, -at.y / height);
    let faces = mesh.faces().iter();
    let corners = faces.map(|face| face.map(|vertex| uv(mesh.positions()[vertex.index()])));
    corners.collect()
}

/// Returns the value of a plane at a position; past the edges, the value of the nearest pixel.
fn pixel(plane: &Raster<f32>, at: DVec3) -> &f32 {
    let [column, row] = [at.x, -at.y].map(|at| at.floor() as i64);
    plane.at(column, row, [Wrap::Clamp; 2])
}

#[cfg(test)]
mod tests;
