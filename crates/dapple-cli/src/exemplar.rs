//! Converts maps to exemplars for texture synthesis.

use dapple::synth::{Edges, Exemplar, SynthError};
use dapple::tile::Map;

/// Converts a map to an exemplar whose channels are about 0 to 1. Values are unchanged, colors are sRGB encoded, and
/// normals have their x and y components as channels, scaled to 0 to 1.
///
/// # Errors
///
/// If a number is not finite, or the magnitude of a value is above 10^12.
pub(crate) fn exemplar_of(map: &Map, edges: Edges) -> Result<Exemplar, SynthError> {
    match map {
        Map::Value(values) => Exemplar::from_planes(&[(values, 1.0)], edges),
        Map::Color(colors) => Exemplar::new(colors, edges),
        Map::Normal(normals) => {
            let unit = |part: f32| 0.5 + 0.5 * part;
            let across = normals.map(|normal| unit(normal.x));
            let along = normals.map(|normal| unit(normal.y));
            Exemplar::from_planes(&[(&across, 1.0), (&along, 1.0)], edges)
        }
    }
}
