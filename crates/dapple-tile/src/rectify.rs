//! Rectifies a flat surface that was photographed at an angle: maps a quadrilateral of an image to a rectangle.
//!
//! Source: Paul S. Heckbert, "Fundamentals of Texture Mapping and Image Warping", Master's thesis, UCB/CSD 89/516,
//! University of California, Berkeley, 1989, section 2.2.3, for the homography of the unit square in closed form.
//!
//! Each pixel of the result averages the quadrilateral that it covers in the image, in linear light. The pixel is
//! divided into equal parts of at most one image pixel along each axis, and each part is one bilinear sample. A pixel
//! that is enlarged is a single sample. Positions are in pixels of the image, with (0, 0) at its top left corner.

use crate::{Map, TileError, TileErrorKind};
use dapple_raster::glam::DVec2;
use dapple_raster::{Raster, Wrap, parallel};

/// Maximum number of parts of a pixel along each axis. A side of more image pixels is sampled with gaps.
const MOST_PARTS: f64 = 64.0;

/// Factor for the side of a part, so that rounding does not divide a pixel that covers exactly one image pixel.
const SLACK: f64 = 1.0 - 1e-6;

/// Minimum turn at a corner: the cross product of its sides, in pixels².
const LEAST_TURN: f64 = 1.0;

/// Maps a quadrilateral of an image to the whole of a new image.
///
/// `corners` are x and y of the top left, top right, bottom right and bottom left corner of the result, in pixels of
/// the image, from (0, 0) to its size. The default size is the mean length of opposite sides of the quadrilateral,
/// rounded. Colors are resampled in linear light.
///
/// Maps of the same size are rectified by the same homography.
///
/// # Errors
///
/// * [`CornerOutside`](TileErrorKind::CornerOutside) if a corner is outside of the image
/// * [`NotConvex`](TileErrorKind::NotConvex) if the quadrilateral is concave, crosses itself or has collinear corners,
///   or if the corners are in counterclockwise order
/// * [`NormalsInPerspective`](TileErrorKind::NormalsInPerspective) for normals
/// * [`Raster`](TileErrorKind::Raster) if the size has no pixels or too many
///
/// # Examples
///
/// ```
/// use dapple_tile::raster::Raster;
/// use dapple_tile::{Map, rectify};
///
/// let photo = Map::Value(Raster::from_fn([64, 48], |x, y| (x + y) as f32)?);
/// let wall = rectify(&photo, [[10.0, 5.0], [60.0, 0.0], [60.0, 48.0], [10.0, 40.0]], None)?;
/// // The top is 50.2 pixels long, the bottom 50.6, the left side 35 and the right side 48.
/// assert_eq!(wall.size(), [50, 42]);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn rectify(
    map: &Map,
    corners: [[f64; 2]; 4],
    size: Option<[u32; 2]>,
) -> Result<Map, TileError> {
    if matches!(map, Map::Normal(_)) {
        return Err(TileError::new(TileErrorKind::NormalsInPerspective));
    }
    let perspective = Perspective::new(corners, map.size())?;
    let size = size.unwrap_or_else(|| perspective.size());
    let planes = map.planes().into_iter().map(|plane| {
        let mut rectified = Raster::filled(size, 0.0)?;
        parallel::for_each_chunk(rectified.pixels_mut(), size[0] as usize, |row, pixels| {
            for (column, pixel) in pixels.iter_mut().enumerate() {
                let first = DVec2::new(column as f64, row as f64);
                *pixel = perspective.mean(&plane, first, size);
            }
        });
        Ok(rectified)
    });
    map.with_planes(planes.collect::<Result<_, TileError>>()?)
}

/// A homography from the unit square to a quadrilateral.
struct Perspective {
    corners: [DVec2; 4],
    /// Numerator: the images of the unit vectors and of the origin.
    across: DVec2,
    down: DVec2,
    origin: DVec2,
    /// Denominator: 1 plus this times the position.
    tilt: DVec2,
}

