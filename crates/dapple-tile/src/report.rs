//! How well a tile repeats, in numbers.
