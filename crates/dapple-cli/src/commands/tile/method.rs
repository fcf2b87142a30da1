//! The methods of `dapple tile`, and their options.

use crate::args::seed;
use crate::error::{Hint, usage};
use crate::words::NamedValueParser;
use anyhow::Result;
use dapple::hash::Seed;
use dapple::tile::{
    Basis, Crossfade, Feather, Method, Pixels, SoftCut, SplineProject, WrapGradient,
};
use dapple::wavelet::{Degree, Phase};
use serde::Serialize;

/// A method's row in the table.
struct Row {
    name: &'static str,
    /// The help text of the method.
    about: &'static str,
    /// The options of the method, without `--`.
    options: &'static [&'static str],
    /// Builds the method from the options.
    make: fn(&MethodArgs) -> How,
}

/// All methods.
const METHODS: [Row; 8] = [
    Row {
        name: "periodic",
        about: "Keeps all detail and the size; spreads the step across the wrap over the image, which shows as a stain where it is large",
        options: &[],
        make: |_| How::Seamless(Method::Periodic),
    },
    Row {
        name: "poisson",
        about: "The same with another gradient across the wrap",
        options: &["wrap-gradient"],
        make: |args| How::Seamless(Method::Poisson(args.wrap_gradient.unwrap_or_default())),
    },
    Row {
        name: SOFT_CUT,
        about: "Cuts along the line of least difference, smaller by the margin: for photographs",
        options: &["margin", "half-width", "crossfade"],
        make: |args| How::Seamless(Method::SoftCut(args.soft_cut())),
    },
    Row {
        name: "spline",
        about: "The blend tile of Du, Wang and Meng; smooths, and hides a seam only in part",
        options: PROJECT_OPTIONS,
        make: |args| How::Seamless(Method::SplineProject(args.project())),
    },
    Row {
        name: "periodic-spline",
        about: "First periodic, then spline",
        options: PROJECT_OPTIONS,
        make: |args| How::Seamless(Method::PeriodicThenProject(args.project())),
    },
    Row {
        name: "feather",
        about: "A crossfade, the usual baseline",
        options: &["margin", "crossfade"],
        make: |args| How::Seamless(Method::Feather(args.feather())),
    },
    Row {
        name: "mirror",
        about: "The image beside its mirror image, twice as large",
        options: &[],
        make: |_| How::Seamless(Method::Mirror),
    },
    Row {
        name: SYNTH,
        about: "Looks for the size that repeats best, and synthesizes a strip along the seam from the rest: for bricks, planks and weave; takes seconds",
        options: &["margin", "seed"],
        make: |args| {
            How::Synth(Resynthesis {
                margin: args.margin,
                seed: Seed(args.seed.unwrap_or(0)),
            })
        },
    },
];

/// How a tile is computed.
pub(super) enum How {
    /// A method of `dapple-tile`.
    Seamless(Method),
    /// Re-synthesis of a strip along the seam.
    Synth(Resynthesis),
}

/// Options for re-synthesis of a strip along the seam.
pub(super) struct Resynthesis {
    /// Width of the strip, in pixels; 3/16 of the shorter side by default.
    pub(super) margin: Option<u32>,
    pub(super) seed: Seed,
}

/// Name of the method that re-synthesizes a strip. It takes much longer than the other methods.
const SYNTH: &str = "synth";

/// The name of the default method.
const SOFT_CUT: &str = "soft-cut";

/// The name that selects the best of all methods.
const AUTO: &str = "auto";

/// The options of the spline methods.
const PROJECT_OPTIONS: &[&str] = &["levels", "basis", "phase", "pixels"];

/// Creates a parser of method names.
fn method() -> NamedValueParser<&'static str> {
    let auto = NamedValueParser::none().or(
        AUTO,
        "Tries the others and keeps the best by the report: synth only if none of them passes, and neither mirror nor feather without a margin, which show two pictures in one",
        AUTO,
    );
    METHODS
        .iter()
        .fold(auto, |words, row| words.or(row.name, row.about, row.name))
}

/// A method with its options, as a candidate for the best tile.
pub(super) struct Candidate {
    /// The name of the method on the command line.
    pub(super) name: String,
    pub(super) how: How,
    /// Lattice of the seam report: for each axis, the spacing of positions in the tile that are comparable to its wrap,
    /// in pixels. Spline methods have a lattice of cells; for others, it is 1.
    pub(super) lattice: [u32; 2],
}

impl Candidate {
    /// Returns whether the candidate is tried only if no other candidate passes.
    pub(super) fn is_last_resort(&self) -> bool {
        matches!(self.how, How::Synth(_))
    }

    fn new(name: String, how: How) -> Self {
        let lattice = match how {
            How::Seamless(
                Method::SplineProject(project) | Method::PeriodicThenProject(project),
            ) => 1_u32.checked_shl(project.levels).unwrap_or(1),
            _ => 1,
        };
        Self {
            name,
            how,
            lattice: [lattice; 2],
        }
    }
}

/// Creates a parser of basis functions for spline tiles.
fn basis() -> NamedValueParser<Basis> {
    let splines = NamedValueParser::<Degree>::all().map(Basis::Spline);
    splines.or("sines", "Sines and cosines", Basis::Sines)
}

/// Options of the method.
#[derive(clap::Args, Clone, Debug, Serialize)]
#[command(next_help_heading = "Method")]
pub(in crate::commands) struct MethodArgs {
    /// The method.
    #[arg(long, value_parser = method(), default_value = SOFT_CUT)]
    method: &'static str,

    /// soft-cut, feather: width in pixels of the overlap of both sides; synth: width of the new strip.
    ///
    /// From 1 to half of the side. The default for soft-cut is an eighth of the shorter side, but at least 32, and at
    /// most a quarter of it; for synth it is 3/16. Without it, feather mixes the image with itself moved by half.
    #[arg(long, value_name = "PX")]
    margin: Option<u32>,

