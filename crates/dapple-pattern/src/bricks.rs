//! Bricks, tiles and planks in regular bonds, with joints, bevels and random numbers for each brick.
//!
//! A bond divides the plane into cells, one for each brick. The face of a brick is its cell minus half of the joint on
//! every side, and minus a random inset if the edges vary. Evaluation is local: a position determines its brick, and
//! the distance to the nearest border needs only the bricks around the position.
//!
//! Positions are in units of the plane, y points down. Distances are Euclidean in the plane, so that joints are equally
//! wide along both axes even if bricks are not square. Rounded corners follow the distance function of a rounded box.
//!
//! Reference: Inigo Quilez, "2D distance functions", <https://iquilezles.org/articles/distfunctions2d/>. The bonds and
//! the search for the nearest brick are our own.

mod bond;
mod hexagons;
mod rectangles;
mod roof;

pub use bond::{Bond, BrickValue};

use crate::PatternError;
use crate::lattice::{self, Split, random, smoothstep, wrapped_cell};
use crate::lattice::{period_words, seed_words, shader_words};
use dapple_hash::{CellHash, Seed, unit_f64};
use dapple_raster::{Field, Range, RasterError, RasterViewMut, Window, range};

/// Options of [`Bricks`]. Lengths are in units of the shorter side of a brick, so that they do not depend on the
/// frequency; for bonds of squares, it is the side of a square.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BrickOptions {
    /// Number of bricks per unit of the plane along x, and of courses along y, above 0 and at most 1e6; by default 4
    /// and 12.
    ///
    /// A brick of `herringbone` and `basket` consists of [`length`](Self::length) squares, and the frequency counts
    /// squares. A stretcher and a header of `flemish` count as two bricks. Hexagons are regular if there are
    /// `2 / √3 = 1.155` times as many courses as columns.
    pub frequency: [f64; 2],
    /// Period along each axis in bricks and courses, or in squares; `None` for an axis without a period. See
    /// [`Bond`] for the periods that suit each bond.
    pub period: [Option<u32>; 2],
    /// Arrangement of the bricks.
    pub bond: Bond,
    /// Shift of every other course, in bricks, from 0 to 1; by default ½. Used by `running`, `roof_tiles` and `slates`.
    pub offset: f64,
    /// Length of a brick in squares, from 1 to 16; by default 2. Used by `herringbone` and `basket`.
    pub length: u32,
    /// Variation of the lengths of planks from 0 (equal) to 1 (from half to one and a half of the mean); by default ½.
    /// Used by `planks`.
    pub variation: f64,
    /// Width of the joints, from 0 to 0.9; by default 0.1.
    pub joint: f64,
    /// Width of the rise from the joint to the face of a brick, from 0 to 1; by default 0.1.
    pub bevel: f64,
    /// Radius of the corners, from 0 to ½; by default 0.05. A ½ makes half-disks.
    pub rounding: f64,
    /// Random displacement of each edge of each brick into its cell, from 0 to 1; by default 0. At 1, an edge moves by
    /// up to a quarter of the face.
    pub jitter: f64,
}

impl BrickOptions {
    /// Valid range of each component of [`frequency`](Self::frequency).
    pub const FREQUENCY: Range = range!(above 0 to 1e6);
    /// Valid range of [`offset`](Self::offset).
    pub const OFFSET: Range = range!(from 0 to 1);
    /// Valid range of [`length`](Self::length).
    pub const LENGTH: Range = range!(from 1 to 16);
    /// Valid range of [`variation`](Self::variation).
    pub const VARIATION: Range = range!(from 0 to 1);
    /// Valid range of [`joint`](Self::joint).
    pub const JOINT: Range = range!(from 0 to 0.9);
    /// Valid range of [`bevel`](Self::bevel).
    pub const BEVEL: Range = range!(from 0 to 1);
    /// Valid range of [`rounding`](Self::rounding).
    pub const ROUNDING: Range = range!(from 0 to 0.5);
    /// Valid range of [`jitter`](Self::jitter).
    pub const JITTER: Range = range!(from 0 to 1);
}

