//! Strands of hooks, woven: each hook reaches over the shank of one in the next strand and comes back under it.
//!
//! Strands run down to the right. It repeats.

use crate::draw::{sampled, smooth_step};
use dapple_color::{ColorRamp, LinearRgb};
use dapple_raster::Raster;
use glam::{DVec2, DVec3};

/// Hooks along a side of the image; there is one at each point of a square lattice.
const N_HOOKS: i64 = 3;

/// The radius of the wire. Lengths are half a diagonal of the lattice, the distance between strands.
const WIRE: f64 = 0.215;

/// The middle of the wire: how far along the strand, how far toward the next strand, and how high.
const PATH: [[f64; 3]; 8] = [
    [-0.85, 0.00, -0.10],
    [0.25, 0.00, 0.00],
    [0.66, 0.00, 0.20],
    [0.66, 1.00, 0.50],
    [0.66, 1.46, 0.00],
    [1.26, 1.46, -0.10],
    [1.26, 1.00, -0.50],
    [1.26, 0.52, -0.30],
];

/// Straight lines that a bend of the wire is made of.
const N_LINES: u32 = 6;

/// Samples along the side of a pixel.
const N_SAMPLES: u32 = 4;

/// Woven hooks, `size` pixels wide and high.
pub(super) fn hooks(size: u32) -> anyhow::Result<Raster<LinearRgb>> {
    let wire = wire();
    let metal = ColorRamp::from_hex(&["#3a1c08", "#a8641c", "#e9b44c", "#fff0c0"])?;
    let ground = LinearRgb::from_srgb([24_u8, 20, 40]);
    Ok(sampled([size; 2], N_SAMPLES, |at| {
        match highest(&wire, at * N_HOOKS as f64) {
            Some(normal) => metal.at(light(normal) as f32),
            None => ground,
        }
    })?)
}

/// The middle of a wire as short lines: straight between its corners and round about them.
fn wire() -> Vec<[DVec3; 2]> {
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
    points.windows(2).map(|ends| [ends[0], ends[1]]).collect()
}

/// The normal of what lies highest at a position of the lattice; none between the wires.
fn highest(wire: &[[DVec3; 2]], at: DVec2) -> Option<DVec3> {
    let mut top = (f64::NEG_INFINITY, None);
    let cell = at.floor();
    for y in -2..=1 {
        for x in -1..=2 {
            let hook = at - cell - DVec2::new(f64::from(x), f64::from(y));
            let along = DVec2::new(hook.x + hook.y, hook.y - hook.x);
            for line in wire {
                if let Some((height, normal)) = surface(*line, along) {
                    if height > top.0 {
                        top = (height, Some(normal));
                    }
                }
            }
        }
    }
    top.1
}

/// The height and the normal of a piece of wire at a position along and across its strand.
fn surface([from, to]: [DVec3; 2], at: DVec2) -> Option<(f64, DVec3)> {
    let (way, reach) = ((to - from).truncate(), at - from.truncate());
    let t = (reach.dot(way) / way.length_squared().max(f64::MIN_POSITIVE)).clamp(0.0, 1.0);
    let aside = reach - t * way;
    let rise_sq = WIRE * WIRE - aside.length_squared();
    (rise_sq > 0.0).then(|| {
        let rise = rise_sq.sqrt();
        let across = DVec2::new(aside.x - aside.y, aside.x + aside.y) * core::f64::consts::FRAC_1_SQRT_2;
        (from.z + t * (to.z - from.z) + rise, across.extend(rise) / WIRE)
    })
}

/// The light from the upper left on a wire, from 0 to 1.
fn light(normal: DVec3) -> f64 {
    let toward = DVec3::new(-0.45, -0.6, 0.66);
    let shine = 0.9 * normal.dot(toward).max(0.0);
    shine * smooth_step(0.1, 0.6, normal.z)
}
