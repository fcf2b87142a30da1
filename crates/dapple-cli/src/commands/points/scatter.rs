//! Defines the kinds of point sets and their options, and scatters the points.

use crate::args::{Axes, Extent, Numbers, ReadArgs, Size, image_alpha, seed};
use crate::error::{Hint, usage};
use crate::input::{self, ALPHA_HINT, Kind as ImageKind};
use crate::words::NamedValueParser;
use anyhow::{Context as _, Error, Result};
use dapple::hash::Seed;
use dapple::points::glam::DVec2;
use dapple::points::raster::{Ramp, Varying, Wrap};
use dapple::points::{
    DiskRule, Domain, PointSet, PointsError, PointsErrorKind, VariablePoissonOptions,
    gentle_radius_for_count, jittered_grid, nested_poisson_disk, poisson_disk, poisson_disk_radius,
    radius_for_count, variable_poisson_disk, white_noise,
};
use dapple::recipe::ImageAlpha;
use dapple::tile::Map;
use serde::Serialize;
use std::path::PathBuf;
use std::str::FromStr;
use std::sync::Arc;

/// Default number of points.
const COUNT: u32 = 1000;
/// Maximum number of columns and rows of the grid on which the density of an image is sampled.
const PLACES_MAX: u32 = 2048;

dapple::raster::named! {
    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    enum Kind {
        Poisson = "poisson",
        Variable = "variable",
        Nested = "nested",
        Jittered = "jittered",
        White = "white",
    }
}

/// Options of the kind of point set.
#[derive(clap::Args, Clone, Debug, Serialize)]
#[command(next_help_heading = "Points")]
pub(super) struct ScatterArgs {
    /// The kind of points, described below.
    #[arg(value_parser = NamedValueParser::<Kind>::all(), default_value_t = Kind::Poisson, hide_possible_values = true, help_heading = None::<&str>)]
    kind: Kind,

    /// Random seed, any whole number from 0 to 2^64 - 1.
    #[arg(long, value_name = "N", default_value_t = 0, value_parser = seed)]
    pub(super) seed: u64,

    /// Approximate number of points, at least 1 [default: 1000].
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..))]
    count: Option<u32>,

    /// poisson: minimum distance in units of the domain, above 0.
    #[arg(long, value_name = "R", conflicts_with = "count")]
    radius: Option<f64>,

    /// nested: minimum distance of each level, coarsest first.
    #[arg(
        long,
        value_name = "R,R,...",
        value_delimiter = ',',
        conflicts_with = "count"
    )]
    radii: Vec<f64>,

    /// nested: number of levels, 1 to 16, each with about four times the points of the previous one [default: 3].
    #[arg(long, value_name = "N", conflicts_with = "radii", value_parser = clap::value_parser!(u32).range(1..=16))]
    levels: Option<u32>,

    /// variable: density as an image with more points in brighter parts, or A:B, a ramp from left to right.
    ///
    /// A to B is the ratio of the densities at both ends.
    #[arg(long, value_name = "IMAGE|A:B")]
    density: Option<Density>,

    /// variable: handling of the image's transparency, an error by default: `drop`, or `over:COLOR` such as
    /// `over:black`.
    #[arg(long, value_name = "drop|over:COLOR", value_parser = image_alpha, requires = "density")]
    alpha: Option<ImageAlpha>,

    #[command(flatten)]
    #[serde(flatten)]
    read: ReadArgs,

    /// variable: put more points in darker parts of the image.
    #[arg(long)]
    invert: bool,

    /// variable: minimum distance of points with different radii [default: the mean of their radii].
    #[arg(long, value_name = "RULE", value_parser = NamedValueParser::<DiskRule>::all())]
    rule: Option<DiskRule>,

    /// jittered: columns and rows of the grid [default: square cells for the count].
    #[arg(long, value_name = "NxM", conflicts_with = "count")]
    cells: Option<Size>,

    /// jittered: jitter, from 0 (cell centers) to 1 (anywhere in the cell) [default: 1].
    #[arg(long, value_name = "PART")]
    jitter: Option<f64>,

    /// Width and height of the domain.
    #[arg(long, value_name = "WxH", default_value = "1", help_heading = "Domain")]
    domain: Extent,

    /// Corner of the domain with the smallest coordinates.
    #[arg(
        long,
        value_name = "X,Y",
        default_value = "0,0",
        allow_hyphen_values = true,
        help_heading = "Domain"
    )]
    origin: Numbers<f64, 2>,

    /// Axes along which the domain wraps, so that the points tile.
    #[arg(long, value_parser = NamedValueParser::<Axes>::all(), default_value_t = Axes::Both, help_heading = "Domain")]
    wrap: Axes,
}

