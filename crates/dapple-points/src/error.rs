//! Errors from creating and checking point sets.

use crate::{Domain, PointIdx};
use glam::DVec2;

dapple_raster::error! {
    /// An error from creating or checking a point set.
    PointsError,
    /// Cause of a [`PointsError`], with the limit and the value.
    PointsErrorKind {
        /// The origin of the domain is beyond 1e300, or a side is not above zero and at most 1e300, or is lost to
        /// rounding relative to the origin.
        Domain {
            /// The domain.
            domain: Domain,
        } =>
            "the domain from {} has size {}, but both sides must be above 0 and at most 1e300, and the origin between -1e300 \
             and 1e300, and near enough that adding a side moves it", domain.origin, domain.size;
        /// A position is not finite, or is outside the domain along an axis that does not wrap.
        Outside {
            /// Index of the point.
            point: PointIdx,
            /// Position of the point.
            position: DVec2,
        } => "point {} at {position} is not in the domain", point.0;
        /// The number of points would exceed the limit.
        TooMany {
            /// Approximate number of points needed.
            needed: f64,
            /// Maximum number of points.
            limit: u64,
        } => "about {needed:.0} points would be needed, but the limit is {limit}";
        /// A number is not above zero and finite, as required.
        NotPositive {
            /// Name of the invalid number, as in the message.
            what: &'static str,
            /// The invalid number.
            value: f64,
        } => "{what} is {value}, but it must be above 0 and finite";
        /// A radius that varies in space is not above zero and finite somewhere.
        Radius {
            /// The position where the radius was read.
            position: DVec2,
            /// Radius at the position.
            radius: f64,
        } => "the radius at {position} is {radius}, but it must be above 0 and finite";
        /// The slope of a radius that varies in space is 1 or more.
        TooSteep {
            /// The position where the radius is too steep.
            position: DVec2,
            /// Slope of the radius.
            slope: f64,
        } => "the radius changes by {slope} per distance near {position}, but it must change by less than 1";
        /// A wrapped axis is shorter than two radii, so a point would conflict with its own copy.
        PeriodTooShort {
            /// The axis, 0 or 1.
            axis: u32,
            /// The length of the axis.
            period: f64,
            /// The radius; the largest one if it varies.
            radius: f64,
        } => "axis {axis} wraps around after {period}, but it must reach over two radii of {radius}";
        /// Two given points are too close to each other.
        TooClose {
            /// The two points.
            points: [PointIdx; 2],
            /// Distance of the two points.
            distance: f64,
            /// Minimum distance.
            radius: f64,
        } => "points {} and {} are {distance} apart, but the radius is {radius}", points[0].0, points[1].0;
        /// A radius of a nested set is larger than the previous one.
        NotDescending {
            /// Index of the radius, starting at 0.
            level: usize,
            /// The radius.
            radius: f64,
            /// Previous radius.
            before: f64,
        } => "radius {level} is {radius}, but it must not be larger than the one before, {before}";
        /// A number is outside its range.
        OutOfRange {
            /// Name of the invalid number, as in the message.
            what: &'static str,
            /// The invalid number.
            value: f64,
            /// Allowed minimum and maximum.
            range: [f64; 2],
        } => "{what} is {value}, but it must be between {} and {}", range[0], range[1];
        /// A nonempty point set is required.
        NoPoints => "there is no point, but at least one is needed";
        /// Point sets that must share one domain have different domains.
        DifferentDomains {
            /// The domain of the first set.
            first: Domain,
            /// The domain of another set.
            other: Domain,
        } => "one set is in the domain from {} of size {} that wraps along x and y: {:?}, but the first one in that from {} of size \
             {}, wrapping: {:?}", other.origin, other.size, other.wrap, first.origin, first.size, first.wrap;
        /// The number of frequencies or rings of a spectrum would exceed the limit.
        TooManyFrequencies {
            /// Approximate number of frequencies or rings.
            needed: f64,
            /// Maximum number.
            limit: u64,
        } => "the spectrum would have about {needed:.0} frequencies or rings, but the limit is {limit}";
        /// The operation was canceled by the caller's callback.
        Cancelled => "the callback asked to stop";
    }
}
