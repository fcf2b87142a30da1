//! Lit previews on the CPU.
