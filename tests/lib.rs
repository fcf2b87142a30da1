//! Workspace-wide tests. They live in the test binary `it`; the code of the README is a test of this library.

#![forbid(unsafe_code)]

#[cfg(doctest)]
#[doc = include_str!("../README.md")]
mod readme {}
