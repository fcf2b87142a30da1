//! Signed distance fields of simple shapes, repeated on a lattice.
//!
//! The distances are exact and Euclidean. Polygons and stars are stored as lists of corners instead of folding angles,
//! so that all values are computed from sums, products and roots.
//!
//! Reference: Inigo Quilez, "2D distance functions", <https://iquilezles.org/articles/distfunctions2d/>.
//!
//! With a lattice of copies, the distance is to the nearest copy, which is not always the copy with the nearest
//! center. All copies are evaluated whose bounding circle is nearer than the smallest distance so far.
//!
//! Positions are in units of the plane, y points down.

use crate::PatternError;
use crate::lattice::{self, Split, direction, length, smoothstep};
use dapple_raster::{Field, Range, RasterError, RasterViewMut, Window, range};

dapple_raster::named! {
    /// Kind of a shape. The `size` is half of its width.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub enum ShapeKind {
        /// Disk.
        #[default]
        Circle = "circle" | "disk",
        /// Rectangle whose height is `ratio` times the width.
        Box = "box" | "rectangle" | "square",
        /// Regular polygon with `sides` sides and a corner on top; `size` is the distance of its corners.
        Polygon = "polygon",
        /// Star with `sides` points and one on top. The inner corners have `ratio` times the distance of the points.
        Star = "star",
        /// Rectangle with half-round ends, whose height is `ratio` times the width.
        Capsule = "capsule" | "pill",
        /// Ring whose inner radius is `ratio` times the outer one.
        Ring = "ring" | "annulus",
        /// Disk without an equal disk, displaced by `ratio` times the diameter to the right.
        Moon = "moon" | "crescent",
        /// Heart with its tip below.
        Heart = "heart",
    }
}

dapple_raster::named! {
    /// Value of a shape at a position.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub enum ShapeValue {
        /// Signed distance to the border of the nearest copy in units of the plane, negative inside.
        #[default]
        Distance = "distance",
        /// Mask: 1 inside and 0 outside, with a smooth transition of the width `edge`.
        Mask = "mask",
    }
}

/// Options of a [`Shape`]. Lengths other than `size` are relative to the size.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ShapeOptions {
    /// Kind of the shape.
    pub kind: ShapeKind,
    /// Position of the center, in units of the plane.
    pub center: [f64; 2],
    /// Half of the width, in units of the plane, above 0; by default ¼. At most 16 times the distance of copies.
    pub size: f64,
    /// Clockwise rotation in degrees.
    pub rotation: f64,
    /// Number of sides of a polygon or points of a star, from 3 to 64; by default 5.
    pub sides: u32,
    /// Proportion of the shape, above 0 to 1; by default ½. See [`ShapeKind`].
    pub ratio: f64,
    /// Radius of rounded corners relative to the size, from 0 below 1; by default 0. The shape is shrunk by the radius
    /// and then dilated by it, which preserves its width. Circles, capsules and rings have no corners.
    pub rounding: f64,
    /// Width of a shell around the border, relative to the size, from 0 to 1; by default 0, the whole shape.
    pub onion: f64,
    /// Width of the transition of a mask relative to the size, from 0 to 2; by default 0.05.
    pub edge: f64,
    /// Number of copies per unit of the plane along each axis, above 0 and at most 1e6; `None` for an axis along which
    /// the shape is not repeated.
    pub frequency: [Option<f64>; 2],
}

impl ShapeOptions {
    /// Valid range of [`center`](Self::center) and [`rotation`](Self::rotation).
    pub const FINITE: Range = range!(finite);
    /// Valid range of [`size`](Self::size).
    pub const SIZE: Range = range!(above 0 to 1e6);
    /// Valid range of [`sides`](Self::sides).
    pub const SIDES: Range = range!(from 3 to 64);
    /// Valid range of [`ratio`](Self::ratio).
    pub const RATIO: Range = range!(above 0 to 1);
    /// Valid range of [`rounding`](Self::rounding).
    pub const ROUNDING: Range = range!(from 0 below 1);
    /// Valid range of [`onion`](Self::onion).
    pub const ONION: Range = range!(from 0 to 1);
    /// Valid range of [`edge`](Self::edge).
    pub const EDGE: Range = range!(from 0 to 2);
    /// Valid range of each component of [`frequency`](Self::frequency).
    pub const FREQUENCY: Range = range!(above 0 to 1e6);
}

