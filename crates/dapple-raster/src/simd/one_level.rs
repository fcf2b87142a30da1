//! The single level without the feature `simd`.

#[doc(inline)]
pub use crate::simd_dispatch as dispatch;

/// The instruction set that the whole program is compiled for.
#[derive(Clone, Copy, Debug)]
pub struct Level;

impl Level {
    /// Returns the only level.
    #[must_use]
    pub const fn baseline() -> Self {
        Self
    }
}

/// Runs an operation at the only level.
#[doc(hidden)]
#[macro_export]
macro_rules! simd_dispatch {
    ($level:expr, $simd:ident => $op:expr) => {{
        let $simd: $crate::simd::Level = $level;
        $op
    }};
}

/// Returns the only level.
#[inline]
#[must_use]
pub const fn level() -> Level {
    Level
}

/// Calls `check` for the only level.
pub fn for_every_level(mut check: impl FnMut(Level)) {
    check(Level);
}
