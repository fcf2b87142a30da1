//! Defines the options of `dapple synth`.

use crate::args::{Axes, Numbers, Size, seed};
use crate::error::{Hint, usage};
use crate::input::{Loaded, mesh_endings};
use crate::words::NamedValueParser;
use anyhow::Result;
use dapple::color::Code as _;
use dapple::hash::Seed;
use dapple::mesh::Surface;
use dapple::raster::Raster;
use dapple::synth::{
    Axes as FieldAxes, Coherence, Edges, EndlessOptions, HierarchyOptions, Matching, Options,
    Symmetry, SynthError, repair_levels, sites_for_exemplar, sites_for_repeats,
};
use dapple::tile::Map;
use serde::Serialize;
use std::path::PathBuf;
use std::str::FromStr;

dapple::raster::named! {
    /// How a mesh is laid out in a texture.
    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    pub(super) enum AtlasName {
        /// Large pieces of the surface, each flattened as a whole.
        Charts = "charts",
        /// Right triangles whose sizes follow the areas of the faces.
        Area = "area",
        /// Right triangles of one size, as in the paper.
        Uniform = "uniform",
        /// The mesh's own texture coordinates; with .obj or .png, a texture for each of their unit squares (UDIM).
        Uv = "uv",
    }
}

dapple::raster::named! {
    /// A channel of an image.
    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    pub(super) enum Channel {
        /// Red.
        Red = "r",
        /// Green.
        Green = "g",
        /// Blue.
        Blue = "b",
        /// Alpha.
        Alpha = "a",
    }
}

impl Channel {
    /// Returns the channel's values in an image, as stored codes from 0 to 1; `None` if the image lacks the channel.
    pub(super) fn of(self, image: &Loaded) -> Option<Raster<f32>> {
        let at = match self {
            Self::Red => 0,
            Self::Green => 1,
            Self::Blue => 2,
            Self::Alpha => return image.alpha.clone(),
        };
        match &image.map {
            Map::Color(colors) => Some(colors.map(|color| color.to_srgb::<u16>()[at].to_unit())),
            Map::Value(_) | Map::Normal(_) => None,
        }
    }
}

dapple::raster::named! {
    /// How a texture in the plane is grown.
    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    pub(super) enum MethodName {
        /// A window of a texture without ends, whose pixels are corrected all at once: fast, and what is large or regular goes on.
        Endless = "endless",
        /// Pixel by pixel, row by row, as in Turk's paper.
        Sweep = "sweep",
    }
}

/// Without a mesh.
#[derive(clap::Args, Clone, Debug, Serialize)]
#[command(next_help_heading = "In the plane")]
pub(super) struct PlaneArgs {
    /// Output size in pixels, at most 2^26 in total [default: 512].
    #[arg(long, value_name = "WxH")]
    pub(super) size: Option<Size>,

    /// Sides that join seamlessly; `both` makes a tile [default: none].
    #[arg(long, value_parser = NamedValueParser::<Axes>::all())]
    pub(super) wrap: Option<Axes>,

    /// Synthesis method in the plane [default: endless where possible].
    ///
    /// Options that need it select `sweep`, and so does a side that wraps and is not a multiple of 2^LEVELS.
    #[arg(long, hide_short_help = true, value_parser = NamedValueParser::<MethodName>::all(), conflicts_with_all = ["repair", "replay"])]
    pub(super) method: Option<MethodName>,

    /// Column and row of an endless texture at which the image begins, each from -2^52 to 2^52 [default: 0,0].
    ///
    /// Adjacent windows fit together.
    #[arg(long, hide_short_help = true, value_name = "X,Y", allow_hyphen_values = true, conflicts_with_all = ["repair", "replay"])]
    pub(super) at: Option<Numbers<i64, 2>>,

    /// Re-synthesize only the pixels where this mask (same size) is white.
    ///
    /// All other pixels keep their values. For an example mesh the mask applies to its texture and to the maps in its
    /// material, and is filled from the surrounding surface. A repaired glTF file stays the same document with other
    /// images. With one texture per unit square (UDIM), give a mask for each, as in `mask.<UDIM>.png`, and an output
    /// NAME.1001.png.
    #[arg(long, value_name = "IMAGE", conflicts_with_all = ["size", "wrap", "evenness", "paper"])]
    pub(super) repair: Option<PathBuf>,

