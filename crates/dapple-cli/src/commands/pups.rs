//! `dapple pups`: partition-of-unity textures.

mod points;

use crate::args::{Extent, ImageArgs, Numbers, image_alpha};
use crate::baking::read_picture;
use crate::error::{Exit, Hint, usage};
use crate::field::{Field, FieldArgs, draw, extent_of};
use crate::input::ALPHA_HINT;
use crate::job::Context;
use crate::words::Word;
use anyhow::Result;
use clap::ValueEnum;
use dapple::pups::{
    AxialWeight, CellsOptions, CellularNoiseOptions, ColorNoiseOptions, CowOptions,
    LabelRampOptions, NetOptions, NoiseOptions, OctavesOptions, Orientations, ProgressionOptions,
    ReferenceOptions, SpaceGiraffeOptions, Spacing, Spots,
};
use dapple::raster::Varying;
use dapple::recipe::{Cells, ControlPoints, ImageAlpha, Images, Node, PupsNode, Referenced};
use serde::Serialize;
use std::path::{Path, PathBuf};

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

    /// The smallest distance of control points, in units of the plane; by default that of the texture.
    #[arg(long, value_name = "UNITS", help_heading = "Texture")]
    spacing: Option<f64>,

    /// The smallest distances at the left and at the right, for the progressions.
    #[arg(long, value_name = "LEFT,RIGHT", help_heading = "Texture")]
    spacings: Option<Numbers<f64, 2>>,

    /// The width and height of the picture in units of the plane.
    #[arg(long, value_name = "W[xH]", alias = "period", help_heading = "Texture")]
    extent: Option<Extent>,

    /// How many octaves or layers, for octaves, turbulence and cellular-noise.
    #[arg(long, value_name = "N", help_heading = "Texture")]
    octaves: Option<u32>,

    /// How high an octave is beside the one before.
    #[arg(
        long,
        alias = "persistence",
        value_name = "PART",
        help_heading = "Texture"
    )]
    gain: Option<f64>,

    /// How many control points a cell has, from the least to the most, for cells and cellular-noise.
    #[arg(long, value_name = "MIN,MAX", help_heading = "Texture")]
    points_per_cell: Option<Numbers<u32, 2>>,

    /// How probable white patches are, from 0 to 1, for cow.
    #[arg(long, value_name = "PART", help_heading = "Texture")]
    probability: Option<f64>,

    /// Draw each radius of a spot on its own, as the paper's recipe does, for giraffe: spots break into pieces.
    #[arg(long, help_heading = "Texture")]
    literal: bool,

    /// The control points, for control: CSV or JSON.
    #[arg(long, value_name = "FILE", help_heading = "Texture")]
    points: Option<PathBuf>,

    /// The image that cells follow, for reference: gray, or color by its luminance.
    #[arg(long, value_name = "FILE", help_heading = "Texture")]
    reference: Option<PathBuf>,

    /// What becomes of the transparency of that image, which is refused otherwise: `drop` takes the colors without it, and
    /// `over:COLOR` lays the image over a color, such as `over:black`.
    #[arg(long, value_name = "drop|over:COLOR", value_parser = image_alpha, requires = "reference")]
    alpha: Option<ImageAlpha>,

    /// Give each place the value of its strongest point alone, for control.
    #[arg(long, help_heading = "Texture")]
    hard: bool,

    /// The length of axes as a multiple of their edges, above 0.5 and at most 16.
    #[arg(long, value_name = "N", help_heading = "Weights")]
    axis_scale: Option<f64>,

    /// How weights fall off along an axis: by the cubic of the paper, or by a quintic with a continuous second derivative.
    #[arg(long, value_name = "CURVE", value_parser = Word::<AxialWeight>::of(&["cubic", "quintic"]), help_heading = "Weights")]
    weight: Option<AxialWeight>,

    /// Whether control points have orientations; by default as the texture has it.
    #[arg(long, value_name = "WHICH", value_parser = Word::<Orientations>::of(&["none", "random"]), help_heading = "Weights")]
    orientations: Option<Orientations>,

    /// How strongly orientations shift weights, from 0 to below 1.
    #[arg(long, value_name = "PART", help_heading = "Weights")]
    strength: Option<f64>,

    #[command(flatten)]
    field: FieldArgs,

    #[command(flatten)]
    #[serde(skip)]
    image: ImageArgs,
}

