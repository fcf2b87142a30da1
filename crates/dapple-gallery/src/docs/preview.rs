//! Renders the rows of images for the documentation of `dapple-preview`.

use super::picture::{SIDE, banner, colored};
use super::{Documented, Strip};
use crate::Panel;
use core::f64::consts::PI;
use dapple_color::LinearRgb;
use dapple_models as models;
use dapple_preview::{
    Camera, Cut, Environment, Light, Material, Mesh, Mirror, Object, Scene, Shadows, Shape, Sky,
    Supersampling, Surface,
};
use glam::DVec3;

/// The folder of the crate and its rows of images, in the order of its documentation.
pub(super) const DOCUMENTED: Documented = Documented {
    folder: "crates/dapple-preview",
    strips: &[SHAPE, CUT, SHADOWS, MATERIAL, MIRROR],
    banner: || {
        let figures = [
            ("worley-fig-03", 0),
            ("worley-fig-05", 0),
            ("worley-fig-06", 0),
            ("worley-fig-extra-radial", 0),
        ];
        banner(&figures)
    },
};

/// Number of shades per channel. It is higher than in other strips, since light changes smoothly.
const COLORS: f32 = 20.0;

const SHAPE: Strip = Strip {
    name: "shape",
    caption: "",
    render: || {
        let ray = Mesh::from_mesh(models::ray(2000)?);
        [
            ("plane", Shape::Plane),
            ("rectangle", Shape::rectangle(1.0, 0.6)),
            ("sphere", Shape::sphere(1.0)),
            ("torus", Shape::torus(0.8, 0.35)),
            ("mesh", Shape::mesh(ray)),
        ]
        .into_iter()
        .map(|(label, shape)| scene(label, |scene| scene.with_object(Object::new(shape, boards))))
        .collect()
    },
};

const CUT: Strip = Strip {
    name: "cut",
    caption: "",
    render: || {
        let half = Cut::HalfSpace {
            normal: DVec3::new(0.2, 0.6, 1.0),
            offset: 0.2,
        };
        let sector = Cut::Sector {
            start: -0.2 * PI,
            sweep: 1.4 * PI,
        };
        [("half space", half), ("sector", sector)]
            .into_iter()
            .map(|(label, cut)| {
                let object = Object::new(Shape::torus(0.8, 0.4), boards).with_cut(cut);
                scene(label, |scene| scene.with_object(object))
            })
            .collect()
    },
};

const SHADOWS: Strip = Strip {
    name: "shadows",
    caption: "",
    render: || {
        let soft = Shadows::Soft {
            radius: 0.12,
            rays: 24,
        };
        [
            ("none", Shadows::None),
            ("hard", Shadows::Hard),
            ("soft", soft),
        ]
        .into_iter()
        .map(|(label, shadows)| {
            let ground = |_: &Surface| Material::matte(LinearRgb::gray(0.5));
            let ball = |_: &Surface| Material::matte(LinearRgb::new(0.6, 0.25, 0.1));
            scene(label, |mut scene| {
                scene.lights[0].shadows = shadows;
                scene
                    .with_object(Object::new(Shape::Plane, ground).at(DVec3::NEG_Y * 0.6))
                    .with_object(Object::new(Shape::sphere(0.6), ball))
            })
        })
        .collect()
    },
};

const MATERIAL: Strip = Strip {
    name: "material",
    caption: "",
    render: || {
        let matte = |_: &Surface| Material::matte(LinearRgb::new(0.6, 0.25, 0.1));
        let shiny = move |at: &Surface| matte(at).with_specular(0.6, 40.0);
        let bumpy = move |at: &Surface| {
            let wave = (at.position * 14.0).map(libm::sin);
            shiny(at).with_bump(wave * 0.6)
        };
        let ball = |label: &str, look: &(dyn Fn(&Surface) -> Material + Sync + Send)| {
            let object = Object::new(Shape::sphere(1.0), |at: &Surface| look(at));
            scene(label, |scene| scene.with_object(object))
        };
        Ok(vec![
            ball("matte", &matte)?,
            ball("with highlights", &shiny)?,
            ball("with a bump", &bumpy)?,
        ])
    },
};

const MIRROR: Strip = Strip {
    name: "mirror",
    caption: "",
    render: || {
        [
            ("constant, 0.5", Mirror::Constant(0.5)),
            ("Fresnel, 0.04", Mirror::Fresnel(0.04)),
        ]
        .into_iter()
        .map(|(label, mirror)| {
            let ball = move |_: &Surface| {
                Material::matte(LinearRgb::new(0.05, 0.1, 0.3)).with_mirror(mirror)
            };
            scene(label, |scene| {
                scene
                    .with_object(Object::new(Shape::Plane, boards).at(DVec3::NEG_Y * 0.8))
                    .with_object(Object::new(Shape::sphere(0.8), ball))
            })
        })
        .collect()
    },
};

/// Renders a scene with a light and a gray sky, to which `fill` adds the objects.
fn scene<'a>(label: &str, fill: impl FnOnce(Scene<'a>) -> Scene<'a>) -> anyhow::Result<Panel> {
    let sky = Sky {
        nadir: LinearRgb::gray(0.5),
        horizon: LinearRgb::gray(0.75),
        zenith: LinearRgb::gray(0.9),
    };
    let camera = Camera::look_at(DVec3::new(1.2, 1.7, 2.8), DVec3::ZERO).with_fov(0.62);
    let empty = Scene::new(camera)
        .with_light(Light::directional(
            DVec3::new(-0.6, 1.2, 0.7),
            LinearRgb::gray(0.9),
        ))
        .with_ambient(LinearRgb::gray(0.15))
        .with_environment(Environment::Sky(sky));
    let picture = fill(empty).render([SIDE; 2], Supersampling(3))?;
    Ok(colored(label, &picture, COLORS))
}

/// Returns a material with a solid checkerboard in two colors.
fn boards(surface: &Surface) -> Material {
    let board = (surface.position * 4.0 + 0.01).floor().element_sum() * 0.5;
    let color = if board == board.floor() {
        LinearRgb::new(0.7, 0.55, 0.3)
    } else {
        LinearRgb::new(0.1, 0.2, 0.3)
    };
    Material::matte(color).with_specular(0.1, 30.0)
}