    /// Re-synthesize the pixels where this channel of the example is below half; with `a` the result is opaque.
    #[arg(long, hide_short_help = true, value_name = "CHANNEL", value_parser = NamedValueParser::<Channel>::all(), conflicts_with_all = ["repair", "replay", "method", "at", "size", "wrap", "evenness", "paper", "which", "guide"])]
    pub(super) repair_channel: Option<Channel>,

    /// Also write the source position of each pixel as OpenEXR: red is the column, green the row.
    #[arg(long, hide_short_help = true, value_name = "FILE.exr")]
    pub(super) sources: Option<PathBuf>,

    /// Also write an image that gives each contiguously copied piece a color.
    #[arg(long, hide_short_help = true, value_name = "FILE")]
    pub(super) pieces: Option<PathBuf>,

    /// Also write an image of the mismatch between each pixel's neighborhood and that of its source.
    ///
    /// Black continues the example perfectly; white is a quarter of the value range.
    #[arg(long, hide_short_help = true, value_name = "FILE")]
    pub(super) differences: Option<PathBuf>,

    /// Also write an image of the example that each pixel comes from: black is the first, white the last.
    #[arg(
        long,
        hide_short_help = true,
        value_name = "FILE",
        requires = "examples"
    )]
    pub(super) origins: Option<PathBuf>,

    /// Take each pixel from the position stored in this --sources image, without matching.
    ///
    /// This lays out another example of the same size, or its maps, in the same way.
    #[arg(long, hide_short_help = true, value_name = "FILE.exr", conflicts_with_all = ["size", "repair", "mask", "paper", "coherence", "evenness"])]
    pub(super) replay: Option<PathBuf>,
}

/// With a mesh.
#[derive(clap::Args, Clone, Debug, Serialize)]
#[command(next_help_heading = "On a mesh")]
pub(super) struct SurfaceArgs {
    #[arg(long, value_name = "FILE", help = format!(
        "Mesh to cover ({}); its faults are repaired",
        mesh_endings()
    ))]
    pub(super) mesh: Option<PathBuf>,

    /// Texture directions: a .csv or .json file for a mesh, an image in the plane [default: down].
    ///
    /// The image has the texture's size, and its gray is an angle: black is down, a quarter of white is to the right,
    /// and so on around to white, which is down again.
    #[arg(long, value_name = "FILE")]
    pub(super) directions: Option<PathBuf>,

    /// Texture directions on an example mesh, as a file [default: down].
    #[arg(long, hide_short_help = true, value_name = "FILE")]
    pub(super) example_directions: Option<PathBuf>,

    /// Number of sample points on an example mesh; more make its features larger [default: as --sites].
    ///
    /// With the default, features cover the same fraction of both surfaces.
    #[arg(long, hide_short_help = true, value_name = "N")]
    example_sites: Option<usize>,

    /// Number of equivalent directions: 2 for bricks, 4 for checkers [default: 1].
    ///
    /// Choose 2 for examples that look the same upside down, and 4 for those that also look the same after a quarter
    /// turn. The texture then has fewer tears.
    #[arg(long, value_name = "N", value_parser = NamedValueParser::<Symmetry>::all())]
    pub(super) symmetry: Option<Symmetry>,

    /// Number of times that the example repeats along the mesh's longest side, above 0 up to 10000 [default: 5, or what
    /// 400000 sites allow].
    ///
    /// The side is that of the bounding box. A smaller number makes larger features. It sets the number of sites.
    #[arg(long, value_name = "N", conflicts_with = "sites")]
    pub(super) repeat: Option<f64>,

    /// Number of sample points on the mesh, 1 to 2^28; more make smaller features [default: as --repeat, or 65536 with an
    /// example mesh].
    #[arg(long, hide_short_help = true, value_name = "N")]
    sites: Option<usize>,

    /// Side of the square texture in pixels, up to 16384 [default: 1024].
    #[arg(long, value_name = "PX", value_parser = clap::value_parser!(u32).range(1..=16384))]
    texture_size: Option<u32>,

    /// Texture layout of the faces [default: charts].
    #[arg(long, hide_short_help = true, value_name = "HOW", value_parser = NamedValueParser::<AtlasName>::all())]
    atlas: Option<AtlasName>,

    /// Pixels around each piece of the texture that continue it, 1 to 1024.
    ///
    /// Triangles need 2^k for k mip levels, charts 3 * 2^k for k + 2. The default is 2 for charts; for triangles a
    /// 1024th of the texture's side, up to a 16th of the room for two faces; and all that is free with `uv`.
    #[arg(long, hide_short_help = true, value_name = "PX", value_parser = clap::value_parser!(u32).range(1..=1024))]
    padding: Option<u32>,

    /// Edge angle in degrees above which shading is sharp: 0 is flat, 180 smooth [default: the mesh's normals, or 30].
    #[arg(long, hide_short_help = true, value_name = "DEGREES", value_parser = angle)]
    crease: Option<f64>,

    /// Displace the surface along its normals by the map `height` times this length; negative is inward.
    ///
    /// The length is in units of the mesh. GLB and OBJ move the vertices of the mesh, and show only detail coarser than
    /// its faces; PLY moves all sites.
    #[arg(long, value_name = "LENGTH", value_parser = length, allow_negative_numbers = true)]
    pub(super) displace: Option<f64>,

    /// How neighborhoods extend over the surface [default: followed].
    #[arg(long, hide_short_help = true, value_name = "HOW", value_parser = NamedValueParser::<FieldAxes>::all())]
    axes: Option<FieldAxes>,

    /// Values that are compared [default: appearance; colors with --paper or an example mesh].
    #[arg(long, hide_short_help = true, value_name = "WHAT", value_parser = NamedValueParser::<Matching>::all())]
    matching: Option<Matching>,
}

