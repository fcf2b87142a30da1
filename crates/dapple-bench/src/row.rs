//! One line of the table: what was set side by side, what it took, and whether the bar is met.

use serde::Serialize;

/// Which way a ratio is read, and its bar.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Must {
    /// The time of the other side over the time of ours is at least this: ours is that many times faster.
    Faster(f64),
    /// The time of ours over the time of the other side is at most this: ours costs that many times as much.
    CostAtMost(f64),
    /// What ours has of something good over what the other side has of it is at least this.
    AtLeast(f64),
}

impl Must {
    /// The ratio of two times in this reading.
    pub(crate) fn ratio(self, ours: f64, theirs: f64) -> f64 {
        match self {
            Self::Faster(_) => theirs / ours,
            Self::CostAtMost(_) | Self::AtLeast(_) => ours / theirs,
        }
    }

    /// Whether a ratio meets the bar. A ratio that is not a number meets none.
    pub(crate) fn holds(self, ratio: f64) -> bool {
        match self {
            Self::Faster(bar) | Self::AtLeast(bar) => ratio >= bar,
            Self::CostAtMost(bar) => ratio <= bar,
        }
    }
}

/// What a row sets side by side.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Case {
    /// The group, which is also a filter: one of [`GROUPS`].
    pub(crate) group: &'static str,
    /// The job.
    pub(crate) case: &'static str,
    /// Whom ours is set beside.
    pub(crate) peer: &'static str,
    /// The unit of both times, see [`Unit`].
    pub(crate) unit: Unit,
    /// The bar.
    pub(crate) must: Must,
    /// What a reader has to know to read the row, or nothing.
    pub(crate) note: &'static str,
}

impl Case {
    /// Whether one of the filters selects this case, or there is none.
    ///
    /// The name of a group selects its cases; any other filter selects the cases that have it in their name or in
    /// their peer's.
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

    /// The row of this case from the seconds that one unit of work took each side, or from bytes, distances or angles.
    pub(crate) fn row(&self, ours: f64, theirs: f64) -> Row {
        let ratio = self.must.ratio(ours, theirs);
        let (must, at) = match self.must {
            Must::Faster(bar) | Must::AtLeast(bar) => (bar, "least"),
            Must::CostAtMost(bar) => (bar, "most"),
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

/// The groups, in the order of the table.
pub(crate) const GROUPS: [&str; 10] = [
    "pups", "points", "graph", "worley", "noise", "wavelet", "tile", "mesh", "synth", "recipe",
];

/// The unit of a time, or of what else is compared.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Unit {
    /// Nanoseconds for each pixel of the image.
    NsPerPixel,
    /// Nanoseconds for each point of the set that came out.
    NsPerPoint,
    /// Nanoseconds for each position asked.
    #[cfg_attr(
        not(feature = "peers"),
        expect(dead_code, reason = "only rows beside peers ask for positions")
    )]
    NsPerPosition,
    /// Microseconds for each neighborhood looked for.
    UsPerQuery,
    /// Milliseconds for the whole job.
    Ms,
    /// Seconds for the whole job.
    S,
    /// Megabytes of memory, 10^6 bytes each.
    Megabytes,
    /// A distance from 0 to 1, in thousandths.
    Thousandths,
    /// An angle.
    Degrees,
}

impl Unit {
    /// As it is printed.
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

    /// How many of this unit one second is, or one byte, a distance of 1, or a degree.
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

/// A measured row, as it is printed and written to JSON.
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
    /// The time of our side.
    pub(crate) ours: f64,
    /// The time of the other side.
    pub(crate) theirs: f64,
    /// Theirs over ours where the bar is `least` and times are compared, ours over theirs everywhere else.
    pub(crate) ratio: f64,
    /// The bar.
    pub(crate) must: f64,
    /// Whether the ratio is to be at `least` or at `most` the bar.
    pub(crate) at: &'static str,
    /// Whether the ratio meets the bar.
    pub(crate) holds: bool,
    /// What a reader has to know to read the row.
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
        must: Must::Faster(10.0),
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
            must: Must::CostAtMost(1.5),
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
            must: Must::AtLeast(0.5),
            ..CASE
        };
        let row = case.row(1.0, 2.0);
        assert!(row.holds, "half is half, not {}", row.ratio);
        assert_eq!(row.at, "least", "more is better");
        assert!(!case.row(0.9, 2.0).holds, "0.45 is less than half");
    }

    #[test]
    fn ratio_that_is_not_a_number_holds_no_bar() {
        assert!(!Must::Faster(1.0).holds(f64::NAN), "0 / 0 is not fast");
        assert!(!Must::CostAtMost(1.0).holds(f64::NAN), "0 / 0 is not cheap");
        assert!(!Must::AtLeast(1.0).holds(f64::NAN), "0 / 0 is not much");
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
