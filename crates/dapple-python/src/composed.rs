//! Compositions of fields of three and four axes.
//!
//! In each plane along the first two axes a composition is the composition of the planes of its parts. At scattered
//! positions the values of each part are computed for many positions at once and then combined, with the same bits.

use crate::error::Result;
use crate::function::{Function, Made, Volume, position, scales};
use dapple::raster::glam::DVec2;
use dapple::raster::{Constant, Field, Fractal, RasterError, RasterViewMut, Window};
use std::sync::Arc;

/// Returns a part of a composition in a plane: its index, and the change of each further coordinate.
pub(crate) type Part<'a> = &'a dyn Fn(usize, &dyn Fn(usize, f64) -> f64) -> Arc<dyn Field>;

/// A function that is composed of others.
#[derive(Clone)]
pub(crate) struct Composed {
    made: Made,
    parts: Vec<Function>,
    n_axes: usize,
}

impl Composed {
    /// Composes parts that have `n_axes` axes, or two.
    pub(crate) fn new(made: Made, parts: Vec<Function>, n_axes: usize) -> Self {
        Self {
            made,
            parts,
            n_axes,
        }
    }

    /// The plane along the first two axes at fixed further coordinates, without displacements out of the plane.
    pub(crate) fn plane(&self, rest: &[f64]) -> Result<Arc<dyn Field>> {
        let part = |index: usize, change: &dyn Fn(usize, f64) -> f64| match &self.parts[index] {
            Function::Plane(field) => Arc::clone(field),
            Function::Space(volume) => {
                let rest = rest.iter().enumerate();
                let rest: Vec<f64> = rest.map(|(axis, &at)| change(axis, at)).collect();
                volume.slice(&rest)
            }
        };
        self.made.of_planes(&part, 0)
    }

    /// The values of a part at positions in space.
    fn part(&self, index: usize, positions: &[f64]) -> Vec<f32> {
        let mut values = vec![0.0; positions.len() / self.n_axes];
        match &self.parts[index] {
            Function::Plane(field) => {
                let places = positions.chunks_exact(self.n_axes).map(position);
                // The lengths are equal, and there are no other errors.
                let _ = field.sample_many(&places.collect::<Vec<_>>(), &mut values);
            }
            Function::Space(volume) => volume.sample_many(positions, &mut values),
        }
        values
    }

    /// Positions with each coordinate changed, by its axis and value.
    fn moved(&self, positions: &[f64], change: impl Fn(usize, f64) -> f64) -> Vec<f64> {
        let positions = positions.iter().enumerate();
        let changed = positions.map(|(index, &at)| change(index % self.n_axes, at));
        changed.collect()
    }

    /// The values at positions in space.
    fn values(&self, positions: &[f64]) -> Result<Vec<f32>> {
        let combined: Arc<dyn Field> = match &self.made {
            // Operations on positions
            Made::Frequency { frequency, .. } => {
                let scaled = self.moved(positions, |axis, at| at * frequency[axis]);
                return Ok(self.part(0, &scaled));
            }
            Made::Offset { offset, .. } => {
                let moved = self.moved(positions, |axis, at| at + offset[axis]);
                return Ok(self.part(0, &moved));
            }
            Made::Rotate { angle, .. } => {
                let (sin, cos) = libm::sincos(*angle);
                let mut turned = positions.to_vec();
                for at in turned.chunks_exact_mut(self.n_axes) {
                    let [x, y] = [at[0], at[1]];
                    (at[0], at[1]) = (x * cos + y * sin, y * cos - x * sin);
                }
                return Ok(self.part(0, &turned));
            }
            Made::Warp {
                amount, further, ..
            } => {
                let mut moved = positions.to_vec();
                for axis in 0..2 + further.len() {
                    let along = moved.iter_mut().skip(axis).step_by(self.n_axes);
                    for (at, by) in along.zip(self.part(axis + 1, positions)) {
                        *at += amount * f64::from(by);
                    }
                }
                return Ok(self.part(0, &moved));
            }
            // Operations on values
            Made::Fractal {
                octaves,
                gain,
                lacunarity,
                shape,
                ..
            } => {
                let octaves = scales(*octaves, *lacunarity)
                    .map(|scale| Known(self.part(0, &self.moved(positions, |_, at| at * scale))));
                // The positions of the octaves are already scaled.
                Arc::new(Fractal::new(octaves, *gain, 1.0, *shape)?)
            }
            made => made.of_planes(&|index, _| Arc::new(Known(self.part(index, positions))), 0)?,
        };
        let indices = 0..positions.len() / self.n_axes;
        let indices: Vec<_> = indices.map(|index| DVec2::new(index as f64, 0.0)).collect();
        let mut values = vec![0.0; indices.len()];
        combined.sample_many(&indices, &mut values)?;
        Ok(values)
    }
}

