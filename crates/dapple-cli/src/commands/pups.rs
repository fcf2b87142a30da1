//! `dapple pups`: renders partition-of-unity textures.

mod flags;
mod points;

use crate::args::{Extent, ImageArgs, ReadArgs, image_alpha};
use crate::baking::read_picture;
use crate::error::{Exit, Hint, usage};
use crate::field::{Field, FieldArgs, draw, extent_of};
use crate::input::ALPHA_HINT;
use crate::job::Context;
use crate::node::NodeArgs;
use crate::words::with_dashes;
use anyhow::{Error, Result};
use clap::ValueEnum;
use clap::builder::PossibleValue;
use dapple::recipe::{ImageAlpha, Images, Node, PupsNode};
use flags::PupsFlags;
use serde::{Serialize, Serializer};
use serde_json::{Value, json};
use std::path::PathBuf;

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

    /// Width and height of the image in units of the plane.
    #[arg(long, value_name = "W[xH]", alias = "period", help_heading = "Texture")]
    extent: Option<Extent>,

    #[command(flatten)]
    #[serde(flatten)]
    textures: NodeArgs<PupsFlags>,

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

impl Args {
    /// Returns the texture with the options of the command line.
    fn node(&self) -> Result<PupsNode> {
        // Set each given option in the default options of the texture.
        let kind = self.kind;
        let mut data = kind.defaults()?;
        for given in self.textures.given() {
            given.check_finite()?;
            put(
                &mut data,
                kind,
                &given.flag,
                &given.path,
                given.value.clone(),
            )?;
        }
        if self.hard {
            put(&mut data, kind, "hard", "cells", json!("hard"))?;
        }
        if let Some(points) = &self.points {
            let points = serde_json::to_value(points::read(points)?)?;
            put(&mut data, kind, "points", "points", points)?;
        }
        if let Some(file) = &self.reference {
            put(
                &mut data,
                kind,
                "reference",
                "file",
                json!(file.to_string_lossy()),
            )?;
        }
        if let Some(radius) = self.motion.or(self.frames.map(|_| MOTION)) {
            if !radius.is_finite() {
                return Err(usage("--motion must be finite"));
            }
            if let Some(path) = path(&data, kind, "net")
                && let Some(net) = data.pointer_mut(&path)
            {
                net["motion"] = json!({ "radius": radius });
            }
        }
        if let Some(alpha) = self.alpha {
            data[kind.in_recipes()]["alpha"] = serde_json::to_value(alpha)?;
        }
        if kind.in_recipes() == "points" && self.points.is_none() {
            return Err(usage("there are no control points").hint("give them with --points FILE"));
        }
        Ok(PupsNode::from_json(&data)?)
    }

    /// Reads the guiding image, if the texture needs one.
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

/// Sets the option called `name` of a texture. `flag` is the flag that the user typed. An option that shares its flag
/// has another name in some textures.
///
/// # Errors
///
/// If the texture does not have the option.
fn put(data: &mut Value, kind: Kind, flag: &str, name: &str, value: Value) -> Result<()> {
    let mut paths = flags::names_of(name).into_iter();
    match paths.find_map(|name| path(data, kind, name)) {
        Some(path) => {
            if let Some(option) = data.pointer_mut(&path) {
                *option = value;
            }
            Ok(())
        }
        None => Err(not_for(flag, name, kind)),
    }
}

/// Returns the JSON pointer to the option called `name` in `data`, a texture's options; `None` if the texture lacks the
/// option.
fn path(data: &Value, kind: Kind, name: &str) -> Option<String> {
    let kind = kind.in_recipes();
    let parts = ["", "/options", "/net", "/options/net"];
    let mut paths = parts.iter().map(|part| format!("/{kind}{part}/{name}"));
    paths.find(|path| data.pointer(path).is_some())
}

/// Returns the error for an option that a texture does not have. The hint lists the textures that have it.
fn not_for(flag: &str, name: &str, kind: Kind) -> Error {
    let has_it = |&kind: &Kind| {
        let names = flags::names_of(name);
        kind.defaults()
            .is_ok_and(|data| names.iter().any(|name| path(&data, kind, name).is_some()))
    };
    let others: Vec<_> = KINDS.into_iter().filter(has_it).map(Kind::name).collect();
    usage(format!("--{flag} is not for {}", kind.name()))
        .hint(format!("it is for {}", others.join(", ")))
}
