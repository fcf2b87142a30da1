//! Blend maps from a texture's own features.
