//! Maps as exemplars of a synthesis.

use dapple::synth::{Edges, Exemplar, SynthError};
use dapple::tile::Map;

/// The exemplar of a map, all channels of which are from about 0 to 1: values as they are, colors as sRGB codes, and normals
/// by their parts along the surface.
///
/// # Errors
///
/// If a number is not finite, or a value is beyond 10^12.
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
