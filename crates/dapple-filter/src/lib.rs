//! Filters of rasters: Gaussian, directional and slope blurs, gradients, dilation and erosion, distances to a mask,
//! connected regions.
//!
//! A filter computes a [`Part`] of a raster from the part and a halo around it. A pixel of the result depends only on
//! the pixels within the halo, and sums run in a fixed order. A filtered part therefore equals the same pixels of the
//! filtered raster, bit for bit, and rasters of any size can be filtered in bands.
//!
//! ```
//! use dapple_filter::{Part, dilate, disk_halo};
//!
//! // A single white pixel, and the disk of one unit around it. Pixels are half a unit wide.
//! let (pixel, radius) = ([0.5, 0.5].into(), 1.0);
//! let part = Part { size: [1, 1], halo: disk_halo(radius, pixel), pixel };
//! let mut values = vec![0.0; 25];
//! values[10] = 1.0;
//! assert_eq!(dilate(&values, &part, radius), [1.0]);
//! ```
//!
//! # Ways to use it
//!
//! | to | use | halo | cost |
//! |---|---|---|---|
//! | blur in all directions | [`gaussian`] | [`gaussian_halo`] | grows with the radius |
//! | blur along a direction | [`DirectionalBlur`] | [`DirectionalBlur::halo`] | grows with the radius |
//! | blur along the slope of heights | [`SlopeBlur`] | [`SlopeBlur::halo`] | at most 32 steps |
//! | compute gradients | [`gradients`] | [`difference_spans`] | |
//! | move values along the slope of heights | [`FlowWarp`] | [`FlowWarp::halo`] | grows with the steps |
//! | take the maximum or minimum of a disk | [`dilate`], [`erode`] | [`disk_halo`] | grows with the radius |
//! | measure distances to a mask | [`distances`] | [`disk_halo`] | grows with the radius |
//! | number connected regions | [`regions`] | the whole raster | |
//!
//! # Features
//!
//! | feature | default | effect |
//! |---|---|---|
//! | `rayon` | on | filters on all cores; the bits do not change |
//!
//! # Limits
//!
//! * Values are single-channel `f32`, row by row. Filter each channel of a color separately.
//! * Filters panic unless the number of values is the number of pixels of the part and its halo.
//! * Results have the same bits on every platform and any number of threads.

#![forbid(unsafe_code)]

mod directional;
mod distance;
mod extremes;
mod gaussian;
mod gradient;
mod part;
mod regions;
mod slope;

pub use directional::DirectionalBlur;
pub use distance::distances;
pub use extremes::{dilate, disk_halo, erode};
pub use gaussian::{gaussian, gaussian_halo};
pub use glam;
pub use gradient::{difference_spans, gradients};
pub use part::Part;
pub use regions::regions;
pub use slope::{FlowDirection, FlowWarp, SlopeBlur};
