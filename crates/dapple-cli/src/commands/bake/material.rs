//! Defines the options for a material that `bake` and `shards` share: size, maps, seed, relief, and the direction of
//! green in normal maps.

use super::maps::Maps;
use super::seeds::Seeds;
use crate::args::{FiniteArgs, SamplesArgs, Size};
use crate::baking::advise;
use crate::error::{Hint, usage};
use crate::words::NamedValueParser;
use anyhow::{Error, Result};
use dapple::color::NormalY;
use dapple::hash::Seed;
use dapple::raster::Named;
use dapple::recipe::{MapKind, Material, Recipe, RecipeError, RecipeErrorKind};
use serde::Serialize;
use std::fmt;
use std::str::FromStr;

/// The maps that are baked by default for every material.
const USUAL: [MapKind; 5] = [
    MapKind::Height,
    MapKind::Normal,
    MapKind::Occlusion,
    MapKind::Albedo,
    MapKind::Roughness,
];

/// The maps that a material may lack.
const OPTIONAL: [MapKind; 4] = [
    MapKind::Emission,
    MapKind::Opacity,
    MapKind::Specular,
    MapKind::Clearcoat,
];

/// A replacement for a value in a recipe, given as `PATH=VALUE`.
#[derive(Clone, Debug, Serialize)]
#[serde(into = "String")]
pub(in crate::commands) struct Setting {
    path: String,
    value: String,
}

impl Setting {
    /// Replaces the value in a recipe.
    ///
    /// # Errors
    ///
    /// Same as [`Recipe::set`], reported as wrong usage.
    pub(in crate::commands) fn apply(&self, recipe: &mut Recipe) -> Result<()> {
        recipe.set(&self.path, &self.value).map_err(|error| {
            let refused = usage(format!("--set {self}: {error}"));
            // The message already names the nearest word, if there is one.
            match error.nearest() {
                Some(_) => refused,
                None => refused.hint("`dapple recipe --reference` lists the options of all nodes"),
            }
        })
    }
}

impl FromStr for Setting {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        match text.split_once('=') {
            Some((path, value)) if !path.is_empty() => Ok(Self {
                path: path.trim().to_owned(),
                value: value.trim().to_owned(),
            }),
            _ => Err(
                "it has the form NODE.OPTION=VALUE or PARAMETER=VALUE, as in stones.from=[0,0.3]"
                    .to_owned(),
            ),
        }
    }
}

impl fmt::Display for Setting {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}={}", self.path, self.value)
    }
}

impl From<Setting> for String {
    fn from(setting: Setting) -> Self {
        setting.to_string()
    }
}

#[expect(
    clippy::trivially_copy_pass_by_ref,
    reason = "serde passes a reference"
)]
fn is_one(number: &u32) -> bool {
    *number == 1
}

/// The size, the maps, and what replaces settings of the recipe.
#[derive(clap::Args, Clone, Debug, Serialize)]
pub(in crate::commands) struct MaterialArgs {
    /// Size of the tile in pixels.
    #[arg(long, value_name = "WxH", default_value = "1024")]
    pub(in crate::commands) size: Size,

    #[command(flatten)]
    #[serde(flatten)]
    pub(in crate::commands) samples: SamplesArgs,

    /// Samples per pixel along each axis, from 1 to 16, whose mean is the pixel: smooth edges of patterns.
    ///
    /// Heights are averaged before normals and occlusion are computed, and colors in linear light. The work grows with
    /// the square.
    #[arg(long, value_name = "K", default_value_t = 1, value_parser = clap::value_parser!(u32).range(1..=16))]
    #[serde(skip_serializing_if = "is_one")]
    pub(in crate::commands) supersample: u32,

    /// Comma-separated maps, or `all`.
    ///
    /// By default height, normal, ao, albedo, roughness, and those of emission, opacity, specular and clearcoat that the
    /// recipe sets.
    #[arg(long, value_name = "MAPS")]
    pub(super) maps: Option<Maps>,

    /// Replace a value of the recipe: a parameter, an option of a node, or a value such as `material.relief`; repeatable.
    #[arg(long, value_name = "PATH=VALUE")]
    set: Vec<Setting>,

    /// Random seed, or a range such as 1-20 for a variant with each seed [default: the recipe's].
    #[arg(long, value_name = "N[-M]")]
    seed: Option<Seeds>,

    /// Direction of green in normal maps [default: the preset's, the recipe's, or opengl].
    #[arg(long, value_name = "WAY", value_parser = NamedValueParser::<NormalY>::all())]
    pub(super) normal_y: Option<NormalY>,

    /// Height of the value 1 in units of the plane, from -1e6 to 1e6 [default: the recipe's].
    #[arg(long, value_name = "UNITS")]
    relief: Option<f64>,

