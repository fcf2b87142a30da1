//! Procedural test models for textures, built from blended shapes. They replace the models of Turk's figure 5.
//!
//! Each model is one smooth closed surface, about two units large and centered at the origin. Animals face +z with y
//! up, so their left is +x. Their modules define named positions on the surface from which direction fields can
//! start. The functions take the number of triangles, from 16 to 2^24. With 10,000 to 20,000 triangles, all details
//! are visible.
//!
//! The gallery, the benchmarks, tests and examples use the models; the crate is not published. [`solid`] contains
//! shapes defined by distance functions, and [`polygonize()`] converts them to meshes.
//!
//! ```
//! use dapple_models::ray;
//!
//! let mesh = ray(2000)?;
//! assert_eq!(mesh.faces().len(), 2000);
//! assert!(ray::SNOUT.z > 0.0);
//! # Ok::<(), dapple_models::ModelError>(())
//! ```

#![forbid(unsafe_code)]

pub mod blended_tori;
pub mod bunny;
pub mod elephant;
pub mod octopus;
pub mod ray;
pub mod zebra;

mod parts;
mod polygonize;
pub mod solid;

mod error;

pub use blended_tori::blended_tori;
pub use bunny::bunny;
pub use elephant::elephant;
pub use error::{ModelError, ModelErrorKind};
pub use octopus::octopus;
pub use polygonize::{TOLERANCE, polygonize, polygonize_n};
pub use ray::ray;
pub use zebra::zebra;

#[cfg(test)]
mod tests;