impl Default for ShapeOptions {
    fn default() -> Self {
        Self {
            kind: ShapeKind::default(),
            center: [0.5; 2],
            size: 0.25,
            rotation: 0.0,
            sides: 5,
            ratio: 0.5,
            rounding: 0.0,
            onion: 0.0,
            edge: 0.05,
            frequency: [None; 2],
        }
    }
}

/// A shape, or a lattice of its copies.
///
/// # Examples
///
/// ```
/// use dapple_pattern::{Shape, ShapeKind, ShapeOptions, ShapeValue, raster::FieldExt};
///
/// let options = ShapeOptions { kind: ShapeKind::Ring, ..ShapeOptions::default() };
/// let ring = Shape::new(options)?;
/// // A ring with the radii 0.125 and 0.25 about (½, ½).
/// assert_eq!(ring.field(ShapeValue::Distance).sample([0.5, 0.0]), 0.25);
/// assert_eq!(ring.field(ShapeValue::Distance).sample([0.5, 0.5]), 0.125);
/// # Ok::<(), dapple_pattern::PatternError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Shape {
    options: ShapeOptions,
    outline: Outline,
    /// Cosine and sine of the angle of rotation.
    direction: [f64; 2],
    /// Radius of rounded corners, in units of the plane.
    rounding: f64,
    /// Radius of a circle about the center that contains the shape, in units of the plane.
    bound: f64,
}

/// One [`ShapeValue`] of a [`Shape`] as a field.
#[derive(Clone, Debug, PartialEq)]
pub struct ShapeField {
    shape: Shape,
    value: ShapeValue,
}

/// The outline of a shape about the origin, in units of the plane, before rounding.
#[derive(Clone, Debug, PartialEq)]
enum Outline {
    Circle {
        radius: f64,
    },
    Box {
        half: [f64; 2],
    },
    /// Corners in order.
    Corners(Vec<[f64; 2]>),
    Capsule {
        half: f64,
        radius: f64,
    },
    Ring {
        radius: f64,
        half_width: f64,
    },
    Moon {
        radius: f64,
        displacement: f64,
    },
    Heart {
        scale: f64,
    },
}

/// Maximum ratio of the size to the distance between copies, which bounds the number of copies that can be nearest.
const MAX_SIZE: f64 = 16.0;

/// Half-width of the heart in [`heart_distance`], `(1 + √2) / 4`, and the height of its middle above its tip.
const HEART: [f64; 2] = [0.603_553_390_593_273_8, 0.551_776_695_296_636_9];

impl Shape {
    /// Creates the shape.
    ///
    /// # Errors
    ///
    /// [`Range`](crate::PatternErrorKind::Range) if an option is out of range.
    pub fn new(options: ShapeOptions) -> Result<Self, PatternError> {
        use ShapeOptions as Of;
        for (range, what, value) in [
            (Of::FINITE, "center", options.center[0]),
            (Of::FINITE, "center", options.center[1]),
            (Of::FINITE, "rotation", options.rotation),
            (Of::SIZE, "size of the shape", options.size),
            (Of::SIDES, "number of sides", options.sides.into()),
            (Of::RATIO, "ratio of the shape", options.ratio),
            (Of::ROUNDING, "radius of corners", options.rounding),
            (Of::ONION, "width of the shell", options.onion),
            (Of::EDGE, "width of the edge", options.edge),
        ] {
            PatternError::check_in(range, what, value)?;
        }
        for frequency in options.frequency.into_iter().flatten() {
            PatternError::check_in(Of::FREQUENCY, "frequency", frequency)?;
            PatternError::check(
                options.size * frequency <= MAX_SIZE,
                "size of the shape",
                options.size * frequency,
                "at most 16 times the distance of copies",
            )?;
        }
        let shell = 0.5 * options.onion * options.size;
        Ok(Self {
            options,
            outline: Outline::new(&options),
            direction: direction(options.rotation),
            rounding: rounding(&options),
            // The corners of a square are further from the center than any other point of a shape.
            bound: core::f64::consts::SQRT_2 * options.size + shell,
        })
    }

