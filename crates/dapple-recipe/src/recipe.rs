//! Recipes as plain data, independent of their text format.

use crate::{Input, MapKind, Node, Parameters};
use dapple_color::NormalY;
use dapple_hash::Seed;
use indexmap::IndexMap;
use serde::{Deserialize, Serialize};

/// The schema version that this crate reads and writes.
pub const SCHEMA: u32 = 1;

/// A texture recipe: named nodes, and the material whose maps they compute.
///
/// Lengths are in units of the plane: the tile starts at the origin and is [`extent`](Self::extent) units wide and
/// high. Nodes may be in any order. The random numbers of a node depend on the recipe's seed and the node's name only,
/// so adding or moving nodes changes no other node.
///
/// # Examples
///
/// ```
/// use dapple_recipe::Recipe;
///
/// let recipe = Recipe::from_toml(
///     r#"
///     dapple = 1
///     seed = 7
///     extent = [8.0, 8.0]
///
///     [nodes.cells.worley]
///     value = "f2_minus_f1"
///
///     [nodes.stones.levels]
///     input = "cells"
///     from = [0.0, 0.3]
///
///     [material]
///     height = "stones"
///     "#,
/// )?;
/// assert_eq!(recipe.nodes.len(), 2);
/// # Ok::<(), dapple_recipe::RecipeError>(())
/// ```
#[derive(Clone, Debug, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Recipe {
    /// Schema version of the recipe.
    ///
    /// Always [`SCHEMA`].
    #[cfg_attr(feature = "schema", schemars(extend("const" = SCHEMA)))]
    pub dapple: u32,
    /// Name of the recipe, used in the names of baked files.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub name: String,
    /// Description of the recipe, in one sentence.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub about: String,
    /// Words for searches; the first one is the family, such as `wood`.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub tags: Vec<String>,
    /// Seed for the random numbers of all nodes.
    ///
    /// A node whose seed is a number does not depend on this seed.
    #[serde(default)]
    #[cfg_attr(feature = "schema", schemars(with = "u64"))]
    pub seed: Seed,
    /// Width and height of the tile, in units of the plane.
    #[serde(default = "default_extent")]
    #[cfg_attr(feature = "schema", schemars(transform = { crate::plan::EXTENT }))]
    pub extent: [f64; 2],
    /// Whether the tile repeats along each axis, x first.
    #[serde(default = "default_wrap")]
    pub wrap: [bool; 2],
    /// Named values that options share, written in an option as `"$name"`. The options have the values; the references
    /// are in the parameters.
    #[serde(skip)]
    pub parameters: Parameters,
    /// Nodes of the recipe, by name.
    #[serde(default)]
    #[cfg_attr(
        feature = "schema",
        schemars(with = "std::collections::BTreeMap<String, Node>")
    )]
    pub nodes: IndexMap<String, Node>,
    /// Inputs of the material's maps.
    pub material: Material,
}

fn default_extent() -> [f64; 2] {
    [1.0; 2]
}

fn default_wrap() -> [bool; 2] {
    [true; 2]
}

/// Inputs of a recipe's maps.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(default, deny_unknown_fields)]
pub struct Material {
    /// Height, from 0 to 1.
    ///
    /// Integer file formats clamp heights to this range.
    pub height: Input,
    /// Relief: the height of a value of 1, in units of the plane, from -1e6 to 1e6.
    #[cfg_attr(feature = "schema", schemars(transform = { crate::plan::RELIEF }))]
    pub relief: f64,
    /// Base color [default: the height as a gray].
    #[serde(alias = "basecolor", alias = "base_color")]
    pub albedo: Option<Input>,
    /// Roughness, from 0 (a mirror) to 1 (chalk).
    pub roughness: Input,
    /// Metalness, from 0 (no metal) to 1 (pure metal).
    pub metallic: Input,
    /// Emitted light, as a color [default: none].
    #[serde(skip_serializing_if = "Option::is_none")]
    pub emission: Option<Input>,
    /// Factor of the emitted light, from 0 to 1e6 [default: 1].
    #[serde(skip_serializing_if = "Option::is_none")]
    #[cfg_attr(feature = "schema", schemars(transform = { crate::plan::EMISSION }))]
    pub emission_strength: Option<f64>,
    /// Opacity, from 0 (transparent) to 1 (opaque) [default: opaque].
    #[serde(skip_serializing_if = "Option::is_none")]
    pub opacity: Option<Input>,
    /// Cut-off of the opacity, from 0 to 1: pixels are opaque at and above it, and transparent below [default: opacity
    /// blends with the background].
    #[serde(skip_serializing_if = "Option::is_none")]
    #[cfg_attr(feature = "schema", schemars(transform = { crate::plan::UNIT }))]
    pub opacity_cutoff: Option<f64>,
    /// Strength of the specular reflection of nonmetals, from 0 (none) to 1 (index of refraction 1.5) [default: 1].
    #[serde(skip_serializing_if = "Option::is_none")]
    pub specular: Option<Input>,
    /// Strength of a clear coat, such as varnish, from 0 (none) to 1 [default: none].
    #[serde(skip_serializing_if = "Option::is_none")]
    pub clearcoat: Option<Input>,
    /// Roughness of the clear coat, from 0 to 1 [default: 0.03].
    #[serde(skip_serializing_if = "Option::is_none")]
    #[cfg_attr(feature = "schema", schemars(transform = { crate::plan::UNIT }))]
    pub clearcoat_roughness: Option<f64>,
    /// Direction of the green channel of normal maps: up, as in OpenGL, or down, as in DirectX.
    pub normal_y: NormalY,
    /// Radius of ambient occlusion, in units of the plane [default: 1/20 of the tile's shorter side].
    pub occlusion_radius: Option<f64>,
    /// Radius of curvature maps, in units of the plane [default: 1/100 of the tile's shorter side].
    pub curvature_radius: Option<f64>,
}

impl Default for Material {
    fn default() -> Self {
        Self {
            height: Input::Number(0.5),
            relief: 0.1,
            albedo: None,
            roughness: Input::Number(0.8),
            metallic: Input::Number(0.0),
            emission: None,
            emission_strength: None,
            opacity: None,
            opacity_cutoff: None,
            specular: None,
            clearcoat: None,
            clearcoat_roughness: None,
            normal_y: NormalY::OpenGl,
            occlusion_radius: None,
            curvature_radius: None,
        }
    }
}

impl Material {
    /// Returns whether the material has this map: whether it sets the emission, opacity, specular or clear coat; true
    /// for all other maps.
    #[must_use]
    pub fn has(&self, map: MapKind) -> bool {
        match map {
            MapKind::Emission => self.emission.is_some(),
            MapKind::Opacity => self.opacity.is_some(),
            MapKind::Specular => self.specular.is_some(),
            MapKind::Clearcoat => self.clearcoat.is_some(),
            _ => true,
        }
    }
}

impl Recipe {
    /// Creates a recipe whose height is a single node, called `name`. It is for commands that render one field.
    #[must_use]
    pub fn of_node(name: &str, node: Node, seed: Seed) -> Self {
        Self {
            dapple: SCHEMA,
            name: name.to_owned(),
            about: String::new(),
            tags: Vec::new(),
            seed,
            extent: default_extent(),
            wrap: default_wrap(),
            parameters: Parameters::default(),
            nodes: IndexMap::from([(name.to_owned(), node)]),
            material: Material {
                height: Input::from(name),
                ..Material::default()
            },
        }
    }

    /// Returns the shorter side of the tile, in units of the plane.
    #[must_use]
    pub fn shorter_side(&self) -> f64 {
        self.extent[0].min(self.extent[1])
    }
}