/// Scattered points, with their levels and radius.
#[derive(Debug)]
pub(super) struct Scattered {
    pub(super) points: PointSet,
    /// For each level, the number of points in this level and all coarser ones. A set without levels has a single
    /// count.
    pub(super) lengths: Vec<usize>,
    /// Minimum distance between points; `None` if there is no minimum.
    pub(super) radius: Option<f64>,
}

impl Scattered {
    /// Returns the level of a point; 0 is the coarsest.
    pub(super) fn level(&self, index: usize) -> usize {
        self.lengths.partition_point(|&length| length <= index)
    }
}

impl ScatterArgs {
    /// Scatters the points.
    ///
    /// # Errors
    ///
    /// If an option belongs to another kind, or is out of range.
    pub(super) fn scatter(&self) -> Result<Scattered> {
        self.check_used()?;
        let Extent([width, height]) = self.domain;
        let domain = Domain {
            origin: DVec2::from(self.origin.0),
            size: DVec2::new(width, height),
            wrap: self.wrap.flags(),
        };
        let (count, seed) = (self.count.unwrap_or(COUNT), Seed(self.seed));
        match self.kind {
            Kind::Poisson => {
                let radius = match self.radius {
                    Some(radius) => radius,
                    None => poisson_disk_radius(domain, count).map_err(advise)?,
                };
                let points = poisson_disk(domain, radius, seed).map_err(advise)?;
                Ok(flat(points, Some(radius)))
            }
            Kind::Nested => self.nested(domain, count, seed),
            Kind::Variable => {
                let radius = self.variable_radius(domain, count)?;
                let options = VariablePoissonOptions {
                    rule: self.rule.unwrap_or_default(),
                    ..VariablePoissonOptions::default()
                };
                let points = variable_poisson_disk(domain, &radius, &options, seed);
                Ok(flat(points.map_err(advise)?, None))
            }
            Kind::Jittered => {
                let cells = self
                    .cells
                    .map_or_else(|| square_cells(domain, count), |cells| cells.0);
                let points = jittered_grid(domain, cells, self.jitter.unwrap_or(1.0), seed)
                    .map_err(advise)?;
                Ok(flat(points, None))
            }
            Kind::White => Ok(flat(
                white_noise(domain, count, seed).map_err(advise)?,
                None,
            )),
        }
    }

    fn nested(&self, domain: Domain, count: u32, seed: Seed) -> Result<Scattered> {
        let radii = if self.radii.is_empty() {
            let finest = poisson_disk_radius(domain, count).map_err(advise)?;
            let n_levels = self.levels.unwrap_or(3);
            // Double the radius from level to level, which gives a quarter of the points.
            let radius = |level| finest * f64::from(1_u32 << (n_levels - 1 - level));
            (0..n_levels).map(radius).collect()
        } else {
            self.radii.clone()
        };
        let nested = nested_poisson_disk(domain, &radii, seed).map_err(advise)?;
        Ok(Scattered {
            lengths: nested.lengths().to_vec(),
            points: nested.into_points(),
            radius: radii.last().copied(),
        })
    }

