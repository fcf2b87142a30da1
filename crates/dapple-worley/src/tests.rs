//! The basis beside its oracle.

mod bits;
mod doors;
mod forced;
mod lipschitz;
pub(crate) mod oracle;
mod properties;
mod statistics;