    /// Returns the options.
    #[must_use]
    pub fn options(&self) -> &ShapeOptions {
        &self.options
    }

    /// Returns one value as a field. Positions are in units of the plane.
    #[must_use]
    pub fn field(&self, value: ShapeValue) -> ShapeField {
        ShapeField {
            shape: self.clone(),
            value,
        }
    }

    /// Returns the shape as a structure for shaders: the words of `Shape` in the WGSL of `dapple-wgsl`, as pairs of
    /// high and low words. The index of the first texel of the corners is 0.
    #[doc(hidden)]
    #[must_use]
    pub fn shader_words(&self) -> [[u32; 2]; 18] {
        let ShapeOptions { size, onion, .. } = self.options;
        let lengths = match self.outline {
            Outline::Circle { radius } => [radius, 0.0],
            Outline::Box { half } => half,
            Outline::Corners(_) => [0.0; 2],
            Outline::Capsule { half, radius } => [half, radius],
            Outline::Ring { radius, half_width } => [radius, half_width],
            Outline::Moon {
                radius,
                displacement,
            } => [radius, displacement],
            Outline::Heart { scale } => [scale, 0.0],
        };
        let ShapeOptions {
            frequency, center, ..
        } = self.options;
        let flags = u32::from(frequency[0].is_some())
            | u32::from(frequency[1].is_some()) << 1
            | u32::from(onion != 0.0) << 2;
        let frequency = frequency.map(|frequency| frequency.unwrap_or(1.0));
        let offset = [0, 1].map(|axis| Split::of(center[axis] * frequency[axis]).offset);
        let half_shell = 0.5 * onion * size;
        let numbers = [
            self.direction,
            [self.rounding, self.bound],
            [half_shell, self.options.edge * size],
            lengths,
            center,
            offset,
            frequency,
            frequency.map(|frequency| 1.0 / frequency),
        ];
        let count = self.shader_corners().len() as u32 / 4;
        let mut words = [[self.options.kind as u32, count], [0, flags]]
            .into_iter()
            .chain(numbers.into_iter().flatten().map(lattice::shader_words));
        std::array::from_fn(|_| words.next().unwrap_or_default())
    }

    /// Returns the corners of a polygon or a star as words for a shader, four words per corner; empty for other
    /// shapes.
    #[doc(hidden)]
    #[must_use]
    pub fn shader_corners(&self) -> Vec<u32> {
        let Outline::Corners(corners) = &self.outline else {
            return Vec::new();
        };
        let numbers = corners.as_flattened().iter();
        numbers
            .flat_map(|&number| lattice::shader_words(number))
            .collect()
    }

    fn sample(&self, value: ShapeValue, position: [f64; 2]) -> f32 {
        if position.iter().any(|coordinate| !coordinate.is_finite()) {
            return f32::NAN;
        }
        let distance = self.distance(position);
        match value {
            ShapeValue::Distance => distance as f32,
            ShapeValue::Mask => {
                let edge = self.options.edge * self.options.size;
                if distance >= 0.5 * edge {
                    return 0.0;
                }
                if distance <= -0.5 * edge {
                    return 1.0;
                }
                let t = 0.5 - distance / edge;
                smoothstep(t) as f32
            }
        }
    }

