//! The fields of nodes that make something of nothing but a seed.
//!
//! A field that has a frequency is asked at the position times the frequency: a whole window is rendered at once, as one
//! whose positions are those products.

use super::{Images, Picture};
use crate::operation::{coordinate, distance};
use crate::{
    Coordinate, Distance, Fractal, FractalBasis, Motion, NodeSeed, Recipe, RecipeError,
    RecipeErrorKind, WaveletNode, WorleyNode, WorleyValue,
};
use dapple_hash::Seed;
use dapple_noise::GradientNoise2;
use dapple_points::Domain;
use dapple_pups::{OctavesOptions, Spacing, octaves};
use dapple_raster::{Field, FieldExt, FractalShape, Frequency, Wrap, field_fn};
use dapple_wavelet::WaveletNoise2;
use dapple_worley::{Axes, Metric, Space, Worley, Worley2, Worley4};
use glam::DVec2;
use std::sync::Arc;

/// The cells of a wavelet tile along axes that do not repeat.
const UNBOUND_TILE: u32 = 128;

/// Makes the fields of a recipe.
pub(crate) struct Generator<'a> {
    pub(crate) recipe: &'a Recipe,
    pub(crate) images: &'a Images,
    /// The part of a loop that has passed.
    pub(crate) time: f64,
}

