//! Serializes [`Spacing`] as a plain number (the smallest distance) or as a table that names the quantity.

use super::Spacing;
use core::fmt;
use dapple_raster::Varying;
use serde::de::value::MapAccessDeserializer;
use serde::de::{Deserialize, Deserializer, MapAccess, Visitor};
use serde::ser::{Serialize, Serializer};

/// A spacing in table form.
#[derive(serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "snake_case")]
enum Table {
    Distance(Varying),
    Density(Varying),
    Count(u32),
}

impl Serialize for Spacing {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let table = match self {
            Self::Distance(Varying::Constant(distance)) => {
                return serializer.serialize_f64(*distance);
            }
            Self::Distance(distance) => Table::Distance(distance.clone()),
            Self::Density(density) => Table::Density(density.clone()),
            Self::Count(count) => Table::Count(*count),
        };
        table.serialize(serializer)
    }
}

impl<'de> Deserialize<'de> for Spacing {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(NumberOrTable)
    }
}

struct NumberOrTable;

impl<'de> Visitor<'de> for NumberOrTable {
    type Value = Spacing;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("a number, or a table with `distance`, `density` or `count`")
    }

    fn visit_f64<E>(self, value: f64) -> Result<Spacing, E> {
        Ok(Spacing::from(value))
    }

    fn visit_i64<E>(self, value: i64) -> Result<Spacing, E> {
        Ok(Spacing::from(value as f64))
    }

    fn visit_u64<E>(self, value: u64) -> Result<Spacing, E> {
        Ok(Spacing::from(value as f64))
    }

    fn visit_map<A: MapAccess<'de>>(self, map: A) -> Result<Spacing, A::Error> {
        Ok(match Table::deserialize(MapAccessDeserializer::new(map))? {
            Table::Distance(distance) => Spacing::Distance(distance),
            Table::Density(density) => Spacing::Density(density),
            Table::Count(count) => Spacing::Count(count),
        })
    }
}
