//! Positions of the samples of a square that is laid out on a surface.
//!
//! Input: the center on the surface, the direction O there, the rates at which the field rotates, and the spacing.
//! Output: position and normal of each sample. Positions are relative to the center.

use super::turning::Turning;
use crate::domain::Square;
use dapple_mesh::{Surface, SurfacePoint, Walk};
use glam::{DVec2, DVec3, Vec3};

/// Number of samples in a register.
const LANES: usize = 8;

/// Samples of a square on a surface, stored in rows of at most eight.
#[derive(Clone, Debug, Default)]
pub(crate) struct Lattice {
    /// Number of samples along a side.
    pub(crate) side: usize,
    /// Unit vectors at the center: across the rows (O), and along the rows (P).
    pub(crate) down: DVec3,
    pub(crate) right: DVec3,
    pub(crate) rows: Vec<Row>,
    /// Rotation of the directions O and P during half of a walking step.
    turning: Turning,
}

/// Up to eight consecutive samples of a row of the square.
#[derive(Clone, Debug)]
pub(crate) struct Row {
    /// Index of the row in the square, from the top.
    pub(crate) at: usize,
    pub(crate) first_column: usize,
    /// Number of used lanes.
    pub(crate) n_lanes: usize,
    /// Position relative to the center (x, y, z) and normal (x, y, z) of each sample.
    pub(crate) lanes: [[f32; LANES]; 6],
}

/// Coordinate of unused samples. It is out of reach of all sites, and its square is finite.
const NOWHERE: f32 = 1e18;

impl Lattice {
    /// Walks to all samples of a square around a point. Directions are transported along the walk and rotate during it.
    pub(crate) fn lay(
        &mut self,
        surface: &Surface,
        middle: SurfacePoint,
        (orientation, turning): (DVec3, Turning),
        square: &Square,
        spacing: f64,
    ) {
        self.make_room(square);
        self.turning = turning;
        // Find O at the center, in the plane of its face.
        let down = surface
            .flatten(middle.face, orientation)
            .normalize_or(DVec2::X);
        self.down = surface.lift(middle.face, down);
        self.right = surface.lift(middle.face, down.perp());
        let center = surface.position(middle);
        let half = square.half;
        let start = Walk {
            point: middle,
            direction: down,
            left: 0.0,
        };
        let around = (center, spacing);
        // Walk along the column through the center.
        self.lay_column(surface, &start, half as usize, square, around);
        // Walk to the right and to the left; after each step, walk along the column there.
        for way in [1.0, -1.0] {
            let turn = turning.right.toward(way);
            let mut walk = Walk {
                direction: down.perp() * way,
                ..start
            };
            for step in 1..=half {
                // Rotate by half before the step and by half after it (second-order midpoint rule).
                walk = surface.walk(walk.point, turn.of(walk.direction), spacing);
                walk.direction = turn.of(walk.direction);
                let column = Walk {
                    direction: -walk.direction.perp() * way,
                    ..walk
                };
                let at = half + step * way as i32;
                self.lay_column(surface, &column, at as usize, square, around);
            }
        }
    }

    /// Arranges the given points in rows of eight, relative to `center`. The direction across the rows points from the
    /// first point to the last.
    pub(crate) fn line_up(&mut self, surface: &Surface, points: &[SurfacePoint], center: DVec3) {
        // Point the axis across the rows from the first point to the last.
        self.side = points.len();
        self.down = match points {
            [first, .., last] => surface.position(*last) - surface.position(*first),
            _ => DVec3::ZERO,
        }
        .normalize_or(DVec3::Z);
        self.right = self.down.any_orthonormal_vector();
        self.rows.clear();
        for (number, points) in points.chunks(LANES).enumerate() {
            self.rows.push(Row::new(0, number * LANES, points.len()));
            for (lane, &point) in points.iter().enumerate() {
                // Use the smooth normal, which does not change from face to face.
                let normal = surface.normal(point);
                self.put(surface, (point, normal), [0, number * LANES + lane], center);
            }
        }
    }