impl Perspective {
    fn new(corners: [[f64; 2]; 4], bounds: [u32; 2]) -> Result<Self, TileError> {
        let corners = corners.map(DVec2::from);
        // Check that the corners are inside, and that each turns clockwise; y points down.
        for (corner, at) in (1..).zip(corners) {
            let is_inside = |axis: usize| (0.0..=f64::from(bounds[axis])).contains(&at[axis]);
            if !(is_inside(0) && is_inside(1)) {
                return Err(TileError::new(TileErrorKind::CornerOutside {
                    corner,
                    position: at.to_array(),
                    size: bounds,
                }));
            }
        }
        for corner in 0..4 {
            let [before, at, after] = [3, 0, 1].map(|step| corners[(corner + step) % 4]);
            let turn = (at - before).perp_dot(after - at);
            if turn < LEAST_TURN {
                let corner = corner as u32 + 1;
                return Err(TileError::new(TileErrorKind::NotConvex { corner, turn }));
            }
        }
        let [p0, p1, p2, p3] = corners;
        let (along_right, along_bottom) = (p1 - p2, p3 - p2);
        // Heckbert's closed form. For a parallelogram the sum is 0, and the map is affine.
        let sum = p0 - p1 + p2 - p3;
        // The denominator is the turn at the third corner, which is not 0.
        let scale = along_right.perp_dot(along_bottom);
        let tilt = DVec2::new(sum.perp_dot(along_bottom), along_right.perp_dot(sum)) / scale;
        Ok(Self {
            corners,
            across: p1 - p0 + tilt.x * p1,
            down: p3 - p0 + tilt.y * p3,
            origin: p0,
            tilt,
        })
    }

    /// Returns the mean lengths of opposite sides, at least one pixel each.
    fn size(&self) -> [u32; 2] {
        let [p0, p1, p2, p3] = self.corners;
        let mean = |a: f64, b: f64| ((a + b) / 2.0).round().max(1.0) as u32;
        [
            mean(p0.distance(p1), p3.distance(p2)),
            mean(p0.distance(p3), p1.distance(p2)),
        ]
    }

    /// Maps a position in the unit square to the image.
    fn at(&self, uv: DVec2) -> DVec2 {
        (self.across * uv.x + self.down * uv.y + self.origin) / (1.0 + self.tilt.dot(uv))
    }

    /// Returns the mean of the image over the pixel of the result at column and row `first`.
    fn mean(&self, plane: &Raster<f32>, first: DVec2, size: [u32; 2]) -> f32 {
        let (size, bounds) = (size.map(f64::from), plane.size().map(f64::from));
        let (size, bounds) = (DVec2::from(size), DVec2::from(bounds));
        let corner = |x: f64, y: f64| self.at((first + DVec2::new(x, y)) / size);
        let [p0, p1, p2, p3] = [
            corner(0.0, 0.0),
            corner(1.0, 0.0),
            corner(1.0, 1.0),
            corner(0.0, 1.0),
        ];
        // Divide the longer of opposite sides into parts of at most one pixel.
        let parts = |a: DVec2, b: DVec2| (a.length().max(b.length()) * SLACK).ceil();
        let across = parts(p1 - p0, p2 - p3).clamp(1.0, MOST_PARTS);
        let down = parts(p3 - p0, p2 - p1).clamp(1.0, MOST_PARTS);
        let mut sum = 0.0;
        for row in 0..down as u32 {
            for column in 0..across as u32 {
                let x = (f64::from(column) + 0.5) / across;
                let y = (f64::from(row) + 0.5) / down;
                let uv = corner(x, y) / bounds;
                sum += f64::from(plane.sample_bilinear(uv, [Wrap::Clamp; 2]));
            }
        }
        (sum / (across * down)) as f32
    }
}

