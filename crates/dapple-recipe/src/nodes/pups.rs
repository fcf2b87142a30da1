//! The textures of `dapple-pups` as nodes, with the recipe's tile as their domain.

use super::{ImageAlpha, NodeKind};
use crate::plan::{Builder, Images, Picture, PlanLimits, Step, TIME, Watch, Work};
use crate::shader::{Code, NodeShader, Refusal, literal};
use crate::{Recipe, RecipeError, RecipeErrorKind};
use dapple_points::Domain;
use dapple_pups::{
    ControlNet, ControlPoints, Folding, PupsField, PupsRecipe, ReferenceImage, ShaderLayers,
};
use dapple_wgsl::Module;
use serde::{Deserialize, Serialize};

/// Texture guided by an image that covers the tile.
///
/// Only the luminance of a color image is used.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
#[cfg_attr(
    feature = "schema",
    derive(schemars::JsonSchema),
    schemars(bound = "T: schemars::JsonSchema + Default + Serialize")
)]
#[serde(
    deny_unknown_fields,
    bound(deserialize = "T: Default + Deserialize<'de>")
)]
pub struct Referenced<T> {
    /// Name of the image file, relative to the folder of the recipe.
    pub file: String,
    /// Conversion of an image with alpha to an opaque one [default: a partly transparent image is an error].
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub alpha: Option<ImageAlpha>,
    /// Options of the texture.
    #[serde(default)]
    pub options: T,
}

/// Builds a texture of `dapple-pups` for a node.
pub(crate) trait Texture {
    /// Returns the image file that guides the texture, and how its alpha is used.
    fn image(&self) -> Option<(&str, Option<ImageAlpha>)> {
        None
    }

    /// Returns whether the texture's values are colors rather than scalars.
    fn is_color(&self) -> bool;

    /// Returns the estimated number of control points of the texture on a tile.
    fn expected_points(&self, tile: Domain) -> f64;

    /// Builds the texture on a plan's tile.
    fn build(&self, plan: &Builder<'_>) -> Result<PupsField, RecipeError>;
}

impl<T: PupsRecipe> Texture for T {
    fn is_color(&self) -> bool {
        T::IS_COLOR
    }

    fn expected_points(&self, tile: Domain) -> f64 {
        placed(self, tile).expected_points()
    }

    fn build(&self, plan: &Builder<'_>) -> Result<PupsField, RecipeError> {
        check_domain(self)?;
        Ok(now(self, plan).build(&(), plan.seed(None))?)
    }
}

impl<T: PupsRecipe<ReferenceImage>> Texture for Referenced<T> {
    fn image(&self) -> Option<(&str, Option<ImageAlpha>)> {
        Some((&self.file, self.alpha))
    }

    fn is_color(&self) -> bool {
        T::IS_COLOR
    }

    fn expected_points(&self, tile: Domain) -> f64 {
        placed(&self.options, tile).expected_points()
    }

