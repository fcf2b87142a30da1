//! Procedural textures for games and tools: cells, noise, animal coats, scattered points, images made to repeat,
//! materials as text, and textures grown over meshes.
//!
//! This crate re-exports all library crates of dapple, one module for each, and has no code of its own. Pass a seed to
//! get a raster; save it, or upload it to a GPU:
//!
//! ```
//! use dapple::color::{Palette, TextureRaster};
//! use dapple::hash::Seed;
//! use dapple::raster::{Field, Window, glam::DVec2};
//! use dapple::worley::{Combination, Worley2};
//!
//! // Cracks between cells, which repeat after 8 cells to the right and 8 down.
//! let worley = Worley2::new(Seed(7)).with_period([Some(8), Some(8)])?;
//! let cracks = worley.combine(Combination::F2_MINUS_F1).normalized()?;
//!
//! // One period of it in 512 × 512 pixels, in colors.
//! let window = Window::new(DVec2::ZERO, DVec2::splat(8.0), [512, 512])?;
//! let colors = Palette::Lagoon.ramp().apply(&cracks.to_raster(&window)?);
//!
//! // Bytes for a GPU (`Rgba8UnormSrgb`). To save it: `dapple::image::write_color_png`.
//! let bytes: Vec<u8> = colors.to_rgba8_srgb();
//! # assert_eq!(bytes.len(), 512 * 512 * 4);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! # Which module
//!
//! | to make | module | begin with |
//! |---|---|---|
//! | cells, cracks, scales, in 2-D to 4-D | [`worley`] | [`Worley2::new`](worley::Worley::new) |
//! | noise and turbulence of control points, cows, giraffes | [`pups`] | [`noise`](pups::noise()), [`octaves`](pups::octaves()), [`space_giraffe`](pups::space_giraffe()) |
//! | Perlin's gradient noise, in 2-D to 4-D, and fractal sums of it | [`noise`] | [`GradientNoise2`](noise::GradientNoise2) |
//! | bricks, tiles, planks, cloth, stars and other shapes | [`pattern`] | [`Bricks`](pattern::Bricks), [`Weave`](pattern::Weave), [`Shape`](pattern::Shape) |
//! | noise with one octave in each band; images halved and doubled | [`wavelet`] | [`WaveletNoise2`](wavelet::WaveletNoise2), [`SplineFilter`](wavelet::SplineFilter) |
//! | a material with all its maps, from a text | [`recipe`] | [`Recipe::builtin`](recipe::Recipe::builtin), [`Bake`](recipe::Bake) |
//! | an image that repeats; materials blended | [`tile`] | [`Seamless`](tile::Seamless), [`SeamReport`](tile::SeamReport), [`blend`](tile::blend()) |
//! | more of an example, in the plane or on a mesh | [`synth`] | [`synthesize_plane`](synth::synthesize_plane), [`synthesize`](synth::synthesize) |
//! | points that keep their distance | [`points`] | [`poisson_disk`](points::poisson_disk) |
//! | their triangulation and other graphs | [`graph`] | [`delaunay`](graph::delaunay()) |
//! | blurs, dilation, distances to a mask, connected regions | [`filter`] | [`gaussian`](filter::gaussian()), [`distances`](filter::distances()) |
//! | colors, normals, occlusion, curvature of heights | [`color`] | [`Palette`](color::Palette), [`normal_map`](color::normal_map) |
//! | files: PNG, OpenEXR and others | [`image`] | [`write_color_png`](image::write_color_png), [`read_image`](image::read_image) |
//! | meshes | [`mesh`] | [`Mesh`](mesh::Mesh), [`Surface`](mesh::Surface) |
//! | mesh files: OBJ, PLY, glTF, OFF, STL | [`mesh_io`] | [`read_model`](mesh_io::read_model), [`write_model`](mesh_io::write_model) |
//! | a lit image of a textured object | [`preview`] | [`Scene`](preview::Scene) |
//!
//! Each module links to the documentation of its crate, which has the costs, the limits, and a search of its own. All
//! of them use the types of [`raster`] (pixels, and their positions) and [`hash`] (seeds). Vectors are those of `glam`,
//! which is [`raster::glam`].
//!
//! # Ways to sample
//!
//! Generators are [`Field`](raster::Field)s, except for those with several values at a position. All ways give the same
//! bits at the same position.
//!
//! | positions | call | for cracks as above |
//! |---|---|---|
//! | one | [`FieldExt::sample`](raster::FieldExt::sample) | |
//! | many scattered | [`FieldExt::sample_many`](raster::FieldExt::sample_many) | 20.6 ns for F1 and F2, with vectors and ids |
//! | a window | [`Field::to_raster`](raster::Field::to_raster) | 0.40 ns/pixel |
//! | one period as a tile | [`Field::tile_raster`](raster::Field::tile_raster) | as a window |
//! | row by row, larger than memory | [`RowWriter`](image::RowWriter) with a window for each band | as a window |
//! | a whole material | [`Bake`](recipe::Bake) | |
//!
//! Times are from one thread of a server processor (AMD EPYC), with 64 pixels per cell.
//!
//! # If you look for …
//!
//! | word | here |
//! |---|---|
//! | Voronoi or cellular noise | [`worley`]: distances by [`Combination`](worley::Combination), a color for each cell by [`cell_values`](worley::Worley::cell_values) |
//! | fBm, ridged noise, octaves, turbulence | [`GradientNoise::fractal`](noise::GradientNoise::fractal), any field by [`FieldExt`](raster::FieldExt), [`Cellular::fractal`](worley::Cellular::fractal), [`pups::octaves`](pups::octaves()), the `octaves` of a recipe's nodes |
//! | Perlin, simplex or gradient noise | [`noise::GradientNoise2`]; [`pups::noise`](pups::noise()) without the directions of a lattice, and [`wavelet::WaveletNoise2`] where nothing may alias |
//! | domain warping | [`FieldExt::warp`](raster::FieldExt::warp), the `warp` node of a [`recipe`] |
//! | a heightmap, or the normal map of one | any field through [`to_raster`](raster::Field::to_raster); [`color::normal_map`] |
//! | tileable or seamless textures | generators repeat exactly with a `period`; [`tile::Seamless`] for images that somebody else made |
//! | a brick wall, a floor, a fabric | [`pattern::Bricks`], [`pattern::Weave`] |
//! | signed distance fields (SDF) | [`pattern::Shape`]; `shape` and `smooth_minimum` of a [`recipe`] |
//! | blue noise | [`points::poisson_disk`]: points that keep their distance |
//! | trees of an endless world, scatter in chunks | [`points::EndlessPoissonDisk`], also with a radius that [varies](points::EndlessVariablePoissonDisk) |
//! | a Voronoi diagram, the nearest of some points | [`graph::Voronoi`] |
//! | texture synthesis from a photograph | [`synth::synthesize_plane`] |
//! | splat maps, terrain blending | [`tile::blend`](tile::blend()) |
//!
//! # Limits, and what holds everywhere
//!
//! * The same seed gives the same bits on every machine, with every set of vector instructions and any number of
//!   threads.
//! * Periods are exact, and independent for each axis. A window is, bit for bit, a crop of the whole image.
//! * Row 0 is the top, x goes right and y down. Positions are `f64`, values `f32`, and colors linear until a file has 8
//!   or 16 bits per channel.
//! * Invalid input is an error that states the limit and the value, never a panic.
//! * A raster has at most 2^31 pixels. Larger images are made window by window.
//! * Nothing runs on a GPU, and no file is downloaded.
//!
//! # Features
//!
//! | feature | default | effect |
//! |---|---|---|
//! | `hash`, `raster`, `color`, `filter`, `points`, `noise`, `pattern`, `wavelet`, `mesh`, `mesh-io`, `image`, `graph`, `worley`, `tile`, `preview`, `pups`, `synth`, `recipe` | on | the module of this name, and the modules whose types it uses |
//! | `rayon` | on | work on all cores; the bits do not change |
//! | `simd` | on | gradient noise in the widest vector instructions of the processor; the bits do not change |
//! | `json` | on | seam reports and directions as JSON |
//! | `schema` | off | recipes as JSON Schema, and a reference of all options |
//!
//! A program that needs only cells uses `default-features = false, features = ["worley"]`, or depends on
//! `dapple-worley`, which is the same code. Depend on a single crate for one purpose, and on this one for several.
//!
//! # Without std
//!
//! Only `hash` is `no_std` (with `alloc`), as the crate `dapple-hash`. The other crates use threads, locks and SIMD
//! detection of std, or its `floor` and `sqrt` of `f64`, and some of them files. Each front page says which.
//!
//! # In a game
//!
//! * A texture that repeats needs a sampler that repeats; the default of most engines clamps.
//! * Color is sRGB (`rgba8unorm-srgb`), and normals, heights and roughness are not (`rgba8unorm`, `r8unorm`, or 16
//!   bits).
//! * Green points up in normal maps, as in OpenGL, glTF, Godot, Blender, Unity and Bevy; `NormalY::DirectX` flips it
//!   for Unreal.
//! * Generate mip levels with [`TextureRaster::mip_levels`](color::TextureRaster::mip_levels), which averages in linear
//!   light.
//! * For a world in chunks, adjacent windows of one grid have the same bits as a single image. So do [endless
//!   points](points::EndlessPoissonDisk).
//!
//! The examples of this crate, in the folder `examples/`, range from one line to a baked model, a terrain in chunks and a
//! material that is baked while a game loads. The README lists them.

