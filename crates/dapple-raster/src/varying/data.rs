//! Serialization of [`Varying`]: a plain number, or a table with the kind as its key.

use super::{Ramp, Varying};
use core::fmt;
use serde::de::value::MapAccessDeserializer;
use serde::de::{Deserialize, Deserializer, MapAccess, Visitor};
use serde::ser::{Error as _, Serialize, Serializer};

/// Serialized form of a [`Varying`]: a table with one key.
#[derive(serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "snake_case")]
enum Table {
    Constant(f64),
    Ramp(Ramp),
    GeometricRamp(Ramp),
}

impl Serialize for Varying {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        match self {
            Self::Constant(value) => serializer.serialize_f64(*value),
            Self::Ramp(ramp) => Table::Ramp(*ramp).serialize(serializer),
            Self::GeometricRamp(ramp) => Table::GeometricRamp(*ramp).serialize(serializer),
            Self::Raster { .. } | Self::Function(_) => Err(S::Error::custom(
                "what varies by a raster or a function cannot be written as data",
            )),
        }
    }
}

impl<'de> Deserialize<'de> for Varying {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(NumberOrTable)
    }
}

struct NumberOrTable;

impl<'de> Visitor<'de> for NumberOrTable {
    type Value = Varying;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("a number, or a table with `ramp` or `geometric_ramp`")
    }

    fn visit_f64<E>(self, value: f64) -> Result<Varying, E> {
        Ok(Varying::Constant(value))
    }

    fn visit_i64<E>(self, value: i64) -> Result<Varying, E> {
        Ok(Varying::Constant(value as f64))
    }

    fn visit_u64<E>(self, value: u64) -> Result<Varying, E> {
        Ok(Varying::Constant(value as f64))
    }

    fn visit_map<A: MapAccess<'de>>(self, map: A) -> Result<Varying, A::Error> {
        let table = Table::deserialize(MapAccessDeserializer::new(map))?;
        Ok(match table {
            Table::Constant(value) => Varying::Constant(value),
            Table::Ramp(ramp) => Varying::Ramp(ramp),
            Table::GeometricRamp(ramp) => Varying::GeometricRamp(ramp),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::super::{Ramp, Varying};
    use glam::DVec2;

    #[test]
    fn a_number_and_a_ramp_come_back_as_they_were() {
        let ramp = Ramp {
            from: DVec2::ZERO,
            to: DVec2::X,
            start: 0.25,
            end: 4.0,
        };
        let all = [
            Varying::Constant(0.5),
            Varying::Ramp(ramp),
            Varying::GeometricRamp(ramp),
        ];
        for varying in all {
            let text = serde_json::to_string(&varying).unwrap();
            let back: Varying = serde_json::from_str(&text).unwrap();
            for x in [0.0, 0.3, 2.0] {
                let at = DVec2::new(x, 0.0);
                assert_eq!(varying.at(at), back.at(at), "{text}");
            }
        }
        let whole: Varying = serde_json::from_str("3").unwrap();
        assert_eq!(whole.at(DVec2::X), 3.0, "a whole number");
    }

    #[test]
    fn what_is_neither_a_number_nor_a_table_is_refused() {
        for text in [
            "\"a\"",
            "[1]",
            "{\"slope\": 1}",
            "{}",
            "{\"ramp\": {\"from\": 1}}",
        ] {
            assert!(serde_json::from_str::<Varying>(text).is_err(), "{text}");
        }
        let function = Varying::function(|at| at.x);
        assert!(
            serde_json::to_string(&function).is_err(),
            "a function is no data"
        );
    }
}
