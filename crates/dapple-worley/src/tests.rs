//! The basis beside its oracle.

mod bits;
pub(crate) mod oracle;
