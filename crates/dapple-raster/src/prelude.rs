//! Traits and types for programs that sample fields: `use dapple_raster::prelude::*`.
//!
//! ```
//! use dapple_raster::prelude::*;
//!
//! let slope = dapple_raster::field_fn(|[x, _y]| x as f32).mul(2.0);
//! let raster: Raster<f32> = slope.to_raster(&Window::unit([4, 4])?)?;
//! assert_eq!(raster.row(0)[3], slope.sample([0.875, 0.125]));
//! # Ok::<(), dapple_raster::RasterError>(())
//! ```

pub use crate::{Field, FieldExt, Gradient, Raster, Window};
