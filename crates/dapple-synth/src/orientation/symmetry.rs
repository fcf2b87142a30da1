//! Rotational symmetry of an orientation field: the equivalent directions at a site, and the one nearest to a vector.
//!
//! A quarter turn rotates down to right, and right to up. Two quarter turns reverse a direction.

use core::ops::Neg;
use glam::{DVec2, DVec3};

dapple_raster::named! {
    /// Number of equally good directions of a texture at a position.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
    pub enum Symmetry {
        /// One direction, for textures with a distinct down direction.
        #[default]
        One = "1",
        /// Two directions, up and down, for textures that look alike upside down, such as bricks.
        Two = "2",
        /// Four directions, a quarter turn apart, for textures that also look alike on their side, such as a checker.
        Four = "4",
    }
}

impl Symmetry {
    /// Returns the rotations between equivalent directions, in quarter turns.
    pub(crate) fn quarters(self) -> &'static [u8] {
        match self {
            Self::One => &[0],
            Self::Two => &[0, 2],
            Self::Four => &[0, 1, 2, 3],
        }
    }

    /// Returns the number of quarter turns, among those the symmetry allows, whose rotation about `normal` brings
    /// `direction` nearest to `other`.
    #[inline]
    pub(crate) fn quarters_toward(self, direction: DVec3, normal: DVec3, other: DVec3) -> u8 {
        if self == Self::One {
            return 0;
        }
        // Components of `other` along the direction and along its quarter turn.
        let right = normal.cross(direction);
        self.quarters_to(DVec2::new(direction.dot(other), right.dot(other)))
    }

    /// Returns the number of quarter turns, among those the symmetry allows, whose rotation brings (1, 0) nearest to a
    /// vector. One quarter turn gives (0, 1). Ties go to 0, then to 2.
    #[inline]
    pub(crate) fn quarters_to(self, DVec2 { x, y }: DVec2) -> u8 {
        match self {
            Self::One => 0,
            Self::Two => 2 * u8::from(x < 0.0),
            Self::Four if x.abs() >= y.abs() => 2 * u8::from(x < 0.0),
            Self::Four => 1 + 2 * u8::from(y < 0.0),
        }
    }

    /// Returns the direction equivalent to `direction` that is nearest to `other`. Equivalent directions are rotations
    /// in the plane with the given normal.
    #[inline]
    pub(crate) fn nearest(self, direction: DVec3, normal: DVec3, other: DVec3) -> DVec3 {
        turned(
            direction,
            normal,
            self.quarters_toward(direction, normal, other),
        )
    }

    /// Returns the n-th power of a unit complex number, where n is the number of equivalent directions. All equivalent
    /// directions have the same power.
    pub(crate) fn power(self, number: DVec2) -> DVec2 {
        match self {
            Self::One => number,
            // Squaring doubles the angle, so opposite directions become equal.
            Self::Two => number.rotate(number),
            Self::Four => Self::Two.power(number.rotate(number)),
        }
    }

    /// Returns a unit complex number whose [`power`](Self::power) has the direction of `power`. `None` for zero.
    pub(crate) fn root(self, power: DVec2) -> Option<DVec2> {
        let unit = power.try_normalize()?;
        Some(match self {
            Self::One => unit,
            Self::Two => square_root(unit),
            Self::Four => square_root(square_root(unit)),
        })
    }
}

/// Returns the square root of a unit complex number, with a nonnegative real part.
fn square_root(unit: DVec2) -> DVec2 {
    // Half-angle formulas: compute the larger of cosine and sine, which has no cancellation, and derive the other.
    let [cos, sin] = [1.0 + unit.x, 1.0 - unit.x].map(|double| (0.5 * double.max(0.0)).sqrt());
    if cos >= sin {
        DVec2::new(cos, 0.5 * unit.y / cos)
    } else {
        DVec2::new(0.5 * unit.y.abs() / sin, sin.copysign(unit.y))
    }
}

