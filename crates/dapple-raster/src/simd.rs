//! Which SIMD level is used, and how tests go through all of them.
//!
//! For crates that fill rasters with the registers of `fearless_simd`: every level gives the same bits.

use fearless_simd::Level;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Mutex, OnceLock, PoisonError};

/// The index of the level that [`for_every_level`] asks for, or [`BEST`].
static CHOSEN: AtomicUsize = AtomicUsize::new(BEST);

/// No level is asked for.
const BEST: usize = usize::MAX;

/// The SIMD level to use: the best of this machine, looked up once, unless [`for_every_level`] asks for another.
#[inline]
#[must_use]
pub fn level() -> Level {
    static LEVEL: OnceLock<Level> = OnceLock::new();
    match CHOSEN.load(Ordering::Relaxed) {
        BEST => *LEVEL.get_or_init(Level::new),
        index => levels()[index],
    }
}

/// The levels that this machine has, from the least to the best, looked up once.
#[cold]
fn levels() -> &'static [Level] {
    static LEVELS: OnceLock<Vec<Level>> = OnceLock::new();
    LEVELS.get_or_init(|| {
        let mut levels = vec![Level::baseline()];
        let best = Level::new();
        #[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
        {
            levels.extend(best.as_sse4_2().map(Level::Sse4_2));
            levels.extend(best.as_avx2().map(Level::Avx2));
        }
        levels.push(best);
        levels
    })
}

/// Calls `check` for every level that this machine has, from the least to the best: what tests of equal bits do.
///
/// Meanwhile [`level`] gives that level in all threads, so that what has no level as an argument is checked as well.
/// Calls from several threads wait for each other; `check` must not call this function.
pub fn for_every_level(mut check: impl FnMut(Level)) {
    static ONE_AT_A_TIME: Mutex<()> = Mutex::new(());
    // After a check that failed, the next one begins anew.
    let _alone = ONE_AT_A_TIME.lock().unwrap_or_else(PoisonError::into_inner);
    for (index, &level) in levels().iter().enumerate() {
        CHOSEN.store(index, Ordering::Relaxed);
        check(level);
    }
    CHOSEN.store(BEST, Ordering::Relaxed);
}

#[cfg(test)]
mod tests {
    use super::{for_every_level, level};

    #[test]
    fn every_level_is_used_in_all_threads() {
        let mut names = Vec::new();
        for_every_level(|expected| {
            let expected = format!("{expected:?}");
            let found = std::thread::spawn(|| format!("{:?}", level())).join();
            assert_eq!(found.expect("a thread"), expected);
            names.push(expected);
        });
        assert_eq!(
            names.last(),
            Some(&format!("{:?}", fearless_simd::Level::new()))
        );
    }
}
