//! Small pictures of what changes would make of a recipe, such as a row of values of one parameter.

use crate::picture::of_values;
use crate::render::{LIMITS, size_of};
use crate::{
    Document, Op, Output, Picture, RenderHost, Renderer, Shown, StudioError, apply, sample,
};
use dapple::recipe::Plan;
use std::sync::Arc;

/// The most pictures of a strip.
pub(crate) const MOST: usize = 12;
/// The longest side of a picture, in pixels.
const MAX_SIDE: u32 = 128;

/// A picture of a strip.
#[derive(Clone, Debug)]
pub struct Variant {
    /// The recipe, which stays as it is.
    pub document: Arc<Document>,
    /// The changes whose effect is shown.
    pub changes: Vec<Op>,
    /// The node that is shown; the material in light by default.
    pub node: Option<String>,
    /// The part of a loop that has passed, from 0 to 1.
    pub time: f64,
    /// The index of the picture.
    pub index: u16,
    /// Its longer side, in pixels.
    pub side: u32,
}

impl Renderer {
    /// Draws a picture of a strip. Changes that the recipe refuses have no picture.
    pub fn draw_variant(&self, variant: &Variant, world: &dyn RenderHost) {
        if let Ok((size, pixels)) = self.pixels(variant, world) {
            let shown = Shown::Strip(variant.index);
            world.put(Output::Picture(Picture::whole(shown, size, pixels)));
        }
    }

    fn pixels(
        &self,
        variant: &Variant,
        world: &dyn RenderHost,
    ) -> Result<([u32; 2], Vec<u8>), StudioError> {
        let document = Document::new(apply(variant.document.text(), &variant.changes)?);
        let recipe = document.recipe().map_err(Clone::clone)?;
        let images = world.images(recipe)?;
        let side = variant.side.clamp(1, MAX_SIDE);
        let Some(node) = &variant.node else {
            return sample::lit(recipe, &images, side);
        };
        let plan = Plan::new_with_cache(recipe, &images, variant.time, &LIMITS, &self.memory)?;
        let size = size_of(recipe.extent, side);
        let (pixels, _) = of_values(&plan.node_picture(node, size, None)?);
        Ok((size, pixels))
    }
}
