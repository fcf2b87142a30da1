//! sRGB and linear color, color ramps, and normal maps from heights.
