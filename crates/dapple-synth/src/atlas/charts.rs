//! Lays out charts, which are large pieces of a surface, each flattened as a whole.
//!
//! `uvunwrap` cuts the surface into charts, flattens them (least squares conformal maps, then as rigid as possible) and
//! packs them. It is written in Rust without dependencies, uses no function whose bits differ between platforms, and
//! rejects charts that fold or overlap. `xatlas` is written in C++, its bindings need libclang, and it hangs on some
//! meshes. A packer of our own that also rotated charts by 45 degrees and less used the same fraction of the map,
//! within 3 %. More than [`MANY`] charts are packed in rows.
//!
//! References: Bruno Lévy, Sylvain Petitjean, Nicolas Ray and Jérome Maillot, "Least Squares Conformal Maps for
//! Automatic Texture Atlas Generation", SIGGRAPH 2002, doi 10.1145/566654.566590; Ligang Liu, Lei Zhang, Yin Xu, Craig
//! Gotsman and Steven J. Gortler, "A Local/Global Approach to Mesh Parameterization", Computer Graphics Forum 27(5),
//! 2008, doi 10.1111/j.1467-8659.2008.01290.x.

use super::{Atlas, check_padding, check_side, own_uvs};
use crate::{SynthError, SynthErrorKind};
use core::ops::ControlFlow;
use dapple_mesh::Surface;
use glam::{DVec2, DVec3, Vec3};
use std::sync::{Mutex, PoisonError};
use uvunwrap::{Density, MeshInput, Options, Packing, Progress, Stage};

/// Maximum angle between a face normal and the mean of its chart, in degrees. At 70 there are a third as many charts,
/// but their arms leave up to half of the map empty, and 100,000 faces take three times as long.
const ANGLE_MAX: f32 = 40.0;

/// Number of charts above which they are packed in rows instead of by shape. Packing by shape compares each chart with
/// all free positions between the others: it took three quarters of the time for 2,000 charts, and most of the time for
/// more.
const MANY: usize = 512;

/// Completed fraction of the work when all charts have been flattened.
const FLAT: f64 = 0.7;

/// A callback that receives the completed fraction of the work, from 0 to 1.
pub(super) type Callback<'a> = &'a mut (dyn FnMut(f64) -> ControlFlow<()> + Send);

/// Reason why the unwrapping was stopped.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Stop {
    /// The caller's callback cancelled.
    Asked,
    /// There are too many charts to pack them by shape.
    Many,
    /// The charts with their padding need more texels than the map has.
    NoRoom,
}

/// State of the unwrapping that the progress callback updates.
struct Watch<'a> {
    callback: Callback<'a>,
    /// Last reported fraction of the work; it never decreases.
    shown: f64,
    n_charts: usize,
    stopped: Option<Stop>,
}

/// Returns the default padding around charts, in texels, in a map of the given side.
pub(super) fn padding(side: u32) -> u32 {
    match side {
        0..512 => 1,
        _ => (side / 1024).max(2),
    }
}

pub(super) fn charts(
    surface: &Surface,
    side: u32,
    padding: u32,
    callback: Callback<'_>,
) -> Result<Atlas, SynthError> {
    check_side(side)?;
    check_padding(padding)?;
    let mesh = surface.mesh();
    let positions = in_unit_cube(mesh.positions());
    let faces = mesh.faces().iter();
    let indices: Vec<u32> = faces.flat_map(|face| face.map(|vertex| vertex.0)).collect();
    let mut options = Options {
        max_chart_angle: ANGLE_MAX,
        density: Density::Auto { page_size: side },
        padding,
        ..Options::default()
    };
    // Upper bound of the number of charts: each takes at least one texel and its padding on all sides.
    let [across, beside] = [side, padding].map(u64::from);
    let room = across * across / (1 + 2 * beside * (beside + 1));
    let watch = Mutex::new(Watch {
        callback,
        shown: 0.0,
        n_charts: 0,
        stopped: None,
    });
    // Lower bound of the number of charts: each is connected.
    let n_least = n_components(&positions, &indices);
    if n_least as u64 > room {
        return Err(too_small(side));
    }
    if n_least > MANY {
        options.packing = Packing::Fast;
    }
    // Unwrap; if there turn out to be too many charts to pack by shape, again with packing in rows.
    let mut layout;
    loop {
        let most = match options.packing {
            Packing::Shape => MANY,
            _ => usize::MAX,
        };
        let input = [MeshInput::new(&positions, &indices)];
        layout = uvunwrap::generate_with_progress(&input, &options, |progress| {
            let mut watch = watch.lock().unwrap_or_else(PoisonError::into_inner);
            watch.hear(progress, most, room)
        });
        let mut watch = watch.lock().unwrap_or_else(PoisonError::into_inner);
        watch.n_charts = 0;
        match watch.stopped.take() {
            Some(Stop::Many) => options.packing = Packing::Fast,
            Some(Stop::Asked) => return Err(SynthError::new(SynthErrorKind::Cancelled)),
            Some(Stop::NoRoom) => return Err(too_small(side)),
            None => break,
        }
    }
    // The library's other errors are about input that a valid mesh cannot contain.
    let layout = layout
        .ok()
        .filter(|layout| layout.page_count == 1)
        .ok_or_else(|| too_small(side))?;
    let pieces = &layout.meshes[0];
    let size = DVec2::new(layout.width.into(), layout.height.into());
    let corner = |&index: &u32| {
        let vertex = pieces.vertices[index as usize];
        if vertex.chart.is_none() {
            return DVec2::NAN;
        }
        // The library's charts are mirrored: flip u.
        let [u, v] = vertex.uv.map(f64::from);
        DVec2::new(1.0 - u, v) * size
    };
    let faces = pieces.indices.chunks_exact(3);
    let corners = faces.map(|face| [corner(&face[0]), corner(&face[1]), corner(&face[2])]);
    own_uvs::covered(corners.map(with_area).collect(), [side; 2], side)
}