/// Rotates `direction` about `normal` by `quarters` quarter turns.
#[inline]
pub(crate) fn turned(direction: DVec3, normal: DVec3, quarters: u8) -> DVec3 {
    match quarters {
        0 => direction,
        1 => normal.cross(direction),
        2 => -direction,
        _ => -normal.cross(direction),
    }
}

/// Converts an offset, to the right and down, in a square that was rotated by `quarters` quarter turns to the offset
/// before the rotation.
#[inline]
pub(crate) fn offset_before<T: Copy + Neg<Output = T>>([i, j]: [T; 2], quarters: u8) -> [T; 2] {
    match quarters {
        0 => [i, j],
        // Right was rotated to up, and down to right.
        1 => [j, -i],
        2 => [-i, -j],
        _ => [-j, i],
    }
}

/// Converts an offset, to the right and down, in a square to the offset after a rotation by `quarters` quarter turns.
/// Inverse of [`offset_before`].
#[inline]
pub(crate) fn offset_after<T: Copy + Neg<Output = T>>(offset: [T; 2], quarters: u8) -> [T; 2] {
    // Rotate by the same angle in the opposite direction.
    offset_before(offset, (4 - quarters) % 4)
}

#[cfg(test)]
mod tests {
    use super::*;
    use dapple_raster::Named as _;

    /// Returns the unit complex number of an angle in degrees.
    fn unit(degrees: f64) -> DVec2 {
        let (sin, cos) = libm::sincos(degrees.to_radians());
        DVec2::new(cos, sin)
    }

    #[test]
    fn nearest_turn_is_that_of_all_turns() {
        let normal = DVec3::new(0.6, 0.0, 0.8);
        let down = DVec3::Y;
        let right = normal.cross(down);
        for symmetry in Symmetry::ALL.iter().copied() {
            for degrees in 0..72 {
                let other = unit(5.0 * f64::from(degrees) + 1.0);
                let other = down * other.x + right * other.y;
                let found = symmetry.nearest(down, normal, other).dot(other);
                let all = symmetry.quarters().iter();
                let best = all.map(|&quarters| turned(down, normal, quarters).dot(other));
                let best = best.fold(-1.0, f64::max);
                assert!(
                    (found - best).abs() < 1e-12,
                    "{symmetry} {degrees}: {found} {best}"
                );
            }
        }
    }

    #[test]
    fn root_of_a_power_is_one_of_the_turns() {
        for symmetry in Symmetry::ALL.iter().copied() {
            for degrees in -40..=40 {
                let number = unit(4.5 * f64::from(degrees));
                let root = symmetry.root(symmetry.power(number)).unwrap();
                assert!(
                    (root.length() - 1.0).abs() < 1e-15,
                    "{symmetry} {degrees}: {root}"
                );
                // The number rotated by quarter turns: times 1, i, -1 and -i.
                let turns = [DVec2::X, DVec2::Y, DVec2::NEG_X, DVec2::NEG_Y];
                let quarters = symmetry.quarters().iter();
                let off = quarters.map(|&at| turns[usize::from(at)].rotate(number).distance(root));
                let off = off.fold(f64::INFINITY, f64::min);
                assert!(off < 1e-9, "{symmetry} {degrees}: {root} is off by {off}");
            }
            assert_eq!(symmetry.root(DVec2::ZERO), None);
        }
    }

    #[test]
    fn samples_move_as_directions_turn() {
        let normal = DVec3::Z;
        let (right, down) = (DVec3::X, DVec3::NEG_Y);
        assert_eq!(
            turned(down, normal, 1),
            right,
            "a quarter turn takes down to right"
        );
        for quarters in 0..4 {
            let [new_down, new_right] = [down, right].map(|at| turned(at, normal, quarters));
            for offset in [[2, 1], [-3, 2], [0, -1]] {
                let place =
                    |[i, j]: [i32; 2], right, down| right * f64::from(i) + down * f64::from(j);
                let before = place(offset_before(offset, quarters), right, down);
                assert_eq!(
                    place(offset, new_right, new_down),
                    before,
                    "{quarters} {offset:?}"
                );
            }
        }
    }
}
