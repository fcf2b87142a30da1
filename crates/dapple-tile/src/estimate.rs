//! Estimates the height, the roughness and the albedo of a surface from a single photograph.
//!
//! A photograph does not determine the shape of a surface: paint and shadow look the same. The estimate is a linear filter
//! of the log luminance, without a learned model.
//!
//! Sources:
//!
//! * Michael S. Langer and Steven W. Zucker, "Shape-from-shading on a cloudy day", Journal of the Optical Society of
//!   America A 11(2), 1994: under diffuse light, dark is deep.
//! * Mashhuda Glencross, Gregory J. Ward, Francho Melendez, Caroline Jay, Jun Liu and Roger Hubbold, "A perceptually
//!   validated model for surface depth hallucination", ACM Transactions on Graphics 27(3), 2008,
//!   <https://doi.org/10.1145/1360612.1360658>: depth from the bands of the log luminance, where an equally dark pit is
//!   the deeper the wider it is. Their albedo from a second photograph with flash has no counterpart here.
//! * Alex P. Pentland, "Linear shape from shading", International Journal of Computer Vision 4, 1990: on gentle slopes,
//!   directed light shows the derivative of the height along its direction.
//! * Peter J. Burt and Edward H. Adelson, "The Laplacian pyramid as a compact image code", IEEE Transactions on
//!   Communications 31(4), 1983.
//!
//! Implementation:
//!
//! 1. [`even_out`] removes changes of light over more than the radius. The logarithm of the luminance is divided into
//!    octave bands by a pyramid of area means, which are enlarged by linear interpolation; repeated doubling gives
//!    smooth quadratic splines.
//! 2. The height is the sum of all bands, weighted by 2^(coarseness · octave). Directed light replaces each band by a
//!    third of it plus its derivative toward the light, in pixels of the octave: the matched filter of Pentland's
//!    model in the middle of the band, which needs no Fourier transform.
//! 3. The sum is mapped to 0 to 1 by `1/2 + t/(2 √(1 + t²))`, where `t` is the deviation from the mean in units of two
//!    standard deviations. So single bright or dark pixels do not compress the rest.
//! 4. The relief gives the heights the requested slope, measured between means of 2 × 2 pixels.
//! 5. The albedo is the even photograph divided by a share of its estimated shading: the ambient occlusion of the
//!    heights, times Lambert's cosine if light is directed. A regression in the logarithm says how much of this shading
//!    the photograph shows.
//! 6. The roughness grows with the local contrast of the two finest octaves relative to its mean, and with their depth.
//!    It has the same soft limits as the height.

use crate::map::{color_from_planes, color_planes};
use crate::photo::{even_out, resize_plane};
use crate::{Map, TileError};
use dapple_color::{HeightPlane, LinearRgb, OcclusionOptions, ambient_occlusion};
use dapple_raster::glam::DVec2;
use dapple_raster::{Range, Raster, Wrap, range};

const COARSENESS: Range = range!(from 0 to 2);
const LIGHT: Range = range!(from -360 to 360);
const SLOPE: Range = range!(from 0 to 10);
const SHARE: Range = range!(from 0 to 1);

/// Luminance that is added before the logarithm, as a fraction of the mean: the floor of shadows.
const SHADOW: f64 = 0.02;

/// Weight of a band itself where light is directed; its derivative has the weight 1.
const DIFFUSE: f32 = 0.35;

/// Minimum of the shading that the albedo is divided by.
const LEAST_SHADING: f32 = 1.0 / 8.0;

/// Radius of the occlusion, as a fraction of the shorter side.
const OCCLUSION: f64 = 1.0 / 20.0;

/// Octave at which slopes are measured.
const SLOPE_OCTAVE: usize = 1;

/// Weight of fine depth in the roughness, relative to local contrast.
const CAVITY: f64 = 0.3;

/// Local contrast, squared and relative to its mean, that is added before the logarithm.
const LEAST_CONTRAST: f64 = 0.01;

/// Octave over which local contrast is averaged.
const CONTRAST_OCTAVE: usize = 4;

