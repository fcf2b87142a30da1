//! Materials of dapple's recipes as assets of Bevy.
//!
//! [`RecipePlugin`] loads recipes (`.toml`) as [`RecipeMaterial`]: images with all mip levels and samplers that repeat where
//! the recipe does, and a `StandardMaterial` that uses them. Level 0 of each image has the values of `dapple bake`.
//!
//! ```no_run
//! use bevy_app::App;
//! use bevy_asset::{AssetServer, Handle};
//! use bevy_dapple::{RecipeMaterial, RecipePlugin};
//!
//! # fn load(mut app: App, assets: &AssetServer) {
//! app.add_plugins(RecipePlugin);
//! let rock: Handle<RecipeMaterial> = assets.load("rock.toml");
//! // The parts have labels: a material is ready to be used by a mesh.
//! # #[cfg(feature = "pbr")]
//! let material: Handle<bevy_pbr::StandardMaterial> = assets.load("rock.toml#material");
//! # }
//! ```
//!
//! With the feature `file_watcher`, Bevy loads a changed recipe again.

use bevy_app::{App, Plugin};
use bevy_asset::io::Reader;
use bevy_asset::{Asset, AssetApp as _, AssetLoader, Handle, LoadContext, RenderAssetUsages};
use bevy_image::{Image, ImageAddressMode, ImageFilterMode, ImageSampler, ImageSamplerDescriptor};
#[cfg(feature = "pbr")]
use bevy_pbr::StandardMaterial;
use bevy_reflect::TypePath;
#[cfg(feature = "pbr")]
use dapple_recipe::color::NormalY;
use dapple_recipe::hash::Seed;
use dapple_recipe::{Bake, BakeOptions, Images, MapKind, MapRows, Plan, Recipe, RecipeError};
use serde::{Deserialize, Serialize};
use std::fmt;
use wgpu_types::{Extent3d, TextureDimension, TextureFormat};

/// Adds [`RecipeMaterial`] and its loader.
#[derive(Clone, Copy, Debug, Default)]
pub struct RecipePlugin;

impl Plugin for RecipePlugin {
    fn build(&self, app: &mut App) {
        app.init_asset::<RecipeMaterial>()
            .init_asset_loader::<RecipeLoader>();
    }
}

/// The baked maps of a recipe. Each part is also a separate asset, with the label of its field.
#[derive(Asset, TypePath, Clone, Debug)]
pub struct RecipeMaterial {
    /// Base color, sRGB encoded (`Rgba8UnormSrgb`). Label `base_color`.
    pub base_color: Handle<Image>,
    /// Normals in tangent space (`Rgba8Unorm`). Label `normal`.
    pub normal: Handle<Image>,
    /// Occlusion, roughness and metalness in red, green and blue (`Rgba8Unorm`). Label `orm`.
    pub orm: Handle<Image>,
    /// Heights, not clamped (`R32Float`, which devices filter only with an optional feature). Label `height`.
    pub height: Handle<Image>,
    /// A material with these images, without emission, opacity, specular strength and clear coat. Label `material`.
    #[cfg(feature = "pbr")]
    pub material: Handle<StandardMaterial>,
}

/// How a recipe is baked, for `AssetServer::load_builder` and `.meta` files.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(default)]
pub struct RecipeSettings {
    /// Columns and rows of the images; by default 512 × 512.
    pub size: [u32; 2],
    /// Random seed; by default the recipe's.
    pub seed: Option<u64>,
}

impl Default for RecipeSettings {
    fn default() -> Self {
        Self {
            size: [512; 2],
            seed: None,
        }
    }
}

/// An error of [`RecipeLoader`].
#[derive(Debug)]
pub enum RecipeLoaderError {
    /// The file cannot be read.
    Io(std::io::Error),
    /// The file is not UTF-8 text.
    Text(std::string::FromUtf8Error),
    /// The recipe is invalid or cannot be baked.
    Recipe(RecipeError),
    /// The recipe reads image files, which the loader does not support.
    Images(Vec<String>),
}

impl fmt::Display for RecipeLoaderError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Io(error) => error.fmt(f),
            Self::Text(error) => error.fmt(f),
            Self::Recipe(error) => error.fmt(f),
            Self::Images(files) => write!(
                f,
                "the recipe reads image files ({}), which is not supported: bake it with `dapple bake`",
                files.join(", ")
            ),
        }
    }
}

impl std::error::Error for RecipeLoaderError {}

impl From<RecipeError> for RecipeLoaderError {
    fn from(error: RecipeError) -> Self {
        Self::Recipe(error)
    }
}

/// Loads recipes in TOML.
#[derive(Clone, Copy, Debug, Default, TypePath)]
pub struct RecipeLoader;

impl AssetLoader for RecipeLoader {
    type Asset = RecipeMaterial;
    type Settings = RecipeSettings;
    type Error = RecipeLoaderError;

