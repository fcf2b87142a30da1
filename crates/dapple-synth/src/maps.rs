//! Bakes color maps and scalar maps from the sources of the finest sites.
//!
//! All maps of the exemplar use the sources that were found for the matched image. An enlarged version of a map can be
//! baked too, and shows more detail. Maps that are baked with the same [`Atlas`] are aligned texel by texel.
//!
//! Texels without a face get the mean of the map. Only coarse mipmap levels can show them.
//!
//! Reference: Greg Turk, "Texture Synthesis on Surfaces", SIGGRAPH 2001, doi 10.1145/383259.383297, section 6.

use crate::detail::Detail;
use crate::lift::LiftedDetail;
use crate::magnify::magnify;
use crate::{Atlas, SurfaceTexture, SynthError, SynthErrorKind, Synthesizer, bake};
use dapple_color::{Code, LinearRgb, LinearRgba};
use dapple_raster::Raster;

/// Bakes a color map: the exemplar's image, another map of the exemplar, or a version of one enlarged by an integer
/// factor.
///
/// Colors are interpolated as 16-bit sRGB codes, as [`Exemplar::new`](crate::Exemplar::new) compares them. Values
/// outside 0 to 1 are clamped.
///
/// # Errors
///
/// [`SynthErrorKind::Count`] if the texture was synthesized for other sites, [`SynthErrorKind::Detail`] if the map's
/// size is not a multiple of the exemplar's, [`SynthErrorKind::Raster`] if the map is larger than the exemplar but the
/// [sources](crate::Options::sources) are pixels, and [`SynthErrorKind::Range`] if a color is not finite.
pub fn bake_colors(
    synthesizer: &Synthesizer,
    texture: &SurfaceTexture,
    map: &Raster<LinearRgb>,
    atlas: &Atlas,
) -> Result<Raster<LinearRgb>, SynthError> {
    for part in map.pixels().iter().flat_map(|color| color.to_array()) {
        check_finite("part of a color", part)?;
    }
    let code = |code: u16| f32::from(code) / f32::from(u16::MAX);
    let codes = map.par_map(|color| color.to_srgb::<u16>().map(code));
    let map = bake_map(synthesizer, texture, codes, atlas)?;
    Ok(map.par_map(|codes| LinearRgb::from_srgb(codes.map(u16::from_unit))))
}

/// Bakes colors with alpha, like [`bake_colors`].
///
/// Colors are weighted by alpha, so that the colors of transparent pixels do not bleed into edges. Where all pixels are
/// transparent, colors are interpolated without weights. Alpha is clamped to 0 to 1.
///
/// # Errors
///
/// Same as [`bake_colors`].
pub fn bake_colors_alpha(
    synthesizer: &Synthesizer,
    texture: &SurfaceTexture,
    map: &Raster<LinearRgba>,
    atlas: &Atlas,
) -> Result<Raster<LinearRgba>, SynthError> {
    for pixel in map.pixels() {
        for part in pixel.color.to_array() {
            check_finite("part of a color", part)?;
        }
        check_finite("alpha", pixel.alpha)?;
    }
    // Interpolate premultiplied colors, and plain ones for fully transparent texels.
    let codes = map.par_map(|pixel| {
        let code = |code: u16| f32::from(code) / f32::from(u16::MAX);
        let [r, g, b] = pixel.color.to_srgb::<u16>().map(code);
        let alpha = pixel.alpha.clamp(0.0, 1.0);
        [r * alpha, g * alpha, b * alpha, alpha, r, g, b]
    });
    let map = bake_map(synthesizer, texture, codes, atlas)?;
    Ok(map.par_map(|&[r, g, b, alpha, plain @ ..]| {
        let codes = if alpha > 0.0 {
            [r / alpha, g / alpha, b / alpha]
        } else {
            plain
        };
        LinearRgba {
            color: LinearRgb::from_srgb(codes.map(u16::from_unit)),
            alpha: alpha.clamp(0.0, 1.0),
        }
    }))
}

/// Bakes scalar values, such as height or roughness. They are interpolated without conversion.
///
/// # Errors
///
/// Same as [`bake_colors`].
///
/// # Examples
///
/// Colors and heights are matched together; heights have half the weight. Roughness is not matched. All three maps are
/// baked from the same sources.
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
///     .map(|map| bake_values(&tetrahedron, &texture, map, &atlas))
///     .collect();
/// let maps = maps?;
/// // The three maps are still aligned.
/// let (bright, roughness) = (maps[0].row(20)[30], maps[2].row(20)[30]);
/// assert!((1.0 - 0.5 * bright - roughness).abs() < 1e-5);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn bake_values(
    synthesizer: &Synthesizer,
    texture: &SurfaceTexture,
    map: &Raster<f32>,
    atlas: &Atlas,
) -> Result<Raster<f32>, SynthError> {
    for &value in map.pixels() {
        check_finite("value of a map", value)?;
    }
    let map = map.map(|&value| [value]);
    let map = bake_map(synthesizer, texture, map, atlas)?;
    Ok(map.par_map(|&[value]| value))
}

/// Bakes a map according to the kind of sources that the texture has: on another surface, between pixels, or at pixels.
fn bake_map<const N: usize>(
    synthesizer: &Synthesizer,
    texture: &SurfaceTexture,
    map: Raster<[f32; N]>,
    atlas: &Atlas,
) -> Result<Raster<[f32; N]>, SynthError> {
    check_column(synthesizer, "sites of the texture", texture.n_sites())?;
    let background = mean(map.pixels());
    // Sources on the surface of another model.
    if let Some(places) = texture.lifted_between() {
        let detail = LiftedDetail::new(map, &places.origin)?;
        return magnify(
            synthesizer,
            places,
            &texture.quarters,
            atlas,
            background,
            |spot| {
                let point = places.origin.walk(spot.place).point;
                detail.sample(point, spot.footprint)
            },
        );
    }
    // Sources at pixels: interpolate the values of the sites.
    let Some(places) = &texture.places else {
        let column = texture.transfer(&map)?;
        let (surface, hierarchy) = (synthesizer.surface(), synthesizer.hierarchy());
        return bake(surface, hierarchy, column.as_flattened(), atlas, background);
    };
    // Sources between pixels: sample the map.
    let detail = Detail::new(map, places.size, places.edges)?;
    magnify(
        synthesizer,
        places,
        &texture.quarters,
        atlas,
        background,
        |spot| detail.sample(spot.place, spot.footprint),
    )
}

/// Fails unless a column has one value per finest site.
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

/// Fails for NaN and infinity.
pub(crate) fn check_finite(what: &'static str, value: f32) -> Result<(), SynthError> {
    SynthError::check(value.is_finite(), what, value.into(), "finite")
}

/// Returns the mean of all pixels.
fn mean<const N: usize>(pixels: &[[f32; N]]) -> [f32; N] {
    let mut sums = [0.0_f64; N];
    for pixel in pixels {
        for (sum, &value) in sums.iter_mut().zip(pixel) {
            *sum += f64::from(value);
        }
    }
    sums.map(|sum| (sum / pixels.len().max(1) as f64) as f32)
}

#[cfg(test)]
mod tests;
