//! Shapes stamped at the points of a jittered lattice: gravel, leaves, grass, rivets, scales, scratches.
//!
//! Each cell of the lattice has a few points, and each point a stamp: a shape with a height profile and random size,
//! rotation and height. Where stamps overlap, the visible one is chosen by height, by a random order or by the rows of
//! the lattice. This is the "tile sampler" of texturing programs, and the texture bombing of R. S. Glanville, "Texture
//! Bombing", GPU Gems, chapter 20, 2004, with exact periods.
//!
//! A position depends only on the stamps of the cells within reach. Stamps are placed relative to the cell of the
//! position, so that a period is exact, and positions far from the origin have the same precision as near ones. Stamps
//! are visited row by row of cells, then by column, then by index within the cell. Of stamps of equal rank, the last
//! one visited is visible.
//!
//! Positions are in cells. Lengths are in units of a cell's width.

mod shader;
mod shape;
mod spacing;

#[cfg(test)]
mod tests;

pub use shader::StampTable;
pub use shape::StampShape;

use crate::PatternError;
use crate::lattice::{check_period, direction, wrapped_cell};
use crate::near::{self, NearCells};
use dapple_hash::{CellHash, Seed, unit_f32};
use dapple_raster::{Field, Range, RasterError, RasterViewMut, Window, range};
use shape::Outline;
use spacing::Spacing;

dapple_raster::named! {
    /// Rule for positions that several stamps cover.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub enum StampOverlap {
        /// The highest stamp at the position.
        #[default]
        Highest = "highest",
        /// The last stamp of a random order, such as fallen leaves.
        Order = "order",
        /// The stamp of the upper row, and within a row the right one, such as roof slates.
        Rows = "rows",
        /// The sum of all heights; other values come from the highest stamp.
        Add = "add",
    }
}

dapple_raster::named! {
    /// Value of stamps at a position. All values are 0 outside of stamps.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub enum StampValue {
        /// Height of the stamp, from 0 to 1; with the overlap `add`, the sum of heights.
        #[default]
        Height = "height",
        /// 1 on a stamp.
        Mask = "mask",
        /// Random number of the stamp, from 0 to below 1.
        Random = "random",
        /// Second random number of the stamp, from 0 to below 1.
        Random2 = "random2",
        /// Third random number of the stamp, from 0 to below 1.
        Random3 = "random3",
        /// Coordinate along the stamp, from 0 to 1.
        U = "u",
        /// Coordinate across the stamp, from 0 to 1.
        V = "v",
        /// Distance from the outline relative to the middle of the stamp, from 0 at the outline to 1.
        EdgeDistance = "edge_distance",
        /// Rotation of the stamp in turns, from 0 to below 1.
        Angle = "angle",
    }
}

const SIZE: Range = range!(from 0.001 to 8);
const ASPECT: Range = range!(from 0.01 to 1);
const ROTATION: Range = range!(from -360 to 360);
const CELL_HEIGHT: Range = range!(from 0.01 to 100);

/// Maximum reach of a stamp beyond the cell of its point, in cells along an axis.
const MAX_REACH: f64 = 8.0;

/// Maximum number of stamps in the cells within reach of a position.
const MAX_NEAR: f64 = 1024.0;

/// Options of [`Stamps`]. Lengths are in widths of a cell. Shapes are not stretched.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StampOptions {
    /// Period along each axis in cells; `None` for an axis without a period.
    pub period: [Option<u32>; 2],
    /// Height of a cell relative to its width, from 0.01 to 100; by default 1.
    pub cell_height: f64,
    /// Mean number of stamps per cell, above 0 and at most 16; by default 1. Every cell has the integer part of this
    /// number, and one more with the probability of the fraction.
    pub density: f64,
    /// Maximum offset of a point from the center of its cell, from 0 (a regular lattice) to 1 (anywhere in the cell);
    /// by default 1.
    pub jitter: f64,
    /// Minimum distance between two points, from 0 to 4; by default 0. Of points that are closer, only the ones with
    /// the highest random priority remain, which lowers the density.
    pub spacing: f64,
    /// Shift of each row of cells relative to the row above, in cells, from −1 to 1; by default 0.
    pub row_offset: f64,
    /// Shape of the stamps.
    pub shape: StampShape,
    /// Minimum and maximum length of a stamp, from 0.001 to 8; by default ½ and 1.
    pub size: [f64; 2],
    /// Minimum and maximum width of a stamp relative to its length, from 0.01 to 1; by default 1.
    pub aspect: [f64; 2],
    /// Minimum and maximum clockwise rotation of a stamp in degrees, from −360 to 360; by default 0 and 360. At 0, the
    /// length of a stamp is along the x axis.
    pub rotation: [f64; 2],
    /// Minimum and maximum height of a stamp, from 0 to 1; by default 1.
    pub height: [f64; 2],
    /// Width of the bevel of flat shapes relative to half of their width, from 0 to 1; by default 0.2.
    pub bevel: f64,
    /// Fraction of a stamp's height that depends on its random rank in the stamping order instead of its profile, from
    /// 0 to 1; by default 0. It makes stamps on top of others higher.
    pub lift: f64,
    /// Slope of the profile along a stamp, from −1 to 1; by default 0. At 1, the height rises from 0 at its start to the
    /// full profile at its end.
    pub tilt: f64,
    /// Rule for positions that several stamps cover.
    pub overlap: StampOverlap,
}

