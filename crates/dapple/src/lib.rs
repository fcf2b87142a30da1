//! Procedural textures: cells, noise, animal coats, scattered points, images made to repeat, materials as text, and textures
//! grown over meshes.
//!
//! This crate re-exports all library crates of dapple, one module for each, and has no code of its own. Pass a seed to
//! get a raster; save it, or upload it to a GPU:
//!
//! ```
//! use dapple::color::Palette;
//! use dapple::hash::Seed;
//! use dapple::raster::{Field, Window, glam::DVec2};
//! use dapple::worley::{Combination, Worley2};
//!
//! // Cracks between cells, which repeat after 8 cells to the right and 8 down.
//! let worley = Worley2::new(Seed(7)).with_period([Some(8), Some(8)])?;
//! let cracks = worley.combine(Combination::F2_MINUS_F1).normalized()?;
//!
//! // One period of it in 256 × 256 pixels, from 0 to 1, and in colors.
//! let window = Window::new(DVec2::ZERO, DVec2::splat(8.0), [256, 256])?;
//! let height = cracks.to_raster(&window)?;
//! let colors = Palette::Lagoon.ramp().apply(&height);
//!
//! // To save it: dapple::image::write_color_png("cracks.png", &colors, Default::default())?;
//! let bytes: Vec<[u8; 3]> = colors.pixels().iter().map(|color| color.to_srgb()).collect();
//! # assert_eq!(bytes.len(), 256 * 256);
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
//! | noise with one octave in each band; images halved and doubled | [`wavelet`] | [`WaveletNoise2`](wavelet::WaveletNoise2), [`SplineFilter`](wavelet::SplineFilter) |
//! | a material with all its maps, from a text | [`recipe`] | [`Recipe::builtin`](recipe::Recipe::builtin), [`Bake`](recipe::Bake) |
//! | an image that repeats; materials blended | [`tile`] | [`Seamless`](tile::Seamless), [`SeamReport`](tile::SeamReport), [`blend`](tile::blend()) |
//! | more of an example, in the plane or on a mesh | [`synth`] | [`synthesize_plane`](synth::synthesize_plane), [`synthesize`](synth::synthesize) |
//! | points that keep their distance | [`points`] | [`poisson_disk`](points::poisson_disk) |
//! | their triangulation and other graphs | [`graph`] | [`delaunay`](graph::delaunay()) |
//! | colors, normals, occlusion, curvature of heights | [`color`] | [`Palette`](color::Palette), [`normal_map`](color::normal_map) |
//! | files: PNG and OpenEXR | [`image`] | [`write_color_png`](image::write_color_png), [`read_image`](image::read_image) |
//! | meshes | [`mesh`] | [`Mesh`](mesh::Mesh), [`Surface`](mesh::Surface) |
//! | mesh files: OBJ, PLY, glTF, OFF, STL | [`mesh_io`] | [`read_model`](mesh_io::read_model), [`write_model`](mesh_io::write_model) |
//! | a lit picture of a texture on a thing | [`preview`] | [`Scene`](preview::Scene) |
//!
//! All of them use the types of [`raster`] (pixels, and their positions) and [`hash`] (seeds). Vectors are those of
//! `glam`, which is [`raster::glam`].
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
//! | blue noise | [`points::poisson_disk`]: points that keep their distance |
//! | trees of an endless world, scatter in chunks | [`points::EndlessPoissonDisk`], also with a radius that [varies](points::EndlessVariablePoissonDisk) |
//! | a Voronoi diagram, the nearest of some points | [`graph::Voronoi`] |
//! | texture synthesis from a photograph | [`synth::synthesize_plane`] |
//! | splat maps, terrain blending | [`tile::blend`](tile::blend()) |
//!
//! # What holds everywhere
//!
//! * The same seed gives the same bits on every machine, with every set of vector instructions and any number of threads.
//! * What a generator repeats, it repeats exactly, along each axis on its own; a window is, bit for bit, a crop of the whole.
//! * Row 0 is the top, x goes right and y down. Positions are `f64`, values `f32`, and colors linear until a file has 8 or 16
//!   bits per channel.
//! * Bad input is an error that names the limit and the value, and never a panic.
//!
//! # Examples
//!
//! The folder `examples/` of this crate goes from one line to a baked model; each has a command in its first lines and
//! draws into `target/examples-out/`, or into the folder in its argument:
//!
//! | example | shows |
//! |---|---|
//! | `01_cells` | one picture of Worley's cells |
//! | `02_tile_and_window` | exact repeats, and a window that equals the crop |
//! | `03_poisson_disk` | points that keep their distance |
//! | `04_pups_noise` | octaves of noise as a land, and its normal map |
//! | `05_giraffe` | the coat of a space giraffe |
//! | `06_wavelet_noise` | noise in bands |
//! | `07_make_a_photo_tile` | an image made to repeat, and its seam report |
//! | `08_blend_materials` | moss in the joints of stones |
//! | `09_recipe_bake` | a material as a text, and its maps as files |
//! | `10_gpu_texture` | the bytes of a GPU texture with mip levels |
//! | `11_synthesize_plane` | a tile that looks like a small example |
//! | `12_baked_model` | stripes grown over a mesh, as a GLB file |
//! | `13_terrain_chunks` | a world without an end in chunks: heights, biomes and trees |
//! | `14_recipe_at_load` | a material made while a game loads, with a bar, and given up |
//! | `15_cracked_ground` | a cracked ground that tiles, as bytes with mip levels for a GPU |
//! | `16_voronoi` | Voronoi cells on a torus, colored by their areas |
//! | `17_moving_coat` | an animal coat that moves in a loop |
//! | `18_grow_and_repair` | a scratch repaired with texture, and a tile grown from it |
//!
//! # Features
//!
//! Each module is a feature of the same name and includes the modules whose types it uses; all are on by default. A
//! program that needs cells alone uses `default-features = false, features = ["worley"]`, or depends on
//! `dapple-worley`, which is the same code: use one of the crates for one purpose, and this one for several.
//!
//! | feature | what it adds |
//! |---|---|
//! | `rayon` | work on all cores; the bits do not change |
//! | `json` | seam reports and directions as JSON |

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

