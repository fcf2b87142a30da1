//! Color ramps, which map numbers to colors.
//!
//! A ramp is a list of stops, each with a position and a color. Positions never decrease. Two stops at the same
//! position make a hard edge; at the position itself the later stop applies. Colors between stops are mixed in a
//! [`RampSpace`]. The colors of the stops are converted to this space when the ramp is created, so mixing in Oklab
//! computes no cube root per color.
//!
//! Reference: our own; for Oklab see `oklab.rs`.

use crate::oklab::linear_from_oklab;
use crate::srgb::{linear_from_srgb, srgb_from_linear};
use crate::{ColorError, ColorErrorKind, LinearRgb};
use dapple_raster::Raster;

/// A stop of a color ramp: a position and its color.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct ColorStop {
    /// Position, in the units of the numbers that the ramp maps; usually from 0 to 1.
    pub position: f32,
    /// Color at the position, linear.
    pub color: LinearRgb,
}

dapple_raster::named! {
    /// Interpolation between two stops of a color ramp.
    ///
    #[cfg_attr(doc, doc = include_str!("../docs/interpolation.md"))]
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
    #[non_exhaustive]
    pub enum Interpolation {
        /// Linear interpolation between two colors.
        #[default]
        Linear = "linear",
        /// Color of the previous stop, without interpolation. See [`ColorRamp::bands`] for bands of equal width.
        Stepped = "stepped",
        /// Smoothstep interpolation `3t² - 2t³`, without a kink at the stops.
        Smooth = "smooth",
    }
}

dapple_raster::named! {
    /// Color space in which a ramp mixes the colors of two stops.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
    #[non_exhaustive]
    pub enum RampSpace {
        /// Oklab (Ottosson 2020), in which equal steps look about equal. The midpoint of two colors is halfway in
        /// lightness and hue. Between two strong colors, a component may be a little below 0 or above 1, which files
        /// clamp.
        #[default]
        Oklab = "oklab",
        /// sRGB codes, as in most drawing programs. Negative components are converted like positive ones and keep their
        /// sign.
        Srgb = "srgb",
        /// Linear light, in which the light of lamps mixes. Use it for numbers that are not colors, or if black to
        /// white must be a straight line.
        Linear = "linear",
    }
}

dapple_raster::named! {
    /// Colors before the first stop and after the last stop.
    ///
    #[cfg_attr(doc, doc = include_str!("../docs/outside.md"))]
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
    #[non_exhaustive]
    pub enum Outside {
        /// Color of the nearest stop.
        #[default]
        Clamp = "clamp",
        /// The ramp repeats. The first color is used where one repeat ends and the next begins.
        Repeat = "repeat",
    }
}

/// A color ramp, which maps numbers to colors.
///
/// # Examples
///
/// ```
/// use dapple_color::{ColorRamp, LinearRgb, RampSpace};
///
/// let ramp = ColorRamp::from_hex(&["#000000", "#ffffff"])?;
/// assert_eq!(ramp.at(7.0), LinearRgb::WHITE);
/// assert_eq!(ramp.at(0.5).to_srgb::<u8>(), [99; 3], "half as light as white");
/// let ramp = ramp.with_space(RampSpace::Linear);
/// assert_eq!(ramp.at(0.25), LinearRgb::gray(0.25), "a quarter of its light");
/// # Ok::<(), dapple_color::ColorError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(try_from = "RampData", into = "RampData")
)]
pub struct ColorRamp {
    stops: Vec<ColorStop>,
    /// Colors of the stops, converted to the mixing space.
    mixed: Vec<[f64; 3]>,
    space: RampSpace,
    interpolation: Interpolation,
    outside: Outside,
}

/// A ramp as data, not yet validated.
#[cfg(feature = "serde")]
#[derive(serde::Serialize, serde::Deserialize)]
struct RampData {
    stops: Vec<ColorStop>,
    #[serde(default)]
    space: RampSpace,
    #[serde(default)]
    interpolation: Interpolation,
    #[serde(default)]
    outside: Outside,
}

impl ColorRamp {
    /// Creates a ramp through stops that interpolates linearly in Oklab and clamps outside.
    ///
    /// # Errors
    ///
    /// [`ColorErrorKind::NoStops`] if there is no stop, [`ColorErrorKind::NotFinite`] if a number is NaN or infinite,
    /// [`ColorErrorKind::Unsorted`] if a position is smaller than the one before it.
    pub fn new(stops: impl Into<Vec<ColorStop>>) -> Result<Self, ColorError> {
        let stops = stops.into();
        check(&stops)?;
        Ok(Self::unchecked(stops))
    }

