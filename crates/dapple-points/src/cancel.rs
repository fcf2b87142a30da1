//! Cancellation callbacks.

use crate::{PointsError, PointsErrorKind};
use core::fmt;
use std::sync::Arc;

/// A callback that returns whether the caller has canceled the operation. It may be called on any thread, at most
/// every few milliseconds of work.
pub type IsCancelled<'a> = dyn Fn() -> bool + Sync + 'a;

/// A cancellation callback that texture options can store, unlike [`IsCancelled`], which is borrowed [default: none].
#[derive(Clone, Default)]
pub struct Cancel(Option<Arc<dyn Fn() -> bool + Send + Sync>>);

impl Cancel {
    /// Creates a handle from a callback that returns whether to cancel.
    #[must_use]
    pub fn by(is_cancelled: impl Fn() -> bool + Send + Sync + 'static) -> Self {
        Self(Some(Arc::new(is_cancelled)))
    }

    /// Returns whether the operation is canceled.
    #[must_use]
    pub fn is_cancelled(&self) -> bool {
        self.0.as_ref().is_some_and(|is_cancelled| is_cancelled())
    }
}

impl fmt::Debug for Cancel {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_tuple("Cancel").field(&self.0.is_some()).finish()
    }
}

/// Fails if the callback reports a cancellation.
pub(crate) fn check(is_cancelled: &IsCancelled) -> Result<(), PointsError> {
    cancelled(is_cancelled())
}

/// Fails if the operation is canceled.
pub(crate) fn cancelled(is_cancelled: bool) -> Result<(), PointsError> {
    match is_cancelled {
        true => Err(PointsError::new(PointsErrorKind::Cancelled)),
        false => Ok(()),
    }
}
