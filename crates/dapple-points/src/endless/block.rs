//! Evaluates a block of cells: decides which darts become points.
//!
//! Lengths are in steps, relative to the first cell of the block.

use super::{EndlessPoint, N_ROUNDS, Plane, Strip};
use core::array::from_fn;
use core::cmp::Ordering;
use dapple_hash::{CellHash, unit_f64};
use glam::DVec2;

/// Reason why a block cannot be evaluated.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Stop {
    /// A dart depends on cells beyond the margin.
    Margin,
    /// The radius is not above zero and finite.
    Radius { position: DVec2, radius: f64 },
}

/// The cells of a block and the margin around it.
pub(super) struct Block<'a, F> {
    plane: &'a Plane,
    radius: &'a F,
    columns: Vec<Strip>,
    rows: Vec<Strip>,
    margin: usize,
    cells: Vec<Cell>,
    /// Neighbors of a cell, nearest first.
    around: Vec<Neighbor>,
    /// Stack of cells that must be decided before the current darts.
    earlier: Vec<usize>,
    /// Scratch memory for [`cover_around`](Self::cover_around).
    quarters: [Vec<[f64; 4]>; 2],
    /// Minimum and maximum radius.
    radii: [f64; 2],
}

/// A cell's state: its current dart, and whether the dart is a point.
#[derive(Clone, Copy)]
struct Cell {
    hash: CellHash,
    /// Random bits for the positions of the cell's darts.
    place: u64,
    dart: Dart,
    /// Current round; [`N_ROUNDS`] after the last one.
    round: u8,
    state: State,
    /// Mask of the sixteenths of the cell, by row and column, in which every dart would be too close to a point.
    covered: u16,
}

/// A candidate point.
#[derive(Clone, Copy)]
struct Dart {
    at: [f64; 2],
    /// Radius at its position.
    radius: f64,
}

/// A conflict between a dart and a neighboring cell.
enum Rival {
    /// No conflict.
    None,
    /// A point is too close to the dart.
    Winner,
    /// An earlier dart in this round is too close to it.
    Earlier(u8),
}

#[derive(Clone, Copy, PartialEq)]
enum State {
    /// The cell has not been accessed.
    New,
    /// The cell is at the edge of the margin and cannot be evaluated.
    Edge,
    /// The current dart is undecided.
    Open,
    /// The current dart is a point.
    Point,
}

/// The relative position of a nearby cell.
#[derive(Clone, Copy)]
struct Neighbor {
    /// Offset to the nearby cell, in columns and rows.
    by: [i64; 2],
    /// Offset to the nearby cell's index.
    offset: isize,
    /// Minimum squared distance between positions of the two cells.
    distance_sq: f64,
}

impl<'a, F: Fn([f64; 2]) -> f64> Block<'a, F> {
    pub(super) fn new(plane: &'a Plane, cells: [[i64; 2]; 2], margin: i64, radius: &'a F) -> Self {
        let strips = |axis: usize| -> Vec<Strip> {
            let [first, end] = cells[axis];
            let numbers = first - margin..end + margin;
            numbers.map(|cell| plane.axes[axis].strip(cell)).collect()
        };
        let [columns, rows] = [0, 1].map(strips);
        let reach = plane.reach();
        let mut block = Self {
            cells: vec![NEW; columns.len() * rows.len()],
            around: around(plane, columns.len()),
            radii: plane.radii.map(|radius| radius / plane.step),
            plane,
            radius,
            columns,
            rows,
            margin: margin as usize,
            earlier: Vec::new(),
            quarters: Default::default(),
        };
        block.close_edge(reach as usize);
        block
    }

    /// Marks the cells whose neighborhood extends beyond the block.
    fn close_edge(&mut self, reach: usize) {
        let (width, height) = (self.columns.len(), self.rows.len());
        for (y, row) in self.cells.chunks_mut(width).enumerate() {
            let is_inside = y >= reach && y < height - reach;
            let (left, right) = if is_inside {
                (reach, reach)
            } else {
                (width, 0)
            };
            row[..left]
                .iter_mut()
                .for_each(|cell| cell.state = State::Edge);
            row[width - right..]
                .iter_mut()
                .for_each(|cell| cell.state = State::Edge);
        }
    }

