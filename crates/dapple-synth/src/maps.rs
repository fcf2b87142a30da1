//! Maps of colors and of plain values, baked from columns of the finest sites.
//!
//! [`SurfaceTexture::transfer`](crate::SurfaceTexture::transfer) makes the columns: any map of the exemplar's size follows
//! what was matched. All maps that are baked with one [`Atlas`] fit together texel by texel.
//!
//! Reference: our own; [`bake()`] has that of baking.
//!
//! Texels without a face, which only coarse levels of a mipmap can show, have the mean of all sites.
//!
//! Reference: Greg Turk, "Texture Synthesis on Surfaces", SIGGRAPH 2001, doi 10.1145/383259.383297, section 6; the tangent
//! frame is that of glTF 2.0.

use crate::{Atlas, SynthError, SynthErrorKind, Synthesizer, bake};
use dapple_color::{Code, LinearRgb};
use dapple_raster::Raster;

/// Bakes a color for each finest site.
///
/// Colors are mixed between sites in their sRGB codes, as [`Exemplar::new`](crate::Exemplar::new) compares them, with 16
/// bits; what is outside of 0 to 1 is clamped.
///
/// # Errors
///
/// [`SynthErrorKind::Count`] unless there is a color for each site, [`SynthErrorKind::Range`] if one is not finite.
pub fn bake_colors(
    synthesizer: &Synthesizer,
    colors: &[LinearRgb],
    atlas: &Atlas,
) -> Result<Raster<LinearRgb>, SynthError> {
    check_column(synthesizer, "colors", colors.len())?;
    for part in colors.iter().flat_map(|color| color.to_array()) {
        check_finite("part of a color", part)?;
    }
    let code = |code: u16| f32::from(code) / f32::from(u16::MAX);
    let codes = |color: &LinearRgb| color.to_srgb::<u16>().map(code);
    let column: Vec<f32> = colors.iter().flat_map(codes).collect();
    let background = mean::<3>(&column);
    let (surface, hierarchy) = (synthesizer.surface(), synthesizer.hierarchy());
    let map = bake(surface, hierarchy, &column, atlas, background)?;
    Ok(map.par_map(|codes| LinearRgb::from_srgb(codes.map(u16::from_unit))))
}

/// Bakes a value for each finest site, such as a height or a roughness: values are mixed as they are.
///
/// # Errors
///
/// [`SynthErrorKind::Count`] unless there is a value for each site, [`SynthErrorKind::Range`] if one is not finite.
///
/// # Examples
///
/// Colors are matched together with heights, which count half as much; roughness is not matched at all. All three are
/// copied.
///
/// ```
/// use dapple_raster::Raster;
/// use dapple_synth::mesh::{Mesh, glam::DVec3};
/// use dapple_synth::{Atlas, Edges, Exemplar, HierarchyOptions, Options, bake_values, synthesize};
///
/// let bright = Raster::from_fn([16, 16], |x, y| f32::from((x / 4 + y / 4) % 2 == 0))?;
/// let height = bright.map(|&bright| 0.25 * bright);
/// let roughness = bright.map(|&bright| 1.0 - 0.5 * bright);
///
/// let exemplar = Exemplar::from_planes(&[(&bright, 1.0), (&height, 0.5)], Edges::Wrap)?;
/// let sites = HierarchyOptions { n_sites: 1000, n_levels: 2, ..Default::default() };
/// let options = Options { n_levels: 2, ..Default::default() };
/// // A tetrahedron; `dapple_mesh_io::read_model` reads yours.
/// let corners = vec![DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z];
/// let mesh = Mesh::new(corners, &[[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]])?;
/// let (tetrahedron, texture) = synthesize(mesh, &exemplar, &[], &sites, &options)?;
///
/// let atlas = Atlas::uniform(tetrahedron.surface(), 128)?;
/// let maps: Result<Vec<Raster<f32>>, _> = [&bright, &height, &roughness]
///     .into_iter()
///     .map(|map| bake_values(&tetrahedron, &texture.transfer(map)?, &atlas))
///     .collect();
/// let maps = maps?;
/// // The three still belong together.
/// let (bright, roughness) = (maps[0].row(20)[30], maps[2].row(20)[30]);
/// assert!((1.0 - 0.5 * bright - roughness).abs() < 1e-5);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn bake_values(
    synthesizer: &Synthesizer,
    values: &[f32],
    atlas: &Atlas,
) -> Result<Raster<f32>, SynthError> {
    check_column(synthesizer, "values", values.len())?;
    for &value in values {
        check_finite("value at a site", value)?;
    }
    let background = mean::<1>(values);
    let (surface, hierarchy) = (synthesizer.surface(), synthesizer.hierarchy());
    let map = bake(surface, hierarchy, values, atlas, background)?;
    Ok(map.par_map(|&[value]| value))
}

/// Refuses a column that has not just one value for each finest site.
pub(crate) fn check_column(
    synthesizer: &Synthesizer,
    what: &'static str,
    count: usize,
) -> Result<(), SynthError> {
    if count == synthesizer.hierarchy().sites().len() {
        return Ok(());
    }
    Err(SynthError::new(SynthErrorKind::Count {
        what,
        count,
        needed: "one for each finest site",
    }))
}

/// Refuses NaN and infinity.
pub(crate) fn check_finite(what: &'static str, value: f32) -> Result<(), SynthError> {
    SynthError::check(value.is_finite(), what, value.into(), "finite")
}

/// The mean of all sites.
fn mean<const N: usize>(column: &[f32]) -> [f32; N] {
    let mut sums = [0.0_f64; N];
    for values in column.chunks_exact(N) {
        for (sum, &value) in sums.iter_mut().zip(values) {
            *sum += f64::from(value);
        }
    }
    let n_sites = (column.len() / N).max(1) as f64;
    sums.map(|sum| (sum / n_sites) as f32)
}

#[cfg(test)]
mod tests;
