//! What the recipes promise, each of them and all together.

mod assign;
mod bad_input;
mod common;
mod labels;
mod motion;
mod noise;
mod progression;