impl Generator<'_> {
    pub(super) fn extent(&self) -> DVec2 {
        self.recipe.extent.into()
    }

    /// What lies past the edges of the tile.
    pub(super) fn wrap(&self) -> [Wrap; 2] {
        self.recipe
            .wrap
            .map(|wraps| if wraps { Wrap::Repeat } else { Wrap::Clamp })
    }

    /// The tile as a domain.
    pub(super) fn domain(&self) -> Domain {
        Domain {
            origin: DVec2::ZERO,
            size: self.extent(),
            wrap: self.recipe.wrap,
        }
    }

    /// An image that the recipe names.
    pub(super) fn image(&self, file: &str) -> Result<&Picture, RecipeError> {
        self.images.get(file).ok_or_else(|| {
            let file = file.to_owned();
            RecipeError::new(RecipeErrorKind::NoImage { file })
        })
    }

    /// The seed of a node.
    pub(super) fn seed(&self, name: &str, other: Option<&NodeSeed>) -> Seed {
        match other {
            None => self.recipe.seed.child(name, 0),
            Some(NodeSeed::Name(name)) => self.recipe.seed.child(name, 0),
            Some(NodeSeed::Seed(seed)) => *seed,
        }
    }

    pub(super) fn worley(
        &self,
        name: &str,
        node: &WorleyNode,
    ) -> Result<Arc<dyn Field>, RecipeError> {
        let seed = self.seed(name, node.seed.as_ref());
        let [x, y] = self.periods(node.frequency.0)?;
        let field = match node.motion {
            None => {
                let worley = Worley2::new(seed).with_period([x, y])?;
                plane_field(node, worley)?
            }
            Some(Motion { cells, z }) => {
                RecipeError::check(z.is_finite(), "place along z", z, "finite")?;
                let worley = Worley4::new(seed).with_period([x, y, None, Some(cells)])?;
                moving_field(node, worley, [z, self.time * f64::from(cells)])?
            }
        };
        Ok(Arc::new(field.frequency_xy(node.frequency.0.into())))
    }

    /// The cells of the tile along each axis that repeats.
    pub(crate) fn periods(&self, frequency: [f64; 2]) -> Result<[Option<u32>; 2], RecipeError> {
        let mut periods = [None; 2];
        for axis in 0..2 {
            let holds = frequency[axis] > 0.0 && frequency[axis] <= 1e6;
            RecipeError::check(
                holds,
                "frequency",
                frequency[axis],
                "above 0 and at most 1e6",
            )?;
            if self.recipe.wrap[axis] {
                let cells = self.recipe.extent[axis] * frequency[axis];
                let whole = cells >= 1.0 && cells.fract() == 0.0 && cells <= f64::from(u32::MAX);
                let range =
                    "a whole number, at least 1 (extent times frequency, since the recipe repeats)";
                RecipeError::check(
                    whole,
                    "number of cells along a side of the tile",
                    cells,
                    range,
                )?;
                periods[axis] = Some(cells as u32);
            }
        }
        Ok(periods)
    }

    pub(super) fn wavelet(
        &self,
        name: &str,
        node: &WaveletNode,
    ) -> Result<Arc<dyn Field>, RecipeError> {
        let seed = self.seed(name, node.seed.as_ref());
        let noise = self.wavelet_noise(seed, node.frequency, &node.weights)?;
        Ok(Arc::new(noise))
    }

    fn wavelet_noise(
        &self,
        seed: Seed,
        frequency: f64,
        weights: &[f32],
    ) -> Result<Frequency<WaveletNoise2>, RecipeError> {
        let noise =
            WaveletNoise2::of_size(self.wavelet_cells(frequency)?, seed)?.with_weights(weights)?;
        Ok(noise.frequency(frequency))
    }

    /// The cells of the tile of wavelet noise along each axis.
    pub(crate) fn wavelet_cells(&self, frequency: f64) -> Result<[u32; 2], RecipeError> {
        let periods = self.periods([frequency; 2])?;
        for cells in periods.into_iter().flatten() {
            let holds = cells >= 4 && cells.is_multiple_of(2);
            let range = "even, at least 4 (extent times frequency, since the recipe repeats)";
            let what = "number of cells of wavelet noise along a side of the tile";
            RecipeError::check(holds, what, cells.into(), range)?;
        }
        Ok(periods.map(|cells| cells.unwrap_or(UNBOUND_TILE)))
    }

    pub(super) fn noise(&self, name: &str, node: &Fractal) -> Result<Arc<dyn Field>, RecipeError> {
        let seed = self.seed(name, node.seed.as_ref());
        let frequency = node.frequency;
        RecipeError::check(
            frequency > 0.0 && frequency <= 1e6,
            "frequency",
            frequency,
            "above 0 and at most 1e6",
        )?;
        let count = node.octaves;
        RecipeError::check(
            (1..=16).contains(&count),
            "number of octaves",
            count.into(),
            "from 1 to 16",
        )?;
        RecipeError::check(
            node.gain > 0.0 && node.gain <= 1.0,
            "gain",
            node.gain,
            "above 0 and at most 1",
        )?;
        match node.basis {
            FractalBasis::Pups => Ok(Arc::new(
                octaves(&self.fractal_options(node), seed)?.normalized(),
            )),
            FractalBasis::Wavelet => {
                let weights = Self::fractal_weights(node, 1.0);
                let noise = self.wavelet_noise(seed, frequency, &weights)?;
                Ok(Arc::new(noise.map(about_half)))
            }
            FractalBasis::Gradient => {
                let noise = GradientNoise2::new(seed).with_period(self.periods([frequency; 2])?)?;
                let octaves = noise.fractal(count, node.gain, 2.0, FractalShape::Sum)?;
                let scale = Self::fractal_weights(node, GradientNoise2::VARIANCE.into())[0];
                let noise = octaves.frequency(frequency);
                Ok(Arc::new(noise.map(move |sum| about_half(scale * sum))))
            }
        }
    }

    /// The options of the octaves of PUPs noise.
    pub(crate) fn fractal_options(&self, node: &Fractal) -> OctavesOptions {
        OctavesOptions {
            domain: self.domain(),
            spacing: Spacing::from(1.0 / node.frequency),
            octaves: node.octaves,
            gain: node.gain,
            ..OctavesOptions::default()
        }
    }

    /// The weights of octaves of noise with a variance, for a sum with a standard deviation of a sixth.
    fn fractal_weights(node: &Fractal, variance: f64) -> Vec<f32> {
        let weights = core::iter::successors(Some(1.0), |weight| Some(weight * node.gain));
        let weights: Vec<f64> = weights.take(node.octaves as usize).collect();
        let deviation = weights
            .iter()
            .map(|weight| weight * weight * variance)
            .sum::<f64>()
            .sqrt();
        weights
            .into_iter()
            .map(|weight| (weight / (6.0 * deviation)) as f32)
            .collect()
    }

    pub(super) fn coordinate(&self, node: &Coordinate) -> Result<Arc<dyn Field>, RecipeError> {
        for number in node.center.into_iter().chain(node.along) {
            RecipeError::check(number.is_finite(), "part of a coordinate", number, "finite")?;
        }
        let (center, along) = (node.center.into(), node.along.into());
        let value = move |position| coordinate(position, center, along);
        Ok(Arc::new(field_fn(value)))
    }

    pub(super) fn distance(&self, node: &Distance) -> Result<Arc<dyn Field>, RecipeError> {
        for number in node.center {
            RecipeError::check(number.is_finite(), "center", number, "finite")?;
        }
        let (center, extent, wrap) = (node.center.into(), self.extent(), self.recipe.wrap);
        let value = move |position| distance(position, center, extent, wrap);
        Ok(Arc::new(field_fn(value)))
    }
}

