//! Handles alpha in a blend. Colors are mixed premultiplied by alpha, so that transparent pixels contribute no color.

use super::layer::Material;
use crate::input::divided;
use anyhow::Result;
use dapple::color::LinearRgb;
use dapple::raster::Raster;
use dapple::tile::Map;

/// How alpha is stored with the blended colors.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::commands) enum AlphaForm {
    /// The image has no alpha.
    None,
    /// Straight colors, as in PNG.
    Straight,
    /// Associated colors, that is, colors multiplied by alpha. Used if a layer is an OpenEXR image, where pixels with
    /// alpha 0 may emit light.
    Associated,
}

/// Multiplies the first map of each layer by its alpha, and appends the alpha as the last map. Does nothing if no layer
/// has alpha.
pub(in crate::commands) fn multiply(materials: &mut [Material]) -> Result<AlphaForm> {
    if materials.iter().all(|material| material.alpha.is_none()) {
        return Ok(AlphaForm::None);
    }
    let form = match materials.iter().any(|material| material.is_associated) {
        true => AlphaForm::Associated,
        false => AlphaForm::Straight,
    };
    for material in materials {
        let alpha = match material.alpha.take() {
            Some(alpha) => alpha,
            None => Raster::filled(material.maps[0].size(), 1.0)?,
        };
        if let (Map::Color(colors), false) = (&mut material.maps[0], material.is_associated) {
            *colors = colors.zip_map(&alpha, |&color, &alpha| color * alpha)?;
        }
        material.maps.push(Map::Value(alpha));
    }
    Ok(form)
}

/// Removes the alpha from the end of `maps` and returns it. Converts the first map to `form`.
pub(in crate::commands) fn take(
    maps: &mut Vec<Map>,
    form: AlphaForm,
) -> Result<Option<Raster<f32>>> {
    if form == AlphaForm::None {
        return Ok(None);
    }
    let Some(Map::Value(alpha)) = maps.pop() else {
        return Ok(None);
    };
    if let (Some(Map::Color(colors)), AlphaForm::Straight) = (maps.first_mut(), form) {
        *colors = colors.zip_map(&alpha, |color, alpha| match *alpha > 0.0 {
            true => divided(color, alpha),
            false => LinearRgb::BLACK,
        })?;
    }
    Ok(Some(alpha))
}
