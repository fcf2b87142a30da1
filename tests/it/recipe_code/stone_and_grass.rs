//! stone-and-grass.
//!
//! Some of its nodes need an image or see the whole tile, so it is baked and has no value at a single position. Needs the
//! crate `dapple`.

use dapple::recipe::{Bake, BakeOptions, Band, Images, MapKind, Plan, Recipe, RecipeError};

/// The recipe, in TOML.
pub const RECIPE: &str = r##"dapple = 1
name = "stone-and-grass"
about = "Grass that grows from the cracks of stones: a blend map made of the stones says where, as with Du, Wang and Meng."
seed = 15
extent = [
    4.0,
    4.0,
]
wrap = [
    true,
    true,
]

[nodes.across.coordinate]
center = [
    0.0,
    0.0,
]
along = [
    7.0,
    0.0,
]

[nodes.albedo.mix]
from = "grass_color"
to = "stone_color"
by = "stony"

[nodes.blades.warp]
input = "strands"
x = "comb"
y = 0.0
amount = 1.0

[nodes.comb]
add = [
    "across",
    "leaning",
]

[nodes.dome.profile]
input = "joint"

[nodes.dome.profile.shape.channels]
width = 0.5

[nodes.dry.levels]
input = "swell"
from = [
    0.4,
    0.75,
]
to = [
    0.0,
    1.0,
]
curve = "linear"

[nodes.grain.noise]
basis = "wavelet"
frequency = 16.0
octaves = 4
gain = 0.6

[nodes.grass_color.mix]
from = "green"
to = "straw"
by = "dry"

[nodes.grass_height.levels]
input = "blades"
from = [
    0.1,
    0.9,
]
to = [
    0.15,
    0.42,
]
curve = "linear"

[nodes.green.ramp]
input = "grass_height"
colors = [
    "#1f2c10",
    "#3d5a1f",
    "#6f8a35",
    "#98a554",
]
positions = [
    0.15,
    0.22,
    0.32,
    0.42,
]
space = "oklab"
interpolation = "linear"
outside = "clamp"

[nodes.height.mix]
from = "grass_height"
to = "stone_height"
by = "stony"

[nodes.joint.worley]
frequency = 1.0
value = "f2_minus_f1"
metric = "euclidean"

[nodes.joint.worley.scatter.jittered]
jitter = 0.85

[nodes.lean.noise]
basis = "wavelet"
frequency = 4.0
octaves = 2
gain = 0.5

[nodes.leaning.levels]
input = "lean"
from = [
    0.0,
    1.0,
]
to = [
    -0.6,
    0.6,
]
curve = "linear"

[nodes.level.levels]
input = "stone"
from = [
    0.0,
    1.0,
]
to = [
    0.55,
    0.85,
]
curve = "linear"

[nodes.lifted]
multiply = [
    "dome",
    "level",
]

[nodes.rough.levels]
input = "grain"
from = [
    0.0,
    1.0,
]
to = [
    -0.07,
    0.07,
]
curve = "linear"

[nodes.roughness.mix]
from = 0.75
to = 0.9
by = "stony"

[nodes.shade.levels]
input = "grain"
from = [
    0.0,
    1.0,
]
to = [
    0.65,
    1.3,
]
curve = "linear"

[nodes.stone.worley]
frequency = 1.0
value = "cell_value"
metric = "euclidean"
seed = "joint"

[nodes.stone.worley.scatter.jittered]
jitter = 0.85

[nodes.stone_color]
multiply = [
    "tint",
    "shade",
]

[nodes.stone_height]
add = [
    "lifted",
    "rough",
    "waves",
]

[nodes.stony.blend]
mixing = "linear"
mask = "where"

[[nodes.stony.blend.layers]]
input = 0.0
weight = 0.4

[[nodes.stony.blend.layers]]
input = 1.0
weight = 0.6

[nodes.stony.blend.weighting.mask]
gain = 12.0

[nodes.strands.noise]
basis = "wavelet"
frequency = 8.0
octaves = 3
gain = 0.7

[nodes.straw.ramp]
input = "grass_height"
colors = [
    "#2c2a12",
    "#6d6630",
    "#b0a35c",
]
positions = [
    0.15,
    0.25,
    0.42,
]
space = "oklab"
interpolation = "linear"
outside = "clamp"

[nodes.swell.noise]
basis = "pups"
frequency = 2.0
octaves = 3
gain = 0.5

[nodes.tint.ramp]
input = "stone"
colors = [
    "#7c7870",
    "#918a7c",
    "#858785",
    "#a09888",
    "#6f6a64",
]
space = "oklab"
interpolation = "linear"
outside = "clamp"

[nodes.waves.levels]
input = "swell"
from = [
    0.0,
    1.0,
]
to = [
    0.0,
    0.2,
]
curve = "linear"

[nodes.where.blend_map]
input = "stone_height"
feature_size = 0.8
contrast = 1.0

[material]
height = "height"
relief = 0.22
albedo = "albedo"
roughness = "roughness"
metallic = 0.0
normal_y = "opengl"
"##;

/// The maps of the material, in bands from the top down.
///
/// # Errors
///
/// If an image is missing, or does not fit.
pub fn bake(size: [u32; 2], maps: &[MapKind], images: &Images) -> Result<Vec<Band>, RecipeError> {
    let plan = Plan::new(&Recipe::from_toml(RECIPE)?, images, 0.0)?;
    let options = BakeOptions { size, maps: maps.to_vec(), ..BakeOptions::default() };
    Bake::new(&plan, &options)?.collect()
}
