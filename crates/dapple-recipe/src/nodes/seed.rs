//! Seeds that override those of nodes.

use core::fmt;
use dapple_hash::Seed;
use serde::de::{Deserialize, Deserializer, Error, Visitor};
use serde::ser::{Serialize, Serializer};

/// Overrides a node's seed, which is derived from its name otherwise. Two nodes with the same seed draw the same random
/// numbers.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum NodeSeed {
    /// Seed that does not depend on the recipe's seed.
    Seed(Seed),
    /// Name from which to derive the seed, such as another node's name.
    Name(String),
}

impl Serialize for NodeSeed {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        match self {
            Self::Seed(seed) => seed.serialize(serializer),
            Self::Name(name) => serializer.serialize_str(name),
        }
    }
}

impl<'de> Deserialize<'de> for NodeSeed {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(NodeSeedVisitor)
    }
}

struct NodeSeedVisitor;

impl Visitor<'_> for NodeSeedVisitor {
    type Value = NodeSeed;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("the name to draw by, or a seed from 0 on")
    }

    fn visit_u64<E>(self, seed: u64) -> Result<NodeSeed, E> {
        Ok(NodeSeed::Seed(Seed(seed)))
    }

    fn visit_i64<E: Error>(self, seed: i64) -> Result<NodeSeed, E> {
        let seed = u64::try_from(seed)
            .map_err(|_| E::invalid_value(serde::de::Unexpected::Signed(seed), &self))?;
        self.visit_u64(seed)
    }

    fn visit_str<E>(self, name: &str) -> Result<NodeSeed, E> {
        Ok(NodeSeed::Name(name.to_owned()))
    }
}
