//! Lit previews on the CPU: images of procedural textures on bump-mapped planes, spheres, cut tori and meshes.
//!
//! A [`Scene`] holds a [`Camera`], [`Object`]s, [`Light`]s and an [`Environment`], and renders to a raster of linear
//! colors. An object is a [`Shape`] and a closure. For a [`Surface`], the point where a ray met the shape, the closure
//! returns a [`Material`] of a color, the gradient of a bump, highlights and a mirror.
//!
//! ```
//! use dapple_color::LinearRgb;
//! use dapple_preview::glam::DVec3;
//! use dapple_preview::{Camera, Light, Material, Object, Scene, Shape, Supersampling, Surface};
//!
//! // A texture in space: boards of one unit.
//! let boards = |surface: &Surface| {
//!     let board = surface.position.floor().element_sum();
//!     let odd = board * 0.5 != (board * 0.5).floor();
//!     Material::matte(LinearRgb::gray(if odd { 0.7 } else { 0.2 })).with_specular(0.2, 50.0)
//! };
//! let scene = Scene::new(Camera::look_at(DVec3::new(0.0, 2.0, 6.0), DVec3::Y))
//!     .with_object(Object::new(Shape::Plane, boards))
//!     .with_object(Object::new(Shape::torus(1.0, 0.4), boards).at(DVec3::new(0.0, 0.4, 0.0)))
//!     .with_light(Light::directional(DVec3::new(1.0, 2.0, 1.0), LinearRgb::WHITE))
//!     .with_ambient(LinearRgb::gray(0.1));
//! let image = scene.render([160, 120], Supersampling(2))?;
//! assert_eq!(image.size(), [160, 120]);
//! # Ok::<(), dapple_preview::PreviewError>(())
//! ```
//!
//! # Ways to use it
//!
//! | to | use |
//! |---|---|
//! | texture an object in space | [`Surface::position`]: the texture moves with the object and goes through it, as the flat face of a [`Cut`] shows |
//! | texture it by coordinates | [`Surface::uv`] |
//! | bump it | [`Material::with_bump`]: the gradient tilts the normal |
//! | show a mesh | [`Mesh::from_mesh`], [`Mesh::smooth`], [`Mesh::flat`], with [`Shape::mesh`] |
//! | light it | [`Light::directional`], [`Light::point`], [`Scene::with_ambient`], [`Environment`] |
//! | smooth edges | [`Supersampling`]: its square is the number of rays per pixel |
//!
//! # Features
//!
//! | feature | default | effect |
//! |---|---|---|
//! | `rayon` | on | renders the rows of an image on all cores; the bits do not change |
//!
//! # Limits
//!
//! * Supersampling is from 1 to 64, and a ray has at most 16 mirror reflections.
//! * Indirect light is not simulated, since the previews are for textures. Shadows are.
//! * Spheres and tori can be cut open. Planes and meshes cannot.
//! * The world is right-handed with y up; a camera on the positive z axis sees x to the right. Lengths are in units of
//!   the world, or of the object where stated. Angles are in radians. Row 0 of an image is at the top.
//! * Colors are linear and not tone mapped. Clamp values above 1 yourself.
//! * The crate contains no textures, accesses no files, and does not use the GPU.
//! * Values are computed with `+ − × ÷ sqrt floor` and `libm` only. An image has the same bits on every platform and
//!   any number of threads if the closures do.
//!
//! # Without std
//!
//! Not possible today. `floor` and `sqrt` of `f64` are methods of std, and `dapple-raster`, `dapple-color` and
//! `dapple-mesh` need std.
//!
//! # How it works
//!
//! One ray per sample of a regular grid finds the nearest shape. Planes and spheres are intersected in closed form,
//! tori by the roots of their quartic, meshes by a bounding volume hierarchy. A texture's gradient tilts the normal
//! (Blinn 1978), shadow rays test the lights, and a mirror sends a ray that sees the other objects and the environment.

#![forbid(unsafe_code)]

mod bump;
mod camera;
mod environment;
mod error;
mod light;
mod material;
mod object;
mod ray;
mod scene;
mod shape;
mod surface;
mod trace;
mod traced;
mod transform;

pub use camera::Camera;
pub use dapple_color as color;
pub use dapple_mesh as mesh;
pub use dapple_raster as raster;
pub use environment::{Environment, Sky, Sun};
pub use error::{PreviewError, PreviewErrorKind};
pub use glam;
pub use light::{Falloff, Light, LightSource, Shadows};
pub use material::{Material, Mirror};
pub use object::Object;
pub use scene::{Scene, Supersampling};
pub use shape::{Cut, Shape};
pub use surface::{Part, Surface, Triangle};
pub use traced::Mesh;
pub use transform::Transform;
