//! Refusals of what a page asked for.

use core::fmt;
use dapple::recipe::RecipeError;

/// A refusal of what a page asked for, as a sentence for people.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct StudioError {
    message: String,
    hint: Option<String>,
    reason: Option<&'static str>,
}

impl StudioError {
    /// A refusal with this sentence, in lower case and without a full stop.
    pub fn new(message: impl Into<String>) -> Self {
        Self {
            message: message.into(),
            hint: None,
            reason: None,
        }
    }

    /// This refusal, with what to do about it.
    #[must_use]
    pub fn with_hint(mut self, hint: impl Into<String>) -> Self {
        self.hint = Some(hint.into());
        self
    }

    /// This refusal, with a word by which a program knows it.
    #[must_use]
    pub fn with_reason(self, reason: &'static str) -> Self {
        let reason = Some(reason);
        Self { reason, ..self }
    }

    /// The word by which a program knows it, if it has one.
    #[must_use]
    pub fn reason(&self) -> Option<&'static str> {
        self.reason
    }

    /// A way around it, if one is known.
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
