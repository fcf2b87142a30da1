//! Iterated reference image (section 3.2, figure 14): boundaries that become fractal.
//!
//! Each iteration doubles the number of control points. A point is white with a probability equal to the intensity at
//! its position. In the first iteration this is the intensity of the reference image, then of the previous iteration's
//! interpolated texture. Away from boundaries the probability is 0 or 1, and nothing changes. Near boundaries the
//! choice is random in every iteration, at ever smaller scales.
//!
//! The paper does not say whether the points of an iteration contain the previous ones; both are available. Points that
//! remain retain their label, since the value of a texture at a control point is that point's value (for an axis scale
//! of at most 1).

use super::octaves::{COUNT, expected_in_series};
use crate::{
    NetOptions, PupsError, PupsErrorKind, PupsField, PupsRecipe, ReferenceImage, Spacing, Texture,
    field_values, random_values,
};
use core::f64::consts::SQRT_2;
use dapple_hash::Seed;
use dapple_points::{Domain, PointSet, nested_poisson_disk_cancellable};

/// Options for [`iterated_reference`].
#[derive(Clone, Debug)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(default, deny_unknown_fields)
)]
pub struct IteratedOptions {
    /// Domain of the control points, which the image covers [default: the paper's torus `[-1, 1]²`].
    #[cfg_attr(feature = "schema", schemars(with = "crate::schema::Tile"))]
    pub domain: Domain,
    /// Spacing of the first iteration's control points: minimum distance in units of the plane, density, or number of
    /// points.
    pub spacing: Spacing,
    /// Number of iterations, from 1 to 16.
    #[cfg_attr(feature = "schema", schemars(transform = { COUNT }))]
    pub iterations: u32,
    /// Whether the points of an iteration contain the points of the previous iteration.
    pub points: IterationPoints,
    /// Weighting of the control points.
    pub net: NetOptions,
}

/// Whether the points of an iteration contain the points of the previous iteration.
///
#[cfg_attr(doc, doc = include_str!("../../docs/iteration-points.md"))]
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(rename_all = "snake_case")
)]
pub enum IterationPoints {
    /// Each iteration has separate points.
    #[default]
    Fresh,
    /// Each iteration contains the previous iteration's points, and as many again between them. The spacing must be
    /// constant.
    Nested,
}

impl Default for IteratedOptions {
    fn default() -> Self {
        Self {
            domain: Domain::paper_torus(),
            spacing: Spacing::from(0.1),
            iterations: 4,
            points: IterationPoints::Fresh,
            net: NetOptions::default(),
        }
    }
}

/// Builds the textures of all iterations. Values are in `[0, 1]` up to rounding, and mostly 0 or 1.
///
#[cfg_attr(doc, doc = include_str!("../../docs/iterated-reference.md"))]
///
/// # Errors
///
/// [`Points`](PupsErrorKind::Points) if points cannot be placed, [`Range`](PupsErrorKind::Range) if the number of
/// iterations is out of its range, [`SpacingVaries`](PupsErrorKind::SpacingVaries) if nested points have a varying
/// spacing. If net options are invalid, same as [`PupsOptions::check`](crate::PupsOptions::check).
///
/// # Examples
///
/// ```
/// use dapple_pups::{IteratedOptions, ReferenceImage, hash::Seed, iterated_reference, raster::Raster};
///
/// let image = ReferenceImage::new(Raster::from_vec([2, 1], vec![0.0, 1.0])?)?;
/// let iterations = iterated_reference(&image, &IteratedOptions::default(), Seed(7))?;
/// let n_points = |iteration: usize| iterations[iteration].pups().n_points();
/// assert!(n_points(3) > 7 * n_points(0));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn iterated_reference(
    image: &ReferenceImage,
    options: &IteratedOptions,
    seed: Seed,
) -> Result<Vec<Texture>, PupsError> {
    PupsError::check_in(COUNT, "number of iterations", options.iterations.into())?;
    let still = NetOptions {
        motion: None,
        ..options.net.clone()
    };
    let mut textures: Vec<Texture> = Vec::new();
    // Texture of the previous iteration, the input of the next one. If points move, this is the texture without motion.
    let mut former: Option<Texture> = None;
    for (iteration, points) in (0..).zip(options.point_sets(seed)?) {
        let seed = seed.child("iteration", iteration);
        // Probability of white at each point: the intensity of the image, or the value of the previous texture.
        let intensities = match &former {
            Some(texture) => field_values(&points, texture)?,
            None => first_intensities(image, &points),
        };
        // Draw white where a random number is below the probability.
        let random = random_values(points.len(), seed.child("label", 0));
        let white = |(random, intensity)| if random < intensity { 1.0 } else { 0.0 };
        let values: Vec<f32> = random.into_iter().zip(intensities).map(white).collect();
        // Build the texture without motion for the next iteration. The returned one includes motion.
        let texture = still.pups(&points, seed)?.texture(values.clone())?;
        textures.push(match options.net.motion {
            Some(_) => options.net.pups(&points, seed)?.texture(values)?,
            None => texture.clone(),
        });
        former = Some(texture);
    }
    Ok(textures)
}

fn first_intensities(image: &ReferenceImage, points: &PointSet) -> Vec<f32> {
    let intensity = |&position| image.intensity(points.domain(), position);
    points.positions().iter().map(intensity).collect()
}

impl IteratedOptions {
    /// Generates the points of each iteration. From one to the next, the number doubles, and distances are divided by
    /// the square root of two.
    fn point_sets(&self, seed: Seed) -> Result<Vec<PointSet>, PupsError> {
        let factors = core::iter::successors(Some(1.0), |factor| Some(factor * SQRT_2));
        let factors = factors.take(self.iterations as usize);
        // Fresh points are generated separately for each iteration.
        if self.points == IterationPoints::Fresh {
            let points = |(iteration, factor)| {
                let seed = seed.child("iteration", iteration).child("points", 0);
                let spacing = self.spacing.finer(factor);
                spacing.points_cancellable(self.domain, seed, &self.net.is_cancelled())
            };
            return (0..).zip(factors).map(points).collect();
        }
        // Nested points are generated as one sequence. Each iteration uses a longer prefix of it.
        let Some(distance) = self.spacing.uniform_distance(self.domain)? else {
            return Err(PupsError::new(PupsErrorKind::SpacingVaries));
        };
        let radii: Vec<f64> = factors.map(|factor| distance / factor).collect();
        let (seed, is_cancelled) = (seed.child("points", 0), self.net.is_cancelled());
        let nested = nested_poisson_disk_cancellable(self.domain, &radii, seed, &is_cancelled);
        let nested = nested.map_err(PupsError::of_part)?;
        let positions = nested.points().positions();
        let level = |&length: &usize| {
            let positions = positions[..length].to_vec();
            Ok(PointSet::new(self.domain, positions)?)
        };
        nested.lengths().iter().map(level).collect()
    }
}

impl PupsRecipe<ReferenceImage> for IteratedOptions {
    net_of!();

    fn expected_points(&self) -> f64 {
        expected_in_series(&self.spacing, self.domain, self.iterations, SQRT_2)
    }

    fn build(&self, image: &ReferenceImage, seed: Seed) -> Result<PupsField, PupsError> {
        let mut rounds = iterated_reference(image, self, seed)?;
        Ok(PupsField::numbers(rounds.swap_remove(rounds.len() - 1)))
    }
}
