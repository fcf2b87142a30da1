//! Functions of the plane with several values at each position, as one type for all channel counts.

use crate::error::{Error, Result};
use dapple::pups::{LabelTexture, Pups, VectorLabelTexture, VectorTexture};
use dapple::raster::glam::DVec2;
use dapple::raster::{Field, RasterError, RasterViewMut, Window};
use std::sync::Arc;

/// A function of the plane with several values at each position.
pub(crate) trait Vectors: Send + Sync {
    /// Returns the number of channels.
    fn n_channels(&self) -> usize;

    /// Returns the period along each axis; `None` for an axis without a period.
    fn period(&self) -> [Option<f64>; 2];

    /// Writes the values at `position`.
    fn sample(&self, position: DVec2, vector: &mut [f32]);

    /// Writes the values at the pixels of a window, pixel by pixel.
    fn render(&self, window: &Window, values: &mut [f32]) -> core::result::Result<(), RasterError>;
}

macro_rules! vectors {
    ($($texture:ident: |$this:ident| $pups:expr),*) => {$(
        impl<const N: usize> Vectors for $texture<N> {
            fn n_channels(&self) -> usize {
                N
            }

            fn period(&self) -> [Option<f64>; 2] {
                let $this = self;
                $pups.domain().period()
            }

            fn sample(&self, position: DVec2, vector: &mut [f32]) {
                vector.copy_from_slice(&Self::sample(self, position));
            }

            fn render(
                &self,
                window: &Window,
                values: &mut [f32],
            ) -> core::result::Result<(), RasterError> {
                let pixels = values.as_chunks_mut::<N>().0;
                let view = RasterViewMut::new(pixels, window.size[0] as usize, window.size)?;
                Self::render(self, window, view)
            }
        }
    )*};
}

vectors!(VectorTexture: |this| this.pups(), Labels: |this| this.pups);

/// A texture of labels with a vector for each label, and its control net, which determines the period.
struct Labels<const N: usize> {
    texture: VectorLabelTexture<N>,
    pups: Pups,
}

impl<const N: usize> Labels<N> {
    fn sample(&self, position: DVec2) -> [f32; N] {
        self.texture.sample(position)
    }

    fn render(
        &self,
        window: &Window,
        out: RasterViewMut<'_, [f32; N]>,
    ) -> core::result::Result<(), RasterError> {
        self.texture.render(window, out)
    }
}

/// A field interpolated from control-point values.
#[derive(Clone)]
pub(crate) enum Values {
    /// One value at each position.
    Numbers(Arc<dyn Field>),
    /// Several values at each position.
    Vectors(Arc<dyn Vectors>),
}

/// Maximum number of values per control point.
pub(crate) const MOST_CHANNELS: usize = 8;

impl Values {
    /// Builds the field from values at control points or, with `labels`, from one value per label. `channels` is the
    /// number of values per control point or label; `None` for scalars.
    pub(crate) fn new(
        pups: Pups,
        values: &[f32],
        channels: Option<usize>,
        labels: Option<&[u32]>,
    ) -> Result<Self> {
        let Some(channels) = channels else {
            let values = values.to_vec();
            return Ok(Self::Numbers(match labels {
                None => Arc::new(pups.texture(values)?),
                Some(labels) => Arc::new(LabelTexture::new(pups, labels.to_vec(), values)?),
            }));
        };
        Ok(Self::Vectors(match channels {
            1 => vectors::<1>(pups, values, labels)?,
            2 => vectors::<2>(pups, values, labels)?,
            3 => vectors::<3>(pups, values, labels)?,
            4 => vectors::<4>(pups, values, labels)?,
            5 => vectors::<5>(pups, values, labels)?,
            6 => vectors::<6>(pups, values, labels)?,
            7 => vectors::<7>(pups, values, labels)?,
            8 => vectors::<8>(pups, values, labels)?,
            _ => {
                let message = format!(
                    "the values have {channels} channels, but it must be from 1 to {MOST_CHANNELS}"
                );
                return Err(Error::new("channels", message));
            }
        }))
    }

    /// Returns the field; an error unless it has a single value at each position.
    pub(crate) fn numbers(self) -> Result<Arc<dyn Field>> {
        match self {
            Self::Numbers(field) => Ok(field),
            Self::Vectors(_) => Err(Error::new(
                "channels",
                "a field of single numbers is needed, but this one has channels",
            )),
        }
    }
}

fn vectors<const N: usize>(
    pups: Pups,
    values: &[f32],
    labels: Option<&[u32]>,
) -> Result<Arc<dyn Vectors>> {
    let values = values.as_chunks::<N>().0.to_vec();
    let Some(labels) = labels else {
        return Ok(Arc::new(pups.vector_texture(values)?));
    };
    let texture = VectorLabelTexture::new(pups.clone(), labels.to_vec(), values)?;
    Ok(Arc::new(Labels { texture, pups }))
}
