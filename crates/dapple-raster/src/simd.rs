//! Which SIMD level is used, and how tests go through all of them.
//!
//! For crates that fill rasters with the registers of `fearless_simd`: every level gives the same bits.

use fearless_simd::Level;
use std::sync::OnceLock;

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