    fn build(&self, plan: &Builder<'_>) -> Result<PupsField, RecipeError> {
        let image = ReferenceImage::new(match plan.image(&self.file)? {
            Picture::Numbers(raster) => raster.as_ref().clone(),
            Picture::Colors(raster) => raster.map(|color| color.luminance()),
        })?;
        check_domain(&self.options)?;
        Ok(now(&self.options, plan).build(&image, plan.seed(None))?)
    }
}

/// Returns a texture's options with the plan's tile, reusable parts, progress callback and, if the points move, time.
fn now<T: PupsRecipe<Image>, Image>(options: &T, plan: &Builder<'_>) -> T {
    let mut options = placed(options, plan.domain());
    let net = options.net_mut();
    net.parts = plan.parts().clone();
    net.cancel = plan.watch().cancel();
    if net.motion.is_some() {
        net.time = plan.time();
    }
    options
}

/// Sets the domain of a texture's options to the tile. The domain does not wrap along axes along which the default
/// domain of the texture does not wrap, even if the tile does.
fn placed<T: PupsRecipe<Image>, Image>(options: &T, tile: Domain) -> T {
    let usual = T::default().domain_mut().wrap;
    let mut options = options.clone();
    *options.domain_mut() = Domain {
        wrap: [0, 1].map(|axis| tile.wrap[axis] && usual[axis]),
        ..tile
    };
    options
}

/// Returns an error if the options set a domain, which is always the recipe's tile.
fn check_domain<T: PupsRecipe<Image>, Image>(options: &T) -> Result<(), RecipeError> {
    if options.clone().domain_mut() == T::default().domain_mut() {
        return Ok(());
    }
    let rule = "the `domain` of a texture in a recipe is the tile; leave it out, and give the recipe an `extent` and a `wrap`";
    Err(RecipeError::new(RecipeErrorKind::Conflict { rule }))
}

/// Defines the enum of the textures in the table of `dapple-pups`.
macro_rules! node {
    ($(#[doc = $about:literal] $name:literal $variant:ident($options:ty),)*) => {
        /// Partition-of-unity texture: one of the recipes of `dapple-pups`.
        ///
        /// The domain of the texture is the recipe's tile and must not be set.
        #[derive(Clone, Debug, Serialize, Deserialize)]
        #[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
        #[non_exhaustive]
        pub enum PupsNode {
            $(#[doc = $about] #[serde(rename = $name)] $variant($options),)*
        }

        impl PupsNode {
            /// The names of the textures, as recipes write them, with a sentence about each.
            pub const KINDS: [(&str, &str); [$($name),*].len()] = [$(($name, $about.trim_ascii())),*];

            /// Returns the texture called `name`, with default options. Required options are empty.
            #[must_use]
            pub fn of_kind(name: &str) -> Option<Self> {
                match name {
                    $($name => Some(Self::$variant(Default::default())),)*
                    _ => None,
                }
            }

            fn texture(&self) -> &dyn Texture {
                match self {
                    $(Self::$variant(options) => options,)*
                }
            }
        }
    };
}

dapple_pups::recipes!(node);

impl PupsNode {
    /// Returns whether the texture's values are colors rather than scalars.
    #[must_use]
    pub fn is_color(&self) -> bool {
        self.texture().is_color()
    }

    /// Returns the image file that guides the texture, if any.
    #[must_use]
    pub fn image_file(&self) -> Option<&str> {
        Some(self.texture().image()?.0)
    }
}

/// The control points of a `pups` node.
#[derive(Clone, Debug)]
pub struct ControlNets {
    /// The control net of each layer, coarsest first. A texture without layers has one net.
    pub nets: Vec<ControlNet>,
    /// The options of the `points` texture that equals this texture bit for bit; `None` if there is no such texture.
    pub points: Option<ControlPoints>,
}

impl Recipe {
    /// Returns the control points of the `pups` node with this name; `None` if the recipe has no such node.
    ///
    /// A texture with one layer of numbers can be converted to a `points` texture. This holds for all textures except
    /// `octaves`, `turbulence` and `cellular_noise`, which have layers, and `color_noise`.
    ///
    /// # Errors
    ///
    /// If [`Plan::new_within`](crate::Plan::new_within) fails because of this node.
    ///
    /// # Examples
    ///
    /// ```
    /// use dapple_recipe::{Images, PlanLimits, Recipe};
    ///
    /// let text = "dapple = 1\n[nodes.hide.pups.cow]\nspacing = 0.2\n[material]\nheight = \"hide\"\n";
    /// let recipe = Recipe::from_toml(text)?;
    /// let nets = recipe.control_nets("hide", &Images::new(), 0.0, &PlanLimits::default())?;
    /// let points = nets.and_then(|nets| nets.points).expect("a cow is one net of numbers");
    /// assert!(points.points.iter().all(|point| point.label.is_some()), "white or black");
    /// # Ok::<(), dapple_recipe::RecipeError>(())
    /// ```
    pub fn control_nets(
        &self,
        node: &str,
        images: &Images,
        time: f64,
        limits: &PlanLimits,
    ) -> Result<Option<ControlNets>, RecipeError> {
        RecipeError::check_in(TIME, "time", time)?;
        let Some((name, node)) = self.nodes.get_key_value(node) else {
            return Ok(None);
        };
        let Some(texture) = node.kind().pups() else {
            return Ok(None);
        };
        let watch = Watch::default();
        let mut builder = Builder::new(self, images, time, limits, None, &watch);
        let field = builder
            .enter(name, node)
            .and_then(|()| texture.build(&builder))
            .map_err(|error| error.within(name))?;
        let points = field.to_points(builder.domain());
        Ok(Some(ControlNets {
            nets: field.nets(),
            points: points.map(|points| ControlPoints {
                // The domain of a texture in a recipe is the tile, and must not be set.
                domain: ControlPoints::default().domain,
                ..points
            }),
        }))
    }
}

impl NodeKind for PupsNode {
    fn images(&self) -> Vec<&str> {
        self.image_file().into_iter().collect()
    }

    fn alpha(&self) -> Option<ImageAlpha> {
        self.texture().image()?.1
    }

    fn work(&self, plan: &Builder<'_>) -> Result<Work, RecipeError> {
        Ok(Work {
            control_points: self.texture().expected_points(plan.domain()),
            ..Work::default()
        })
    }

    fn pups(&self) -> Option<&dyn Texture> {
        Some(self.texture())
    }

    fn build(&self, plan: &mut Builder<'_>) -> Result<Step, RecipeError> {
        Ok(match self.texture().build(plan)? {
            PupsField::Numbers(field) => Step::Field(field),
            PupsField::Colors(texture) => Step::Colors(texture.into()),
        })
    }

    fn shader(&self, shader: &mut NodeShader<'_, '_>) -> Result<Code, Refusal> {
        match shader.build(|plan| self.texture().build(plan))? {
            PupsField::Numbers(field) => code(shader, &field.shader_layers()),
            PupsField::Colors(_) => Err(Refusal::new("colors of control points have no shader")),
        }
    }
}

/// Writes WGSL for a PUPs texture, and adds its control points to the shader's `data` texture.
pub(crate) fn code(
    shader: &mut NodeShader<'_, '_>,
    texture: &ShaderLayers,
) -> Result<Code, Refusal> {
    shader.needs(Module::Pups2d);
    let mut layers = Vec::new();
    for layer in &texture.layers {
        let first = shader.data(&layer.words)?;
        let folded = u32::from(layer.folding == Folding::Folded);
        // A scale is a power of two.
        let exponent = (layer.scale as u64).trailing_zeros();
        layers.extend([first as u32, layer.amplitude.to_bits(), folded, exponent]);
    }
    let at = shader.position([1.0; 2]);
    let Some(maximum) = texture.maximum else {
        let first = layers[0];
        let place = format!("pups_position(data, {first}u, {at})");
        return Ok(Code::number(format!(
            "pups_value(data, {first}u, {place}, zero)"
        )));
    };
    let count = texture.layers.len();
    let first = shader.data(&layers)?;
    let sum = format!("pups_sum(data, {first}u, {count}u, {at}, zero)");
    // Rounding may make a sum larger than the maximum.
    let maximum = literal(maximum);
    Ok(Code::number(format!("number_min({sum}, {maximum}, zero)")))
}
