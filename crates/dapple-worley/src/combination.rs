//! Linear combinations of F1 to F4.
//!
//! Worley finds that differences of two or more of the distances have more character than F1 to F4 alone ("A Cellular
//! Texture Basis Function", SIGGRAPH 1996, <https://doi.org/10.1145/237170.237267>).

/// Linear combination of the distances F1 to F4: `C1·F1 + C2·F2 + C3·F3 + C4·F4`.
///
/// # Examples
///
/// ```
/// use dapple_worley::Combination;
///
/// assert_eq!(Combination::F2_MINUS_F1, Combination::new([-1.0, 1.0, 0.0, 0.0]));
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(transparent)
)]
pub struct Combination {
    coefficients: [f32; 4],
}

impl Combination {
    /// The distance to the nearest feature point. It looks like cones that meet in valleys.
    ///
    #[cfg_attr(doc, doc = include_str!("../docs/combination-f1.md"))]
    pub const F1: Self = Self::new([1.0, 0.0, 0.0, 0.0]);
    /// The distance to the second nearest feature point.
    ///
    #[cfg_attr(doc, doc = include_str!("../docs/combination-f2.md"))]
    pub const F2: Self = Self::new([0.0, 1.0, 0.0, 0.0]);
    /// The distance to the third nearest feature point.
    ///
    #[cfg_attr(doc, doc = include_str!("../docs/combination-f3.md"))]
    pub const F3: Self = Self::new([0.0, 0.0, 1.0, 0.0]);
    /// The distance to the fourth nearest feature point.
    ///
    #[cfg_attr(doc, doc = include_str!("../docs/combination-f4.md"))]
    pub const F4: Self = Self::new([0.0, 0.0, 0.0, 1.0]);
    /// `F2 − F1`, which is zero on the borders of the Voronoi cells. Suits cracks, veins and flagstones.
    ///
    #[cfg_attr(doc, doc = include_str!("../docs/combination-f2-minus-f1.md"))]
    pub const F2_MINUS_F1: Self = Self::new([-1.0, 1.0, 0.0, 0.0]);
    /// `F1 + F2`.
    ///
    #[cfg_attr(doc, doc = include_str!("../docs/combination-f1-plus-f2.md"))]
    pub const F1_PLUS_F2: Self = Self::new([1.0, 1.0, 0.0, 0.0]);
    /// `F3 − F1`.
    ///
    #[cfg_attr(doc, doc = include_str!("../docs/combination-f3-minus-f1.md"))]
    pub const F3_MINUS_F1: Self = Self::new([-1.0, 0.0, 1.0, 0.0]);
    /// `F3 − F2`.
    ///
    #[cfg_attr(doc, doc = include_str!("../docs/combination-f3-minus-f2.md"))]
    pub const F3_MINUS_F2: Self = Self::new([0.0, -1.0, 1.0, 0.0]);
    /// `F4 − F1`.
    ///
    #[cfg_attr(doc, doc = include_str!("../docs/combination-f4-minus-f1.md"))]
    pub const F4_MINUS_F1: Self = Self::new([-1.0, 0.0, 0.0, 1.0]);
    /// `F4 − F3`.
    ///
    #[cfg_attr(doc, doc = include_str!("../docs/combination-f4-minus-f3.md"))]
    pub const F4_MINUS_F3: Self = Self::new([0.0, 0.0, -1.0, 1.0]);
    /// `2·F3 − F2 − F1`, a combination from Worley's paper.
    ///
    #[cfg_attr(doc, doc = include_str!("../docs/combination-two-f3-minus-f2-minus-f1.md"))]
    pub const TWO_F3_MINUS_F2_MINUS_F1: Self = Self::new([-1.0, -1.0, 2.0, 0.0]);

    /// The named combinations. Their value ranges are known; see [`Cellular::normalized`](crate::Cellular::normalized).
    pub const NAMED: [(&'static str, Self); 11] = [
        ("F1", Self::F1),
        ("F2", Self::F2),
        ("F3", Self::F3),
        ("F4", Self::F4),
        ("F2 - F1", Self::F2_MINUS_F1),
        ("F1 + F2", Self::F1_PLUS_F2),
        ("F3 - F1", Self::F3_MINUS_F1),
        ("F3 - F2", Self::F3_MINUS_F2),
        ("F4 - F1", Self::F4_MINUS_F1),
        ("F4 - F3", Self::F4_MINUS_F3),
        ("2 F3 - F2 - F1", Self::TWO_F3_MINUS_F2_MINUS_F1),
    ];

    /// Creates a combination with the given coefficients of F1 to F4.
    ///
    #[cfg_attr(doc, doc = include_str!("../docs/combination-new.md"))]
    #[must_use]
    pub const fn new(coefficients: [f32; 4]) -> Self {
        Self { coefficients }
    }

    /// Returns the coefficients of F1 to F4.
    #[must_use]
    pub const fn coefficients(&self) -> [f32; 4] {
        self.coefficients
    }

    /// Returns the largest n for which the coefficient of `F_n` is nonzero; 1 if all are zero.
    #[must_use]
    pub fn depth(&self) -> usize {
        let last = self.coefficients.iter().rposition(|&part| part != 0.0);
        last.map_or(1, |last| last + 1)
    }

    /// Returns the combination of the distances F1, F2, …; there must be at least [`depth`](Self::depth) of them.
    ///
    /// Distances with a coefficient of zero are skipped, and products are added from F1 up.
    #[must_use]
    #[inline]
    pub fn of(&self, distances: &[f32]) -> f32 {
        let mut sum = 0.0;
        for (&coefficient, &distance) in self.coefficients.iter().zip(distances) {
            if coefficient != 0.0 {
                sum += coefficient * distance;
            }
        }
        sum
    }
}
