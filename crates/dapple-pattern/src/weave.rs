//! Woven cloth: two sets of threads that pass over and under each other by a draft.
//!
//! Warp threads run along y, weft threads along x. A draft says at every crossing which of the two is on top. Between
//! crossings a thread rises and sinks smoothly, and its cross-section is an ellipse, which is flattened for ribbons.
//! The visible thread is the higher one.
//!
//! Twill and satin are drafts of one kind: a warp thread lies over `over` crossings and under `under`, and each weft
//! thread is shifted by `step` against the one before (Branko Grünbaum and Geoffrey Shephard, "Satins and Twills: An
//! Introduction to the Geometry of Fabrics", Mathematics Magazine 53, 1980, <https://doi.org/10.2307/2690105>).
//!
//! Positions are in units of the plane, y points down.

use crate::PatternError;
use crate::lattice::{self, Split, random, smoothstep, wrapped};
use crate::lattice::{period_words, seed_words, shader_words};
use dapple_hash::{CellHash, Seed, unit_f64};
use dapple_raster::{Field, Range, RasterError, RasterViewMut, Window, range};

dapple_raster::named! {
    /// Draft of a weave.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub enum Draft {
        /// Threads lie over and under each other in turn. Even numbers of threads.
        #[default]
        Plain = "plain" | "canvas" | "linen",
        /// Diagonal ribs, as in denim: over 2, under 2, step 1 by default.
        Twill = "twill" | "denim",
        /// Long floats with scattered crossings: over 4, under 1, step 2 by default.
        Satin = "satin" | "sateen",
        /// Groups of threads that cross as one; `over` threads in a group, 2 by default.
        Basket = "basket",
    }
}

dapple_raster::named! {
    /// Value of a weave at a position.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub enum WeaveValue {
        /// Height from 0 in the holes to 1 on the crests of threads.
        #[default]
        Height = "height",
        /// Random number of the visible thread, from 0 to below 1.
        Random = "random" | "cell_value",
        /// Second random number of the visible thread, independent of the first.
        Random2 = "random2",
        /// Direction of the visible thread: 0 for warp, along y, and 1 for weft, along x.
        Direction = "direction",
        /// Position along the visible thread, from 0 to below 1 for every crossing.
        U = "u",
        /// Position across the visible thread, from 0 to 1; clamped in the holes.
        V = "v",
    }
}

/// Options of a [`Weave`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WeaveOptions {
    /// Numbers of warp threads along x and of weft threads along y per unit of the plane, above 0 and at most 1e6; by
    /// default 16.
    pub frequency: [f64; 2],
    /// Period along each axis, in threads; `None` for an axis without a period. A period holds whole repeats of the
    /// draft.
    pub period: [Option<u32>; 2],
    /// Draft.
    pub draft: Draft,
    /// Crossings that a warp thread passes over in a row, from 1 to 32; the default depends on the draft.
    pub over: Option<u32>,
    /// Crossings that a warp thread passes under in a row, from 1 to 32; the default depends on the draft. Used by `twill`
    /// and `satin`.
    pub under: Option<u32>,
    /// Shift of the draft between neighboring weft threads, in threads, from 1 to 32; the default depends on the draft.
    /// Used by `twill` and `satin`, where it has no common factor with `over + under`.
    pub step: Option<u32>,
    /// Width of a thread relative to the distance of threads, above 0 and at most 1; by default 0.9.
    pub width: f64,
    /// Cross-section of threads, from 0 (flat ribbon) to 1 (ellipse); by default 1.
    pub roundness: f64,
    /// Variation of the widths and positions of threads, from 0 to 1; by default 0. At 1, widths vary from half of
    /// `width` to all of it.
    pub jitter: f64,
}

impl WeaveOptions {
    /// Valid range of each component of [`frequency`](Self::frequency).
    pub const FREQUENCY: Range = range!(above 0 to 1e6);
    /// Valid range of [`over`](Self::over), [`under`](Self::under) and [`step`](Self::step).
    pub const CROSSINGS: Range = range!(from 1 to 32);
    /// Valid range of [`width`](Self::width).
    pub const WIDTH: Range = range!(above 0 to 1);
    /// Valid range of [`roundness`](Self::roundness).
    pub const ROUNDNESS: Range = range!(from 0 to 1);
    /// Valid range of [`jitter`](Self::jitter).
    pub const JITTER: Range = range!(from 0 to 1);
}

impl Default for WeaveOptions {
    fn default() -> Self {
        Self {
            frequency: [16.0; 2],
            period: [None; 2],
            draft: Draft::default(),
            over: None,
            under: None,
            step: None,
            width: 0.9,
            roundness: 1.0,
            jitter: 0.0,
        }
    }
}

