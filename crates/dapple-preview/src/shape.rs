//! The shapes of a scene, and their intersection with rays.
//!
//! Closed shapes are intersected as solids. [`solid`] lists the intervals of a ray inside the solid, and [`cut`]
//! removes parts of them. The remaining intervals begin and end at the skin or at the flat face of a cut.

mod cut;
mod solid;

pub use cut::Cut;

use crate::ray::Ray;
use crate::surface::{Chart, Part};
use crate::traced::Mesh;
use crate::{PreviewError, PreviewErrorKind};
use dapple_mesh::RayHit;
use glam::{DVec2, DVec3};
use solid::{Boundary, Skin, Solid};
use std::sync::Arc;

/// The geometry of an object, in object space.
///
#[cfg_attr(doc, doc = include_str!("../docs/shape.md"))]
#[derive(Clone, Debug)]
#[non_exhaustive]
pub enum Shape {
    /// The infinite plane `y = 0`.
    Plane,
    /// A rectangle in the plane `y = 0`, centered at the origin.
    Rectangle {
        /// Half-side lengths along x and z, above zero.
        half_size: DVec2,
    },
    /// A sphere around the origin.
    Sphere {
        /// The radius, above zero.
        radius: f64,
    },
    /// A torus around the y axis, in the plane `y = 0`.
    Torus {
        /// The radius of the circle in the middle of the tube, above zero.
        major_radius: f64,
        /// The radius of the tube, above zero and at most the major radius.
        minor_radius: f64,
    },
    /// A triangle mesh.
    Mesh(Arc<Mesh>),
}

impl Shape {
    /// Creates a sphere around the origin.
    #[must_use]
    pub fn sphere(radius: f64) -> Self {
        Self::Sphere { radius }
    }

    /// Creates a torus around the y axis. `major_radius` is the radius of the circle along the middle of the tube;
    /// `minor_radius` is the radius of the tube.
    #[must_use]
    pub fn torus(major_radius: f64, minor_radius: f64) -> Self {
        Self::Torus {
            major_radius,
            minor_radius,
        }
    }

    /// Creates a rectangle in the plane `y = 0`, centered at the origin, from its half-side lengths along x and z.
    #[must_use]
    pub fn rectangle(half_x: f64, half_z: f64) -> Self {
        let half_size = DVec2::new(half_x, half_z);
        Self::Rectangle { half_size }
    }

    /// Creates a shape from a triangle mesh. Pass an `Arc` to share it between objects.
    #[must_use]
    pub fn mesh(mesh: impl Into<Arc<Mesh>>) -> Self {
        Self::Mesh(mesh.into())
    }

    pub(crate) fn prepare(&self, cut: Option<Cut>) -> Result<Body<'_>, PreviewError> {
        let no_cut = |shape| match cut {
            Some(_) => Err(PreviewError::new(PreviewErrorKind::NotSolid { shape })),
            None => Ok(()),
        };
        let skin = match self {
            Self::Plane => {
                no_cut("plane")?;
                let half_size = DVec2::INFINITY;
                return Ok(Body::Flat { half_size });
            }
            Self::Rectangle { half_size } => {
                no_cut("rectangle")?;
                let half_size = *half_size;
                PreviewError::check_length("half of a side of a rectangle", half_size.x)?;
                PreviewError::check_length("half of a side of a rectangle", half_size.y)?;
                return Ok(Body::Flat { half_size });
            }
            Self::Mesh(mesh) => {
                no_cut("mesh")?;
                return Ok(Body::Mesh(mesh));
            }
            Self::Sphere { radius } => {
                PreviewError::check_length("radius of a sphere", *radius)?;
                Skin::Sphere { radius: *radius }
            }
            Self::Torus {
                major_radius,
                minor_radius,
            } => {
                let [major, minor] = [*major_radius, *minor_radius];
                PreviewError::check_length("major radius of a torus", major)?;
                PreviewError::check_length("minor radius of a torus", minor)?;
                let what = "minor radius of a torus";
                let range = "at most the major radius";
                PreviewError::check(minor <= major, what, minor, range)?;
                Skin::Torus { major, minor }
            }
        };
        let wedge = cut.map(|cut| cut.prepare()).transpose()?;
        Ok(Body::Solid(Solid { skin, wedge }))
    }
}

