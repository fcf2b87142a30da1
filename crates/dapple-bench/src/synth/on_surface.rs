//! Orientation and continuity of a texture on a surface: stripes follow the field, and colors do not jump at mesh
//! edges.
//!
//! A texture's direction is the direction of least change, from the structure tensor of the sites around each
//! site: Josef Bigün and Gösta Granlund, "Optimal Orientation Detection of Linear Symmetry", ICCV 1987.
//!
//! Colors are compared slightly to the left and to the right of every edge. Equation 1 bounds their difference: a
//! weight changes by at most 1.5 over the radius, and a mean of colors changes by at most the sum of the weights'
//! changes, each times the distance of its color from the mean.

use super::scene::{N_SITES, model, synthesizer};
use crate::harness::{Bench, median};
use crate::row::{Case, Goal, Unit};
use anyhow::{Context as _, Result, ensure};
use dapple_color::LinearRgb;
use dapple_mesh::{FaceEdge, FaceIdx};
use dapple_raster::Raster;
use dapple_synth::{Edges, Exemplar, INTERPOLATION_RADIUS, Options, SiteIdx, Synthesizer};
use glam::{DMat2, DVec2, DVec3};

const ORIENTATION: Case = Case {
    group: "synth",
    case: "orientation of features, median turn from the field",
    peer: "the limit of 5 degrees",
    unit: Unit::Degrees,
    must: Goal::CostAtMost(1.0),
    note: "",
};

const JUMPS: Case = Case {
    case: "jumps across input edges, the largest over its bound",
    peer: "the bound of the interpolation",
    unit: Unit::Thousandths,
    ..ORIENTATION
};

/// Distance from an edge at which colors are compared, in multiples of the site spacing.
const ASIDE: f64 = 0.01;

/// Maximum rounding error of colors. They are sums of about five `f32` values from 0 to 1, each rounded a few times by
/// up to 2^-24.
const ROUNDING: f64 = 1e-6;

pub(super) fn run(bench: &mut Bench) -> Result<()> {
    if !bench.wants_any(&[ORIENTATION, JUMPS]) {
        return Ok(());
    }
    let model = model()?;
    let synthesizer = synthesizer(&model, N_SITES, 3)?;
    let texture = synthesizer.synthesize(&stripes()?, &Options::default())?;
    let note = format!("upright stripes, 262,144 sites; {}", model.note);
    let striped = Striped {
        values: texture.values(0).chunks(3).map(|color| color[0]).collect(),
        synthesizer: &synthesizer,
    };
    if bench.wants(&ORIENTATION) {
        let sites = || synthesizer.hierarchy().sites().iter();
        let gradients: Vec<DVec3> = sites().map(|site| striped.gradient(site)).collect();
        let mut turns: Vec<f64> = sites().map(|site| striped.turn(site, &gradients)).collect();
        bench.measured_with(&ORIENTATION, median(&mut turns), 5.0, note.clone());
    }
    if bench.wants(&JUMPS) {
        let [found, bound] = striped.largest_jump()?;
        bench.measured_with(&JUMPS, found, bound, note);
    }
    Ok(())
}

/// Builds an exemplar with seven vertical stripes in 56 pixels: the texture changes only along P.
fn stripes() -> Result<Exemplar> {
    let image = Raster::from_fn([56, 56], |x, _| {
        let turns = f64::from(x % 8) / 8.0;
        let wave = 1.0 - (2.0 * turns - 1.0).abs();
        LinearRgb::gray((0.1 + 0.8 * wave) as f32)
    })?;
    Ok(Exemplar::new(&image, Edges::Wrap)?)
}

/// A surface with a texture of stripes.
struct Striped<'a> {
    synthesizer: &'a Synthesizer,
    /// sRGB code of each site, from 0 to 1.
    values: Vec<f32>,
}

