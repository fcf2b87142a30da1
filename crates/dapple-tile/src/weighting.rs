//! Weighting, which determines the shares of layers at every pixel.
//!
//! Plain weights give gradual transitions in which both textures are half transparent. With heights, the higher stones
//! of one layer extend into the other. A blend tile cuts the transition along its own features.
//!
//! * [`Weighting::Height`]: a layer with weight `α` (weights sum to 1) and height `h` has the level
//!   `l = h + α - max(1 / 4α - 1, 0)`. Its share is `w = α · max(l - (top - depth), 0)`, where `top` is the largest
//!   level, divided by the sum of all `w`. This is the usual height blend of engines with two changes, which let a
//!   layer fade in from nothing: the factor `α`, and a lower level for layers with weights below ¼. The smaller the
//!   weight, the lower the level. Without this, a high layer of negligible weight would be the top and displace all
//!   others. Only differences of heights matter, so heights may have any range. The larger the differences, the smaller
//!   the weight at which a layer becomes visible.
//! * [`Weighting::Mask`]: with the thresholds `T(i) = α(1) + … + α(i)` and a blend tile `m`, the share is
//!   `w(i) = s(T(i)) - s(T(i-1))` with `s(T) = clamp((T - m) / 2r + ½, 0, 1)`. Half of the width of the ramp is
//!   `r = min(1 / (2 gain), T, 1 - T)`, or 0 for the largest gain. The ramp is narrower near 0 and 1, where it would
//!   exceed the values of the tile. So every layer has exactly its share of the area for every gain, if the values of
//!   the tile are evenly distributed, like those of [`rank_equalize`](crate::rank_equalize). A layer without weight has
//!   no area.

use crate::error::{check, rows_cancellable};
use crate::map::check_finite;
use crate::{IsCancelled, Layer, TileError, TileErrorKind};
use dapple_raster::Raster;

/// Rule that converts the weights of layers to their shares. The shares of a pixel sum to 1.
///
#[cfg_attr(doc, doc = include_str!("../docs/weighting.md"))]
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(rename_all = "snake_case", deny_unknown_fields)
)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub enum Weighting {
    /// Each weight divided by the sum of all weights.
    #[default]
    Given,
    /// Share by height: the higher layer is visible. The blend tile is the height of layers without one.
    Height {
        /// Height difference over which layers mix, above 0: 0.1 is crisp, 0.3 is soft.
        ///
        /// With heights from 0 to 1 and up to four layers, a layer with less than 1/16 of the weights is invisible, for
        /// depths up to 1.
        #[cfg_attr(feature = "serde", serde(default = "depth"))]
        depth: f64,
    },
    /// Share by mask: the blend tile is divided at thresholds. The first layer is visible where the tile is lowest, as
    /// in the cracks of a [`BlendMap`](crate::BlendMap).
    Mask {
        /// Sharpness of transitions, above 0 and at most 1e9: 1 is soft, 1e9 is hard.
        ///
        /// It is the reciprocal of the transition's width, which is measured in tile values. 4 and more show the
        /// features of the tile.
        #[cfg_attr(feature = "serde", serde(default = "gain"))]
        gain: f64,
    },
}

/// Default depth.
#[cfg(feature = "serde")]
fn depth() -> f64 {
    0.2
}

/// Default gain.
#[cfg(feature = "serde")]
fn gain() -> f64 {
    8.0
}

/// Maximum gain, which gives hard edges.
const MOST_GAIN: f64 = 1e9;

impl Weighting {
    /// Returns half of the width of the ramps of a mask, away from 0 and 1.
    #[doc(hidden)]
    #[must_use]
    pub fn half_width(gain: f64) -> f64 {
        if gain < MOST_GAIN { 0.5 / gain } else { 0.0 }
    }

