//! Tiling a map to any size.
