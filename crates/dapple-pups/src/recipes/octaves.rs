//! Octaves of noise, their sum (equation 5, figure 6), folding (figure 7) and turbulence (figure 8).
//!
//! In octave i, control points are 2^i times as dense along each axis. The paper uses separate points for every octave
//! and notes that one rescaled tile would suffice; both are available. A rescaled octave is `tile(2^i · position)`.
//! Since the factor is a power of two and the tile repeats, this is exact, and the octave repeats with the tile's
//! period.
//!
//! The sum of equation 5 is between 0 and 1 + ½ + ¼ + ⅛ = 1.875. The paper does not say how it is displayed. Here it is
//! divided by the largest possible value: [`Layers::normalized`].

use crate::{
    Folding, Layers, NetOptions, NoiseOptions, Octave, PupsError, PupsErrorKind, PupsField,
    PupsRecipe, Range, Spacing, Texture, noise, range,
};
use dapple_hash::Seed;
use dapple_points::Domain;

/// Options for [`octaves`] and [`turbulence`].
#[derive(Clone, Debug)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(default, deny_unknown_fields)
)]
pub struct OctavesOptions {
    /// Domain of the control points, in which the texture repeats [default: the paper's torus `[-1, 1]²`].
    #[cfg_attr(feature = "schema", schemars(with = "crate::schema::Tile"))]
    pub domain: Domain,
    /// Spacing of the first octave's control points: minimum distance in units of the plane, density, or number of
    /// points.
    pub spacing: Spacing,
    /// Number of octaves, from 1 to 16.
    #[cfg_attr(feature = "schema", schemars(transform = { COUNT }))]
    pub octaves: u32,
    /// Frequency ratio of successive octaves, above 1 and at most 16. Rescaled octaves require a power of two.
    #[cfg_attr(feature = "schema", schemars(transform = { LACUNARITY }))]
    pub lacunarity: f64,
    /// Amplitude ratio of successive octaves, above 0 and at most 1.
    #[cfg_attr(feature = "serde", serde(alias = "persistence"))]
    #[cfg_attr(feature = "schema", schemars(transform = { GAIN }))]
    pub gain: f64,
    /// Source of the octaves: separate control points, or one rescaled tile.
    ///
    /// The paper has separate control points.
    pub source: OctaveSource,
    /// Weighting of the control points.
    pub net: NetOptions,
}

/// Options for [`turbulence`], the same as for [`octaves`].
#[derive(Clone, Debug, Default)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(transparent)
)]
pub struct TurbulenceOptions(pub OctavesOptions);

/// Source of the octaves.
///
#[cfg_attr(doc, doc = include_str!("../../docs/octave-source.md"))]
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(rename_all = "snake_case")
)]
pub enum OctaveSource {
    /// Separate control points for each octave, as in the paper.
    #[default]
    Separate,
    /// One tile for all octaves, rescaled about the origin of the plane. The domain must wrap along both axes.
    ///
    /// This takes less memory, but the octaves are correlated: all of them are equal at the origin.
    Rescaled,
}

impl Default for OctavesOptions {
    fn default() -> Self {
        Self {
            domain: Domain::paper_torus(),
            spacing: Spacing::from(0.1),
            octaves: 4,
            lacunarity: 2.0,
            gain: 0.5,
            source: OctaveSource::Separate,
            net: NetOptions::default(),
        }
    }
}

/// Builds octaves of noise. As a field, the result is their sum by equation 5.
///
#[cfg_attr(doc, doc = include_str!("../../docs/octaves.md"))]
///
/// # Errors
///
/// Same as [`noise`]; [`Range`](PupsErrorKind::Range) if an option is out of its range;
/// [`NotWrapped`](PupsErrorKind::NotWrapped) if octaves are rescaled and the domain does not wrap along both axes.
///
/// # Examples
///
/// ```
/// use dapple_pups::{OctavesOptions, hash::Seed, octaves};
/// use dapple_pups::raster::{Field, Window, glam::DVec2};
///
/// let sum = octaves(&OctavesOptions::default(), Seed(7))?;
/// assert_eq!(sum.maximum(), 1.875);
/// let window = Window::new(DVec2::NEG_ONE, DVec2::splat(2.0), [64, 64])?;
/// let image = sum.normalized().to_raster(&window)?;
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[doc(alias = "fBm")]
pub fn octaves(options: &OctavesOptions, seed: Seed) -> Result<Layers<Octave>, PupsError> {
    options.check()?;
    let scales = core::iter::successors(Some(1.0), |scale| Some(scale * options.lacunarity));
    let scales = scales.take(options.octaves as usize);
    let octaves: Result<Vec<Octave>, PupsError> = match options.source {
        // Each octave has its own points, spaced more closely by the scale.
        OctaveSource::Separate => (0..)
            .zip(scales)
            .map(|(index, scale)| {
                let texture = options.texture(scale, seed.child("octave", index))?;
                Ok(Octave::new(texture, 1.0))
            })
            .collect(),
        // All octaves share one texture, with positions multiplied by the scale.
        OctaveSource::Rescaled => {
            let texture = options.texture(1.0, seed.child("octave", 0))?;
            Ok(scales
                .map(|scale| Octave::new(texture.clone(), scale))
                .collect())
        }
    };
    // Equation 5 with the gain instead of 1/2: Σ gain^i P_i(x).
    Ok(Layers::geometric(octaves?, options.gain))
}

