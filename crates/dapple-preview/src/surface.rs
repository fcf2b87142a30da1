//! Surface points, where rays meet shapes.

use core::f64::consts::{PI, TAU};
use glam::{DVec2, DVec3};

/// A surface point to be shaded.
///
/// Positions and normals are in the space of the object unless stated otherwise, so that a solid texture moves with
/// the object. Normals are unit vectors and point to the visible side.
#[derive(Clone, Copy, Debug)]
#[non_exhaustive]
pub struct Surface {
    /// The position of the point, in object space.
    pub position: DVec3,
    /// The position of the point, in the world.
    pub world_position: DVec3,
    /// The normal of the smooth surface. For a mesh, it is interpolated from the normals of the vertices.
    pub normal: DVec3,
    /// The normal of the actual surface. For a mesh, it is the normal of the triangle.
    pub geometric_normal: DVec3,
    /// Whether the point is on the skin of the shape or on the flat face of a cut.
    pub part: Part,
    /// Width of an image sample perpendicular to the ray, in units of the object. Finer detail cannot be shown.
    ///
    /// At grazing angles, a sample covers a longer piece of the surface: `footprint / incidence`.
    pub footprint: f64,
    /// The cosine of the angle between the ray and `geometric_normal`: 1 for a perpendicular view, toward 0 at grazing
    /// angles.
    pub incidence: f64,
    pub(crate) chart: Chart,
}

/// A part of a shape.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Part {
    /// The surface of the uncut shape.
    Skin,
    /// The flat face where a solid was cut.
    Cut,
}

/// A point on a triangle of a mesh.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Triangle {
    /// The index of the triangle.
    pub index: u32,
    /// The barycentric weights of the corners, which sum to 1, for interpolation of vertex data such as uv.
    pub weights: [f64; 3],
}

/// The surface coordinates of a shape.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Chart {
    None,
    Triangle(Triangle),
    Plane,
    Sphere,
    Torus { major_radius: f64 },
}

impl Surface {
    /// Returns the surface coordinates (u, v); `None` on meshes and on the faces of cuts.
    ///
    /// * Plane and rectangle: x and z, in units of the object. Seen from above with -z up, u goes right and v down.
    /// * Sphere: the angle around y in turns, counterclockwise from +x seen from above, and the angle from +y in half
    ///   turns. Both are from 0 to 1, with v = 0 at the top.
    /// * Torus: the angle around y as on a sphere, and the angle around the tube from the outside toward +y. Both are
    ///   in turns, from 0 to 1.
    #[must_use]
    pub fn uv(&self) -> Option<DVec2> {
        let at = self.position;
        let turn = |y: f64, x: f64| {
            let part = libm::atan2(y, x) / TAU;
            if part < 0.0 { part + 1.0 } else { part }
        };
        let around = || turn(-at.z, at.x);
        let outward = || (at.x * at.x + at.z * at.z).sqrt();
        match self.chart {
            Chart::None | Chart::Triangle(_) => None,
            Chart::Plane => Some(DVec2::new(at.x, at.z)),
            Chart::Sphere => Some(DVec2::new(around(), libm::atan2(outward(), at.y) / PI)),
            Chart::Torus { major_radius } => {
                Some(DVec2::new(around(), turn(at.y, outward() - major_radius)))
            }
        }
    }

    /// Returns the mesh triangle of the point with its barycentric weights; `None` on other shapes.
    #[must_use]
    pub fn triangle(&self) -> Option<Triangle> {
        match self.chart {
            Chart::Triangle(triangle) => Some(triangle),
            _ => None,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{Chart, Part, Surface};
    use glam::{DVec2, DVec3};

    fn uv(chart: Chart, position: DVec3) -> Option<DVec2> {
        let surface = Surface {
            position,
            world_position: position,
            normal: DVec3::Y,
            geometric_normal: DVec3::Y,
            part: Part::Skin,
            footprint: 0.0,
            incidence: 1.0,
            chart,
        };
        surface.uv()
    }

    #[test]
    fn uv_of_a_sphere_goes_around_from_x_to_minus_z_and_down() {
        let at = |x, y, z| uv(Chart::Sphere, DVec3::new(x, y, z)).unwrap();
        assert_eq!(at(2.0, 0.0, 0.0), DVec2::new(0.0, 0.5), "+x");
        assert_eq!(at(0.0, 0.0, -2.0), DVec2::new(0.25, 0.5), "-z");
        assert_eq!(at(0.0, 0.0, 2.0), DVec2::new(0.75, 0.5), "+z");
        assert_eq!(at(0.0, 2.0, 0.0).y, 0.0, "top");
        assert_eq!(at(0.0, -2.0, 0.0).y, 1.0, "bottom");
    }

    #[test]
    fn uv_of_a_torus_goes_around_it_and_around_its_tube() {
        let chart = Chart::Torus { major_radius: 2.0 };
        let at = |x, y, z| uv(chart, DVec3::new(x, y, z)).unwrap();
        assert_eq!(at(3.0, 0.0, 0.0), DVec2::new(0.0, 0.0), "outside");
        assert_eq!(at(0.0, 1.0, -2.0), DVec2::new(0.25, 0.25), "top");
        assert_eq!(at(-1.0, 0.0, 0.0), DVec2::new(0.5, 0.5), "hole");
        assert_eq!(at(2.0, -1.0, 0.0), DVec2::new(0.0, 0.75), "bottom");
    }

    #[test]
    fn uv_of_a_plane_is_x_and_z_and_of_a_mesh_nothing() {
        let at = DVec3::new(3.0, 0.0, -4.0);
        assert_eq!(uv(Chart::Plane, at), Some(DVec2::new(3.0, -4.0)), "plane");
        assert_eq!(uv(Chart::None, at), None, "mesh");
    }
}
