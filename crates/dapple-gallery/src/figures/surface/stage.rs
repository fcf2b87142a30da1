//! Renders lit images of meshes.

use anyhow::Result;
use dapple_color::LinearRgb;
use dapple_preview::{
    Camera, Environment, Light, Material, Mesh, Object, Scene, Shape, Sky, Supersampling, Surface,
};
use dapple_raster::Raster;
use glam::DVec3;

/// A view of a mesh: the eye, its target, and the field of view.
#[derive(Clone, Copy, Debug)]
pub(crate) struct View {
    pub(crate) eye: DVec3,
    pub(crate) target: DVec3,
    /// The vertical field of view, in radians.
    pub(crate) fov: f64,
}

impl View {
    /// Returns the view from the opposite side, at the same distance from the target, and as far below it as the eye
    /// was above.
    pub(crate) fn opposite(self) -> Self {
        Self {
            eye: self.target * 2.0 - self.eye,
            ..self
        }
    }
}

/// Returns views from four sides, slightly from above, far enough away to show the whole mesh.
pub(super) fn views(mesh: &dapple_synth::mesh::Mesh) -> [View; 4] {
    let positions = mesh.positions().iter().copied();
    let low = positions.clone().fold(DVec3::INFINITY, DVec3::min);
    let high = positions.clone().fold(DVec3::NEG_INFINITY, DVec3::max);
    let target = low * 0.5 + high * 0.5;
    let radius = positions.map(|at| at.distance(target)).fold(0.0, f64::max);
    let view = |toward: DVec3| View {
        eye: target + toward.normalize() * (3.6 * radius),
        target,
        fov: 0.6,
    };
    [
        view(DVec3::new(0.5, 0.4, 1.0)),
        view(DVec3::new(1.0, 0.4, -0.5)),
        view(DVec3::new(-0.5, 0.4, -1.0)),
        view(DVec3::new(-1.0, 0.4, 0.5)),
    ]
}

/// Renders a mesh in a plain room, with two lights from above that follow the eye.
pub(crate) fn lit(
    mesh: &dapple_synth::mesh::Mesh,
    view: &View,
    size: [u32; 2],
    color: impl Fn(&Surface) -> LinearRgb + Send + Sync,
) -> Result<Raster<LinearRgb>> {
    let toward = (view.eye - view.target).normalize();
    let right = DVec3::Y.cross(toward).normalize();
    let look = |surface: &Surface| Material::matte(color(surface)).with_specular(0.06, 25.0);
    let shape = Shape::mesh(Mesh::from_mesh(mesh.clone()));
    let room = Sky {
        nadir: LinearRgb::gray(0.55),
        horizon: LinearRgb::gray(0.8),
        zenith: LinearRgb::gray(0.9),
    };
    let key = Light::directional(toward - right * 0.5 + DVec3::Y * 0.9, LinearRgb::gray(0.75));
    let fill = Light::directional(toward + right * 0.9 + DVec3::Y * 0.2, LinearRgb::gray(0.3));
    let scene = Scene::new(Camera::look_at(view.eye, view.target).with_fov(view.fov))
        .with_object(Object::new(shape, look))
        .with_light(key)
        .with_light(fill)
        .with_ambient(LinearRgb::gray(0.22))
        .with_environment(Environment::Sky(room));
    Ok(scene.render(size, Supersampling(2))?)
}
