//! Materials as data: a recipe in TOML or JSON is a graph of named nodes, and its maps (height, normal, occlusion,
//! albedo, roughness and more) are baked from it at any size.
//!
//! The crate's README, `crates/dapple-recipe/README.md`, describes the format for authors of recipes. All options are
//! in its `docs/reference.md`, and in the output of `dapple recipe --reference`.
//!
//! ```
//! use dapple_recipe::{Bake, BakeOptions, Images, MapKind, Plan, Recipe};
//!
//! let recipe = Recipe::from_toml(
//!     r##"
//!     dapple = 1
//!     seed = 7
//!     extent = [8.0, 8.0]
//!
//!     [nodes.joint.worley]
//!     value = "f2_minus_f1"
//!
//!     [nodes.stones.levels]
//!     input = "joint"
//!     from = [0.04, 0.4]
//!     curve = "smooth"
//!
//!     [nodes.color.ramp]
//!     input = "stones"
//!     colors = ["#8a7450", "#8c857a"]
//!
//!     [material]
//!     height = "stones"
//!     albedo = "color"
//!     "##,
//! )?;
//! let plan = Plan::new(&recipe, &Images::new(), 0.0)?;
//! let maps = vec![MapKind::Height, MapKind::Normal, MapKind::Albedo];
//! let options = BakeOptions { size: [256, 256], maps, ..BakeOptions::default() };
//! for (kind, map) in Bake::new(&plan, &options)?.whole_maps()? {
//!     println!("{}: {:?} pixels, {} bytes for a GPU", kind.name(), map.size(), map.to_rgba8().len());
//! }
//! # Ok::<(), dapple_recipe::RecipeError>(())
//! ```
//!
//! A [`Recipe`] is data, a [`Plan`] is a recipe that has been validated and prepared for evaluation, and a [`Bake`]
//! renders the maps in bands. [`Recipe::builtin`] returns the built-in recipes, and [`Recipe::to_rust`] generates a
//! program that bakes a recipe.
//!
//! # Ways to use it
//!
//! A window, a band and the whole image have the same bits.
//!
//! | to get | call | cost |
//! |---|---|---|
//! | all maps, whole | [`Bake::whole_maps`] | memory for all pixels |
//! | all maps, band by band | [`Bake`] as an iterator | memory for a band, if no node depends on the whole tile |
//! | a part of an image | [`BakeOptions::region`] | |
//! | an image in parts, on any number of machines | [`Shards`] | no memory for the list |
//! | one node at any position, or in a window | [`Plan::field`], [`Plan::colors`], [`Plan::height`] | not for nodes
//! that depend on the whole tile |
//! | an image of one node | [`Plan::node_picture`] | |
//! | bytes and mip levels for a GPU | [`MapRows::to_rgba8`], [`MapRows::mip_levels`] | |
//! | progress, and a way to stop | [`Plan::new_with_progress`] | |
//! | redraw a recipe as it changes | [`Plan::new_with_cache`] with a [`PlanCache`] | only what changed |
//!
//! All maps of the built-in recipe `mountains` take 54.1 ms at 256 × 256 pixels, on one thread of a server processor
//! (AMD EPYC). Nodes that synthesize a texture (`synth`) do their work in [`Plan::new`], and nodes that depend on the
//! whole tile in [`Bake::new`].
//!
//! # Features
//!
//! | feature | default | effect |
//! |---|---|---|
//! | `rayon` | on | renders on all cores; the bits do not change |
//! | `schema` | off | describes recipes as JSON Schema (`Recipe::schema`) and as a reference of all options (`Recipe::reference`) |
//! | `image` | off | writes baked rows to files with the `RowWriter` of `dapple-image` |
//!
//! # Limits
//!
//! * A recipe has at most 1024 nodes and 4 MiB of text ([`MAX_TEXT`]). The parser does not panic on any text.
//! * A recipe may ask for any amount of work. [`PlanLimits`] bound it: if the estimated work exceeds a limit,
//!   [`Plan::new`] returns an error that names the node, before the work is done.
//! * Nodes that depend on the whole tile (`tile`, `disturb`, `match_borders`, `corner_tiles`, `equalize`, `flood_fill`,
//!   `blend_map`, most `blend`s) cannot be baked under [`BakeMemory::Banded`], and have no value at a single position.
//! * Nodes that depend on the neighborhood of a pixel (`blur`, `slope`, `curvature`, `occlusion`, …) can be baked under
//!   [`BakeMemory::Banded`], and have values in windows, but none at a single position. The sum of their halos is at
//!   most 2^15 pixels. Below a `warp`, `transform` or `fractal` they depend on the whole tile.
//! * The crate opens no files. Read images yourself, and pass them by name as [`Images`].
//! * A recipe of another format version than [`SCHEMA`] is an error.
//! * An error has the line and the column, or the node, and the nearest valid word.
//! * Maps have the same bits on every machine and any number of threads.
//!
//! # Without std
//!
//! Not possible today. A [`PlanCache`] is behind a `Mutex` of std, and the crates of the nodes need std.

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
mod shader;
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
    ImageSource, Images, NodeColors, NodeField, Picture, Plan, PlanCache, PlanLimits, Renderer,
    RendererError, Samples, Whole,
};
pub use recipe::{Material, Recipe, SCHEMA};
pub use shader::{FieldShader, MaterialShader, ShaderOptions, field_to_wgsl};
pub use text::{MAX_TEXT, Parameter, Parameters, read_options};
pub use values::Values;
pub use words::similar_words;