/// Options of [`estimate_material`].
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(default, deny_unknown_fields)
)]
pub struct EstimateOptions {
    /// Radius in pixels beyond which changes of light are removed, as in [`even_out`], from 1 to 65536. It also limits
    /// the size of estimated forms. [default: a sixth of the shorter side]
    pub radius: Option<f64>,
    /// Depth of wide forms, from 0 to 2: each octave is 2^coarseness times as deep as the next finer one at the same
    /// contrast. At 1 all octaves have equal slopes. [default: 0.8]
    pub coarseness: f64,
    /// Direction of the light in the image, in degrees from -360 to 360: 0 from the right, 90 from the top. `None` is
    /// diffuse light, where dark is deep. [default: `None`]
    pub light: Option<f64>,
    /// Whether bright is deep, as in light joints between dark stones. [default: false]
    pub invert: bool,
    /// Root mean square slope of the surface, from 0 to 10. [default: 0.5]
    pub slope: f64,
    /// Share of the estimated shading that is removed from the albedo, from 0 to 1. [default: 0.5]
    pub delight: f64,
    /// Mean roughness, from 0 to 1. [default: 0.75]
    pub roughness: f64,
    /// Maximum deviation from the mean roughness, from 0 to 1. [default: 0.25]
    pub variation: f64,
}

impl Default for EstimateOptions {
    fn default() -> Self {
        Self {
            radius: None,
            coarseness: 0.8,
            light: None,
            invert: false,
            slope: 0.5,
            delight: 0.5,
            roughness: 0.75,
            variation: 0.25,
        }
    }
}

/// Maps of a material that were estimated from a photograph, in its size. They do not repeat.
#[derive(Clone, Debug, PartialEq)]
pub struct Estimate {
    /// Base color in linear light, with a part of the shading removed.
    pub albedo: Raster<LinearRgb>,
    /// Height, from 0 to 1.
    pub height: Raster<f32>,
    /// Roughness, from 0 to 1.
    pub roughness: Raster<f32>,
    /// Relief: the height of the value 1, in pixels.
    pub relief: f64,
}

/// Estimates the material of a flat surface from a photograph. The heights give normals and occlusion.
///
/// Stains of the surface become forms, and shadows that objects cast become pits. Height and slope have no scale in a
/// photograph: the mean slope is an option. The [method](EstimateOptions) is a multi-scale shape from shading; no model
/// is learned.
///
/// # Errors
///
/// * [`Range`](crate::TileErrorKind::Range) if an option is out of its range
/// * [`NotFinite`](crate::TileErrorKind::NotFinite) if a pixel is NaN or infinite
///
/// # Examples
///
/// ```
/// use dapple_tile::color::LinearRgb;
/// use dapple_tile::raster::Raster;
/// use dapple_tile::{EstimateOptions, estimate_material};
///
/// // Dark joints between bright stones.
/// let photo = Raster::from_fn([64, 64], |x, y| {
///     LinearRgb::gray(if x % 16 < 3 || y % 16 < 3 { 0.1 } else { 0.5 })
/// })?;
/// let estimate = estimate_material(&photo, &EstimateOptions::default())?;
/// assert!(estimate.height.row(24)[24] > estimate.height.row(24)[17]);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn estimate_material(
    photo: &Raster<LinearRgb>,
    options: &EstimateOptions,
) -> Result<Estimate, TileError> {
    options.check()?;
    crate::map::check_planes(&color_planes(photo))?;
    let size = photo.size();
    let shorter = f64::from(size[0].min(size[1]));
    let radius = options.radius.unwrap_or((shorter / 6.0).max(1.0));
    // Remove slow changes of light, and divide the log luminance into octaves.
    let even = color_from_planes(even_out(&Map::Color(photo.clone()), radius)?.planes())?;
    let octaves = octaves(log_luminance(&even, options.invert), radius)?;
    let toward = options.light.map(|degrees| {
        let (sin, cos) = libm::sincos(degrees.to_radians());
        DVec2::new(cos, -sin)
    });
    let height = unit_height(&height(&octaves, options.coarseness, toward)?);
    let relief = relief(&height, options.slope)?;
    let albedo = match options.delight > 0.0 {
        true => delit(&even, &shading(&height, relief, toward)?, options.delight)?,
        false => even,
    };
    let roughness = rough(&octaves)?.par_map(|&rough| {
        let value = options.roughness + options.variation * soft(rough.into());
        value.clamp(0.0, 1.0) as f32
    });
    Ok(Estimate {
        albedo,
        height,
        roughness,
        relief,
    })
}

