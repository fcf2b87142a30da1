//! Control points of textures, for display and for editing.

use crate::StudioError;
use crate::message::Points;
use crate::render::LIMITS;
use dapple::pups::ControlNet;
use dapple::recipe::{ControlPoint, ControlPoints, Images, Node, PupsNode, Recipe};
use serde_json::Value as Json;

/// Maximum number of points that are shown.
const MOST_POINTS: usize = 20_000;

/// Returns the control points of a node and the edges of their graph.
pub(crate) fn report(
    recipe: &Recipe,
    images: &Images,
    node: &str,
    time: f64,
) -> Result<Points, StudioError> {
    let nets = recipe.control_nets(node, images, time, &LIMITS)?;
    let nets = nets.ok_or_else(|| no_points(node))?;
    let net = nets.nets.first().ok_or_else(|| no_points(node))?;
    let n_points = net.pups.n_points();
    if n_points > MOST_POINTS {
        let message = format!("`{node}` has {n_points} control points, too many to be shown");
        return Err(StudioError::new(message));
    }
    let graph = net
        .graph()
        .map_err(|error| StudioError::new(error.to_string()))?;
    // Convert each edge to two indices and a vector.
    let edge = |(from, axis): (dapple::points::PointIdx, dapple::graph::Axis)| {
        (from.0, axis.to.0, axis.vector.x, axis.vector.y)
    };
    let written = match recipe.nodes.get(node) {
        Some(Node::Pups(PupsNode::Points(written))) => Some(written),
        _ => None,
    };
    Ok(Points {
        node: node.to_owned(),
        editable: written.is_some(),
        can_be_editable: nets.points.is_some(),
        layers: nets.nets.len(),
        extent: recipe.extent,
        wrap: recipe.wrap,
        points: points(net, written),
        values: match (written, net.shared_labels()) {
            (Some(written), _) => written.values.clone(),
            (None, Some((_, values))) => values.to_vec(),
            (None, None) => Vec::new(),
        },
        edges: graph.edges().map(edge).collect(),
    })
}

/// Lists the control points of a net. Points that are written in the text have the labels given there.
fn points(net: &ControlNet, written: Option<&ControlPoints>) -> Vec<ControlPoint> {
    let label = |index: usize| match written {
        Some(written) => written.points[index].label,
        None => net.shared_labels().map(|(labels, _)| labels[index]),
    };
    let (numbers, orientations) = (net.numbers(), net.orientations());
    let positions = net.pups.points().positions().iter().enumerate();
    let point = |(index, position): (usize, &dapple::raster::glam::DVec2)| ControlPoint {
        x: position.x,
        y: position.y,
        value: Some(numbers.as_ref().map_or(0.5, |numbers| numbers[index])),
        label: label(index),
        orientation: orientations
            .as_ref()
            .map(|orientations| orientations[index]),
    };
    positions.map(point).collect()
}

/// Returns the options of a PUPs node of kind `points` that renders the same image as the node `node`.
pub(crate) fn editable(recipe: &Recipe, images: &Images, node: &str) -> Result<Json, StudioError> {
    let nets = recipe.control_nets(node, images, 0.0, &LIMITS)?;
    let nets = nets.ok_or_else(|| no_points(node))?;
    let points: ControlPoints = nets.points.ok_or_else(|| {
        let message = format!("the points of `{node}` cannot be edited: it has layers or colors");
        StudioError::new(message)
    })?;
    if points.points.len() > MOST_POINTS {
        let message = format!(
            "`{node}` has {} control points, too many to be edited",
            points.points.len()
        );
        return Err(StudioError::new(message));
    }
    let options = PupsNode::Points(points).to_json()?;
    Ok(options.get("points").cloned().unwrap_or(options))
}

fn no_points(node: &str) -> StudioError {
    StudioError::new(format!("there is no node `{node}` with control points"))
}
