//! The subcommands, with one file for each.

mod bake;
mod blend;
mod blend_map;
mod completions;
mod copies;
mod info;
mod join;
mod licenses;
mod man;
mod noise;
mod photo;
mod points;
mod pups;
mod recipe;
mod shards;
#[cfg(feature = "studio")]
mod studio;
mod synth;
mod tile;
mod watch;
mod wavelet;
mod wgsl;
mod worley;

use crate::error::Exit;
use crate::job::Context;
use anyhow::Result;
use clap::Subcommand;

/// The subcommands, in the order of `--help`.
#[derive(Debug, Subcommand)]
pub(crate) enum Command {
    Bake(Box<bake::Args>),
    Watch(Box<watch::Args>),
    #[cfg(feature = "studio")]
    Studio(Box<studio::Args>),
    Shards(Box<shards::Args>),
    Join(Box<join::Args>),
    Recipe(Box<recipe::Args>),
    Worley(Box<worley::Args>),
    Pups(Box<pups::Args>),
    Noise(Box<noise::Args>),
    Wavelet(Box<wavelet::Args>),
    Wgsl(wgsl::Args),
    Tile(Box<tile::Args>),
    Photo(Box<photo::Args>),
    Copies(Box<copies::Args>),
    Blend(Box<blend::Args>),
    BlendMap(Box<blend_map::Args>),
    Synth(Box<synth::Args>),
    Points(Box<points::Args>),
    Info(info::Args),
    Completions(completions::Args),
    Man(man::Args),
    Licenses(licenses::Args),
}

/// Runs a subcommand.
///
/// # Errors
///
/// If the subcommand fails.
pub(crate) fn run(command: &Command, context: &Context) -> Result<Exit> {
    match command {
        Command::Bake(args) => bake::run(args, context),
        Command::Watch(args) => watch::run(args, context),
        #[cfg(feature = "studio")]
        Command::Studio(args) => studio::run(args, context),
        Command::Shards(args) => shards::run(args, context),
        Command::Join(args) => join::run(args, context),
        Command::Recipe(args) => recipe::run(args, context),
        Command::Worley(args) => worley::run(args, context),
        Command::Pups(args) => pups::run(args, context),
        Command::Noise(args) => noise::run(args, context),
        Command::Wavelet(args) => wavelet::run(args, context),
        Command::Wgsl(args) => wgsl::run(args, context),
        Command::Tile(args) => tile::run(args, context),
        Command::Photo(args) => photo::run(args, context),
        Command::Copies(args) => copies::run(args, context),
        Command::Blend(args) => blend::run(args, context),
        Command::BlendMap(args) => blend_map::run(args, context),
        Command::Synth(args) => synth::run(args, context),
        Command::Points(args) => points::run(args, context),
        Command::Info(args) => info::run(args, context),
        Command::Completions(args) => completions::run(args),
        Command::Man(args) => man::run(args, context),
        Command::Licenses(args) => licenses::run(args),
    }
}
