//! Patterns of bricks, woven threads, shapes and scattered stamps for walls, floors, cloth and ground: exact periods, any
//! position, and the same bits on every machine.
//!
//! A pattern has several values at a position, such as the height, a random number of the brick, and the coordinates on
//! it. Each is a [`Field`](dapple_raster::Field), so that [`FieldExt`](dapple_raster::FieldExt) composes it.
//!
//! ```
//! use dapple_pattern::{Bond, BrickOptions, BrickValue, Bricks, hash::Seed};
//! use dapple_pattern::raster::prelude::*;
//!
//! // A wall of 4 × 12 bricks on a unit of the plane, which tiles exactly.
//! let period = [Some(4), Some(12)];
//! let options = BrickOptions { bond: Bond::Running, period, jitter: 0.3, ..Default::default() };
//! let wall = Bricks::new(Seed(7), options)?;
//! let height = wall.field(BrickValue::Height).tile_raster([512, 512])?;
//!
//! // The shade and the distance to the nearest joint, of the same bricks.
//! let shade = wall.field(BrickValue::Random).tile_raster([512, 512])?;
//! let distance = wall.field(BrickValue::EdgeDistance).sample([0.3, 0.7]);
//! assert!(height.size() == shade.size() && distance < 0.5);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! # Patterns
//!
//! | pattern | kinds | values |
//! |---|---|---|
//! | [`Bricks`] | nine [`Bond`]s: running, flemish, herringbone, hexagons, planks, roof tiles and others | height, edge distance, random numbers, coordinates on the brick, column and course |
//! | [`Weave`] | four [`Draft`]s: plain, twill, satin, basket | height, random numbers and direction of the thread, coordinates on it |
//! | [`Shape`] | eight [`ShapeKind`]s, alone or on a lattice | signed distance, mask |
//! | [`Stamps`] | eleven [`StampShape`]s at scattered points: pebbles, leaves, blades, slates and others | height, mask, random numbers, coordinates on the stamp, edge distance, angle |
//! | [`GaborNoise`] | stripes of a frequency and a direction that waver | noise, phase |
//!
//! # Ways to sample
//!
//! All ways give the same bits at the same position.
//!
//! | positions | call |
//! |---|---|
//! | one | [`sample`](dapple_raster::FieldExt::sample) |
//! | many scattered | [`sample_many`](dapple_raster::FieldExt::sample_many) |
//! | a window | [`to_raster`](dapple_raster::Field::to_raster), [`render`](dapple_raster::Field::render) |
//! | one period as a tile | [`tile_raster`](dapple_raster::Field::tile_raster) |
//!
//! # Features
//!
//! | feature | default | effect |
//! |---|---|---|
//! | `rayon` | on | fills windows on all cores; the bits do not change |
//! | `serde` | off | reads and writes bonds, drafts, kinds of shapes and values by name |
//! | `schema` | off | describes them as JSON Schema |
//!
//! # Limits
//!
//! * Positions are in units of the plane; `frequency` is the number of bricks, threads or copies per unit.
//! * A period holds a whole number of bricks or threads, and whole repeats of the bond or the draft. Other periods are
//!   an error that names the condition.
//! * Lengths among the options are relative to the shorter side of a brick, to the distance of threads, or to the size
//!   of a shape, so that a frequency changes no proportions. Distances among the values are in units of the plane.
//! * Values are not filtered: a joint narrower than a pixel aliases.
//! * At a position that is not finite the value is NaN.
//! * The bits are the same on every platform and any number of threads.
//!
//! # Without std
//!
//! Not possible today. `floor` and `sqrt` of `f64` are methods of std, and `dapple-raster` has locks of std.

#![forbid(unsafe_code)]

mod bricks;
mod error;
mod gabor;
mod lattice;
mod near;
mod scatter;
mod shape;
mod weave;

#[doc(alias("tiles", "wall", "planks", "hexagon", "herringbone"))]
pub use bricks::Bricks;
pub use bricks::{Bond, BrickField, BrickOptions, BrickValue};
pub use dapple_hash as hash;
pub use dapple_raster as raster;
pub use error::{PatternError, PatternErrorKind};
#[doc(alias("phasor"))]
pub use gabor::GaborNoise;
pub use gabor::{GaborField, GaborOptions, GaborValue};
#[doc(hidden)]
pub use lattice::direction;
#[doc(hidden)]
pub use scatter::StampTable;
#[doc(alias("scatter", "pebbles", "leaves", "grass", "rivets"))]
pub use scatter::Stamps;
pub use scatter::{StampField, StampOptions, StampOverlap, StampShape, StampValue};
#[doc(alias("sdf", "signed distance", "star"))]
pub use shape::Shape;
pub use shape::{ShapeField, ShapeKind, ShapeOptions, ShapeValue};
#[doc(alias("cloth", "fabric", "twill"))]
pub use weave::Weave;
pub use weave::{Draft, WeaveField, WeaveOptions, WeaveValue};