    /// Decides all cells of the block, and returns the points.
    pub(super) fn solve(mut self) -> Result<Vec<EndlessPoint>, Stop> {
        let width = self.columns.len();
        let inside = |n: usize| self.margin..n - self.margin;
        let columns = inside(width);
        let rows = inside(self.rows.len());
        let all = rows.flat_map(move |y| columns.clone().map(move |x| y * width + x));
        let mut open: Vec<usize> = all.clone().collect();
        for round in 0..N_ROUNDS {
            for &cell in &open {
                self.decide(cell, round)?;
            }
            open.retain(|&cell| {
                self.cells[cell].state == State::Open && self.cells[cell].round < N_ROUNDS
            });
        }
        let found = all.filter_map(move |index| {
            let cell = &self.cells[index];
            (cell.state == State::Point).then(|| EndlessPoint {
                position: self.position(index),
                radius: cell.dart.radius * self.plane.step,
                id: cell.hash.at(ID),
            })
        });
        Ok(found.collect())
    }

    /// Decides the darts of a cell in all rounds up to and including `round`.
    fn decide(&mut self, index: usize, round: u8) -> Result<(), Stop> {
        if self.cells[index].state == State::New {
            self.start(index)?;
        }
        while self.cells[index].state == State::Open && self.cells[index].round <= round {
            if !self.cells[index].is_covered() && self.stays(index)? {
                self.cells[index].state = State::Point;
                self.cover_around(index);
            } else {
                self.cells[index].round += 1;
                self.throw(index)?;
            }
        }
        Ok(())
    }

    /// Returns whether the current dart of a cell is far enough from all points of earlier darts.
    fn stays(&mut self, index: usize) -> Result<bool, Stop> {
        let (dart, round) = (self.cells[index].dart, self.cells[index].round);
        let reach = self.plane.rule.distance(dart.radius, self.radii[1]);
        let begin = self.earlier.len();
        // Check the rivals that are decided, and collect the undecided ones.
        for which in 0..self.around.len() {
            let neighbor = self.around[which];
            if neighbor.distance_sq >= reach * reach {
                break;
            }
            let other_index = index.wrapping_add_signed(neighbor.offset);
            if self.cells[other_index].state == State::New {
                self.start(other_index)?;
            }
            let other = &self.cells[other_index];
            match other.state {
                // Its dart is an earlier one: a later one would have waited for this dart.
                State::Point if self.are_too_close(&dart, &other.dart) => {
                    self.earlier.truncate(begin);
                    return Ok(false);
                }
                State::Open
                    if other.round < round
                        || (other.round == round && self.are_too_close(&dart, &other.dart)) =>
                {
                    self.earlier.push(other_index);
                }
                State::Edge => return Err(Stop::Margin),
                _ => {}
            }
        }
        // Decide the earlier darts that are too close.
        let mut is_free = true;
        while is_free && self.earlier.len() > begin {
            let other_index = self.earlier[self.earlier.len() - 1];
            match self.next_rival(&dart, self.cells[index].hash, round, other_index)? {
                Rival::Earlier(until) => self.decide(other_index, until)?,
                Rival::None => {
                    self.earlier.pop();
                }
                Rival::Winner => is_free = false,
            }
        }
        self.earlier.truncate(begin);
        Ok(is_free)
    }

    /// Finds the conflict of a dart with another cell; `hash` is the hash of the dart's cell.
    fn next_rival(
        &self,
        dart: &Dart,
        hash: CellHash,
        round: u8,
        other_index: usize,
    ) -> Result<Rival, Stop> {
        let other = &self.cells[other_index];
        let is_near = self.are_too_close(dart, &other.dart);
        if other.state == State::Point {
            return Ok(if is_near { Rival::Winner } else { Rival::None });
        }
        // Find an earlier round in which the other cell has a dart too close.
        for its_round in other.round..round {
            let its_dart = if its_round == other.round {
                Some(other.dart)
            } else {
                self.dart(other_index, its_round)?
            };
            if its_dart.is_some_and(|its_dart| self.are_too_close(dart, &its_dart)) {
                return Ok(Rival::Earlier(its_round));
            }
        }
        if other.round > round {
            return Ok(Rival::None);
        }
        let its_dart = if other.round == round {
            Some(other.dart)
        } else {
            self.dart(other_index, round)?
        };
        // Both darts are in the same round, so the lower rank comes first.
        if !its_dart.is_some_and(|its_dart| self.are_too_close(dart, &its_dart)) {
            return Ok(Rival::None);
        }
        let [mine, theirs] = [hash, other.hash].map(|hash| hash.at(RANK + u32::from(round)));
        Ok(match theirs.cmp(&mine) {
            Ordering::Less => Rival::Earlier(round),
            // If the ranks are equal, neither dart becomes a point.
            Ordering::Equal => Rival::Winner,
            Ordering::Greater => Rival::None,
        })
    }

