//! `dapple pups`: renders partition-of-unity textures.

mod points;

use crate::args::{Extent, ImageArgs, Numbers, ReadArgs, image_alpha};
use crate::baking::read_picture;
use crate::error::{Exit, Hint, usage};
use crate::field::{Field, FieldArgs, draw, extent_of};
use crate::input::ALPHA_HINT;
use crate::job::Context;
use crate::words::{NamedValueParser, with_dashes};
use anyhow::{Error, Result};
use clap::ValueEnum;
use clap::builder::PossibleValue;
use dapple::pups::{AxialWeight, Orientations};
use dapple::recipe::{ImageAlpha, Images, Node, PupsNode};
use serde::{Serialize, Serializer};
use serde_json::{Value, json};
use std::path::PathBuf;
use std::slice;

const EXAMPLES: &str = "\
Examples:
  dapple pups noise -o noise.png
  dapple pups turbulence --spacing 0.3 --octaves 5 --size 1024 -o turbulence.png
  dapple pups cow --probability 0.4 --seed 5 -o cow.png
  dapple pups giraffe --ramp '#7a4a1e,#f2e3c0' -o giraffe.png
  dapple pups cells --points-per-cell 3,4 --ramp lagoon -o cells.png
  dapple pups noise --orientations random --strength 0.8 -o twisted.png
  dapple pups ramp --wrap y -o ramp.png
  dapple pups reference --reference photo.png --spacing 0.03 -o cells.png
  dapple pups noise --frames 24 --size 256 -o waves/
  dapple pups control --points control.csv --size 256 -o own.png

The picture is 2 units along its shorter side, as the paper's torus, unless --extent says
otherwise; --spacing is in the same units. Control points of your own are `x,y,value` lines
of CSV, with `,ox,oy` for an orientation, or JSON: [{\"x\": 0.5, \"y\": 1, \"value\": 0.3}, …].";

/// Draw a partition-of-unity texture: values at scattered points, blended by their neighborhoods.
#[derive(clap::Args, Debug, Serialize)]
#[command(after_help = EXAMPLES)]
pub(crate) struct Args {
    /// Which texture.
    #[arg(value_enum, value_name = "KIND")]
    kind: Kind,

    /// Minimum distance of control points in units of the plane [default: the texture's].
    #[arg(long, value_name = "UNITS", help_heading = "Texture")]
    spacing: Option<f64>,

    /// Minimum distances at the left and at the right, for the progressions.
    #[arg(long, value_name = "LEFT,RIGHT", help_heading = "Texture")]
    spacings: Option<Numbers<f64, 2>>,

    /// Width and height of the image in units of the plane.
    #[arg(long, value_name = "W[xH]", alias = "period", help_heading = "Texture")]
    extent: Option<Extent>,

    /// Number of octaves, layers or rounds, for octaves, turbulence, cellular-noise and iterated-reference.
    #[arg(long, value_name = "N", help_heading = "Texture")]
    octaves: Option<u32>,

    /// Amplitude of an octave relative to the previous one.
    #[arg(
        long,
        alias = "persistence",
        value_name = "PART",
        help_heading = "Texture"
    )]
    gain: Option<f64>,

    /// Minimum and maximum number of control points per cell, for cells and cellular-noise.
    #[arg(long, value_name = "MIN,MAX", help_heading = "Texture")]
    points_per_cell: Option<Numbers<u32, 2>>,

    /// Probability of white patches, from 0 to 1, for cow.
    #[arg(long, value_name = "PART", help_heading = "Texture")]
    probability: Option<f64>,

    /// Choose each radius of a spot independently, as in the paper, for giraffe: spots break into pieces.
    #[arg(long, help_heading = "Texture")]
    literal: bool,

    /// Control points as CSV or JSON, for control.
    #[arg(long, value_name = "FILE", help_heading = "Texture")]
    points: Option<PathBuf>,

    /// Image that cells follow, for reference and iterated-reference; color is read as luminance.
    #[arg(long, value_name = "FILE", help_heading = "Texture")]
    reference: Option<PathBuf>,

    /// Handling of that image's transparency, an error by default: `drop`, or `over:COLOR` such as `over:black`.
    #[arg(long, value_name = "drop|over:COLOR", value_parser = image_alpha, requires = "reference")]
    alpha: Option<ImageAlpha>,

    #[command(flatten)]
    #[serde(flatten)]
    read: ReadArgs,

    /// Assign each position the value of its strongest point alone, for control.
    #[arg(long, help_heading = "Texture")]
    hard: bool,

    /// Length of axes relative to their edges, above 0.5 up to 16.
    #[arg(long, value_name = "N", help_heading = "Weights")]
    axis_scale: Option<f64>,

    /// Falloff of weights along an axis: the paper's cubic, or a quintic with a continuous second derivative.
    #[arg(long, value_name = "CURVE", value_parser = NamedValueParser::of([("cubic", AxialWeight::Cubic), ("quintic", AxialWeight::Quintic)]), help_heading = "Weights")]
    weight: Option<AxialWeight>,

    /// Orientations of control points [default: the texture's].
    #[arg(long, value_name = "WHICH", value_parser = NamedValueParser::of([("none", Orientations::None), ("random", Orientations::Random)]), help_heading = "Weights")]
    orientations: Option<Orientations>,

    /// Strength of orientations, from 0 to below 1.
    #[arg(long, value_name = "PART", help_heading = "Weights")]
    strength: Option<f64>,

    /// Number of frames of a loop in which the control points move on circles.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=100_000), help_heading = "Loop")]
    frames: Option<u32>,

    /// Largest radius of moving points, relative to the mean distance of neighbors, above 0 up to 1 [default: 0.25 with
    /// --frames].
    ///
    /// Without either option the points do not move.
    #[arg(long, value_name = "PART", help_heading = "Loop")]
    motion: Option<f64>,

    #[command(flatten)]
    field: FieldArgs,

    #[command(flatten)]
    #[serde(skip)]
    image: ImageArgs,
}

