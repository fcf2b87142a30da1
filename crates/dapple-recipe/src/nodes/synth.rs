//! Synthesizes textures from example images.

use super::{ImageAlpha, NodeKind, NodeSeed};
use crate::RecipeError;
use crate::plan::{Builder, OF_NODE, Picture, Step, StretchedImage, Watch, Work};
use core::ops::ControlFlow;
use dapple_raster::{Range, range};
use dapple_synth::{Edges, Endless, EndlessOptions, Exemplar, PlaneTexture};
use serde::{Deserialize, Serialize};
use std::sync::Arc;

/// Texture without repetitions, synthesized from an example image and stretched over the tile.
///
/// The texture is interpolated between its pixels, or averaged over each pixel of a smaller bake. Along axes on which
/// the recipe repeats, the texture repeats with the tile.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct SynthNode {
    /// Name of the image file whose pixels the texture shows, relative to the folder of the recipe.
    pub file: String,
    /// Name of the image file in which neighborhoods are compared [default: `file`].
    ///
    /// Nodes with the same example synthesize matching maps of one material. `file` must be the same size as the
    /// example, or a whole number of times as large. The size, levels, edges and seed of these nodes must be equal.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub example: Option<String>,
    /// Size of the texture across the tile, in pixels of the example, x first. Along axes on which the recipe repeats,
    /// the size must be a multiple of 2 to the power of `levels`.
    #[serde(default = "size")]
    #[cfg_attr(feature = "schema", schemars(transform = { SIZE }))]
    pub size: [u32; 2],
    /// Number of pyramid levels, from 1 to 16 [default: the maximum for the size of the example, such as 7 for 256
    /// pixels].
    ///
    /// More levels preserve larger features of the example.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[cfg_attr(feature = "schema", schemars(transform = { LEVELS }))]
    pub levels: Option<u32>,
    /// Content past the edges of the example: nothing, or the image again, as for a tile.
    #[serde(default)]
    pub edges: Edges,
    /// Conversion of images with alpha to opaque ones [default: a partly transparent image is an error].
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub alpha: Option<ImageAlpha>,
    /// Seed, or the name of the node whose random numbers are used [default: this node's name].
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub seed: Option<NodeSeed>,
}

const SIZE: Range = range!(at least 1);
const LEVELS: Range = range!(from 1 to 16);

fn size() -> [u32; 2] {
    [512; 2]
}

impl NodeKind for SynthNode {
    fn images(&self) -> Vec<&str> {
        [&self.file]
            .into_iter()
            .chain(&self.example)
            .map(String::as_str)
            .collect()
    }

    fn alpha(&self) -> Option<ImageAlpha> {
        self.alpha
    }

    fn work(&self, plan: &Builder<'_>) -> Result<Work, RecipeError> {
        let [shown, example] = [plan.image(&self.file)?, plan.image(self.example())?];
        let sides = [0, 1].map(|axis| {
            let scale = f64::from(shown.size()[axis]) / f64::from(example.size()[axis]);
            f64::from(self.size[axis]) * scale.max(1.0)
        });
        Ok(Work {
            synthesized_pixels: sides[0] * sides[1],
            ..Work::default()
        })
    }

    fn build(&self, plan: &mut Builder<'_>) -> Result<Step, RecipeError> {
        for pixels in self.size {
            RecipeError::check_in(SIZE, "number of pixels along a side", pixels.into())?;
        }
        if let Some(levels) = self.levels {
            RecipeError::check_in(LEVELS, "number of levels", levels.into())?;
        }
        // Reuse a texture with equal options: other nodes may transfer other maps of the same example.
        let repeats = plan.domain().wrap;
        let options = EndlessOptions {
            seed: plan.seed(self.seed.as_ref()),
            n_levels: self.levels,
            period: [0, 1].map(|axis| repeats[axis].then_some(self.size[axis])),
        };
        let example = plan.image(self.example())?;
        let grown = plan.parts().get_or_make(
            |grown: &Grown| {
                let is_alike = grown.options == options && grown.edges == self.edges;
                is_alike && grown.texture.sources().size() == self.size && grown.example == *example
            },
            || {
                Grown::new(
                    example,
                    self.edges,
                    options.clone(),
                    self.size,
                    plan.watch(),
                )
            },
        )?;
        let picture = match plan.image(&self.file)? {
            Picture::Numbers(numbers) => {
                Picture::Numbers(Arc::new(grown.texture.transfer(numbers)?))
            }
            Picture::Colors(colors) => Picture::Colors(Arc::new(grown.texture.transfer(colors)?)),
        };
        Ok(Step::Image(StretchedImage {
            picture,
            origin: plan.domain().origin,
            extent: plan.domain().size,
            wrap: plan.wrap(),
        }))
    }
}

impl SynthNode {
    /// Returns the name of the image file in which neighborhoods are compared.
    fn example(&self) -> &str {
        self.example.as_ref().unwrap_or(&self.file)
    }
}

/// A synthesized texture and the inputs that determine it, stored for reuse.
struct Grown {
    example: Picture,
    edges: Edges,
    options: EndlessOptions,
    texture: PlaneTexture,
}

impl Grown {
    fn new(
        example: &Picture,
        edges: Edges,
        options: EndlessOptions,
        size: [u32; 2],
        watch: &Watch,
    ) -> Result<Self, RecipeError> {
        let exemplar = match example {
            Picture::Numbers(numbers) => Exemplar::from_planes(&[(numbers, 1.0)], edges)?,
            Picture::Colors(colors) => Exemplar::new(colors, edges)?,
        };
        let endless = Endless::new_cancellable(&exemplar, &options, &|| watch.is_cancelled())?;
        // Preparing the example is about half of the work. Report progress for the other half.
        let half = OF_NODE / 2;
        let prepared = watch.done() + half;
        let texture = endless.window([0; 2], size, |progress| {
            watch.reach(prepared + (progress.part() * half as f64) as usize);
            match watch.is_cancelled() {
                true => ControlFlow::Break(()),
                false => ControlFlow::Continue(()),
            }
        })?;
        Ok(Self {
            example: example.clone(),
            edges,
            options,
            texture,
        })
    }
}