/// How pixels of the example are found.
#[derive(clap::Args, Clone, Debug, Serialize)]
#[command(next_help_heading = "Matching")]
pub(super) struct MatchArgs {
    /// Random seed, any whole number from 0 to 2^64 - 1.
    #[arg(long, value_name = "N", default_value_t = 0, value_parser = seed)]
    seed: u64,

    /// What lies past the edges of the example.
    #[arg(long, value_parser = NamedValueParser::<Edges>::all(), default_value_t = Edges::Cut)]
    pub(super) edges: Edges,

    /// Number of resolution levels, 1 to 16; more for larger features [default: 3, or all that fit in endless
    /// textures].
    ///
    /// For the repair of an image, the default follows the size of the hole. Each level has a quarter of the points of the
    /// next finer one.
    #[arg(long, hide_short_help = true, value_name = "N")]
    levels: Option<u32>,

    /// Weight of a map in matching, relative to one color channel, such as height=0.5; repeatable [default: 0].
    ///
    /// A map of weight 0 only follows.
    #[arg(
        long,
        hide_short_help = true,
        value_name = "NAME=N",
        requires = "map",
        conflicts_with = "replay"
    )]
    weight: Vec<WeightArg>,

    /// Preference for continuing adjacent pieces, at least 0; higher copies larger pieces [default: auto].
    ///
    /// `auto` is 2, or 0 on finer levels where the example is a regular image; it is 0 with --paper.
    #[arg(long, hide_short_help = true, value_name = "auto|N")]
    coherence: Option<Coherence>,

    /// How evenly the example is used, 0 to 1000 [default: 1, or 0 with --paper].
    #[arg(long, hide_short_help = true, value_name = "N")]
    evenness: Option<f32>,

    /// Match as in Turk (2001).
    ///
    /// The smallest difference wins, and neighborhoods extend straight. Textures of meshes average the colors of sites,
    /// and are softer than the example.
    #[arg(long, hide_short_help = true)]
    pub(super) paper: bool,
}

