//! The request of a caller to stop the work of a plan.

use crate::{RecipeError, RecipeErrorKind};
use std::fmt;
use std::sync::Arc;

/// The callback by which a caller asks to stop, if there is one.
#[derive(Clone, Default)]
pub(super) struct Cancel(Option<Arc<dyn Fn() -> bool + Send + Sync>>);

impl Cancel {
    /// Asks a callback.
    pub(super) fn by(is_cancelled: impl Fn() -> bool + Send + Sync + 'static) -> Self {
        Self(Some(Arc::new(is_cancelled)))
    }

    /// Fails if the caller asked to stop.
    pub(super) fn check(&self) -> Result<(), RecipeError> {
        match &self.0 {
            Some(is_cancelled) if is_cancelled() => {
                Err(RecipeError::new(RecipeErrorKind::Cancelled))
            }
            _ => Ok(()),
        }
    }
}

impl fmt::Debug for Cancel {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_tuple("Cancel").field(&self.0.is_some()).finish()
    }
}
