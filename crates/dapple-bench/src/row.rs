//! One row of a table: the two sides, their measurements, and whether the goal is met.

use serde::Serialize;

/// A threshold for the ratio of both sides, and its direction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Goal {
    /// The other side's time divided by ours must be at least this, that is, ours is this many times faster.
    Faster(f64),
    /// Our time divided by the other side's must be at most this.
    CostAtMost(f64),
    /// Our quality measure divided by the other side's must be at least this.
    AtLeast(f64),
}

impl Goal {
    /// Returns the ratio that this goal limits, from the measurements of both sides.
    pub(crate) fn ratio(self, ours: f64, theirs: f64) -> f64 {
        match self {
            Self::Faster(_) => theirs / ours,
            Self::CostAtMost(_) | Self::AtLeast(_) => ours / theirs,
        }
    }

    /// Returns whether a ratio meets the threshold; false for NaN.
    pub(crate) fn holds(self, ratio: f64) -> bool {
        match self {
            Self::Faster(bar) | Self::AtLeast(bar) => ratio >= bar,
            Self::CostAtMost(bar) => ratio <= bar,
        }
    }
}

/// Description of a row: the two sides, the unit and the threshold.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Case {
    /// The group, which is also a filter: one of [`GROUPS`].
    pub(crate) group: &'static str,
    /// The name of the job.
    pub(crate) case: &'static str,
    /// The name of the other side.
    pub(crate) peer: &'static str,
    /// The unit of both measurements, see [`Unit`].
    pub(crate) unit: Unit,
    /// Threshold for the ratio.
    pub(crate) must: Goal,
    /// Note that helps a reader understand the row; empty if not needed.
    pub(crate) note: &'static str,
}

impl Case {
    /// Returns whether one of the filters selects this case, or there are no filters.
    ///
    /// The name of a group selects all its cases; any other filter selects the cases whose name or peer contains it.
    pub(crate) fn is_wanted(&self, filters: &[String]) -> bool {
        let is_group = |filter: &str| GROUPS.contains(&filter);
        filters.is_empty()
            || filters.iter().any(|filter| {
                if is_group(filter) {
                    self.group == filter
                } else {
                    self.case.contains(filter.as_str()) || self.peer.contains(filter.as_str())
                }
            })
    }

    /// Returns the measured row of this case. Both measurements are in base units: seconds per unit of work, bytes,
    /// distances or degrees.
    pub(crate) fn row(&self, ours: f64, theirs: f64) -> Row {
        let ratio = self.must.ratio(ours, theirs);
        let (must, at) = match self.must {
            Goal::Faster(bar) | Goal::AtLeast(bar) => (bar, "least"),
            Goal::CostAtMost(bar) => (bar, "most"),
        };
        Row {
            group: self.group,
            case: self.case,
            peer: self.peer,
            unit: self.unit.name(),
            ours: ours * self.unit.per_one(),
            theirs: theirs * self.unit.per_one(),
            ratio,
            must,
            at,
            holds: self.must.holds(ratio),
            note: self.note.to_owned(),
        }
    }
}

/// The groups in table order.
pub(crate) const GROUPS: [&str; 11] = [
    "pups", "points", "graph", "worley", "noise", "pattern", "wavelet", "tile", "mesh", "synth",
    "recipe",
];

/// Unit of a time or of another measure.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Unit {
    /// Nanoseconds for each pixel of the image.
    NsPerPixel,
    /// Nanoseconds for each point of the resulting set.
    NsPerPoint,
    /// Nanoseconds for each evaluated position.
    #[cfg_attr(
        not(feature = "peers"),
        expect(dead_code, reason = "only rows beside peers ask for positions")
    )]
    NsPerPosition,
    /// Microseconds for each searched neighborhood.
    UsPerQuery,
    /// Milliseconds for the whole job.
    Ms,
    /// Seconds for the whole job.
    S,
    /// Megabytes of memory, 10^6 bytes each.
    Megabytes,
    /// A distance from 0 to 1, in thousandths.
    Thousandths,
    /// An angle in degrees.
    Degrees,
}

impl Unit {
    /// Returns the name of the unit, as printed.
    pub(crate) const fn name(self) -> &'static str {
        match self {
            Self::NsPerPixel => "ns/pixel",
            Self::NsPerPoint => "ns/point",
            Self::NsPerPosition => "ns/position",
            Self::UsPerQuery => "µs/query",
            Self::Ms => "ms",
            Self::S => "s",
            Self::Megabytes => "MB",
            Self::Thousandths => "distance/1000",
            Self::Degrees => "degrees",
        }
    }

    /// Returns the conversion factor from the base unit (one second, one byte, a distance of 1, or one degree) to
    /// this unit.
    pub(crate) const fn per_one(self) -> f64 {
        match self {
            Self::NsPerPixel | Self::NsPerPoint | Self::NsPerPosition => 1e9,
            Self::UsPerQuery => 1e6,
            Self::Ms | Self::Thousandths => 1e3,
            Self::S | Self::Degrees => 1.0,
            Self::Megabytes => 1e-6,
        }
    }
}