/// Returns the name of the first option that was given. `options` are pairs of a name and whether it was given.
pub(super) fn first_given(options: &[(&'static str, bool)]) -> Option<&'static str> {
    let given = options.iter().find(|(_, is_given)| *is_given);
    given.map(|&(name, _)| name)
}

/// Parses a finite length, which may be negative.
fn length(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(length) if length.is_finite() => Ok(length),
        _ => Err(format!("{text:?} is not a length")),
    }
}

/// The weight of a map, given as `NAME=N`.
#[derive(Clone, Debug, Serialize)]
struct WeightArg {
    name: String,
    weight: f32,
}

impl FromStr for WeightArg {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let parts = text.split_once('=');
        let parts = parts.and_then(|(name, weight)| Some((name, weight.parse::<f32>().ok()?)));
        match parts {
            Some((name, weight)) if weight >= 0.0 && weight.is_finite() => Ok(Self {
                name: name.to_owned(),
                weight,
            }),
            _ => Err(format!(
                "{text:?} is not a weight: give NAME=N, such as height=0.5, with N at least 0"
            )),
        }
    }
}

/// Parses an angle from 0 to 180 degrees.
fn angle(text: &str) -> Result<f64, String> {
    match text.parse() {
        Ok(angle) if (0.0..=180.0).contains(&angle) => Ok(angle),
        _ => Err(format!("{text:?} is not an angle from 0 to 180 degrees")),
    }
}

impl PlaneArgs {
    /// Returns the name of a given option that only applies to textures in the plane; `None` if there is none.
    pub(super) fn given(&self) -> Option<&'static str> {
        first_given(&[
            ("size", self.size.is_some()),
            ("wrap", self.wrap.is_some()),
            ("method", self.method.is_some()),
            ("at", self.at.is_some()),
            ("repair", self.repair.is_some()),
            ("repair-channel", self.repair_channel.is_some()),
            ("sources", self.sources.is_some()),
            ("pieces", self.pieces.is_some()),
            ("differences", self.differences.is_some()),
            ("origins", self.origins.is_some()),
            ("replay", self.replay.is_some()),
        ])
    }

    /// Returns, for each axis, whether the texture wraps or is cut.
    pub(super) fn edges(&self) -> [Edges; 2] {
        let wrap = self.wrap.unwrap_or(Axes::None);
        wrap.flags()
            .map(|wraps| if wraps { Edges::Wrap } else { Edges::Cut })
    }
}

impl SurfaceArgs {
    /// Returns the name of a given option that only applies to a mesh; `None` if there is none.
    pub(super) fn given(&self) -> Option<&'static str> {
        first_given(&[
            ("symmetry", self.symmetry.is_some()),
            ("repeat", self.repeat.is_some()),
            ("sites", self.sites.is_some()),
            ("texture-size", self.texture_size.is_some()),
            ("atlas", self.atlas.is_some()),
            ("padding", self.padding.is_some()),
            ("crease", self.crease.is_some()),
            ("displace", self.displace.is_some()),
            ("axes", self.axes.is_some()),
            ("matching", self.matching.is_some()),
        ])
    }

    /// Returns the name of a given option that only applies to an example that is a mesh; `None` if there is none.
    pub(super) fn given_for_example(&self) -> Option<&'static str> {
        first_given(&[
            ("example-directions", self.example_directions.is_some()),
            ("example-sites", self.example_sites.is_some()),
        ])
    }

    /// Returns the options for placing sites on a mesh that is the example.
    pub(super) fn example_sites(&self, matching: &MatchArgs) -> HierarchyOptions {
        let sites = self.sites(matching);
        HierarchyOptions {
            n_sites: self.example_sites.unwrap_or(sites.n_sites),
            seed: Seed(matching.seed).child("example sites", 0),
            ..sites
        }
    }

    /// Returns the side of the square texture, in pixels.
    pub(super) fn side(&self) -> u32 {
        self.texture_size.unwrap_or(1024)
    }

    pub(super) fn atlas(&self) -> AtlasName {
        self.atlas.unwrap_or(AtlasName::Charts)
    }

    pub(super) fn padding(&self) -> Option<u32> {
        self.padding
    }

    /// Returns the angle above which an edge is a crease, in radians; `None` if it was not given.
    pub(super) fn crease(&self) -> Option<f64> {
        self.crease.map(f64::to_radians)
    }

    /// Returns the options for placing sites on the mesh that is textured. They have one level per level of matching.
    pub(super) fn sites(&self, matching: &MatchArgs) -> HierarchyOptions {
        let default = HierarchyOptions::default();
        HierarchyOptions {
            n_sites: self.sites.unwrap_or(default.n_sites),
            n_levels: matching.n_levels(),
            seed: Seed(matching.seed).child("sites", 0),
            ..default
        }
    }
}