/// Ranges of options, for the schema of recipes.
#[doc(hidden)]
impl StampOptions {
    pub const DENSITY: Range = range!(above 0 to 16);
    pub const FRACTION: Range = range!(from 0 to 1);
    pub const SIGNED: Range = range!(from -1 to 1);
    pub const SPACING: Range = range!(from 0 to 4);
}

impl Default for StampOptions {
    fn default() -> Self {
        Self {
            period: [None; 2],
            cell_height: 1.0,
            density: 1.0,
            jitter: 1.0,
            spacing: 0.0,
            row_offset: 0.0,
            shape: StampShape::default(),
            size: [0.5, 1.0],
            aspect: [1.0; 2],
            rotation: [0.0, 360.0],
            height: [1.0; 2],
            bevel: 0.2,
            lift: 0.0,
            tilt: 0.0,
            overlap: StampOverlap::default(),
        }
    }
}

impl StampOptions {
    /// Checks that all options are in their ranges.
    fn check(&self) -> Result<(), PatternError> {
        check_period(self.period)?;
        for (range, what, value) in [
            (CELL_HEIGHT, "height of a cell", self.cell_height),
            (Self::DENSITY, "number of stamps per cell", self.density),
            (Self::FRACTION, "jitter", self.jitter),
            (Self::SPACING, "spacing", self.spacing),
            (Self::SIGNED, "offset of a row", self.row_offset),
            (Self::FRACTION, "bevel", self.bevel),
            (Self::FRACTION, "lift", self.lift),
            (Self::SIGNED, "tilt", self.tilt),
        ] {
            PatternError::check_in(range, what, value)?;
        }
        for (range, what, ends) in [
            (SIZE, "size of a stamp", self.size),
            (ASPECT, "aspect of a stamp", self.aspect),
            (ROTATION, "rotation of a stamp", self.rotation),
            (Self::FRACTION, "height of a stamp", self.height),
        ] {
            check_range(range, what, ends)?;
        }
        Ok(())
    }

    /// Checks that the spacing is at most the period, and that few enough points are within it.
    fn check_spacing(&self) -> Result<(), PatternError> {
        for (period, length) in self.period.into_iter().zip([1.0, self.cell_height]) {
            let length = period.map_or(f64::INFINITY, |cells| f64::from(cells) * length);
            let (what, range) = ("spacing", "at most the period");
            PatternError::check(self.spacing <= length, what, self.spacing, range)?;
        }
        let area = core::f64::consts::PI * self.spacing * self.spacing / self.cell_height;
        let near = area * self.density;
        let range = "at most 64 (by the density and the spacing)";
        PatternError::check(
            near <= 64.0,
            "number of points within the spacing",
            near,
            range,
        )
    }

    /// Returns the maximum distance from the center of a stamp to a position that it covers, in cells along each axis.
    fn reach(&self) -> [f64; 2] {
        // Corners of the bounding box, whose half width is the half length times the aspect.
        let aspect = self.aspect[1];
        let radius = 0.5 * self.size[1] * (1.0 + aspect * aspect).sqrt();
        [radius, radius / self.cell_height]
    }
}

/// Stamps at the points of a jittered lattice.
///
/// # Examples
///
/// ```
/// use dapple_hash::Seed;
/// use dapple_pattern::{StampOptions, StampShape, StampValue, Stamps};
/// use dapple_raster::{Field as _, FieldExt as _};
///
/// let options = StampOptions {
///     period: [Some(8), Some(8)],
///     shape: StampShape::Pebble,
///     size: [0.6, 1.2],
///     ..StampOptions::default()
/// };
/// let pebbles = Stamps::new(Seed(7), options)?;
/// let (height, random) = (pebbles.field(StampValue::Height), pebbles.field(StampValue::Random));
/// assert_eq!(height.sample([0.25, 3.5]), height.sample([8.25, -4.5]));
/// let tile = height.tile_raster([64, 64])?;
/// assert!(tile.pixels().iter().all(|height| (0.0..=1.0).contains(height)));
/// assert!((0.0..1.0).contains(&random.sample([0.25, 3.5])));
/// # Ok::<(), dapple_pattern::PatternError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Stamps {
    seed: Seed,
    options: StampOptions,
}