/// A kind of texture, as an index into [`PupsNode::KINDS`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Kind(usize);

/// Textures that have a shorter name on the command line, as pairs of the name in recipes and the short name.
const SHORT_NAMES: [(&str, &str); 3] = [
    ("space_giraffe", "giraffe"),
    ("label_ramp", "ramp"),
    ("points", "control"),
];

const KINDS: [Kind; PupsNode::KINDS.len()] = {
    let mut kinds = [Kind(0); PupsNode::KINDS.len()];
    let mut index = 0;
    while index < kinds.len() {
        kinds[index] = Kind(index);
        index += 1;
    }
    kinds
};

impl Kind {
    /// Returns the texture's name in recipes.
    fn in_recipes(self) -> &'static str {
        PupsNode::KINDS[self.0].0
    }

    /// Returns the texture's name on the command line.
    fn name(self) -> String {
        let name = self.in_recipes();
        let short = SHORT_NAMES.iter().find(|(long, _)| *long == name);
        with_dashes(short.map_or(name, |(_, short)| short))
    }

    /// Returns the texture with its default options, as JSON.
    fn defaults(self) -> Result<Value> {
        let texture = PupsNode::of_kind(self.in_recipes());
        Ok(texture.map_or(Ok(Value::Null), |texture| texture.to_json())?)
    }
}

impl ValueEnum for Kind {
    fn value_variants<'a>() -> &'a [Self] {
        &KINDS
    }

    fn to_possible_value(&self) -> Option<PossibleValue> {
        let (name, about) = PupsNode::KINDS[self.0];
        let value = PossibleValue::new(self.name()).help(about.trim_end_matches('.'));
        Some(value.alias(with_dashes(name)).alias(name))
    }
}

impl Serialize for Kind {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.serialize_str(&self.name())
    }
}

/// Renders the texture.
///
/// # Errors
///
/// If an option does not apply to the texture or is out of range, or if a file cannot be read or written.
pub(crate) fn run(args: &Args, context: &Context) -> Result<Exit> {
    let node = args.node()?;
    let field = Field {
        command: "pups",
        is_color: node.is_color(),
        images: args.images(&node)?,
        node: Node::Pups(node),
        extent: match &args.extent {
            Some(extent) => extent.0,
            None => extent_of(args.field.spaces()?, SIDE),
        },
        range: [0.0, 1.0],
        frames: args.frames,
    };
    draw(&field, &args.field, &args.image, args, context)
}

/// Default radius of the circles on which points move, as a fraction of the mean distance between neighbors. Points of
/// a Poisson-disk set remain apart at this radius.
const MOTION: f64 = 0.25;

/// Default shorter side of the image, in units of the plane. It is the side of the paper's torus.
const SIDE: f64 = 2.0;

/// An option that was given on the command line, as JSON.
struct Given {
    option: &'static str,
    /// The names that the option may have in a texture's options. A texture has at most one of them.
    names: &'static [&'static str],
    value: Value,
}