impl SurfaceArgs {
    /// Returns the options for placing sites on a surface. Without `--sites`, the number of sites is computed from the
    /// number of repeats and from `size`, the example's size in pixels.
    ///
    /// # Errors
    ///
    /// If the number of repeats is out of range.
    pub(super) fn sites_on(
        &self,
        surface: &Surface,
        size: [u32; 2],
        matching: &MatchArgs,
    ) -> Result<HierarchyOptions, SynthError> {
        let sites = self.sites(matching);
        let n_sites = match (self.repeat, self.sites) {
            (Some(repeats), _) => sites_for_repeats(surface, size, repeats)?,
            (None, Some(n_sites)) => n_sites,
            (None, None) => sites_for_exemplar(surface, size),
        };
        Ok(HierarchyOptions { n_sites, ..sites })
    }
}

impl MatchArgs {
    /// Returns the matching weight of the map called `name`; 0 if it has no weight.
    pub(super) fn weight_of(&self, name: &str) -> f32 {
        let given = self.weight.iter().find(|weight| weight.name == name);
        given.map_or(0.0, |given| given.weight)
    }

    /// Refuses weights for maps that were not given, and duplicate weights for one map.
    ///
    /// # Errors
    ///
    /// If there is such a weight. The error names the first one.
    pub(super) fn check_weights(&self, maps: &[&str]) -> Result<()> {
        for (at, WeightArg { name, .. }) in self.weight.iter().enumerate() {
            if !maps.contains(&name.as_str()) {
                let error = usage(format!("--weight {name}: there is no --map {name}"));
                return Err(error.hint(format!("maps are {}", maps.join(", "))));
            }
            if self.weight[..at].iter().any(|other| other.name == *name) {
                let error = usage(format!("--weight {name} is given twice"));
                return Err(error.hint("leave one of them out"));
            }
        }
        Ok(())
    }

    /// Returns the name of a given option that has no effect on an endless texture; `None` if there is none.
    pub(super) fn given_for_sweeps(&self) -> Option<&'static str> {
        first_given(&[
            ("coherence", self.coherence.is_some()),
            ("evenness", self.evenness.is_some()),
            ("paper", self.paper),
        ])
    }

    /// Returns the number of levels of a sweep.
    fn n_levels(&self) -> usize {
        self.levels
            .map_or(Options::default().n_levels, |levels| levels as usize)
    }

    /// Returns the number of levels for repairing a hole in an image. By default, it depends on the size of the hole.
    pub(super) fn repair_levels(&self, hole: &Raster<bool>) -> usize {
        self.levels
            .map_or_else(|| repair_levels(hole), |levels| levels as usize)
    }

    /// Returns the options for an endless texture. `period` is in pixels; `None` for axes along which the texture does
    /// not repeat.
    pub(super) fn endless(&self, period: [Option<u32>; 2]) -> EndlessOptions {
        EndlessOptions {
            seed: Seed(self.seed),
            n_levels: self.levels,
            period,
        }
    }

    /// Returns the options for a sweep.
    pub(super) fn options(&self, surface: &SurfaceArgs) -> Options {
        let default = if self.paper {
            Options::paper()
        } else {
            Options::default()
        };
        Options {
            seed: Seed(self.seed),
            n_levels: self.n_levels(),
            // Use the paper's schedule for this number of levels.
            schedule: None,
            coherence: self.coherence.unwrap_or(default.coherence),
            evenness: self.evenness.unwrap_or(default.evenness),
            axes: surface.axes.unwrap_or(default.axes),
            center: default.center,
            matching: surface.matching.unwrap_or(default.matching),
            sources: default.sources,
        }
    }
}
