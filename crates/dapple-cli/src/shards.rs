//! Manages the list of a recipe's shards: its file, the names of the shards' files, and its checksum.
//!
//! The files of a list are in a directory whose name has the first digits of the list's checksum. The checksum covers
//! the version of dapple, the recipe as it is baked, the content of its images, and the sizes. A file with the name of
//! a shard is therefore complete and valid, regardless of the process that baked it, and a changed recipe does not
//! reuse old files. The list itself is `shards.json`, next to that directory.

use crate::args::{FiniteArgs, Frame, SamplesArgs, Shard, Size, file_name};
use crate::error::Hint;
use crate::input;
use crate::output::{self, Outputs, Target};
use anyhow::{Context as _, Error, Result, anyhow};
use dapple::recipe::{MapKind, Recipe, Region, Samples, Shards};
use serde::{Deserialize, Serialize};
use std::path::{Path, PathBuf};

/// The file name of a list.
const FILE: &str = "shards.json";
/// Maximum number of files in a list: shards times maps times frames.
const FILES_MAX: u64 = 1 << 20;
/// Number of digits of the checksum in the directory's name.
const DIGITS: usize = 12;

/// A list of the shards of a recipe, as stored in `shards.json`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct List {
    /// The version of dapple.
    dapple: String,
    /// The recipe, as given on the command line.
    recipe: String,
    /// The name of the recipe.
    pub(crate) name: String,
    /// Checksum of all inputs that determine the bits of the shards.
    sha256: String,
    /// Columns and rows of the maps.
    pub(crate) size: [u32; 2],
    /// Sample positions: pixel centers or corners.
    #[serde(default, skip_serializing_if = "is_default")]
    samples: Samples,
    /// Columns and rows of a shard.
    pub(crate) shard: [u32; 2],
    /// Overlap: the number of columns and rows that neighboring shards share. They count as part of a shard's size.
    #[serde(default, skip_serializing_if = "is_default")]
    pub(crate) overlap: u32,
    /// The names of the maps.
    maps: Vec<String>,
    /// Number of frames in a looping animation; `None` for still maps.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) frames: Option<u32>,
}

/// A shard of a list, which is baked as a unit.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Task {
    /// The frame of the loop.
    pub(crate) frame: Option<Frame>,
    /// The shard's position and size, as for `--shard`.
    pub(crate) shard: Shard,
    /// The shard's region of the map, in pixels.
    pub(crate) region: Region,
}

/// The requested properties of a new list.
pub(crate) struct Wanted<'a> {
    pub(crate) size: Size,
    pub(crate) samples: SamplesArgs,
    /// The command-line option for several samples per pixel; `None` for one sample.
    pub(crate) supersample: Option<String>,
    pub(crate) shard: Size,
    pub(crate) overlap: u32,
    pub(crate) maps: &'a [MapKind],
    pub(crate) frames: Option<u32>,
    pub(crate) finite: FiniteArgs,
}

impl List {
    /// Creates the list for a recipe as it is baked, with images in `folder`. `typed` is the recipe as given on the
    /// command line.
    ///
    /// # Errors
    ///
    /// If an image cannot be read.
    pub(crate) fn new(
        typed: &str,
        recipe: &Recipe,
        folder: &Path,
        wanted: &Wanted<'_>,
    ) -> Result<Self> {
        let version = env!("CARGO_PKG_VERSION");
        let files = recipe.image_files().into_iter();
        let images = files.map(|file| input::sha256(&folder.join(file)));
        let images = images.collect::<Result<Vec<_>>>()?;
        let Wanted {
            size,
            samples,
            supersample,
            shard,
            overlap,
            maps,
            frames,
            finite,
        } = wanted;
        let all = (version, recipe, images, size, shard, frames);
        // Leave options at their defaults out of the checksum, so that lists of older versions keep theirs.
        let described = match (overlap, finite.word(), samples.word(), supersample) {
            (0, None, None, None) => serde_json::to_vec(&all)?,
            (overlap, None, None, None) => serde_json::to_vec(&(all, overlap))?,
            (overlap, Some(word), None, None) => serde_json::to_vec(&(all, overlap, word))?,
            (overlap, word, Some(samples), None) => {
                serde_json::to_vec(&(all, overlap, word, samples))?
            }
            (overlap, word, samples, Some(supersample)) => {
                serde_json::to_vec(&(all, overlap, word, samples, supersample))?
            }
        };
        let list = Self {
            dapple: version.to_owned(),
            recipe: typed.to_owned(),
            name: recipe.name.clone(),
            sha256: output::sha256(&described),
            size: size.0,
            samples: samples.samples,
            shard: shard.0,
            overlap: *overlap,
            maps: maps.iter().map(|kind| kind.name().to_owned()).collect(),
            frames: *frames,
        };
        let counted = list.check_count();
        counted
            .hint("take larger shards, as in --shard 2048")
            .wrong_value()?;
        Ok(list)
    }

    /// Reads the list in a directory; `None` if there is no list.
    ///
    /// # Errors
    ///
    /// If the list cannot be read.
    pub(crate) fn read(folder: &Path) -> Result<Option<Self>> {
        let path = folder.join(FILE);
        if !path.exists() {
            return Ok(None);
        }
        input::check_regular(&path, "a list of shards")?;
        let text = input::text(&path)?;
        let list = serde_json::from_str(&text).map_err(Error::new);
        let list = list.and_then(|list: Self| list.checked());
        let list = list.with_context(|| format!("{} is no list of shards", path.display()))?;
        Ok(Some(list))
    }