    #[command(flatten)]
    #[serde(flatten)]
    pub(in crate::commands) finite: FiniteArgs,
}

impl MaterialArgs {
    /// Creates options that leave the recipe unchanged, except for the direction of green.
    pub(super) fn new(size: Size, maps: Option<Maps>, normal_y: Option<NormalY>) -> Self {
        Self {
            size,
            samples: SamplesArgs::default(),
            supersample: 1,
            maps,
            set: Vec::new(),
            seed: None,
            normal_y,
            relief: None,
            finite: FiniteArgs::default(),
        }
    }

    /// Returns the requested maps, or the default ones. By default, and for `all`, maps that the material lacks are left
    /// out.
    pub(in crate::commands) fn map_kinds(&self, material: &Material) -> Vec<MapKind> {
        match &self.maps {
            Some(maps) if !maps.are_all() => maps.0.clone(),
            maps => {
                let is_wanted = |kind: &MapKind| {
                    maps.is_some() || USUAL.contains(kind) || OPTIONAL.contains(kind)
                };
                let kinds = MapKind::ALL.into_iter().filter(is_wanted);
                kinds.filter(|&kind| material.has(kind)).collect()
            }
        }
    }

    /// Returns copies of the options with a single seed each, with the labels of the seeds; a single copy without a
    /// label unless `--seed` is a range.
    pub(super) fn variants(&self) -> Vec<(Option<String>, Self)> {
        match self.seed.filter(|seeds| seeds.are_several()) {
            None => vec![(None, self.clone())],
            Some(seeds) => {
                let variant = |seed| {
                    let one = Self {
                        seed: Some(Seeds::one(seed)),
                        ..self.clone()
                    };
                    (Some(seeds.label(seed)), one)
                };
                seeds.all().map(variant).collect()
            }
        }
    }

    /// Formats the number of samples per pixel as a command-line argument; `None` if it is 1.
    pub(in crate::commands) fn supersample_word(&self) -> Option<String> {
        let per_axis = self.supersample;
        (per_axis > 1).then(|| format!("--supersample={per_axis}"))
    }

    /// Refuses a range of seeds.
    ///
    /// # Errors
    ///
    /// If `--seed` is a range of several seeds.
    pub(in crate::commands) fn check_single(&self) -> Result<()> {
        match self.seed.filter(|seeds| seeds.are_several()) {
            None => Ok(()),
            Some(seeds) => Err(usage(format!(
                "--seed {seeds} is a range, and one seed is needed here"
            ))
            .hint("`dapple bake` takes a range, and bakes a variant with each seed")),
        }
    }

    /// Applies the options to a recipe. `normal_y` is the direction of green in the preset, which `--normal-y`
    /// overrides.
    ///
    /// # Errors
    ///
    /// If `--set` names a value that the recipe does not have, or gives it a value of the wrong type.
    pub(in crate::commands) fn change(
        &self,
        recipe: &mut Recipe,
        normal_y: Option<NormalY>,
    ) -> Result<()> {
        for setting in &self.set {
            setting.apply(recipe)?;
        }
        if let Some(seeds) = self.seed {
            recipe.seed = Seed(seeds.first);
        }
        if let Some(relief) = self.relief {
            recipe.material.relief = relief;
        }
        if let Some(normal_y) = self.normal_y.or(normal_y) {
            recipe.material.normal_y = normal_y;
        }
        Ok(())
    }

    /// Converts an error from a plan. An error about the value of `--relief` becomes a usage error.
    pub(in crate::commands) fn blame(&self, error: RecipeError) -> Error {
        // Match the error by name, not by value: the given relief may be NaN, which equals nothing.
        let is_of_relief = matches!(error.kind(), RecipeErrorKind::Range { what: "relief", .. });
        // A node may have an option named `relief`, too.
        let is_of_material = error.node() == Some("material");
        match is_of_relief && is_of_material && self.relief.is_some() {
            true => advise(error).wrong_value(),
            false => advise(error),
        }
    }

    /// Formats the options as command-line arguments.
    pub(in crate::commands) fn words(&self) -> Vec<String> {
        let set = self.set.iter().map(|setting| format!("--set={setting}"));
        let options = [
            Some(format!("--size={}", self.size)),
            self.samples.word(),
            self.supersample_word(),
            self.maps
                .as_ref()
                .map(|maps| format!("--maps={}", maps.names().join(","))),
            self.seed.map(|seed| format!("--seed={seed}")),
            self.normal_y
                .map(|way| format!("--normal-y={}", way.name())),
            self.relief.map(|relief| format!("--relief={relief}")),
            self.finite.word(),
        ];
        options.into_iter().flatten().chain(set).collect()
    }
}