/// A validated shape, prepared for intersection.
#[derive(Debug)]
pub(crate) enum Body<'a> {
    Flat { half_size: DVec2 },
    Solid(Solid),
    Mesh(&'a Mesh),
}

/// The intersection of a ray and a body, with only the data needed to find the nearest one.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Hit {
    /// The distance along the ray, above zero.
    pub(crate) distance: f64,
    face: HitFace,
}

#[derive(Clone, Copy, Debug)]
enum HitFace {
    Flat,
    Solid(Boundary),
    Triangle(RayHit),
}

/// The position and normals of a body at a hit, in object space. The normals may point to either side.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Detail {
    pub(crate) position: DVec3,
    pub(crate) geometric_normal: DVec3,
    pub(crate) normal: DVec3,
    pub(crate) part: Part,
    pub(crate) chart: Chart,
    /// Origin of shadow rays. On a mesh with vertex normals, it is a point on the smooth surface that the triangle
    /// approximates; otherwise the position.
    pub(crate) lit_position: DVec3,
}

impl Body<'_> {
    /// Returns the nearest intersection of a ray and the body, at a distance above zero and below `limit`.
    pub(crate) fn hit(&self, ray: &Ray, limit: f64) -> Option<Hit> {
        let (distance, face) = match self {
            Body::Flat { half_size } => (flat_hit(ray, *half_size)?, HitFace::Flat),
            Body::Solid(solid) => {
                let boundary = solid.hit(ray)?;
                (boundary.distance, HitFace::Solid(boundary))
            }
            Body::Mesh(mesh) => {
                let hit = mesh.first_hit(ray, limit)?;
                (hit.distance, HitFace::Triangle(hit))
            }
        };
        (distance < limit).then_some(Hit { distance, face })
    }

    /// Returns whether a ray intersects the body at a distance above zero and below `limit`.
    pub(crate) fn blocks(&self, ray: &Ray, limit: f64) -> bool {
        match self {
            Body::Mesh(mesh) => mesh.is_blocked(ray, limit),
            Body::Flat { .. } | Body::Solid(_) => self.hit(ray, limit).is_some(),
        }
    }

    /// Returns the position, normals and surface coordinates at `hit`, an intersection with `ray`.
    pub(crate) fn detail(&self, ray: &Ray, hit: &Hit) -> Detail {
        let position = ray.at(hit.distance);
        match (self, hit.face) {
            (Body::Solid(solid), HitFace::Solid(boundary)) => {
                let (normal, part, chart) = solid.detail(position, boundary.face);
                Detail::flat(position, normal, part, chart)
            }
            (Body::Mesh(mesh), HitFace::Triangle(hit)) => mesh.detail(position, &hit),
            // The kinds of body and hit always match, so the remaining case is a plane.
            _ => {
                let position = DVec3::new(position.x, 0.0, position.z);
                Detail::flat(position, DVec3::Y, Part::Skin, Chart::Plane)
            }
        }
    }
}

impl Detail {
    /// Creates the detail of a point on a surface without interpolated normals.
    fn flat(position: DVec3, normal: DVec3, part: Part, chart: Chart) -> Self {
        Self {
            position,
            geometric_normal: normal,
            normal,
            part,
            chart,
            lit_position: position,
        }
    }
}

/// Returns the distance at which a ray hits the rectangle in the plane `y = 0`.
fn flat_hit(ray: &Ray, half_size: DVec2) -> Option<f64> {
    let distance = -ray.origin.y / ray.direction.y;
    // The condition also fails for NaN, which results from a ray within the plane.
    if !(distance > 0.0 && distance.is_finite()) {
        return None;
    }
    let at = ray.at(distance);
    (at.x.abs() <= half_size.x && at.z.abs() <= half_size.y).then_some(distance)
}

#[cfg(test)]
mod tests;