    /// Validates the checksum, the maps and the number of files of a list that was read.
    fn checked(self) -> Result<Self> {
        let is_digit = |c: char| c.is_ascii_hexdigit();
        if self.sha256.len() != 64 || !self.sha256.chars().all(is_digit) {
            return Err(anyhow!("{:?} is no checksum", self.sha256));
        }
        if self.maps.is_empty() {
            return Err(anyhow!("it has no maps"));
        }
        self.check_count()?;
        Ok(self)
    }

    /// Returns an error if the list has more than [`FILES_MAX`] files.
    fn check_count(&self) -> Result<()> {
        let n_files = self.n_tasks()?.saturating_mul(self.maps.len() as u64);
        if n_files <= FILES_MAX {
            return Ok(());
        }
        Err(anyhow!(
            "there are {n_files} files of shards, but the limit is {FILES_MAX}"
        ))
    }

    /// Writes the list to a directory. A list of other shards is replaced only if `may_replace` is true.
    ///
    /// # Errors
    ///
    /// If the directory has a list of other shards that may not be replaced, or the file cannot be written.
    pub(crate) fn write(&self, folder: &Path, may_replace: bool) -> Result<()> {
        if !may_replace {
            self.check_folder(folder)?;
        }
        let mut outputs = Outputs::new(true);
        outputs.make_folder(folder)?;
        let output = outputs.claim(&Target::Path(folder.join(FILE)))?;
        let mut text = serde_json::to_string_pretty(self)?;
        text.push('\n');
        outputs.write(output, text.as_bytes())?;
        outputs.commit()
    }

    /// Returns an error if a directory has a list of other shards.
    ///
    /// # Errors
    ///
    /// If the checksum of the list in the directory differs, or that list cannot be read.
    pub(crate) fn check_folder(&self, folder: &Path) -> Result<()> {
        let Some(other) = Self::read(folder)? else {
            return Ok(());
        };
        if other.sha256 == self.sha256 {
            return Ok(());
        }
        let error = anyhow!(
            "{} lists shards of {}, and not these: the recipe, an image of it, a size, the loop, or the version of dapple is another",
            folder.join(FILE).display(),
            other.name,
        );
        Err(error.hint("take another folder, or list the shards again with `dapple shards --force`; files of the other list stay"))
    }

    /// Returns the maps of the list.
    ///
    /// # Errors
    ///
    /// If a map has an unknown name, as in a list of another version.
    pub(crate) fn map_kinds(&self) -> Result<Vec<MapKind>> {
        let kind = |name: &String| {
            MapKind::from_name(name).ok_or_else(|| anyhow!("there is no map {name:?}"))
        };
        self.maps.iter().map(kind).collect()
    }

    /// Returns the columns and rows of the grid of shards.
    ///
    /// # Errors
    ///
    /// If a size is zero.
    pub(crate) fn grid(&self) -> Result<[u32; 2]> {
        Ok(self.shards()?.grid())
    }

    /// Returns all shards, frame by frame.
    ///
    /// # Errors
    ///
    /// If a size is zero.
    pub(crate) fn tasks(&self) -> Result<impl Iterator<Item = Task>> {
        let shards = self.shards()?;
        let (size, overlap, steps) = (Size(self.shard), self.overlap, shards.steps());
        let task = move |frame, region: Region| {
            let place = [0, 1].map(|axis| region.first[axis] / steps[axis]);
            let shard = Shard {
                place,
                size,
                overlap,
            };
            Task {
                frame,
                shard,
                region,
            }
        };
        let of_frame = move |frame| shards.iter().map(move |region| task(frame, region));
        Ok(Frame::all(self.frames).flat_map(of_frame))
    }

    /// Returns the total number of shards in all frames.
    ///
    /// # Errors
    ///
    /// If a size is zero.
    pub(crate) fn n_tasks(&self) -> Result<u64> {
        let n_frames = self.frames.unwrap_or(1);
        Ok(self.shards()?.len().saturating_mul(n_frames.into()))
    }

    /// Returns the shards of a frame in one row of the grid, from left to right.
    ///
    /// # Errors
    ///
    /// If the row is outside of the grid.
    pub(crate) fn row(&self, frame: Option<Frame>, row: u32) -> Result<Vec<Task>> {
        let [columns, _] = self.grid()?;
        let task = |column| {
            let shard = Shard {
                place: [column, row],
                size: Size(self.shard),
                overlap: self.overlap,
            };
            let region = shard.region(Size(self.size))?;
            Ok(Task {
                frame,
                shard,
                region,
            })
        };
        (0..columns).map(task).collect()
    }

    /// Returns the path of a shard's map, relative to the directory of `shards.json`. Each row of shards has its own
    /// directory, which limits the number of files per directory.
    pub(crate) fn file(&self, frame: Option<Frame>, place: [u32; 2], kind: MapKind) -> PathBuf {
        let [column, row] = place;
        let digits = self.sha256.get(..DIGITS).unwrap_or(&self.sha256);
        let list = format!("{}-{digits}", file_name(&self.name));
        let frame = frame.map_or(String::new(), |frame| format!("{}_", frame.label()));
        let file = format!("x{column}_y{row}_{}.exr", kind.name());
        [list, format!("{frame}y{row}"), file].iter().collect()
    }

    fn shards(&self) -> Result<Shards> {
        Ok(Shards::new(self.size, self.shard)?.with_overlap(self.overlap)?)
    }
}

/// Returns whether a value is its type's default; serde then omits it from the list.
fn is_default<T: Default + PartialEq>(value: &T) -> bool {
    *value == T::default()
}
