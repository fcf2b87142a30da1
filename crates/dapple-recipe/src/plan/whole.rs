//! The steps that see the whole tile, evaluated beforehand for a picture of a given size.

use super::evaluate::Places;
use super::step::{Global, Laid, Layers, Step};
use super::{Picture, Plan, Values};
use crate::operation::colors;
use crate::{RecipeError, RecipeErrorKind};
use dapple_raster::{Raster, RasterError, Window, Wrap};
use dapple_tile::{CornerTiles, Layer, Map, blend, blend_by_tile, rank_equalize};
use glam::DVec2;
use std::sync::Arc;

/// What sees the whole tile, for a picture of one size: as many pixels for each such step.
#[derive(Clone, Debug, Default)]
pub struct Whole {
    /// The tile as a window; none where no step sees it.
    window: Option<Window>,
    wrap: [Wrap; 2],
    extent: DVec2,
    pictures: Vec<Option<Picture>>,
}

impl Plan {
    /// Whether a map of the material, or a node, sees the whole tile, so that a picture of it cannot be made in bands.
    #[must_use]
    pub fn sees_whole(&self) -> bool {
        !self.needed_globals().is_empty()
    }

    /// The steps that see the whole tile and take part in the material, in their order.
    fn needed_globals(&self) -> Vec<usize> {
        let channels = self.channels();
        let mut needed = vec![false; self.steps().len()];
        for index in [
            channels.height,
            channels.albedo,
            channels.roughness,
            channels.metallic,
        ] {
            needed[index] = true;
        }
        for index in (0..needed.len()).rev() {
            if needed[index] {
                self.steps()[index]
                    .inputs()
                    .into_iter()
                    .for_each(|input| needed[input] = true);
            }
        }
        let is_global =
            |&index: &usize| needed[index] && matches!(self.steps()[index], Step::Global(..));
        (0..needed.len()).filter(is_global).collect()
    }

    /// Refuses a material that sees the whole tile.
    ///
    /// # Errors
    ///
    /// [`Global`](RecipeErrorKind::Global), with the node.
    pub fn check_local(&self) -> Result<(), RecipeError> {
        let Some(&index) = self.needed_globals().first() else {
            return Ok(());
        };
        let error = RecipeError::new(RecipeErrorKind::Global {
            during: "in a bake that goes band by band",
        });
        Err(self.within(index, error))
    }

    /// An error in the node of a step.
    pub(super) fn within(&self, index: usize, error: RecipeError) -> RecipeError {
        match self.names.iter().find(|&(_, &step)| step == index) {
            Some((name, _)) => error.within(name),
            None => error,
        }
    }

    /// Evaluates what sees the whole tile, for a picture of so many pixels.
    ///
    /// # Errors
    ///
    /// What the crates of the nodes refuse, [`Raster`](RecipeErrorKind::Raster) for a size that is too large, and
    /// [`TooMuch`](RecipeErrorKind::TooMuch) for more pixels in all than the limits of the plan allow.
    pub fn whole(&self, size: [u32; 2]) -> Result<Whole, RecipeError> {
        let globals = self.needed_globals();
        let Some(&first) = globals.first() else {
            return Ok(Whole::default());
        };
        self.limits
            .check_pixels(globals.len(), size)
            .map_err(|error| self.within(first, error))?;
        let window = Window::new(DVec2::ZERO, self.extent(), size)?;
        let mut whole = Whole {
            window: Some(window),
            wrap: self
                .wrap
                .map(|wraps| if wraps { Wrap::Repeat } else { Wrap::Clamp }),
            extent: self.extent(),
            pictures: vec![None; self.steps().len()],
        };
        for index in globals {
            let picture = self.picture(&whole, &window, index);
            whole.pictures[index] = Some(picture.map_err(|error| self.within(index, error))?);
        }
        Ok(whole)
    }

    /// The picture of a step that sees the whole tile.
    fn picture(
        &self,
        whole: &Whole,
        window: &Window,
        index: usize,
    ) -> Result<Picture, RecipeError> {
        let Step::Global(global, inputs, _) = &self.steps()[index] else {
            return Err(RecipeError::new(RecipeErrorKind::Conflict {
                rule: "only some nodes see the whole tile",
            }));
        };
        let of_inputs = global.window_of_inputs(window)?;
        let made = self.values(whole, &of_inputs, inputs, &[])?;
        let made: Vec<&Values> = made.iter().collect();
        let values = match global {
            Global::Tile(seamless) => {
                let tiled = seamless.apply_maps(&[map(made[0], window.size)?])?;
                if tiled[0].size() != window.size {
                    let rule =
                        "a tile in a recipe keeps its size: the methods soft_cut and mirror do not";
                    return Err(RecipeError::new(RecipeErrorKind::Conflict { rule }));
                }
                values(tiled)?
            }
            Global::BlendMap(how, feature_size) => {
                let mut how = *how;
                how.feature_size = feature_size / window.pixel.max_element();
                let map = how.apply(&raster(made[0], window.size)?)?;
                Values::Numbers(rank_equalize(&map)?.into_pixels())
            }
            Global::Blend(layers) => blend_values(layers, &made, window.size)?,
            Global::Disturb(disturbance, _) => {
                let maps = alike(&made, of_inputs.size)?;
                values(disturbance.render_maps(&maps, [0, 0], window.size)?)?
            }
            Global::MatchBorders(options) => {
                let maps = alike(&made, window.size)?;
                let maps: Vec<_> = maps.into_iter().map(|map| vec![map]).collect();
                values(options.apply_maps(&maps)?.swap_remove(1))?
            }
            Global::CornerTiles(corners) => {
                let maps = alike(&made, of_inputs.size)?;
                let maps: Vec<_> = maps.into_iter().map(|map| vec![map]).collect();
                let tiles = CornerTiles::new(&maps)?
                    .with_width(corners.width)?
                    .with_period(corners.copies.map(Some))?;
                values(tiles.render(corners.seed, [0, 0], window.size)?)?
            }
        };
        Ok(match values {
            Values::Numbers(numbers) => {
                Picture::Numbers(Arc::new(Raster::from_vec(window.size, numbers)?))
            }
            Values::Colors(colors) => {
                Picture::Colors(Arc::new(Raster::from_vec(window.size, colors)?))
            }
        })
    }
}

