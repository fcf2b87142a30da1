//! Blending in bands, with a mask that is sharper where details are finer.