    fn are_too_close(&self, a: &Dart, b: &Dart) -> bool {
        let [x, y] = [a.at[0] - b.at[0], a.at[1] - b.at[1]];
        let least = self.plane.rule.distance(a.radius, b.radius);
        x * x + y * y < least * least
    }

    /// Initializes a cell with its first dart.
    fn start(&mut self, index: usize) -> Result<(), Stop> {
        let [column, row] = self.strips(index);
        let hash = CellHash::new(self.plane.seed, [column.cell, row.cell]);
        self.cells[index].hash = hash;
        self.cells[index].place = hash.at(PLACE);
        self.cells[index].state = State::Open;
        self.throw(index)
    }

    /// Throws darts, starting with the current round, until one falls in an uncovered part.
    fn throw(&mut self, index: usize) -> Result<(), Stop> {
        while self.cells[index].round < N_ROUNDS {
            let cell = &self.cells[index];
            if !cell.is_covered()
                && let Some(dart) = self.dart(index, cell.round)?
            {
                self.cells[index].dart = dart;
                return Ok(());
            }
            self.cells[index].round += 1;
        }
        Ok(())
    }

    /// Returns the dart of a cell in a round, if there is one.
    fn dart(&self, index: usize, round: u8) -> Result<Option<Dart>, Stop> {
        let cell = &self.cells[index];
        let bits = cell.place ^ DARTS[usize::from(round)];
        let strips = self.strips(index);
        let along = |bits: u32, strip: &Strip| (i64::from(bits) * strip.width) >> 32;
        let within = [
            along((bits >> 32) as u32, &strips[0]),
            along(bits as u32, &strips[1]),
        ];
        let in_period = |axis: usize| (strips[axis].start + within[axis]) as f64 * self.plane.step;
        let position = [in_period(0), in_period(1)];
        let radius = (self.radius)(position);
        if !(radius > 0.0 && radius.is_finite()) {
            let position = position.into();
            return Err(Stop::Radius { position, radius });
        }
        let [least, most] = self.radii;
        let radius = (radius / self.plane.step).clamp(least, most);
        // Thin the darts where the radius is large, so that their number per point is constant.
        let share = least / radius;
        if share < 1.0 && unit_f64(cell.hash.at(THIN + u32::from(round))) >= share * share {
            return Ok(None);
        }
        let first = [self.columns[0].absolute, self.rows[0].absolute];
        let local = |axis: usize| (strips[axis].absolute - first[axis] + within[axis]) as f64;
        let at = [local(0), local(1)];
        Ok(Some(Dart { at, radius }))
    }

    /// Returns the position of a cell's current dart, in the caller's units.
    fn position(&self, index: usize) -> DVec2 {
        let strips = self.strips(index);
        let first = [self.columns[0].absolute, self.rows[0].absolute];
        let along = |axis: usize| {
            let strip = &strips[axis];
            let within = self.cells[index].dart.at[axis] as i64 - (strip.absolute - first[axis]);
            strip.origin + (strip.start + within) as f64 * self.plane.step
        };
        DVec2::new(along(0), along(1))
    }

    /// Returns the column and row of the cell at `index`.
    fn strips(&self, index: usize) -> [Strip; 2] {
        let width = self.columns.len();
        [self.columns[index % width], self.rows[index / width]]
    }

