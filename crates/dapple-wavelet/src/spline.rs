//! B-splines, and the options of a spline filter.
//!
//! The spline of degree `d` is the box function of width 1, convolved `d` times with itself. Its width is `d + 1`. It
//! is a sum of `d + 2` splines of half the width, weighted by binomial coefficients (equation 4 of the paper).
//! Positions are in units of the distance between coefficients, and a spline is centered on its coefficient.
//!
//! Reference: Carl de Boor, "A Practical Guide to Splines", Springer 1978.

dapple_raster::named! {
    /// The degree of a B-spline.
    ///
    #[cfg_attr(doc, doc = include_str!("../docs/degree.md"))]
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
    pub enum Degree {
        /// Steps: the Haar wavelet's own function.
        Constant = "constant",
        /// Tents.
        Linear = "linear",
        /// The paper's choice, and Cook and DeRose's.
        #[default]
        Quadratic = "quadratic",
        /// The smoothest of the four.
        Cubic = "cubic",
    }
}

impl Degree {
    /// Evaluates the B-spline centered on 0, which is the basis function φ of equations 1 to 4, at `x`.
    ///
    /// Values are at least 0, and the sum over all integer shifts is 1. The value is 0 at and beyond a distance of
    /// half the width `degree + 1`. At a discontinuity of the constant spline, it is the limit from the right.
    ///
    /// # Examples
    ///
    /// ```
    /// use dapple_wavelet::Degree;
    ///
    /// assert_eq!(Degree::Quadratic.value(0.0), 0.75);
    /// assert_eq!(Degree::Quadratic.value(1.0), 0.125);
    /// ```
    #[must_use]
    pub fn value(self, x: f64) -> f64 {
        let distance = x.abs();
        match self {
            Self::Constant if (-0.5..0.5).contains(&x) => 1.0,
            Self::Linear if distance < 1.0 => 1.0 - distance,
            Self::Quadratic if distance < 0.5 => 0.75 - x * x,
            Self::Quadratic if distance < 1.5 => 0.5 * (1.5 - distance) * (1.5 - distance),
            Self::Cubic if distance < 1.0 => 2.0 / 3.0 - x * x * (1.0 - 0.5 * distance),
            Self::Cubic if distance < 2.0 => {
                let rest = 2.0 - distance;
                rest * rest * rest / 6.0
            }
            _ => 0.0,
        }
    }

    /// Returns the derivative of [`value`](Self::value) at `x`. At a kink of the linear spline, this is the
    /// derivative from the right; for the constant spline, it is 0.
    #[must_use]
    pub fn derivative(self, x: f64) -> f64 {
        let distance = x.abs();
        let side = if x < 0.0 { 1.0 } else { -1.0 };
        match self {
            Self::Linear if (-1.0..1.0).contains(&x) => side,
            Self::Quadratic if distance < 0.5 => -2.0 * x,
            Self::Quadratic if distance < 1.5 => side * (1.5 - distance),
            Self::Cubic if distance < 1.0 => x * (1.5 * distance - 2.0),
            Self::Cubic if distance < 2.0 => side * 0.5 * (2.0 - distance) * (2.0 - distance),
            _ => 0.0,
        }
    }

    /// Returns the degree as a number.
    pub(crate) fn order(self) -> i64 {
        match self {
            Self::Constant => 0,
            Self::Linear => 1,
            Self::Quadratic => 2,
            Self::Cubic => 3,
        }
    }
}

dapple_raster::named! {
    /// Where the coarse coefficients lie over the fine ones.
    ///
    /// Coefficient `j` of the coarse line is spread over the fine coefficients `2j + first ..= 2j + last`:
    ///
    /// | degree | [`Centered`](Self::Centered) | [`CookDeRose`](Self::CookDeRose) |
    /// |---|---|---|
    /// | constant | 0 ..= 1 | −1 ..= 0 |
    /// | linear | −1 ..= 1 | −2 ..= 0 |
    /// | quadratic | −1 ..= 2 | −2 ..= 1 |
    /// | cubic | −2 ..= 2 | −3 ..= 1 |
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
    pub enum Phase {
        /// For even degrees, a coarse pixel covers exactly the fine pixels `2j` and `2j + 1`, so pictures do not move; for odd
        /// degrees it lies on pixel `2j`.
        #[default]
        Centered = "centered",
        /// One fine pixel earlier, as in the listing of Cook and DeRose (2005): a half-size picture is shifted by one fine pixel.
        CookDeRose = "cook_de_rose",
    }
}

dapple_raster::named! {
    /// How a line continues past its ends.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
    pub enum Border {
        /// The line repeats. To be halved, its length must be even.
        #[default]
        Periodic = "periodic",
        /// The line is mirrored: with the end pixel twice for even degrees, once for odd ones.
        ///
        /// The halved line of a mirrored one is mirrored too, and of what would repeat, one copy is kept. A line of `n` has, once
        /// halved, a length of
        ///
        /// | degree | [`Centered`](Phase::Centered) | [`CookDeRose`](Phase::CookDeRose) |
        /// |---|---|---|
        /// | even | ⌈n/2⌉ | ⌊n/2⌋ + 1 |
        /// | odd | ⌈n/2⌉ | ⌊n/2⌋ |
        ///
        /// Any length from 2 on can be halved; in the phase of Cook and DeRose, for even degrees, any from 3 on, since 2 would
        /// stay 2.
        ///
        /// Coefficient `j` of the result is coefficient `j` of the table of [`Phase`], but `j + 1` for an odd degree in the phase
        /// of Cook and DeRose.
        ///
        /// Each level mirrors its own line anew, by the rule above. One level equals that of the infinitely mirrored
        /// fine line. So do several levels if the phase is centered and every line that is halved, except the last, has
        /// an even length for an even degree, or an odd one for an odd degree. Otherwise the mirrors of the fine line
        /// lie elsewhere in a coarse line than this rule assumes, and near the ends the result differs; for steps, not
        /// always.
        Mirror = "mirror",
    }
}

dapple_raster::named! {
    /// The distance that is least when a line is halved.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
    pub enum Fit {
        /// The least integral of the squared difference of the two functions: the paper's sense.
        #[default]
        Function = "function",
        /// The least sum of the squared differences of the coefficients (`(HᵀH)⁻¹Hᵀ`).
        Coefficients = "coefficients",
    }
}

/// A pair of filters: `h` doubles a line and `a` halves it.
///
/// The default is the paper's pair: quadratic, pixel-centered, with a least-squares fit of the functions.
///
#[cfg_attr(doc, doc = include_str!("../docs/spline-filter.md"))]
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(default, deny_unknown_fields))]
pub struct SplineFilter {
    /// Degree of the spline [default: quadratic].
    pub degree: Degree,
    /// Position of the coarse coefficients [default: centered].
    pub phase: Phase,
    /// Distance measure that halving minimizes [default: between the functions].
    pub fit: Fit,
}

impl SplineFilter {
    /// Returns the index of the first fine coefficient that coarse coefficient 0 is spread over.
    pub(crate) fn first_tap(self) -> i64 {
        let centered = -((self.degree.order() + 1) / 2);
        match self.phase {
            Phase::Centered => centered,
            Phase::CookDeRose => centered - 1,
        }
    }
}

#[cfg(test)]
mod tests;
