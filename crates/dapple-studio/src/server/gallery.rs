//! Thumbnails of the built-in recipes and of the recipes in the folder.

use crate::{Picture, Shown, StudioError, sample};
use dapple::recipe::{Images, Recipe};
use std::collections::BTreeMap;
use std::sync::{Mutex, PoisonError};

/// A cache of thumbnails. The key is the text of the recipe and the longer side in pixels.
#[derive(Default)]
pub(super) struct Gallery {
    made: Mutex<BTreeMap<(String, u32), Picture>>,
}

/// Maximum number of cached thumbnails. A full cache is cleared.
const KEPT: usize = 1000;

impl Gallery {
    /// Returns the thumbnail of a recipe from the cache, or renders it.
    pub(super) fn of(
        &self,
        shown: Shown,
        text: &str,
        side: u32,
        images: impl Fn(&Recipe) -> Result<Images, StudioError>,
    ) -> Result<Picture, StudioError> {
        let key = (text.to_owned(), side);
        let known = self
            .made
            .lock()
            .unwrap_or_else(PoisonError::into_inner)
            .get(&key)
            .cloned();
        if let Some(known) = known {
            return Ok(Picture { shown, ..known });
        }
        let recipe = Recipe::from_toml(text)?;
        let picture = sample(shown, &recipe, &images(&recipe)?, side)?;
        let mut made = self.made.lock().unwrap_or_else(PoisonError::into_inner);
        if made.len() >= KEPT {
            made.clear();
        }
        made.insert(key, picture.clone());
        Ok(picture)
    }
}
