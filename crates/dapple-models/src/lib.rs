//! Test models for textures, made of blended shapes: our own stand-ins for those of Turk's figure 5.
//!
//! Each is one smooth closed surface about two units large around the origin. Animals look toward +z with y up, so that
//! their left is +x; their modules name places on the surface to start directions from. The functions take the number
//! of triangles, from 16 to 2^24: 10,000 to 20,000 show all detail.
//!
//! The gallery, the benchmarks, tests and examples use them; the crate is not published. [`solid`] has shapes given by
//! distance functions, and [`polygonize()`] makes meshes of them.
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
