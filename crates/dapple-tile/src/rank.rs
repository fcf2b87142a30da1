//! Values replaced by their ranks, so that a threshold covers its share of the area.