#[cfg(test)]
mod tests {
    use super::{Perspective, rectify};
    use crate::test_fields::{gravel, same_on_threads};
    use crate::{Map, TileErrorKind};
    use dapple_color::Normal;
    use dapple_raster::Raster;
    use dapple_raster::glam::{DMat3, DVec2, DVec3};

    fn values(map: Map) -> Raster<f32> {
        match map {
            Map::Value(raster) => raster,
            other => panic!("{other:?}"),
        }
    }

    /// A checkerboard of 8 × 6 fields of 10 units.
    fn checker(at: DVec2) -> f32 {
        let field = (at / 10.0).floor();
        ((field.x + field.y) as i64).rem_euclid(2) as f32
    }

    /// A camera that looks down at the board at an angle: the homography from the board to the image.
    fn camera() -> DMat3 {
        DMat3::from_cols(
            DVec3::new(5.0, 0.8, 0.002),
            DVec3::new(-0.9, 4.0, 0.006),
            DVec3::new(70.0, 40.0, 1.0),
        )
    }

    fn seen(board: DVec2) -> [f64; 2] {
        let at = camera() * board.extend(1.0);
        (at.truncate() / at.z).to_array()
    }

    #[test]
    fn rectify_returns_a_checker_that_a_camera_has_seen() {
        // Render the board with 4 × 4 rays per pixel through the inverse of the camera's matrix.
        let rays = camera().inverse();
        let photo = Raster::from_fn([480, 320], |x, y| {
            let ray = |index: u32| {
                let part = DVec2::new((index % 4).into(), (index / 4).into()) / 4.0 + 0.125;
                let at = rays * (DVec2::new(x.into(), y.into()) + part).extend(1.0);
                checker(at.truncate() / at.z)
            };
            (0..16).map(ray).sum::<f32>() / 16.0
        })
        .unwrap();
        let corners = [[0.0, 0.0], [80.0, 0.0], [80.0, 60.0], [0.0, 60.0]];
        let corners = corners.map(|corner| seen(corner.into()));
        let board = values(rectify(&Map::Value(photo), corners, Some([320, 240])).unwrap());
        // Away from the edges of fields, where an image pixel has both colors, the board is back. A sample reads up to two
        // image pixels away, which are at most 0.8 units.
        let mut n_pixels = 0;
        for y in 0..240 {
            for x in 0..320 {
                let at = (DVec2::new(x.into(), y.into()) + 0.5) / 4.0;
                let to_edge = (at / 10.0 - (at / 10.0).round()).abs() * 10.0;
                if to_edge.min_element() > 0.8 {
                    let difference = board.row(y)[x as usize] - checker(at);
                    assert!(difference.abs() < 1e-6, "{x} {y}: {difference}");
                    n_pixels += 1;
                }
            }
        }
        assert!(n_pixels > 50_000, "{n_pixels}");
    }

    #[test]
    fn perspective_equals_the_matrix_of_the_camera() {
        let corners = [[0.0, 0.0], [80.0, 0.0], [80.0, 60.0], [0.0, 60.0]];
        let corners = corners.map(|corner| seen(corner.into()));
        let perspective = Perspective::new(corners, [480, 320]).unwrap();
        for uv in [[0.0, 0.0], [0.3, 0.9], [0.5, 0.5], [1.0, 1.0]].map(DVec2::from) {
            let expected = DVec2::from(seen(uv * DVec2::new(80.0, 60.0)));
            // Both round a few times in f64.
            assert!(perspective.at(uv).distance(expected) < 1e-9, "{uv}");
        }
    }

    #[test]
    fn rectify_of_the_whole_image_returns_the_image() {
        let image = gravel(5, [61, 47], false);
        let whole = [[0.0, 0.0], [61.0, 0.0], [61.0, 47.0], [0.0, 47.0]];
        let same = values(rectify(&Map::Value(image.clone()), whole, None).unwrap());
        assert_eq!(same, image);
        // A crop at whole pixels is a crop.
        let part = [[7.0, 3.0], [40.0, 3.0], [40.0, 29.0], [7.0, 29.0]];
        let part = values(rectify(&Map::Value(image.clone()), part, None).unwrap());
        assert_eq!(part, image.crop([7, 3], [33, 26]).unwrap());
    }

