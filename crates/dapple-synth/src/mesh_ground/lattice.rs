//! Where the samples of a square are on a surface.

use crate::ground::Square;
use core::array;
use dapple_mesh::{Surface, SurfacePoint, Walk};
use glam::{DVec2, DVec3};

/// Samples in rows of `N` lanes, of which the first `side` are used.
///
/// Positions are relative to the site in the middle, normals those of the faces.
#[derive(Clone, Debug)]
pub(crate) struct Lattice<const N: usize> {
    pub(crate) side: usize,
    /// The rows that are laid out.
    pub(crate) n_rows: usize,
    /// The direction that rows follow each other in, at the site.
    pub(crate) down: DVec3,
    /// x, y and z of the positions, then of the normals, of all samples of a row.
    pub(crate) rows: [[[f32; N]; 6]; N],
}

/// So far away that no site counts, and that squares stay finite.
const NOWHERE: f32 = 1e18;

impl<const N: usize> Default for Lattice<N> {
    fn default() -> Self {
        let lanes = [NOWHERE; N];
        let row = [lanes, lanes, lanes, [0.0; N], [0.0; N], [0.0; N]];
        Self {
            side: 0,
            n_rows: 0,
            down: DVec3::ZERO,
            rows: [row; N],
        }
    }
}

impl<const N: usize> Lattice<N> {
    /// Walks to all samples of a square around a point.
    pub(crate) fn lay(
        &mut self,
        surface: &Surface,
        middle: SurfacePoint,
        orientation: DVec3,
        square: &Square,
        spacing: f64,
    ) {
        if self.side != square.side() {
            *self = Self::default();
            self.side = square.side();
        }
        let (first, last) = (*square.range().start(), *square.range().end());
        self.n_rows = (last - first + 1) as usize;
        let center = surface.position(middle);
        let down = surface
            .flatten(middle.face, orientation)
            .normalize_or(DVec2::X);
        self.down = surface.lift(middle.face, down);
        let half = square.half;
        // The direction of a walk is O turned to P here, and turned back for the columns.
        for (way, last_step) in [(1.0, half), (-1.0, half)] {
            let mut walk = Walk {
                point: middle,
                direction: down.perp() * way,
                left: 0.0,
            };
            for step in 0..=last_step {
                if step > 0 {
                    walk = surface.walk(walk.point, walk.direction, spacing);
                } else if way < 0.0 {
                    continue;
                }
                let column = (half + (way as i32) * step) as usize;
                let right = walk.direction * way;
                self.lay_column(
                    surface,
                    (walk.point, -right.perp()),
                    column,
                    square,
                    (center, spacing),
                );
            }
        }
    }

    /// Walks up and down from the middle of a column.
    fn lay_column(
        &mut self,
        surface: &Surface,
        (middle, down): (SurfacePoint, DVec2),
        column: usize,
        square: &Square,
        (center, spacing): (DVec3, f64),
    ) {
        let half = square.half;
        if self.n_rows > half as usize {
            self.put(surface, middle, half as usize, column, center);
        }
        for (way, n_steps) in [(-1, half), (1, *square.range().end())] {
            let (mut point, mut direction) = (middle, down * f64::from(way));
            for step in 1..=n_steps {
                let walk = surface.walk(point, direction, spacing);
                (point, direction) = (walk.point, walk.direction);
                self.put(surface, point, (half + way * step) as usize, column, center);
            }
        }
    }

    #[inline]
    fn put(
        &mut self,
        surface: &Surface,
        point: SurfacePoint,
        row: usize,
        column: usize,
        center: DVec3,
    ) {
        let position = surface.position(point) - center;
        let normal = surface.face_normal(point.face);
        let values: [f64; 6] = array::from_fn(|part| {
            if part < 3 {
                position[part]
            } else {
                normal[part - 3]
            }
        });
        for (lanes, value) in self.rows[row].iter_mut().zip(values) {
            lanes[column] = value as f32;
        }
    }
}
