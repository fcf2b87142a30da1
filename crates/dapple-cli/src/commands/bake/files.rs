//! Reuses the options of `bake` for output files in subcommands that create a material without a recipe file.

use super::{Args, MaterialArgs, Work};
use crate::args::{OutputArgs, Size};
use crate::job::Context;
use crate::progress::Progress;
use anyhow::Result;
use clap::{ArgMatches, Command, Error, FromArgMatches};
use dapple::recipe::{Images, Recipe};
use serde::Serialize;
use std::path::Path;

/// Names of the reused options.
const IDS: [&str; 10] = [
    "maps", "preset", "normal_y", "sheet", "preview", "format", "output", "name", "force", "json",
];

/// The files of a material: maps, presets, format, previews and output. The options are those of `bake`.
#[derive(Clone, Debug, Serialize)]
#[serde(transparent)]
pub(in crate::commands) struct MaterialFiles(Box<Args>);

impl clap::Args for MaterialFiles {
    fn augment_args(command: Command) -> Command {
        let bake = Args::augment_args(Command::new("bake"));
        let is_shared = |arg: &&clap::Arg| IDS.contains(&arg.get_id().as_str());
        command.args(bake.get_arguments().filter(is_shared).cloned())
    }

    fn augment_args_for_update(command: Command) -> Command {
        Self::augment_args(command)
    }
}

impl FromArgMatches for MaterialFiles {
    fn from_arg_matches(matches: &ArgMatches) -> Result<Self, Error> {
        Ok(Self(Box::new(Args {
            recipes: Vec::new(),
            // The size is set when the material is baked.
            material: MaterialArgs::new(
                Size([1; 2]),
                matches.get_one("maps").cloned(),
                matches.get_one("normal_y").copied(),
            ),
            preset: (matches.get_many("preset").into_iter().flatten().copied()).collect(),
            node: None,
            region: None,
            shard: None,
            frame: None,
            frames: None,
            flipbook: None,
            banded: false,
            keep_going: false,
            gpu: false,
            sheet: matches.get_flag("sheet"),
            preview: matches.get_one("preview").copied(),
            contact_sheet: false,
            format: matches.get_one("format").copied(),
            files: OutputArgs::from_arg_matches(matches)?,
        })))
    }

    fn update_from_arg_matches(&mut self, matches: &ArgMatches) -> Result<(), Error> {
        *self = Self::from_arg_matches(matches)?;
        Ok(())
    }
}

impl MaterialFiles {
    /// Refuses options that have no effect on the files.
    ///
    /// # Errors
    ///
    /// If such an option is given.
    pub(in crate::commands) fn check(&self) -> Result<()> {
        self.0.check_document()
    }

    /// Bakes a recipe with images in memory, and writes the files.
    ///
    /// # Errors
    ///
    /// If an option is invalid, the recipe cannot be baked, or a file cannot be written.
    pub(in crate::commands) fn bake(
        &self,
        size: [u32; 2],
        recipe: Recipe,
        images: Images,
        context: &Context,
    ) -> Result<()> {
        let mut args = (*self.0).clone();
        args.material.size = Size(size);
        let works = Work::of_presets(&args, &recipe, Path::new(""), Some(&images))?;
        let rows = u64::from(args.n_rows()?) * works.len() as u64;
        let progress = Progress::bar("baking", rows, context);
        for mut work in works {
            work.bake(context, &progress)?;
        }
        Ok(())
    }
}