impl Striped<'_> {
    /// Returns the gradient of the color at a site that best fits the differences to its neighbors. A sum over edges
    /// would be biased where neighbors are unevenly distributed.
    fn gradient(&self, site: SiteIdx) -> DVec3 {
        let hierarchy = self.synthesizer.hierarchy();
        let sites = hierarchy.sites();
        let value = |site: SiteIdx| f64::from(self.values[site.index()]);
        let (right, down) = sites.normals()[site.index()].any_orthonormal_pair();
        let mut normal = DMat2::ZERO;
        let mut sums = DVec2::ZERO;
        for &other in hierarchy.levels()[0].graph().neighbors(site) {
            let step = sites.positions()[other.index()] - sites.positions()[site.index()];
            let step = DVec2::new(step.dot(right), step.dot(down));
            normal += DMat2::from_cols(step * step.x, step * step.y);
            sums += step * (value(other) - value(site));
        }
        // If all neighbors lie on a line, the gradient perpendicular to it is unknown.
        let trace = normal.x_axis.x + normal.y_axis.y;
        if normal.determinant() < 1e-6 * trace * trace {
            return DVec3::ZERO;
        }
        let gradient = normal.inverse() * sums;
        right * gradient.x + down * gradient.y
    }

    /// Returns the angle between the field and the direction of least change at a site, in degrees.
    fn turn(&self, site: SiteIdx, gradients: &[DVec3]) -> f64 {
        let hierarchy = self.synthesizer.hierarchy();
        let (sites, level) = (hierarchy.sites(), &hierarchy.levels()[0]);
        let down = self.synthesizer.orientation().vectors()[site.index()];
        let right = sites.normals()[site.index()].cross(down);
        let center = sites.positions()[site.index()];
        let (mut xx, mut xy, mut yy) = (0.0, 0.0, 0.0);
        // A ball as wide as a stripe and its gap always contains an edge.
        level.grid().visit(center, 4.0 * level.spacing(), |near| {
            let gradient = gradients[near.index()];
            let (x, y) = (gradient.dot(right), gradient.dot(down));
            xx += x * x;
            xy += x * y;
            yy += y * y;
        });
        // The direction of maximum change is P if the texture follows the field.
        (0.5 * libm::atan2(2.0 * xy, xx - yy)).abs().to_degrees()
    }

    /// Returns the difference in sRGB codes across the edge where it is largest relative to its bound, and this bound.
    fn largest_jump(&self) -> Result<[f64; 2]> {
        let surface = self.synthesizer.surface();
        let (mut largest, mut n_edges) = ([0.0, f64::INFINITY], 0);
        for face in (0..surface.mesh().faces().len() as u32).map(FaceIdx) {
            for edge in 0..3 {
                let Some(other) = surface.adjacency().across(FaceEdge { face, edge }) else {
                    continue;
                };
                let [found, bound] = self.jump(FaceEdge { face, edge }, other.face)?;
                if found / bound > largest[0] / largest[1] {
                    largest = [found, bound];
                }
                n_edges += 1;
            }
        }
        ensure!(n_edges > 1000, "there are only {n_edges} edges");
        Ok(largest)
    }

    /// Returns the difference in sRGB codes across an edge, and its bound.
    fn jump(&self, here: FaceEdge, there: FaceIdx) -> Result<[f64; 2]> {
        let (surface, hierarchy) = (self.synthesizer.surface(), self.synthesizer.hierarchy());
        let corners = surface.mesh().corners(here.face);
        let edge = usize::from(here.edge);
        let at = corners[edge].lerp(corners[(edge + 1) % 3], 0.4);
        let aside = ASIDE * hierarchy.levels()[0].spacing();
        let mut shown = [(DVec3::ZERO, 0.0); 2];
        for (shown, face) in shown.iter_mut().zip([here.face, there]) {
            let corners = surface.mesh().corners(face);
            let middle = (corners[0] + corners[1] + corners[2]) / 3.0;
            let at = at + (middle - at).clamp_length_max(aside);
            let normal = surface.normal(surface.project(face, at));
            let value = hierarchy.interpolate(0, &self.values, at, normal)?;
            *shown = (at, f64::from(value.context("a color")?));
        }
        let [(here, color), (there, other)] = shown;
        Ok([(color - other).abs(), self.bound([here, there], color)])
    }

    /// Returns an upper bound for the change of the interpolated color between two positions. `color` is the
    /// interpolated color at one of them.
    fn bound(&self, [here, there]: [DVec3; 2], color: f64) -> f64 {
        let hierarchy = self.synthesizer.hierarchy();
        let (sites, level) = (hierarchy.sites(), &hierarchy.levels()[0]);
        let radius = INTERPOLATION_RADIUS * level.spacing();
        let (mut spread, mut weights) = (0.0, 0.0);
        level
            .grid()
            .visit(here, radius + here.distance(there), |site| {
                let [x, y] =
                    [here, there].map(|at| sites.positions()[site.index()].distance(at) / radius);
                if x < 1.0 || y < 1.0 {
                    spread += (f64::from(self.values[site.index()]) - color).abs();
                    weights += if y < 1.0 {
                        (2.0 * y - 3.0) * y * y + 1.0
                    } else {
                        0.0
                    };
                }
            });
        1.5 * here.distance(there) / radius * spread / weights + ROUNDING
    }
}
