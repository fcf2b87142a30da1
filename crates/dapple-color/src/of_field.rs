//! Computes maps of a field in a window, with neighbors that are evaluated beyond the window's sides.
//!
//! A raster ends at its sides, so its map needs a rule for the heights beyond them. A field has heights everywhere,
//! so the maps of two adjacent windows match, and a point has the same value in every window that contains it.

use crate::{
    ColorError, CurvatureOptions, HeightPlane, Normal, NormalOptions, OcclusionOptions,
    ambient_occlusion_of_part, curvature_of_part, normal_map_of_part,
};
use dapple_raster::{Field, Raster, Window, Wrap};

/// Computes the normals of a height field in a window. Like [`normal_map`](crate::normal_map), but neighbors beyond
/// the window's sides come from the field.
///
/// The extent and the wrap in the options are ignored.
///
/// # Errors
///
/// Same as [`normal_map`](crate::normal_map), or if rendering the field fails.
///
/// # Examples
///
/// ```
/// use dapple_color::{NormalOptions, normal_map_of_field};
/// use dapple_raster::{Window, field_fn};
///
/// // Two chunks of a slope of 45 degrees: no seam, and no edge.
/// let slope = field_fn(|[x, _y]| x as f32);
/// for chunk in 0..2 {
///     let window = Window::new([f64::from(chunk), 0.0], [1.0; 2], [64, 64])?;
///     let normals = normal_map_of_field(&slope, &window, &NormalOptions::default())?;
///     assert!(normals.pixels().iter().all(|normal| normal.x == -0.5_f32.sqrt()));
/// }
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn normal_map_of_field(
    field: &(impl Field + ?Sized),
    window: &Window,
    options: &NormalOptions,
) -> Result<Raster<Normal>, ColorError> {
    let options = NormalOptions {
        plane: in_window(options.plane, window),
        ..*options
    };
    let heights = with_margin(field, window, [1; 2])?;
    let normals = normal_map_of_part(&heights, window.size, &options)?;
    Ok(normals.crop([1; 2], window.size)?)
}

/// Computes the visible fraction of the sky for a height field in a window. Like
/// [`ambient_occlusion`](crate::ambient_occlusion), but heights beyond the window's sides come from the field.
///
/// The extent and the wrap in the options are ignored.
///
/// # Errors
///
/// Same as [`ambient_occlusion`](crate::ambient_occlusion), or if rendering the field fails.
pub fn ambient_occlusion_of_field(
    field: &(impl Field + ?Sized),
    window: &Window,
    options: &OcclusionOptions,
) -> Result<Raster<f32>, ColorError> {
    let options = OcclusionOptions {
        plane: in_window(options.plane, window),
        ..*options
    };
    let halo = options.halo(window.size);
    let heights = with_margin(field, window, halo)?;
    ambient_occlusion_of_part(&heights, halo, window.size, &options)
}

/// Computes the mean curvature of a height field in a window. Like [`curvature`](crate::curvature()), but neighbors
/// beyond the window's sides come from the field.
///
/// The extent and the wrap in the options are ignored.
///
/// # Errors
///
/// Same as [`curvature`](crate::curvature()), or if rendering the field fails.
pub fn curvature_of_field(
    field: &(impl Field + ?Sized),
    window: &Window,
    options: &CurvatureOptions,
) -> Result<Raster<f32>, ColorError> {
    let options = CurvatureOptions {
        plane: in_window(options.plane, window),
        ..*options
    };
    let halo = options.halo(window.size);
    let heights = with_margin(field, window, halo)?;
    let bent = curvature_of_part(&heights, window.size, &options)?;
    Ok(bent.crop(halo, window.size)?)
}

/// Returns `plane` with the extent of a window. The wrap has no effect, since neighbors are read from the field.
fn in_window(plane: HeightPlane, window: &Window) -> HeightPlane {
    HeightPlane {
        strength: plane.strength,
        ..HeightPlane::for_window(window, [Wrap::Clamp; 2])
    }
}