impl EstimateOptions {
    fn check(&self) -> Result<(), TileError> {
        let check = TileError::check_in;
        check(COARSENESS, "coarseness", self.coarseness)?;
        check(LIGHT, "direction of the light", self.light.unwrap_or(0.0))?;
        check(SLOPE, "slope", self.slope)?;
        check(SHARE, "share of removed shading", self.delight)?;
        check(SHARE, "roughness", self.roughness)?;
        check(SHARE, "variation of the roughness", self.variation)
    }
}

/// Returns the logarithm of the luminance, negated if bright is deep.
fn log_luminance(colors: &Raster<LinearRgb>, invert: bool) -> Raster<f32> {
    let luminance = colors.map(|color| color.luminance());
    let floor = luminance.statistics().mean * SHADOW;
    let sign = if invert { -1.0 } else { 1.0 };
    luminance.par_map(|&value| {
        let value = f64::from(value).max(0.0) + floor;
        (sign * libm::log(value.max(f64::from(f32::MIN_POSITIVE)))) as f32
    })
}

/// Halves a raster until a pixel is as wide as the radius. The finest octave is first.
fn octaves(finest: Raster<f32>, radius: f64) -> Result<Vec<Raster<f32>>, TileError> {
    let mut octaves = vec![finest];
    let mut width = 1.0;
    while width < radius {
        let last = &octaves[octaves.len() - 1];
        let half = last.size().map(|side| side.div_ceil(2));
        octaves.push(resized(last, half)?);
        width *= 2.0;
    }
    Ok(octaves)
}

fn resized(plane: &Raster<f32>, size: [u32; 2]) -> Result<Raster<f32>, TileError> {
    resize_plane(plane, size, [Wrap::Clamp; 2])
}

/// Enlarges a raster of octave `octave` to the size of the finest octave, by doubling.
fn enlarged(
    mut plane: Raster<f32>,
    octaves: &[Raster<f32>],
    octave: usize,
) -> Result<Raster<f32>, TileError> {
    for finer in octaves[..octave].iter().rev() {
        plane = resized(&plane, finer.size())?;
    }
    Ok(plane)
}

/// Sums the weighted bands of the octaves, from the coarsest to the finest. `toward` is the direction of the light, with
/// y down.
fn height(
    octaves: &[Raster<f32>],
    coarseness: f64,
    toward: Option<DVec2>,
) -> Result<Raster<f32>, TileError> {
    let coarsest = &octaves[octaves.len() - 1];
    let mut height = Raster::filled(coarsest.size(), 0.0)?;
    for (octave, pair) in octaves.windows(2).enumerate().rev() {
        // A band of the Laplacian pyramid is the difference from the enlarged coarser octave.
        let [fine, coarse] = [&pair[0], &resized(&pair[1], pair[0].size())?];
        let band = fine.zip_map(coarse, |fine, coarse| fine - coarse)?;
        let form = match toward {
            None => band,
            Some(toward) => {
                let slope = slope_along(&band, toward)?;
                band.zip_map(&slope, |band, slope| DIFFUSE * band + slope)?
            }
        };
        // Of two equally dark pits, the wider one is deeper (Glencross et al.).
        let weight = libm::exp2(coarseness * octave as f64) as f32;
        let under = resized(&height, fine.size())?;
        height = under.zip_map(&form, |under, form| under + weight * form)?;
    }
    Ok(height)
}

