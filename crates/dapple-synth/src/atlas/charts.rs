//! Charts: large pieces of a surface, each flattened as a whole.
//!
//! They are cut, flattened (least squares conformal maps, then as rigid as possible) and packed by `uvunwrap`, which is
//! Rust without dependencies, uses no function whose bits differ between platforms, and refuses pieces that fold or
//! overlap; `xatlas` is C++, whose bindings need libclang, and hangs on some meshes. A packer of our own that also turned
//! charts by 45 degrees and less used as much of the map, within 3 %.
//!
//! References: Bruno Lévy, Sylvain Petitjean, Nicolas Ray and Jérome Maillot, "Least Squares Conformal Maps for Automatic
//! Texture Atlas Generation", SIGGRAPH 2002, doi 10.1145/566654.566590; Ligang Liu, Lei Zhang, Yin Xu, Craig Gotsman and
//! Steven J. Gortler, "A Local/Global Approach to Mesh Parameterization", Computer Graphics Forum 27(5), 2008,
//! doi 10.1111/j.1467-8659.2008.01290.x.

use super::{Atlas, check_padding, check_side, own_uvs};
use crate::{SynthError, SynthErrorKind};
use dapple_mesh::Surface;
use glam::{DVec2, DVec3};
use uvunwrap::{Density, MeshInput, Options};

/// The largest angle between a face and the mean of its chart, in degrees. At 70 there are a third as many charts, but
/// their arms leave up to half of the map free, and 100,000 faces take three times as long.
const ANGLE_MAX: f32 = 40.0;

/// The padding of charts in a map of this side.
pub(super) fn padding(side: u32) -> u32 {
    match side {
        0..512 => 1,
        _ => (side / 1024).max(2),
    }
}

pub(super) fn charts(surface: &Surface, side: u32, padding: u32) -> Result<Atlas, SynthError> {
    check_side(side)?;
    check_padding(padding)?;
    let mesh = surface.mesh();
    let positions = in_unit_cube(mesh.positions());
    let faces = mesh.faces().iter();
    let indices: Vec<u32> = faces.flat_map(|face| face.map(|vertex| vertex.0)).collect();
    let options = Options {
        max_chart_angle: ANGLE_MAX,
        density: Density::Auto { page_size: side },
        padding,
        ..Options::default()
    };
    // What else is refused cannot be in a mesh.
    let layout = uvunwrap::generate(&[MeshInput::new(&positions, &indices)], &options)
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
