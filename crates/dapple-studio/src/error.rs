//! The error type for requests of a page.

use core::fmt;
use dapple::recipe::RecipeError;

/// An error message for a refused request, with an optional hint and reason code.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct StudioError {
    message: String,
    hint: Option<String>,
    reason: Option<&'static str>,
}

impl StudioError {
    /// Creates an error with this message, which must be lower case and have no period at its end.
    pub fn new(message: impl Into<String>) -> Self {
        Self {
            message: message.into(),
            hint: None,
            reason: None,
        }
    }

    /// Adds a hint on how to avoid the error.
    #[must_use]
    pub fn with_hint(mut self, hint: impl Into<String>) -> Self {
        self.hint = Some(hint.into());
        self
    }

    /// Adds a reason code for programs.
    #[must_use]
    pub fn with_reason(self, reason: &'static str) -> Self {
        let reason = Some(reason);
        Self { reason, ..self }
    }

    /// Returns the reason code for programs, if the error has one.
    #[must_use]
    pub fn reason(&self) -> Option<&'static str> {
        self.reason
    }

    /// Returns the hint on how to avoid the error, if there is one.
    #[must_use]
    pub fn hint(&self) -> Option<&str> {
        self.hint.as_deref()
    }
}

impl fmt::Display for StudioError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.message)
    }
}

impl core::error::Error for StudioError {}

impl From<RecipeError> for StudioError {
    fn from(error: RecipeError) -> Self {
        Self::new(error.to_string())
    }
}