/// Builds Perlin's turbulence: the sum of folded [`octaves`], which is between 0 and 1.875 by default.
///
#[cfg_attr(doc, doc = include_str!("../../docs/turbulence.md"))]
///
/// # Errors
///
/// Same as [`octaves`].
pub fn turbulence(options: &OctavesOptions, seed: Seed) -> Result<Layers<Octave>, PupsError> {
    Ok(octaves(options, seed)?.folded())
}

impl Layers<Octave> {
    /// Folds each octave.
    #[must_use]
    pub fn folded(self) -> Self {
        self.map(|octave| octave.with_folding(Folding::Folded))
    }
}

impl OctavesOptions {
    fn texture(&self, scale: f64, seed: Seed) -> Result<Texture, PupsError> {
        let options = NoiseOptions {
            domain: self.domain,
            spacing: self.spacing.finer(scale),
            net: self.net.clone(),
        };
        noise(&options, seed)
    }

    fn check(&self) -> Result<(), PupsError> {
        check_series(
            "number of octaves",
            self.octaves,
            self.lacunarity,
            self.gain,
        )?;
        // Only powers of two scale positions exactly. Scaled positions leave the domain, so it must wrap.
        if self.source == OctaveSource::Rescaled {
            let power = [2.0, 4.0, 8.0, 16.0].contains(&self.lacunarity);
            PupsError::check(
                power,
                "lacunarity of rescaled octaves",
                self.lacunarity,
                "2, 4, 8 or 16",
            )?;
            if let Some(axis) = self.domain.wrap.iter().position(|wrap| !wrap) {
                return Err(PupsError::new(PupsErrorKind::NotWrapped { axis }));
            }
        }
        Ok(())
    }
}

/// Range of the number of octaves, layers or iterations.
pub(super) const COUNT: Range = range!(from 1 to 16);
/// Range of the frequency ratio of successive octaves.
pub(super) const LACUNARITY: Range = range!(above 1 to 16);
/// Range of the amplitude ratio of successive octaves.
pub(super) const GAIN: Range = range!(above 0 to 1);

/// Checks the number, the lacunarity and the gain of a series of layers.
pub(crate) fn check_series(
    what: &'static str,
    count: u32,
    lacunarity: f64,
    gain: f64,
) -> Result<(), PupsError> {
    PupsError::check_in(COUNT, what, count.into())?;
    PupsError::check_in(LACUNARITY, "lacunarity", lacunarity)?;
    PupsError::check_in(GAIN, "gain", gain)
}

impl PupsRecipe for OctavesOptions {
    net_of!();

    fn expected_points(&self) -> f64 {
        match self.source {
            OctaveSource::Separate => {
                expected_in_series(&self.spacing, self.domain, self.octaves, self.lacunarity)
            }
            OctaveSource::Rescaled => self.spacing.expected_points(self.domain),
        }
    }

    fn build(&self, (): &(), seed: Seed) -> Result<PupsField, PupsError> {
        Ok(PupsField::numbers(octaves(self, seed)?.normalized()))
    }
}

impl PupsRecipe for TurbulenceOptions {
    net_of!(.0);

    fn expected_points(&self) -> f64 {
        self.0.expected_points()
    }

    fn build(&self, (): &(), seed: Seed) -> Result<PupsField, PupsError> {
        Ok(PupsField::numbers(turbulence(&self.0, seed)?.normalized()))
    }
}

/// Estimates the total number of control points in a series of layers, in which point distances are divided by
/// `factor` from layer to layer. Returns 0 for an invalid number of layers, which is an error when the layers are
/// built.
pub(super) fn expected_in_series(
    spacing: &Spacing,
    domain: Domain,
    count: u32,
    factor: f64,
) -> f64 {
    let count = if COUNT.holds(count.into()) { count } else { 0 };
    let scales = core::iter::successors(Some(1.0), |scale| Some(scale * factor));
    let scales = scales.take(count as usize);
    scales
        .map(|scale| spacing.finer(scale).expected_points(domain))
        .sum()
}
