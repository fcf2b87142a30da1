//! Color noise: palette colors at the control points, interpolated. This goes beyond the paper, which calls color "a
//! more challenging problem" and does not pursue it, although its values may be "a vector color value".
//!
//! Colors are interpolated as given, so use linear RGB, or any other three numbers that can be averaged.

use crate::{
    NetOptions, PupsError, PupsField, PupsRecipe, Spacing, VectorTexture, palette_values,
    random_labels,
};
use dapple_hash::Seed;
use dapple_points::Domain;

/// Options for [`color_noise`].
#[derive(Clone, Debug)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(default, deny_unknown_fields)
)]
pub struct ColorNoiseOptions {
    /// Domain of the control points, in which the texture repeats [default: the paper's torus `[-1, 1]²`].
    #[cfg_attr(feature = "schema", schemars(with = "crate::schema::Tile"))]
    pub domain: Domain,
    /// Spacing of the control points: minimum distance in units of the plane, density, or number of points.
    pub spacing: Spacing,
    /// Equally probable colors of the control points, in linear RGB from 0 to 1.
    ///
    /// The default is an orange, a cream, a teal and a dark blue.
    pub palette: Vec<[f32; 3]>,
    /// Weighting of the control points.
    pub net: NetOptions,
}

impl Default for ColorNoiseOptions {
    fn default() -> Self {
        Self {
            domain: Domain::paper_torus(),
            spacing: Spacing::from(0.1),
            palette: vec![
                [0.75, 0.2, 0.03],
                [0.9, 0.8, 0.55],
                [0.05, 0.3, 0.3],
                [0.01, 0.03, 0.15],
            ],
            net: NetOptions::default(),
        }
    }
}

/// Builds a texture that interpolates random palette colors. Every channel is between its smallest and largest value in
/// the palette.
///
#[cfg_attr(doc, doc = include_str!("../../docs/color-noise.md"))]
///
/// # Errors
///
/// [`Points`](crate::PupsErrorKind::Points) if points cannot be placed, [`Range`](crate::PupsErrorKind::Range) if the
/// palette is empty or a color is not finite. If net options are invalid, same as
/// [`PupsOptions::check`](crate::PupsOptions::check).
///
/// # Examples
///
/// ```
/// use dapple_pups::{ColorNoiseOptions, color_noise, glam::DVec2, hash::Seed};
///
/// let [red, _, blue] = color_noise(&ColorNoiseOptions::default(), Seed(7))?.sample(DVec2::ZERO);
/// assert!((0.0..=1.0).contains(&red) && (0.0..=1.0).contains(&blue));
/// # Ok::<(), dapple_pups::PupsError>(())
/// ```
pub fn color_noise(options: &ColorNoiseOptions, seed: Seed) -> Result<VectorTexture<3>, PupsError> {
    let points = options
        .net
        .points(&options.spacing, options.domain, seed.child("points", 0))?;
    // Draw a color of the palette for each point.
    let n_colors = u32::try_from(options.palette.len()).unwrap_or(u32::MAX);
    let labels = random_labels(points.len(), n_colors, seed.child("label", 0))?;
    let colors = palette_values(&labels, &options.palette)?;
    options.net.pups(&points, seed)?.vector_texture(colors)
}

impl PupsRecipe for ColorNoiseOptions {
    const IS_COLOR: bool = true;

    net_of!(points);

    fn build(&self, (): &(), seed: Seed) -> Result<PupsField, PupsError> {
        Ok(PupsField::Colors(Box::new(color_noise(self, seed)?)))
    }
}
