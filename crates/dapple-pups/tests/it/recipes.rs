//! Tests of the documented properties of the recipes.

mod assign;
mod bad_input;
mod common;
mod labels;
mod motion;
mod noise;
mod progression;