#![forbid(unsafe_code)]

/// Seeds, and random numbers from them.
#[cfg(feature = "hash")]
pub use dapple_hash as hash;

/// Pixels in memory, their positions in the plane, and fields of values.
#[cfg(feature = "raster")]
pub use dapple_raster as raster;

/// Colors, ramps, and maps from heights: normals, occlusion, curvature.
#[cfg(feature = "color")]
pub use dapple_color as color;

/// Filters of rasters: blurs, gradients, dilation, distances to a mask, connected regions. Large rasters can be
/// filtered window by window.
#[cfg(feature = "filter")]
pub use dapple_filter as filter;

/// Point sets with a minimum distance between points, on domains that may wrap.
#[cfg(feature = "points")]
pub use dapple_points as points;

/// Delaunay triangulations and other graphs of points.
#[cfg(feature = "graph")]
pub use dapple_graph as graph;

/// Partition-of-unity parametrics: noise and animal coats from control points.
#[cfg(feature = "pups")]
pub use dapple_pups as pups;

/// Worley's cellular basis: F1 to F4 in 2-D, 3-D and 4-D.
#[cfg(feature = "worley")]
pub use dapple_worley as worley;

/// Perlin's gradient noise, with exact periods.
#[cfg(feature = "noise")]
pub use dapple_noise as noise;

