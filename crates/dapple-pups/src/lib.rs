//! Textures from control points: noise, turbulence, cells, and the coats of cows and giraffes. They are smooth and
//! tileable, and can be edited point by point.
//!
//! Control points in the plane are connected by a graph. The edges at a control point are its axes. A position is
//! projected onto each axis, every projection gives an axial weight, and the product of the axial weights is the
//! weight of the control point. A control point has a weight only in its support, a polygon around it. [`Pups`] is
//! such a net. [`Texture`] interpolates values of the control points; [`Pups::strongest`] returns the control point
//! with the largest weight, whose label a position gets.
//!
//! ```
//! use dapple_pups::hash::Seed;
//! use dapple_pups::raster::{Field, Window};
//! use dapple_pups::{NoiseOptions, SpaceGiraffeOptions, noise, space_giraffe};
//!
//! // Noise from 0 to 1 that repeats after two units, and one period of it as an image.
//! let options = NoiseOptions { spacing: 0.1.into(), ..NoiseOptions::default() };
//! let window = Window::new(options.domain.origin, options.domain.size, [256, 256])?;
//! let image = noise(&options, Seed(7))?.to_raster(&window)?;
//! assert!(image.statistics().max <= 1.0 + 1e-5);
//!
//! // The coat of a giraffe: 1 on the spots, 0 between them.
//! let coat = space_giraffe(&SpaceGiraffeOptions::default(), Seed(7))?.label_raster(&window)?;
//! assert!(coat.pixels().contains(&1));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! # Ways to use it
//!
//! | to make | call |
//! |---|---|
//! | noise, octaves, turbulence | [`noise`], [`octaves`], [`turbulence`] |
//! | cells, cellular noise, colors | [`cells`], [`cellular_noise`], [`color_noise`] |
//! | animal coats | [`cow`], [`space_giraffe`] |
//! | a progression from left to right | [`cow_progression`], [`giraffe_progression`], [`label_ramp`] |
//! | cells after a reference image | [`reference_texture`], [`iterated_reference`] |
//! | from your own control points | [`control_points`] |
//! | a texture of your own | [`Pups::delaunay`], then [`Pups::texture`]; attributes by [`random_values`], [`biased_labels`], [`grouped_labels`], [`random_orientations`] and others |
//! | looping animation | [`NetOptions::motion`], without jumps with [`NetOptions::fade`] |
//!
//! | positions | call | cost with 700 points |
//! |---|---|---|
//! | one | [`sample`](dapple_raster::FieldExt::sample) | 42.0 ns |
//! | a window | [`to_raster`](dapple_raster::Field::to_raster), [`render`](dapple_raster::Field::render) | 1.67 ns/pixel, 3.37 with orientations |
//!
//! Times are from one thread of a server processor (AMD EPYC). With 10,000 points a raster takes 3.79 ns/pixel.
//!
//! # Features
//!
//! | feature | default | effect |
//! |---|---|---|
//! | `rayon` | on | fills rasters and point sets on all cores; the bits do not change |
//! | `serde` | off | reads and writes the options as data |
//! | `schema` | off | describes the options as JSON Schema; includes `serde` |
//!
//! # Limits
//!
//! * Textures are in the plane. They repeat exactly along each axis on which their domain wraps.
//! * The progressions do not repeat from left to right.
//! * Control points are at least 1e-9 of the domain's larger side apart. The sides of a domain are from 1e-18 to 1e18
//!   long.
//! * Positions are `f64`, values `f32`.
//! * The bits are the same on every machine, at every SIMD level and with any number of threads.
//!
//! # Without std
//!
//! Not supported. Parts of a net that are computed on demand are stored in std's `OnceLock`, `floor` and `sqrt` of
//! `f64` are std methods, and `dapple-graph`, `dapple-points` and `dapple-raster` need std.
//!
//! # Reference
//!
//! Jack Caron and David Mould, "Partition of Unity Parametrics for Texture Synthesis", Graphics Interface 2013.

#![forbid(unsafe_code)]

mod error;
mod options;
mod weight;

mod net;
mod pups;
mod support;
mod texture;

mod profile;

mod power;
mod shift;

mod bins;
mod sample;

mod gradient;

mod render;

mod line;
mod splat;
mod tile;

mod sink;

mod assign;
mod recipes;

mod shader;

#[cfg(feature = "schema")]
mod schema;

pub use assign::{
    Orientations, ReferenceImage, angle_orientations, biased_labels, field_orientations,
    field_values, grouped_labels, outward_orientations, own_labels, palette_values, random_labels,
    random_orientations, random_values, reference_labels, varying_values,
};
pub use dapple_graph as graph;
pub use dapple_hash as hash;
pub use dapple_points as points;
pub use dapple_points::{Cancel, IsCancelled};
pub use dapple_raster as raster;
pub(crate) use dapple_raster::{Range, range};
pub use error::{PupsError, PupsErrorKind};
pub use glam;
pub use options::{Orientation, PupsOptions};
pub use pups::Pups;
pub use recipes::{
    Cells, CellsOptions, CellularNoiseOptions, ColorNoiseOptions, ControlNet, ControlPoint,
    ControlPoints, CowOptions, CowProgressionOptions, Folding, GiraffeProgressionOptions,
    IteratedOptions, IterationPoints, LabelRampOptions, LabelTexture, Layers, NetField, NetOptions,
    NetValues, NoiseOptions, Octave, OctaveSource, OctavesOptions, Orbits, ProgressionOptions,
    PupsField, PupsRecipe, ReferenceOptions, SpaceGiraffeOptions, Spacing, Spots,
    TurbulenceOptions, VectorLabelTexture, cells, cellular_noise, color_noise, control_points, cow,
    cow_progression, giraffe_progression, iterated_reference, label_ramp, noise, octaves,
    reference_texture, space_giraffe, turbulence,
};
pub use shader::{ShaderLayer, ShaderLayers};
pub use texture::{Texture, VectorTexture};
pub use weight::AxialWeight;
