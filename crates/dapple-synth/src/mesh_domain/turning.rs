//! Rotation of the orientation field near a site, to first order.
//!
//! If a square is laid out with the directions at its center alone, features of a curved field cross it at an angle.
//! The paper's first pass reads only the rows above. There the features appear to come from one side, and are continued
//! straight where they should bend. All later passes retain that error. So during the walk to a sample, the directions
//! rotate as the field does. There are two rates, one along P and one along O, fitted by least squares to the field at
//! the neighbors of the site.

use crate::{Hierarchy, Orientation, SiteIdx};
use glam::DVec2;

/// Maximum rotation from the center of a square to its edge, in radians. Close to a singularity of the field no rate is
/// useful. Sites out of reach of the square have no influence.
const MOST: f64 = 0.5;

/// Rotations of the orientation field over half of a step between two samples of a neighborhood: `right` for steps along
/// the axis P, `down` for steps along the axis O.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Turning {
    pub(crate) right: Turn,
    pub(crate) down: Turn,
}

/// A rotation in a tangent plane: its cosine and sine.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Turn(DVec2);

impl Turning {
    /// Fits the field around a site of a level. Samples are `spacing` apart, and up to `half` steps from the center.
    pub(crate) fn around(
        hierarchy: &Hierarchy,
        orientation: &Orientation,
        (site, level): (SiteIdx, usize),
        (spacing, half): (f64, i32),
    ) -> Self {
        let Some([right, down]) = turn_rates(hierarchy, orientation, site, level) else {
            return Self::default();
        };
        // Limit the rotation over the whole square.
        let limit = MOST / f64::from(half.max(1));
        let half_step = |rate: f64| Turn::by((spacing * rate).clamp(-limit, limit) / 2.0);
        Self {
            right: half_step(right),
            down: half_step(down),
        }
    }
}

/// Returns the rates at which the field rotates from O toward P, along P and along O, in radians per unit length. They
/// are a least-squares fit to the neighbors of a site. `None` if the neighbors are collinear.
pub(crate) fn turn_rates(
    hierarchy: &Hierarchy,
    orientation: &Orientation,
    site: SiteIdx,
    level: usize,
) -> Option<[f64; 2]> {
    let (positions, normals) = (hierarchy.sites().positions(), hierarchy.sites().normals());
    let vectors = orientation.vectors();
    let at = site.index();
    let (down, right) = (vectors[at], normals[at].cross(vectors[at]));
    // Normal equations of the least-squares fit: rotation = x * along P + y * along O.
    let (mut xx, mut xy, mut yy, mut of_x, mut of_y) = (0.0, 0.0, 0.0, 0.0, 0.0);
    for other in hierarchy.levels()[level].graph().neighbors(site) {
        let other = other.index();
        let step = positions[other] - positions[at];
        let (x, y) = (step.dot(right), step.dot(down));
        // Sine of the angle from O here to O there, in the tangent plane.
        let there = orientation.nearest(normals, other, down);
        let there = DVec2::new(there.dot(down), there.dot(right));
        let turn = there.normalize_or(DVec2::X).y;
        xx += x * x;
        xy += x * y;
        yy += y * y;
        of_x += x * turn;
        of_y += y * turn;
    }
    // Solve the equations.
    let determinant = xx * yy - xy * xy;
    // Collinear neighbors determine only one rate. The comparison is false for NaN as well.
    let is_plane = determinant > 1e-6 * (xx + yy) * (xx + yy);
    is_plane.then(|| {
        [
            (yy * of_x - xy * of_y) / determinant,
            (xx * of_y - xy * of_x) / determinant,
        ]
    })
}

impl Default for Turn {
    /// Returns the identity.
    fn default() -> Self {
        Self(DVec2::X)
    }
}

impl Turn {
    /// Creates a rotation from O toward P by a small angle, in radians. The exact angle is 2 atan(angle / 2).
    fn by(angle: f64) -> Self {
        let tangent = angle / 2.0;
        let square = tangent * tangent;
        Self(DVec2::new(1.0 - square, angle) / (1.0 + square))
    }

    /// Rotates a direction.
    #[inline]
    pub(crate) fn of(self, direction: DVec2) -> DVec2 {
        self.0.rotate(direction)
    }

