//! Small pictures of the built-in recipes and of those in the folder.

use crate::{Picture, Shown, StudioError, sample};
use dapple::recipe::{Images, Recipe};
use std::collections::BTreeMap;
use std::sync::{Mutex, PoisonError};

/// Pictures that were made, by the text of the recipe and the side.
#[derive(Default)]
pub(super) struct Gallery {
    made: Mutex<BTreeMap<(String, u32), Picture>>,
}

/// The most pictures that are kept.
const KEPT: usize = 1000;

impl Gallery {
    /// The picture of a recipe.
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
