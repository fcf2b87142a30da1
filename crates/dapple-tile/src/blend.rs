//! Blends textures by weights, in all maps of several materials.
//!
//! Blending has two independent parts. The [`Weighting`] determines the share of each layer in a pixel. The share is
//! the weight itself, or is larger for the higher layer, or comes from a blend tile. The last is the purpose of the
//! tiles of Du, Wang and Meng ("Wavelet and Blend maps for texture synthesis", section V). The [`Mixing`] determines
//! how the layers' values `x` are combined by these shares `w`:
//!
//! * linear: `Σ w x`, the splatting of Charles Bloom (2000);
//! * variance-preserving: `Σ w μ + Σ w (x - μ) / sqrt(Σ w²)`, with `μ` the mean of a layer's map over the raster, after
//!   Eric Heitz and Fabrice Neyret, "High-Performance By-Example Noise using a Histogram-Preserving Blending Operator",
//!   Proceedings of the ACM on Computer Graphics and Interactive Techniques 1(2), 2018,
//!   <https://doi.org/10.1145/3233304>. Their operator is for textures with histograms made Gaussian; here values are
//!   used unchanged;
//! * in bands: see [`Pyramid`].
//!
//! The fine contrast that remains in the middle of a ramp of 128 pixels, for two different noises of equal contrast, as
//! measured by the tests:
//!
//! | weighting | linear | variance-preserving | pyramid |
//! |---|---|---|---|
//! | given | 0.71 | 1.00 | 0.88 |
//! | height, depth 0.3 | 0.92 | | |
//! | height, depth 0.1 | 1.01 | | |
//! | mask, gain 4 | 0.97 | | 0.99 |
//! | mask, hard | 1.05 | | |
//!
//! All maps of a material have the same shares. Normals are blended as slopes, and the results are unit vectors. For
//! normals that match the blended height, compute them from it by [`normal_map`](dapple_color::normal_map).

use crate::error::{check, rows_cancellable};
use crate::map::check_planes;
use crate::{IsCancelled, Map, Pyramid, TileError, TileErrorKind, Weighting};
use dapple_raster::Raster;

/// A material with the weight of its layer at each pixel.
#[derive(Clone, Copy, Debug)]
pub struct Layer<'a> {
    /// Maps of the material. All layers have the same kinds in the same order, and all maps are the same size.
    pub maps: &'a [Map],
    /// Weight of the layer at each pixel, at least 0, relative to the weights of the other layers.
    pub weight: &'a Raster<f32>,
    /// Height for [`Weighting::Height`], usually from 0 to 1. Only differences between layers matter.
    pub height: Option<&'a Raster<f32>>,
}

/// Options for blending layers.
///
/// # Examples
///
/// ```
/// use dapple_tile::{Blend, Mixing, Weighting};
///
/// // Plain splatting, and splatting with hard edges along the features of a blend tile.
/// let splatting = Blend::new(Weighting::Given, Mixing::Linear);
/// let cut = Blend { weighting: Weighting::Mask { gain: 1e9 }, ..splatting };
/// assert_eq!(splatting, Blend::default());
/// assert_ne!(splatting, cut);
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(default, deny_unknown_fields)
)]
pub struct Blend {
    /// Rule that converts weights to shares.
    ///
    /// The default is [`Weighting::Given`].
    pub weighting: Weighting,
    /// Rule that combines layers by their shares.
    ///
    /// The default is linear.
    pub mixing: Mixing,
}

/// Rule that combines layers by their shares.
///
#[cfg_attr(doc, doc = include_str!("../docs/mixing.md"))]
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(rename_all = "snake_case")
)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub enum Mixing {
    /// Weighted mean. It stays in the range of the layers' values.
    #[default]
    Linear,
    /// Variance-preserving mean, which retains the contrast of uncorrelated layers. Values may exceed the range of the
    /// layers.
    KeepVariance,
    /// Weighted mean in frequency bands, with sharper transitions for finer detail.
    Pyramid(Pyramid),
}

impl Blend {
    /// Creates a blend with the given weighting and mixing.
    #[must_use]
    pub fn new(weighting: Weighting, mixing: Mixing) -> Self {
        Self { weighting, mixing }
    }
}

