//! Blending textures: all maps of several materials by weights.
