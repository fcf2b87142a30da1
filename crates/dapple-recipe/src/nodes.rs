//! The kinds of nodes, one file per kind. Each file has the options of its kind, and builds its step in a plan.
//!
//! To add a kind, write a file that implements [`NodeKind`] for its options, and add a line to the table below.

mod alpha;
mod arithmetic;
mod blend;
mod blend_map;
mod blur;
mod bricks;
mod channel;
mod clamp;
mod color;
mod coordinate;
mod corner_tiles;
mod curvature;
mod curve;
mod dilate;
mod distance;
mod distance_to;
mod disturb;
mod edges;
mod equalize;
mod flood_fill;
mod flow_warp;
pub(crate) mod fractal;
mod gabor;
mod hsl;
mod image;
mod invert;
mod kaleidoscope;
mod levels;
mod match_borders;
mod mirror;
mod mix;
pub(crate) mod noise;
mod occlusion;
mod output;
mod polar;
mod power;
mod profile;
pub(crate) mod pups;
mod quantize;
mod ramp;
mod sample;
mod scatter;
mod seed;
mod select;
mod shape;
mod sharpen;
mod slope;
mod slope_blur;
mod smooth;
mod synth;
mod threshold;
mod tile;
mod transform;
mod warp;
mod wave;
pub(crate) mod wavelet;
mod weave;
pub(crate) mod worley;

pub use alpha::ImageAlpha;
pub use arithmetic::{Absolute, Add, Divide, Maximum, Minimum, Multiply, Subtract};
pub use blend::{Blended, BlendedLayer};
pub use blend_map::BlendMapOf;
pub use blur::Blur;
pub use bricks::BricksNode;
pub use channel::{ChannelOf, ColorChannel};
pub use clamp::Clamp;
pub use color::ColorOf;
pub use coordinate::Coordinate;
pub use corner_tiles::CornerTilesOf;
pub use curvature::Curvature;
pub use curve::SplineCurve;
pub use dapple_pups::{Cells, ControlPoint, ControlPoints};
pub use dilate::{Dilate, Erode};
pub use distance::Distance;
pub use distance_to::DistanceTo;
pub use disturb::Disturbed;
pub use edges::Edges;
pub use equalize::Equalize;
pub use flood_fill::{FloodFill, RegionValue};
pub use flow_warp::FlowWarpNode;
pub use fractal::FractalOf;
pub use gabor::GaborNode;
pub use hsl::HslChange;
pub use image::ImageNode;
pub use invert::Invert;
pub use kaleidoscope::Kaleidoscope;
pub use levels::{Levels, LevelsCurve};
pub use match_borders::Framed;
pub use mirror::MirroredNode;
pub use mix::Mix;
pub use noise::{FractalBasis, FractalNode};
pub use occlusion::Occlusion;
pub use output::Output;
pub use polar::Polar;
pub use power::Power;
pub use profile::ProfileOf;
pub use pups::{ControlNets, PupsNode, Referenced};
pub use quantize::Quantize;
pub use ramp::Ramped;
pub use sample::SampleAt;
pub use scatter::ScatterNode;
pub use seed::NodeSeed;
pub use select::Select;
pub use shape::ShapeNode;
pub use sharpen::Sharpen;
pub use slope::Slope;
pub use slope_blur::SlopeBlur;
pub use smooth::{SmoothMaximum, SmoothMinimum};
pub use synth::SynthNode;
pub use threshold::Threshold;
pub use tile::Tiled;
pub use transform::Transform;
pub use warp::Warp;
pub use wave::{Wave, Waveform};
pub use wavelet::WaveletNode;
pub use weave::WeaveNode;
pub use worley::{Frequency, Motion, WorleyNode, WorleyValue};

use crate::plan::{Builder, ImageSource, Step, Work};
use crate::shader::{Code, NodeShader, Refusal};
use crate::{Input, RecipeError};
use serde::{Deserialize, Serialize};

/// A kind of node.
///
/// A node has a number at every position, or a color if [`build`](Self::build) returns a color step.
pub(crate) trait NodeKind {
    /// Returns the inputs of the node, in the order of its options.
    fn inputs(&self) -> Vec<&Input> {
        Vec::new()
    }

    /// Returns the image files that the node reads.
    fn images(&self) -> Vec<&str> {
        Vec::new()
    }

    /// Returns how the alpha of the image files is used, if the node sets it.
    fn alpha(&self) -> Option<ImageAlpha> {
        None
    }

    /// Returns the layer of the image files to read, if the node sets it.
    fn layer(&self) -> Option<&str> {
        None
    }