impl Stamps {
    /// Creates the stamps.
    ///
    /// # Errors
    ///
    /// [`Range`](crate::PatternErrorKind::Range) if an option is out of range, stamps reach farther than 8 cells along an
    /// axis, more than 1024 stamps are in the cells within reach, a period is shorter than the spacing, more than 64
    /// points are within the spacing, or the offsets of all rows of a period do not add up to a whole number of cells.
    pub fn new(seed: Seed, options: StampOptions) -> Result<Self, PatternError> {
        options.check()?;
        let reach = options.reach();
        for reach in reach {
            PatternError::check(
                reach <= MAX_REACH,
                "reach of a stamp in cells",
                reach,
                "at most 8 along each axis",
            )?;
        }
        let near = options.density * (2.0 * reach[0] + 1.0) * (2.0 * reach[1] + 1.0);
        PatternError::check(
            near <= MAX_NEAR,
            "number of stamps within reach of a position",
            near,
            "at most 1024 (by the density and the largest size)",
        )?;
        options.check_spacing()?;
        if let Some(rows) = options.period[1] {
            let shift = f64::from(rows) * options.row_offset;
            PatternError::check(
                // Offsets such as 0.333 are meant as whole parts of a cell.
                (shift - shift.round()).abs() <= 0.01,
                "total offset of the rows of a period",
                shift,
                "a whole number of cells (rows times offset)",
            )?;
        }
        Ok(Self {
            seed: seed.child("stamps", 0),
            options,
        })
    }

    /// Returns the field of a value of the stamps, over positions in cells.
    #[must_use]
    pub fn field(&self, value: StampValue) -> StampField {
        StampField {
            stamps: self.clone(),
            value,
            reach: self.options.reach(),
        }
    }

    /// Returns the points of a cell, with positions relative to the corner of the cell.
    fn points(&self, cell: [i64; 2]) -> impl Iterator<Item = Point> {
        let wrapped = wrapped_cell(cell, self.options.period);
        let shift = wrapped[1] as f64 * self.options.row_offset;
        let shift = shift - shift.floor();
        let hash = CellHash::new(self.seed, wrapped);
        let whole = self.options.density.floor();
        let has_one_more = f64::from(halves(hash.at(0))[0]) < self.options.density - whole;
        let count = whole as u32 + u32::from(has_one_more);
        (0..count).map(move |index| {
            let first = 1 + DRAWS * index;
            let [x, y] = halves(hash.at(first))
                .map(|part| 0.5 + (f64::from(part) - 0.5) * self.options.jitter);
            Point {
                position: [x + shift, y],
                hash,
                first,
            }
        })
    }

    /// Draws the random properties of the stamp at a point.
    fn stamp(&self, point: &Point) -> Stamp {
        let draw = |number: u32| halves(point.hash.at(point.first + number));
        let between = |[from, to]: [f64; 2], part: f32| from + (to - from) * f64::from(part);
        let [size, aspect] = draw(1);
        let [rotation, height] = draw(2);
        let [random, random2] = draw(3);
        let [random3, order] = draw(4);
        let [a, b] = draw(5);
        let [c, d] = draw(6);
        let half = 0.5 * between(self.options.size, size);
        let aspect = between(self.options.aspect, aspect);
        let degrees = between(self.options.rotation, rotation);
        let [cos, sin] = direction(degrees);
        let turns = degrees / 360.0;
        let (full, lift) = (
            between(self.options.height, height) as f32,
            self.options.lift as f32,
        );
        Stamp {
            center: point.position,
            u_axis: [cos / half, sin * self.options.cell_height / half],
            v_axis: [
                -sin / (half * aspect),
                cos * self.options.cell_height / (half * aspect),
            ],
            outline: Outline {
                aspect: aspect as f32,
                bevel: self.options.bevel as f32,
                random: [a, b, c, d],
            },
            height: full,
            highest: full * (lift * order + (1.0 - lift)),
            order,
            randoms: [random, random2, random3],
            angle: (turns - turns.floor()) as f32,
        }
    }