/// Blends the maps of all layers.
///
/// Where only one layer has a weight, the result equals its maps: exactly with [`Mixing::Linear`], and up to rounding
/// with [`Mixing::KeepVariance`]. With [`Mixing::Pyramid`] it is equal up to one rounding per level, if no other layer
/// has a weight nearby. Normals are exact up to the rounding of their slopes.
///
/// # Errors
///
/// * [`Count`](TileErrorKind::Count) without layers or maps, if the numbers of maps differ between layers, or if a
///   height or a blend tile is missing
/// * [`KindMismatch`](TileErrorKind::KindMismatch) if the kinds of maps differ between layers
/// * [`Raster`](TileErrorKind::Raster) if sizes differ
/// * [`NotFinite`](TileErrorKind::NotFinite) if a pixel is NaN or infinite
/// * [`Range`](TileErrorKind::Range) if a weight is below 0, a pixel has no weight in any layer, or a depth, gain,
///   sharpness or number of levels is out of its range
/// * [`Wavelet`](TileErrorKind::Wavelet) if a size cannot be halved as often as a pyramid requires
///
/// # Examples
///
/// ```
/// use dapple_raster::Raster;
/// use dapple_tile::{Blend, Layer, Map, blend};
///
/// let [sand, rock] = [0.8, 0.2].map(|gray| Raster::filled([4, 4], gray).map(Map::Value));
/// let weight = Raster::filled([4, 4], 1.0)?;
/// let [sand, rock] = [[sand?], [rock?]];
/// let layers = [&sand, &rock].map(|maps| Layer { maps, weight: &weight, height: None });
/// let blended = blend(&layers, &Blend::default())?;
/// assert_eq!(blended, [Map::Value(Raster::filled([4, 4], 0.5)?)]);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn blend(layers: &[Layer<'_>], how: &Blend) -> Result<Vec<Map>, TileError> {
    blend_cancellable(layers, None, how, &|| false)
}

/// Blends the maps of all layers along the features of a blend tile, which is the same size as the maps. The tile is
/// the mask for [`Weighting::Mask`]. For [`Weighting::Height`], it is the height of layers without a height. Other
/// weightings ignore it.
///
/// # Errors
///
/// Same as [`blend`], and [`Range`](TileErrorKind::Range) if a mask has a value outside of 0 to 1.
///
/// # Examples
///
/// Grow grass in the cracks of stones, over a third of the area:
///
/// ```
/// use dapple_raster::Raster;
/// use dapple_tile::{Blend, BlendMap, Layer, Map, Mixing, Weighting, blend_by_tile, rank_equalize};
///
/// let stones = Raster::from_fn([48, 48], |_, row| if row % 12 < 4 { 0.1_f32 } else { 0.6 })?;
/// let tile = rank_equalize(&BlendMap::new(24.0).apply(&stones)?)?;
/// let [grass, stones] = [[Map::Value(Raster::filled([48, 48], 1.0)?)], [Map::Value(stones)]];
/// let [third, rest] = [Raster::filled([48, 48], 1.0)?, Raster::filled([48, 48], 2.0)?];
/// let layers = [
///     Layer { maps: &grass, weight: &third, height: None },
///     Layer { maps: &stones, weight: &rest, height: None },
/// ];
/// let how = Blend::new(Weighting::Mask { gain: 8.0 }, Mixing::Linear);
/// let Map::Value(blended) = &blend_by_tile(&layers, &tile, &how)?[0] else { panic!("no values") };
/// assert!(blended.row(1)[0] > 0.9);
/// assert_eq!(blended.row(8)[0], 0.6);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn blend_by_tile(
    layers: &[Layer<'_>],
    tile: &Raster<f32>,
    how: &Blend,
) -> Result<Vec<Map>, TileError> {
    blend_cancellable(layers, Some(tile), how, &|| false)
}

