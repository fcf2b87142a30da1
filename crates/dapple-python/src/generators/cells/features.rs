//! Finds feature points, and gradients of their distances, at many positions.

use super::CellsMade;
use super::texture::{Texture, plane};
use crate::error::{Error, Result};
use crate::generators::array;
use crate::grid::Grid;
use crate::watch::{self, Stop};
use dapple::raster::{RasterViewMut, Window};
use dapple::worley::{Dimensions, FeatureView, MAX_NEAREST, Space, Vector};

/// Number of positions between two checks for an interruption.
const PART: usize = 1 << 15;

pub(super) fn check_count(count: usize) -> Result<()> {
    if (1..=MAX_NEAREST).contains(&count) {
        return Ok(());
    }
    Err(Error::new(
        "count",
        format!("the number of feature points is {count}, but it must be from 1 to {MAX_NEAREST}"),
    ))
}

/// The nearest feature points of several positions.
pub(super) struct Found {
    pub(super) distance: Vec<f32>,
    pub(super) vector: Vec<f64>,
    pub(super) id: Vec<u64>,
}

pub(super) fn find<const N: usize, const K: usize>(
    made: &CellsMade,
    positions: &[f64],
    stop: &Stop,
) -> Result<Found>
where
    Dimensions: Space<N>,
{
    let basis = made.basis::<N>()?;
    let mut found = Found {
        distance: Vec::new(),
        vector: Vec::new(),
        id: Vec::new(),
    };
    for positions in positions.chunks(N * PART) {
        stop.check()?;
        let features = dapple::raster::parallel::map_at_least(256, positions.len() / N, |index| {
            let position: [f64; N] = core::array::from_fn(|axis| positions[index * N + axis]);
            basis.sample::<K>(position)
        });
        for feature in features.as_flattened() {
            let vector: [f64; N] = feature.vector.into();
            found.distance.push(feature.distance);
            found.vector.extend(vector);
            found.id.push(feature.id);
        }
    }
    Ok(found)
}

/// The requested arrays of the nearest feature points, nearest point first; `None` for an array that was not requested.
pub(super) struct Drawn {
    pub(super) distance: Option<Vec<f32>>,
    pub(super) vector: Option<Vec<f32>>,
    pub(super) id: Option<Vec<u64>>,
}

pub(super) fn draw<const N: usize, const K: usize>(
    made: &CellsMade,
    grid: &Grid,
    rest: &[f64],
    wanted: [bool; 3],
    stop: &Stop,
) -> Result<Drawn>
where
    Dimensions: Space<N>,
{
    let basis = made.basis::<N>()?;
    let window = grid.plane();
    let (n_values, stride) = (window.n_pixels(), window.size[0] as usize);
    let mut distance = wanted[0].then(|| vec![0.0_f32; K * n_values]);
    let mut vector = wanted[1].then(|| vec![[0.0_f32; N]; K * n_values]);
    let mut id = wanted[2].then(|| vec![0_u64; K * n_values]);
    let mut put = |part: &Window, first: usize| -> Result<()> {
        let size = part.size;
        let mut views: [FeatureView<'_, N>; K] = core::array::from_fn(|_| FeatureView::default());
        if let Some(values) = &mut distance {
            for (view, values) in views.iter_mut().zip(values.chunks_mut(n_values)) {
                view.distance = Some(RasterViewMut::new(&mut values[first..], stride, size)?);
            }
        }
        if let Some(values) = &mut vector {
            for (view, values) in views.iter_mut().zip(values.chunks_mut(n_values)) {
                view.vector = Some(RasterViewMut::new(&mut values[first..], stride, size)?);
            }
        }
        if let Some(values) = &mut id {
            for (view, values) in views.iter_mut().zip(values.chunks_mut(n_values)) {
                view.id = Some(RasterViewMut::new(&mut values[first..], stride, size)?);
            }
        }
        Ok(basis.render_features(&plane::<N>(rest), part, views)?)
    };
    watch::in_parts(stop, window.size[1] as usize, PART / stride, |rows| {
        let size = [window.size[0], rows.len() as u32];
        put(
            &window.crop([0, rows.start as i64], size)?,
            rows.start * stride,
        )
    })?;
    for copies in grid.copies() {
        put(&copies.window, copies.at[1] * stride + copies.at[0])?;
    }
    Ok(Drawn {
        distance,
        vector: vector.map(Vec::into_flattened),
        id,
    })
}

pub(super) fn gradients<const N: usize>(
    made: &CellsMade,
    positions: &[f64],
    stop: &Stop,
) -> Result<Vec<f64>>
where
    Dimensions: Space<N>,
{
    let texture = made.texture::<N>()?;
    let gradient: &(dyn Fn(Vector<N>) -> Vector<N> + Sync) = match &texture {
        Texture::Cellular(cellular) => &|position| cellular.gradient(position),
        Texture::Fractal(fractal) => &|position| fractal.gradient(position),
        Texture::Edges(_) | Texture::CellValues(_) => {
            return Err(Error::new(
                "conflict",
                "`cell_value` and `edge_distance` have no gradient",
            ));
        }
    };
    let mut gradients = Vec::new();
    for positions in positions.chunks(N * PART) {
        stop.check()?;
        let part = dapple::raster::parallel::map_at_least(256, positions.len() / N, |index| {
            let position: [f64; N] = core::array::from_fn(|axis| positions[index * N + axis]);
            let gradient: [f64; N] = gradient(position.into()).into();
            gradient
        });
        gradients.extend(part.into_flattened());
    }
    Ok(gradients)
}

/// Returns the positions and ids of the feature points in one cell.
pub(super) fn cell_points<const N: usize>(
    made: &CellsMade,
    cell: &[i64],
) -> Result<(Vec<f64>, Vec<u64>)>
where
    Dimensions: Space<N>,
{
    let cell: [i64; N] = array(cell)?;
    let points = made.basis::<N>()?.cell_points(cell);
    let positions = points.iter().flat_map(|point| {
        let offset: [f64; N] = point.offset.into();
        core::array::from_fn::<f64, N, _>(|axis| cell[axis] as f64 + offset[axis])
    });
    Ok((
        positions.collect(),
        points.iter().map(|point| point.id).collect(),
    ))
}