/// Points that keep their distance, on domains that wrap.
#[cfg(feature = "points")]
pub use dapple_points as points;

/// Delaunay triangulations and other graphs of points.
#[cfg(feature = "graph")]
pub use dapple_graph as graph;

/// Partition-of-unity parametrics: noise and animal coats from control points.
#[cfg(feature = "pups")]
pub use dapple_pups as pups;

/// Worley's cells: F1 to F4 in 2-D, 3-D and 4-D.
#[cfg(feature = "worley")]
pub use dapple_worley as worley;

/// Gradient noise: Perlin's, with exact periods.
#[cfg(feature = "noise")]
pub use dapple_noise as noise;

/// Spline wavelets: rasters halved and doubled exactly, and wavelet noise.
#[cfg(feature = "wavelet")]
pub use dapple_wavelet as wavelet;

/// Images made to repeat, seam reports, and blending of materials.
#[cfg(feature = "tile")]
pub use dapple_tile as tile;

/// Recipes and materials as text, and the maps that are baked from them.
#[cfg(feature = "recipe")]
pub use dapple_recipe as recipe;

/// Triangle meshes: repair, walking, nearest points.
#[cfg(feature = "mesh")]
pub use dapple_mesh as mesh;

/// Mesh files: OBJ, PLY, glTF, OFF.
#[cfg(feature = "mesh-io")]
pub use dapple_mesh_io as mesh_io;

/// Textures from an example image, on meshes and in the plane.
#[cfg(feature = "synth")]
pub use dapple_synth as synth;

/// Lit pictures of textures on objects.
#[cfg(feature = "preview")]
pub use dapple_preview as preview;

/// Image files: PNG and OpenEXR.
#[cfg(feature = "image")]
pub use dapple_image as image;
