//! Cellular textures: distances, their fractal sums, edge distances and cell values.

use dapple::raster::Field;
use dapple::worley::{
    CellValues, Cellular, CellularFractal, Dimensions, EdgeDistances, Plane, Space,
};
use std::sync::Arc;

/// A cellular texture, by the kind of its values.
pub(super) enum Texture<const N: usize>
where
    Dimensions: Space<N>,
{
    Cellular(Cellular<N>),
    Fractal(CellularFractal<N>),
    Edges(EdgeDistances<N>),
    CellValues(CellValues<N>),
}

impl<const N: usize> Texture<N>
where
    Dimensions: Space<N>,
{
    pub(super) fn field(self) -> Arc<dyn Field<N>> {
        match self {
            Self::Cellular(cellular) => Arc::new(cellular),
            Self::Fractal(fractal) => Arc::new(fractal),
            Self::Edges(edges) => Arc::new(edges),
            Self::CellValues(values) => Arc::new(values),
        }
    }
}

/// Returns the plane along the first two axes. `rest` has the fixed coordinates along the other axes.
pub(super) fn plane<const N: usize>(rest: &[f64]) -> Plane<N>
where
    Dimensions: Space<N>,
{
    let mut origin = [0.0; N];
    origin[2..].copy_from_slice(rest);
    Plane::slice(origin.into())
}
