//! B-splines, and the options of a spline filter.
//!
//! The spline of degree `d` is the box function of width 1, convolved `d` times with itself. Its width is `d + 1`. It
//! is a sum of `d + 2` splines of half the width, weighted by binomial coefficients (equation 4 of the paper).
//! Positions are in units of the distance between coefficients, and a spline is centered on its coefficient.
//!
//! Reference: Carl de Boor, "A Practical Guide to Splines", Springer 1978.

dapple_raster::named! {
    /// Degree of a B-spline.
    ///
    #[cfg_attr(doc, doc = include_str!("../docs/degree.md"))]
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
    pub enum Degree {
        /// Piecewise constant: the function of the Haar wavelet.
        Constant = "constant",
        /// Piecewise linear: tent functions.
        Linear = "linear",
        /// Piecewise quadratic: the choice of the paper, and of Cook and DeRose.
        #[default]
        Quadratic = "quadratic",
        /// Piecewise cubic: the smoothest of the four.
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
    /// Position of the coarse coefficients relative to the fine ones.
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
        /// Centered on the fine pixels. For even degrees, a coarse pixel covers exactly fine pixels `2j` and `2j + 1`,
        /// so images are not shifted. For odd degrees, a coarse pixel is centered on pixel `2j`.
        #[default]
        Centered = "centered",
        /// One fine pixel earlier than centered, as in the listing of Cook and DeRose (2005). A half-size image is
        /// shifted by one fine pixel.
        CookDeRose = "cook_de_rose",
    }
}

dapple_raster::named! {
    /// Extension of a line past its ends.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
    pub enum Border {
        /// Periodic extension: the line repeats. To be halved, a line must have an even length.
        #[default]
        Periodic = "periodic",
        /// Mirrored extension: the end pixel occurs twice for even degrees, and once for odd degrees.
        ///
        /// Halving a mirrored line gives a mirrored line. Only one copy of the values that repeat is stored. The number
        /// of values that remain of a line of `n` is:
        ///
        /// | degree | [`Centered`](Phase::Centered) | [`CookDeRose`](Phase::CookDeRose) |
        /// |---|---|---|
        /// | even | ⌈n/2⌉ | ⌊n/2⌋ + 1 |
        /// | odd | ⌈n/2⌉ | ⌊n/2⌋ |
        ///
        /// Lines of at least 2 values can be halved. In the Cook–DeRose phase, even degrees need at least 3, since a
        /// line of 2 would stay at 2.
        ///
        /// Coefficient `j` of the result is coefficient `j` in the table of [`Phase`], except for an odd degree in the
        /// Cook–DeRose phase, where it is coefficient `j + 1`.
        ///
        /// Each level mirrors its own line anew, by the rule above. One level equals that of the infinitely mirrored
        /// fine line. So do several levels if the phase is centered and every line that is halved, except the last, has
        /// an even length for an even degree, or an odd one for an odd degree. Otherwise the mirrors of the fine line
        /// are elsewhere in a coarse line than this rule assumes, and the result differs near the ends (for constant
        /// splines, not always).
        Mirror = "mirror",
    }
}

dapple_raster::named! {
    /// Distance that is minimized when a line is halved.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
    pub enum Fit {
        /// Integral of the squared difference of the two functions, as in the paper.
        #[default]
        Function = "function",
        /// Sum of the squared differences of the coefficients, minimized by `(HᵀH)⁻¹Hᵀ`.
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
    /// Degree of the spline.
    ///
    /// The default is quadratic.
    pub degree: Degree,
    /// Position of the coarse coefficients.
    ///
    /// The default is centered.
    pub phase: Phase,
    /// Distance measure that halving minimizes.
    ///
    /// The default is between the functions.
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
