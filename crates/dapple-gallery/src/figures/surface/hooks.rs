//! Draws woven strands of hooks; each hook reaches over the shank of a hook in the next strand and comes back under
//! it.
//!
//! Strands run down to the right. The image tiles.

use crate::draw::{sampled, smooth_step};
use dapple_color::{ColorRamp, LinearRgb};
use dapple_raster::Raster;
use glam::{DVec2, DVec3};

/// Number of hooks along each side of the image. There is one at each point of a square lattice.
const N_HOOKS: i64 = 3;

/// Radius of the wire. All lengths are in multiples of half a diagonal of the lattice, which is the distance between
/// strands.
const WIRE: f64 = 0.19;

/// Center line of the wire, as coordinates along the strand, toward the next strand, and up.
const PATH: [[f64; 3]; 8] = [
    [-1.00, 0.00, -0.10],
    [0.20, 0.00, 0.00],
    [0.52, 0.00, 0.15],
    [0.52, 1.00, 0.50],
    [0.52, 1.55, 0.10],
    [1.24, 1.55, -0.10],
    [1.24, 1.00, -0.50],
    [1.24, 0.50, -0.40],
];

/// Number of line segments in a bend of the wire.
const N_LINES: u32 = 6;

/// Number of samples along each side of a pixel.
const N_SAMPLES: u32 = 4;

/// The wire of one hook.
struct Wire {
    /// Center line of the wire as short segments: straight along its path, rounded at the corners.
    lines: Vec<[DVec3; 2]>,
    /// Bounds of the hook, with axes along and across its strand.
    bounds: [DVec2; 2],
}

/// Draws woven hooks, `size` pixels wide and high.
pub(super) fn hooks(size: u32) -> anyhow::Result<Raster<LinearRgb>> {
    let wire = Wire::new();
    let metal = ColorRamp::from_hex(&["#3a1c08", "#a8641c", "#e9b44c", "#fff0c0"])?;
    let ground = LinearRgb::from_srgb([24_u8, 20, 40]);
    Ok(sampled([size; 2], N_SAMPLES, |at| {
        match highest(&wire, at * N_HOOKS as f64) {
            Some(normal) => metal.at(light(normal) as f32),
            None => ground,
        }
    })?)
}

impl Wire {
    fn new() -> Self {
        let corners = PATH.map(DVec3::from);
        let mut points = vec![corners[0]];
        for bend in corners.windows(3) {
            let [from, to] = [bend[0].midpoint(bend[1]), bend[1].midpoint(bend[2])];
            points.extend((0..=N_LINES).map(|index| {
                let t = f64::from(index) / f64::from(N_LINES);
                from.lerp(bend[1], t).lerp(bend[1].lerp(to, t), t)
            }));
        }
        points.push(corners[corners.len() - 1]);
        let flat = points.iter().map(|point| point.truncate());
        let low = flat.clone().fold(DVec2::INFINITY, DVec2::min);
        let high = flat.fold(DVec2::NEG_INFINITY, DVec2::max);
        Self {
            lines: points.windows(2).map(|ends| [ends[0], ends[1]]).collect(),
            bounds: [low - DVec2::splat(WIRE), high + DVec2::splat(WIRE)],
        }
    }
}

/// Returns the normal of the highest wire at a position of the lattice, or `None` between wires.
fn highest(wire: &Wire, at: DVec2) -> Option<DVec3> {
    let mut top = (f64::NEG_INFINITY, None);
    let cell = at.floor();
    for y in -2..=1 {
        for x in -1..=2 {
            let hook = at - cell - DVec2::new(f64::from(x), f64::from(y));
            let along = DVec2::new(hook.x + hook.y, hook.y - hook.x);
            let [low, high] = wire.bounds;
            if along.cmplt(low).any() || along.cmpgt(high).any() {
                continue;
            }
            for line in &wire.lines {
                if let Some((height, normal)) = surface(*line, along)
                    && height > top.0
                {
                    top = (height, Some(normal));
                }
            }
        }
    }
    top.1
}

/// Returns the height and the normal of a piece of wire with round ends, at a position whose axes are along and
/// across its strand.
fn surface([from, to]: [DVec3; 2], at: DVec2) -> Option<(f64, DVec3)> {
    let length = (to - from).length();
    let axis = (to - from).normalize_or_zero();
    // Compute the point where a vertical line through the position leaves the wire, if the wire were infinitely long.
    let reach = at.extend(0.0) - from;
    let start = reach - reach.dot(axis) * axis;
    let climb = DVec3::Z - axis.z * axis;
    let height = later_root(
        climb.length_squared(),
        start.dot(climb),
        start.length_squared(),
    )?;
    let along = (reach + height * DVec3::Z).dot(axis);
    if (0.0..=length).contains(&along) {
        return Some((height, to_image(start + height * climb)));
    }
    let end = from + along.clamp(0.0, length) * axis;
    let aside = at.extend(0.0) - end;
    let height = later_root(1.0, aside.z, aside.length_squared())?;
    Some((height, to_image(aside + height * DVec3::Z)))
}

/// Returns the larger root `h` of `square · h² + 2 · half · h + rest = WIRE²`; `None` if there is no real root.
fn later_root(square: f64, half: f64, rest: f64) -> Option<f64> {
    let inside = half * half - square * (rest - WIRE * WIRE);
    (inside >= 0.0 && square > 0.0).then(|| (inside.sqrt() - half) / square)
}

/// Converts a normal from axes along and across the strand to image axes.
fn to_image(radius: DVec3) -> DVec3 {
    let turned = DVec2::new(radius.x - radius.y, radius.x + radius.y);
    (turned * core::f64::consts::FRAC_1_SQRT_2).extend(radius.z) / WIRE
}

/// Returns the brightness of a wire lit from the upper left, from 0 to 1.
fn light(normal: DVec3) -> f64 {
    let toward = DVec3::new(-0.45, -0.6, 0.66);
    let shine = 0.9 * normal.dot(toward).max(0.0);
    shine * smooth_step(0.1, 0.6, normal.z)
}
