//! The basis beside its oracle.

mod bits;
mod oracle;