/// Which texture.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum, Serialize)]
#[serde(rename_all = "kebab-case")]
enum Kind {
    /// Random values, interpolated.
    Noise,
    /// Octaves of noise.
    Octaves,
    /// Octaves of folded noise.
    Turbulence,
    /// Cells with a random value each.
    Cells,
    /// Layers of cells.
    #[value(alias = "cellular_noise")]
    CellularNoise,
    /// Random colors, interpolated.
    #[value(alias = "color_noise")]
    ColorNoise,
    /// The patches of a cow.
    Cow,
    /// The spots of a giraffe.
    Giraffe,
    /// A cow whose patches get smaller to the right.
    #[value(alias = "cow_progression")]
    CowProgression,
    /// A giraffe whose spots get smaller to the right.
    #[value(alias = "giraffe_progression")]
    GiraffeProgression,
    /// Black cells on the left, white ones on the right.
    Ramp,
    /// Control points of your own: --points.
    Control,
    /// Black and white cells after an image: --reference.
    Reference,
}

/// Runs it.
///
/// # Errors
///
/// Whatever went wrong.
pub(crate) fn run(args: &Args, context: &Context) -> Result<Exit> {
    args.check()?;
    let field = Field {
        command: "pups",
        node: Node::Pups(args.node()?),
        is_color: args.kind == Kind::ColorNoise,
        extent: args
            .extent
            .map_or_else(|| extent_of(args.field.size, SIDE), |extent| extent.0),
        range: [0.0, 1.0],
        frames: None,
        images: args.images()?,
    };
    draw(&field, &args.field, &args.image, args, context)
}

/// The shorter side of a picture, in units of the plane: that of the paper's torus.
const SIDE: f64 = 2.0;

impl Args {
    /// Refuses options that the texture does not have.
    fn check(&self) -> Result<()> {
        use Kind::{
            Cells, CellularNoise, Control, Cow, CowProgression, Giraffe, GiraffeProgression,
            Octaves, Reference, Turbulence,
        };
        let progressions = [CowProgression, GiraffeProgression];
        let rules: [(&str, bool, &[Kind]); 10] = [
            ("--spacings", self.spacings.is_some(), &progressions),
            (
                "--octaves",
                self.octaves.is_some(),
                &[Octaves, Turbulence, CellularNoise],
            ),
            (
                "--gain",
                self.gain.is_some(),
                &[Octaves, Turbulence, CellularNoise],
            ),
            (
                "--points-per-cell",
                self.points_per_cell.is_some(),
                &[Cells, CellularNoise],
            ),
            ("--probability", self.probability.is_some(), &[Cow]),
            ("--literal", self.literal, &[Giraffe]),
            ("--points", self.points.is_some(), &[Control]),
            ("--hard", self.hard, &[Control]),
            ("--reference", self.reference.is_some(), &[Reference]),
            (
                "--spacing",
                self.spacing.is_some()
                    && (progressions.contains(&self.kind) || self.kind == Control),
                &[],
            ),
        ];
        for (option, is_given, kinds) in rules {
            if is_given && !kinds.contains(&self.kind) {
                let error = usage(format!("{option} is not for {}", name(self.kind)));
                let names: Vec<_> = kinds.iter().map(|&kind| name(kind)).collect();
                return Err(if names.is_empty() {
                    error.hint("take --spacings LEFT,RIGHT for progressions; points of your own have their places")
                } else {
                    error.hint(format!("it is for {}", names.join(", ")))
                });
            }
        }
        Ok(())
    }

