//! Small pictures of the built-in recipes and of those in the folder.

use crate::{StudioError, sample};
use dapple::recipe::{Images, Recipe};
use std::collections::BTreeMap;
use std::sync::{Arc, Mutex, PoisonError};

/// Pictures that were made, by the text of the recipe and the side.
#[derive(Default)]
pub(super) struct Gallery {
    made: Mutex<BTreeMap<(String, u32), Arc<Sample>>>,
}

/// A small picture.
pub(super) struct Sample {
    pub(super) size: [u32; 2],
    pub(super) pixels: Vec<u8>,
}

/// The longest side of a picture, in pixels.
pub(super) const MOST: u32 = 256;
/// The most pictures that are kept.
const KEPT: usize = 1000;

impl Gallery {
    /// The picture of a recipe.
    pub(super) fn of(
        &self,
        text: &str,
        side: u32,
        images: impl Fn(&Recipe) -> Result<Images, StudioError>,
    ) -> Result<Arc<Sample>, StudioError> {
        let key = (text.to_owned(), side);
        let known = self
            .made
            .lock()
            .unwrap_or_else(PoisonError::into_inner)
            .get(&key)
            .cloned();
        if let Some(known) = known {
            return Ok(known);
        }
        let recipe = Recipe::from_toml(text)?;
        let (size, pixels) = sample::lit(&recipe, &images(&recipe)?, side.clamp(1, MOST))?;
        let sample = Arc::new(Sample { size, pixels });
        let mut made = self.made.lock().unwrap_or_else(PoisonError::into_inner);
        if made.len() >= KEPT {
            made.clear();
        }
        made.insert(key, sample.clone());
        Ok(sample)
    }
}
