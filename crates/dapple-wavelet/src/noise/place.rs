//! Coordinates on a periodic tile, given by a cell and a fraction within it.
//!
//! All steps are exact, so that positions one period apart have the same tile coordinate, at any distance from the
//! origin.

/// At this distance and beyond, coordinates are reduced by a remainder, which is exact but slow. Below it, integers
/// and their products with the period are exact.
const FAR: f64 = (1_u64 << 50) as f64;

/// Adding and subtracting this constant rounds a number below 2^51 to an integer: the sum has no bits for a fraction.
const ROUND: f64 = (3_u64 << 51) as f64;

/// A period of an integer number of cells along an axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Period {
    cells: f64,
    inverse: f64,
}

/// A coordinate on the tile.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Place {
    /// Cell number: an integer from 0 (included) to the period (excluded).
    pub(super) cell: f64,
    /// Position within the cell, from 0 to 1. It is exactly 1 only for a coordinate just below an integer, where no
    /// closer fraction is representable.
    pub(super) fraction: f64,
}

impl Period {
    pub(super) fn new(cells: u32) -> Self {
        let cells = f64::from(cells);
        Self {
            cells,
            inverse: 1.0 / cells,
        }
    }

    /// Converts a position to tile coordinates, using one period per axis; `None` if the position is not finite.
    #[inline(always)]
    pub(super) fn places<const N: usize>(
        periods: [Self; N],
        mut position: [f64; N],
    ) -> Option<[Place; N]> {
        let mut places = [Place::ZERO; N];
        for axis in 0..N {
            // NaN is not near.
            let is_near = position[axis].abs() < FAR;
            if !is_near {
                position[axis] = periods[axis].bring_near(position[axis])?;
            }
        }
        for axis in 0..N {
            places[axis] = periods[axis].place(position[axis]);
        }
        Some(places)
    }

    /// Converts a coordinate to a tile coordinate; `None` if it is not finite.
    pub(super) fn place_of(self, coordinate: f64) -> Option<Place> {
        Self::places([self], [coordinate]).map(|[place]| place)
    }

    #[inline(always)]
    fn place(self, coordinate: f64) -> Place {
        let whole = floor(coordinate);
        Place {
            cell: self.wrap(whole),
            fraction: coordinate - whole,
        }
    }

    /// Wraps a cell number into the range from 0 to the period.
    #[inline(always)]
    pub(super) fn wrap(self, cell: f64) -> f64 {
        let rest = cell - round(cell * self.inverse) * self.cells;
        if rest < 0.0 { rest + self.cells } else { rest }
    }

    #[cold]
    #[inline(never)]
    fn bring_near(self, coordinate: f64) -> Option<f64> {
        coordinate.is_finite().then_some(coordinate % self.cells)
    }
}

impl Place {
    pub(super) const ZERO: Self = Self {
        cell: 0.0,
        fraction: 0.0,
    };

    /// Returns the cell number as an index.
    #[inline(always)]
    pub(super) fn index(self) -> usize {
        // The low bits of the sum contain the integer.
        (self.cell + (1_u64 << 52) as f64).to_bits() as u32 as usize
    }

    /// Returns the quadratic B-spline weights for the coefficients of the previous cell, this cell and the next cell.
    #[inline(always)]
    pub(super) fn weights(self) -> [f32; 3] {
        let after = self.fraction as f32;
        let before = 1.0 - after;
        [
            0.5 * before * before,
            0.5 + after * before,
            0.5 * after * after,
        ]
    }

    /// Returns the derivatives of [`weights`](Self::weights) with respect to the position in cells.
    #[inline(always)]
    pub(super) fn slopes(self) -> [f32; 3] {
        let after = self.fraction as f32;
        let before = 1.0 - after;
        [-before, before - after, after]
    }
}

/// Returns the largest integer not above `x`. `f64::floor` would be a function call on targets without an instruction
/// for it.
#[inline(always)]
pub(super) fn floor(x: f64) -> f64 {
    let near = round(x);
    if near > x { near - 1.0 } else { near }
}

/// Returns the nearest integer.
#[inline(always)]
fn round(x: f64) -> f64 {
    (x + ROUND) - ROUND
}

#[cfg(test)]
mod tests {
    use super::{FAR, Period, floor};
    use dapple_hash::{Seed, hash1, unit_f64};

    #[test]
    fn floor_equals_that_of_the_standard_library() {
        for index in 0..10_000 {
            let bits = hash1(Seed(1), [index], 0);
            let scale = (1_u64 << (index % 50)) as f64;
            let x = (unit_f64(bits) - 0.5) * scale;
            for x in [x, x.floor(), x.ceil(), x.floor() + 0.5] {
                assert_eq!(floor(x), x.floor(), "{x}");
            }
        }
        for x in [0.0, -0.0, 1e-300, -1e-300, -0.5, 0.5, 1.5, -1.5] {
            assert_eq!(floor(x), x.floor(), "{x}");
        }
    }

    #[test]
    fn places_of_whole_numbers_equal_those_of_integers() {
        for cells in [4, 6, 10, 100, 128, 1000, 11584, 8_388_606] {
            let period = Period::new(cells);
            for index in 0..2000 {
                let shift = 13 + index % 50;
                let whole = hash1(Seed(u64::from(cells)), [index], 0).cast_signed() >> shift;
                // Above 2^53, not every integer is representable.
                let x = whole as f64;
                let place = period.place_of(x).expect("the coordinate is finite");
                let expected = (x as i64).rem_euclid(i64::from(cells));
                assert_eq!((place.cell as i64, place.fraction), (expected, 0.0), "{x}");
                assert_eq!(place.index() as i64, expected, "{x}");
            }
        }
    }

    #[test]
    fn places_are_on_the_tile_at_the_ends_of_periods_and_at_the_limit() {
        let period = Period::new(6);
        let below = |x: f64| f64::from_bits(x.to_bits() - 1);
        for x in [6.0, 12.0, 6e9, FAR, 4.0 * FAR, 1e300, f64::MAX] {
            for x in [x, -x, below(x), -below(x)] {
                let place = period.place_of(x).expect("the coordinate is finite");
                assert!((0.0..6.0).contains(&place.cell), "{x}: {place:?}");
                assert!((0.0..=1.0).contains(&place.fraction), "{x}: {place:?}");
                assert_eq!(place.cell + place.fraction, x.rem_euclid(6.0), "{x}");
            }
        }
        let place = period.place_of(-1e-300).expect("the coordinate is finite");
        assert_eq!((place.cell, place.fraction), (5.0, 1.0));
    }

    #[test]
    fn no_place_is_where_a_coordinate_is_not_finite() {
        for x in [f64::NAN, -f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
            let places = Period::places([Period::new(8), Period::new(6)], [0.5, x]);
            assert_eq!(places, None, "{x}");
        }
    }
}
