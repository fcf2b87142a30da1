//! What distance means: Euclidean, Manhattan, Chebyshev and Minkowski.
//!
//! Worley proposes the Manhattan metric for rigid rectangular regions ("A Cellular Texture Basis Function", SIGGRAPH
//! 1996, <https://doi.org/10.1145/237170.237267>). All four are joined from one term for each axis, so that a picture
//! can compute the terms of a column and of a row once. While searching, points are compared by the *key*, which
//! grows with the distance and is cheaper: the square, for the Euclidean metric.
//!
//! Terms are joined from the last axis to the first, in this order everywhere, so that the bits agree.

use crate::{WorleyError, WorleyErrorKind};
use fearless_simd::{f32x16, prelude::*};

/// How the distance between two positions is measured.
///
#[cfg_attr(doc, doc = include_str!("../docs/metric.md"))]
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(rename_all = "snake_case")
)]
#[non_exhaustive]
pub enum Metric {
    /// The straight line: `sqrt(dx² + dy² + …)`.
    #[default]
    Euclidean,
    /// Along the axes: `|dx| + |dy| + …`. Regions are rigidly rectangular.
    Manhattan,
    /// The longest of `|dx|`, `|dy|`, ….
    Chebyshev,
    /// `(|dx|^p + |dy|^p + …)^(1/p)` with `p` from 1, which is Manhattan, over 2, which is Euclidean, up to 10.
    Minkowski(f32),
}

/// The largest exponent: beyond it, the powers of a step and of 16 cells do not both fit into `f32`.
const LARGEST_EXPONENT: f32 = 10.0;

impl Metric {
    pub(crate) fn check(self) -> Result<Self, WorleyError> {
        match self {
            Self::Minkowski(p) if !(1.0..=LARGEST_EXPONENT).contains(&p) => {
                Err(WorleyError::new(WorleyErrorKind::Range {
                    what: "exponent of the Minkowski metric",
                    value: f64::from(p),
                    range: "from 1 to 10",
                }))
            }
            metric => Ok(metric),
        }
    }

    /// The length of a vector.
    #[must_use]
    pub fn length<const N: usize>(self, vector: [f32; N]) -> f32 {
        with_norm!(self, norm => norm.distance(norm.key(vector)))
    }

