//! Dispatches code by SIMD level.
//!
//! On processors with wide registers (nearly all x86-64 processors since 2013), the inner loops are compiled for each
//! kind of [metric](crate::metric) (sum of squares, sum, maximum) and for one and two nearest points. All other cases
//! share one loop that supports any metric and number. Minkowski's metric always uses that loop, since its powers are
//! so slow that wide registers gain nothing.

/// Runs an operation in wide registers and returns `Some(result)`. Returns `None` if the level has no wide registers.
#[cfg(target_arch = "x86_64")]
macro_rules! wide {
    ($level:expr, $simd:ident => $op:expr) => {{
        use fearless_simd::Simd as _;
        let level: fearless_simd::Level = $level;
        if let Some($simd) = level.as_avx512() {
            Some($simd.vectorize(
                #[inline(always)]
                || $op,
            ))
        } else if let Some($simd) = level.as_avx2() {
            Some($simd.vectorize(
                #[inline(always)]
                || $op,
            ))
        } else {
            None
        }
    }};
}

/// Runs an operation at the given SIMD level, and returns `Some(result)`. On this platform, every level counts as
/// wide.
#[cfg(not(target_arch = "x86_64"))]
macro_rules! wide {
    ($level:expr, $simd:ident => $op:expr) => {
        Some(dapple_raster::simd::dispatch!($level, $simd => $op))
    };
}

/// Returns whether a level has wide registers.
#[cfg(target_arch = "x86_64")]
pub(crate) fn is_wide(level: fearless_simd::Level) -> bool {
    level.as_avx2().is_some()
}

/// Returns whether a level has wide registers. On this platform, every level has them.
#[cfg(not(target_arch = "x86_64"))]
pub(crate) fn is_wide(_: fearless_simd::Level) -> bool {
    true
}

/// Runs an operation with the metric converted to a [`Measure`](crate::metric::Measure), at the widest SIMD level for
/// that metric.
macro_rules! measured {
    ($level:expr, $metric:expr, ($simd:ident, $measure:ident) => $op:expr) => {{
        let metric: crate::Metric = $metric;
        let done = match metric.kernel() {
            crate::metric::Kernel::General => None,
            _ => crate::levels::wide!($level, $simd => {
                let $measure = crate::metric::Exact(metric);
                $op
            }),
        };
        if done.is_none() {
            dapple_raster::simd::baseline!($simd => {
                let $measure = crate::metric::General(metric);
                $op
            });
        }
    }};
}

pub(crate) use {measured, wide};