    /// Returns the signed distance to the nearest copy.
    fn distance(&self, position: [f64; 2]) -> f64 {
        // Offset from the copy whose center is nearest, and the distance of copies along each axis.
        let (mut offset, mut spacing) = ([0.0; 2], [None; 2]);
        for axis in 0..2 {
            let center = self.options.center[axis];
            offset[axis] = match self.options.frequency[axis] {
                None => position[axis] - center,
                Some(frequency) => {
                    spacing[axis] = Some(1.0 / frequency);
                    let place = Split::of(position[axis] * frequency);
                    let center = Split::of(center * frequency);
                    let cells = Split::of(place.offset - center.offset + 0.5).offset - 0.5;
                    cells / frequency
                }
            };
        }
        let mut nearest = self.copy_distance(offset);
        if spacing == [None; 2] {
            return nearest;
        }
        // The nearest point of all copies is at most half of a period from the position along each axis, compared with
        // the same point of other copies. The center of its copy is at most the bound further away.
        let steps = [0, 1].map(|axis| match spacing[axis] {
            None => (0, 0),
            Some(spacing) => {
                let reach = self.bound + 0.5 * spacing;
                let first = ((offset[axis] - reach) / spacing).ceil();
                let last = ((offset[axis] + reach) / spacing).floor();
                (first as i64, last as i64)
            }
        });
        let moved = |axis: usize, step: i64| match spacing[axis] {
            Some(spacing) if step != 0 => offset[axis] - step as f64 * spacing,
            _ => offset[axis],
        };
        for row in steps[1].0..=steps[1].1 {
            for column in steps[0].0..=steps[0].1 {
                let offset = [moved(0, column), moved(1, row)];
                // Skip copies whose bounding circle is not nearer.
                if (column, row) != (0, 0) && length(offset) - self.bound < nearest {
                    nearest = nearest.min(self.copy_distance(offset));
                }
            }
        }
        nearest
    }

    /// Returns the signed distance to the border of a copy, given the position's offset from the copy's center.
    fn copy_distance(&self, [x, y]: [f64; 2]) -> f64 {
        let [cos, sin] = self.direction;
        let at = [x * cos + y * sin, y * cos - x * sin];
        let distance = self.outline.distance(at) - self.rounding;
        match self.options.onion {
            0.0 => distance,
            onion => distance.abs() - 0.5 * onion * self.options.size,
        }
    }
}

impl Outline {
    /// Creates the outline, shrunk by the radius of rounded corners.
    fn new(options: &ShapeOptions) -> Self {
        let ShapeOptions { size, ratio, .. } = *options;
        let radius = rounding(options);
        let size = size - radius;
        match options.kind {
            ShapeKind::Circle => Self::Circle { radius: size },
            ShapeKind::Box => Self::Box {
                half: [size, options.size * ratio - radius],
            },
            ShapeKind::Polygon => Self::Corners(corners(options.sides, |_| size)),
            ShapeKind::Star => Self::Corners(corners(2 * options.sides, |index| {
                if index % 2 == 0 { size } else { size * ratio }
            })),
            ShapeKind::Capsule => {
                let radius = size * ratio;
                Self::Capsule {
                    half: size - radius,
                    radius,
                }
            }
            ShapeKind::Ring => Self::Ring {
                radius: 0.5 * size * (1.0 + ratio),
                half_width: 0.5 * size * (1.0 - ratio),
            },
            ShapeKind::Moon => Self::Moon {
                radius: size,
                displacement: 2.0 * ratio * size,
            },
            ShapeKind::Heart => Self::Heart {
                scale: size / HEART[0],
            },
        }
    }

    /// Returns the signed distance to the outline, negative inside.
    fn distance(&self, at: [f64; 2]) -> f64 {
        match self {
            Self::Circle { radius } => length(at) - radius,
            Self::Box { half } => {
                let past = [0, 1].map(|axis| at[axis].abs() - half[axis]);
                length(past.map(|past| past.max(0.0))) + past[0].max(past[1]).min(0.0)
            }
            Self::Corners(corners) => polygon_distance(corners, at),
            Self::Capsule { half, radius } => {
                length([(at[0].abs() - half).max(0.0), at[1]]) - radius
            }
            Self::Ring { radius, half_width } => (length(at) - radius).abs() - half_width,
            Self::Moon {
                radius,
                displacement,
            } => moon_distance(*radius, *displacement, at),
            // The distance function has the heart's tip at the origin, and y points up.
            Self::Heart { scale } => {
                scale * heart_distance([at[0] / scale, HEART[1] - at[1] / scale])
            }
        }
    }
}

