//! What the recipes promise, each of them and all together.

mod common;
mod noise;
