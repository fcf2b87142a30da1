//! A cache of texture parts, which are reused when a texture is rebuilt with other options, for example while a
//! slider is dragged.

use core::any::Any;
use core::fmt;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

/// A cache of texture parts, such as networks of control points, that several textures need in identical form.
///
/// Clones share the cache. The default cache stores nothing. A cache created by [`keeping`](Self::keeping) retains
/// the parts used in recent rounds.
///
/// # Examples
///
/// ```
/// use dapple_raster::Parts;
///
/// let parts = Parts::keeping();
/// let squares = |n: u32| {
///     parts.get_or_make(
///         |squares: &Vec<u32>| squares.len() == n as usize,
///         || Ok::<_, ()>((0..n).map(|i| i * i).collect()),
///     )
/// };
/// assert!(std::sync::Arc::ptr_eq(&squares(3)?, &squares(3)?));
/// # Ok::<(), ()>(())
/// ```
#[derive(Clone, Default)]
pub struct Parts {
    kept: Option<Arc<Mutex<Kept>>>,
}

/// Cached parts, each with the round of its last use.
#[derive(Default)]
struct Kept {
    parts: Vec<(Arc<dyn Any + Send + Sync>, u64)>,
    round: u64,
}

impl Parts {
    /// Creates a cache that retains parts until [`begin`](Self::begin) drops them.
    #[must_use]
    pub fn keeping() -> Self {
        Self {
            kept: Some(Arc::default()),
        }
    }

    /// Starts a round, and drops the parts that were not used in the last `max_age` rounds.
    pub fn begin(&self, max_age: u64) {
        if let Some(mut kept) = self.lock() {
            kept.round += 1;
            let now = kept.round;
            kept.parts.retain(|(_, used)| used + max_age >= now);
        }
    }

    /// Returns the cached part of type `T` for which `is_it` is true. If there is none, creates the part with `make`
    /// and caches it.
    ///
    /// `is_it` must be true only for parts with the same bits as the result of `make`.
    ///
    /// # Errors
    ///
    /// If `make` fails.
    pub fn get_or_make<T: Any + Send + Sync, E>(
        &self,
        is_it: impl Fn(&T) -> bool,
        make: impl FnOnce() -> Result<T, E>,
    ) -> Result<Arc<T>, E> {
        if let Some(found) = self.lock().and_then(|mut kept| kept.find(is_it)) {
            return Ok(found);
        }
        let made = Arc::new(make()?);
        if let Some(mut kept) = self.lock() {
            let round = kept.round;
            kept.parts.push((made.clone(), round));
        }
        Ok(made)
    }

    fn lock(&self) -> Option<MutexGuard<'_, Kept>> {
        let kept = self.kept.as_ref()?;
        Some(kept.lock().unwrap_or_else(PoisonError::into_inner))
    }
}

impl Kept {
    fn find<T: Any + Send + Sync>(&mut self, is_it: impl Fn(&T) -> bool) -> Option<Arc<T>> {
        let round = self.round;
        self.parts.iter_mut().find_map(|(part, used)| {
            let found = part.clone().downcast::<T>().ok()?;
            is_it(&found).then(|| {
                *used = round;
                found
            })
        })
    }
}

impl fmt::Debug for Parts {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("Parts")
    }
}

#[cfg(test)]
mod tests {
    use super::Parts;
    use std::sync::Arc;

    fn part(parts: &Parts, n: u32) -> Arc<u32> {
        parts
            .get_or_make(|&other| other == n, || Ok::<_, ()>(n))
            .unwrap()
    }

    #[test]
    fn parts_are_kept_for_as_many_rounds_as_asked() {
        let parts = Parts::keeping();
        let [old, used] = [1, 2].map(|n| part(&parts, n));
        for _ in 0..2 {
            parts.begin(1);
            assert!(Arc::ptr_eq(&used, &part(&parts, 2)));
        }
        assert!(!Arc::ptr_eq(&old, &part(&parts, 1)), "it was not used");
    }

    #[test]
    fn nothing_is_kept_by_default() {
        let parts = Parts::default();
        assert!(!Arc::ptr_eq(&part(&parts, 1), &part(&parts, 1)));
    }

    #[test]
    fn parts_of_other_types_are_no_answer_and_errors_are_not_kept() {
        let parts = Parts::keeping();
        let kept = part(&parts, 1);
        let failed = parts.get_or_make(|_: &u64| true, || Err::<u64, _>("no"));
        assert_eq!(failed, Err("no"));
        assert!(Arc::ptr_eq(&kept, &part(&parts, 1)));
    }
}
