//! The basis beside its oracle.

mod oracle;
