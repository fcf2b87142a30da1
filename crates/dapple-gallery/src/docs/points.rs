//! Renders the rows of images for the documentation of `dapple-points`.

use super::picture::{GRAYS, LARGE, banner_of, shaded};
use super::{Documented, Strip};
use crate::Panel;
use crate::draw::Canvas;
use dapple_points::{
    Domain, PointSet, VariablePoissonOptions, extend_poisson_disk, hash::Seed, jittered_grid,
    nested_poisson_disk, poisson_disk, variable_poisson_disk, white_noise,
};
use dapple_raster::{Ramp, Varying, Window};
use glam::DVec2;

/// The folder of the crate and its rows of images, in the order of its documentation.
pub(super) const DOCUMENTED: Documented = Documented {
    folder: "crates/dapple-points",
    strips: &[POISSON_DISK, EXTENDED, NESTED, VARIABLE, WHITE, JITTERED],
    banner: || {
        let side = super::picture::BANNER;
        let [jittered, poisson] = [
            jittered_grid(domain(), [15; 2], 1.0, SEED)?,
            poisson_disk(domain(), 0.11, SEED)?,
        ];
        banner_of(&[
            dots("", &white_noise(domain(), 225, SEED)?, side)?,
            dots("", &jittered, side)?,
            dots("", &poisson, side)?,
            nested(0.16, side)?,
            dots("", &variable()?, side)?,
        ])
    },
};

const SEED: Seed = Seed(4);

/// Radius of a drawn point, in pixels.
const RADIUS: f64 = 1.6;

const POISSON_DISK: Strip = Strip {
    name: "poisson-disk",
    caption: "Radius, in the square [-1, 1]² that wraps",
    render: || {
        [("0.3", 0.3), ("0.2", 0.2), ("0.1", 0.1)]
            .into_iter()
            .map(|(label, radius)| dots(label, &poisson_disk(domain(), radius, SEED)?, LARGE))
            .collect()
    },
};

const EXTENDED: Strip = Strip {
    name: "extend-poisson-disk",
    caption: "",
    render: || {
        let given = white_noise(domain(), 12, SEED)?;
        let all = extend_poisson_disk(&given, 0.15, SEED)?;
        let mut canvas = canvas(LARGE)?;
        canvas.points(&all, RADIUS, 0.0);
        canvas.points(&given, 2.5 * RADIUS, 0.0);
        Ok(vec![
            dots("12 given points", &given, LARGE)?,
            panel("those, large, and the others", canvas),
        ])
    },
};

const NESTED: Strip = Strip {
    name: "nested-poisson-disk",
    caption: "",
    render: || {
        Ok(vec![nested(0.16, LARGE)?.with_label(
            "three levels; the points of coarser levels are larger",
        )])
    },
};

const VARIABLE: Strip = Strip {
    name: "variable-poisson-disk",
    caption: "",
    render: || {
        let points = variable()?;
        Ok(vec![dots(
            "a radius from 0.3 at the left to 0.05 at the right",
            &points,
            LARGE,
        )?])
    },
};

const WHITE: Strip = Strip {
    name: "white-noise",
    caption: "",
    render: || {
        let points = white_noise(domain(), 225, SEED)?;
        Ok(vec![dots("225 points", &points, LARGE)?])
    },
};

const JITTERED: Strip = Strip {
    name: "jittered-grid",
    caption: "15 × 15 cells, jitter",
    render: || {
        [("0", 0.0), ("0.5", 0.5), ("1", 1.0)]
            .into_iter()
            .map(|(label, jitter)| {
                let points = jittered_grid(domain(), [15; 2], jitter, SEED)?;
                dots(label, &points, LARGE)
            })
            .collect()
    },
};

fn domain() -> Domain {
    Domain::paper_torus()
}

/// Returns points whose radius varies from left to right, on a domain that wraps from top to bottom.
fn variable() -> anyhow::Result<PointSet> {
    let domain = Domain {
        wrap: [false, true],
        ..domain()
    };
    let radius = Varying::GeometricRamp(Ramp {
        from: DVec2::new(-1.0, 0.0),
        to: DVec2::new(1.0, 0.0),
        start: 0.3,
        end: 0.05,
    });
    let options = VariablePoissonOptions::default();
    Ok(variable_poisson_disk(domain, &radius, &options, SEED)?)
}

/// Draws three nested levels, each with half the radius of the previous one.
fn nested(finest: f64, side: u32) -> anyhow::Result<Panel> {
    let radii = [4.0 * finest, 2.0 * finest, finest];
    let nested = nested_poisson_disk(domain(), &radii, SEED)?;
    let mut canvas = canvas(side)?;
    for (level, size) in [(2, 0.9), (1, 1.8), (0, 3.0)] {
        if let Some(points) = nested.level(level) {
            canvas.points(&points, size * RADIUS, 0.0);
        }
    }
    Ok(panel("", canvas))
}

fn dots(label: &str, points: &PointSet, side: u32) -> anyhow::Result<Panel> {
    let mut canvas = canvas(side)?;
    canvas.points(points, RADIUS, 0.0);
    Ok(panel(label, canvas))
}

fn canvas(side: u32) -> anyhow::Result<Canvas<f32>> {
    let domain = domain();
    let window = Window::new(domain.origin, domain.size, [side; 2])?;
    Ok(Canvas::new(&window, 1.0)?)
}

fn panel(label: &str, canvas: Canvas<f32>) -> Panel {
    shaded(label, &canvas.into_raster(), GRAYS)
}
