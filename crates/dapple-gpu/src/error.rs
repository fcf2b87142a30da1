//! Errors from the GPU.

use core::fmt;
use dapple_recipe::RecipeError;

/// An error from a GPU.
///
/// Programs match on [`kind`](Self::kind); the message is for people.
#[derive(Clone, Debug, PartialEq)]
pub struct GpuError {
    kind: GpuErrorKind,
}

/// The cause of a [`GpuError`].
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum GpuErrorKind {
    /// No graphics adapter was found.
    NoAdapter {
        /// The message of `wgpu`.
        reason: String,
    },
    /// The device computes an operation with other bits than the CPU.
    NotExact {
        /// The operation.
        operation: &'static str,
    },
    /// No shader computes a node.
    NotInShader {
        /// The name of the node.
        node: String,
    },
    /// The device [compiles](crate::Gpu::compile_in_background) a shader in the background.
    Compiling,
    /// One row of pixels needs more memory than a buffer of the device may have, or a texture has too many pixels along a
    /// side.
    TooLarge {
        /// The name of the quantity.
        what: &'static str,
        /// The needed size.
        needed: u64,
        /// The limit of the device.
        limit: u64,
    },
    /// The device has too little memory.
    OutOfMemory,
    /// The device is lost, such as by a reset of the driver. A new device is needed.
    Lost {
        /// The operation that failed.
        during: &'static str,
    },
    /// The device or its driver refuses a shader or a command.
    Refused {
        /// The message of `wgpu`.
        reason: String,
    },
    /// An error from the recipe or its plan.
    Recipe(RecipeError),
}

impl GpuError {
    pub(crate) fn new(kind: GpuErrorKind) -> Self {
        Self { kind }
    }

    pub(crate) fn lost(during: &'static str) -> Self {
        Self::new(GpuErrorKind::Lost { during })
    }

    /// Returns an error if `needed` is above the limit of the device.
    pub(crate) fn check_limit(what: &'static str, needed: u64, limit: u64) -> Result<(), Self> {
        let error = GpuErrorKind::TooLarge {
            what,
            needed,
            limit,
        };
        (needed <= limit).then_some(()).ok_or(Self::new(error))
    }

    /// Returns the cause of the error.
    #[must_use]
    pub fn kind(&self) -> &GpuErrorKind {
        &self.kind
    }
}

impl fmt::Display for GpuError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match &self.kind {
            GpuErrorKind::NoAdapter { reason } => {
                write!(f, "there is no graphics adapter: {reason}")
            }
            GpuErrorKind::NotExact { operation } => {
                write!(
                    f,
                    "the GPU computes {operation} with other bits than the CPU"
                )
            }
            GpuErrorKind::NotInShader { node } => write!(f, "no shader computes the node `{node}`"),
            GpuErrorKind::Compiling => f.write_str("the GPU compiles a shader"),
            GpuErrorKind::TooLarge {
                what,
                needed,
                limit,
            } => write!(
                f,
                "the {what} is {needed}, but the limit of the GPU is {limit}"
            ),
            GpuErrorKind::OutOfMemory => f.write_str("the GPU has too little memory"),
            GpuErrorKind::Lost { during } => write!(f, "the GPU was lost during {during}"),
            GpuErrorKind::Refused { reason } => write!(f, "the GPU refused a command: {reason}"),
            GpuErrorKind::Recipe(error) => error.fmt(f),
        }
    }
}

impl core::error::Error for GpuError {
    fn source(&self) -> Option<&(dyn core::error::Error + 'static)> {
        match &self.kind {
            GpuErrorKind::Recipe(error) => Some(error),
            _ => None,
        }
    }
}

impl From<RecipeError> for GpuError {
    fn from(error: RecipeError) -> Self {
        Self::new(GpuErrorKind::Recipe(error))
    }
}
