//! A material's maps: their names and contents.

use crate::data;
use crate::error::{Error, Result};
use crate::pictures::{Content, Kind};
use dapple::recipe::MapKind;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyString};

/// Returns the kind of a map: its content and number of channels.
pub(super) fn kind_of(map: MapKind) -> Kind {
    let (content, n_channels) = match map {
        MapKind::Albedo | MapKind::Emission => (Content::Color, 3),
        MapKind::Normal => (Content::Normal, 3),
        MapKind::Orm => (Content::Data, 3),
        _ => (Content::Gray, 1),
    };
    Kind {
        content,
        n_channels,
    }
}

/// Returns the content of the map called `name` if it is neither a scalar nor a color; otherwise `None`.
pub(crate) fn content_of(name: &str) -> Option<Content> {
    let kind = kind_of(MapKind::from_name(name)?);
    (kind.n_channels > 1 && kind.content != Content::Color).then_some(kind.content)
}

/// Reads one map name or several; an error if a name is listed twice.
pub(super) fn maps(names: &Bound<'_, PyAny>) -> Result<Vec<MapKind>> {
    let names: Vec<String> = match names.cast::<PyString>() {
        Ok(name) => vec![name.to_str()?.to_owned()],
        Err(_) => names
            .try_iter()?
            .map(|name| name?.extract())
            .collect::<PyResult<_>>()?,
    };
    let mut maps = Vec::new();
    for name in &names {
        let map = map(name)?;
        if maps.contains(&map) {
            let message = format!("the map `{name}` is asked for twice");
            return Err(Error::new("maps", message));
        }
        maps.push(map);
    }
    if maps.is_empty() {
        return Err(Error::new("maps", "at least one map is needed"));
    }
    Ok(maps)
}

/// Returns the map called `name`.
fn map(name: &str) -> Result<MapKind> {
    MapKind::from_name(name)
        .ok_or_else(|| data::unknown_name("map", name, &MapKind::ALL.map(MapKind::name)))
}

/// Returns all maps by name, as `MapInfo`.
#[pyfunction]
pub(crate) fn _map_info(py: Python<'_>) -> Result<Bound<'_, PyDict>> {
    let info = py.import("dapple_textures._types")?.getattr("MapInfo")?;
    let all = PyDict::new(py);
    for map in MapKind::ALL {
        let Kind {
            content,
            n_channels,
        } = kind_of(map);
        let space = match content {
            Content::Color => "linear",
            _ => "non-color",
        };
        let entry = info.call1((n_channels, space, content.to_string()))?;
        all.set_item(map.name(), entry)?;
    }
    Ok(all)
}

/// Returns the names of all maps of a material.
///
/// Returns
/// -------
/// list of str
///     The names, in the library's order.
#[pyfunction]
pub(crate) fn map_names() -> Vec<&'static str> {
    MapKind::ALL.map(MapKind::name).to_vec()
}
