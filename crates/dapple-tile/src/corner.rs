//! Corner tiles: sets that fit in any order.
