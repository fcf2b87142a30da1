//! Worley's cellular basis function.