/// Renders the heights of a field in a window with margins.
fn with_margin(
    field: &(impl Field + ?Sized),
    window: &Window,
    margin: [u32; 2],
) -> Result<Raster<f32>, ColorError> {
    let size = [0, 1].map(|axis| window.size[axis].saturating_add(margin[axis].saturating_mul(2)));
    let wide = window.crop(margin.map(|side| -i64::from(side)), size)?;
    Ok(field.to_raster(&wide)?)
}

#[cfg(test)]
mod tests {
    use super::{ambient_occlusion_of_field, curvature_of_field, normal_map_of_field};
    use crate::{CurvatureOptions, HeightPlane, NormalOptions, OcclusionOptions};
    use crate::{ambient_occlusion, curvature, normal_map};
    use dapple_raster::{Field as _, Raster, Window, Wrap, field_fn};

    /// Returns a chunk of 64 × 64 positions, 1/32 apart, so that all numbers are exact.
    fn chunk(column: i64, row: i64) -> Window {
        let whole = Window::new([0.0; 2], [6.0; 2], [192; 2]).unwrap();
        whole.crop([64 * column, 64 * row], [64; 2]).unwrap()
    }

    fn hills([x, y]: [f64; 2]) -> f32 {
        (0.2 * libm::sin(3.0 * x) * libm::cos(2.0 * y + x)) as f32
    }

    #[test]
    fn chunks_have_the_bits_of_the_whole() {
        let field = field_fn(hills);
        let whole = Window::new([0.0; 2], [6.0; 2], [192; 2]).unwrap();
        let heights = field.to_raster(&whole).unwrap();
        let plane = HeightPlane::for_window(&whole, [Wrap::Clamp; 2]);
        let occlusion = OcclusionOptions {
            radius: 0.5,
            ..plane.into()
        };
        let bent = CurvatureOptions {
            radius: 0.1,
            ..plane.into()
        };
        let normals = normal_map(&heights, &plane.into()).unwrap();
        let seen = ambient_occlusion(&heights, &occlusion).unwrap();
        let curved = curvature(&heights, &bent).unwrap();
        let (middle, first) = (chunk(1, 1), [64; 2]);
        let part = normal_map_of_field(&field, &middle, &NormalOptions::default()).unwrap();
        assert_eq!(part, normals.crop(first, [64; 2]).unwrap());
        let part = ambient_occlusion_of_field(&field, &middle, &occlusion).unwrap();
        assert_eq!(part, seen.crop(first, [64; 2]).unwrap());
        let part = curvature_of_field(&field, &middle, &bent).unwrap();
        assert_eq!(part, curved.crop(first, [64; 2]).unwrap());
    }

    #[test]
    fn a_repeated_chunk_would_lean_the_other_way_at_its_sides() {
        let slope = field_fn(|[x, _y]| x as f32);
        let window = chunk(0, 0);
        let normals = normal_map_of_field(&slope, &window, &NormalOptions::default()).unwrap();
        let right = 0.5_f32.sqrt();
        assert!(normals.pixels().iter().all(|normal| normal.x == -right));
        let heights = Raster::from_window(&window, |at| at.x as f32).unwrap();
        let repeated = HeightPlane::for_window(&window, [Wrap::Repeat; 2]);
        let normals = normal_map(&heights, &repeated.into()).unwrap();
        assert!(normals.row(0)[0].x > 0.9, "the last column is its neighbor");
        let open = HeightPlane::for_window(&window, [Wrap::Clamp; 2]);
        let normals = normal_map(&heights, &open.into()).unwrap();
        assert_eq!(normals.row(0)[0].x, -right);
    }

    #[test]
    fn bad_options_are_refused_before_the_margin_is_rendered() {
        let field = field_fn(hills);
        let wild = OcclusionOptions {
            radius: f64::INFINITY,
            ..OcclusionOptions::default()
        };
        assert!(ambient_occlusion_of_field(&field, &chunk(0, 0), &wild).is_err());
        let wild = CurvatureOptions {
            radius: -1.0,
            ..CurvatureOptions::default()
        };
        assert!(curvature_of_field(&field, &chunk(0, 0), &wild).is_err());
    }
}