impl Volume for Composed {
    fn period(&self) -> Vec<Option<f64>> {
        // The periods along further axes follow from those of the parts as they do in a plane of these axes.
        let part = |index: usize, _: &dyn Fn(usize, f64) -> f64| {
            let mut period = [Some(0.0); 2];
            if let Function::Space(volume) = &self.parts[index] {
                for (period, further) in period.iter_mut().zip(&volume.period()[2..]) {
                    *period = *further;
                }
            }
            let field: Arc<dyn Field> = Arc::new(Repeating(period));
            field
        };
        let of = |made: Result<Arc<dyn Field>>| made.map_or([None; 2], |plane| plane.period());
        let plane = of(self.plane(&vec![0.0; self.n_axes - 2]));
        let further = of(self.made.of_planes(&part, 2));
        [plane, further].concat()[..self.n_axes].to_vec()
    }

    fn sample(&self, position: &[f64]) -> f32 {
        let mut value = [f32::NAN];
        self.sample_many(position, &mut value);
        value[0]
    }

    fn sample_many(&self, positions: &[f64], values: &mut [f32]) {
        match self.values(&positions[..values.len() * self.n_axes]) {
            Ok(made) => values.copy_from_slice(&made),
            // The same composition was made before, of other parts.
            Err(_) => values.fill(f32::NAN),
        }
    }

    fn slice(&self, rest: &[f64]) -> Arc<dyn Field> {
        match &self.made {
            Made::Warp { further, .. } if !further.is_empty() => Arc::new(Section {
                composed: self.clone(),
                rest: rest.to_vec(),
            }),
            // The same composition was made before, at other coordinates.
            _ => self
                .plane(rest)
                .unwrap_or_else(|_| Arc::new(Constant(f32::NAN))),
        }
    }
}

/// Values that are known at the positions `(0, 0)`, `(1, 0)`, `(2, 0)`, …
struct Known(Vec<f32>);

impl Field for Known {
    fn sample(&self, position: DVec2) -> f32 {
        self.0.get(position.x as usize).copied().unwrap_or(f32::NAN)
    }
}

/// A field of which only the periods are known.
struct Repeating([Option<f64>; 2]);

impl Field for Repeating {
    fn sample(&self, _: DVec2) -> f32 {
        0.0
    }

    fn period(&self) -> [Option<f64>; 2] {
        self.0
    }
}

/// A plane through a warp that displaces positions out of the plane.
struct Section {
    composed: Composed,
    rest: Vec<f64>,
}

impl Field for Section {
    fn sample(&self, position: DVec2) -> f32 {
        let position = [&position.to_array()[..], &self.rest].concat();
        self.composed.sample(&position)
    }

    fn sample_many(
        &self,
        positions: &[DVec2],
        values: &mut [f32],
    ) -> core::result::Result<(), RasterError> {
        let mut at = Vec::with_capacity(positions.len() * self.composed.n_axes);
        for position in positions {
            at.extend(position.to_array());
            at.extend(&self.rest);
        }
        self.composed.sample_many(&at, values);
        Ok(())
    }

    fn render(
        &self,
        window: &Window,
        mut out: RasterViewMut<'_, f32>,
    ) -> core::result::Result<(), RasterError> {
        for (row, values) in (0..).zip(out.rows_mut()) {
            let y = window.row_y(row);
            let columns = (0..window.size[0]).map(|column| DVec2::new(window.column_x(column), y));
            self.sample_many(&columns.collect::<Vec<_>>(), values)?;
        }
        Ok(())
    }

    fn period(&self) -> [Option<f64>; 2] {
        let period = self.composed.period();
        [period[0], period[1]]
    }
}