/// Same as [`blend`], or [`blend_by_tile`] with a tile, but fails if `is_cancelled` returns true. It is called before each
/// layer and each plane of a map, and once per 65,536 pixels of a pass over them.
///
/// # Errors
///
/// Same as [`blend_by_tile`], plus [`Cancelled`](TileErrorKind::Cancelled).
pub fn blend_cancellable(
    layers: &[Layer<'_>],
    tile: Option<&Raster<f32>>,
    how: &Blend,
    is_cancelled: &IsCancelled,
) -> Result<Vec<Map>, TileError> {
    check_layers(layers)?;
    check(is_cancelled)?;
    let shares = how.weighting.shares(layers, tile, is_cancelled)?;
    // Shares for each band, finest first.
    let bands = match &how.mixing {
        Mixing::Pyramid(pyramid) => pyramid.shares(shares, is_cancelled)?,
        Mixing::Linear | Mixing::KeepVariance => vec![shares],
    };
    (0..layers[0].maps.len())
        .map(|map| mix_map(layers, map, &bands, &how.mixing, is_cancelled))
        .collect()
}

/// Checks that the layers have the same number, kinds and sizes of maps.
fn check_layers(layers: &[Layer<'_>]) -> Result<(), TileError> {
    let count = |what, count, needed| {
        TileError::new(TileErrorKind::Count {
            what,
            count,
            needed,
        })
    };
    let first = layers.first().ok_or(count("layers", 0, "at least 1"))?;
    if first.maps.is_empty() {
        return Err(count("maps", 0, "at least 1"));
    }
    for layer in layers {
        if layer.maps.len() != first.maps.len() {
            let needed = "as many as the first layer has";
            return Err(count("maps", layer.maps.len(), needed));
        }
        for (map, (a, b)) in layer.maps.iter().zip(first.maps).enumerate() {
            if core::mem::discriminant(a) != core::mem::discriminant(b) {
                return Err(TileError::new(TileErrorKind::KindMismatch { map }));
            }
            first.weight.check_same_size(a.size())?;
        }
        first.weight.check_same_size(layer.weight.size())?;
    }
    Ok(())
}

/// Blends one map of all layers.
fn mix_map(
    layers: &[Layer<'_>],
    map: usize,
    bands: &[Vec<Raster<f32>>],
    mixing: &Mixing,
    is_cancelled: &IsCancelled,
) -> Result<Map, TileError> {
    // Iterate over the planes of this map in all layers at once.
    let mut of_layers: Vec<_> = layers
        .iter()
        .map(|layer| layer.maps[map].planes().into_iter())
        .collect();
    let mut blended = Vec::new();
    loop {
        // Take the next plane of each layer; all layers have the same number of planes.
        let planes: Vec<_> = of_layers.iter_mut().filter_map(Iterator::next).collect();
        if planes.is_empty() {
            return layers[0].maps[map].with_planes(blended);
        }
        check_planes(&planes)?;
        check(is_cancelled)?;
        blended.push(match mixing {
            Mixing::Linear => linear(&planes, &bands[0], is_cancelled)?,
            Mixing::KeepVariance => keep_variance(&planes, &bands[0], is_cancelled)?,
            Mixing::Pyramid(pyramid) => pyramid.mix(&planes, bands, is_cancelled)?,
        });
    }
}

/// Computes the linear blend `Σ w x`, clamped to the range of the values whose share is nonzero.
pub(crate) fn linear(
    planes: &[Raster<f32>],
    shares: &[Raster<f32>],
    is_cancelled: &IsCancelled,
) -> Result<Raster<f32>, TileError> {
    let size = planes[0].size();
    rows_cancellable(size, is_cancelled, |row| {
        // For each pixel, compute the weighted sum, and the range of the values that have a share.
        let mut sums = vec![(0.0_f64, f32::INFINITY, f32::NEG_INFINITY); size[0] as usize];
        for (plane, shares) in planes.iter().zip(shares) {
            let pixels = plane.row(row).iter().zip(shares.row(row));
            for ((sum, min, max), (&value, &share)) in sums.iter_mut().zip(pixels) {
                *sum += f64::from(share) * f64::from(value);
                if share > 0.0 {
                    *min = min.min(value);
                    *max = max.max(value);
                }
            }
        }
        // Rounding of the sum of shares must not push the result out of the range.
        let mixed = |(sum, min, max): (f64, f32, f32)| (sum as f32).max(min).min(max);
        sums.into_iter().map(mixed)
    })
}

/// Computes the variance-preserving blend `Σ w μ + Σ w (x - μ) / sqrt(Σ w²)`.
fn keep_variance(
    planes: &[Raster<f32>],
    shares: &[Raster<f32>],
    is_cancelled: &IsCancelled,
) -> Result<Raster<f32>, TileError> {
    let size = planes[0].size();
    let means: Vec<f64> = planes.iter().map(|plane| plane.statistics().mean).collect();
    rows_cancellable(size, is_cancelled, |row| {
        // For each pixel, compute `Σ w μ`, `Σ w (x - μ)` and `Σ w²`.
        let mut sums = vec![[0.0_f64; 3]; size[0] as usize];
        for ((plane, shares), mean) in planes.iter().zip(shares).zip(&means) {
            let pixels = plane.row(row).iter().zip(shares.row(row));
            for ([means, offsets, squares], (&value, &share)) in sums.iter_mut().zip(pixels) {
                let [value, share] = [value, share].map(f64::from);
                *means += share * mean;
                *offsets += share * (value - mean);
                *squares += share * share;
            }
        }
        // The sum of squares is at least one over the number of layers.
        let mixed = |[mean, offset, squares]: [f64; 3]| (mean + offset / squares.sqrt()) as f32;
        sums.into_iter().map(mixed)
    })
}

#[cfg(test)]
mod tests;