    /// Computes the share of each layer.
    pub(crate) fn shares(
        &self,
        layers: &[Layer<'_>],
        tile: Option<&Raster<f32>>,
        is_cancelled: &IsCancelled,
    ) -> Result<Vec<Raster<f32>>, TileError> {
        if let (Some(tile), Some(layer)) = (tile, layers.first()) {
            layer.weight.check_same_size(tile.size())?;
            check_finite(tile)?;
        }
        for layer in layers {
            check(is_cancelled)?;
            check_finite(layer.weight)?;
            let least = layer.weight.statistics().min;
            TileError::check(least >= 0.0, "smallest weight", least.into(), "at least 0")?;
        }
        let weights: Vec<_> = layers.iter().map(|layer| layer.weight).collect();
        match *self {
            Self::Given => normalize(&weights, is_cancelled),
            Self::Height { depth } => {
                let holds = depth > 0.0 && depth.is_finite();
                TileError::check(holds, "depth", depth, "above 0 and finite")?;
                let weights = normalize(&weights, is_cancelled)?;
                by_height(&weights, &heights(layers, tile)?, depth, is_cancelled)
            }
            Self::Mask { gain } => {
                let holds = gain > 0.0 && gain <= MOST_GAIN;
                TileError::check(holds, "gain", gain, "above 0 and at most 1e9")?;
                by_mask(&weights, checked_mask(tile)?, gain, is_cancelled)
            }
        }
    }
}

/// Divides weights by their sum, which must be above zero everywhere.
pub(crate) fn normalize(
    weights: &[&Raster<f32>],
    is_cancelled: &IsCancelled,
) -> Result<Vec<Raster<f32>>, TileError> {
    let sums = sums(weights, is_cancelled)?;
    let share = |&weight: &f32, sum: &f64| (f64::from(weight) / sum) as f32;
    let shares = weights
        .iter()
        .map(|weights| zip(weights, &sums, is_cancelled, share));
    shares.collect()
}

/// Returns the sums of the weights, added in the order of the layers. They must be above zero.
fn sums(weights: &[&Raster<f32>], is_cancelled: &IsCancelled) -> Result<Raster<f64>, TileError> {
    let first = weights.first().ok_or(TileError::new(TileErrorKind::Count {
        what: "layers",
        count: 0,
        needed: "at least 1",
    }))?;
    let mut sums = first.map(|_| 0.0);
    for weights in weights {
        sums = zip(&sums, weights, is_cancelled, |sum, &weight| {
            sum + f64::from(weight)
        })?;
    }
    let least = sums.pixels().iter().copied().fold(f64::INFINITY, f64::min);
    TileError::check(least > 0.0, "sum of the weights", least, "above 0")?;
    Ok(sums)
}

/// Returns the height of each layer. For layers without a height, it is the blend tile.
fn heights<'a>(
    layers: &[Layer<'a>],
    tile: Option<&'a Raster<f32>>,
) -> Result<Vec<&'a Raster<f32>>, TileError> {
    let heights = layers.iter().filter_map(|layer| layer.height.or(tile));
    let heights: Vec<_> = heights.collect();
    if heights.len() < layers.len() {
        return Err(TileError::new(TileErrorKind::Count {
            what: "heights",
            count: heights.len(),
            needed: "as many as layers, or a blend tile",
        }));
    }
    heights.iter().try_for_each(|height| check_finite(height))?;
    Ok(heights)
}

fn by_height(
    weights: &[Raster<f32>],
    heights: &[&Raster<f32>],
    depth: f64,
    is_cancelled: &IsCancelled,
) -> Result<Vec<Raster<f32>>, TileError> {
    // Compute the level of each layer, and the largest level of each pixel.
    let levels: Vec<Raster<f64>> = weights
        .iter()
        .zip(heights)
        .map(|(weights, heights)| zip(weights, heights, is_cancelled, level))
        .collect::<Result<_, _>>()?;
    let mut top = levels[0].clone();
    for levels in &levels[1..] {
        top = zip(&top, levels, is_cancelled, |top, level| level.max(*top))?;
    }
    // Divide by the depth first. The highest layer then has a nearness of 1 even for the smallest depth.
    let nearness = |level: &f64, top: &f64| (1.0 - (top - level) / depth).max(0.0);
    let product = |&weight: &f32, nearness: &f64| (f64::from(weight) * nearness) as f32;
    // Multiply weights by nearness, and normalize the products.
    let shares: Vec<Raster<f32>> = weights
        .iter()
        .zip(&levels)
        .map(|(weights, levels)| {
            let nearness = zip(levels, &top, is_cancelled, nearness)?;
            zip(weights, &nearness, is_cancelled, product)
        })
        .collect::<Result<_, _>>()?;
    normalize(&shares.iter().collect::<Vec<_>>(), is_cancelled)
}

