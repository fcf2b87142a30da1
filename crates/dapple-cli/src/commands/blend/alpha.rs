//! Alpha in a blend: colors are mixed premultiplied by alpha, so that transparent pixels add no color.

use super::layer::Material;
use anyhow::Result;
use dapple::color::LinearRgb;
use dapple::raster::Raster;
use dapple::tile::Map;

/// Multiplies alpha into the first maps, and adds it as the last map of every layer, if any layer has alpha.
pub(in crate::commands) fn multiply(materials: &mut [Material]) -> Result<bool> {
    if materials.iter().all(|material| material.alpha.is_none()) {
        return Ok(false);
    }
    for material in materials {
        let alpha = match material.alpha.take() {
            Some(alpha) => alpha,
            None => Raster::filled(material.maps[0].size(), 1.0)?,
        };
        if let Map::Color(colors) = &mut material.maps[0] {
            *colors = colors.zip_map(&alpha, |&color, &alpha| color * alpha)?;
        }
        material.maps.push(Map::Value(alpha));
    }
    Ok(true)
}

/// Removes alpha from the end of the maps, and divides the first by it.
pub(in crate::commands) fn divide(maps: &mut Vec<Map>) -> Result<Option<Raster<f32>>> {
    let Some(Map::Value(alpha)) = maps.pop() else {
        return Ok(None);
    };
    if let Some(Map::Color(colors)) = maps.first_mut() {
        *colors = colors.zip_map(&alpha, |&color, &alpha| {
            if alpha > 0.0 {
                LinearRgb::from(color.to_array().map(|part| part / alpha))
            } else {
                LinearRgb::BLACK
            }
        })?;
    }
    Ok(Some(alpha))
}