impl Default for BrickOptions {
    fn default() -> Self {
        Self {
            frequency: [4.0, 12.0],
            period: [None; 2],
            bond: Bond::default(),
            offset: 0.5,
            length: 2,
            variation: 0.5,
            joint: 0.1,
            bevel: 0.1,
            rounding: 0.05,
            jitter: 0.0,
        }
    }
}

/// A wall, floor or roof of bricks.
///
/// # Examples
///
/// ```
/// use dapple_pattern::{Bond, BrickOptions, BrickValue, Bricks, hash::Seed, raster::Field};
///
/// let options = BrickOptions {
///     period: [Some(4), Some(12)],
///     bond: Bond::Flemish,
///     ..BrickOptions::default()
/// };
/// let wall = Bricks::new(Seed(7), options)?;
/// let height = wall.field(BrickValue::Height).tile_raster([256, 256])?;
/// let shades = wall.field(BrickValue::Random).tile_raster([256, 256])?;
/// assert_eq!(height.size(), shades.size());
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bricks {
    seed: Seed,
    options: BrickOptions,
    /// Width of a brick and height of a course, in units of the plane.
    cell: [f64; 2],
    /// Length of the shorter side of a brick in units of the plane, in which the options give lengths.
    unit: f64,
}

/// One [`BrickValue`] of [`Bricks`] as a field.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BrickField {
    bricks: Bricks,
    value: BrickValue,
}

/// A brick and a position in its cell.
#[derive(Clone, Copy, Debug)]
struct Brick {
    /// Column and course, wrapped by the period.
    id: [i64; 2],
    /// Whether the long axis is vertical.
    upright: bool,
    /// Position along and across the face, from 0 to 1.
    uv: [f64; 2],
    /// Height of the surface at the position; negative values are clamped.
    height: f64,
}

/// First counter of a brick's hash for the insets of its sides. The counters below it are for three random numbers.
const SIDES: u32 = 4;

impl Bricks {
    /// Creates the bricks.
    ///
    /// # Errors
    ///
    /// [`Range`](crate::PatternErrorKind::Range) if an option is out of range, or if a period does not suit the bond.
    pub fn new(seed: impl Into<Seed>, options: BrickOptions) -> Result<Self, PatternError> {
        use BrickOptions as Of;
        for frequency in options.frequency {
            PatternError::check_in(Of::FREQUENCY, "frequency", frequency)?;
        }
        for (range, what, value) in [
            (Of::OFFSET, "offset of courses", options.offset),
            (Of::LENGTH, "length of bricks", options.length.into()),
            (Of::VARIATION, "variation of lengths", options.variation),
            (Of::JOINT, "width of joints", options.joint),
            (Of::BEVEL, "width of the bevel", options.bevel),
            (Of::ROUNDING, "radius of corners", options.rounding),
            (Of::JITTER, "jitter of edges", options.jitter),
        ] {
            PatternError::check_in(range, what, value)?;
        }
        options.bond.check_period(&options)?;
        let cell = options.frequency.map(|frequency| 1.0 / frequency);
        Ok(Self {
            seed: seed.into(),
            options,
            cell,
            unit: options.bond.shorter_side(cell),
        })
    }

    /// Returns the options.
    #[must_use]
    pub fn options(&self) -> &BrickOptions {
        &self.options
    }

    /// Returns one value as a field. Positions are in units of the plane.
    #[must_use]
    pub fn field(&self, value: BrickValue) -> BrickField {
        BrickField {
            bricks: *self,
            value,
        }
    }

    /// Returns the bricks as a structure for shaders: the words of `Bricks` in the WGSL of `dapple-wgsl`, as pairs of
    /// high and low words.
    #[must_use]
    pub fn shader_words(&self) -> [[u32; 2]; 16] {
        let options = self.options;
        let [course, end] = ["course", "end"].map(|part| seed_words(self.seed.child(part, 0).0));
        let [x, y] = options.frequency.map(shader_words);
        let [width, height] = self.cell.map(shader_words);
        [
            seed_words(self.seed.0),
            period_words(options.period),
            [options.bond as u32, options.length],
            x,
            y,
            width,
            height,
            shader_words(self.unit),
            shader_words(0.5 * options.joint),
            shader_words(0.25 * (1.0 - options.joint) * options.jitter),
            shader_words(options.bevel * self.unit),
            shader_words(options.rounding * self.unit),
            shader_words(options.offset),
            shader_words(0.5 * options.variation),
            course,
            end,
        ]
    }