    /// Returns the partition-of-unity texture of a `pups` node; `None` for other kinds.
    fn pups(&self) -> Option<&dyn pups::Texture> {
        None
    }

    /// Returns the names of the values that the node `output` can take from this node; none if it has a single value.
    fn outputs(&self) -> &'static [&'static str] {
        &[]
    }

    /// Returns a copy of the node that computes the output called `value`, one of [`outputs`](Self::outputs); `None` if
    /// it has no such output.
    fn with_output(&self, _value: &str) -> Option<Box<dyn NodeKind>> {
        None
    }

    /// Returns whether the node reads the relief of the material.
    fn reads_relief(&self) -> bool {
        false
    }

    /// Estimates the work of building the node's step. An estimate that is too high is preferred to one that is too
    /// low.
    fn work(&self, _plan: &Builder<'_>) -> Result<Work, RecipeError> {
        Ok(Work::default())
    }

    /// Builds the step of the node. The steps of its inputs must be in the plan already.
    fn build(&self, plan: &mut Builder<'_>) -> Result<Step, RecipeError>;

    /// Writes the node as a WGSL expression, with the same bits as the step. The plan has validated all options.
    /// Implementations must return refusals before they read inputs at the same position.
    fn shader(&self, shader: &mut NodeShader<'_, '_>) -> Result<Code, Refusal> {
        Err(shader.no_shader())
    }
}

/// Implements `inputs` of a [`NodeKind`] by the names of its fields.
macro_rules! inputs {
    ($($field:tt),*) => {
        fn inputs(&self) -> Vec<&$crate::Input> {
            vec![$(&self.$field),*]
        }
    };
}

pub(crate) use inputs;

/// Implements `outputs` and `with_output` of a [`NodeKind`] whose option `value` is one of the named values of an enum.
macro_rules! outputs {
    ($values:ty) => {
        fn outputs(&self) -> &'static [&'static str] {
            <$values as dapple_raster::Named>::NAMES
        }

        fn with_output(&self, value: &str) -> Option<Box<dyn NodeKind>> {
            let value = dapple_raster::Named::from_name(value)?;
            Some(Box::new(Self {
                value,
                ..self.clone()
            }))
        }
    };
}

pub(crate) use outputs;

