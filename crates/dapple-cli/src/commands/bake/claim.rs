//! The files of a recipe: claimed before the work begins, and written when it is done.

use super::documents::{glb, mtlx};
use super::presets::Document;
use super::{Args, Work};
use crate::args::{OutputArgs, Shard, Targets};
use crate::baking::{self, MapFile};
use crate::encode::Format;
use crate::error::{Hint, usage};
use crate::job::Job;
use crate::layers::{Image, Layers};
use crate::output::{OutputIdx, Outputs, Target};
use crate::progress::Progress;
use crate::shards::List;
use anyhow::{Error, Result};
use dapple::recipe::{Bake, MapKind, Recipe};
use std::path::Path;

/// The files of a recipe.
pub(super) struct Claimed {
    /// The images that are to be made.
    pub(super) images: Vec<Image>,
    /// Files of a shard that are there already.
    pub(super) finished: Vec<Target>,
    /// A file for each image, unless a document has them in it.
    files: Vec<MapFile>,
    document: Option<(OutputIdx, Document)>,
    pub(super) preview: Option<(OutputIdx, Format)>,
}

/// Claims a file for each image, and for all that goes with them: the output itself for a single one, unless that is a folder,
/// and else `NAME_MAP.png`.
pub(super) fn claim(
    args: &Args,
    files: &OutputArgs,
    work: &Work,
    job: &mut Job<'_>,
) -> Result<Claimed> {
    let Targets { main, files } = targets(args, files, work)?;
    let mut places = files.into_iter();
    let mut claimed = Claimed {
        images: Vec::new(),
        finished: Vec::new(),
        files: Vec::new(),
        document: None,
        preview: None,
    };
    if let Some(document) = args.document()
        && let Some(target) = places.next()
    {
        check_ending(&target, document)?;
        claimed.document = Some((job.claim(&target)?, document));
    }
    for (_, layers, asked) in args.images() {
        if args.has_images_in_it() {
            let format = asked.unwrap_or(Format::Png8);
            claimed.images.push(Image { layers, format });
            continue;
        }
        let Some(target) = places.next() else { break };
        let target = match claimed.document {
            Some(_) => target.with_ending("png"),
            None => target,
        };
        if args.is_finished(&target) {
            claimed.finished.push(target);
            continue;
        }
        let image = image(layers, asked, &target)?;
        let output = job.claim(&target)?;
        let sheet = args.sheet.then(|| places.next()).flatten();
        let sheet = sheet.map(|sheet| job.claim(&sheet)).transpose()?;
        claimed.images.push(image);
        claimed.files.push(MapFile {
            image,
            output,
            sheet,
        });
    }
    if let Some(target) = places.next() {
        claimed.preview = Some(claim_preview(args, target, job)?);
    }
    job.claim_sidecar(&main)?;
    Ok(claimed)
}

/// The names of all files: the document, each image with its sheet, and the preview; or those of a shard.
fn targets(args: &Args, files: &OutputArgs, work: &Work) -> Result<Targets> {
    if let (Some(shard), Some(list)) = (args.shard, &work.list) {
        let folder = files.output.as_deref().ok_or_else(no_folder)?;
        return shard_targets(args, folder, shard, list);
    }
    let document = args.document();
    // A document is the output itself.
    let mut parts: Vec<_> = document.iter().map(|_| String::new()).collect();
    let images = args.images();
    for (part, ..) in images.iter().filter(|_| !args.has_images_in_it()) {
        parts.push((*part).to_owned());
        parts.extend(args.sheet.then(|| format!("{part}_2x2")));
    }
    parts.extend(args.preview.map(|_| "preview".to_owned()));
    if let Some(frame) = args.frame {
        for part in parts.iter_mut().filter(|part| !part.is_empty()) {
            *part += &format!("_{}", frame.label());
        }
    }
    let ending = match document {
        Some(document) => document.ending(),
        None => args.format.map_or("png", Format::ending),
    };
    let prefix = args.preset().map_or("", |preset| preset.prefix);
    let mut targets = files.targets(&format!("{prefix}{}", work.recipe.name), &parts, ending)?;
    if let (Some(frame), Some(_)) = (args.frame, args.frames) {
        // Of a loop the output itself is numbered, too, as is the JSON file beside it.
        let numbered = targets.main.part(&frame.label())?;
        for file in targets
            .files
            .iter_mut()
            .filter(|file| **file == targets.main)
        {
            file.clone_from(&numbered);
        }
        targets.main = numbered;
    }
    Ok(targets)
}

