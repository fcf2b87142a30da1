//! Detects the machine's SIMD levels, based on `fearless_simd`.

#[doc(hidden)]
pub use fearless_simd;
pub use fearless_simd::Level;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Mutex, OnceLock, PoisonError};

#[doc(inline)]
pub use crate::{simd_baseline as baseline, simd_dispatch as dispatch};

/// Runs an operation at a SIMD level, like `fearless_simd::dispatch!`, but compiled for fewer levels.
///
/// On x86-64 the levels are SSE2, AVX2 and AVX-512. Nearly all processors with SSE4.2 have AVX2, and compiling a
/// fourth level for the others would add a quarter of the compile time. Builds with debug assertions have AVX-512 only
/// with `--cfg all_simd_levels`, because compile time dominates their tests.
#[doc(hidden)]
#[cfg(target_arch = "x86_64")]
#[macro_export]
macro_rules! simd_dispatch {
    ($level:expr, $simd:ident => $op:expr) => {{
        use $crate::simd::fearless_simd::Simd as _;
        let level: $crate::simd::fearless_simd::Level = $level;
        $crate::simd_avx512!(level, $simd => $op, else if let Some($simd) = level.as_avx2() {
            $simd.vectorize(
                #[inline(always)]
                || $op,
            )
        } else {
            $crate::simd_baseline!($simd => $op)
        })
    }};
}

/// Runs an operation with AVX-512, or else the code of the next level.
#[doc(hidden)]
#[cfg(all(target_arch = "x86_64", any(not(debug_assertions), all_simd_levels)))]
#[macro_export]
macro_rules! simd_avx512 {
    ($level:ident, $simd:ident => $op:expr, else $others:expr) => {
        if let Some($simd) = $level.as_avx512() {
            $simd.vectorize(
                #[inline(always)]
                || $op,
            )
        } else {
            $others
        }
    };
}

/// Runs the code of the next level, since AVX-512 is not compiled.
#[doc(hidden)]
#[cfg(all(target_arch = "x86_64", debug_assertions, not(all_simd_levels)))]
#[macro_export]
macro_rules! simd_avx512 {
    ($level:ident, $simd:ident => $op:expr, else $others:expr) => {
        $others
    };
}

/// Runs an operation at a SIMD level, like `fearless_simd::dispatch!`.
#[doc(hidden)]
#[cfg(not(target_arch = "x86_64"))]
#[macro_export]
macro_rules! simd_dispatch {
    ($level:expr, $simd:ident => $op:expr) => {
        $crate::simd::fearless_simd::dispatch!($level, $simd => $op)
    };
}

/// Runs an operation at the baseline SIMD level. Use it for code that gains little from wider registers.
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

/// Runs an operation at the baseline SIMD level. Use it for code that gains little from wider registers.
#[doc(hidden)]
#[cfg(not(target_arch = "x86_64"))]
#[macro_export]
macro_rules! simd_baseline {
    ($simd:ident => $op:expr) => {{
        use $crate::simd::fearless_simd;
        fearless_simd::dispatch!(fearless_simd::Level::baseline(), $simd => $op)
    }};
}

/// Index of the level forced by [`for_every_level`], or [`BEST`].
static CHOSEN: AtomicUsize = AtomicUsize::new(BEST);

/// Value of [`CHOSEN`] if no level is forced.
const BEST: usize = usize::MAX;

/// Returns the SIMD level to use. It is the best level of this machine that [`dispatch`] is compiled for (detected
/// once), unless [`for_every_level`] forces another level.
#[inline]
#[must_use]
pub fn level() -> Level {
    static LEVEL: OnceLock<Level> = OnceLock::new();
    match CHOSEN.load(Ordering::Relaxed) {
        BEST => *LEVEL.get_or_init(|| levels()[levels().len() - 1]),
        index => levels()[index],
    }
}

/// Returns the levels of this machine that [`dispatch`] is compiled for, from lowest to highest, detected once.
#[cold]
fn levels() -> &'static [Level] {
    static LEVELS: OnceLock<Vec<Level>> = OnceLock::new();
    LEVELS.get_or_init(|| {
        let best = Level::new();
        let mut levels = vec![Level::baseline()];
        #[cfg(target_arch = "x86_64")]
        {
            levels.extend(best.as_avx2().map(Level::Avx2));
            #[cfg(any(not(debug_assertions), all_simd_levels))]
            levels.extend(best.as_avx512().map(Level::Avx512));
        }
        #[cfg(not(target_arch = "x86_64"))]
        levels.push(best);
        levels
    })
}

/// Calls `check` for every level of this machine that [`dispatch`] is compiled for, from lowest to highest, to test
/// that all levels give the same bits.
///
/// During each call, [`level`] returns the tested level in all threads, so that code without a level argument is
/// tested as well. Concurrent calls wait for each other; `check` must not call this function.
pub fn for_every_level(mut check: impl FnMut(Level)) {
    static ONE_AT_A_TIME: Mutex<()> = Mutex::new(());
    // Ignore poisoning after a failed check.
    let _alone = ONE_AT_A_TIME.lock().unwrap_or_else(PoisonError::into_inner);
    for (index, &level) in levels().iter().enumerate() {
        CHOSEN.store(index, Ordering::Relaxed);
        check(level);
    }
    CHOSEN.store(BEST, Ordering::Relaxed);
}

#[cfg(test)]
mod tests {
    use super::{dispatch, for_every_level, level, levels};

    #[test]
    fn every_level_is_used_in_all_threads() {
        let mut names = Vec::new();
        for_every_level(|expected| {
            let expected = format!("{expected:?}");
            let found = std::thread::spawn(|| format!("{:?}", level())).join();
            assert_eq!(found.expect("a thread"), expected);
            names.push(expected);
        });
        assert_eq!(names.len(), levels().len());
    }

    #[test]
    fn every_level_is_the_one_that_is_dispatched() {
        for_every_level(|level| {
            let found = dispatch!(level, simd => simd.level());
            assert_eq!(format!("{found:?}"), format!("{level:?}"));
        });
    }

    #[cfg(all(target_arch = "x86_64", all_simd_levels))]
    #[test]
    fn avx512_is_among_all_levels() {
        let of_machine = fearless_simd::Level::new().as_avx512();
        let found = levels().iter().filter_map(|level| level.as_avx512());
        assert_eq!(found.count(), usize::from(of_machine.is_some()));
    }
}
