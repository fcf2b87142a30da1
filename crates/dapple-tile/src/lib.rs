//! Making images repeat, honest reports of their seams, and blending textures with tiles.

#![forbid(unsafe_code)]

mod error;
mod map;

mod seamless;

mod axis;
mod crossfade;
mod cut_path;
mod overlap;

mod fourier;
mod periodic;
mod poisson;
mod sines;
mod spline_project;

mod feather;
mod mirror;
mod soft_cut;

mod report;

mod corner;
mod disturb;
mod match_borders;
mod repeat;

mod blend_map;
mod rank;

mod blend;
mod pyramid;

#[cfg(test)]
mod test_fields;

pub use corner::CornerTiles;
pub use crossfade::Crossfade;
pub use disturb::Disturbance;
pub use error::{TileError, TileErrorKind};
pub use feather::Feather;
pub use map::Map;
pub use match_borders::{BorderSource, MatchBorders};
pub use poisson::WrapGradient;
pub use repeat::{repeat, repeat_into};
pub use report::{DetailKept, Seam, SeamOptions, SeamRatio, SeamReport};
pub use seamless::{Method, Seamless};
pub use soft_cut::SoftCut;
pub use spline_project::{Basis, Pixels, SplineProject};

pub use dapple_color as color;
pub use dapple_raster as raster;
pub use dapple_wavelet as wavelet;