/// Patterns with exact periods: bricks, woven threads, shapes.
#[cfg(feature = "pattern")]
pub use dapple_pattern as pattern;

/// Spline wavelets: exact filters that halve and double rasters, and wavelet noise.
#[cfg(feature = "wavelet")]
pub use dapple_wavelet as wavelet;

/// Seamless tiles from images, seam reports, and blending of materials.
#[cfg(feature = "tile")]
pub use dapple_tile as tile;

/// Recipes, which are materials as text, and the maps that are baked from them.
#[cfg(feature = "recipe")]
pub use dapple_recipe as recipe;

/// Triangle meshes: repair, straight paths, nearest points.
#[cfg(feature = "mesh")]
pub use dapple_mesh as mesh;

/// Mesh files: OBJ, PLY, glTF, OFF.
#[cfg(feature = "mesh-io")]
pub use dapple_mesh_io as mesh_io;

/// Texture synthesis from an example image, on meshes and in the plane.
#[cfg(feature = "synth")]
pub use dapple_synth as synth;

/// Lit previews of textures on objects.
#[cfg(feature = "preview")]
pub use dapple_preview as preview;

/// Image files: PNG, OpenEXR, JPEG, TIFF, WebP, TGA and Radiance HDR.
#[cfg(feature = "image")]
pub use dapple_image as image;
