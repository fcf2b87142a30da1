//! Descriptions of objects, which share the object that is built from them.

use crate::error::Result;
use serde::{Deserialize, Deserializer, Serialize, Serializer};
use std::sync::{Arc, OnceLock};

/// A description of an object that is expensive to build.
pub(crate) trait Build {
    /// The built object, which is cheap to clone.
    type Built: Clone;

    /// Builds the object.
    fn build(&self) -> Result<Self::Built>;
}

/// A description with the object built from it. The object is built once, on first use, and shared by all clones.
/// Serialization and comparison use only the description.
pub(crate) struct Shared<T: Build>(Arc<(T, OnceLock<T::Built>)>);

impl<T: Build> Shared<T> {
    /// Wraps a description, without building its object.
    pub(crate) fn new(made: T) -> Self {
        Self(Arc::new((made, OnceLock::new())))
    }

    /// Returns the description.
    pub(crate) fn made(&self) -> &T {
        &self.0.0
    }

    /// Returns the described object, built on first use.
    pub(crate) fn get(&self) -> Result<T::Built> {
        let (made, built) = &*self.0;
        if let Some(built) = built.get() {
            return Ok(built.clone());
        }
        let new = made.build()?;
        Ok(built.get_or_init(|| new).clone())
    }
}

impl<T: Build> Clone for Shared<T> {
    fn clone(&self) -> Self {
        Self(Arc::clone(&self.0))
    }
}

impl<T: Build + PartialEq> PartialEq for Shared<T> {
    fn eq(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.0, &other.0) || self.made() == other.made()
    }
}

impl<T: Build + core::fmt::Debug> core::fmt::Debug for Shared<T> {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        self.made().fmt(f)
    }
}

impl<T: Build + Serialize> Serialize for Shared<T> {
    fn serialize<S: Serializer>(&self, serializer: S) -> core::result::Result<S::Ok, S::Error> {
        self.made().serialize(serializer)
    }
}

impl<'de, T: Build + Deserialize<'de>> Deserialize<'de> for Shared<T> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> core::result::Result<Self, D::Error> {
        T::deserialize(deserializer).map(Self::new)
    }
}