impl Watch<'_> {
    /// Counts the charts, reports the progress, and returns whether the work continues.
    fn hear(&mut self, progress: Progress, most: usize, room: u64) -> bool {
        let done = progress.done as f64;
        let part = match (progress.stage, progress.total) {
            (Stage::Segmenting, _) => 0.0,
            (Stage::Parameterizing, Some(total)) => FLAT * done / total.max(1) as f64,
            // The number of packing attempts is not known in advance.
            (Stage::Packing, _) => FLAT + (1.0 - FLAT) * done / (done + 8.0),
            _ => 1.0,
        };
        self.shown = self.shown.max(part);
        // Each chart is reported once, when it has been flattened.
        self.n_charts += usize::from(progress.stage == Stage::Parameterizing);
        self.stopped = if (self.callback)(self.shown).is_break() {
            Some(Stop::Asked)
        } else if self.n_charts as u64 > room {
            Some(Stop::NoRoom)
        } else if self.n_charts > most {
            Some(Stop::Many)
        } else {
            None
        };
        self.stopped.is_none()
    }
}

/// Returns the number of connected components among the faces that have an area, which is a lower bound of the number
/// of charts. Vertices at the same position count as one.
fn n_components(positions: &[[f32; 3]], indices: &[u32]) -> usize {
    // Join vertices with the same position: each points to the first of them. Adding zero turns -0 into 0.
    let bits = |vertex: u32| positions[vertex as usize].map(|part| (part + 0.0).to_bits());
    let mut order: Vec<u32> = (0..positions.len() as u32).collect();
    order.sort_unstable_by_key(|&vertex| (bits(vertex), vertex));
    let mut roots: Vec<u32> = (0..positions.len() as u32).collect();
    for pair in order.windows(2) {
        if bits(pair[0]) == bits(pair[1]) {
            roots[pair[1] as usize] = roots[pair[0] as usize];
        }
    }
    // Join the corners of each face.
    let mut has_area = vec![false; positions.len()];
    for face in indices.chunks_exact(3) {
        let [a, b, c] = [face[0], face[1], face[2]];
        let root = [a, b, c].map(|vertex| root(&mut roots, vertex));
        let least = root[0].min(root[1]).min(root[2]);
        for other in root {
            roots[other as usize] = least;
        }
        let at = |vertex: u32| Vec3::from(positions[vertex as usize]).as_dvec3();
        has_area[a as usize] |= (at(b) - at(a)).cross(at(c) - at(a)) != DVec3::ZERO;
    }
    // Count the components with an area.
    let mut counted = vec![false; positions.len()];
    for vertex in 0..positions.len() {
        if has_area[vertex] {
            counted[root(&mut roots, vertex as u32) as usize] = true;
        }
    }
    counted.into_iter().filter(|&counted| counted).count()
}

/// Returns the root of `vertex` in a union-find forest, with path halving.
fn root(roots: &mut [u32], mut vertex: u32) -> u32 {
    while roots[vertex as usize] != vertex {
        let above = roots[roots[vertex as usize] as usize];
        roots[vertex as usize] = above;
        vertex = above;
    }
    vertex
}

/// Returns the given corners; NaN if their triangle has no area or is mirrored.
fn with_area([a, b, c]: [DVec2; 3]) -> [DVec2; 3] {
    // A comparison with NaN is false.
    if (b - a).perp_dot(c - a) < 0.0 {
        [a, b, c]
    } else {
        [DVec2::NAN; 3]
    }
}

/// Translates and scales positions into the cube from -1 to 1.
fn in_unit_cube(positions: &[DVec3]) -> Vec<[f32; 3]> {
    let low = positions.iter().copied().reduce(DVec3::min);
    let high = positions.iter().copied().reduce(DVec3::max);
    let (low, high) = (low.unwrap_or_default(), high.unwrap_or_default());
    let center = low * 0.5 + high * 0.5;
    let half = (high * 0.5 - low * 0.5).max_element();
    let place = |at: &DVec3| ((*at - center) / half).as_vec3().to_array();
    positions.iter().map(place).collect()
}

fn too_small(side: u32) -> SynthError {
    SynthError::new(SynthErrorKind::Range {
        what: "side of the texture map",
        value: side.into(),
        range: "large enough for all charts with their paddings",
    })
}

#[cfg(test)]
mod tests;