    /// Returns whether adjacent samples are at least `least` apart, in all columns and in the middle row (or in the
    /// last row, if there is no middle one).
    pub(crate) fn is_spread(&self, least: f32) -> bool {
        let blocks = self.side.div_ceil(LANES).max(1);
        let n_rows = self.rows.len() / blocks;
        let place = |row: usize, column: usize| {
            let lanes = &self.rows[row * blocks + column / LANES].lanes;
            Vec3::from([0, 1, 2].map(|part| lanes[part][column % LANES]))
        };
        let is_apart = |a: Vec3, b: Vec3| a.distance_squared(b) >= least * least;
        let middle = (self.side / 2).min(n_rows.saturating_sub(1));
        let along =
            |row: usize, column: usize| is_apart(place(row - 1, column), place(row, column));
        (0..self.side).all(|column| (1..n_rows).all(|row| along(row, column)))
            && (1..self.side)
                .all(|column| is_apart(place(middle, column - 1), place(middle, column)))
    }

    /// Allocates the rows that the square needs. Unused lanes are at [`NOWHERE`].
    fn make_room(&mut self, square: &Square) {
        let side = square.side();
        let n_rows = square.range().count();
        let blocks = side.div_ceil(LANES);
        if self.side == side && self.rows.len() == n_rows * blocks {
            return;
        }
        self.side = side;
        self.rows = (0..n_rows * blocks)
            .map(|number| {
                let first_column = number % blocks * LANES;
                Row::new(
                    number / blocks,
                    first_column,
                    LANES.min(side - first_column),
                )
            })
            .collect();
    }

    /// Walks up and down from the middle of a column. The direction of `start` is O.
    fn lay_column(
        &mut self,
        surface: &Surface,
        start: &Walk,
        column: usize,
        square: &Square,
        (center, spacing): (DVec3, f64),
    ) {
        let half = square.half;
        let last = *square.range().end();
        let mut normal = (start.point.face, surface.face_normal(start.point.face));
        // Store the middle of the column.
        if last >= 0 {
            let at = [half as usize, column];
            self.put(surface, (start.point, normal.1), at, center);
        }
        // Walk up, then down.
        for (way, n_steps) in [(-1, half), (1, last)] {
            let turn = self.turning.down.toward(f64::from(way));
            let (mut point, mut direction) = (start.point, start.direction * f64::from(way));
            for step in 1..=n_steps {
                let walk = surface.walk(point, turn.of(direction), spacing);
                (point, direction) = (walk.point, turn.of(walk.direction));
                if point.face != normal.0 {
                    normal = (point.face, surface.face_normal(point.face));
                }
                let row = (half + way * step) as usize;
                self.put(surface, (point, normal.1), [row, column], center);
            }
        }
    }

    /// Stores a sample.
    #[inline]
    fn put(
        &mut self,
        surface: &Surface,
        (point, normal): (SurfacePoint, DVec3),
        [row, column]: [usize; 2],
        center: DVec3,
    ) {
        let position = (surface.position(point) - center).as_vec3();
        let normal = normal.as_vec3();
        let blocks = self.side.div_ceil(LANES);
        let row = &mut self.rows[row * blocks + column / LANES];
        let lane = column % LANES;
        for part in 0..3 {
            row.lanes[part][lane] = position[part];
            row.lanes[3 + part][lane] = normal[part];
        }
    }
}

impl Row {
    /// Creates a row whose samples are at [`NOWHERE`].
    fn new(at: usize, first_column: usize, n_lanes: usize) -> Self {
        let (far, zero) = ([NOWHERE; LANES], [0.0; LANES]);
        Self {
            at,
            first_column,
            n_lanes,
            lanes: [far, far, far, zero, zero, zero],
        }
    }
}
