//! Unlike tiles that fit beside each other.
