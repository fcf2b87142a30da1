//! Recipes and materials as data: textures in TOML or JSON, and the maps that are baked from them.
#![forbid(unsafe_code)]

mod bake;
mod builtin;
mod error;
mod input;
mod nodes;
mod plan;
mod recipe;
mod rust;
#[cfg(feature = "schema")]
mod schema;
mod text;
mod values;
mod words;

pub use bake::{Bake, BakeMemory, BakeOptions, Band, MapKind, MapRows, Region, Shards};
pub use dapple_color as color;
pub use dapple_hash as hash;
pub use dapple_raster as raster;
pub use dapple_synth as synth;
pub use dapple_synth::Progress;
pub use dapple_tile as tile;
pub use error::{Place, RecipeError, RecipeErrorKind};
pub use indexmap;
pub use input::Input;
pub use nodes::*;
pub use plan::{
    ImageSource, Images, NodeColors, NodeField, Picture, Plan, PlanCache, PlanLimits, Samples,
    Whole,
};
pub use recipe::{Material, Recipe, SCHEMA};
pub use text::{MAX_TEXT, read_options};
pub use values::Values;
pub use words::similar_words;