/// Windows are rendered on all cores if the feature `rayon` is enabled.
impl Field for ShapeField {
    fn value(&self, position: [f64; 2]) -> f32 {
        self.shape.sample(self.value, position)
    }

    fn render(&self, window: &Window, out: RasterViewMut<'_, f32>) -> Result<(), RasterError> {
        lattice::render(window, out, |position| self.value(position))
    }

    fn period(&self) -> [Option<f64>; 2] {
        let frequency = self.shape.options.frequency;
        frequency.map(|frequency| frequency.map(|frequency| 1.0 / frequency))
    }
}

/// Returns the radius of rounded corners, in units of the plane; 0 for shapes without corners.
fn rounding(options: &ShapeOptions) -> f64 {
    let radius = options.rounding * options.size;
    match options.kind {
        ShapeKind::Circle | ShapeKind::Capsule | ShapeKind::Ring => 0.0,
        ShapeKind::Box => radius.min(options.size * options.ratio),
        _ => radius,
    }
}

/// Returns `count` points around the origin at equal angles, clockwise from the top. `distance` gives each point's
/// distance from the origin.
fn corners(count: u32, distance: impl Fn(u32) -> f64) -> Vec<[f64; 2]> {
    let corner = |index: u32| {
        let [cos, sin] = direction(360.0 * f64::from(index) / f64::from(count));
        let distance = distance(index);
        [distance * sin, -distance * cos]
    };
    (0..count).map(corner).collect()
}

/// Returns the signed distance to a polygon, negative inside.
fn polygon_distance(corners: &[[f64; 2]], at: [f64; 2]) -> f64 {
    let (mut least_sq, mut inside) = (f64::INFINITY, false);
    let mut from = corners[corners.len() - 1];
    for &to in corners {
        // Distance to the side
        let side = [to[0] - from[0], to[1] - from[1]];
        let offset = [at[0] - from[0], at[1] - from[1]];
        let along =
            (offset[0] * side[0] + offset[1] * side[1]) / (side[0] * side[0] + side[1] * side[1]);
        let along = along.clamp(0.0, 1.0);
        let foot = [offset[0] - along * side[0], offset[1] - along * side[1]];
        least_sq = least_sq.min(foot[0] * foot[0] + foot[1] * foot[1]);
        // Count the sides that a ray to the right crosses.
        if (from[1] > at[1]) != (to[1] > at[1]) {
            let cross = side[0] * offset[1] - side[1] * offset[0];
            inside ^= (cross < 0.0) == (side[1] > 0.0);
        }
        from = to;
    }
    let distance = least_sq.sqrt();
    if inside { -distance } else { distance }
}

/// Returns the signed distance to a crescent: a disk minus an equal disk that is displaced to the right.
fn moon_distance(radius: f64, displacement: f64, [x, y]: [f64; 2]) -> f64 {
    let y = y.abs();
    // The circles meet at (a, ±b).
    let a = 0.5 * displacement;
    let b = (radius * radius - a * a).max(0.0).sqrt();
    if x * b - y * a > displacement * (b - y).max(0.0) {
        return length([x - a, y - b]);
    }
    (length([x, y]) - radius).max(radius - length([x - displacement, y]))
}

/// Returns the signed distance to a heart with its tip at the origin and a half-width of [`HEART`]; y points up.
fn heart_distance([x, y]: [f64; 2]) -> f64 {
    let x = x.abs();
    if x + y > 1.0 {
        return length([x - 0.25, y - 0.75]) - core::f64::consts::SQRT_2 / 4.0;
    }
    let foot = 0.5 * (x + y).max(0.0);
    let distance = length([x, y - 1.0]).min(length([x - foot, y - foot]));
    if x < y { -distance } else { distance }
}

#[cfg(test)]
mod tests;