/// Woven cloth.
///
/// # Examples
///
/// ```
/// use dapple_pattern::{Draft, Weave, WeaveOptions, WeaveValue, hash::Seed, raster::Field};
///
/// let options = WeaveOptions {
///     period: [Some(16), Some(16)],
///     draft: Draft::Twill,
///     ..WeaveOptions::default()
/// };
/// let denim = Weave::new(Seed(7), options)?;
/// let height = denim.field(WeaveValue::Height).tile_raster([256, 256])?;
/// assert!(height.pixels().iter().all(|height| (0.0..=1.0).contains(height)));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Weave {
    seed: Seed,
    options: WeaveOptions,
    repeat: Repeat,
}

/// One [`WeaveValue`] of a [`Weave`] as a field.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WeaveField {
    weave: Weave,
    value: WeaveValue,
}

/// A draft with its parameters.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Repeat {
    /// Groups of threads in a checkerboard.
    Checks { size: i64 },
    /// Each weft thread has `over` crossings with the warp on top, then the others below, repeated after `threads`.
    /// Each row is shifted by `step` relative to the previous one.
    Shifted { over: i64, threads: i64, step: i64 },
}

/// A thread and a position on it.
#[derive(Clone, Copy, Debug)]
struct Thread {
    /// 0 for warp, 1 for weft.
    axis: usize,
    /// Index of the thread, wrapped by the period.
    index: i64,
    /// Position across the thread, from -1 to 1 on it.
    across: f64,
    /// Position along the thread, from 0 to below 1 for every crossing.
    along: f64,
    /// Height of the surface; 0 outside of the thread.
    height: f64,
}

impl Weave {
    /// Creates the cloth.
    ///
    /// # Errors
    ///
    /// [`Range`](crate::PatternErrorKind::Range) if an option is out of range, or if a period does not hold whole
    /// repeats of the draft.
    pub fn new(seed: impl Into<Seed>, options: WeaveOptions) -> Result<Self, PatternError> {
        use WeaveOptions as Of;
        for frequency in options.frequency {
            PatternError::check_in(Of::FREQUENCY, "frequency", frequency)?;
        }
        PatternError::check_in(Of::WIDTH, "width of threads", options.width)?;
        PatternError::check_in(Of::ROUNDNESS, "roundness of threads", options.roundness)?;
        PatternError::check_in(Of::JITTER, "jitter of threads", options.jitter)?;
        let repeat = Repeat::new(&options)?;
        for period in options.period.into_iter().flatten() {
            PatternError::check(
                period > 0 && repeat.holds_after(period.into()),
                "number of threads in the period",
                period.into(),
                "a multiple of the threads in a repeat of the draft",
            )?;
        }
        Ok(Self {
            seed: seed.into(),
            options,
            repeat,
        })
    }

    /// Returns the options.
    #[must_use]
    pub fn options(&self) -> &WeaveOptions {
        &self.options
    }

    /// Returns one value as a field. Positions are in units of the plane.
    #[must_use]
    pub fn field(&self, value: WeaveValue) -> WeaveField {
        WeaveField {
            weave: *self,
            value,
        }
    }

    /// Returns the weave as a structure for shaders: the words of `Weave` in the WGSL of `dapple-wgsl`, as pairs of
    /// high and low words.
    #[must_use]
    pub fn shader_words(&self) -> [[u32; 2]; 7] {
        // The numbers of a draft are at most 64.
        let (draft, step) = match self.repeat {
            Repeat::Checks { size } => ([0, size], 0),
            Repeat::Shifted {
                over,
                threads,
                step,
            } => ([threads, over], step),
        };
        let WeaveOptions {
            width,
            roundness,
            jitter,
            ..
        } = self.options;
        [
            seed_words(self.seed.0),
            period_words(self.options.period),
            draft.map(|number| number as u32),
            [step as u32, 0],
            shader_words(width),
            shader_words(roundness),
            shader_words(jitter),
        ]
    }

    fn sample(&self, value: WeaveValue, position: [f64; 2]) -> f32 {
        let place = [0, 1].map(|axis| Split::of(position[axis] * self.options.frequency[axis]));
        if place.iter().any(|split| split.offset.is_nan()) {
            return f32::NAN;
        }
        let [warp, weft] = [0, 1].map(|axis| self.thread(axis, place));
        let is_warp = if warp.height == weft.height {
            // In a hole, the nearer thread.
            warp.across.abs() <= weft.across.abs()
        } else {
            warp.height > weft.height
        };
        let visible = if is_warp { warp } else { weft };
        match value {
            WeaveValue::Height => visible.height as f32,
            WeaveValue::Random => random(self.hash(&visible), 0),
            WeaveValue::Random2 => random(self.hash(&visible), 1),
            WeaveValue::Direction => visible.axis as f32,
            WeaveValue::U => visible.along as f32,
            WeaveValue::V => (0.5 + 0.5 * visible.across).clamp(0.0, 1.0) as f32,
        }
    }

