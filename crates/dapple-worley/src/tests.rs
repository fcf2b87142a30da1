//! The basis beside its oracle.

mod bits;
mod doors;
mod edges;
mod far_away;
mod forced;
mod fractal;
mod lipschitz;
mod many;
pub(crate) mod oracle;
mod properties;
#[cfg(feature = "serde")]
mod serialized;
mod sheet;
mod stability;
mod statistics;
mod threads;
mod varying;
