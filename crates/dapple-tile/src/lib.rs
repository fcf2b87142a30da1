//! Making images repeat, honest reports of their seams, and blending textures with tiles.

#![forbid(unsafe_code)]

mod error;
mod map;

mod seamless;

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

pub use error::{TileError, TileErrorKind};
pub use feather::Feather;
pub use map::Map;
pub use poisson::WrapGradient;
pub use report::{DetailKept, Seam, SeamOptions, SeamRatio, SeamReport};
pub use seamless::{Method, Seamless};
pub use soft_cut::{Crossfade, SoftCut};
pub use spline_project::{Basis, Pixels, SplineProject};

pub use dapple_color as color;
pub use dapple_raster as raster;
pub use dapple_wavelet as wavelet;
