//! Rows of documentation images about textures with two, three and four axes, and 2-D slices through them.

use super::{SHADES, SIDE, basis, gray, ranged, shaded, square};
use crate::Panel;
use crate::docs::Strip;
use dapple_raster::Raster;
use dapple_worley::{Combination, Plane, Worley3, Worley4, hash::Seed};
use glam::{DVec3, DVec4};

/// Width and height of an image, in cells.
const CELLS: f64 = 2.5;

pub(super) const AXES: Strip = Strip {
    name: "worley",
    caption: "F1",
    render: || {
        let flat = ranged(basis().combine(Combination::F1))?;
        let space = ranged(Worley3::new(Seed(3)).combine(Combination::F1))?;
        let four = ranged(Worley4::new(Seed(3)).combine(Combination::F1))?;
        Ok(vec![
            gray("in the plane", CELLS, |at| flat.value(at))?,
            gray("a slice through space", CELLS, |at| {
                space.value(DVec3::new(at.x, at.y, 0.5))
            })?,
            gray("a slice through four dimensions", CELLS, |at| {
                four.value(DVec4::new(at.x, at.y, 0.5, 0.5))
            })?,
        ])
    },
};

pub(super) const PLANE: Strip = Strip {
    name: "plane",
    caption: "F2 − F1 of the same feature points in space",
    render: || {
        let slice = Plane::slice(DVec3::ZERO);
        let planes = [
            ("the slice z = 0", slice),
            ("the slice z = 0.1", Plane::slice(DVec3::Z * 0.1)),
            (
                "an oblique plane through the upper edge of the first",
                Plane {
                    v: DVec3::new(0.0, 0.8, 0.6),
                    ..slice
                },
            ),
            (
                "u twice as long",
                Plane {
                    u: DVec3::X * 2.0,
                    ..slice
                },
            ),
        ];
        planes
            .into_iter()
            .map(|(label, plane)| through(label, &plane))
            .collect()
    },
};

fn through(label: &str, plane: &Plane<3>) -> anyhow::Result<Panel> {
    let texture = Worley3::new(Seed(3)).combine(Combination::F2_MINUS_F1);
    let mut raster = Raster::filled([SIDE; 2], 0.0)?;
    let window = square(CELLS)?;
    let texture = texture.normalized()?;
    texture.render_plane(plane, &window, raster.view_mut())?;
    Ok(shaded(label, &raster, SHADES))
}