    /// Returns the rotation for a step forward (1) or backward (-1).
    #[inline]
    pub(crate) fn toward(self, way: f64) -> Self {
        Self(DVec2::new(self.0.x, way * self.0.y))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Orientation;
    use crate::domain::{Rows, Square};
    use crate::mesh_domain::Lattice;
    use crate::shapes::{sites_on, square};
    use dapple_mesh::Surface;
    use glam::DVec3;

    const HALF: i32 = 3;
    /// Center of the circles of the field; it is far from the unit square.
    const CENTER: DVec3 = DVec3::new(-1.0, 0.5, 0.0);

    fn circles(hierarchy: &Hierarchy, center: DVec3) -> Orientation {
        Orientation::from_fn(hierarchy, |at, normal| normal.cross(at - center))
    }

    /// Returns the maximum distance of the samples above and below the center of a square from the circle of the field
    /// through that center, in multiples of the spacing.
    fn off_circle(hierarchy: &Hierarchy, site: SiteIdx, turning: Turning) -> f64 {
        let surface = Surface::new(square()).unwrap();
        let orientation = circles(hierarchy, CENTER);
        let spacing = hierarchy.levels()[0].spacing();
        let laid = Square {
            site: site.0,
            level: 0,
            reads: 0,
            half: HALF,
            rows: Rows::All,
        };
        let point = hierarchy.sites().points()[site.index()];
        let directions = (orientation.vectors()[site.index()], turning);
        let mut lattice = Lattice::default();
        lattice.lay(&surface, point, directions, &laid, spacing);
        let middle = hierarchy.sites().positions()[site.index()];
        let off = lattice.rows.iter().map(|row| {
            let [x, y, z] = [0, 1, 2].map(|part| f64::from(row.lanes[part][HALF as usize]));
            let radius = (middle + DVec3::new(x, y, z)).distance(CENTER);
            (radius - middle.distance(CENTER)).abs() / spacing
        });
        off.fold(0.0, f64::max)
    }

    #[test]
    fn square_follows_a_field_of_circles() {
        let hierarchy = sites_on(square(), 400, 1);
        let orientation = circles(&hierarchy, CENTER);
        let spacing = hierarchy.levels()[0].spacing();
        let mut n_compared = 0;
        for site in hierarchy.sites().iter() {
            let at = hierarchy.sites().positions()[site.index()];
            if (at - DVec3::new(0.5, 0.5, 0.0)).abs().max_element() > 0.25 {
                continue; // The square may end at an edge of the surface.
            }
            let turning = Turning::around(&hierarchy, &orientation, (site, 0), (spacing, HALF));
            // Without rotation, three steps end 9 / 2 spacing / radius off the circle. Here the spacing is 0.054 and
            // the radius at most 1.75. The fit is of first order, and its neighbors are at different distances on
            // different sides.
            let [followed, carried] =
                [turning, Turning::default()].map(|turning| off_circle(&hierarchy, site, turning));
            assert!(carried > 0.1, "{site:?}: straight on by {carried}");
            assert!(
                followed < 0.01,
                "{site:?}: off by {followed} beside {carried}"
            );
            n_compared += 1;
        }
        assert!(n_compared > 50, "only {n_compared} sites were compared");
    }

    #[test]
    fn directions_never_turn_by_more_than_the_limit() {
        let hierarchy = sites_on(square(), 400, 1);
        let orientation = circles(&hierarchy, DVec3::new(0.5, 0.5, 0.0));
        for site in hierarchy.sites().iter() {
            let turning = Turning::around(&hierarchy, &orientation, (site, 0), (1.0, HALF));
            for Turn(turn) in [turning.right, turning.down] {
                assert!((turn.length() - 1.0).abs() < 1e-12, "{site:?}: not a turn");
                let most = MOST / f64::from(HALF) / 2.0;
                assert!(turn.y.abs() <= most, "{site:?}: turned by {turn}");
            }
        }
    }

    #[test]
    fn site_without_neighbors_goes_straight_on() {
        for n_sites in [1, 2] {
            let hierarchy = sites_on(square(), n_sites, 1);
            let orientation = circles(&hierarchy, CENTER);
            let site = (SiteIdx(0), 0);
            let turning = Turning::around(&hierarchy, &orientation, site, (0.1, HALF));
            assert_eq!(turning, Turning::default(), "{n_sites} sites");
        }
    }
}
