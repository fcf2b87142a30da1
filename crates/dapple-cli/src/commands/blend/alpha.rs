//! Alpha in a blend: colors are mixed premultiplied by alpha, so that transparent pixels add no color.

use super::layer::Material;
use crate::input::divided;
use anyhow::Result;
use dapple::color::LinearRgb;
use dapple::raster::Raster;
use dapple::tile::Map;

/// The form of the colors beside alpha, once they are mixed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::commands) enum AlphaForm {
    /// There is no alpha.
    None,
    /// Alpha is divided out, as in PNG.
    Straight,
    /// Alpha stays multiplied into the colors, since a layer is of OpenEXR, where light may cover nothing.
    Associated,
}

/// Multiplies alpha into the first maps, and adds it as the last map of every layer, if any layer has alpha.
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

/// Removes alpha from the end of the maps, and gives the first the form.
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
