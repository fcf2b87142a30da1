//! Textures of cells: distances, their sums at several scales, borders and cell values, in the plane and in planes through more axes.

use crate::function::Volume;
use dapple::raster::glam::DVec2;
use dapple::raster::{Field as _, Raster, RasterError, RasterViewMut, Window};
use dapple::worley::{
    Axes, Cellular, EdgeDistances, Feature, FeatureView, Fractal, Plane, Space, Vector, Worley,
};
use std::sync::Arc;

/// A texture of cells, by the kind of its values.
pub(super) enum Texture<const N: usize>
where
    Axes: Space<N>,
{
    Cellular(Cellular<N>),
    Fractal(Fractal<N>),
    Edges(EdgeDistances<N>),
    CellValues(Worley<N>),
}

/// A texture of three or four axes, restricted to a plane.
struct Section<const N: usize>
where
    Axes: Space<N>,
{
    texture: Arc<Texture<N>>,
    plane: Plane<N>,
}

impl<const N: usize> Texture<N>
where
    Axes: Space<N>,
{
    pub(super) fn value(&self, position: Vector<N>) -> f32 {
        match self {
            Self::Cellular(cellular) => cellular.value(position),
            Self::Fractal(fractal) => fractal.value(position),
            Self::Edges(edges) => edges.value(position),
            Self::CellValues(basis) => {
                let [nearest] = basis.sample(position);
                if nearest.distance.is_nan() {
                    f32::NAN
                } else {
                    nearest.cell_value()
                }
            }
        }
    }
}

/// A texture of three or four axes.
pub(super) struct Cells<const N: usize>
where
    Axes: Space<N>,
{
    pub(super) texture: Arc<Texture<N>>,
    pub(super) period: Vec<Option<f64>>,
}

/// The plane along the first two axes at fixed further coordinates.
pub(super) fn plane<const N: usize>(rest: &[f64]) -> Plane<N>
where
    Axes: Space<N>,
{
    let mut origin = [0.0; N];
    origin[2..].copy_from_slice(rest);
    Plane::slice(origin.into())
}

impl<const N: usize> Volume for Cells<N>
where
    Axes: Space<N>,
{
    fn period(&self) -> Vec<Option<f64>> {
        self.period.clone()
    }

    fn sample(&self, position: &[f64]) -> f32 {
        let position: [f64; N] = core::array::from_fn(|axis| position[axis]);
        self.texture.value(position.into())
    }

    fn slice(&self, rest: &[f64]) -> Arc<dyn dapple::raster::Field> {
        Arc::new(Section {
            texture: Arc::clone(&self.texture),
            plane: plane::<N>(rest),
        })
    }

    fn render(
        &self,
        window: &Window,
        planes: &[Vec<f64>],
        values: &mut [f32],
    ) -> core::result::Result<(), RasterError> {
        let views = values
            .chunks_mut(window.n_pixels())
            .map(|values| RasterViewMut::new(values, window.size[0] as usize, window.size));
        let slices = planes
            .iter()
            .zip(views)
            .map(|(rest, view)| Ok((plane::<N>(rest), view?)));
        let slices: Vec<_> = slices.collect::<core::result::Result<_, RasterError>>()?;
        match self.texture.as_ref() {
            Texture::Cellular(cellular) => cellular.render_slices(window, slices),
            Texture::Fractal(fractal) => fractal.render_slices(window, slices),
            _ => {
                for (plane, view) in slices {
                    let section = Section {
                        texture: Arc::clone(&self.texture),
                        plane,
                    };
                    section.render(window, view)?;
                }
                Ok(())
            }
        }
    }
}

impl<const N: usize> dapple::raster::Field for Section<N>
where
    Axes: Space<N>,
{
    fn sample(&self, position: DVec2) -> f32 {
        self.texture.value(self.plane.position(position))
    }

    fn render(
        &self,
        window: &Window,
        mut out: RasterViewMut<'_, f32>,
    ) -> core::result::Result<(), RasterError> {
        match self.texture.as_ref() {
            Texture::Cellular(cellular) => cellular.render_plane(&self.plane, window, out),
            Texture::Fractal(fractal) => fractal.render_plane(&self.plane, window, out),
            Texture::Edges(edges) => edges.render_plane(&self.plane, window, out),
            Texture::CellValues(basis) => {
                window.check_size(out.size())?;
                let mut ids = Raster::filled(window.size, 0_u64)?;
                let nearest = FeatureView {
                    id: Some(ids.view_mut()),
                    ..FeatureView::default()
                };
                basis.render_features(&self.plane, window, [nearest])?;
                for (row, values) in (0..).zip(out.rows_mut()) {
                    for (value, &id) in values.iter_mut().zip(ids.row(row)) {
                        *value = Feature {
                            distance: 0.0,
                            vector: (),
                            id,
                        }
                        .cell_value();
                    }
                }
                Ok(())
            }
        }
    }
}
