//! Copies of a tile that differ inside and agree on their borders.