    fn sample(&self, value: BrickValue, position: [f64; 2]) -> f32 {
        let [x, y] = [0, 1].map(|axis| Split::of(position[axis] * self.options.frequency[axis]));
        if x.offset.is_nan() || y.offset.is_nan() {
            return f32::NAN;
        }
        let bond = self.options.bond;
        if value == BrickValue::EdgeDistance {
            return match bond {
                Bond::Hexagons => self.hexagon_edge_distance([x, y]) as f32,
                Bond::RoofTiles | Bond::Slates => self.roof_edge_distance([x, y]) as f32,
                _ => self.rectangle_edge_distance([x, y]) as f32,
            };
        }
        let brick = match bond {
            Bond::Hexagons => self.hexagon([x, y]),
            Bond::RoofTiles | Bond::Slates => self.roof_tile([x, y]),
            _ => self.rectangle([x, y]),
        };
        match value {
            BrickValue::Height | BrickValue::EdgeDistance => brick.height.clamp(0.0, 1.0) as f32,
            BrickValue::Random => self.random(brick.id, 0),
            BrickValue::Random2 => self.random(brick.id, 1),
            BrickValue::Random3 => self.random(brick.id, 2),
            BrickValue::U => brick.uv[0] as f32,
            BrickValue::V => brick.uv[1] as f32,
            BrickValue::Column => brick.id[0] as f32,
            BrickValue::Row => brick.id[1] as f32,
            BrickValue::Direction => f32::from(u8::from(brick.upright)),
        }
    }

    /// Returns a random number of a brick, from 0 to below 1.
    fn random(&self, id: [i64; 2], index: u32) -> f32 {
        random(CellHash::new(self.seed, id), index)
    }

    /// Returns the distance from the side of a cell to the face of its brick: half of a joint plus the random
    /// displacement, in units of the plane.
    fn inset(&self, id: [i64; 2], side: u32) -> f64 {
        let BrickOptions { joint, jitter, .. } = self.options;
        let random = match jitter {
            0.0 => 0.0,
            _ => unit_f64(CellHash::new(self.seed, id).at(SIDES + side)),
        };
        self.unit * (0.5 * joint + 0.25 * (1.0 - joint) * jitter * random)
    }

    /// Returns the profile of a bevel at the given distance from the border of a face: 0 at the border, rising to 1 at
    /// the end of the bevel.
    fn rise(&self, depth: f64) -> f64 {
        if depth <= 0.0 {
            return 0.0;
        }
        let bevel = self.options.bevel * self.unit;
        if depth >= bevel {
            return 1.0;
        }
        smoothstep(depth / bevel)
    }

    fn wrapped(&self, id: [i64; 2]) -> [i64; 2] {
        wrapped_cell(id, self.options.period)
    }

    /// Returns the shift of a course along x, in bricks.
    fn shift(&self, course: i64) -> f64 {
        match course.rem_euclid(2) {
            0 => 0.0,
            _ => self.options.offset,
        }
    }
}

/// Windows are rendered on all cores if the feature `rayon` is enabled.
impl Field for BrickField {
    fn value(&self, position: [f64; 2]) -> f32 {
        self.bricks.sample(self.value, position)
    }

    fn render(&self, window: &Window, out: RasterViewMut<'_, f32>) -> Result<(), RasterError> {
        lattice::render(window, out, |position| self.value(position))
    }

    fn period(&self) -> [Option<f64>; 2] {
        let BrickOptions {
            period, frequency, ..
        } = self.bricks.options;
        [0, 1].map(|axis| period[axis].map(|bricks| f64::from(bricks) / frequency[axis]))
    }
}

#[cfg(test)]
mod tests;