impl Global {
    /// The pixels of the inputs: those of the picture, or where it is made of smaller copies, of one of them.
    fn window_of_inputs(&self, window: &Window) -> Result<Window, RecipeError> {
        let copies = match self {
            Self::Disturb(_, copies) => *copies,
            Self::CornerTiles(corners) => corners.copies,
            Self::Tile(_) | Self::BlendMap(..) | Self::Blend(_) | Self::MatchBorders(_) => [1; 2],
        };
        let mut size = window.size;
        for axis in 0..2 {
            let pixels = f64::from(size[axis]) / f64::from(copies[axis]);
            let what = "number of pixels along a side of a copy";
            let range = "a whole number (size of the bake over copies)";
            RecipeError::check(pixels.fract() == 0.0, what, pixels, range)?;
            size[axis] /= copies[axis];
        }
        let copies = DVec2::new(copies[0].into(), copies[1].into());
        Ok(Window {
            pixel: window.pixel * copies,
            size,
            ..*window
        })
    }
}

impl Whole {
    /// The values of a step at some places: pixels of the picture where the places are such, else what lies between them.
    pub(super) fn at(&self, index: usize, places: Places<'_>) -> Result<Values, RecipeError> {
        let (Some(tile), Some(Some(picture))) = (self.window, self.pictures.get(index)) else {
            return Err(RecipeError::new(RecipeErrorKind::Global { during: "yet" }));
        };
        match places {
            Places::Window(window)
                if window.origin == tile.origin && window.pixel == tile.pixel =>
            {
                Ok(match picture {
                    Picture::Numbers(raster) => Values::Numbers(self.pixels(raster, window)),
                    Picture::Colors(raster) => Values::Colors(self.pixels(raster, window)),
                })
            }
            places => {
                let laid = Laid {
                    picture: picture.clone(),
                    extent: self.extent,
                    wrap: self.wrap,
                };
                Ok(laid.at(&places.positions()))
            }
        }
    }

    /// The pixels of a part of the tile, or of its surroundings.
    fn pixels<T: Copy>(&self, raster: &Raster<T>, window: &Window) -> Vec<T> {
        let mut pixels = Vec::with_capacity(window.n_pixels());
        for row in 0..window.size[1] {
            let y = window.first[1] + i64::from(row);
            for column in 0..window.size[0] {
                pixels.push(*raster.at(window.first[0] + i64::from(column), y, self.wrap));
            }
        }
        pixels
    }
}

/// A blend of layers: their inputs, their weights, the heights of those that have one, and the mask.
pub(crate) fn blend_values(
    layers: &Layers,
    inputs: &[&Values],
    size: [u32; 2],
) -> Result<Values, RecipeError> {
    let count = layers.heights.len();
    let maps = alike(&inputs[..count], size)?;
    let maps: Vec<_> = maps.into_iter().map(|map| [map]).collect();
    let rasters = inputs[count..].iter().map(|values| raster(values, size));
    let rasters = rasters.collect::<Result<Vec<_>, _>>()?;
    let mut heights = rasters[count..].iter();
    let layer = |index: usize| Layer {
        maps: &maps[index],
        weight: &rasters[index],
        height: if layers.heights[index] {
            heights.next()
        } else {
            None
        },
    };
    let of_blend: Vec<_> = (0..count).map(layer).collect();
    let blended = if layers.mask {
        blend_by_tile(&of_blend, &rasters[rasters.len() - 1], &layers.how)?
    } else {
        blend(&of_blend, &layers.how)?
    };
    values(blended)
}

/// The maps of all inputs: of colors, if one of them has colors.
fn alike(inputs: &[&Values], size: [u32; 2]) -> Result<Vec<Map>, RasterError> {
    let is_color = |values: &&Values| matches!(values, Values::Colors(_));
    let any = inputs.iter().any(is_color);
    let kind = |values: &&Values| match any {
        true => Values::Colors(colors(values)),
        false => Values::clone(values),
    };
    inputs
        .iter()
        .map(|values| map(&kind(values), size))
        .collect()
}

/// Numbers as they are, and the luminance of colors.
fn raster(values: &Values, size: [u32; 2]) -> Result<Raster<f32>, RasterError> {
    Raster::from_vec(size, values.clone().into_grays())
}

fn map(values: &Values, size: [u32; 2]) -> Result<Map, RasterError> {
    Ok(match values {
        Values::Numbers(numbers) => Map::Value(Raster::from_vec(size, numbers.clone())?),
        Values::Colors(colors) => Map::Color(Raster::from_vec(size, colors.clone())?),
    })
}

/// The values of the only map of a result.
fn values(maps: Vec<Map>) -> Result<Values, RecipeError> {
    match maps.into_iter().next() {
        Some(Map::Value(raster)) => Ok(Values::Numbers(raster.into_pixels())),
        Some(Map::Color(raster)) => Ok(Values::Colors(raster.into_pixels())),
        Some(Map::Normal(_)) | None => {
            let rule = "a blend gives back what it was given";
            Err(RecipeError::new(RecipeErrorKind::Conflict { rule }))
        }
    }
}

#[cfg(test)]
mod tests;
