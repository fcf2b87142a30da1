//! Charts: large pieces of a surface, each flattened as a whole.
//!
//! They are cut, flattened (least squares conformal maps, then as rigid as possible) and packed by `uvunwrap`, which is
//! Rust without dependencies, uses no function whose bits differ between platforms, and refuses pieces that fold or
//! overlap; `xatlas` is C++, whose bindings need libclang, and hangs on some meshes. A packer of our own that also turned
//! charts by 45 degrees and less used as much of the map, within 3 %. More than [`MANY`] charts are packed in rows.
//!
//! References: Bruno Lévy, Sylvain Petitjean, Nicolas Ray and Jérome Maillot, "Least Squares Conformal Maps for Automatic
//! Texture Atlas Generation", SIGGRAPH 2002, doi 10.1145/566654.566590; Ligang Liu, Lei Zhang, Yin Xu, Craig Gotsman and
//! Steven J. Gortler, "A Local/Global Approach to Mesh Parameterization", Computer Graphics Forum 27(5), 2008,
//! doi 10.1111/j.1467-8659.2008.01290.x.

use super::{Atlas, check_padding, check_side, own_uvs};
use crate::{SynthError, SynthErrorKind};
use core::ops::ControlFlow;
use dapple_mesh::Surface;
use glam::{DVec2, DVec3, Vec3};
use std::sync::{Mutex, PoisonError};
use uvunwrap::{Density, MeshInput, Options, Packing, Progress, Stage};

/// The largest angle between a face and the mean of its chart, in degrees. At 70 there are a third as many charts, but
/// their arms leave up to half of the map free, and 100,000 faces take three times as long.
const ANGLE_MAX: f32 = 40.0;

/// Number of charts above which they are packed in rows instead of by their shapes. Packing by shapes compares each chart with
/// all places between the others: it took three quarters of the time of 2,000 charts, and most of that of more.
const MANY: usize = 512;

/// Part of the work that is done once all charts are flat.
const FLAT: f64 = 0.7;

/// A callback for the part of the work that is done, from 0 to 1.
pub(super) type Callback<'a> = &'a mut (dyn FnMut(f64) -> ControlFlow<()> + Send);

/// The reason why the unwrapping was stopped.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Stop {
    /// The caller asked for it.
    Asked,
    /// There are too many charts to pack them by their shapes.
    Many,
    /// The charts with their padding need more texels than the map has.
    NoRoom,
}

/// What is known while charts are made.
struct Watch<'a> {
    callback: Callback<'a>,
    /// The part of the work that was reported; it never decreases.
    shown: f64,
    n_charts: usize,
    stopped: Option<Stop>,
}

/// The padding of charts in a map of this side.
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
    // A chart has a texel at least, and padding to all sides.
    let [across, beside] = [side, padding].map(u64::from);
    let room = across * across / (1 + 2 * beside * (beside + 1));
    let watch = Mutex::new(Watch {
        callback,
        shown: 0.0,
        n_charts: 0,
        stopped: None,
    });
    // Charts are connected.
    let n_least = n_components(&positions, &indices);
    if n_least as u64 > room {
        return Err(too_small(side));
    }
    if n_least > MANY {
        options.packing = Packing::Fast;
    }
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
    // What else is refused cannot be in a mesh.
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
        // Their pictures are mirrored.
        let [u, v] = vertex.uv.map(f64::from);
        DVec2::new(1.0 - u, v) * size
    };
    let faces = pieces.indices.chunks_exact(3);
    let corners = faces.map(|face| [corner(&face[0]), corner(&face[1]), corner(&face[2])]);
    own_uvs::covered(corners.map(with_area).collect(), [side; 2], side)
}

impl Watch<'_> {
    /// Counts the charts and reports the progress. Whether the work goes on.
    fn hear(&mut self, progress: Progress, most: usize, room: u64) -> bool {
        let done = progress.done as f64;
        let part = match (progress.stage, progress.total) {
            (Stage::Segmenting, _) => 0.0,
            (Stage::Parameterizing, Some(total)) => FLAT * done / total.max(1) as f64,
            // The number of trials is not known before.
            (Stage::Packing, _) => FLAT + (1.0 - FLAT) * done / (done + 8.0),
            _ => 1.0,
        };
        self.shown = self.shown.max(part);
        // Each chart is reported once, when it is flat.
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

/// Number of connected components of the faces that have an area, where vertices at one position are one: a lower bound of the
/// number of charts.
fn n_components(positions: &[[f32; 3]], indices: &[u32]) -> usize {
    // The first vertex at the position of each vertex. The sum makes one zero of both.
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
    let mut counted = vec![false; positions.len()];
    for vertex in 0..positions.len() {
        if has_area[vertex] {
            counted[root(&mut roots, vertex as u32) as usize] = true;
        }
    }
    counted.into_iter().filter(|&counted| counted).count()
}

/// The root of a vertex in a forest, whose paths are halved on the way.
fn root(roots: &mut [u32], mut vertex: u32) -> u32 {
    while roots[vertex as usize] != vertex {
        let above = roots[roots[vertex as usize] as usize];
        roots[vertex as usize] = above;
        vertex = above;
    }
    vertex
}

/// The corners of a face, or none if they have no area.
fn with_area([a, b, c]: [DVec2; 3]) -> [DVec2; 3] {
    // Not a number is not below zero.
    if (b - a).perp_dot(c - a) < 0.0 {
        [a, b, c]
    } else {
        [DVec2::NAN; 3]
    }
}

/// Positions moved and scaled into the cube from -1 to 1.
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
