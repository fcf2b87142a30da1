//! Assigns values to points: random, or from a function of the position, a field or a palette.

use crate::PupsError;
use dapple_hash::{Seed, hash1, unit_f32};
use dapple_points::PointSet;
use dapple_raster::{Field, FieldExt as _, Varying};

/// Returns independent random values, uniform in `[0, 1)`, as in the paper's noise.
///
/// # Examples
///
/// ```
/// use dapple_pups::{hash::Seed, random_values};
///
/// let values = random_values(700, Seed(7));
/// assert!(values.iter().all(|value| (0.0..1.0).contains(value)));
/// ```
#[must_use]
pub fn random_values(n_points: usize, seed: Seed) -> Vec<f32> {
    // A set has at most 2^31 points, so indices fit into `i64`.
    (0..n_points as i64)
        .map(|index| random_value(seed, index))
        .collect()
}

/// Returns a random number in `[0, 1)` for the index of a point, a cell or a label.
pub(crate) fn random_value(seed: Seed, index: i64) -> f32 {
    unit_f32((hash1(seed, [index], 0) >> 32) as u32)
}

/// Evaluates `value` at the points.
///
/// # Errors
///
/// [`Range`](crate::PupsErrorKind::Range) if a value is not finite in single precision.
pub fn varying_values(points: &PointSet, value: &Varying) -> Result<Vec<f32>, PupsError> {
    let values: Vec<f32> = points
        .positions()
        .iter()
        .map(|&position| value.at(position) as f32)
        .collect();
    check_finite(values)
}

/// Samples a field, such as another texture, at the points.
///
/// # Errors
///
/// [`Range`](crate::PupsErrorKind::Range) if a value is not finite.
pub fn field_values(points: &PointSet, field: &dyn Field) -> Result<Vec<f32>, PupsError> {
    let mut values = vec![0.0; points.len()];
    field.sample_many(points.positions(), &mut values)?;
    check_finite(values)
}

/// Returns the palette's vector (such as a color) for each label. Labels beyond the end of the palette wrap around.
///
/// # Errors
///
/// [`Count`](crate::PupsErrorKind::Count) if the palette is empty.
///
/// # Examples
///
/// ```
/// use dapple_pups::{hash::Seed, palette_values, random_labels};
///
/// let (red, blue) = ([1.0, 0.0, 0.0], [0.0, 0.0, 1.0]);
/// let colors = palette_values(&random_labels(700, 2, Seed(7))?, &[red, blue])?;
/// assert!(colors.contains(&red) && colors.contains(&blue));
/// # Ok::<(), dapple_pups::PupsError>(())
/// ```
pub fn palette_values<const N: usize>(
    labels: &[u32],
    palette: &[[f32; N]],
) -> Result<Vec<[f32; N]>, PupsError> {
    if palette.is_empty() {
        PupsError::check_count("colors of the palette", 0, 1)?;
    }
    let color = |&label: &u32| palette[label as usize % palette.len()];
    Ok(labels.iter().map(color).collect())
}

fn check_finite(values: Vec<f32>) -> Result<Vec<f32>, PupsError> {
    for &value in &values {
        PupsError::check(
            value.is_finite(),
            "value of a control point",
            f64::from(value),
            "finite",
        )?;
    }
    Ok(values)
}
