//! Evaluates the steps that depend on the whole tile, beforehand and at a given size.

use super::builder::wrap;
use super::evaluate::{At, Places};
use super::neighborhood::margin;
use super::step::{Global, Step, StretchedImage, Tile, needed_wholes};
use super::{OF_NODE, Pass, Picture, Plan, Samples, TileSamples, Watch};
use crate::{RecipeError, RecipeErrorKind, Region, Values};
use dapple_raster::{Raster, Window, Wrap};
use glam::DVec2;
use std::sync::Arc;

/// Images of the values of all steps that depend on the whole tile, at one size. A neighborhood that is read between
/// pixels also has an image.
#[derive(Clone, Debug, Default)]
pub struct Whole {
    /// The tile as a window; `None` if no step depends on the whole tile.
    window: Option<Window>,
    wrap: [Wrap; 2],
    extent: DVec2,
    pictures: Vec<Option<Picture>>,
    /// Reports the progress of work that uses these values.
    pub(crate) watch: Watch,
}

impl Plan {
    /// Returns whether a map of the material depends on the whole tile and so cannot be baked in bands. A neighborhood,
    /// such as a blur, does so below a `warp`, `transform` or `fractal`, which read it at positions that are not pixels.
    #[must_use]
    pub fn sees_whole(&self) -> bool {
        !needed_wholes(self.steps(), &self.channels().steps()).is_empty()
    }

    /// Checks that the material does not depend on the whole tile.
    ///
    /// # Errors
    ///
    /// [`Global`](RecipeErrorKind::Global), with the node, if it does.
    pub fn check_local(&self) -> Result<(), RecipeError> {
        let wholes = needed_wholes(self.steps(), &self.channels().steps());
        let Some(&index) = wholes.first() else {
            return Ok(());
        };
        let error = RecipeError::new(RecipeErrorKind::Global {
            during: "in a bake that goes band by band",
        });
        Err(self.within(index, error))
    }

    /// Adds the name of a step's node to an error.
    pub(super) fn within(&self, index: usize, error: RecipeError) -> RecipeError {
        match self.names.iter().find(|&(_, &step)| step == index) {
            Some((name, _)) => error.within(name),
            None => error,
        }
    }

    /// Evaluates the steps that depend on the whole tile, for maps of `size` columns and rows.
    ///
    /// # Errors
    ///
    /// If a node fails, [`Raster`](RecipeErrorKind::Raster) if the size is too large, and
    /// [`TooMuch`](RecipeErrorKind::TooMuch) if the images of these steps together have more pixels than the plan's
    /// limits allow.
    pub fn whole(&self, size: [u32; 2]) -> Result<Whole, RecipeError> {
        let tile = self.tile_samples(size, Samples::Centers)?;
        self.whole_of(&tile, &self.channels().steps(), self.watch())
    }

    /// Evaluates the steps that depend on the whole tile, for the samples of a bake.
    pub(crate) fn whole_at(&self, tile: &TileSamples) -> Result<Whole, RecipeError> {
        self.whole_of(tile, &self.channels().steps(), self.watch())
    }

    /// Evaluates those steps that `wanted` need and that depend on the whole tile.
    fn whole_of(
        &self,
        tile: &TileSamples,
        wanted: &[usize],
        watch: Watch,
    ) -> Result<Whole, RecipeError> {
        // Check the halos of neighborhoods before any work is done.
        margin(self.steps(), &tile.window, wanted)?;
        let wholes = needed_wholes(self.steps(), wanted);
        let Some(&first) = wholes.first() else {
            return Ok(Whole {
                watch,
                ..Whole::default()
            });
        };
        let window = tile.window;
        self.limits
            .check_pixels(wholes.len(), window.size)
            .map_err(|error| self.within(first, error))?;
        // Check that the window has no more pixels than a raster can have.
        Window::unit(window.size)?;
        let mut whole = Whole {
            window: Some(window),
            wrap: wrap(self.wrap),
            extent: tile.extent,
            pictures: vec![None; self.steps().len()],
            watch,
        };
        // Evaluate the steps in order; each may read the images of earlier ones.
        whole.watch.begin(Pass::Whole, OF_NODE * wholes.len());
        for (number, index) in wholes.into_iter().enumerate() {
            whole.watch.reach(OF_NODE * number);
            whole.watch.check()?;
            let picture = self.known_picture(&whole, &window, index);
            let picture = picture.map_err(|error| whole.watch.reason(self.within(index, error)))?;
            whole.pictures[index] = Some(picture);
        }
        Ok(whole)
    }

