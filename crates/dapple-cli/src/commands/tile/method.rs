//! The methods of `dapple tile`, and the options that each of them takes.

use crate::error::{Hint, usage};
use crate::words::Word;
use anyhow::Result;
use dapple::raster::Named;
use dapple::tile::{
    Basis, Crossfade, Feather, Method, Pixels, SoftCut, SplineProject, WrapGradient,
};
use dapple::wavelet::{Degree, Phase};
use serde::Serialize;

dapple::raster::named! {
    /// How an image is made to repeat.
    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    enum Name {
        Auto = "auto",
        Periodic = "periodic",
        Poisson = "poisson",
        SoftCut = "soft-cut",
        Spline = "spline",
        PeriodicSpline = "periodic-spline",
        Feather = "feather",
        Mirror = "mirror",
    }
}

/// A method with its options.
pub(super) struct Candidate {
    /// Its name on the command line.
    pub(super) name: String,
    pub(super) method: Method,
    /// How many pixels apart the boundaries of a tile are that are like its wrap.
    pub(super) lattice: [u32; 2],
}

/// Reads the functions that a tile is made of.
fn basis() -> Word<Basis> {
    let splines = Word::<Degree>::all().map(Basis::Spline);
    splines.or("sines", "Sines and cosines", Basis::Sines)
}

/// The margin where none is given: that of the library, if the image has room for it.
fn default_margin(size: [u32; 2]) -> u32 {
    let shorter = size[0].min(size[1]);
    SoftCut::default().margin.min((shorter / 4).max(1))
}

/// The method and its options.
#[derive(clap::Args, Clone, Debug, Serialize)]
#[command(next_help_heading = "Method")]
pub(super) struct MethodArgs {
    /// The method.
    #[arg(long, value_parser = Word::<Name>::all(), default_value_t = Name::SoftCut)]
    method: Name,

    /// soft-cut, feather: how wide the two sides lie over each other, in pixels, from 1 to half of the side. By default 32
    /// for soft-cut, or a quarter of the shorter side if that is less; without it, feather mixes the image with itself moved by half.
    #[arg(long, value_name = "PX")]
    margin: Option<u32>,

    /// soft-cut: half of the width over which the cut is softened, in pixels, from 0 to half of the margin; by default 4,
    /// or half of the margin if that is less.
    #[arg(long, value_name = "PX")]
    half_width: Option<f32>,

    /// soft-cut, feather with a margin: how the sides are mixed; by default the variance is kept.
    #[arg(long, value_name = "HOW", value_parser = Word::<Crossfade>::all())]
    crossfade: Option<Crossfade>,

    /// poisson: the gradient across the wrap; by default zero.
    #[arg(long, value_name = "WHICH", value_parser = Word::<WrapGradient>::all())]
    wrap_gradient: Option<WrapGradient>,

    /// spline, periodic-spline: how often the image is halved and doubled, from 0 to 32; by default 1.
    #[arg(long, value_name = "N")]
    levels: Option<u32>,

    /// spline, periodic-spline: the functions that the tile is made of; by default quadratic splines.
    #[arg(long, value_name = "WHAT", value_parser = basis())]
    basis: Option<Basis>,

    /// spline, periodic-spline: where coarse coefficients lie; by default centered.
    #[arg(long, value_name = "WHERE", value_parser = Word::<Phase>::all())]
    phase: Option<Phase>,

    /// spline, periodic-spline: how pixels determine the spline; by default as its coefficients, as in the paper.
    #[arg(long, value_name = "WHAT", value_parser = Word::<Pixels>::all())]
    pixels: Option<Pixels>,
}

impl MethodArgs {
    /// The method with its options for images of a size, or all of them if the best shall be found.
    pub(super) fn candidates(&self, size: [u32; 2]) -> Vec<Candidate> {
        if !self.is_auto() {
            return vec![self.candidate(self.method, size)];
        }
        let names = Name::ALL.iter().copied();
        // Poisson with zero is the periodic part.
        let named = names.filter(|name| !matches!(name, Name::Auto | Name::Poisson));
        let named = named.map(|name| self.candidate(name, size));
        let margin = default_margin(size);
        let crossfade = Crossfade::default();
        let more = [
            (
                "poisson --wrap-gradient extrapolate".to_owned(),
                Method::Poisson(WrapGradient::Extrapolate),
            ),
            (
                format!("feather --margin {margin}"),
                Method::Feather(Feather::Margin { margin, crossfade }),
            ),
        ];
        let more = more.map(|(name, method)| Candidate {
            name,
            method,
            lattice: [1; 2],
        });
        named.chain(more).collect()
    }

    /// Whether the best of all methods is to be found.
    pub(super) fn is_auto(&self) -> bool {
        self.method == Name::Auto
    }

    fn candidate(&self, name: Name, size: [u32; 2]) -> Candidate {
        let method = match name {
            Name::Periodic => Method::Periodic,
            Name::Poisson => Method::Poisson(self.wrap_gradient.unwrap_or_default()),
            Name::Auto | Name::SoftCut => Method::SoftCut(self.soft_cut(size)),
            Name::Spline => Method::SplineProject(self.project()),
            Name::PeriodicSpline => Method::PeriodicThenProject(self.project()),
            Name::Feather => Method::Feather(match self.margin {
                None => Feather::HalfShift,
                Some(margin) => Feather::Margin {
                    margin,
                    crossfade: self.crossfade(),
                },
            }),
            Name::Mirror => Method::Mirror,
        };
        let lattice = match method {
            Method::SplineProject(project) | Method::PeriodicThenProject(project) => {
                1_u32.checked_shl(project.levels).unwrap_or(1)
            }
            _ => 1,
        };
        Candidate {
            name: name.to_string(),
            method,
            lattice: [lattice; 2],
        }
    }

    fn soft_cut(&self, size: [u32; 2]) -> SoftCut {
        let default = SoftCut::default();
        let margin = self.margin.unwrap_or(default_margin(size));
        let most = margin as f32 / 2.0;
        SoftCut {
            margin,
            half_width: self.half_width.unwrap_or(default.half_width.min(most)),
            crossfade: self.crossfade(),
        }
    }

    fn crossfade(&self) -> Crossfade {
        self.crossfade.unwrap_or_default()
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

    /// Refuses options of other methods, which would have no effect.
    ///
    /// # Errors
    ///
    /// If there is one.
    pub(super) fn check_used(&self) -> Result<()> {
        use Name::{Feather, PeriodicSpline, Poisson, SoftCut, Spline};
        let splines = &[Spline, PeriodicSpline][..];
        let given = [
            ("margin", self.margin.is_some(), &[SoftCut, Feather][..]),
            ("half-width", self.half_width.is_some(), &[SoftCut]),
            ("crossfade", self.crossfade.is_some(), &[SoftCut, Feather]),
            ("wrap-gradient", self.wrap_gradient.is_some(), &[Poisson]),
            ("levels", self.levels.is_some(), splines),
            ("basis", self.basis.is_some(), splines),
            ("phase", self.phase.is_some(), splines),
            ("pixels", self.pixels.is_some(), splines),
        ];
        for (option, is_given, methods) in given {
            if is_given && !methods.contains(&self.method) {
                let names: Vec<_> = methods.iter().map(|method| method.name()).collect();
                let message = format!("--{option} has no effect on this method");
                return Err(usage(message).hint(format!("add --method {}", names.join(" or "))));
            }
        }
        if self.method == Feather && self.crossfade.is_some() && self.margin.is_none() {
            return Err(usage("--crossfade has no effect without a margin").hint("add --margin PX"));
        }
        Ok(())
    }
}