    /// Sorts stamps for the overlap rule. They must be in stamping order. If the rule makes the last stamp visible,
    /// the visible stamp becomes the first element.
    fn arrange<T>(&self, near: &mut [T], stamp: impl Fn(&T) -> &Stamp) {
        match self.options.overlap {
            StampOverlap::Highest | StampOverlap::Add => {}
            StampOverlap::Order => {
                near.reverse();
                near.sort_by(|a, b| stamp(b).order.total_cmp(&stamp(a).order));
            }
            StampOverlap::Rows => {
                near.reverse();
                let row = |of: &T| stamp(of).center[1].floor();
                near.sort_by(|a, b| row(a).total_cmp(&row(b)));
            }
        }
    }

    /// Returns the height of a stamp at a position with the coordinate `u` along it, where its profile has the value
    /// `profile`.
    fn height_of(&self, stamp: &Stamp, u: f32, profile: f32) -> f32 {
        let (lift, tilt) = (self.options.lift as f32, self.options.tilt as f32);
        let tilted = profile * (1.0 + tilt * u) / (1.0 + tilt.abs());
        stamp.height * (lift * stamp.order + (1.0 - lift) * tilted)
    }
}

/// Checks that both ends of a range of values are in `range`, and in ascending order.
fn check_range(range: Range, what: &'static str, ends: [f64; 2]) -> Result<(), PatternError> {
    for end in ends {
        PatternError::check_in(range, what, end)?;
    }
    let what = "upper end of a range";
    PatternError::check(ends[0] <= ends[1], what, ends[1], "at least the lower end")
}

/// Converts 64 random bits to two numbers from 0 to below 1.
fn halves(bits: u64) -> [f32; 2] {
    [(bits >> 32) as u32, bits as u32].map(unit_f32)
}

/// Number of hash counters that are reserved for a point: for its position, its stamp and its priority.
const DRAWS: u32 = 8;

/// A point of a cell.
#[derive(Clone, Copy, Debug)]
struct Point {
    position: [f64; 2],
    /// Hash of the cell.
    hash: CellHash,
    /// First hash counter of the point.
    first: u32,
}

/// A stamp at a point.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Stamp {
    /// Position of the center in cells.
    center: [f64; 2],
    /// Gradient, per cell, of the coordinate u along the stamp. u is −1 and 1 at the ends of the stamp.
    u_axis: [f64; 2],
    /// Gradient, per cell, of the coordinate v across the stamp. v is −1 and 1 at the sides of the stamp.
    v_axis: [f64; 2],
    outline: Outline,
    height: f32,
    /// Upper bound of the height, where the profile is 1.
    highest: f32,
    /// Rank in the random stamping order, from 0 to below 1.
    order: f32,
    randoms: [f32; 3],
    /// Rotation in turns.
    angle: f32,
}

impl Stamp {
    /// Returns the coordinates u and v of a position, along and across the stamp.
    #[inline(always)]
    fn local(&self, position: [f64; 2]) -> [f64; 2] {
        let [x, y] = [position[0] - self.center[0], position[1] - self.center[1]];
        [
            x * self.u_axis[0] + y * self.u_axis[1],
            x * self.v_axis[0] + y * self.v_axis[1],
        ]
    }

    /// Returns whether the bounding box of the stamp may meet a box around `center`.
    fn meets(&self, center: [f64; 2], half: [f64; 2]) -> bool {
        // Rounding must not leave out a stamp whose outline touches the box.
        const MARGIN: f64 = 1e-6;
        let local = self.local(center);
        let axes = [self.u_axis, self.v_axis];
        local.iter().zip(axes).all(|(local, [x, y])| {
            local.abs() <= 1.0 + MARGIN + x.abs() * half[0] + y.abs() * half[1]
        })
    }
}

/// A stamp that covers a position.
#[derive(Clone, Copy)]
struct Hit<'a> {
    stamp: &'a Stamp,
    /// Coordinates u and v of the position, along and across the stamp, from −1 to 1.
    local: [f32; 2],
    height: f32,
    /// Distance from the outline, from 0 to 1.
    edge: f32,
}

/// A value of [`Stamps`] as a field over positions in cells.
///
/// At a position that is not finite, the value is NaN.
#[derive(Clone, Debug, PartialEq)]
pub struct StampField {
    stamps: Stamps,
    value: StampValue,
    /// Maximum distance from the center of a stamp to a position that it covers, in cells along each axis.
    reach: [f64; 2],
}