    /// Creates a ramp through equally spaced colors, the first at 0 and the last at 1.
    ///
    /// # Errors
    ///
    /// [`ColorErrorKind::NoStops`] if there is no color, [`ColorErrorKind::NotFinite`] if a component is NaN or
    /// infinite.
    pub fn even(colors: &[LinearRgb]) -> Result<Self, ColorError> {
        Self::new(even_stops(colors))
    }

    /// Creates a ramp through equally spaced colors from 0 to 1. At least one color is required, and all must be
    /// finite.
    pub(crate) fn even_unchecked(colors: &[LinearRgb]) -> Self {
        Self::unchecked(even_stops(colors))
    }

    fn unchecked(stops: Vec<ColorStop>) -> Self {
        let ramp = Self {
            stops,
            mixed: Vec::new(),
            space: RampSpace::default(),
            interpolation: Interpolation::default(),
            outside: Outside::default(),
        };
        ramp.with_space(RampSpace::default())
    }

    /// Creates a ramp through equally spaced sRGB colors in hexadecimal, the first at 0 and the last at 1.
    ///
    /// # Errors
    ///
    /// [`ColorErrorKind::NoStops`] if there is no color, [`ColorErrorKind::Hex`] if a text is not a color.
    pub fn from_hex(colors: &[&str]) -> Result<Self, ColorError> {
        let colors: Result<Vec<_>, _> = colors
            .iter()
            .map(|text| LinearRgb::from_hex(text))
            .collect();
        Self::even(&colors?)
    }

    /// Creates a ramp of equally wide bands from 0 to 1, one per color, without mixing.
    ///
    /// # Errors
    ///
    /// [`ColorErrorKind::NoStops`] if there is no color, [`ColorErrorKind::NotFinite`] if a component is NaN or
    /// infinite.
    pub fn bands(colors: &[LinearRgb]) -> Result<Self, ColorError> {
        let count = colors.len() as f32;
        let stop = |(at, &color): (usize, &LinearRgb)| ColorStop {
            position: at as f32 / count,
            color,
        };
        let stops: Vec<ColorStop> = colors.iter().enumerate().map(stop).collect();
        Ok(Self::new(stops)?.with_interpolation(Interpolation::Stepped))
    }

    /// Sets the space in which the colors of two stops are mixed.
    #[must_use]
    pub fn with_space(self, space: RampSpace) -> Self {
        let colors = self.stops.iter().map(|stop| space.of_linear(stop.color));
        Self {
            mixed: colors.collect(),
            space,
            ..self
        }
    }

    /// Sets the interpolation between two stops.
    #[must_use]
    pub fn with_interpolation(self, interpolation: Interpolation) -> Self {
        Self {
            interpolation,
            ..self
        }
    }

    /// Sets the colors before the first stop and after the last.
    #[must_use]
    pub fn with_outside(self, outside: Outside) -> Self {
        Self { outside, ..self }
    }

    /// Returns the stops in order.
    #[must_use]
    pub fn stops(&self) -> &[ColorStop] {
        &self.stops
    }

    /// Returns the color for a number. NaN gets the first stop's color.
    #[must_use]
    pub fn at(&self, value: f32) -> LinearRgb {
        let value = self.bring_inside(value);
        // Number of stops at or before the value; the value is below the next stop.
        let count = self.stops.partition_point(|stop| stop.position <= value);
        let Some(before) = count.checked_sub(1).map(|at| self.stops[at]) else {
            return self.stops[0].color;
        };
        let Some(after) = self.stops.get(count) else {
            return before.color;
        };
        // Both terms are halved so that the difference of any two finite numbers is finite.
        let length = after.position * 0.5 - before.position * 0.5;
        let part = (value * 0.5 - before.position * 0.5) / length;
        match self.interpolation {
            Interpolation::Linear => self.mixture(count, part),
            Interpolation::Stepped => before.color,
            Interpolation::Smooth => self.mixture(count, part * part * (3.0 - 2.0 * part)),
        }
    }

