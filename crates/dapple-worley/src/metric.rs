//! Metrics: Euclidean, Manhattan, Chebyshev and Minkowski.
//!
//! Worley proposes the Manhattan metric for rigid rectangular regions ("A Cellular Texture Basis Function", SIGGRAPH
//! 1996, <https://doi.org/10.1145/237170.237267>). Searches compare points by *key*, a monotone stand-in for the
//! distance that is cheaper to compute; for the Euclidean metric, it is the squared distance. A key is the sum (for
//! Chebyshev, the maximum) of one *term* for each axis, a function of the coordinate difference: `d²`, `|d|` or
//! `|d|^p`. Rendering can therefore compute the terms of a column and of a row once.
//!
//! Terms are accumulated from the last axis to the first, in the same order everywhere, so that the bits agree.

use crate::WorleyError;
use dapple_raster::{Range, range};
use fearless_simd::{f32x16, prelude::*};

/// Metric, which defines the distance between two positions.
///
#[cfg_attr(doc, doc = include_str!("../docs/metric.md"))]
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(rename_all = "snake_case")
)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub enum Metric {
    /// Euclidean distance: `sqrt(dx² + dy² + …)`.
    #[default]
    Euclidean,
    /// Sum along the axes: `|dx| + |dy| + …`. Regions are rigid rectangles.
    Manhattan,
    /// Maximum along the axes: the largest of `|dx|`, `|dy|`, ….
    Chebyshev,
    /// Minkowski distance of order `p`, from 1 to 10: `(|dx|^p + |dy|^p + …)^(1/p)`.
    ///
    /// The order 1 equals Manhattan, and 2 equals Euclidean.
    Minkowski(#[cfg_attr(feature = "schema", schemars(transform = { EXPONENT }))] f32),
}

/// Range of the exponent. Above 10, the powers of a step and of 16 cells do not both fit into `f32`.
const EXPONENT: Range = range!(from 1 to 10);

impl Metric {
    /// The metrics without a parameter, with their names in recipes and on the command line.
    pub const NAMED: [(&'static str, Self); 3] = [
        ("euclidean", Self::Euclidean),
        ("manhattan", Self::Manhattan),
        ("chebyshev", Self::Chebyshev),
    ];

    pub(crate) fn check(self) -> Result<Self, WorleyError> {
        match self {
            Self::Minkowski(exponent) => {
                let what = "exponent of the Minkowski metric";
                WorleyError::check_in(EXPONENT, what, exponent.into())?;
                Ok(self)
            }
            metric => Ok(metric),
        }
    }

    /// Returns the length of a vector.
    #[inline]
    #[must_use]
    pub fn length<const N: usize>(self, vector: [f32; N]) -> f32 {
        self.distance(self.key(vector))
    }

    /// Returns the gradient of the length with respect to the vector; zero at the zero vector.
    ///
    /// Its components are in `[-1, 1]`. For [`Metric::Chebyshev`] it is along the longest axis; if several are equally
    /// long, along the first of them.
    #[inline]
    #[must_use]
    pub fn gradient<const N: usize>(self, vector: [f32; N]) -> [f32; N] {
        let length = self.length(vector);
        if length.is_nan() || length <= 0.0 {
            return [0.0; N];
        }
        match self {
            // The unit vector from the feature point to the position, as in the paper.
            Self::Euclidean => vector.map(|part| part / length),
            Self::Manhattan => vector.map(sign),
            Self::Chebyshev => {
                let longest = vector.iter().position(|part| part.abs() == length);
                core::array::from_fn(|axis| {
                    if Some(axis) == longest {
                        sign(vector[axis])
                    } else {
                        0.0
                    }
                })
            }
            Self::Minkowski(p) => {
                // ∂|v| / ∂vᵢ = sign(vᵢ) · (|vᵢ| / |v|)^(p − 1)
                vector.map(|part| sign(part) * libm::powf(part.abs() / length, p - 1.0))
            }
        }
    }
}

fn sign(part: f32) -> f32 {
    if part == 0.0 {
        0.0
    } else {
        1.0_f32.copysign(part)
    }
}

// A metric accumulates one *term* for each axis, by adding the terms or by taking the largest. The result is the *key*
// of a vector. Keys are compared instead of distances; the Euclidean key is the squared distance. Keys are at least
// zero, and do not decrease when a difference grows; `rounding_slack` bounds the exceptions that rounding causes.
impl Metric {
    /// Returns a factor, at least 1. A bound on exact keys, multiplied by it, is valid for rounded keys.
    #[inline]
    pub(crate) fn rounding_slack(self) -> f32 {
        match self {
            // `powf` is accurate to an ulp or two, so the power of a larger difference can be too small by as much. The
            // factor allows 80 ulps.
            Self::Minkowski(_) => 1.000_01,
            Self::Euclidean | Self::Manhattan | Self::Chebyshev => 1.0,
        }
    }

    /// Returns whether a key is the sum of its terms, each of which is rounded at most once.
    #[inline(always)]
    pub(crate) fn is_exact_sum(self) -> bool {
        matches!(self, Self::Euclidean | Self::Manhattan)
    }

    /// Returns whether key terms are so slow to compute that SIMD gains nothing.
    #[inline]
    pub(crate) fn is_slow(self) -> bool {
        matches!(self, Self::Minkowski(_))
    }

    /// Returns the metric's number in shaders; `None` for Minkowski's metric, which shaders do not support.
    pub(crate) fn shader_word(self) -> Option<u32> {
        match self {
            Self::Euclidean => Some(0),
            Self::Manhattan => Some(1),
            Self::Chebyshev => Some(2),
            Self::Minkowski(_) => None,
        }
    }

    /// Returns the key term of a difference along one axis, in cells. It equals the key of a vector parallel to that
    /// axis.
    #[inline(always)]
    pub(crate) fn term(self, difference: f32) -> f32 {
        match self {
            Self::Euclidean => difference * difference,
            Self::Manhattan | Self::Chebyshev => difference.abs(),
            Self::Minkowski(p) => power(difference, p),
        }
    }

    /// Returns the key of a vector, the stand-in for its length.
    #[inline(always)]
    pub(crate) fn key<const N: usize>(self, differences: [f32; N]) -> f32 {
        let mut key = self.term(differences[N - 1]);
        for axis in (0..N - 1).rev() {
            key = self.accumulate(self.term(differences[axis]), key);
        }
        key
    }

    /// Accumulates the key term of one more axis into a key.
    #[inline(always)]
    pub(crate) fn accumulate(self, term: f32, key: f32) -> f32 {
        match self {
            Self::Chebyshev if term > key => term,
            Self::Chebyshev => key,
            Self::Euclidean | Self::Manhattan | Self::Minkowski(_) => term + key,
        }
    }

    /// Converts a key to a distance.
    #[inline(always)]
    pub(crate) fn distance(self, key: f32) -> f32 {
        match self {
            Self::Euclidean => key.sqrt(),
            Self::Manhattan | Self::Chebyshev => key,
            Self::Minkowski(p) => root(key, p),
        }
    }

    /// Lowers a bound on keys by the rounding slack. A key whose rounded value is below the result is exactly below
    /// `bound`.
    #[inline]
    pub(crate) fn tightened(self, bound: f32) -> f32 {
        bound / self.rounding_slack()
    }
}

/// The kinds of inner loops for wide registers.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Kernel {
    /// Loops specialized for [`Squares`].
    Squares,
    /// Loops specialized for [`Additive`].
    Sum,
    /// Loops specialized for [`Longest`].
    Longest,
    /// No loops for wide registers, since [`General`] is as fast.
    General,
}

impl Metric {
    /// Returns the kind of inner loops that this metric uses in wide registers.
    #[inline]
    pub(crate) fn kernel(self) -> Kernel {
        match self {
            Self::Euclidean => Kernel::Squares,
            Self::Manhattan => Kernel::Sum,
            Self::Chebyshev => Kernel::Longest,
            // Powers are so slow that wide registers gain nothing.
            Self::Minkowski(_) => Kernel::General,
        }
    }
}

/// A metric that operates on SIMD registers, for the inner loops. The default methods support all metrics except
/// Minkowski's.
pub(crate) trait Measure: Copy {
    /// Returns the metric, which is a compile-time constant for some types.
    fn metric(self) -> Metric;

    /// Returns the key terms of coordinate differences, in `C` registers.
    #[inline(always)]
    fn terms<S: Simd, V: SimdFloat<S, Element = f32>, const C: usize>(
        self,
        mut differences: [V; C],
    ) -> [V; C] {
        match self.metric() {
            Metric::Euclidean => {
                for i in 0..C {
                    differences[i] *= differences[i];
                }
            }
            // Powers are computed by `General`.
            Metric::Manhattan | Metric::Chebyshev | Metric::Minkowski(_) => {
                for i in 0..C {
                    differences[i] = differences[i].abs();
                }
            }
        }
        differences
    }

    /// Accumulates the key terms of one more axis into the keys.
    #[inline(always)]
    fn accumulate<S: Simd, V: SimdFloat<S, Element = f32>>(self, terms: V, keys: V) -> V {
        match self.metric() {
            Metric::Chebyshev => terms.max(keys),
            Metric::Euclidean | Metric::Manhattan | Metric::Minkowski(_) => terms + keys,
        }
    }

    /// Converts keys to distances.
    #[inline(always)]
    fn distances<S: Simd>(self, keys: f32x16<S>) -> f32x16<S> {
        match self.metric() {
            Metric::Euclidean => keys.sqrt(),
            // Roots are computed by `General`.
            Metric::Manhattan | Metric::Chebyshev | Metric::Minkowski(_) => keys,
        }
    }

    /// Computes the keys of sixteen vectors.
    #[inline(always)]
    fn keys<S: Simd, const N: usize>(self, differences: [f32x16<S>; N]) -> f32x16<S> {
        let terms = self.terms(differences);
        let mut key = terms[N - 1];
        for axis in (0..N - 1).rev() {
            key = self.accumulate(terms[axis], key);
        }
        key
    }
}

/// Any metric except Minkowski's, whose function calls would spill all registers of a loop.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Exact(pub(crate) Metric);

impl Measure for Exact {
    #[inline(always)]
    fn metric(self) -> Metric {
        self.0
    }
}

/// The Euclidean or the Manhattan metric, whose key is the sum of its terms.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Additive(pub(crate) Metric);

impl Measure for Additive {
    #[inline(always)]
    fn metric(self) -> Metric {
        self.0
    }

    #[inline(always)]
    fn accumulate<S: Simd, V: SimdFloat<S, Element = f32>>(self, terms: V, keys: V) -> V {
        terms + keys
    }
}

/// The Euclidean metric as a compile-time constant, for loops so short that a branch on the metric would slow them
/// down.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Squares;

impl Measure for Squares {
    #[inline(always)]
    fn metric(self) -> Metric {
        Metric::Euclidean
    }
}

/// The Chebyshev metric, whose key is the largest term.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Longest;

impl Measure for Longest {
    #[inline(always)]
    fn metric(self) -> Metric {
        Metric::Chebyshev
    }
}

/// Any metric. Minkowski's is computed lane by lane, through memory.
#[derive(Clone, Copy, Debug)]
pub(crate) struct General(pub(crate) Metric);

impl Measure for General {
    #[inline(always)]
    fn metric(self) -> Metric {
        self.0
    }

    #[inline(always)]
    fn terms<S: Simd, V: SimdFloat<S, Element = f32>, const C: usize>(
        self,
        mut differences: [V; C],
    ) -> [V; C] {
        let Metric::Minkowski(p) = self.0 else {
            return Exact(self.0).terms(differences);
        };
        for i in 0..C {
            differences[i] = each_lane(differences[i], p, power_each);
        }
        differences
    }

    #[inline(always)]
    fn distances<S: Simd>(self, keys: f32x16<S>) -> f32x16<S> {
        match self.0 {
            Metric::Minkowski(p) => each_lane(keys, p, root_each),
            metric => Exact(metric).distances(keys),
        }
    }
}

/// Factor applied to differences before they are raised to a power. It keeps both the power of a step and the power of
/// 16 cells in the range of `f32`.
const MINKOWSKI_SCALE: f32 = 256.0;

/// Returns the Minkowski key term of a difference.
fn power(difference: f32, p: f32) -> f32 {
    libm::powf(difference.abs() * MINKOWSKI_SCALE, p)
}

/// Converts a Minkowski key to a distance.
fn root(key: f32, p: f32) -> f32 {
    libm::powf(key, 1.0 / p) * (1.0 / MINKOWSKI_SCALE)
}

#[inline(never)]
fn power_each(differences: &mut [f32], p: f32) {
    for difference in differences {
        *difference = power(*difference, p);
    }
}

#[inline(never)]
fn root_each(keys: &mut [f32], p: f32) {
    for key in keys {
        *key = root(*key, p);
    }
}

/// Applies a function to the lanes of a register one by one, through memory. `p` is passed to the function.
#[inline(always)]
fn each_lane<S: Simd, V: SimdFloat<S, Element = f32>>(
    lanes: V,
    p: f32,
    change: fn(&mut [f32], f32),
) -> V {
    let mut values = [0.0; 16];
    let values = &mut values[..V::LEN];
    lanes.store_slice(values);
    change(values, p);
    V::from_slice(lanes.token(), values)
}