impl Args {
    /// Returns the texture with the options of the command line.
    fn node(&self) -> Result<PupsNode> {
        // Set each given option in the default options of the texture.
        let kind = self.kind;
        let mut data = kind.defaults()?;
        for given in self.given()? {
            let Some(path) = path(&data, kind, given.names) else {
                return Err(not_for(&given, kind));
            };
            if let Some(option) = data.pointer_mut(&path) {
                *option = given.value;
            }
        }
        let radius = self.motion.or(self.frames.map(|_| MOTION));
        let motion = given("--motion", &["net"], radius)?;
        if let Some(motion) = motion
            && let Some(path) = path(&data, kind, motion.names)
            && let Some(net) = data.pointer_mut(&path)
        {
            net["motion"] = json!({ "radius": motion.value });
        }
        if let Some(alpha) = self.alpha {
            data[kind.in_recipes()]["alpha"] = serde_json::to_value(alpha)?;
        }
        if kind.in_recipes() == "points" && self.points.is_none() {
            return Err(usage("there are no control points").hint("give them with --points FILE"));
        }
        Ok(PupsNode::from_json(&data)?)
    }

    /// Returns the texture options that were given on the command line.
    fn given(&self) -> Result<Vec<Given>> {
        let points = self.points.as_deref().map(points::read).transpose()?;
        let spacings = self.spacings.map(|Numbers(distances)| distances);
        let counts = self.points_per_cell.map(|Numbers(counts)| counts);
        let literal = self.literal.then_some("literal");
        let hard = self.hard.then_some("hard");
        let reference = self.reference.as_ref().map(|file| file.to_string_lossy());
        let of_series = &["octaves", "layers", "iterations"];
        let all = [
            given("--spacing", &["spacing"], self.spacing)?,
            given("--spacings", &["distances"], spacings)?,
            given("--octaves", of_series, self.octaves)?,
            given("--gain", &["gain"], self.gain)?,
            given("--points-per-cell", &["points_per_cell"], counts)?,
            given("--probability", &["probability"], self.probability)?,
            given("--literal", &["spots"], literal)?,
            given("--points", &["points"], points)?,
            given("--hard", &["cells"], hard)?,
            given("--reference", &["file"], reference)?,
            given("--axis-scale", &["axis_scale"], self.axis_scale)?,
            given("--weight", &["weight"], self.weight)?,
            given(
                "--orientations",
                &["orientations"],
                self.orientations.as_ref(),
            )?,
            given("--strength", &["strength"], self.strength)?,
        ];
        Ok(all.into_iter().flatten().collect())
    }

    /// Reads the reference image, if the texture needs one.
    fn images(&self, node: &PupsNode) -> Result<Images> {
        let Some(name) = node.image_file() else {
            return Ok(Images::new());
        };
        let Some(file) = self.reference.as_deref() else {
            let error = usage("there is no image to follow");
            return Err(error.hint("give it with --reference FILE"));
        };
        let picture = read_picture(file, self.alpha, &self.read, ALPHA_HINT)?;
        Ok(Images::from([(name.to_owned(), picture)]))
    }
}

/// Returns the JSON pointer to the option with one of these names in a texture's options; `None` if there is no such
/// option.
fn path(data: &Value, kind: Kind, names: &[&str]) -> Option<String> {
    let kind = kind.in_recipes();
    let parts = ["", "/options", "/net", "/options/net"];
    let mut paths = parts.iter().flat_map(|part| {
        names
            .iter()
            .map(move |name| format!("/{kind}{part}/{name}"))
    });
    paths.find(|path| data.pointer(path).is_some())
}

/// Returns the error for an option that a texture does not have. The hint lists the textures that have it.
fn not_for(given: &Given, kind: Kind) -> Error {
    let has_it = |&kind: &Kind| {
        kind.defaults()
            .is_ok_and(|data| path(&data, kind, given.names).is_some())
    };
    let others: Vec<_> = KINDS.into_iter().filter(has_it).map(Kind::name).collect();
    usage(format!("{} is not for {}", given.option, kind.name()))
        .hint(format!("it is for {}", others.join(", ")))
}

/// Converts an option to JSON, if it was given. Fails for NaN and infinite numbers.
fn given(
    option: &'static str,
    names: &'static [&'static str],
    value: Option<impl Serialize>,
) -> Result<Option<Given>> {
    let Some(value) = value else {
        return Ok(None);
    };
    let value = serde_json::to_value(value)?;
    // Serde writes NaN and infinite numbers as null.
    let parts = value
        .as_array()
        .map_or(slice::from_ref(&value), Vec::as_slice);
    if parts.contains(&Value::Null) {
        return Err(usage(format!("{option} must be finite")));
    }
    Ok(Some(Given {
        option,
        names,
        value,
    }))
}