/// Returns the level of a layer for the shares by height. The highest layer is visible, and a layer without weight is
/// below all others.
fn level(&weight: &f32, &height: &f32) -> f64 {
    let weight = f64::from(weight);
    // Below a weight of ¼, the level decreases without limit.
    f64::from(height) + weight - (0.25 / weight - 1.0).max(0.0)
}

/// Checks that there is a blend tile with values from 0 to 1, and returns it.
fn checked_mask(tile: Option<&Raster<f32>>) -> Result<&Raster<f32>, TileError> {
    let tile = tile.ok_or(TileError::new(TileErrorKind::Count {
        what: "blend tiles",
        count: 0,
        needed: "1",
    }))?;
    let range = tile.statistics();
    for value in [range.min, range.max] {
        let holds = (0.0..=1.0).contains(&value);
        TileError::check(
            holds,
            "value of the blend tile",
            value.into(),
            "from 0 to 1",
        )?;
    }
    Ok(tile)
}

fn by_mask(
    weights: &[&Raster<f32>],
    mask: &Raster<f32>,
    gain: f64,
    is_cancelled: &IsCancelled,
) -> Result<Vec<Raster<f32>>, TileError> {
    let half_width = Weighting::half_width(gain);
    let sums = sums(weights, is_cancelled)?;
    // Cumulative weights of the layers, and the ramp at the previous threshold.
    let mut part = mask.map(|_| 0.0);
    let mut below = mask.map(|_| 0.0);
    let mut shares = Vec::with_capacity(weights.len());
    for weights in weights {
        part = zip(&part, weights, is_cancelled, |part, &weight| {
            part + f64::from(weight)
        })?;
        // These sums are computed in the same way as the sums of all weights, so the last threshold is exactly 1.
        let thresholds = zip(&part, &sums, is_cancelled, |part, sum| part / sum)?;
        // Parts of the mask below the threshold belong to this layer and those before it.
        let up_to = zip(&thresholds, mask, is_cancelled, |&threshold, &mask| {
            step(threshold, mask, half_width)
        })?;
        // The layer's share is the difference from the previous threshold.
        shares.push(zip(&up_to, &below, is_cancelled, |up_to, below| {
            (up_to - below).max(0.0) as f32
        })?);
        below = up_to;
    }
    Ok(shares)
}

/// Returns a ramp from 1, where the mask is below the threshold, to 0, where it is above.
fn step(threshold: f64, mask: f32, half_width: f64) -> f64 {
    // Narrow the ramp near 0 and 1, where it would exceed the values of the mask.
    let half_width = half_width.min(threshold).min(1.0 - threshold);
    let above = f64::from(mask) - threshold;
    if half_width > 0.0 {
        (0.5 - 0.5 * above / half_width).clamp(0.0, 1.0)
    } else if above < 0.0 || threshold >= 1.0 {
        1.0
    } else {
        0.0
    }
}

/// Combines two rasters of the same size. With the feature `rayon`, pixels are combined in parallel.
pub(crate) fn zip<A: Sync, B: Sync, C: Send>(
    a: &Raster<A>,
    b: &Raster<B>,
    is_cancelled: &IsCancelled,
    combine: impl Fn(&A, &B) -> C + Sync,
) -> Result<Raster<C>, TileError> {
    a.check_same_size(b.size())?;
    let combine = &combine;
    rows_cancellable(a.size(), is_cancelled, |row| {
        let pairs = a.row(row).iter().zip(b.row(row));
        pairs.map(move |(a, b)| combine(a, b))
    })
}

#[cfg(test)]
mod tests;
