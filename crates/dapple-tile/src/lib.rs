//! Makes images repeat without a seam, measures the seams, fills large maps from small tiles, and blends materials.
//!
//! If a generator in this workspace produces the image, give it a period. It then repeats exactly, without any loss.
//! The methods here are for images without a generator, such as photographs.
//!
//! ```
//! use dapple_tile::raster::Raster;
//! use dapple_tile::{Method, SeamOptions, SeamReport, Seamless, SoftCut, rank_equalize, repeat};
//!
//! fn tile(image: &Raster<f32>) -> Result<Raster<f32>, Box<dyn std::error::Error>> {
//!     // Overlap a margin of 32 pixels with the other side, and cut it where the cut is least visible.
//!     let cut = Seamless::new(Method::SoftCut(SoftCut::default()));
//!     let tile = cut.apply(image)?;
//!
//!     // Measure how well it repeats, and how much detail it has kept.
//!     let report = SeamReport::beside(image, &tile, &SeamOptions::default())?;
//!     println!("{report}");
//!
//!     // A large mask. A threshold of 0.25 covers a quarter of every whole copy of the tile.
//!     Ok(repeat(&rank_equalize(&tile)?, [1024, 1024])?)
//! }
//! # let image = Raster::from_fn([160, 160], |x, y| (x * x % 37 + y * y % 23) as f32 + 0.1 * x as f32)?;
//! # assert_eq!(tile(&image)?.size(), [1024, 1024]);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! # Ways to use it
//!
//! | to | use | cost |
//! |---|---|---|
//! | make one raster repeat | [`Seamless::apply`] | depends on the [`Method`], below |
//! | make a color image repeat | [`Seamless::apply_color`] | all channels together |
//! | make all maps of a material repeat | [`Seamless::apply_maps`] | one cut for all maps |
//! | prepare a photograph | [`even_out`], [`rectify`], [`resize`] | |
//! | estimate height and roughness from a photograph | [`estimate_material`] | |
//! | measure a seam | [`SeamReport`], [`SeamReports`] for all channels | |
//! | fill any size | [`repeat`], [`repeat_into`] | 0.18 ns/pixel from a tile of 128 × 128 |
//! | vary the copies | [`Disturbance`] | |
//! | build tiles that fit in any order | [`CornerTiles`] | while built, memory for C² copies of a source, for C sources |
//! | make different tiles fit | [`MatchBorders`] | |
//! | find the cracks of a texture | [`BlendMap`] | |
//! | make a mask that covers exactly its share | [`rank_equalize`] | |
//! | mix materials by weight, height, mask or in bands | [`blend`], [`blend_by_tile`] | |
//!
//! Times are from one thread of a server processor (AMD EPYC).
//!
//! | method | use it for | cost |
//! |---|---|---|
//! | [`Periodic`](Method::Periodic) | smooth noise | no margin; retains all fine detail |
//! | [`Poisson`](Method::Poisson) | smooth noise, with gradients nearest to the source's | no margin; retains all fine detail |
//! | [`SoftCut`] | photographs, grains | a margin along each axis |
//! | [`SplineProject`] | the blend tile of Du, Wang and Meng | with one level, two thirds to three quarters of the finest octave |
//! | [`PeriodicThenProject`](Method::PeriodicThenProject) | the same blend tile without its seam | as `SplineProject` |
//! | [`Feather`] | a baseline | contrast, of which 0.70 to 0.95 remains |
//! | [`Mirror`](Method::Mirror) | a baseline | obvious symmetry |
//!
//! No method is best everywhere, and none of them joins courses of bricks; for these, use `dapple-synth`. The README
//! has the measurements, and says how far a report's verdict agrees with visual judgment.
//!
//! # Features
//!
//! | feature | default | effect |
//! |---|---|---|
//! | `rayon` | on | works on all cores; the bits do not change |
//! | `serde` | off | reads and writes options and reports as data |
//! | `json` | off | writes seam reports as JSON; includes `serde` |
//!
//! # Limits
//!
//! * Pixels must be finite. All maps of a material are the same size.
//! * [`CornerTiles`] takes two to four sources.
//! * A tile that passes a report may still look bad, and one that fails may look good. Check both visually.
//! * Rasters are `f32`, and equations are solved in `f64`. All results have the same bits on every platform and with
//!   any number of threads.
//! * The crate has no file formats and does not access files.
//!
//! # Without std
//!
//! Not supported. `floor` and `sqrt` of `f64` are std methods, and `dapple-raster`, `dapple-color` and `dapple-wavelet`
//! need std.
//!
//! # Reference
//!
//! Du Jin-Lian, Wang Song and Meng Xianhai, "Wavelet and Blend maps for texture synthesis", compute a small tile that
//! repeats, fill large blend maps with it and blend textures by them. This crate has the paper's tile, better methods,
//! and the measurements that compare them.

#![forbid(unsafe_code)]

mod error;
mod map;

mod estimate;
mod photo;
mod rectify;

mod seamless;

mod axis;
mod crossfade;
mod cut;
mod cut_path;
mod frame;
mod overlap;

mod fourier;
mod sines;

mod report;

mod corner;
mod disturb;
mod match_borders;
mod piece;
mod repeat;

mod gauss;

mod blend_map;
mod rank;

mod blend;
mod weighting;

mod pyramid;

#[cfg(test)]
mod test_fields;

#[doc(alias("splat map", "terrain blending"))]
pub use blend::blend;
pub use blend::{Blend, Layer, Mixing, blend_by_tile, blend_cancellable};
pub use blend_map::BlendMap;
pub use corner::CornerTiles;
pub use crossfade::Crossfade;
pub use disturb::Disturbance;
pub use error::{IsCancelled, TileError, TileErrorKind};
pub use estimate::{Estimate, EstimateOptions, estimate_material};
pub use gauss::blur;
pub use map::Map;
pub use match_borders::{BorderSource, MatchBorders};
pub use photo::{even_out, resample_with_alpha, resize};
pub use pyramid::Pyramid;
pub use rank::rank_equalize;
pub use rectify::rectify;
pub use repeat::{repeat, repeat_into};
pub use report::{
    ChannelReport, DetailKept, Fault, Seam, SeamOptions, SeamRatio, SeamReport, SeamReports,
};
#[doc(alias("tileable", "seamless"))]
pub use seamless::Seamless;
pub use seamless::*;
pub use weighting::Weighting;

pub use dapple_color as color;
pub use dapple_hash as hash;
pub use dapple_raster as raster;
pub use dapple_wavelet as wavelet;