    #[test]
    fn rectify_to_a_smaller_size_averages_areas() {
        let image = gravel(6, [64, 48], false);
        let whole = [[0.0, 0.0], [64.0, 0.0], [64.0, 48.0], [0.0, 48.0]];
        let small = rectify(&Map::Value(image.clone()), whole, Some([16, 12])).unwrap();
        let small = values(small);
        for (x, y) in [(0, 0), (15, 11), (7, 5)] {
            let part = image.crop([4 * x, 4 * y], [4, 4]).unwrap();
            let mean = part.statistics().mean;
            let value = f64::from(small.row(y)[x as usize]);
            assert!((value - mean).abs() < 1e-6, "{x} {y}: {value} {mean}");
        }
    }

    #[test]
    fn rectify_turns_the_image_by_the_order_of_the_corners() {
        let image = gravel(7, [20, 10], false);
        let turned = [[20.0, 0.0], [20.0, 10.0], [0.0, 10.0], [0.0, 0.0]];
        let turned = values(rectify(&Map::Value(image.clone()), turned, None).unwrap());
        assert_eq!(turned.size(), [10, 20]);
        assert_eq!(turned.row(0)[0], image.row(0)[19]);
        assert_eq!(turned.row(19)[9], image.row(9)[0]);
    }

    #[test]
    fn rectify_refuses_bad_corners_and_normals() {
        let image = Map::Value(gravel(8, [40, 30], false));
        let kind = |corners| rectify(&image, corners, None).unwrap_err().kind().clone();
        let outside = [[-0.1, 0.0], [40.0, 0.0], [40.0, 30.0], [0.0, 30.0]];
        assert!(matches!(
            kind(outside),
            TileErrorKind::CornerOutside { corner: 1, .. }
        ));
        let outside = [[0.0, 0.0], [40.0, 0.0], [40.0, f64::NAN], [0.0, 30.0]];
        assert!(matches!(
            kind(outside),
            TileErrorKind::CornerOutside { corner: 3, .. }
        ));
        for bad in [
            // Concave, crossing, collinear, counterclockwise, a point.
            [[0.0, 0.0], [40.0, 0.0], [10.0, 10.0], [0.0, 30.0]],
            [[0.0, 0.0], [40.0, 30.0], [40.0, 0.0], [0.0, 30.0]],
            [[0.0, 0.0], [20.0, 0.0], [40.0, 0.0], [0.0, 30.0]],
            [[0.0, 0.0], [0.0, 30.0], [40.0, 30.0], [40.0, 0.0]],
            [[5.0, 5.0]; 4],
        ] {
            assert!(
                matches!(kind(bad), TileErrorKind::NotConvex { .. }),
                "{bad:?}"
            );
        }
        let up = Map::Normal(Raster::filled([4, 4], Normal::FLAT).unwrap());
        let whole = [[0.0, 0.0], [4.0, 0.0], [4.0, 4.0], [0.0, 4.0]];
        let refused = rectify(&up, whole, None).unwrap_err();
        assert_eq!(*refused.kind(), TileErrorKind::NormalsInPerspective);
        assert!(rectify(&image, whole, Some([0, 4])).is_err());
    }

    #[test]
    fn rectify_has_the_same_bits_on_any_number_of_threads() {
        let image = Map::Value(gravel(9, [90, 70], false));
        let corners = [[10.0, 5.0], [80.0, 12.5], [88.0, 66.0], [3.0, 50.0]];
        assert!(same_on_threads(|| values(
            rectify(&image, corners, None).unwrap()
        )));
    }
}
