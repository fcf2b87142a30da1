//! Feature points of cells, and gradients of their distances, at many positions.

use super::CellsMade;
use super::texture::{Texture, plane};
use crate::error::{Error, Result};
use crate::generators::array;
use dapple::raster::{RasterViewMut, Window};
use dapple::worley::{Axes, FeatureView, LIMIT, Space, Vector};

pub(super) fn check_count(count: usize) -> Result<()> {
    if (1..=LIMIT).contains(&count) {
        return Ok(());
    }
    Err(Error::new(
        "count",
        format!("the number of feature points is {count}, but it must be from 1 to {LIMIT}"),
    ))
}

/// The nearest feature points of many positions.
pub(super) struct Found {
    pub(super) distance: Vec<f32>,
    pub(super) vector: Vec<f64>,
    pub(super) id: Vec<u64>,
}

pub(super) fn find<const N: usize, const K: usize>(
    made: &CellsMade,
    positions: &[f64],
) -> Result<Found>
where
    Axes: Space<N>,
{
    let basis = made.basis::<N>()?;
    let features = dapple::raster::parallel::map_at_least(256, positions.len() / N, |index| {
        let position: [f64; N] = core::array::from_fn(|axis| positions[index * N + axis]);
        basis.sample::<K>(position)
    });
    let features = features.as_flattened();
    Ok(Found {
        distance: features.iter().map(|feature| feature.distance).collect(),
        vector: features
            .iter()
            .flat_map(|feature| feature.vector.into())
            .collect(),
        id: features.iter().map(|feature| feature.id).collect(),
    })
}

/// The planes of the nearest feature points, those of the nearest first.
pub(super) struct Drawn {
    pub(super) distance: Option<Vec<f32>>,
    pub(super) vector: Option<Vec<f32>>,
    pub(super) id: Option<Vec<u64>>,
}

pub(super) fn draw<const N: usize, const K: usize>(
    made: &CellsMade,
    window: &Window,
    rest: &[f64],
    wanted: [bool; 3],
    n_values: usize,
) -> Result<Drawn>
where
    Axes: Space<N>,
{
    let basis = made.basis::<N>()?;
    let mut distance = wanted[0].then(|| vec![0.0_f32; K * n_values]);
    let mut vector = wanted[1].then(|| vec![[0.0_f32; N]; K * n_values]);
    let mut id = wanted[2].then(|| vec![0_u64; K * n_values]);
    let mut views: [FeatureView<'_, N>; K] = core::array::from_fn(|_| FeatureView::default());
    let stride = window.size[0] as usize;
    if let Some(values) = &mut distance {
        for (view, values) in views.iter_mut().zip(values.chunks_mut(n_values)) {
            view.distance = Some(RasterViewMut::new(values, stride, window.size)?);
        }
    }
    if let Some(values) = &mut vector {
        for (view, values) in views.iter_mut().zip(values.chunks_mut(n_values)) {
            view.vector = Some(RasterViewMut::new(values, stride, window.size)?);
        }
    }
    if let Some(values) = &mut id {
        for (view, values) in views.iter_mut().zip(values.chunks_mut(n_values)) {
            view.id = Some(RasterViewMut::new(values, stride, window.size)?);
        }
    }
    basis.render_features(&plane::<N>(rest), window, views)?;
    Ok(Drawn {
        distance,
        vector: vector.map(Vec::into_flattened),
        id,
    })
}

pub(super) fn gradients<const N: usize>(made: &CellsMade, positions: &[f64]) -> Result<Vec<f64>>
where
    Axes: Space<N>,
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
    let gradients = dapple::raster::parallel::map_at_least(256, positions.len() / N, |index| {
        let position: [f64; N] = core::array::from_fn(|axis| positions[index * N + axis]);
        let gradient: [f64; N] = gradient(position.into()).into();
        gradient
    });
    Ok(gradients.into_flattened())
}

/// The positions and ids of the feature points of a cell.
pub(super) fn cell_points<const N: usize>(
    made: &CellsMade,
    cell: &[i64],
) -> Result<(Vec<f64>, Vec<u64>)>
where
    Axes: Space<N>,
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
