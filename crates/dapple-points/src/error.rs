//! Errors of point sets.

use crate::{Domain, PointIdx};
use glam::DVec2;

dapple_raster::error! {
    /// An error of making or checking a point set.
    PointsError,
    /// The cause of a [`PointsError`], with the limit and the value.
    PointsErrorKind {
        /// The origin of the domain is beyond 1e300, or a side is not above zero and at most 1e300, or lost in rounding
        /// beside the origin.
        Domain {
            /// The domain.
            domain: Domain,
        } =>
            "the domain from {} has size {}, but both sides must be above 0 and at most 1e300, and the origin between -1e300 \
             and 1e300, and near enough that adding a side moves it", domain.origin, domain.size;
        /// A position is not finite, or lies outside of the domain along an axis that does not wrap.
        Outside {
            /// The index of the point.
            point: PointIdx,
            /// The position of the point.
            position: DVec2,
        } => "point {} at {position} is not in the domain", point.0;
        /// More points would be needed than the limit allows.
        TooMany {
            /// The number of points needed, about.
            needed: f64,
            /// The largest number of points allowed.
            limit: u64,
        } => "about {needed:.0} points would be needed, but the limit is {limit}";
        /// A number that must be above zero and finite is not.
        NotPositive {
            /// The name of the number.
            what: &'static str,
            /// The number.
            value: f64,
        } => "{what} is {value}, but it must be above 0 and finite";
        /// A radius that varies in space is not above zero and finite somewhere.
        Radius {
            /// The position where the radius was read.
            position: DVec2,
            /// The radius at that position.
            radius: f64,
        } => "the radius at {position} is {radius}, but it must be above 0 and finite";
        /// A radius that varies in space changes by as much as the distance, or by more.
        TooSteep {
            /// The position where the radius is too steep.
            position: DVec2,
            /// The change of the radius per distance.
            slope: f64,
        } => "the radius changes by {slope} per distance near {position}, but it must change by less than 1";
        /// A wrapped axis is shorter than two radii, so that a point would meet its own copy.
        PeriodTooShort {
            /// The axis, 0 or 1.
            axis: u32,
            /// The length of the axis.
            period: f64,
            /// The radius, the largest one if it varies.
            radius: f64,
        } => "axis {axis} wraps around after {period}, but it must reach over two radii of {radius}";
        /// Two given points are closer than they may be.
        TooClose {
            /// The two points.
            points: [PointIdx; 2],
            /// The distance of the two points.
            distance: f64,
            /// The smallest distance allowed.
            radius: f64,
        } => "points {} and {} are {distance} apart, but the radius is {radius}", points[0].0, points[1].0;
        /// A radius of a nested set is larger than the one before.
        NotDescending {
            /// The index of the radius, from 0.
            level: usize,
            /// The radius.
            radius: f64,
            /// The radius before it.
            before: f64,
        } => "radius {level} is {radius}, but it must not be larger than the one before, {before}";
        /// A number is outside of its range.
        OutOfRange {
            /// The name of the number.
            what: &'static str,
            /// The number.
            value: f64,
            /// The smallest and the largest number allowed.
            range: [f64; 2],
        } => "{what} is {value}, but it must be between {} and {}", range[0], range[1];
        /// A point is needed, but there is no set, or a set without points.
        NoPoints => "there is no point, but at least one is needed";
        /// Sets that must share one domain do not.
        DifferentDomains {
            /// The domain of the first set.
            first: Domain,
            /// The domain of another one.
            other: Domain,
        } => "one set is in the domain from {} of size {} that wraps along x and y: {:?}, but the first one in that from {} of size \
             {}, wrapping: {:?}", other.origin, other.size, other.wrap, first.origin, first.size, first.wrap;
        /// A spectrum would have more frequencies, or rings, than the limit allows.
        TooManyFrequencies {
            /// The number of frequencies or rings, about.
            needed: f64,
            /// The largest number allowed.
            limit: u64,
        } => "the spectrum would have about {needed:.0} frequencies or rings, but the limit is {limit}";
        /// The callback of the caller asked to stop.
        Cancelled => "the callback asked to stop";
    }
}
