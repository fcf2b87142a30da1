//! Which SIMD level is used, and how tests go through all of them.
//!
//! For crates that fill rasters with the registers of `fearless_simd`: every level gives the same bits.

#[doc(hidden)]
pub use fearless_simd;
use fearless_simd::Level;
use std::sync::OnceLock;

#[doc(inline)]
pub use crate::{simd_baseline as baseline, simd_dispatch as dispatch};

/// Runs an operation with the registers of a level, as `fearless_simd::dispatch!` does, compiled for fewer levels.
///
/// On x86-64 these are SSE2, AVX2 and AVX-512. Nearly all processors with SSE4.2 have AVX2, and to compile everything a
/// fourth time for the others would take a quarter of the time that it takes to compile.
#[doc(hidden)]
#[cfg(target_arch = "x86_64")]
#[macro_export]
macro_rules! simd_dispatch {
    ($level:expr, $simd:ident => $op:expr) => {{
        use $crate::simd::fearless_simd::Simd as _;
        let level: $crate::simd::fearless_simd::Level = $level;
        if let Some($simd) = level.as_avx512() {
            $simd.vectorize(
                #[inline(always)]
                || $op,
            )
        } else if let Some($simd) = level.as_avx2() {
            $simd.vectorize(
                #[inline(always)]
                || $op,
            )
        } else {
            $crate::simd_baseline!($simd => $op)
        }
    }};
}

/// Runs an operation with the registers of a level, as `fearless_simd::dispatch!` does.
#[doc(hidden)]
#[cfg(not(target_arch = "x86_64"))]
#[macro_export]
macro_rules! simd_dispatch {
    ($level:expr, $simd:ident => $op:expr) => {
        $crate::simd::fearless_simd::dispatch!($level, $simd => $op)
    };
}

/// Runs an operation with the registers that every processor has: for what gains little from larger ones.
#[doc(hidden)]
#[cfg(target_arch = "x86_64")]
#[macro_export]
macro_rules! simd_baseline {
    ($simd:ident => $op:expr) => {{
        use $crate::simd::fearless_simd::Simd as _;
        let baseline = $crate::simd::fearless_simd::Level::baseline().as_sse2();
        let $simd = baseline.expect("SSE2 is a part of x86-64");
        $simd.vectorize(
            #[inline(always)]
            || $op,
        )
    }};
}

/// Runs an operation with the registers that every processor has: for what gains little from larger ones.
#[doc(hidden)]
#[cfg(not(target_arch = "x86_64"))]
#[macro_export]
macro_rules! simd_baseline {
    ($simd:ident => $op:expr) => {{
        use $crate::simd::fearless_simd;
        fearless_simd::dispatch!(fearless_simd::Level::baseline(), $simd => $op)
    }};
}

/// The best level of this machine, looked up once.
#[inline]
#[must_use]
pub fn level() -> Level {
    static LEVEL: OnceLock<Level> = OnceLock::new();
    *LEVEL.get_or_init(Level::new)
}

/// Calls `check` for every level that this machine has, from the least to the best: what tests of equal bits do.
pub fn for_every_level(mut check: impl FnMut(Level)) {
    let best = Level::new();
    check(Level::baseline());
    #[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
    {
        if let Some(token) = best.as_sse4_2() {
            check(Level::Sse4_2(token));
        }
        if let Some(token) = best.as_avx2() {
            check(Level::Avx2(token));
        }
    }
    check(best);
}