/// Half more than a value, cut off at 0 and 1.
fn about_half(value: f32) -> f32 {
    (0.5 + value).clamp(0.0, 1.0)
}

/// A cellular basis with the metric and the scatter of a node.
fn basis<const N: usize>(node: &WorleyNode, worley: Worley<N>) -> Result<Worley<N>, RecipeError>
where
    Axes: Space<N>,
{
    match node.value {
        WorleyValue::Combination(_) => {}
        WorleyValue::CellValue => check_single(node, true)?,
        WorleyValue::EdgeDistance => check_single(node, node.metric == Metric::Euclidean)?,
    }
    Ok(worley
        .with_metric(node.metric)?
        .with_scatter(node.scatter)?)
}

/// The field of a cellular basis of the plane.
fn plane_field(node: &WorleyNode, worley: Worley2) -> Result<Arc<dyn Field>, RecipeError> {
    let worley = basis(node, worley)?;
    let combination = match node.value {
        WorleyValue::Combination(combination) => combination,
        WorleyValue::CellValue => return Ok(Arc::new(worley.cell_values())),
        WorleyValue::EdgeDistance => return Ok(Arc::new(worley.edge_distances())),
    };
    let cellular = worley.combine(combination);
    Ok(match (node.octaves, node.range) {
        (None, None) => Arc::new(cellular),
        (None, Some(range)) => Arc::new(cellular.with_range(range)?),
        (Some(octaves), None) => Arc::new(cellular.fractal(octaves)?),
        (Some(octaves), Some(range)) => Arc::new(cellular.fractal(octaves)?.with_range(range)?),
    })
}

/// The field of a slice of a basis of four dimensions.
fn moving_field(
    node: &WorleyNode,
    worley: Worley4,
    place: [f64; 2],
) -> Result<Arc<dyn Field>, RecipeError> {
    let worley = basis(node, worley)?;
    let combination = match node.value {
        WorleyValue::Combination(combination) => combination,
        WorleyValue::CellValue => {
            let [z, w] = place;
            let value = move |at: DVec2| cell_value(&worley, [at.x, at.y, z, w]);
            return Ok(Arc::new(field_fn(value)));
        }
        WorleyValue::EdgeDistance => return Ok(Arc::new(worley.edge_distances().slice(place))),
    };
    let cellular = worley.combine(combination);
    Ok(Arc::new(match (node.octaves, node.range) {
        (None, None) => cellular.slice(place),
        (None, Some(range)) => cellular.with_range(range)?.slice(place),
        (Some(octaves), None) => cellular.fractal(octaves)?.slice(place),
        (Some(octaves), Some(range)) => cellular.fractal(octaves)?.with_range(range)?.slice(place),
    }))
}

fn cell_value(worley: &Worley4, at: [f64; 4]) -> f32 {
    let [nearest] = worley.sample(at);
    if nearest.distance.is_nan() {
        f32::NAN
    } else {
        nearest.cell_value()
    }
}

/// Refuses what only combinations of distances have.
fn check_single(node: &WorleyNode, metric: bool) -> Result<(), RecipeError> {
    let rule = if node.octaves.is_some() || node.range.is_some() {
        "`cell_value` and `edge_distance` have neither `octaves` nor a `range`"
    } else if !metric {
        "`edge_distance` is of the Euclidean metric"
    } else {
        return Ok(());
    };
    Err(RecipeError::new(RecipeErrorKind::Conflict { rule }))
}
