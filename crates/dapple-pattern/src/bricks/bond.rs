//! The bonds of bricks and the values at a position.

use super::BrickOptions;
use crate::PatternError;

dapple_raster::named! {
    /// Arrangement of bricks.
    ///
    /// A period holds a whole number of bricks and courses. Where courses alternate, their number is even, and where
    /// squares alternate, it is a multiple of the pattern's side.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub enum Bond {
        /// Courses of equal bricks, in columns. Any period.
        Stack = "stack" | "grid",
        /// Courses of equal bricks; every other course is shifted by `offset`. An even number of courses.
        #[default]
        Running = "running" | "stretcher",
        /// Long stretchers and short headers in turn, with headers centered over stretchers. A stretcher is twice as
        /// long as a header. An even number of bricks and of courses.
        Flemish = "flemish",
        /// Bricks of `length` squares, at right angles to each other in a zigzag. Multiples of twice the length.
        Herringbone = "herringbone",
        /// Blocks of `length` parallel bricks, in turn horizontal and vertical. Multiples of twice the length.
        Basket = "basket" | "basket_weave" | "parquet",
        /// Hexagons, with every other course shifted by half. An even number of courses.
        Hexagons = "hexagons" | "hexagon",
        /// Courses of boards with varied lengths and random offsets. Any period.
        Planks = "planks" | "boards",
        /// Courses that overlap the course below them, with half-round lower ends. An even number of courses.
        RoofTiles = "roof_tiles" | "scales",
        /// Courses that overlap the course below them, with straight lower ends whose corners have the radius
        /// `rounding`. An even number of courses.
        Slates = "slates" | "shingles",
    }
}

dapple_raster::named! {
    /// Value of bricks at a position.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub enum BrickValue {
        /// Height from 0 in the joints to 1 on the faces, with a smooth rise over the bevel. Roof tiles rise by half
        /// from course to course, and their lower ends lie above the next course by half.
        #[default]
        Height = "height",
        /// Distance to the nearest border of a brick in units of the plane: positive on bricks, negative in joints.
        EdgeDistance = "edge_distance",
        /// Random number of the brick, from 0 to below 1.
        Random = "random" | "cell_value",
        /// Second random number of the brick, independent of the first.
        Random2 = "random2",
        /// Third random number of the brick.
        Random3 = "random3",
        /// Position along the long axis of the face, from 0 to 1; clamped in the joints.
        U = "u",
        /// Position across the face, from 0 to 1; clamped in the joints.
        V = "v",
        /// Index of the column, a whole number modulo the period.
        Column = "column",
        /// Index of the course, a whole number modulo the period.
        Row = "row",
        /// Direction of the long axis: 0 for horizontal, 1 for vertical.
        Direction = "direction",
    }
}

impl Bond {
    /// Returns an error if a period does not suit the bond.
    pub(super) fn check_period(self, options: &BrickOptions) -> Result<(), PatternError> {
        let squares = (
            2 * options.length,
            "a multiple of twice the length of a brick",
        );
        let pairs = (2, "even, for courses or bricks alternate");
        let (columns, courses) = match self {
            Self::Stack | Self::Planks => ((1, "at least 1"), (1, "at least 1")),
            Self::Running | Self::Hexagons | Self::RoofTiles | Self::Slates => {
                ((1, "at least 1"), pairs)
            }
            Self::Flemish => (pairs, pairs),
            Self::Herringbone | Self::Basket => (squares, squares),
        };
        let what = [
            "number of bricks in the period",
            "number of courses in the period",
        ];
        for (axis, (factor, range)) in [columns, courses].into_iter().enumerate() {
            if let Some(period) = options.period[axis] {
                let holds = period > 0 && period % factor == 0;
                PatternError::check(holds, what[axis], period.into(), range)?;
            }
        }
        Ok(())
    }

    /// Returns the shorter side of the smallest brick, in units of the plane. The options give lengths in this unit.
    pub(super) fn shorter_side(self, [width, height]: [f64; 2]) -> f64 {
        match self {
            Self::Flemish => height.min(width * 2.0 / 3.0),
            // Variation halves the length of a plank at most.
            Self::Planks => height.min(width / 2.0),
            Self::Hexagons => {
                let diagonal = (width * width / 4.0 + height * height).sqrt();
                diagonal.min(width).min(2.0 * height)
            }
            _ => height.min(width),
        }
    }
}
