//! Parses a list of maps on the command line.

use crate::words::{unknown, with_underscores};
use dapple::recipe::MapKind;
use serde::{Serialize, Serializer};
use std::str::FromStr;

/// The maps to bake, each once.
#[derive(Clone, Debug)]
pub(super) struct Maps(pub(super) Vec<MapKind>);

impl Maps {
    /// Returns whether the list has all maps, in their order.
    pub(super) fn are_all(&self) -> bool {
        self.0 == MapKind::ALL
    }

    /// Returns the names of the maps, or `all`.
    pub(super) fn names(&self) -> Vec<&'static str> {
        match self.are_all() {
            true => vec!["all"],
            false => self.0.iter().map(|kind| kind.name()).collect(),
        }
    }
}

impl FromStr for Maps {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        if with_underscores(text) == "all" {
            return Ok(Self(MapKind::ALL.to_vec()));
        }
        let mut maps = Vec::new();
        for name in text.split(',') {
            let names = MapKind::ALL.map(MapKind::name);
            let kind = MapKind::from_name(&with_underscores(name));
            let kind = kind.ok_or_else(|| unknown("map", name, &names, ", or all"))?;
            if maps.contains(&kind) {
                return Err(format!("the map {} is asked for twice", kind.name()));
            }
            maps.push(kind);
        }
        Ok(Self(maps))
    }
}

impl Serialize for Maps {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_seq(self.0.iter().map(|kind| kind.name()))
    }
}

#[cfg(test)]
mod tests {
    use super::Maps;

    #[test]
    fn maps_go_by_their_names_in_any_case() {
        let names = |text: &str| -> Result<Vec<_>, String> {
            let maps: Maps = text.parse()?;
            Ok(maps.0.iter().map(|kind| kind.name()).collect())
        };
        assert_eq!(names("AO, BaseColor"), Ok(vec!["ao", "albedo"]));
        assert_eq!(names("base-color"), names("albedo"));
        assert_eq!(names("All").map(|maps| maps.len()), Ok(12));
        for (wrong, part) in [
            ("bumps", "roughness"),
            ("heigth", "height?"),
            ("ao,ao", "twice"),
        ] {
            let error = names(wrong).unwrap_err();
            assert!(error.contains(part), "{wrong}: {error}");
        }
    }
}
