//! Why points were refused.

use crate::{Domain, PointIdx};
use core::fmt;
use glam::DVec2;

/// Why a point set was refused, or could not be made.
///
/// Match on [`kind`](Self::kind); the text is for people.
#[derive(Clone, Debug, PartialEq)]
pub struct PointsError {
    kind: PointsErrorKind,
}

/// The limit that was broken.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum PointsErrorKind {
    /// The origin of the domain is beyond 1e300, or a side is not above zero and at most 1e300.
    Domain {
        /// The domain.
        domain: Domain,
    },
    /// A position is not finite, or lies outside of the domain along an axis that does not wrap.
    Outside {
        /// Which point it is.
        point: PointIdx,
        /// Its position.
        position: DVec2,
    },
    /// More points would be needed than the limit allows.
    TooMany {
        /// About how many would be needed.
        needed: f64,
        /// How many are allowed.
        limit: u64,
    },
    /// A number that must be above zero and finite is not.
    NotPositive {
        /// What the number is.
        what: &'static str,
        /// The number.
        value: f64,
    },
    /// A radius that varies in space is not above zero and finite somewhere.
    Radius {
        /// Where.
        position: DVec2,
        /// The radius there.
        radius: f64,
    },
    /// A radius that varies in space does so by as much as the distance, or by more.
    TooSteep {
        /// Where.
        position: DVec2,
        /// By how much it changes per distance.
        slope: f64,
    },
    /// A wrapped axis is shorter than two radii, so that a point would meet its own copy.
    PeriodTooShort {
        /// The axis, 0 or 1.
        axis: u32,
        /// Its length.
        period: f64,
        /// The radius, the largest one if it varies.
        radius: f64,
    },
    /// Two given points are closer than they may be.
    TooClose {
        /// Which points they are.
        points: [PointIdx; 2],
        /// How far they are apart.
        distance: f64,
        /// How far they must be apart at least.
        radius: f64,
    },
    /// A radius of a nested set is larger than the one before.
    NotDescending {
        /// Which radius it is, from 0.
        level: usize,
        /// The radius.
        radius: f64,
        /// The one before.
        before: f64,
    },
    /// A number is outside of its range.
    OutOfRange {
        /// What the number is.
        what: &'static str,
        /// The number.
        value: f64,
        /// The smallest and the largest allowed.
        range: [f64; 2],
    },
    /// There is no set, or a set without points, where points are needed.
    NoPoints,
    /// Sets that must share one domain do not.
    DifferentDomains {
        /// The domain of the first set.
        first: Domain,
        /// The domain of another one.
        other: Domain,
    },
    /// A spectrum would have more frequencies, or rings, than the limit allows.
    TooManyFrequencies {
        /// About how many it would have.
        needed: f64,
        /// How many are allowed.
        limit: u64,
    },
}

impl PointsError {
    pub(crate) fn new(kind: PointsErrorKind) -> Self {
        Self { kind }
    }

    /// The limit that was broken.
    #[must_use]
    pub fn kind(&self) -> &PointsErrorKind {
        &self.kind
    }
}

impl fmt::Display for PointsError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        use PointsErrorKind as Kind;
        match &self.kind {
            Kind::Domain {
                domain: Domain { origin, size, .. },
            } => write!(
                f,
                "the domain from {origin} has size {size}, but both sides must be above 0 and at most 1e300, and the origin between -1e300 and 1e300"
            ),
            Kind::Outside { point, position } => {
                write!(f, "point {} at {position} is not in the domain", point.0)
            }
            Kind::Radius { position, radius } => write!(
                f,
                "the radius at {position} is {radius}, but it must be above 0 and finite"
            ),
            Kind::TooSteep { position, slope } => write!(
                f,
                "the radius changes by {slope} per distance near {position}, but it must change by less than 1"
            ),
            Kind::TooClose {
                points: [first, second],
                distance,
                radius,
            } => write!(
                f,
                "points {} and {} are {distance} apart, but the radius is {radius}",
                first.0, second.0
            ),
            Kind::DifferentDomains { first, other } => write!(
                f,
                "one set is in {other:?}, but the first one is in {first:?}"
            ),
            Kind::NoPoints => f.write_str("there is no point, but at least one is needed"),
            numbers => fmt_numbers(numbers, f),
        }
    }
}

/// The text for the kinds that are about numbers alone.
fn fmt_numbers(kind: &PointsErrorKind, f: &mut fmt::Formatter<'_>) -> fmt::Result {
    use PointsErrorKind as Kind;
    match kind {
        Kind::TooMany { needed, limit } => write!(
            f,
            "about {needed:.0} points would be needed, but the limit is {limit}"
        ),
        Kind::NotPositive { what, value } => {
            write!(f, "{what} is {value}, but it must be above 0 and finite")
        }
        Kind::PeriodTooShort {
            axis,
            period,
            radius,
        } => write!(
            f,
            "axis {axis} wraps around after {period}, but it must reach over two radii of {radius}"
        ),
        Kind::NotDescending {
            level,
            radius,
            before,
        } => write!(
            f,
            "radius {level} is {radius}, but it must not be larger than the one before, {before}"
        ),
        Kind::OutOfRange {
            what,
            value,
            range: [least, most],
        } => write!(
            f,
            "{what} is {value}, but it must be between {least} and {most}"
        ),
        Kind::TooManyFrequencies { needed, limit } => write!(
            f,
            "the spectrum would have about {needed:.0} frequencies or rings, but the limit is {limit}"
        ),
        other => write!(f, "{other:?}"),
    }
}

impl core::error::Error for PointsError {}
