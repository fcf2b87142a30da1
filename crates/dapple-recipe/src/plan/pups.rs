//! The textures of `dapple-pups` over the tile of a recipe.

use super::Picture;
use super::generate::Generator;
use super::step::Step;
use crate::{Cells, ControlPoints, PupsNode, RecipeError, RecipeErrorKind};
use dapple_hash::Seed;
use dapple_points::{Domain, PointSet};
use dapple_pups::graph::delaunay;
use dapple_pups::{
    LabelRampOptions, LabelTexture, Orientation, Orientations, ProgressionOptions, Pups,
    PupsOptions, ReferenceImage, cells, cellular_noise, color_noise, cow, cow_progression,
    giraffe_progression, iterated_reference, label_ramp, noise, octaves, own_labels,
    reference_texture, space_giraffe, turbulence,
};
use dapple_raster::Field;
use glam::{DVec2, DVec3};
use std::sync::Arc;

/// The options with the tile as their domain, unless they have one of their own, which a recipe must not.
macro_rules! over {
    ($domain:expr, $usual:expr, $options:expr) => {{
        let mut options = $options.clone();
        check_domain(options.domain, $usual)?;
        options.domain = $domain;
        options
    }};
}

impl Generator<'_> {
    pub(super) fn pups(&self, name: &str, node: &PupsNode) -> Result<Step, RecipeError> {
        let seed = self.seed(name, None);
        let (tile, torus) = (self.domain(), Domain::paper_torus());
        let field: Arc<dyn Field> = match node {
            PupsNode::Noise(options) => Arc::new(noise(&over!(tile, torus, options), seed)?),
            PupsNode::Octaves(options) => {
                Arc::new(octaves(&over!(tile, torus, options), seed)?.normalized())
            }
            PupsNode::Turbulence(options) => {
                Arc::new(turbulence(&over!(tile, torus, options), seed)?.normalized())
            }
            PupsNode::Cells(options) => Arc::new(cells(&over!(tile, torus, options), seed)?),
            PupsNode::CellularNoise(options) => {
                Arc::new(cellular_noise(&over!(tile, torus, options), seed)?.normalized())
            }
            PupsNode::ColorNoise(options) => {
                let texture = color_noise(&over!(tile, torus, options), seed)?;
                return Ok(Step::ColorNoise(Box::new(texture)));
            }
            PupsNode::Cow(options) => Arc::new(cow(&over!(tile, torus, options), seed)?),
            PupsNode::SpaceGiraffe(options) => {
                Arc::new(space_giraffe(&over!(tile, torus, options), seed)?)
            }
            PupsNode::CowProgression(options) => {
                let usual = ProgressionOptions::default().domain;
                Arc::new(cow_progression(&over!(self.strip(), usual, options), seed)?)
            }
            PupsNode::GiraffeProgression(options) => {
                let usual = ProgressionOptions::default().domain;
                Arc::new(giraffe_progression(
                    &over!(self.strip(), usual, options),
                    seed,
                )?)
            }
            PupsNode::LabelRamp(options) => {
                let usual = LabelRampOptions::default().domain;
                Arc::new(label_ramp(&over!(self.strip(), usual, options), seed)?)
            }
            PupsNode::Reference(node) => {
                let image = self.reference(&node.file)?;
                Arc::new(reference_texture(
                    &image,
                    &over!(tile, torus, node.options),
                    seed,
                )?)
            }
            PupsNode::IteratedReference(node) => {
                let image = self.reference(&node.file)?;
                let mut rounds =
                    iterated_reference(&image, &over!(tile, torus, node.options), seed)?;
                Arc::new(rounds.swap_remove(rounds.len() - 1))
            }
            PupsNode::Points(points) => self.control_points(points, seed)?,
        };
        Ok(Step::Field(field))
    }

    /// An image for a texture to follow.
    fn reference(&self, file: &str) -> Result<ReferenceImage, RecipeError> {
        Ok(ReferenceImage::new(match self.image(file)? {
            Picture::Numbers(raster) => raster.as_ref().clone(),
            Picture::Colors(raster) => raster.map(|color| color.luminance()),
        })?)
    }

    /// The tile without its repeat along x, for what changes from the left to the right.
    pub(super) fn strip(&self) -> Domain {
        let tile = self.domain();
        Domain {
            wrap: [false, tile.wrap[1]],
            ..tile
        }
    }

    fn control_points(
        &self,
        node: &ControlPoints,
        seed: Seed,
    ) -> Result<Arc<dyn Field>, RecipeError> {
        let positions = node
            .points
            .iter()
            .map(|point| DVec2::new(point.x, point.y))
            .collect();
        let points =
            PointSet::new(self.domain(), positions).map_err(dapple_pups::PupsError::from)?;
        let values: Vec<f32> = node.points.iter().map(|point| point.value).collect();
        let pups = match orientations(node)? {
            Some(vectors) => {
                let options = PupsOptions {
                    axis_scale: node.net.axis_scale,
                    weight: node.net.weight,
                    orientation: Some(Orientation::new(vectors).with_strength(node.net.strength)),
                };
                Pups::new(
                    &points,
                    &delaunay(&points).map_err(dapple_pups::PupsError::from)?,
                    options,
                )?
            }
            None => node.net.pups(&points, seed)?,
        };
        Ok(match node.cells {
            Cells::Mixed => Arc::new(pups.texture(values)?),
            Cells::Hard => Arc::new(LabelTexture::new(pups, own_labels(values.len()), values)?),
        })
    }
}

fn check_domain(domain: Domain, usual: Domain) -> Result<(), RecipeError> {
    if domain == usual {
        return Ok(());
    }
    let rule = "the `domain` of a texture in a recipe is the tile; leave it out, and give the recipe an `extent` and a `wrap`";
    Err(RecipeError::new(RecipeErrorKind::Conflict { rule }))
}

/// The orientations that the points have, if they have any.
fn orientations(node: &ControlPoints) -> Result<Option<Vec<DVec3>>, RecipeError> {
    let given: Vec<_> = node
        .points
        .iter()
        .filter_map(|point| point.orientation)
        .collect();
    let conflict = |rule| Err(RecipeError::new(RecipeErrorKind::Conflict { rule }));
    if given.is_empty() {
        return Ok(None);
    }
    if given.len() != node.points.len() {
        return conflict("all points have an `orientation`, or none has");
    }
    if !matches!(node.net.orientations, Orientations::None) {
        return conflict("`orientations` are not given where the points have them");
    }
    Ok(Some(
        given
            .into_iter()
            .map(|[x, y]| DVec3::new(x, y, 0.0))
            .collect(),
    ))
}