    /// soft-cut: half of the blend width along the cut, in pixels, up to half of the margin.
    ///
    /// The default is a sixteenth of the margin, but at least 4, and at most half of it.
    #[arg(long, value_name = "PX")]
    half_width: Option<f32>,

    /// soft-cut, feather with a margin: blend of both sides.
    ///
    /// The default is linear for soft-cut and keep-variance for feather.
    #[arg(long, value_name = "HOW", value_parser = NamedValueParser::<Crossfade>::all())]
    crossfade: Option<Crossfade>,

    /// synth: random seed, any whole number from 0 to 2^64 - 1 [default: 0].
    #[arg(long, value_name = "N", value_parser = seed)]
    seed: Option<u64>,

    /// poisson: gradient across the wrap [default: zero].
    #[arg(long, value_name = "WHICH", value_parser = NamedValueParser::<WrapGradient>::all())]
    wrap_gradient: Option<WrapGradient>,

    /// spline, periodic-spline: number of times the image is halved and doubled, from 0 to 32 [default: 1].
    #[arg(long, value_name = "N")]
    levels: Option<u32>,

    /// spline, periodic-spline: basis functions of the tile [default: quadratic].
    #[arg(long, value_name = "WHAT", value_parser = basis())]
    basis: Option<Basis>,

    /// spline, periodic-spline: position of the coarse coefficients [default: centered].
    #[arg(long, value_name = "WHERE", value_parser = NamedValueParser::<Phase>::all())]
    phase: Option<Phase>,

    /// spline, periodic-spline: meaning of the pixels [default: coefficients of the spline, as in the paper].
    #[arg(long, value_name = "WHAT", value_parser = NamedValueParser::<Pixels>::all())]
    pixels: Option<Pixels>,
}

impl MethodArgs {
    /// Returns the methods to try on images of `size` pixels, with their options. Unless the method is `auto`, there is
    /// only one. A method of last resort is at the end.
    pub(super) fn candidates(&self, size: [u32; 2]) -> Vec<Candidate> {
        let candidates_of = |is_wanted: &dyn Fn(&str) -> bool| -> Vec<Candidate> {
            let wanted = METHODS.iter().filter(|row| is_wanted(row.name));
            wanted
                .map(|row| Candidate::new(row.name.to_owned(), (row.make)(self)))
                .collect()
        };
        if !self.is_auto() {
            return candidates_of(&|name| name == self.method);
        }
        // Leave out `poisson` with a zero gradient, which equals `periodic`. Leave out `mirror`, and `feather` without
        // a margin, which superimpose two images over the whole tile; a report of the seam does not see this.
        let mut candidates =
            candidates_of(&|name| ![SYNTH, "poisson", "feather", "mirror"].contains(&name));
        let margin = SoftCut::default().margin_of(size);
        let crossfade = Crossfade::default();
        candidates.push(Candidate::new(
            "poisson --wrap-gradient extrapolate".to_owned(),
            How::Seamless(Method::Poisson(WrapGradient::Extrapolate)),
        ));
        candidates.push(Candidate::new(
            format!("feather --margin {margin}"),
            How::Seamless(Method::Feather(Feather::Margin { margin, crossfade })),
        ));
        // Try re-synthesis last: it takes seconds, and all others take moments.
        candidates.extend(candidates_of(&|name| name == SYNTH));
        candidates
    }

    /// Returns whether the best method is chosen automatically.
    pub(in crate::commands) fn is_auto(&self) -> bool {
        self.method == AUTO
    }

    fn feather(&self) -> Feather {
        match self.margin {
            None => Feather::HalfShift,
            Some(margin) => Feather::Margin {
                margin,
                crossfade: self.crossfade.unwrap_or_default(),
            },
        }
    }

    fn soft_cut(&self) -> SoftCut {
        SoftCut {
            margin: self.margin,
            half_width: self.half_width,
            crossfade: self.crossfade.unwrap_or(SoftCut::default().crossfade),
        }
    }

    fn project(&self) -> SplineProject {
        let default = SplineProject::default();
        SplineProject {
            levels: self.levels.unwrap_or(default.levels),
            phase: self.phase.unwrap_or_default(),
            basis: self.basis.unwrap_or(default.basis),
            pixels: self.pixels.unwrap_or_default(),
        }
    }

    /// Refuses options that belong to another method, since they would have no effect.
    ///
    /// # Errors
    ///
    /// If such an option is given.
    pub(in crate::commands) fn check_used(&self) -> Result<()> {
        let given = [
            ("margin", self.margin.is_some()),
            ("seed", self.seed.is_some()),
            ("half-width", self.half_width.is_some()),
            ("crossfade", self.crossfade.is_some()),
            ("wrap-gradient", self.wrap_gradient.is_some()),
            ("levels", self.levels.is_some()),
            ("basis", self.basis.is_some()),
            ("phase", self.phase.is_some()),
            ("pixels", self.pixels.is_some()),
        ];
        for (option, _) in given.into_iter().filter(|(_, is_given)| *is_given) {
            let takes_it = |row: &&Row| row.options.contains(&option);
            let names: Vec<_> = METHODS
                .iter()
                .filter(takes_it)
                .map(|row| row.name)
                .collect();
            if !names.contains(&self.method) {
                let message = format!("--{option} has no effect on this method");
                return Err(usage(message).hint(format!("add --method {}", names.join(" or "))));
            }
        }
        if self.method == "feather" && self.crossfade.is_some() && self.margin.is_none() {
            return Err(usage("--crossfade has no effect without a margin").hint("add --margin PX"));
        }
        Ok(())
    }
}
