//! Strips of thumbnails that show the effect of edits, such as several values of one parameter.

use crate::picture::of_values;
use crate::render::{LIMITS, size_of};
use crate::{
    Document, Op, Output, Picture, RenderHost, Renderer, Shown, StudioError, apply, sample,
};
use dapple::recipe::Plan;
use std::sync::Arc;

/// Maximum number of thumbnails in a strip.
pub(crate) const MOST: usize = 12;
/// Maximum side of a thumbnail, in pixels.
const MAX_SIDE: u32 = 128;

/// One thumbnail of a strip.
#[derive(Clone, Debug)]
pub struct Variant {
    /// The document before the edits.
    pub document: Arc<Document>,
    /// The edits that the thumbnail shows.
    pub changes: Vec<Op>,
    /// The node to show. Default: the lit material.
    pub node: Option<String>,
    /// Phase of the looping animation, from 0 to 1.
    pub time: f64,
    /// The index of the thumbnail in the strip.
    pub index: u16,
    /// The longer side of the thumbnail, in pixels.
    pub side: u32,
}

impl Renderer {
    /// Renders and sends a thumbnail of a strip. If the edits give an invalid recipe, nothing is sent.
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
        let plan = Plan::new_with_cache(recipe, &images, variant.time, &LIMITS, &self.cache)?;
        let size = size_of(recipe.extent, side);
        let (pixels, _) = of_values(&plan.node_picture(node, size, None)?);
        Ok((size, pixels))
    }
}