impl StampField {
    /// Calls `found` for each stamp that may cover a position in a box of a cell, in stamping order. Its arguments are
    /// the stamp, the offset of the stamp's cell from `cell`, and the index of the stamp in its cell.
    fn visit(
        &self,
        cell: [i64; 2],
        center: [f64; 2],
        half: [f64; 2],
        mut found: impl FnMut(Stamp, [i64; 2], usize),
    ) {
        let stamps = &self.stamps;
        let has_offset = i64::from(stamps.options.row_offset != 0.0);
        let first = [0, 1].map(|axis| {
            let low = center[axis] - half[axis] - self.reach[axis];
            low.floor() as i64 - if axis == 0 { has_offset } else { 0 }
        });
        let mut spacing = Spacing::new(stamps);
        let last = [0, 1].map(|axis| (center[axis] + half[axis] + self.reach[axis]).floor() as i64);
        for y in first[1]..=last[1] {
            for x in first[0]..=last[0] {
                let other = [cell[0].wrapping_add(x), cell[1].wrapping_add(y)];
                for (index, mut point) in stamps.points(other).enumerate() {
                    point.position[0] += x as f64;
                    point.position[1] += y as f64;
                    // Most points are too far for any stamp.
                    let is_far = (0..2).any(|axis| {
                        let distance = (point.position[axis] - center[axis]).abs();
                        distance > half[axis] + 1.001 * self.reach[axis]
                    });
                    if is_far {
                        continue;
                    }
                    let stamp = stamps.stamp(&point);
                    if stamp.meets(center, half) && spacing.keeps(other, index) {
                        found(stamp, [x, y], index);
                    }
                }
            }
        }
    }
}

impl NearCells for StampField {
    type Item = Stamp;

    /// Appends the stamps in stamping order, or topmost first for overlap rules that depend on an order.
    fn near(&self, cell: [i64; 2], center: [f64; 2], half: [f64; 2], near: &mut Vec<Stamp>) {
        self.visit(cell, center, half, |stamp, _, _| near.push(stamp));
        self.stamps.arrange(near, |stamp| stamp);
    }

    fn meets(stamp: &Stamp, center: [f64; 2], half: [f64; 2]) -> bool {
        stamp.meets(center, half)
    }

    fn value_of(&self, near: &[Stamp], position: [f64; 2]) -> f32 {
        let mut top: Option<Hit<'_>> = None;
        let mut sum = 0.0;
        let overlap = self.stamps.options.overlap;
        for stamp in near {
            // A stamp that is nowhere as high as the top so far does not matter.
            if overlap == StampOverlap::Highest && top.is_some_and(|top| stamp.highest < top.height)
            {
                continue;
            }
            let local = stamp.local(position);
            if local[0].abs() > 1.0 || local[1].abs() > 1.0 {
                continue;
            }
            let [u, v] = local.map(|local| local as f32);
            let Some((edge, profile)) = self.stamps.options.shape.at(&stamp.outline, u, v) else {
                continue;
            };
            let height = self.stamps.height_of(stamp, u, profile);
            sum += height;
            let hit = Hit {
                stamp,
                local: [u, v],
                height,
                edge,
            };
            match overlap {
                StampOverlap::Highest | StampOverlap::Add => {
                    if top.is_none_or(|top| height >= top.height) {
                        top = Some(hit);
                    }
                }
                StampOverlap::Order | StampOverlap::Rows => {
                    top = Some(hit);
                    break;
                }
            }
        }
        let Some(hit) = top else {
            return 0.0;
        };
        let [random, random2, random3] = hit.stamp.randoms;
        match self.value {
            StampValue::Height if self.stamps.options.overlap == StampOverlap::Add => sum,
            StampValue::Height => hit.height,
            StampValue::Mask => 1.0,
            StampValue::Random => random,
            StampValue::Random2 => random2,
            StampValue::Random3 => random3,
            StampValue::U => 0.5 + 0.5 * hit.local[0],
            StampValue::V => 0.5 + 0.5 * hit.local[1],
            StampValue::EdgeDistance => hit.edge,
            StampValue::Angle => hit.stamp.angle,
        }
    }
}

impl Field for StampField {
    fn value(&self, position: [f64; 2]) -> f32 {
        near::value(self, position)
    }

    fn values(&self, positions: &[[f64; 2]], values: &mut [f32]) -> Result<(), RasterError> {
        near::values(self, positions, values)
    }

    fn render(&self, window: &Window, out: RasterViewMut<'_, f32>) -> Result<(), RasterError> {
        near::render(self, window, out)
    }

    fn period(&self) -> [Option<f64>; 2] {
        self.stamps
            .options
            .period
            .map(|period| period.map(f64::from))
    }
}
