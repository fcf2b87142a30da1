//! Frames, which surround the middle of one image by the borders of another, with a cut all around.
//!
//! Along each axis there is a cut at either end. First, the left and the right cut run from top to bottom. Then, on the
//! result, the upper and the lower cut run from left to right. Where both sides of a cut show the frame, it costs
//! nothing, so the four cuts join to one closed path around the middle.

use crate::axis::{Axis, each_axis, transpose_all};
use crate::cut::{Band, Cut, Ends, scales};
use crate::{IsCancelled, TileError};
use dapple_raster::Raster;

/// The width of a frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Frame {
    /// Number of pixels along each border that are taken from the frame unchanged.
    pub(crate) whole: u32,
    /// Number of additional pixels for the cut and its ramp. Together with `whole`, it is at most half of a side.
    pub(crate) band: u32,
}

/// Puts planes into a frame. All planes are cut along the same path.
pub(crate) fn framed(
    planes: &[Raster<f32>],
    frame: &[Raster<f32>],
    width: Frame,
    is_cancelled: &IsCancelled,
) -> Result<Vec<Raster<f32>>, TileError> {
    framed_along(planes, width, is_cancelled, |_, axis| {
        in_axis(frame, axis, is_cancelled)
    })
}

/// Returns the frame's planes, transposed if needed so that their rows run along `axis`.
pub(crate) fn in_axis(
    frame: &[Raster<f32>],
    axis: Axis,
    is_cancelled: &IsCancelled,
) -> Result<Vec<Raster<f32>>, TileError> {
    match axis {
        Axis::X => Ok(frame.to_vec()),
        Axis::Y => transpose_all(frame, is_cancelled),
    }
}

/// Puts planes into a frame that `frame` computes for each axis, from the current planes with rows along that axis.
pub(crate) fn framed_along(
    planes: &[Raster<f32>],
    width: Frame,
    is_cancelled: &IsCancelled,
    frame: impl Fn(&[Raster<f32>], Axis) -> Result<Vec<Raster<f32>>, TileError>,
) -> Result<Vec<Raster<f32>>, TileError> {
    each_axis(planes, [true; 2], is_cancelled, |planes, axis| {
        let mut frame = frame(planes, axis)?;
        let mut planes = planes.to_vec();
        let scales = scales(&[&planes, &frame]);
        let band = Band {
            first: width.whole,
            count: width.band,
        };
        // The upper and lower cuts are closed, since columns repeat.
        let ends = match axis {
            Axis::X => Ends::Free,
            Axis::Y => Ends::Closed,
        };
        // Make the left cut, and then, on mirrored planes, the right one.
        for _ in 0..2 {
            let cut = Cut::cheapest([&frame, &planes], &scales, band, ends, is_cancelled)?;
            let pairs = frame.iter().zip(&planes);
            let joined = pairs.map(|(frame, plane)| mirrored(&cut.join([frame, plane])?));
            planes = joined.collect::<Result<_, _>>()?;
            frame = frame.iter().map(mirrored).collect::<Result<_, _>>()?;
        }
        Ok(planes)
    })
}

/// Reverses the order of the columns.
fn mirrored(plane: &Raster<f32>) -> Result<Raster<f32>, TileError> {
    Ok(Raster::from_rows(plane.size(), |row| {
        plane.row(row).iter().rev().copied()
    })?)
}

#[cfg(test)]
mod tests {
    use super::{Frame, framed};
    use crate::test_fields::{gravel, turned};
    use core::slice;
    use dapple_raster::Raster;

    fn in_frame(plane: &Raster<f32>, frame: &Raster<f32>, width: Frame) -> Raster<f32> {
        let [plane, frame] = [plane, frame].map(slice::from_ref);
        let planes = framed(plane, frame, width, &|| false);
        planes.unwrap().swap_remove(0)
    }

    #[test]
    fn framed_has_whole_pieces_of_both_and_a_thin_line_between_them() {
        let width = Frame { whole: 3, band: 12 };
        for seed in 0..8 {
            let [plane, frame] = [seed, seed + 50].map(|seed| gravel(seed, [50, 41], true));
            let made = in_frame(&plane, &frame, width);
            let mut n_mixed = 0;
            for (x, y) in (0..41).flat_map(|y| (0..50).map(move |x| (x, y))) {
                let [plane, frame, made] =
                    [&plane, &frame, &made].map(|raster| raster.row(y)[x as usize]);
                let from_border = x.min(49 - x).min(y.min(40 - y));
                match from_border {
                    0..3 => assert_eq!(made, frame, "{x}, {y}"),
                    15.. => assert_eq!(made, plane, "{x}, {y}"),
                    _ => n_mixed += u32::from(made != frame && made != plane),
                }
            }
            // A cut blends three pixels of each row or column that it crosses, and the cuts are as long as the sides.
            assert!(n_mixed <= 3 * 2 * (50 + 41), "{n_mixed} pixels are mixed");
        }
    }

    #[test]
    fn framed_shows_no_cut_where_there_is_a_way_of_no_difference() {
        // The two images differ everywhere except in a ring of equal pixels whose distance from the border varies.
        let ring = |x: u32, y: u32| {
            let from_border = x.min(39 - x).min(y.min(39 - y));
            let wave = 7 + (x / 5 + y / 7) % 3;
            (wave..wave + 5).contains(&from_border)
        };
        let plane = Raster::from_fn([40; 2], |x, y| if ring(x, y) { 0.0 } else { 1.0 });
        let frame = Raster::from_fn([40; 2], |x, y| if ring(x, y) { 0.0 } else { -1.0 });
        let made = in_frame(
            &plane.unwrap(),
            &frame.unwrap(),
            Frame { whole: 2, band: 16 },
        );
        for (x, y) in (0..40).flat_map(|y| (0..40).map(move |x| (x, y))) {
            let value = made.row(y)[x as usize];
            assert!([-1.0, 0.0, 1.0].contains(&value), "{value} at {x}, {y}");
        }
    }

    #[test]
    fn framed_with_a_hard_edge_is_a_rectangle_in_a_rectangle() {
        let [plane, frame] = [1.0, 2.0].map(|value| Raster::filled([9, 7], value).unwrap());
        for whole in 0..=3 {
            let made = in_frame(&plane, &frame, Frame { whole, band: 0 });
            let expected = Raster::from_fn([9, 7], |x, y| {
                let from_border = x.min(8 - x).min(y.min(6 - y));
                if from_border < whole { 2.0 } else { 1.0 }
            });
            assert_eq!(made, expected.unwrap());
            assert_eq!(turned(&turned(&made)), made);
        }
    }
}
