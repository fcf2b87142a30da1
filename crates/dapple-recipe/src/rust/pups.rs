//! The code of the textures of `dapple-pups`.

use super::Printer;
use super::literal::{literal, struct_literal};
use crate::{Cells, ControlPoints, PupsNode, RecipeError};
use dapple_points::Domain;
use dapple_pups::{
    CellsOptions, CellularNoiseOptions, ColorNoiseOptions, CowOptions, LabelRampOptions,
    NoiseOptions, OctavesOptions, ProgressionOptions, SpaceGiraffeOptions,
};

/// The code of options whose domain is another than the default.
macro_rules! with_domain {
    ($name:expr, $options:expr, $default:expr, $domain:expr, [$($field:ident),*]) => {{
        let code = struct_literal!($name, $options, $default, [$($field),*]);
        let domain = format!("domain: {}", domain($domain));
        if code.contains('{') {
            code.replacen("{ ", &format!("{{ {domain}, "), 1)
        } else {
            format!("{} {{ {domain}, ..{}::default() }}", $name, $name)
        }
    }};
}

impl Printer<'_> {
    pub(super) fn pups(
        &self,
        name: &str,
        node: &PupsNode,
        object: &str,
    ) -> Result<(String, String), RecipeError> {
        let seed = self.seed(name, None);
        let tile = self.tile();
        if let PupsNode::Points(points) = node {
            let code = control_points(points, tile, &seed);
            return Ok((code, format!("{object}.sample(at)")));
        }
        let Some((call, options)) = noise_call(node, tile).or_else(|| label_call(node, tile))
        else {
            let file = node_file(node);
            return Err(RecipeError::new(crate::RecipeErrorKind::NoImage { file }));
        };
        let code = call.replace("()", &format!("(&{options}, {seed})?"));
        let code = code.replace(".normalized", ".normalized()");
        let value = match node {
            PupsNode::ColorNoise(_) => format!("LinearRgb::from({object}.sample(at))"),
            _ => format!("{object}.sample(at)"),
        };
        Ok((format!("pups::{code}"), value))
    }

    fn tile(&self) -> Domain {
        Domain {
            origin: glam::DVec2::ZERO,
            size: self.recipe.extent.into(),
            wrap: self.recipe.wrap,
        }
    }
}

/// The call, with nothing in its first parentheses, and the options of a texture of mixed values.
fn noise_call(node: &PupsNode, tile: Domain) -> Option<(&'static str, String)> {
    Some(match node {
        PupsNode::Noise(o) => {
            let usual = NoiseOptions::default();
            let code = with_domain!("pups::NoiseOptions", o, usual, tile, [spacing, net]);
            ("noise()", code)
        }
        PupsNode::Octaves(o) => ("octaves().normalized", octaves_over(o, tile)),
        PupsNode::Turbulence(o) => ("turbulence().normalized", octaves_over(o, tile)),
        PupsNode::CellularNoise(o) => {
            let usual = CellularNoiseOptions::default();
            let fields = with_domain!(
                "pups::CellularNoiseOptions",
                o,
                usual,
                tile,
                [spacing, layers, lacunarity, gain, points_per_cell, net]
            );
            ("cellular_noise().normalized", fields)
        }
        PupsNode::ColorNoise(o) => {
            let usual = ColorNoiseOptions::default();
            let name = "pups::ColorNoiseOptions";
            (
                "color_noise()",
                with_domain!(name, o, usual, tile, [spacing, palette, net]),
            )
        }
        _ => return None,
    })
}

/// The same for a texture of labels.
fn label_call(node: &PupsNode, tile: Domain) -> Option<(&'static str, String)> {
    let strip = Domain {
        wrap: [false, tile.wrap[1]],
        ..tile
    };
    Some(match node {
        PupsNode::Cells(o) => {
            let usual = CellsOptions::default();
            let name = "pups::CellsOptions";
            (
                "cells()",
                with_domain!(name, o, usual, tile, [spacing, points_per_cell, net]),
            )
        }
        PupsNode::Cow(o) => {
            let usual = CowOptions::default();
            let name = "pups::CowOptions";
            (
                "cow()",
                with_domain!(name, o, usual, tile, [spacing, probability, values, net]),
            )
        }
        PupsNode::SpaceGiraffe(o) => {
            let usual = SpaceGiraffeOptions::default();
            let name = "pups::SpaceGiraffeOptions";
            let fields = with_domain!(name, o, usual, tile, [spacing, pairs, spots, values, net]);
            ("space_giraffe()", fields)
        }
        PupsNode::CowProgression(o) => ("cow_progression()", progression(o, strip)),
        PupsNode::GiraffeProgression(o) => ("giraffe_progression()", progression(o, strip)),
        PupsNode::LabelRamp(o) => {
            let usual = LabelRampOptions::default();
            let name = "pups::LabelRampOptions";
            (
                "label_ramp()",
                with_domain!(name, o, usual, strip, [spacing, probabilities, net]),
            )
        }
        _ => return None,
    })
}

fn node_file(node: &PupsNode) -> String {
    match node {
        PupsNode::Reference(node) => node.file.clone(),
        PupsNode::IteratedReference(node) => node.file.clone(),
        _ => String::new(),
    }
}

/// The code of octaves with a domain of their own.
pub(super) fn octaves(options: &OctavesOptions) -> String {
    octaves_over(options, options.domain)
}

fn octaves_over(options: &OctavesOptions, tile: Domain) -> String {
    let usual = OctavesOptions::default();
    with_domain!(
        "pups::OctavesOptions",
        options,
        usual,
        tile,
        [spacing, octaves, lacunarity, gain, source, net]
    )
}

fn progression(options: &ProgressionOptions, strip: Domain) -> String {
    with_domain!(
        "pups::ProgressionOptions",
        options,
        ProgressionOptions::default(),
        strip,
        [distances, net]
    )
}

fn domain(domain: Domain) -> String {
    let Domain { origin, size, wrap } = domain;
    format!(
        "points::Domain {{ origin: {}, size: {}, wrap: {} }}",
        literal(&origin),
        literal(&size),
        literal(&wrap)
    )
}

/// The code of control points that are given one by one.
fn control_points(node: &ControlPoints, tile: Domain, seed: &str) -> String {
    let places: Vec<_> = node
        .points
        .iter()
        .map(|point| literal(&glam::DVec2::new(point.x, point.y)))
        .collect();
    let values: Vec<f32> = node.points.iter().map(|point| point.value).collect();
    let vectors: Vec<_> = node
        .points
        .iter()
        .filter_map(|point| point.orientation)
        .map(|[x, y]| literal(&glam::DVec3::new(x, y, 0.0)))
        .collect();
    let net = literal(&node.net);
    let net = if vectors.is_empty() {
        format!("{net}.pups(&points, {seed})?")
    } else {
        format!(
            "{{
            let net = {net};
            let orientation = pups::Orientation::new(vec![{}]).with_strength(net.strength);
            let options = pups::PupsOptions {{ axis_scale: net.axis_scale, weight: net.weight, orientation: Some(orientation) }};
            pups::Pups::new(&points, &graph::delaunay(&points)?, options)?
        }}",
            vectors.join(", ")
        )
    };
    let texture = match node.cells {
        Cells::Mixed => "net.texture(values)?",
        Cells::Hard => "pups::LabelTexture::new(net, pups::own_labels(values.len()), values)?",
    };
    format!(
        "{{
        let points = points::PointSet::new({}, vec![{}])?;
        let values = {};
        let net = {net};
        {texture}
    }}",
        domain(tile),
        places.join(", "),
        literal(&values)
    )
}