    /// Renders a node at the pixels of the tile, or of a region of it. The node may be one that the material does not
    /// use.
    ///
    /// # Errors
    ///
    /// [`UnknownNode`](RecipeErrorKind::UnknownNode) if there is no such node, or the same errors as
    /// [`whole`](Self::whole) and [`Bake::new`](crate::Bake::new).
    pub fn node_picture(
        &self,
        node: &str,
        size: [u32; 2],
        region: Option<Region>,
    ) -> Result<Picture, RecipeError> {
        let step = self.step_of(node)?;
        let tile = self.tile_samples(size, Samples::Centers)?;
        let window = match region {
            None => tile.window,
            Some(region) => region.of(&tile.window)?,
        };
        let whole = self.whole_of(&tile, &[step], self.watch())?;
        whole.watch.begin(Pass::Rows, window.size[1] as usize);
        let values = self.values(&whole, &window, &[step], &[])?;
        values.into_iter().next().map_or_else(
            || Err(RecipeError::new(RecipeErrorKind::Global { during: "yet" })),
            |values| values.picture(window.size),
        )
    }

    /// Returns the image of a step's values; from the cache if it is stored there.
    fn known_picture(
        &self,
        whole: &Whole,
        window: &Window,
        index: usize,
    ) -> Result<Picture, RecipeError> {
        let Step::Global(step) = &self.steps()[index] else {
            // A neighborhood is cached like all steps that are evaluated in windows.
            let values = self.values(whole, window, &[index], &[])?;
            let values = values.into_iter().next();
            return values
                .unwrap_or(Values::Numbers(Vec::new()))
                .picture(window.size);
        };
        let Some(cache) = &self.cache else {
            return self.picture(whole, window, step)?.picture(window.size);
        };
        let values = match cache.values(self.ids[index], window) {
            Some(values) => values,
            None => {
                let values = Arc::new(self.picture(whole, window, step)?);
                cache.keep(self.ids[index], window, values.clone());
                values
            }
        };
        Values::clone(&values).picture(window.size)
    }

    /// Computes the image of a step that depends on the whole tile.
    fn picture(
        &self,
        whole: &Whole,
        window: &Window,
        step: &Global,
    ) -> Result<Values, RecipeError> {
        let of_inputs = step.window_of_inputs(window)?;
        let made = self.values(whole, &of_inputs, &step.inputs, &[])?;
        whole.watch.check()?;
        (step.apply)(&Tile {
            inputs: &made.iter().collect::<Vec<_>>(),
            input_size: of_inputs.size,
            window,
            watch: &whole.watch,
        })
    }
}

impl Values {
    /// Converts the values to an image of `size` columns and rows.
    fn picture(self, size: [u32; 2]) -> Result<Picture, RecipeError> {
        Ok(match self {
            Self::Numbers(numbers) => Picture::Numbers(Arc::new(Raster::from_vec(size, numbers)?)),
            Self::Colors(colors) => Picture::Colors(Arc::new(Raster::from_vec(size, colors)?)),
        })
    }
}

impl Global {
    /// Returns the window in which the inputs are evaluated: the tile, or a single copy if the step repeats its inputs
    /// in the tile.
    fn window_of_inputs(&self, window: &Window) -> Result<Window, RecipeError> {
        let mut size = window.size;
        for (side, copies) in size.iter_mut().zip(self.copies) {
            let pixels = f64::from(*side) / f64::from(copies);
            let what = "number of pixels along a side of a copy";
            let range = "a whole number (size of the bake over copies)";
            RecipeError::check(pixels.fract() == 0.0, what, pixels, range)?;
            *side /= copies;
        }
        let times = |part: [f64; 2]| [0, 1].map(|axis| part[axis] * f64::from(self.copies[axis]));
        Ok(Window {
            origin: times(window.origin),
            pixel: times(window.pixel),
            size,
            ..*window
        })
    }
}

impl Whole {
    /// Returns the values of a step at `places`, from its image. Values at pixel centers are exact; other positions are
    /// interpolated.
    pub(super) fn at(&self, index: usize, places: Places<'_>) -> Result<Values, RecipeError> {
        let (Some(tile), Some(Some(picture))) = (self.window, self.pictures.get(index)) else {
            return Err(RecipeError::new(RecipeErrorKind::Global { during: "yet" }));
        };
        match places.at {
            At::Window(window)
                if (window.origin, window.pixel, window.scale)
                    == (tile.origin, tile.pixel, tile.scale) =>
            {
                Ok(match picture {
                    Picture::Numbers(raster) => Values::Numbers(self.pixels(raster, window)),
                    Picture::Colors(raster) => Values::Colors(self.pixels(raster, window)),
                })
            }
            _ => {
                let laid = StretchedImage {
                    picture: picture.clone(),
                    origin: tile.origin.into(),
                    extent: self.extent,
                    wrap: self.wrap,
                };
                Ok(laid.at(places))
            }
        }
    }

    /// Returns the pixels of `window` from an image of the tile. The window may extend past the tile.
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
