//! Parses the maps of a material on the command line, given as `NAME=FILE`.

use crate::input::Kind;
use crate::words::with_underscores;
use dapple::recipe::MapKind;
use serde::Serialize;
use std::path::PathBuf;
use std::str::FromStr;

/// A map of a material, given as `NAME=FILE`.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub(crate) struct MapArg {
    /// Name of the map, of letters, digits and `_`. The name `normal` makes it a normal map.
    pub(crate) name: String,
    pub(crate) path: PathBuf,
}

impl FromStr for MapArg {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let is_name = |name: &str| {
            let is_part = |byte: u8| byte.is_ascii_alphanumeric() || byte == b'_';
            !name.is_empty() && name.bytes().all(is_part)
        };
        match text.split_once('=') {
            Some((name, path)) if is_name(name) && !path.is_empty() => Ok(Self {
                name: name.to_owned(),
                path: PathBuf::from(path),
            }),
            _ => Err(format!(
                "{text:?} is not a map: give NAME=FILE, such as normal=FILE"
            )),
        }
    }
}

impl MapArg {
    /// Returns how the image must be read: as normals if its name is that of a normal map, otherwise by its channels.
    pub(crate) fn kind(&self) -> Kind {
        match MapKind::from_name(&with_underscores(&self.name)) {
            Some(MapKind::Normal) => Kind::Normals,
            _ => Kind::ByChannels,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::MapArg;

    #[test]
    fn maps_have_a_name_and_a_file() {
        let map: MapArg = "normal=a=b.png".parse().unwrap();
        assert_eq!(
            (map.name.as_str(), map.path.to_str()),
            ("normal", Some("a=b.png"))
        );
        for text in ["", "normal", "normal=", "=a.png", "my map=a.png"] {
            assert!(
                text.parse::<MapArg>().unwrap_err().contains("NAME=FILE"),
                "{text:?}"
            );
        }
    }
}
