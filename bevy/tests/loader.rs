//! A recipe loaded without a window: formats, mip levels, samplers and bytes.

use bevy_app::{App, TaskPoolPlugin};
use bevy_asset::{AssetPlugin, AssetServer, Assets, Handle, LoadState};
use bevy_dapple::{RecipeMaterial, RecipePlugin, RecipeSettings};
use bevy_image::{Image, ImageAddressMode, ImageSampler};
use dapple_recipe::{Bake, BakeOptions, Images, MapKind, Plan, Recipe};
use wgpu_types::TextureFormat;

const SIZE: [u32; 2] = [64, 32];

const RECIPE: &str = r##"
dapple = 1
extent = [4.0, 2.0]
wrap = [true, false]
[nodes]
cells.worley = { value = "f2_minus_f1" }
color.ramp = { input = "cells", colors = ["#204060", "#f0e0d0"] }
[material]
height = "cells"
albedo = "color"
roughness = 0.7
"##;

fn app(folder: &std::path::Path) -> App {
    let mut app = App::new();
    app.add_plugins((
        TaskPoolPlugin::default(),
        AssetPlugin {
            file_path: folder.to_string_lossy().into_owned(),
            ..AssetPlugin::default()
        },
        RecipePlugin,
    ));
    bevy_asset::AssetApp::init_asset::<Image>(&mut app);
    #[cfg(feature = "pbr")]
    bevy_asset::AssetApp::init_asset::<bevy_pbr::StandardMaterial>(&mut app);
    app
}

/// Runs the app until a recipe is loaded or has failed.
fn load(app: &mut App, file: &str) -> (Handle<RecipeMaterial>, LoadState) {
    let server = app.world().resource::<AssetServer>().clone();
    let handle: Handle<RecipeMaterial> = server
        .load_builder()
        .with_settings(|settings: &mut RecipeSettings| settings.size = SIZE)
        .load(file.to_owned());
    for _ in 0..3000 {
        app.update();
        let state = server.load_state(&handle);
        if state.is_loaded() || state.is_failed() {
            return (handle, state);
        }
        std::thread::sleep(std::time::Duration::from_millis(10));
    }
    panic!("the recipe is not loaded after 30 seconds");
}

#[test]
fn images_have_the_bytes_of_a_bake_with_mip_levels_and_repeating_samplers() {
    let folder = std::env::temp_dir().join(format!("bevy-dapple-{}", std::process::id()));
    std::fs::create_dir_all(&folder).unwrap();
    std::fs::write(folder.join("cells.toml"), RECIPE).unwrap();
    let photo = RECIPE.replace(
        "cells.worley = {",
        "cells.image = { file = \"a.png\" }\nother.worley = {",
    );
    std::fs::write(folder.join("photo.toml"), photo).unwrap();
    let mut app = app(&folder);
    let (handle, state) = load(&mut app, "cells.toml");
    assert!(state.is_loaded(), "{state:?}");
    let (_, refused) = load(&mut app, "photo.toml");
    assert!(format!("{refused:?}").contains("a.png"), "{refused:?}");
    std::fs::remove_dir_all(&folder).unwrap();

    let recipe = Recipe::from_toml(RECIPE).unwrap();
    let plan = Plan::new(&recipe, &Images::new(), 0.0).unwrap();
    let world = app.world();
    let material = world
        .resource::<Assets<RecipeMaterial>>()
        .get(&handle)
        .unwrap()
        .clone();
    for (image, kind, format) in [
        (
            material.base_color,
            MapKind::Albedo,
            TextureFormat::Rgba8UnormSrgb,
        ),
        (material.normal, MapKind::Normal, TextureFormat::Rgba8Unorm),
        (material.orm, MapKind::Orm, TextureFormat::Rgba8Unorm),
        (material.height, MapKind::Height, TextureFormat::R32Float),
    ] {
        let image = world.resource::<Assets<Image>>().get(&image).unwrap();
        assert_eq!(image.texture_descriptor.format, format);
        assert_eq!(
            image.texture_descriptor.mip_level_count, 7,
            "64 × 32 to 1 × 1"
        );
        let pixels: u32 = (0..7)
            .map(|level| (64 >> level) * (32_u32 >> level).max(1))
            .sum();
        let data = image.data.as_ref().unwrap();
        assert_eq!(data.len(), 4 * pixels as usize);
        let options = BakeOptions {
            size: SIZE,
            maps: vec![kind],
            ..BakeOptions::default()
        };
        let maps = Bake::new(&plan, &options).unwrap().whole_maps().unwrap();
        let expected: Vec<u8> = match &maps[0].1 {
            dapple_recipe::MapRows::Gray(raster) => raster
                .pixels()
                .iter()
                .flat_map(|number| number.to_le_bytes())
                .collect(),
            map => map.to_rgba8(),
        };
        assert!(data.starts_with(&expected), "{kind:?} differs from a bake");
        let ImageSampler::Descriptor(sampler) = &image.sampler else {
            panic!("no sampler");
        };
        let modes = [sampler.address_mode_u, sampler.address_mode_v];
        assert_eq!(
            modes,
            [ImageAddressMode::Repeat, ImageAddressMode::ClampToEdge]
        );
    }
}
