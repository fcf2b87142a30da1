//! B-splines that refine themselves: what a filter is made of.

/// The degree of a B-spline.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(rename_all = "snake_case")
)]
pub enum Degree {
    /// Steps: the Haar wavelet's own function.
    Constant,
    /// Tents.
    Linear,
    /// The paper's choice, and Cook and DeRose's.
    #[default]
    Quadratic,
    /// The smoothest of the four.
    Cubic,
}

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
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(rename_all = "snake_case")
)]
pub enum Phase {
    /// For even degrees, a coarse pixel covers exactly the fine pixels `2j` and `2j + 1`, so pictures do not move; for odd
    /// degrees it lies on pixel `2j`.
    #[default]
    Centered,
    /// One fine pixel earlier, as in the listing of Cook and DeRose (2005): a half-size picture is shifted by one fine pixel.
    CookDeRose,
}

/// What lies past the ends of a line.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(rename_all = "snake_case")
)]
pub enum Border {
    /// The line repeats. Its length must be even.
    #[default]
    Periodic,
    /// The line is mirrored: with the end pixel twice for even degrees, once for odd ones. Any length from 2 on.
    Mirror,
}

/// What "nearest" means when a line is halved.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(rename_all = "snake_case")
)]
pub enum Fit {
    /// The least integral of the squared difference of the two functions: the paper's sense.
    #[default]
    Function,
    /// The least sum of the squared differences of the coefficients (`(HᵀH)⁻¹Hᵀ`).
    Coefficients,
}

/// A filter pair: `h` that doubles a line and `a` that halves it.
///
/// The default is the paper's: quadratic, pixel-centered, nearest as functions.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(default))]
pub struct SplineFilter {
    /// The degree of the spline. By default quadratic.
    pub degree: Degree,
    /// Where coarse coefficients lie. By default centered.
    pub phase: Phase,
    /// What is nearest. By default the function.
    pub fit: Fit,
}