/// Returns the derivative along a direction, per pixel, by central differences. Sides are clamped.
fn slope_along(plane: &Raster<f32>, direction: DVec2) -> Result<Raster<f32>, TileError> {
    let [last_x, last_y] = plane.size().map(|side| side - 1);
    let [across, down] = (direction / 2.0).to_array().map(|part| part as f32);
    let slopes = Raster::from_rows(plane.size(), |row| {
        let line = plane.row(row);
        let above = plane.row(row.saturating_sub(1));
        let below = plane.row((row + 1).min(last_y));
        (0..=last_x).map(move |column| {
            let ends = [column.saturating_sub(1), (column + 1).min(last_x)];
            let [left, right] = ends.map(|column| line[column as usize]);
            let column = column as usize;
            (right - left) * across + (below[column] - above[column]) * down
        })
    });
    Ok(slopes?)
}

/// Maps heights to 0 to 1. A deviation of two standard deviations from the mean reaches 0.71 of the range.
fn unit_height(height: &Raster<f32>) -> Raster<f32> {
    let statistics = height.statistics();
    let unit = 2.0 * statistics.deviation;
    height.par_map(|&height| {
        let part = match unit > 0.0 {
            true => (f64::from(height) - statistics.mean) / unit,
            false => 0.0,
        };
        (0.5 + 0.5 * soft(part)) as f32
    })
}

/// Limits a number smoothly to -1 to 1.
fn soft(number: f64) -> f64 {
    number / (1.0 + number * number).sqrt()
}

/// Returns the relief, in pixels, that gives heights a root mean square slope.
fn relief(height: &Raster<f32>, slope: f64) -> Result<f64, TileError> {
    let mut coarse = height.clone();
    for _ in 0..SLOPE_OCTAVE {
        coarse = resized(&coarse, coarse.size().map(|side| side.div_ceil(2)))?;
    }
    let mean_square = |direction| -> Result<f64, TileError> {
        let statistics = slope_along(&coarse, direction)?.statistics();
        Ok(statistics.mean * statistics.mean + statistics.deviation * statistics.deviation)
    };
    let pixels = f64::from(1_u32 << SLOPE_OCTAVE);
    let present = (mean_square(DVec2::X)? + mean_square(DVec2::Y)?).sqrt() / pixels;
    Ok(if present > 0.0 { slope / present } else { 0.0 })
}

/// Returns the estimated shading of the heights: their ambient occlusion, times the cosine to the light at 45 degrees if
/// it is directed, relative to a flat surface.
fn shading(
    height: &Raster<f32>,
    relief: f64,
    toward: Option<DVec2>,
) -> Result<Raster<f32>, TileError> {
    let size = height.size();
    let plane = HeightPlane {
        strength: relief,
        extent: DVec2::new(size[0].into(), size[1].into()),
        wrap: [Wrap::Clamp; 2],
    };
    let options = OcclusionOptions {
        radius: f64::from(size[0].min(size[1])) * OCCLUSION,
        ..plane.into()
    };
    let seen = ambient_occlusion(height, &options)?;
    let Some(toward) = toward else {
        return Ok(seen);
    };
    let [x, y] = [
        slope_along(height, DVec2::X)?,
        slope_along(height, DVec2::Y)?,
    ];
    let slopes = x.zip_map(&y, |&x, &y| DVec2::new(x.into(), y.into()) * relief)?;
    let lit = slopes.map(|slope| {
        // Lambert's cosine of the normal (-slope, 1) and the light (toward, 1), relative to level ground.
        let cosine = (1.0 - slope.dot(toward)) / (1.0 + slope.length_squared()).sqrt();
        cosine.max(0.0) as f32
    });
    Ok(seen.zip_map(&lit, |seen, lit| seen * lit)?)
}

