//! Workspace-wide tests; they live in the test binary `it`.
