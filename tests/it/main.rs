//! Workspace-wide tests, one binary.