    /// The gradient of the length at a vector; zero where the vector is.
    ///
    /// Its parts lie in `[-1, 1]`. For [`Metric::Chebyshev`] it points along the longest axis, the first of several.
    #[must_use]
    pub fn gradient<const N: usize>(self, vector: [f32; N]) -> [f32; N] {
        let length = self.length(vector);
        if length.is_nan() || length <= 0.0 {
            return [0.0; N];
        }
        match self {
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

/// A metric that is known when the code is compiled.
///
/// Keys are never below zero, and they do not shrink when a difference grows; [`LOOSE`](Self::LOOSE) says how far
/// rounding may break that.
pub(crate) trait Norm: Copy + Send + Sync {
    /// What a key is multiplied by before it serves as a bound.
    const LOOSE: f32 = 1.0;

    /// Whether terms are joined by adding them, each rounded once at most.
    const IS_SUM: bool = false;

    fn term(self, difference: f32) -> f32;
    fn join(self, term: f32, rest: f32) -> f32;
    fn distance(self, key: f32) -> f32;
    fn terms<S: Simd, V: SimdFloat<S, Element = f32>>(self, difference: V) -> V;
    fn joins<S: Simd, V: SimdFloat<S, Element = f32>>(self, term: V, rest: V) -> V;
    fn distances<S: Simd>(self, key: f32x16<S>) -> f32x16<S>;

    /// The key of a vector.
    #[inline(always)]
    fn key<const N: usize>(self, differences: [f32; N]) -> f32 {
        let mut key = self.term(differences[N - 1]);
        for axis in (0..N - 1).rev() {
            key = self.join(self.term(differences[axis]), key);
        }
        key
    }

    /// The keys of sixteen vectors.
    #[inline(always)]
    fn keys<S: Simd, const N: usize>(self, differences: [f32x16<S>; N]) -> f32x16<S> {
        let mut key = self.terms(differences[N - 1]);
        for axis in (0..N - 1).rev() {
            key = self.joins(self.terms(differences[axis]), key);
        }
        key
    }

    /// See [`IS_SUM`](Self::IS_SUM).
    #[inline(always)]
    fn is_sum(self) -> bool {
        Self::IS_SUM
    }

    /// The key of a vector of this length along one axis.
    #[inline(always)]
    fn key_along_one_axis(self, length: f32) -> f32 {
        self.term(length)
    }

    /// A bound that holds for exact keys, made to hold for rounded ones.
    #[inline(always)]
    fn tightened(self, bound: f32) -> f32 {
        bound / Self::LOOSE
    }
}

#[derive(Clone, Copy)]
pub(crate) struct Euclidean;

impl Norm for Euclidean {
    const IS_SUM: bool = true;

    #[inline(always)]
    fn term(self, difference: f32) -> f32 {
        difference * difference
    }

    #[inline(always)]
    fn join(self, term: f32, rest: f32) -> f32 {
        term + rest
    }

    #[inline(always)]
    fn distance(self, key: f32) -> f32 {
        key.sqrt()
    }

    #[inline(always)]
    fn terms<S: Simd, V: SimdFloat<S, Element = f32>>(self, difference: V) -> V {
        difference * difference
    }

    #[inline(always)]
    fn joins<S: Simd, V: SimdFloat<S, Element = f32>>(self, term: V, rest: V) -> V {
        term + rest
    }

    #[inline(always)]
    fn distances<S: Simd>(self, key: f32x16<S>) -> f32x16<S> {
        key.sqrt()
    }
}

#[derive(Clone, Copy)]
pub(crate) struct Manhattan;

impl Norm for Manhattan {
    const IS_SUM: bool = true;

    #[inline(always)]
    fn term(self, difference: f32) -> f32 {
        difference.abs()
    }

    #[inline(always)]
    fn join(self, term: f32, rest: f32) -> f32 {
        term + rest
    }

    #[inline(always)]
    fn distance(self, key: f32) -> f32 {
        key
    }

    #[inline(always)]
    fn terms<S: Simd, V: SimdFloat<S, Element = f32>>(self, difference: V) -> V {
        difference.abs()
    }

    #[inline(always)]
    fn joins<S: Simd, V: SimdFloat<S, Element = f32>>(self, term: V, rest: V) -> V {
        term + rest
    }

    #[inline(always)]
    fn distances<S: Simd>(self, key: f32x16<S>) -> f32x16<S> {
        key
    }
}

#[derive(Clone, Copy)]
pub(crate) struct Chebyshev;

impl Norm for Chebyshev {
    #[inline(always)]
    fn term(self, difference: f32) -> f32 {
        difference.abs()
    }

    #[inline(always)]
    fn join(self, term: f32, rest: f32) -> f32 {
        if term > rest { term } else { rest }
    }

    #[inline(always)]
    fn distance(self, key: f32) -> f32 {
        key
    }

    #[inline(always)]
    fn terms<S: Simd, V: SimdFloat<S, Element = f32>>(self, difference: V) -> V {
        difference.abs()
    }

    #[inline(always)]
    fn joins<S: Simd, V: SimdFloat<S, Element = f32>>(self, term: V, rest: V) -> V {
        term.max(rest)
    }

    #[inline(always)]
    fn distances<S: Simd>(self, key: f32x16<S>) -> f32x16<S> {
        key
    }
}

/// The Minkowski metric with its exponent.
#[derive(Clone, Copy)]
pub(crate) struct Minkowski(pub(crate) f32);

/// Differences are scaled by this before their power, so that a step and 16 cells are about as far from the ends of
/// the range of `f32`.
const MINKOWSKI_SCALE: f32 = 256.0;

impl Norm for Minkowski {
    /// `powf` is good to an ulp or two, so larger differences can have smaller powers by as much; this is 80 ulps.
    const LOOSE: f32 = 1.000_01;

    #[inline(always)]
    fn term(self, difference: f32) -> f32 {
        libm::powf(difference.abs() * MINKOWSKI_SCALE, self.0)
    }

    #[inline(always)]
    fn join(self, term: f32, rest: f32) -> f32 {
        term + rest
    }

    #[inline(always)]
    fn distance(self, key: f32) -> f32 {
        libm::powf(key, 1.0 / self.0) * (1.0 / MINKOWSKI_SCALE)
    }

    #[inline(always)]
    fn terms<S: Simd, V: SimdFloat<S, Element = f32>>(self, difference: V) -> V {
        each_lane(difference, |difference| self.term(difference))
    }

    #[inline(always)]
    fn joins<S: Simd, V: SimdFloat<S, Element = f32>>(self, term: V, rest: V) -> V {
        term + rest
    }

    #[inline(always)]
    fn distances<S: Simd>(self, key: f32x16<S>) -> f32x16<S> {
        each_lane(key, |key| self.distance(key))
    }
}

#[inline(always)]
fn each_lane<S: Simd, V: SimdFloat<S, Element = f32>>(lanes: V, change: impl Fn(f32) -> f32) -> V {
    let mut values = [0.0; 16];
    let values = &mut values[..V::LEN];
    lanes.store_slice(values);
    for value in &mut *values {
        *value = change(*value);
    }
    V::from_slice(lanes.token(), values)
}

/// Evaluates an expression with the [`Norm`] of a [`Metric`].
macro_rules! with_norm {
    ($metric:expr, $norm:ident => $body:expr) => {
        match $metric {
            $crate::metric::Metric::Euclidean => {
                let $norm = $crate::metric::Euclidean;
                $body
            }
            $crate::metric::Metric::Manhattan => {
                let $norm = $crate::metric::Manhattan;
                $body
            }
            $crate::metric::Metric::Chebyshev => {
                let $norm = $crate::metric::Chebyshev;
                $body
            }
            $crate::metric::Metric::Minkowski(p) => {
                let $norm = $crate::metric::Minkowski(p);
                $body
            }
        }
    };
}
pub(crate) use with_norm;