    fn hash(&self, thread: &Thread) -> CellHash {
        CellHash::new(self.seed, [thread.axis as i64, thread.index])
    }

    /// Returns the warp thread (axis 0) or weft thread (axis 1) at a position.
    fn thread(&self, axis: usize, place: [Split; 2]) -> Thread {
        let (own, along) = (place[axis], place[1 - axis]);
        let mut thread = Thread {
            axis,
            index: wrapped(own.cell, self.options.period[axis]),
            across: 0.0,
            along: along.offset,
            height: 0.0,
        };
        // Narrow the thread and displace it within its part of the plane.
        let (mut width, mut center) = (self.options.width, 0.5);
        if self.options.jitter > 0.0 {
            let hash = self.hash(&thread);
            width *= 1.0 - 0.5 * self.options.jitter * unit_f64(hash.at(2));
            center += self.options.jitter * (1.0 - width) * (unit_f64(hash.at(3)) - 0.5);
        }
        thread.across = (own.offset - center) / (0.5 * width);
        if thread.across.abs() < 1.0 {
            // Interpolate between the crossings before and after the position.
            let before = along.shifted(-0.5);
            let [start, end] = [0, 1].map(|step| self.level(axis, own.cell, before.cell + step));
            let level = start + (end - start) * smoothstep(before.offset);
            let circle = (1.0 - thread.across * thread.across).sqrt();
            let profile = 1.0 - self.options.roundness * (1.0 - circle);
            thread.height = 0.5 * level + 0.5 * profile;
        }
        thread
    }

    /// Returns 1 if a thread of the set `axis` (0 for warp, 1 for weft) is on top at a crossing, and 0 if it is below.
    fn level(&self, axis: usize, thread: i64, crossing: i64) -> f64 {
        let mut at = [thread, crossing];
        if axis == 1 {
            at.reverse();
        }
        let is_warp_above = self.repeat.is_warp_above(at);
        f64::from(u8::from(is_warp_above == (axis == 0)))
    }
}

impl Repeat {
    fn new(options: &WeaveOptions) -> Result<Self, PatternError> {
        let number = |number: Option<u32>, default: u32, what: &'static str| {
            let number = number.unwrap_or(default);
            PatternError::check_in(WeaveOptions::CROSSINGS, what, number.into())?;
            Ok::<_, PatternError>(i64::from(number))
        };
        let defaults = match options.draft {
            Draft::Plain => return Ok(Self::Checks { size: 1 }),
            Draft::Basket => {
                let size = number(options.over, 2, "number of threads in a group")?;
                return Ok(Self::Checks { size });
            }
            Draft::Twill => [2, 2, 1],
            Draft::Satin => [4, 1, 2],
        };
        let over = number(options.over, defaults[0], "number of crossings over")?;
        let under = number(options.under, defaults[1], "number of crossings under")?;
        let step = number(options.step, defaults[2], "step of the draft")?;
        let threads = over + under;
        PatternError::check(
            common_factor(step, threads) == 1,
            "step of the draft",
            step as f64,
            "without a common factor with the sum of `over` and `under`",
        )?;
        Ok(Self::Shifted {
            over,
            threads,
            step,
        })
    }

    /// Returns whether the draft repeats after `period` threads along either axis.
    fn holds_after(self, period: i64) -> bool {
        match self {
            Self::Checks { size } => period % (2 * size) == 0,
            // The step has no common factor with the number of threads.
            Self::Shifted { threads, .. } => period % threads == 0,
        }
    }

    /// Returns whether the warp thread is on top at a crossing.
    fn is_warp_above(self, [warp, weft]: [i64; 2]) -> bool {
        match self {
            Self::Checks { size } => (warp.div_euclid(size) + weft.div_euclid(size)) % 2 == 0,
            Self::Shifted {
                over,
                threads,
                step,
            } => {
                let shift = step * weft.rem_euclid(threads);
                (warp.rem_euclid(threads) - shift).rem_euclid(threads) < over
            }
        }
    }
}

/// Windows are rendered on all cores if the feature `rayon` is enabled.
impl Field for WeaveField {
    fn value(&self, position: [f64; 2]) -> f32 {
        self.weave.sample(self.value, position)
    }

    fn render(&self, window: &Window, out: RasterViewMut<'_, f32>) -> Result<(), RasterError> {
        lattice::render(window, out, |position| self.value(position))
    }

    fn period(&self) -> [Option<f64>; 2] {
        let WeaveOptions {
            period, frequency, ..
        } = self.weave.options;
        [0, 1].map(|axis| period[axis].map(|threads| f64::from(threads) / frequency[axis]))
    }
}

/// Returns the greatest common divisor of two positive numbers.
fn common_factor(mut a: i64, mut b: i64) -> i64 {
    while b != 0 {
        (a, b) = (b, a % b);
    }
    a
}

#[cfg(test)]
mod tests;