/// Divides colors by the share of the shading that they show, to the power `share`, and keeps their mean luminance.
fn delit(
    colors: &Raster<LinearRgb>,
    shading: &Raster<f32>,
    share: f64,
) -> Result<Raster<LinearRgb>, TileError> {
    let shading = shading.par_map(|shading| {
        let shading = f64::from(shading.max(LEAST_SHADING));
        libm::log(shading) as f32
    });
    // The regression coefficient of the log luminance: 1 if all of the shading is visible, 0 if none.
    let visible = regression(&log_luminance(colors, false), &shading)?.clamp(0.0, 1.0);
    let divided = colors.zip_map(&shading, |&color, &shading| {
        color * libm::exp(-share * visible * f64::from(shading)) as f32
    })?;
    let mean = |colors: &Raster<LinearRgb>| colors.map(|color| color.luminance()).statistics().mean;
    let [before, after] = [colors, &divided].map(mean);
    // The division brightens the image; restore its mean luminance.
    let scale = if after > 0.0 { before / after } else { 1.0 };
    Ok(divided.par_map(|&color| color * scale as f32))
}

/// Returns the slope of the regression line of `values` over `of`; 0 if `of` is constant.
fn regression(values: &Raster<f32>, of: &Raster<f32>) -> Result<f64, TileError> {
    let [mean, statistics] = [values, of].map(Raster::statistics);
    let product = values.zip_map(of, |&value, &of| {
        ((f64::from(value) - mean.mean) * (f64::from(of) - statistics.mean)) as f32
    })?;
    let variance = statistics.deviation * statistics.deviation;
    Ok(match variance > 0.0 {
        true => product.statistics().mean / variance,
        false => 0.0,
    })
}

/// Returns a measure of roughness without a unit and with a mean of about 0: the logarithm of the local contrast of the
/// two finest octaves relative to its mean, minus a part of their value in standard deviations.
fn rough(octaves: &[Raster<f32>]) -> Result<Raster<f32>, TileError> {
    let at = |octave: usize| octave.min(octaves.len() - 1);
    let smooth = enlarged(octaves[at(2)].clone(), octaves, at(2))?;
    let detail = octaves[0].zip_map(&smooth, |fine, smooth| fine - smooth)?;
    let deviation = detail.statistics().deviation;
    if deviation == 0.0 {
        return Ok(detail);
    }
    let detail = detail.map(|&value| (f64::from(value) / deviation) as f32);
    // Average the squares by halving, and enlarge the means.
    let mut squares = detail.map(|&value| value * value);
    for octave in &octaves[1..=at(CONTRAST_OCTAVE)] {
        squares = resized(&squares, octave.size())?;
    }
    let contrast = enlarged(squares, octaves, at(CONTRAST_OCTAVE))?;
    Ok(contrast.zip_map(&detail, |&square, &detail| {
        // The mean of the squares is 1.
        let contrast = 0.5 * libm::log(f64::from(square) + LEAST_CONTRAST);
        (contrast - CAVITY * f64::from(detail)) as f32
    })?)
}

#[cfg(test)]
mod tests {
    use super::{EstimateOptions, estimate_material};
    use crate::TileErrorKind;
    use crate::test_fields::{fbm, same_on_threads};
    use dapple_color::{
        HeightPlane, LinearRgb, NormalOptions, OcclusionOptions, ambient_occlusion, normal_map,
    };
    use dapple_raster::glam::DVec2;
    use dapple_raster::{Raster, Wrap};

    const SIZE: [u32; 2] = [256, 192];

    fn plane() -> HeightPlane {
        HeightPlane {
            strength: 6.0,
            extent: DVec2::new(SIZE[0].into(), SIZE[1].into()),
            wrap: [Wrap::Clamp; 2],
        }
    }

    /// Heights of a few pixels, and their brown surface under a light.
    fn lit(shade: impl Fn(&Raster<f32>) -> Raster<f32>) -> (Raster<f32>, Raster<LinearRgb>) {
        let height = fbm(3, SIZE, false);
        let photo = shade(&height).map(|&light| LinearRgb::new(0.5, 0.4, 0.3) * light);
        (height, photo)
    }

    /// Light at 45 degrees from the given direction.
    fn directed(height: &Raster<f32>, degrees: f64) -> Raster<f32> {
        let normals = normal_map(height, &NormalOptions::from(plane())).unwrap();
        let (sin, cos) = libm::sincos(degrees.to_radians());
        normals.map(|normal| {
            let light = normal.x * cos as f32 + normal.y * sin as f32 + normal.z;
            (light * 0.7).max(0.02)
        })
    }