/// The files of a shard, in a folder that is made for good: other runs may need it before this one is done.
fn shard_targets(args: &Args, folder: &Path, shard: Shard, list: &List) -> Result<Targets> {
    list.check_folder(folder)?;
    let kinds = args.material.map_kinds().iter();
    let file = |&kind: &MapKind| folder.join(list.file(args.frame, shard.place, kind));
    let files: Vec<_> = kinds.map(file).collect();
    if let Some(folder) = files.first().and_then(|file| file.parent()) {
        Outputs::make_lasting_folder(folder)?;
    }
    let files: Vec<_> = files.into_iter().map(Target::Path).collect();
    let main = files.first().cloned().unwrap_or(Target::Stdout);
    Ok(Targets { main, files })
}

fn no_folder() -> Error {
    usage("missing output").hint("add -o DIR/, the folder of the shards")
}

/// An image in the format of its file.
fn image(layers: Layers, asked: Option<Format>, target: &Target) -> Result<Image> {
    let format = baking::format(asked, target)?;
    format.check(layers.content(), target)?;
    Ok(Image { layers, format })
}

/// Claims the lit preview, which is a PNG where the maps are not images.
fn claim_preview(args: &Args, target: Target, job: &mut Job<'_>) -> Result<(OutputIdx, Format)> {
    let target = match target.ending().as_str() {
        "png" | "exr" => target,
        _ => target.with_ending("png"),
    };
    let asked = args
        .format
        .filter(|format| format.ending() == target.ending());
    let format = baking::format(asked, &target)?;
    Ok((job.claim(&target)?, format))
}

/// Refuses a name that is none of such a document.
fn check_ending(target: &Target, document: Document) -> Result<()> {
    let ending = document.ending();
    if *target == Target::Stdout || target.ending() == ending {
        return Ok(());
    }
    let error = usage(format!("{target} is not a name for a .{ending}"));
    Err(error.hint(format!(
        "let it end in .{ending}, or in a slash for a folder"
    )))
}

impl Args {
    /// Whether a file is a finished one of a shard. What is under the name of a shard is whole, and belongs to its list.
    fn is_finished(&self, target: &Target) -> bool {
        let is_there = |path: &Path| path.exists();
        self.shard.is_some() && !self.files.force && target.path().is_some_and(is_there)
    }
}

impl Claimed {
    /// The maps that the images are made of, each once.
    pub(super) fn map_kinds(&self) -> Vec<MapKind> {
        let mut kinds: Vec<MapKind> = Vec::new();
        for kind in self.images.iter().flat_map(|image| image.layers.kinds()) {
            if !kinds.contains(&kind) {
                kinds.push(kind);
            }
        }
        kinds
    }

    /// Writes the images, and the document that is made of them.
    pub(super) fn write(
        &self,
        job: &mut Job<'_>,
        bake: Bake<'_>,
        recipe: &Recipe,
        progress: &Progress,
    ) -> Result<()> {
        match self.document {
            None => baking::write(job, bake, &self.files, progress),
            Some((output, Document::Glb)) => {
                let images = baking::encode(bake, &self.images, progress)?;
                job.write(output, &glb(recipe, images)?)
            }
            Some((output, Document::Mtlx)) => {
                baking::write(job, bake, &self.files, progress)?;
                let name = |file: &MapFile| (file.image.layers, job.target(file.output).name());
                let names: Vec<_> = self.files.iter().map(name).collect();
                job.write(output, mtlx(recipe, &names).as_bytes())
            }
        }
    }
}