    /// Marks the sixteenths of surrounding cells in which a new point excludes every dart, whatever the dart's radius
    /// is.
    fn cover_around(&mut self, index: usize) {
        let point = self.cells[index].dart;
        let reach = self.plane.rule.distance(self.radii[0], point.radius);
        let reach_sq = reach * reach;
        let width = self.columns.len();
        let (column, row) = (index % width, index / width);
        // Squared distances from the point to the far sides of the quarters of surrounding columns and rows
        let quarters = |axis: usize, strip: &Strip, first: &Strip| -> [f64; 4] {
            let start = (strip.absolute - first.absolute) as f64 - point.at[axis];
            let quarter = 0.25 * strip.width as f64;
            from_fn(|which| {
                // Positions of darts are rounded down to a step.
                let low = start + quarter * which as f64 - 1.0;
                let high = low + quarter + 1.0;
                (low * low).max(high * high)
            })
        };
        let n_around = self.plane.reach() as usize;
        for (axis, strips, at) in [(0, &self.columns, column), (1, &self.rows, row)] {
            let near = &strips[at - n_around..=at + n_around];
            self.quarters[axis].clear();
            self.quarters[axis].extend(near.iter().map(|strip| quarters(axis, strip, &strips[0])));
        }
        for neighbor in &self.around {
            if neighbor.distance_sq >= reach_sq {
                break;
            }
            let cell = &mut self.cells[index.wrapping_add_signed(neighbor.offset)];
            if cell.state == State::Point || cell.covered == u16::MAX {
                continue;
            }
            let [x, y] = neighbor.by;
            let x_sq = self.quarters[0][n_around.wrapping_add_signed(x as isize)];
            let y_sq = self.quarters[1][n_around.wrapping_add_signed(y as isize)];
            let mut covered = 0;
            for (y, y_sq) in y_sq.into_iter().enumerate() {
                for (x, x_sq) in x_sq.into_iter().enumerate() {
                    covered |= u16::from(x_sq + y_sq < reach_sq) << (4 * y + x);
                }
            }
            cell.covered |= covered;
        }
    }
}

impl Cell {
    /// Returns whether the position of the current dart is known to be too close to a point.
    fn is_covered(&self) -> bool {
        let bits = self.place ^ DARTS[usize::from(self.round)];
        let [x, y] = [bits >> 62, bits >> 30 & 3];
        self.covered >> (4 * y + x) & 1 == 1
    }
}

/// Counters for a cell's hash: positions of its darts, id of its point, ranks and thinning of its darts.
const PLACE: u32 = 0;
const ID: u32 = 1;
const RANK: u32 = 2;
const THIN: u32 = RANK + N_ROUNDS as u32;

/// First points of the Sobol sequence, x in the upper half. In each round, one is combined with the position bits of a
/// cell, so that the darts of a cell fall into different parts of it.
const DARTS: [u64; N_ROUNDS as usize] = {
    let mut darts = [0; N_ROUNDS as usize];
    let mut round = 0;
    while round < N_ROUNDS as u32 {
        let (mut y, mut direction, mut rest) = (0_u32, 1_u32 << 31, round);
        while rest > 0 {
            if rest & 1 == 1 {
                y ^= direction;
            }
            direction ^= direction >> 1;
            rest >>= 1;
        }
        darts[round as usize] = (round.reverse_bits() as u64) << 32 | y as u64;
        round += 1;
    }
    darts
};

/// A cell that has not been accessed.
const NEW: Cell = Cell {
    hash: CellHash::of_words([0, 0]),
    place: 0,
    dart: Dart {
        at: [0.0; 2],
        radius: 0.0,
    },
    round: 0,
    state: State::New,
    covered: 0,
};

/// Returns the neighbors of a cell that are nearer than the largest radius, nearest first.
fn around(plane: &Plane, width: usize) -> Vec<Neighbor> {
    let reach = plane.reach();
    let most = plane.radii[1] / plane.step;
    let gap = |axis: usize, by: i64| {
        let gap = (by.abs() - 1).max(0) * plane.axes[axis].narrowest();
        (gap * gap) as f64
    };
    let all = (-reach..=reach).flat_map(|y| (-reach..=reach).map(move |x| [x, y]));
    let mut around: Vec<Neighbor> = all
        .filter(|&by| by != [0, 0])
        .map(|by| Neighbor {
            by,
            offset: by[1] as isize * width as isize + by[0] as isize,
            distance_sq: gap(0, by[0]) + gap(1, by[1]),
        })
        .filter(|neighbor| neighbor.distance_sq < most * most)
        .collect();
    around.sort_by(|a, b| {
        let length_sq = |n: &Neighbor| n.by[0] * n.by[0] + n.by[1] * n.by[1];
        a.distance_sq
            .total_cmp(&b.distance_sq)
            .then(length_sq(a).cmp(&length_sq(b)))
    });
    around
}
