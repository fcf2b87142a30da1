//! Recipes as plain data, independent of their text format.

use crate::{Input, Node};
use dapple_color::NormalY;
use dapple_hash::Seed;
use indexmap::IndexMap;
use serde::{Deserialize, Serialize};

/// The schema version that this crate reads and writes.
pub const SCHEMA: u32 = 1;

/// A texture as data: named nodes, and the material that is made of them.
///
/// Lengths are in units of the plane: the tile is [`extent`](Self::extent) units wide and high, from the origin. Nodes are
/// in any order. Every node that needs chance takes it from the recipe's seed and its own name, so that moving or adding
/// nodes changes no other.
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
    /// The version of the schema: [`SCHEMA`].
    #[cfg_attr(feature = "schema", schemars(extend("const" = SCHEMA)))]
    pub dapple: u32,
    /// The name, which the baked files have.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub name: String,
    /// A sentence about the recipe.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub about: String,
    /// The seed of all random numbers; 0 by default.
    #[serde(default)]
    #[cfg_attr(feature = "schema", schemars(with = "u64"))]
    pub seed: Seed,
    /// The width and height of the tile, in units of the plane; 1 × 1 by default.
    #[serde(default = "default_extent")]
    #[cfg_attr(feature = "schema", schemars(transform = { crate::plan::EXTENT }))]
    pub extent: [f64; 2],
    /// The axes along which the tile repeats, x first; both by default.
    #[serde(default = "default_wrap")]
    pub wrap: [bool; 2],
    /// The nodes by name.
    #[serde(default)]
    #[cfg_attr(
        feature = "schema",
        schemars(with = "std::collections::BTreeMap<String, Node>")
    )]
    pub nodes: IndexMap<String, Node>,
    /// The inputs of the maps.
    pub material: Material,
}

fn default_extent() -> [f64; 2] {
    [1.0; 2]
}

fn default_wrap() -> [bool; 2] {
    [true; 2]
}

/// The inputs of the maps of a recipe.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(default, deny_unknown_fields)]
pub struct Material {
    /// The height, from 0 to 1; ½ by default. Files with whole numbers clamp it to this range.
    pub height: Input,
    /// The relief: the height in units of the plane of a value of 1, from -1e6 to 1e6; 0.1 by default.
    #[cfg_attr(feature = "schema", schemars(transform = { crate::plan::RELIEF }))]
    pub relief: f64,
    /// The color; the height as a gray by default.
    #[serde(alias = "basecolor", alias = "base_color")]
    pub albedo: Option<Input>,
    /// The roughness, from 0, a mirror, to 1, chalk; 0.8 by default.
    pub roughness: Input,
    /// The metalness, from 0, no metal, to 1, all metal; 0 by default.
    pub metallic: Input,
    /// The direction of the green channel of normals; up, as in OpenGL, by default.
    pub normal_y: NormalY,
    /// The radius of ambient occlusion, in units of the plane; a twentieth of the tile's shorter side by default.
    pub occlusion_radius: Option<f64>,
    /// The radius of curvature maps, in units of the plane; a hundredth of the tile's shorter side by default.
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
            normal_y: NormalY::OpenGl,
            occlusion_radius: None,
            curvature_radius: None,
        }
    }
}

impl Recipe {
    /// Creates a recipe with a single node, called `name`, as the material's height. It is for commands that render a
    /// single field.
    #[must_use]
    pub fn of_node(name: &str, node: Node, seed: Seed) -> Self {
        Self {
            dapple: SCHEMA,
            name: name.to_owned(),
            about: String::new(),
            seed,
            extent: default_extent(),
            wrap: default_wrap(),
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