    async fn load(
        &self,
        reader: &mut dyn Reader,
        settings: &RecipeSettings,
        context: &mut LoadContext<'_>,
    ) -> Result<RecipeMaterial, RecipeLoaderError> {
        let mut bytes = Vec::new();
        let read = reader.read_to_end(&mut bytes).await;
        read.map_err(RecipeLoaderError::Io)?;
        let text = String::from_utf8(bytes).map_err(RecipeLoaderError::Text)?;
        let mut recipe = Recipe::from_toml(&text)?;
        if let Some(seed) = settings.seed {
            recipe.seed = Seed(seed);
        }
        let files = recipe.image_files();
        if !files.is_empty() {
            let files = files.iter().map(ToString::to_string).collect();
            return Err(RecipeLoaderError::Images(files));
        }
        let [base_color, normal, orm, height] = bake(&recipe, settings.size)?;
        let base_color = context.add_labeled_asset("base_color", base_color);
        let normal = context.add_labeled_asset("normal", normal);
        let orm = context.add_labeled_asset("orm", orm);
        let height = context.add_labeled_asset("height", height);
        #[cfg(feature = "pbr")]
        let material = StandardMaterial {
            base_color_texture: Some(base_color.clone()),
            normal_map_texture: Some(normal.clone()),
            flip_normal_map_y: recipe.material.normal_y == NormalY::DirectX,
            // Textures are multiplied by these numbers.
            perceptual_roughness: 1.0,
            metallic: 1.0,
            metallic_roughness_texture: Some(orm.clone()),
            occlusion_texture: Some(orm.clone()),
            ..StandardMaterial::default()
        };
        Ok(RecipeMaterial {
            base_color,
            normal,
            orm,
            height,
            #[cfg(feature = "pbr")]
            material: context.add_labeled_asset("material", material),
        })
    }

    fn extensions(&self) -> &[&str] {
        &["toml"]
    }
}

/// Bakes base color, normals, occlusion-roughness-metalness, and heights.
fn bake(recipe: &Recipe, size: [u32; 2]) -> Result<[Image; 4], RecipeError> {
    let plan = Plan::new(recipe, &Images::new(), 0.0)?;
    let kinds = [
        MapKind::Albedo,
        MapKind::Normal,
        MapKind::Orm,
        MapKind::Height,
    ];
    let options = BakeOptions {
        size,
        maps: kinds.to_vec(),
        ..BakeOptions::default()
    };
    let maps = Bake::new(&plan, &options)?.whole_maps()?;
    let image = |kind: MapKind| {
        let map = maps.iter().find(|(other, _)| *other == kind);
        // The bake has all maps of its options.
        let levels = map.map_or(Ok(Vec::new()), |(_, map)| map.mip_levels())?;
        let format = match kind {
            MapKind::Albedo => TextureFormat::Rgba8UnormSrgb,
            MapKind::Height => TextureFormat::R32Float,
            _ => TextureFormat::Rgba8Unorm,
        };
        Ok::<_, RecipeError>(of_levels(&levels, size, format, recipe.wrap))
    };
    let [base_color, normal, orm, height] = kinds.map(image);
    Ok([base_color?, normal?, orm?, height?])
}

/// Returns an image of mip levels. The sampler repeats along the axes that `wrap` names.
fn of_levels(
    levels: &[MapRows],
    [width, height]: [u32; 2],
    format: TextureFormat,
    wrap: [bool; 2],
) -> Image {
    let extent = Extent3d {
        width,
        height,
        depth_or_array_layers: 1,
    };
    let bytes = levels.iter().flat_map(|level| match level {
        MapRows::Gray(raster) if format == TextureFormat::R32Float => {
            let numbers = raster.pixels().iter();
            numbers.flat_map(|number| number.to_le_bytes()).collect()
        }
        level => level.to_rgba8(),
    });
    let usage = RenderAssetUsages::default();
    let mut image = Image::new_uninit(extent, TextureDimension::D2, format, usage);
    image.data = Some(bytes.collect());
    image.texture_descriptor.mip_level_count = levels.len() as u32;
    let [u, v] = wrap.map(|wraps| match wraps {
        true => ImageAddressMode::Repeat,
        false => ImageAddressMode::ClampToEdge,
    });
    // Devices filter 32-bit numbers only with an optional feature.
    let (filter, anisotropy) = match format {
        TextureFormat::R32Float => (ImageFilterMode::Nearest, 1),
        _ => (ImageFilterMode::Linear, 8),
    };
    image.sampler = ImageSampler::Descriptor(ImageSamplerDescriptor {
        address_mode_u: u,
        address_mode_v: v,
        mag_filter: filter,
        min_filter: filter,
        mipmap_filter: filter,
        anisotropy_clamp: anisotropy,
        ..ImageSamplerDescriptor::default()
    });
    image
}