    fn node(&self) -> Result<PupsNode> {
        Ok(match self.kind {
            Kind::Noise => {
                PupsNode::Noise(self.texture(|o: &mut NoiseOptions| (&mut o.spacing, &mut o.net)))
            }
            Kind::Octaves => PupsNode::Octaves(self.layers(|o: &mut OctavesOptions| {
                (&mut o.spacing, &mut o.net, &mut o.octaves, &mut o.gain)
            })),
            Kind::Turbulence => PupsNode::Turbulence(self.layers(|o: &mut OctavesOptions| {
                (&mut o.spacing, &mut o.net, &mut o.octaves, &mut o.gain)
            })),
            Kind::Cells => {
                let mut options = self.texture(|o: &mut CellsOptions| (&mut o.spacing, &mut o.net));
                self.set_points_per_cell(&mut options.points_per_cell);
                PupsNode::Cells(options)
            }
            Kind::CellularNoise => {
                let mut options = self.layers(|o: &mut CellularNoiseOptions| {
                    (&mut o.spacing, &mut o.net, &mut o.layers, &mut o.gain)
                });
                self.set_points_per_cell(&mut options.points_per_cell);
                PupsNode::CellularNoise(options)
            }
            Kind::ColorNoise => PupsNode::ColorNoise(
                self.texture(|o: &mut ColorNoiseOptions| (&mut o.spacing, &mut o.net)),
            ),
            Kind::Cow => {
                let mut options = self.texture(|o: &mut CowOptions| (&mut o.spacing, &mut o.net));
                if let Some(probability) = self.probability {
                    options.probability = Varying::Constant(probability);
                }
                PupsNode::Cow(options)
            }
            Kind::Giraffe => {
                let mut options =
                    self.texture(|o: &mut SpaceGiraffeOptions| (&mut o.spacing, &mut o.net));
                if self.literal {
                    options.spots = Spots::Literal;
                }
                PupsNode::SpaceGiraffe(options)
            }
            Kind::CowProgression => PupsNode::CowProgression(self.progression()),
            Kind::GiraffeProgression => PupsNode::GiraffeProgression(self.progression()),
            Kind::Ramp => PupsNode::LabelRamp(
                self.texture(|o: &mut LabelRampOptions| (&mut o.spacing, &mut o.net)),
            ),
            Kind::Control => PupsNode::Points(self.control()?),
            Kind::Reference => PupsNode::Reference(Referenced {
                file: self.reference_file()?.to_string_lossy().into_owned(),
                alpha: self.alpha,
                options: self.texture(|o: &mut ReferenceOptions| (&mut o.spacing, &mut o.net)),
            }),
        })
    }

    /// The options of a texture with what the command line says of its control points.
    fn texture<T: Default>(&self, parts: impl Fn(&mut T) -> (&mut Spacing, &mut NetOptions)) -> T {
        let mut options = T::default();
        let (spacing, net) = parts(&mut options);
        if let Some(distance) = self.spacing {
            *spacing = Spacing::from(distance);
        }
        self.set_net(net);
        options
    }

    /// The same for a texture of several layers.
    fn layers<T: Default>(
        &self,
        parts: impl Fn(&mut T) -> (&mut Spacing, &mut NetOptions, &mut u32, &mut f64),
    ) -> T {
        let mut options = self.texture(|options| {
            let (spacing, net, _, _) = parts(options);
            (spacing, net)
        });
        let (_, _, layers, gain) = parts(&mut options);
        *layers = self.octaves.unwrap_or(*layers);
        *gain = self.gain.unwrap_or(*gain);
        options
    }

    fn progression(&self) -> ProgressionOptions {
        let mut options = ProgressionOptions::default();
        if let Some(Numbers(distances)) = self.spacings {
            options.distances = distances;
        }
        self.set_net(&mut options.net);
        options
    }

    fn control(&self) -> Result<ControlPoints> {
        let Some(file) = &self.points else {
            return Err(usage("there are no control points").hint("give them with --points FILE"));
        };
        let mut net = NetOptions::default();
        self.set_net(&mut net);
        Ok(ControlPoints {
            points: points::read(file)?,
            net,
            cells: if self.hard { Cells::Hard } else { Cells::Mixed },
        })
    }

    fn reference_file(&self) -> Result<&Path> {
        let file = self.reference.as_deref();
        file.ok_or_else(|| {
            usage("there is no image to follow").hint("give it with --reference FILE")
        })
    }

    /// The image that the texture follows, if it follows one.
    fn images(&self) -> Result<Images> {
        if self.kind != Kind::Reference {
            return Ok(Images::new());
        }
        let file = self.reference_file()?;
        let picture = read_picture(file, self.alpha, ALPHA_HINT)?;
        Ok(Images::from([(
            file.to_string_lossy().into_owned(),
            picture,
        )]))
    }

    fn set_points_per_cell(&self, counts: &mut [u32; 2]) {
        if let Some(Numbers(least_and_most)) = self.points_per_cell {
            *counts = least_and_most;
        }
    }

    fn set_net(&self, net: &mut NetOptions) {
        net.axis_scale = self.axis_scale.unwrap_or(net.axis_scale);
        net.strength = self.strength.unwrap_or(net.strength);
        net.weight = self.weight.unwrap_or(net.weight);
        if let Some(orientations) = &self.orientations {
            net.orientations = orientations.clone();
        }
    }
}

/// The name of a texture on the command line.
fn name(kind: Kind) -> String {
    let value = kind.to_possible_value();
    value.map_or_else(String::new, |value| value.get_name().to_owned())
}
