//! Which SIMD level is used, and how tests go through all of them.

use fearless_simd::Level;
use std::sync::OnceLock;

/// The best level of this machine, looked up once.
#[inline]
pub(crate) fn level() -> Level {
    static LEVEL: OnceLock<Level> = OnceLock::new();
    *LEVEL.get_or_init(Level::new)
}

/// Calls `check` for every level that this machine has.
#[cfg(test)]
pub(crate) fn for_every_level(mut check: impl FnMut(Level)) {
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