    /// Returns the radius as a function of position, chosen to give the requested density.
    fn variable_radius(&self, domain: Domain, count: u32) -> Result<Varying> {
        let (from, end) = (domain.origin, domain.end());
        let path = match &self.density {
            None => {
                return Err(
                    usage("variable points need a density").hint("add --density IMAGE or A:B")
                );
            }
            Some(Density::Ramp(ends)) => {
                let density = Varying::Ramp(Ramp {
                    from,
                    to: DVec2::new(end.x, from.y),
                    start: ends[0],
                    end: ends[1],
                });
                return radius_for_count(domain, &density, count.into()).map_err(advise);
            }
            Some(Density::Image(path)) => path,
        };
        let kind = ImageKind::ByChannels;
        let values = match input::map(path, kind, None, self.alpha, &self.read, ALPHA_HINT)?.map {
            Map::Value(values) => values,
            Map::Color(colors) => colors.map(|color| color.luminance()),
            Map::Normal(normals) => normals.map(|normal| normal.z),
        };
        let density = values.map(|value| {
            let value = if self.invert { 1.0 - value } else { *value };
            value.max(0.0)
        });
        let places = density.size().map(|side| side.min(PLACES_MAX));
        let density = Varying::Raster {
            raster: Arc::new(density),
            origin: from,
            extent: domain.size,
            wrap: self.wrap.choose(Wrap::Repeat, Wrap::Clamp),
        };
        let radius = gentle_radius_for_count(domain, &density, count.into(), places);
        radius.map_err(advise).with_context(|| input::name(path))
    }

    /// Returns an error if an option of another kind is given, which would have no effect.
    fn check_used(&self) -> Result<()> {
        let given = [
            ("radius", self.radius.is_some(), Kind::Poisson),
            ("radii", !self.radii.is_empty(), Kind::Nested),
            ("levels", self.levels.is_some(), Kind::Nested),
            ("density", self.density.is_some(), Kind::Variable),
            ("invert", self.invert, Kind::Variable),
            ("rule", self.rule.is_some(), Kind::Variable),
            ("cells", self.cells.is_some(), Kind::Jittered),
            ("jitter", self.jitter.is_some(), Kind::Jittered),
        ];
        for (option, is_given, kind) in given {
            if is_given && kind != self.kind {
                let message = format!("--{option} has no effect on points of this kind");
                return Err(usage(message).hint(format!("it is for dapple points {kind}")));
            }
        }
        Ok(())
    }
}

/// A density: an image, or a linear ramp, given by its values at the left and right sides.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(untagged)]
enum Density {
    Ramp([f64; 2]),
    Image(PathBuf),
}

impl FromStr for Density {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let ends = text
            .split_once(':')
            .map(|(a, b)| [a, b].map(str::parse::<f64>));
        match ends {
            Some([Ok(a), Ok(b)]) if a > 0.0 && b > 0.0 && a.is_finite() && b.is_finite() => {
                Ok(Self::Ramp([a, b]))
            }
            Some([Ok(a), Ok(b)]) => Err(format!("densities are above 0 and finite, not {a}:{b}")),
            _ => Ok(Self::Image(PathBuf::from(text))),
        }
    }
}

fn flat(points: PointSet, radius: Option<f64>) -> Scattered {
    Scattered {
        lengths: vec![points.len()],
        points,
        radius,
    }
}

/// Returns the number of columns and rows of a grid with about `count` nearly square cells.
fn square_cells(domain: Domain, count: u32) -> [u32; 2] {
    let side = (domain.area() / f64::from(count)).sqrt();
    let along = |length: f64| ((length / side + 0.5).floor().max(1.0)) as u32;
    [along(domain.size.x), along(domain.size.y)]
}

/// Adds a hint to common errors.
fn advise(error: PointsError) -> Error {
    let hint = match error.kind() {
        PointsErrorKind::PeriodTooShort { .. } => {
            "take a smaller radius, more points, or --wrap none"
        }
        PointsErrorKind::TooSteep { .. } => {
            "take more points, or ends of the ramp that differ less"
        }
        PointsErrorKind::TooMany { .. } => "take a larger radius or a smaller domain",
        PointsErrorKind::NotDescending { .. } => "name the largest radius first",
        _ => return Error::new(error).wrong_value(),
    };
    Error::new(error).hint(hint).wrong_value()
}