    fn correlation(a: &Raster<f32>, b: &Raster<f32>) -> f64 {
        let [of_a, of_b] = [a, b].map(|raster| raster.statistics());
        let product = a.zip_map(b, |&a, &b| {
            ((f64::from(a) - of_a.mean) * (f64::from(b) - of_b.mean)) as f32
        });
        product.unwrap().statistics().mean / (of_a.deviation * of_b.deviation)
    }

    fn heights(photo: &Raster<LinearRgb>, options: &EstimateOptions) -> Raster<f32> {
        estimate_material(photo, options).unwrap().height
    }

    /// At a coarseness of 0.6, the measured correlation is 0.79; the bar leaves a margin for the default. The rest is what
    /// neighbors shade, and the fine octaves, whose weights differ.
    #[test]
    fn height_correlates_with_the_surface_under_diffuse_light() {
        let options = OcclusionOptions {
            radius: 32.0,
            ..plane().into()
        };
        let (height, photo) = lit(|height| ambient_occlusion(height, &options).unwrap());
        let found = correlation(&heights(&photo, &EstimateOptions::default()), &height);
        assert!(found > 0.7, "{found}");
    }

    /// At a coarseness of 0.6, the measured correlations are 0.60 to 0.70, and at most 0.02 without the direction of the
    /// light; the bars leave a margin for the default. Forms along the light do not change the shading, so none of them
    /// can be found.
    #[test]
    fn height_correlates_with_the_surface_under_light_of_a_known_direction() {
        for degrees in [0.0, 45.0, 90.0, 200.0] {
            let (height, photo) = lit(|height| directed(height, degrees));
            let estimate = |light| {
                let options = EstimateOptions {
                    light,
                    ..EstimateOptions::default()
                };
                correlation(&heights(&photo, &options), &height)
            };
            let [found, blind] = [Some(degrees), None].map(estimate);
            assert!(found > 0.5 && blind < 0.1, "{degrees}: {found} {blind}");
            // Light from the other side makes hills of dents.
            let other = estimate(Some(degrees - 180.0));
            assert!(other < -0.5, "{degrees}: {other}");
        }
    }

    #[test]
    fn invert_turns_the_height_over() {
        let (_, photo) = lit(|height| height.map(|height| 1.0 + 0.2 * height));
        let options = EstimateOptions {
            invert: true,
            ..EstimateOptions::default()
        };
        let [up, down] =
            [EstimateOptions::default(), options].map(|options| heights(&photo, &options));
        for (up, down) in up.pixels().iter().zip(down.pixels()) {
            // The sums are negated exactly; the mean and the deviation round in f64.
            assert!((up + down - 1.0).abs() < 1e-5, "{up} {down}");
        }
    }

    #[test]
    fn heights_have_the_requested_slope_and_maps_their_ranges() {
        let (_, photo) = lit(|height| height.map(|height| 1.0 + 0.2 * height));
        let estimate = estimate_material(&photo, &EstimateOptions::default()).unwrap();
        let plane = HeightPlane {
            strength: estimate.relief,
            ..plane()
        };
        let normals = normal_map(&estimate.height, &NormalOptions::from(plane)).unwrap();
        let square = normals
            .map(|normal| (normal.x * normal.x + normal.y * normal.y) / (normal.z * normal.z));
        let slope = square.statistics().mean.sqrt();
        // The slope is set between means of 2 × 2 pixels, which lack a part of the finest octave.
        assert!((0.45..0.7).contains(&slope), "{slope}");
        for map in [&estimate.height, &estimate.roughness] {
            let statistics = map.statistics();
            assert!(
                statistics.min >= 0.0 && statistics.max <= 1.0,
                "{statistics:?}"
            );
            assert!(statistics.deviation > 0.02, "{statistics:?}");
        }
        let mean = |colors: &Raster<LinearRgb>| colors.map(|color| color.g).statistics().mean;
        let [before, after] = [&photo, &estimate.albedo].map(mean);
        assert!((after / before - 1.0).abs() < 0.02, "{before} {after}");
    }