    /// Mixes stop `to` with the stop before it; `part` is 0 at the earlier stop and 1 at stop `to`.
    fn mixture(&self, to: usize, part: f32) -> LinearRgb {
        let from = to - 1;
        let (before, after) = (self.stops[from].color, self.stops[to].color);
        if self.space == RampSpace::Linear {
            return before.lerp(after, part);
        }
        // The conversion to the space and back rounds, so the colors of stops are returned unchanged.
        if part == 0.0 || before == after {
            return before;
        }
        let (before, after, part) = (self.mixed[from], self.mixed[to], f64::from(part));
        let mix = |axis: usize| before[axis] * (1.0 - part) + after[axis] * part;
        self.space.to_linear([mix(0), mix(1), mix(2)])
    }

    /// Maps a raster of numbers to colors. Uses all cores if the feature `rayon` is enabled.
    #[must_use]
    pub fn apply(&self, values: &Raster<f32>) -> Raster<LinearRgb> {
        values.par_map(|&value| self.at(value))
    }

    /// Maps a number into the range of the stops without changing its color. With [`Outside::Clamp`], returns the
    /// number itself.
    fn bring_inside(&self, value: f32) -> f32 {
        let [first, last] =
            [self.stops[0], self.stops[self.stops.len() - 1]].map(|stop| stop.position);
        let inside = value >= first && value < last;
        if self.outside == Outside::Clamp || inside || !value.is_finite() || first == last {
            return value;
        }
        // In `f64` the difference of two `f32` cannot overflow.
        let (first, last, value) = (f64::from(first), f64::from(last), f64::from(value));
        let wrapped = first + (value - first).rem_euclid(last - first);
        // Rounding may reach the last stop, where the ramp starts again.
        let wrapped = wrapped as f32;
        if f64::from(wrapped) < last {
            wrapped
        } else {
            first as f32
        }
    }
}

impl RampSpace {
    /// Converts a color to this mixing space.
    fn of_linear(self, color: LinearRgb) -> [f64; 3] {
        match self {
            Self::Oklab => color.to_oklab(),
            Self::Srgb => color
                .to_array()
                .map(|part| signed(part.into(), srgb_from_linear)),
            Self::Linear => color.to_array().map(f64::from),
        }
    }

    /// Converts components in this mixing space to a color.
    fn to_linear(self, parts: [f64; 3]) -> LinearRgb {
        match self {
            Self::Oklab => linear_from_oklab(parts),
            Self::Srgb => parts
                .map(|part| signed(part, linear_from_srgb) as f32)
                .into(),
            Self::Linear => parts.map(|part| part as f32).into(),
        }
    }
}

/// Extends a curve for nonnegative numbers to negative ones as an odd function.
fn signed(value: f64, curve: fn(f64) -> f64) -> f64 {
    curve(value.abs()).copysign(value)
}

fn even_stops(colors: &[LinearRgb]) -> Vec<ColorStop> {
    let last = colors.len().saturating_sub(1).max(1) as f32;
    let stop = |(at, &color): (usize, &LinearRgb)| ColorStop {
        position: at as f32 / last,
        color,
    };
    colors.iter().enumerate().map(stop).collect()
}

fn check(stops: &[ColorStop]) -> Result<(), ColorError> {
    if stops.is_empty() {
        return Err(ColorError::new(ColorErrorKind::NoStops));
    }
    let not_finite = |what, value: f32| {
        let value = f64::from(value);
        Err(ColorError::new(ColorErrorKind::NotFinite { what, value }))
    };
    for stop in stops {
        if !stop.position.is_finite() {
            return not_finite("position of a stop", stop.position);
        }
        if let Some(part) = stop
            .color
            .to_array()
            .into_iter()
            .find(|part| !part.is_finite())
        {
            return not_finite("color of a stop", part);
        }
    }
    for pair in stops.windows(2) {
        let [before, position] = [pair[0].position, pair[1].position];
        if position < before {
            return Err(ColorError::new(ColorErrorKind::Unsorted {
                position,
                before,
            }));
        }
    }
    Ok(())
}

#[cfg(feature = "serde")]
impl TryFrom<RampData> for ColorRamp {
    type Error = ColorError;

    fn try_from(data: RampData) -> Result<Self, ColorError> {
        let ramp = Self::new(data.stops)?.with_space(data.space);
        let ramp = ramp.with_interpolation(data.interpolation);
        Ok(ramp.with_outside(data.outside))
    }
}

#[cfg(feature = "serde")]
impl From<ColorRamp> for RampData {
    fn from(ramp: ColorRamp) -> Self {
        Self {
            stops: ramp.stops,
            space: ramp.space,
            interpolation: ramp.interpolation,
            outside: ramp.outside,
        }
    }
}

#[cfg(test)]
mod tests;
