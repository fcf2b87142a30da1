//! flagstone.

use dapple::image::{Depth, write_color_png, write_gray_png, write_normal_png};
use dapple::recipe::{Bake, BakeOptions, Images, MapKind, MapRows, Plan, Recipe, RecipeError};

/// The maps of the material. What images the recipe names has to be put into `images`.
pub fn bake(
    size: [u32; 2],
    maps: Vec<MapKind>,
    images: &Images,
) -> Result<Vec<(MapKind, MapRows)>, RecipeError> {
    let plan = Plan::new(&Recipe::from_toml(RECIPE)?, images, 0.0)?;
    Bake::new(&plan, &BakeOptions { size, maps, ..BakeOptions::default() })?.whole_maps()
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let maps = vec![MapKind::Height, MapKind::Normal, MapKind::Albedo];
    for (kind, rows) in bake([512, 512], maps, &Images::new())? {
        let path = format!("{}.png", kind.name());
        match rows {
            MapRows::Gray(values) => write_gray_png(path, &values, Depth::Sixteen)?,
            MapRows::Color(colors) => write_color_png(path, &colors, Depth::Eight)?,
            MapRows::Normal(normals) => write_normal_png(path, &normals, Depth::Eight)?,
            _ => {}
        }
    }
    Ok(())
}

/// The recipe, in TOML.
const RECIPE: &str = r##"dapple = 1
name = "flagstone"
about = "Split stone paving in sandy joints. Worley's F2 - F1."
tags = [
    "stone",
    "paving",
    "floor",
    "outdoor",
]
seed = 3
extent = [
    6.0,
    6.0,
]
wrap = [
    true,
    true,
]

[nodes.albedo.mix]
from = "soil"
to = "faces"
by = "plate"

[nodes.border]
multiply = [
    "joint",
    "reach",
]

[nodes.chips.levels]
input = "grain"
from = [
    0.0,
    1.0,
]
to = [
    -0.05,
    0.05,
]
curve = "linear"

[nodes.edge]
add = [
    "border",
    "chips",
    "wander",
]

[nodes.faces]
multiply = [
    "stained",
    "shade",
]

[nodes.grain.noise]
basis = "wavelet"
frequency = 8.0
octaves = 5
gain = 0.65

[nodes.height.mix]
from = "sand"
to = "top"
by = "plate"

[nodes.joint.worley]
frequency = 1.0
value = "f2_minus_f1"
metric = "euclidean"

[nodes.joint.worley.scatter.jittered]
jitter = 0.65

[nodes.level.levels]
input = "stone"
from = [
    0.0,
    1.0,
]
to = [
    0.46,
    0.7,
]
curve = "linear"

[nodes.pits.levels]
input = "grain"
from = [
    0.0,
    1.0,
]
to = [
    -0.08,
    0.08,
]
curve = "linear"

[nodes.plate.levels]
input = "edge"
from = [
    0.06,
    0.14,
]
to = [
    0.0,
    1.0,
]
curve = "smooth"

[nodes.reach.worley]
frequency = 1.0
value = "f1_plus_f2"
metric = "euclidean"
seed = "joint"

[nodes.reach.worley.scatter.jittered]
jitter = 0.65

[nodes.roughness.mix]
from = 0.95
to = "worn"
by = "plate"

[nodes.round.levels]
input = "border"
from = [
    0.0,
    1.2,
]
to = [
    0.0,
    0.14,
]
curve = "linear"

[nodes.sand.levels]
input = "grain"
from = [
    0.0,
    1.0,
]
to = [
    0.0,
    0.26,
]
curve = "linear"

[nodes.shade.levels]
input = "grain"
from = [
    0.1,
    0.9,
]
to = [
    0.6,
    1.3,
]
curve = "linear"

[nodes.soil.ramp]
input = "grain"
colors = [
    "#3b3226",
    "#6b5c47",
]
positions = [
    0.2,
    0.8,
]
space = "oklab"
interpolation = "linear"
outside = "clamp"

[nodes.stain.levels]
input = "swell"
from = [
    0.5,
    0.8,
]
to = [
    0.0,
    0.7,
]
curve = "linear"

[nodes.stained.mix]
from = "tint"
to = "#86684a"
by = "stain"

[nodes.stone.worley]
frequency = 1.0
value = "cell_value"
metric = "euclidean"
seed = "joint"

[nodes.stone.worley.scatter.jittered]
jitter = 0.65

[nodes.swell.noise]
basis = "pups"
frequency = 2.0
octaves = 4
gain = 0.5

[nodes.tint.ramp]
input = "stone"
colors = [
    "#857b6c",
    "#9c8e78",
    "#777874",
    "#a99a80",
    "#6d6964",
    "#8f7d68",
    "#939188",
]
space = "oklab"
interpolation = "linear"
outside = "clamp"

[nodes.top]
add = [
    "level",
    "waves",
    "pits",
    "round",
]

[nodes.wander.levels]
input = "swell"
from = [
    0.0,
    1.0,
]
to = [
    -0.18,
    0.18,
]
curve = "linear"

[nodes.waves.levels]
input = "swell"
from = [
    0.0,
    1.0,
]
to = [
    -0.2,
    0.2,
]
curve = "linear"

[nodes.worn.levels]
input = "grain"
from = [
    0.0,
    1.0,
]
to = [
    0.85,
    0.5,
]
curve = "linear"

[material]
height = "height"
relief = 0.16
albedo = "albedo"
roughness = "roughness"
metallic = 0.0
normal_y = "opengl"
"##;