    #[test]
    fn albedo_has_less_shading_than_the_photograph() {
        let options = OcclusionOptions {
            radius: 32.0,
            ..plane().into()
        };
        let (height, photo) = lit(|height| ambient_occlusion(height, &options).unwrap());
        let contrast = |delight: f64| {
            let options = EstimateOptions {
                delight,
                ..EstimateOptions::default()
            };
            let albedo = estimate_material(&photo, &options).unwrap().albedo;
            albedo.map(|color| color.g).statistics().deviation
        };
        let [none, half] = [0.0, 0.5].map(contrast);
        assert!(half < 0.9 * none, "{none} {half} {:?}", height.size());
    }

    #[test]
    fn a_plain_photograph_is_flat() {
        let gray = Raster::filled([9, 5], LinearRgb::gray(0.25)).unwrap();
        let black = Raster::filled([1, 1], LinearRgb::BLACK).unwrap();
        for photo in [gray, black] {
            let estimate = estimate_material(&photo, &EstimateOptions::default()).unwrap();
            assert!(
                estimate
                    .height
                    .pixels()
                    .iter()
                    .all(|height| (height - 0.5).abs() < 0.5)
            );
            assert!(estimate.relief.is_finite());
            let albedo = estimate.albedo.pixels()[0];
            assert!((albedo.r - photo.pixels()[0].r).abs() < 1e-4, "{albedo:?}");
        }
    }

    #[test]
    fn estimate_refuses_options_out_of_range_and_pixels_that_are_not_finite() {
        let photo = Raster::filled([8, 8], LinearRgb::WHITE).unwrap();
        let default = EstimateOptions::default();
        for options in [
            EstimateOptions {
                radius: Some(0.5),
                ..default
            },
            EstimateOptions {
                coarseness: 2.1,
                ..default
            },
            EstimateOptions {
                light: Some(f64::NAN),
                ..default
            },
            EstimateOptions {
                light: Some(361.0),
                ..default
            },
            EstimateOptions {
                slope: -0.1,
                ..default
            },
            EstimateOptions {
                delight: 1.5,
                ..default
            },
            EstimateOptions {
                roughness: f64::INFINITY,
                ..default
            },
            EstimateOptions {
                variation: -1.0,
                ..default
            },
        ] {
            let error = estimate_material(&photo, &options).unwrap_err();
            assert!(
                matches!(error.kind(), TileErrorKind::Range { .. }),
                "{options:?}: {error}"
            );
        }
        let bad = photo.map(|_| LinearRgb::new(f32::NAN, 0.0, 0.0));
        let error = estimate_material(&bad, &default).unwrap_err();
        assert!(
            matches!(error.kind(), TileErrorKind::NotFinite { .. }),
            "{error}"
        );
    }

    #[test]
    fn estimate_has_the_same_bits_on_any_number_of_threads() {
        let (_, photo) = lit(|height| height.map(|height| 1.0 + 0.2 * height));
        let options = EstimateOptions {
            light: Some(30.0),
            ..EstimateOptions::default()
        };
        for map in [0, 1, 2] {
            assert!(same_on_threads(|| {
                let estimate = estimate_material(&photo, &options).unwrap();
                match map {
                    0 => estimate.height,
                    1 => estimate.roughness,
                    _ => estimate.albedo.map(|color| color.b),
                }
            }));
        }
    }

    #[test]
    fn value_stability_of_estimates() {
        let (_, photo) = lit(|height| height.map(|height| 1.0 + 0.2 * height));
        let estimate = estimate_material(&photo, &EstimateOptions::default()).unwrap();
        let at = |map: &Raster<f32>| [map.row(40)[30], map.row(150)[200]].map(f32::to_bits);
        assert_eq!(
            [at(&estimate.height), at(&estimate.roughness)],
            [
                [1_051_936_182, 1_057_391_695],
                [1_060_646_733, 1_060_796_173]
            ]
        );
    }
}
