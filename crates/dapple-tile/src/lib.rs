//! Seamless tiles from images, measurement of their seams, and blending of textures.
//!
//! Du Jin-Lian, Wang Song and Meng Xianhai, "Wavelet and Blend maps for texture synthesis", make a small tile that
//! repeats, fill large blend maps with it and blend textures by them. This crate has the paper's tile, better methods,
//! and the measurements that compare them.
//!
//! * **A tile of an image**: [`Seamless`] applies a [`Method`] to one raster, a color picture, or all maps of a material
//!   along the same cut. [`Periodic`](Method::Periodic) keeps all fine detail and needs no margin;
//!   [`SoftCut`] suits grains and costs a margin; [`SplineProject`] is the paper's, which smooths, and hides a seam only
//!   where the image was made periodic before ([`PeriodicThenProject`](Method::PeriodicThenProject)). [`Feather`] and
//!   [`Mirror`](Method::Mirror) are the usual baselines.
//! * **What it cost**: [`SeamReport`] compares the steps across the wrap with those inside, at four scales, counts the
//!   detail that was kept and says what is wrong; [`SeamReports`] does so for all channels of a picture.
//! * **A map of a tile**: [`repeat`] and [`repeat_into`] fill any size; [`Disturbance`] varies the copies inside and keeps
//!   their borders; [`CornerTiles`] are sets that fit in any order; [`MatchBorders`] makes unlike tiles fit.
//! * **Blending**: [`BlendMap`] finds where a texture has its cracks, [`rank_equalize`] makes any raster a mask that covers
//!   exactly its share, and [`blend`] mixes materials by weights, heights or masks, plainly or in bands.
//!
//! ```
//! use dapple_tile::raster::Raster;
//! use dapple_tile::{Method, SeamOptions, SeamReport, Seamless, repeat};
//!
//! let image = Raster::from_fn([64, 64], |x, y| (x * x % 37 + y * y % 23) as f32 + 0.5 * x as f32)?;
//! let tile = Seamless::new(Method::Periodic).apply(&image)?;
//! let report = SeamReport::beside(&image, &tile, &SeamOptions::default())?;
//! println!("{report}");
//! let map = repeat(&tile, [1000, 700])?;
//! assert_eq!(map.row(640)[64], tile.row(0)[0]);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! If a generator of this workspace makes the image, make it periodic there: every generator has a period, and repeats
//! exactly without any loss. The methods here are for images whose source is not at hand.
//!
//! Rasters are `f32`, and equations are solved in `f64`. All results have the same bits on every platform and on any
//! number of threads. The crate knows no file format and touches no file.

#![forbid(unsafe_code)]

mod error;
mod map;

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
pub use blend::{Blend, Layer, Mixing, blend_by_tile};
pub use blend_map::BlendMap;
pub use corner::CornerTiles;
pub use crossfade::Crossfade;
pub use disturb::Disturbance;
pub use error::{IsCancelled, TileError, TileErrorKind};
pub use gauss::blur;
pub use map::Map;
pub use match_borders::{BorderSource, MatchBorders};
pub use pyramid::Pyramid;
pub use rank::rank_equalize;
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