/// Defines the enum of all kinds, their names in recipes, and access to a node as a [`NodeKind`].
macro_rules! nodes {
    ($($(#[$doc:meta])* $name:literal $variant:ident($options:ident) in $group:literal as $start:literal $(also $tags:literal)?,)*) => {
        /// Node of a recipe: a table with a single entry, whose key is the kind of node.
        ///
        /// Most nodes compute a number at every position. `ramp`, `color`, `hsl`, `image` and `synth` with a color image,
        /// and `pups = { color_noise = … }` compute a color. `add`, `multiply`, `mix`, `select`, `invert`, `blur`,
        /// `slope_blur`, `flow_warp`, `sharpen`, `dilate`, `erode`, `tile`, `disturb`, `match_borders`, `corner_tiles`,
        /// `blend` and nodes that evaluate another node elsewhere, such as `warp`, compute a color if an input is a
        /// color; numbers among their inputs are then grays.
        #[derive(Clone, Debug, Serialize, Deserialize)]
        #[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
        #[non_exhaustive]
        pub enum Node {
            $($(#[$doc])* #[serde(rename = $name)] $variant($options),)*
        }

        /// Names of the node kinds in recipes.
        pub const KINDS: [&str; [$($name),*].len()] = [$($name),*];

        /// For each of [`KINDS`], its group, such as `shape`, and the initial options of a new node, as JSON.
        pub const NEW_NODES: [(&str, &str); KINDS.len()] = [$(($group, $start)),*];

        /// For each of [`KINDS`], its names in other programs, separated by commas; may be empty.
        pub const NODE_TAGS: [&str; KINDS.len()] = [$(concat!($($tags)?)),*];

        impl Node {
            pub(crate) fn kind(&self) -> &dyn NodeKind {
                match self {
                    $(Self::$variant(node) => node,)*
                }
            }

            /// Returns the name of the node's kind in recipes.
            pub(crate) fn kind_name(&self) -> &'static str {
                match self {
                    $(Self::$variant(_) => $name,)*
                }
            }
        }
    };
}

nodes! {
    /// Worley's cellular basis: distances to scattered feature points.
    "worley" Worley(WorleyNode) in "cells and noise" as "{}"
        also "voronoi, cellular, cells, crystal, cracks, stones, leather, scales",
    /// Partition-of-unity texture, such as cells, noise or an animal coat.
    "pups" Pups(PupsNode) in "cells and noise" as r#"{"cells":{}}"#
        also "grunge, spots, animal, giraffe, cow, cells",
    /// Band-limited wavelet noise.
    "wavelet" Wavelet(WaveletNode) in "cells and noise" as "{}"
        also "fbm, band-limited noise",
    /// Fractal noise from 0 to 1: octaves of PUPs, gradient noise or wavelet noise.
    "noise" Noise(FractalNode) in "cells and noise" as "{}"
        also "perlin, simplex, fbm, clouds, grunge, turbulence, fractal",
    /// Bricks, tiles or planks in a regular bond.
    "bricks" Bricks(BricksNode) in "patterns" as "{}"
        also "brick, tile generator, planks, herringbone, hexagon, wall",
    /// Woven cloth: plain weave, twill, satin or basket weave.
    "weave" Weave(WeaveNode) in "patterns" as "{}"
        also "fabric, cloth, textile, twill",
    /// Simple shape, such as a star, as a signed distance or a mask.
    "shape" Shape(ShapeNode) in "patterns" as "{}"
        also "sdf, circle, box, square, polygon, star, dots, mask",
    /// Another value of a node that has several, such as the random number of a brick.
    "output" Output(Output) in "patterns" as r#"{"of":0.5}"#
        also "random, id, uv",
    /// Gabor noise: waves of about one length and direction, such as wood fiber or ripples.
    "gabor" Gabor(GaborNode) in "cells and noise" as "{}"
        also "fiber, wood grain, hair, fur, sand ripples, brushed metal, anisotropic noise",
    /// Shapes stamped at scattered points, such as gravel, leaves, rivets or scratches.
    "scatter" Scatter(ScatterNode) in "patterns" as "{}"
        also "tile sampler, splatter, stamp, dots, gravel, pebbles, stones, scratches, dirt",
    /// Coordinate of a position along a direction.
    "coordinate" Coordinate(Coordinate) in "position" as r#"{"along":[1.0,0.0]}"#
        also "gradient, linear, uv, position",
    /// Distance of a position from a center.
    "distance" Distance(Distance) in "position" as r#"{"center":[0.5,0.5]}"#
        also "radial gradient, circle",
    /// Image file, stretched over the tile.
    "image" Image(ImageNode) in "color and images" as r#"{"file":"image.png"}"#
        also "bitmap, texture, photo",
    /// Texture synthesized from an example image.
    "synth" Synth(SynthNode) in "color and images" as r#"{"file":"image.png"}"#
        also "texture synthesis, quilting, by example",
    /// Constant color.
    "color" Color(ColorOf) in "color and images" as r##""#c08040""##
        also "uniform color, solid, rgb",
    /// Sum of all inputs.
    "add" Add(Add) in "arithmetic" as "[0.0,0.0]"
        also "linear dodge, plus, sum",
    /// First input minus the second.
    "subtract" Subtract(Subtract) in "arithmetic" as "[0.0,0.0]"
        also "minus, difference",
    /// Product of all inputs.
    "multiply" Multiply(Multiply) in "arithmetic" as "[1.0,1.0]"
        also "times, product, math, tint",
    /// First input divided by the second; 0 where the second is 0.
    "divide" Divide(Divide) in "arithmetic" as "[1.0,1.0]",
    /// Minimum of all inputs.
    "minimum" Minimum(Minimum) in "arithmetic" as "[0.0,1.0]"
        also "min, darken",
    /// Maximum of all inputs.
    "maximum" Maximum(Maximum) in "arithmetic" as "[0.0,1.0]"
        also "max, lighten",
    /// Smooth minimum of all inputs, which joins shapes with a fillet.
    "smooth_minimum" SmoothMinimum(SmoothMinimum) in "arithmetic" as r#"{"inputs":[0.0,1.0]}"#
        also "smooth union, metaballs",
    /// Smooth maximum of all inputs, which intersects shapes with a fillet.
    "smooth_maximum" SmoothMaximum(SmoothMaximum) in "arithmetic" as r#"{"inputs":[0.0,1.0]}"#
        also "smooth intersection",
    /// Absolute value of a number.
    "absolute" Absolute(Absolute) in "arithmetic" as "0.0"
        also "abs",
    /// Number raised to a power.
    "power" Power(Power) in "arithmetic" as r#"{"input":0.5,"exponent":2.0}"#
        also "gamma, exponent, contrast",
    /// Periodic wave of a number, such as a sine or a sawtooth.
    "wave" Wave(Wave) in "shape" as r#"{"input":0.5}"#
        also "sine, sin, stripes, checker, sawtooth, triangle, modulo, repeat",
    /// Number mapped from one range to another.
    "levels" Levels(Levels) in "shape" as r#"{"input":0.5}"#
        also "map range, remap, histogram, contrast, brightness, auto levels",
    /// Number mapped by a smooth curve through points.
    "curve" Curve(SplineCurve) in "shape" as r#"{"input":0.5,"points":[[0.0,0.0],[0.5,0.6],[1.0,1.0]]}"#
        also "curves, rgb curves, spline, transfer",
    /// 1 where a number is above a threshold, 0 where it is below.
    "threshold" Threshold(Threshold) in "shape" as r#"{"input":0.5}"#
        also "mask, step, binarize, histogram scan, edge",
    /// Number rounded to the nearest of evenly spaced values.
    "quantize" Quantize(Quantize) in "shape" as r#"{"input":0.5}"#
        also "posterize, steps, terrace, round",
    /// 1 minus a number or a color.
    "invert" Invert(Invert) in "arithmetic" as "0.0"
        also "negative, one minus",
    /// One of several inputs, chosen by a number.
    "select" Select(Select) in "shape" as r#"{"inputs":[0.0,1.0],"by":0.5}"#
        also "switch, multi switch, id mask",
    /// Cross-section of a bump, such as a spot or a channel, as a function of a number.
    "profile" Profile(ProfileOf) in "shape" as r#"{"input":0.5,"shape":{"spots":{"radius":0.5}}}"#
        also "bump, bevel",
    /// Interpolation between two inputs.
    "mix" Mix(Mix) in "shape" as r#"{"from":0.0,"to":1.0,"by":0.5}"#
        also "lerp, blend, merge, composite, mask, interpolate, opacity",
    /// Number clamped to a range.
    "clamp" Clamp(Clamp) in "shape" as r#"{"input":0.5}"#
        also "saturate, limit",
    /// Another node, sampled at displaced positions.
    "warp" Warp(Warp) in "shape" as r#"{"input":0.5,"x":0.0,"y":0.0}"#
        also "distort, displace, domain warp, directional warp",
    /// Another node, rotated, repeated more often and shifted.
    "transform" Transform(Transform) in "shape" as r#"{"input":0.5}"#
        also "rotate, scale, translate, offset, uv transform",
    /// Another node, evaluated at the positions that two numbers give.
    "sample" SampleAt(SampleAt) in "shape" as r#"{"input":0.5,"x":0.0,"y":0.0}"#
        also "uv lookup, pixel processor",
    /// Another node, mirrored at a center.
    "mirror" Mirror(MirroredNode) in "shape" as r#"{"input":0.5}"#
        also "symmetry, flip",
    /// Another node, bent around a center.
    "polar" Polar(Polar) in "shape" as r#"{"input":0.5}"#
        also "radial, circular, spiral, cartesian to polar",
    /// Sector of another node, repeated around a center.
    "kaleidoscope" Kaleidoscope(Kaleidoscope) in "shape" as r#"{"input":0.5}"#
        also "symmetry, mandala",
    /// Fractal sum of a node at several scales.
    "fractal" Fractal(FractalOf) in "shape" as r#"{"input":0.5}"#
        also "fbm, octaves, turbulence, ridged, billow",
    /// Color for each number, from a color ramp.
    "ramp" Ramp(Ramped) in "color and images" as r##"{"input":0.5,"colors":["#202020","#f0f0f0"]}"##
        also "gradient map, color ramp, colorize, palette",
    /// Gaussian blur, in all directions or along one.
    "blur" Blur(Blur) in "neighborhood" as r#"{"input":0.5,"radius":0.02}"#
        also "gaussian, directional blur, soften, smooth",
    /// Blur along the slope of a height: values run downhill.
    "slope_blur" SlopeBlur(SlopeBlur) in "neighborhood" as r#"{"input":0.5,"height":0.5,"radius":0.05}"#
        also "erosion, flow",
    /// Input that flows along the slope or the contour lines of a height, in steps.
    "flow_warp" FlowWarp(FlowWarpNode) in "neighborhood" as r#"{"input":0.5,"height":0.5,"amount":0.1}"#
        also "flow, swirl, twirl, curl, advect, eddy, marbling, vector warp",
    /// Input sharpened by an unsharp mask.
    "sharpen" Sharpen(Sharpen) in "neighborhood" as r#"{"input":0.5,"radius":0.02}"#
        also "unsharp mask, high pass",
    /// Where the input changes: the length of its gradient.
    "edges" Edges(Edges) in "neighborhood" as r#"{"input":0.5,"radius":0.02}"#
        also "edge detect, sobel, outline",
    /// Maximum of the input within a radius.
    "dilate" Dilate(Dilate) in "neighborhood" as r#"{"input":0.5,"radius":0.02}"#
        also "expand, grow, maximum filter",
    /// Minimum of the input within a radius.
    "erode" Erode(Erode) in "neighborhood" as r#"{"input":0.5,"radius":0.02}"#
        also "shrink, minimum filter",
    /// Distance to where a mask is above ½, up to a radius.
    "distance_to" DistanceTo(DistanceTo) in "neighborhood" as r#"{"input":0.5,"radius":0.1}"#
        also "distance field, bevel, edge wear",
    /// Steepness of a height, from 0 where it is level to 1 where it is vertical.
    "slope" Slope(Slope) in "neighborhood" as r#"{"input":0.5}"#
        also "normal, steepness, gradient",
    /// Curvature of a height: ½ where it is flat, more on edges, less in grooves.
    "curvature" Curvature(Curvature) in "neighborhood" as r#"{"input":0.5}"#
        also "edge wear, convexity, cavity, emboss",
    /// Ambient occlusion of a height: the visible fraction of the sky.
    "occlusion" Occlusion(Occlusion) in "neighborhood" as r#"{"input":0.5}"#
        also "ao, ambient occlusion, cavity, dirt",
    /// Number spread evenly from 0 to 1 over the tile.
    "equalize" Equalize(Equalize) in "whole tile" as r#"{"input":0.5}"#
        also "histogram, auto levels",
    /// Number for each connected region of a mask.
    "flood_fill" FloodFill(FloodFill) in "whole tile" as r#"{"input":0.5}"#
        also "region, island, id, random",
    /// Component of a color as a number, such as its luminance or hue.
    "channel" Channel(ChannelOf) in "color and images" as r##"{"input":"#808080"}"##
        also "luminance, grayscale, desaturate, split, separate rgb, swizzle, hue",
    /// Color with another hue, saturation and lightness.
    "hsl" Hsl(HslChange) in "color and images" as r##"{"input":"#808080"}"##
        also "hue, saturation, lightness, hsv, tint, desaturate, replace color, color correct",
    /// Texture made to repeat seamlessly.
    "tile" Tile(Tiled) in "whole tile" as r#"{"input":0.5}"#
        also "seamless, make it tile, repeat",
    /// Copies of a tile with equal borders and different interiors.
    "disturb" Disturb(Disturbed) in "whole tile" as r#"{"input":0.5}"#
        also "variation, wang tiles",
    /// Texture with the borders of another texture.
    "match_borders" MatchBorders(Framed) in "whole tile" as r#"{"input":0.5,"border":0.5}"#,
    /// Pieces of several textures in random order, joined by corner tiles.
    "corner_tiles" CornerTiles(CornerTilesOf) in "whole tile" as r#"{"inputs":[0.25,0.75]}"#
        also "wang tiles, stochastic tiling",
    /// Blend map of a texture: low in cracks, where another texture shows first.
    "blend_map" BlendMap(BlendMapOf) in "whole tile" as r#"{"input":0.5,"feature_size":0.5}"#
        also "height blend",
    /// Layers blended by weights.
    "blend" Blend(Blended) in "whole tile" as r#"{"layers":[{"input":0.5}]}"#
        also "layers, height blend",
}

impl Node {
    /// Returns the image files in the options of the node.
    #[must_use]
    pub fn image_files(&self) -> Vec<&str> {
        self.kind().images()
    }

    /// Returns how the alpha of the image files is used, if the node sets it.
    #[must_use]
    pub fn image_alpha(&self) -> Option<ImageAlpha> {
        self.kind().alpha()
    }

    /// Returns the layer of the image files to read, if the node sets it.
    #[must_use]
    pub fn image_layer(&self) -> Option<&str> {
        self.kind().layer()
    }

    /// Returns the images that the node reads. Each is a file with its layer and alpha handling.
    pub fn image_sources(&self) -> impl Iterator<Item = ImageSource<'_>> {
        let (layer, alpha) = (self.image_layer(), self.image_alpha());
        let files = self.image_files().into_iter();
        files.map(move |file| ImageSource { file, layer, alpha })
    }

    /// Returns the inputs of the node, in a fixed order.
    #[must_use]
    pub fn inputs(&self) -> Vec<&Input> {
        self.kind().inputs()
    }
}
