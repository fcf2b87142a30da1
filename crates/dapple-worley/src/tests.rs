//! The basis beside its oracle.

mod bits;
mod doors;
mod forced;
pub(crate) mod oracle;
