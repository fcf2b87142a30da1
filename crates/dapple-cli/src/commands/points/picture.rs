//! Draws images of point sets. Each point is a dot in the color of its level.

use super::scatter::Scattered;
use crate::args::{RampArg, Size};
use crate::error::usage;
use anyhow::Result;
use dapple::color::{LinearRgb, Palette};
use dapple::points::Domain;
use dapple::points::glam::DVec2;
use dapple::raster::Raster;

/// Maximum side of an image, in pixels.
const SIDE_MAX: u32 = 1 << 14;
/// Default radius of a dot, as a fraction of the mean distance between points.
const DOT: f64 = 0.25;
/// Minimum default radius of a dot, in pixels, so that it is visible.
const DOT_MIN: f64 = 0.6;

/// Returns an image of the points. It is the largest image within `size` that has square pixels.
///
/// # Errors
///
/// If `size` is too large, or the radius of a dot is not above 0.
pub(super) fn picture(
    scattered: &Scattered,
    size: Size,
    dot: Option<f64>,
    ramp: Option<&RampArg>,
) -> Result<Raster<LinearRgb>> {
    let domain = scattered.points.domain();
    if size.0.iter().any(|&side| side > SIDE_MAX) {
        return Err(usage(format!(
            "a picture of points has at most {SIDE_MAX} pixels a side"
        )));
    }
    let scale = [0, 1].map(|axis| f64::from(size.0[axis]) / domain.size[axis]);
    let scale = scale[0].min(scale[1]);
    let sides = domain.size * scale;
    let pixels = [sides.x, sides.y].map(|side| (side + 0.5).floor().max(1.0) as u32);
    let n_points = scattered.points.len().max(1) as f64;
    let mean_distance = (domain.area() / n_points).sqrt() * scale;
    let radius = dot.unwrap_or((DOT * mean_distance).max(DOT_MIN));
    if !(radius > 0.0 && radius <= f64::from(SIDE_MAX)) {
        return Err(usage(format!(
            "a dot has a radius above 0 and at most {SIDE_MAX}, not {radius}"
        )));
    }
    let colors = colors(ramp, scattered.lengths.len());
    let mut picture = Raster::filled(pixels, colors[0])?;
    for (point, at) in scattered.points.iter() {
        let color = colors[1 + scattered.level(point.index()) % (colors.len() - 1)];
        for shift in shifts(domain) {
            let center = (at - domain.origin + shift) * scale;
            draw(&mut picture, center, radius, color);
        }
    }
    Ok(picture)
}

/// Returns the background color, followed by the colors of the levels.
fn colors(ramp: Option<&RampArg>, n_levels: usize) -> Vec<LinearRgb> {
    match ramp.map(|ramp| ramp.colors.as_slice()) {
        Some(colors) if colors.len() > 1 => colors.to_vec(),
        Some(colors) => [&[LinearRgb::WHITE], colors].concat(),
        None if n_levels > 1 => [vec![LinearRgb::WHITE], Palette::Labels.colors()].concat(),
        None => vec![LinearRgb::WHITE, LinearRgb::BLACK],
    }
}

/// Returns the translations of the copies of a wrapping domain whose dots may reach into the domain.
fn shifts(domain: &Domain) -> impl Iterator<Item = DVec2> {
    let steps = |axis: usize| if domain.wrap[axis] { -1..=1 } else { 0..=0 };
    let (columns, rows, size) = (steps(0), steps(1), domain.size);
    rows.flat_map(move |y| {
        let columns = columns.clone();
        columns.map(move |x| size * DVec2::new(f64::from(x), f64::from(y)))
    })
}

/// Draws an antialiased disk, clipped to the image. `center` and `radius` are in pixels.
fn draw(picture: &mut Raster<LinearRgb>, center: DVec2, radius: f64, color: LinearRgb) {
    let [columns, rows] = [0, 1].map(|axis| {
        let side = f64::from(picture.size()[axis]);
        let first = (center[axis] - radius - 0.5).floor().clamp(0.0, side);
        let end = (center[axis] + radius + 1.5).floor().clamp(0.0, side);
        first as u32..end as u32
    });
    for row in rows {
        for column in columns.clone() {
            let pixel = DVec2::new(f64::from(column) + 0.5, f64::from(row) + 0.5);
            let offset = pixel - center;
            let distance = (offset.x * offset.x + offset.y * offset.y).sqrt();
            let covered = (radius + 0.5 - distance).clamp(0.0, 1.0);
            let index = row as usize * picture.width() as usize + column as usize;
            let under = &mut picture.pixels_mut()[index];
            *under = under.lerp(color, covered as f32);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::picture;
    use crate::args::Size;
    use crate::commands::points::scatter::Scattered;
    use dapple::color::LinearRgb;
    use dapple::points::glam::DVec2;
    use dapple::points::{Domain, PointSet};

    #[test]
    fn a_dot_at_a_corner_of_a_torus_is_in_all_four() {
        let domain = Domain::torus(DVec2::ZERO, DVec2::new(2.0, 1.0));
        let points = PointSet::new(domain, vec![DVec2::ZERO]).unwrap();
        let scattered = Scattered {
            points,
            lengths: vec![1],
            radius: None,
        };
        let picture = picture(&scattered, Size([32, 32]), Some(4.0), None).unwrap();
        assert_eq!(
            picture.size(),
            [32, 16],
            "the domain is twice as wide as high"
        );
        for (column, row) in [(0, 0), (31, 0), (0, 15), (31, 15)] {
            assert_eq!(
                picture.row(row)[column],
                LinearRgb::BLACK,
                "{column}, {row}"
            );
        }
        assert_eq!(picture.row(8)[16], LinearRgb::WHITE, "the middle");
    }
}