/// A measured row, as printed and written to JSON.
#[derive(Clone, Debug, Serialize)]
pub(crate) struct Row {
    /// See [`Case::group`].
    pub(crate) group: &'static str,
    /// See [`Case::case`].
    pub(crate) case: &'static str,
    /// See [`Case::peer`].
    pub(crate) peer: &'static str,
    /// The unit of `ours` and `theirs`.
    pub(crate) unit: &'static str,
    /// The measurement of our side.
    pub(crate) ours: f64,
    /// The measurement of the other side.
    pub(crate) theirs: f64,
    /// The ratio that is compared with the threshold: their time divided by ours if our speed is measured, otherwise
    /// our measurement divided by theirs.
    pub(crate) ratio: f64,
    /// Threshold for the ratio.
    pub(crate) must: f64,
    /// Comparison with the threshold: the ratio must be at `least` or at `most` this value.
    pub(crate) at: &'static str,
    /// Whether the ratio meets the threshold.
    pub(crate) holds: bool,
    /// Note that helps a reader understand the row; empty if not needed.
    pub(crate) note: String,
}

#[cfg(test)]
mod tests {
    use super::*;

    const CASE: Case = Case {
        group: "points",
        case: "raster of 700 points",
        peer: "spade",
        unit: Unit::NsPerPixel,
        must: Goal::Faster(10.0),
        note: "",
    };

    #[test]
    fn faster_divides_theirs_by_ours_and_needs_at_least_the_bar() {
        let row = CASE.row(2e-9, 20e-9);
        assert!(
            (row.ratio - 10.0).abs() < 1e-12,
            "20 ns is ten times 2 ns, not {}",
            row.ratio
        );
        assert!(row.holds, "exactly ten times faster meets a bar of ten");
        assert!(!CASE.row(2.1e-9, 20e-9).holds, "9.5 times faster does not");
    }

    #[test]
    fn cost_divides_ours_by_theirs_and_needs_at_most_the_bar() {
        let case = Case {
            must: Goal::CostAtMost(1.5),
            ..CASE
        };
        let row = case.row(3.0, 2.0);
        assert!(
            (row.ratio - 1.5).abs() < 1e-12,
            "3 s is 1.5 times 2 s, not {}",
            row.ratio
        );
        assert!(row.holds, "exactly the bar is met");
        assert!(!case.row(3.2, 2.0).holds, "1.6 times the cost is too much");
    }

    #[test]
    fn at_least_divides_ours_by_theirs_and_needs_at_least_the_bar() {
        let case = Case {
            must: Goal::AtLeast(0.5),
            ..CASE
        };
        let row = case.row(1.0, 2.0);
        assert!(row.holds, "half is half, not {}", row.ratio);
        assert_eq!(row.at, "least", "more is better");
        assert!(!case.row(0.9, 2.0).holds, "0.45 is less than half");
    }

    #[test]
    fn ratio_that_is_not_a_number_holds_no_bar() {
        assert!(!Goal::Faster(1.0).holds(f64::NAN), "0 / 0 is not fast");
        assert!(!Goal::CostAtMost(1.0).holds(f64::NAN), "0 / 0 is not cheap");
        assert!(!Goal::AtLeast(1.0).holds(f64::NAN), "0 / 0 is not much");
    }

    #[test]
    fn times_are_in_the_unit_of_the_case() {
        let row = CASE.row(2e-9, 20e-9);
        assert!(
            (row.ours - 2.0).abs() < 1e-12,
            "2e-9 s are 2 ns, not {}",
            row.ours
        );
        let row = Case {
            unit: Unit::Ms,
            ..CASE
        }
        .row(0.25, 1.0);
        assert!(
            (row.ours - 250.0).abs() < 1e-12,
            "0.25 s are 250 ms, not {}",
            row.ours
        );
    }

    #[test]
    fn filter_selects_a_group_or_a_part_of_a_name() {
        let wanted = |filters: &[&str]| {
            CASE.is_wanted(&filters.iter().map(ToString::to_string).collect::<Vec<_>>())
        };
        assert!(wanted(&[]), "no filter selects all");
        assert!(wanted(&["points"]), "the case is of the group points");
        assert!(!wanted(&["pups"]), "a group selects only its own cases");
        assert!(
            wanted(&["pups", "raster"]),
            "one filter that fits is enough"
        );
        assert!(wanted(&["spade"]), "the name of the peer counts");
        let other = Case {
            group: "pups",
            ..CASE
        };
        assert!(
            !other.is_wanted(&["points".to_owned()]),
            "`points` is a group, though the case has it in its name"
        );
    }
}
