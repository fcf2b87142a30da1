//! The four operations of section 3.2 on columns of values: interpolation, low-pass, down- and upsampling.

use crate::hierarchy::Blend;
use crate::{Hierarchy, SiteIdx};
use glam::DVec3;

/// The radius of interpolation in spacings of the level.
///
/// The paper does not say. At 1.0 most positions have three or four sites in reach; at 2.0 colors blur away.
pub const INTERPOLATION_RADIUS: f64 = 1.1;

impl Hierarchy {
    /// The value at a position of the surface: equation 1, with `w(x) = 2x³ − 3x² + 1` and the radius
    /// [`INTERPOLATION_RADIUS`] spacings of the level.
    ///
    /// Sites whose normal is more than a right angle from `normal` are on another sheet and do not count. Where no site is in reach, the
    /// nearest one of a wider ball counts alone. `column` holds a value for each site of the level.
    #[must_use]
    pub fn interpolate<T: Blend>(
        &self,
        level: usize,
        column: &[T],
        position: DVec3,
        normal: DVec3,
    ) -> Option<T> {
        // SKELETON: a plain version.
        let radius = self.levels()[level].spacing() * INTERPOLATION_RADIUS;
        let (mut sum, mut weights) = (T::ZERO, 0.0);
        let mut nearest: Option<(f64, SiteIdx)> = None;
        self.levels()[level]
            .grid()
            .visit(position, 3.0 * radius, |site| {
                if self.sites().normals()[site.index()].dot(normal) < 0.0 {
                    return;
                }
                let distance = self.sites().positions()[site.index()].distance(position);
                if nearest.is_none_or(|(least, _)| distance < least) {
                    nearest = Some((distance, site));
                }
                let x = distance / radius;
                if x < 1.0 {
                    let weight = (2.0 * x - 3.0) * x * x + 1.0;
                    sum = sum.add_scaled(column[site.index()], weight);
                    weights += weight;
                }
            });
        if weights > 1e-9 {
            return Some(T::ZERO.add_scaled(sum, 1.0 / weights));
        }
        nearest.map(|(_, site)| column[site.index()])
    }
}
