//! Claims a recipe's output files before the work begins, and writes them when it is done.

use super::documents::{glb, mtlx, tres};
use super::presets::Document;
use super::unity;
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
use std::path::{Path, PathBuf};

/// The claimed files of a recipe.
pub(super) struct Claimed {
    /// The images to bake.
    pub(super) images: Vec<Image>,
    /// Files of the shard that exist already and are not baked again.
    pub(super) finished: Vec<Target>,
    /// A file for each image; empty if a document embeds the images.
    files: Vec<MapFile>,
    document: Option<(OutputIdx, Document)>,
    /// Unity's import settings of each image: their output file, the layers of the image, and the image's file name.
    metas: Vec<(OutputIdx, Layers, String)>,
    pub(super) preview: Option<(OutputIdx, Format)>,
}

/// Claims the document, a file for each image and its sheet, the preview, and the sidecar. A single file has the output
/// path itself, unless that is a directory. Several files are called `NAME_MAP.EXTENSION`.
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
        metas: Vec::new(),
        preview: None,
    };
    if let Some(document) = args.document()
        && let Some(target) = places.next()
    {
        // The material of Godot keeps its extension if the output is named like an image.
        let target = match document {
            Document::Tres => target.with_ending("tres"),
            Document::Glb | Document::Mtlx => target,
        };
        check_ending(&target, document)?;
        claimed.document = Some((job.claim(&target)?, document));
    }
    for (_, layers, asked) in args.images(&work.recipe.material) {
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
        if args.preset().is_some_and(|preset| preset.has_metas) {
            claim_meta(&target, layers, &mut claimed, job)?;
        }
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

/// Returns the paths of all files, in the order of [`claim`]: the document, each image with its sheet, and the preview.
/// For a shard, returns the paths of its maps.
fn targets(args: &Args, files: &OutputArgs, work: &Work) -> Result<Targets> {
    if let (Some(shard), Some(list)) = (args.shard, &work.list) {
        let folder = files.output.as_deref().ok_or_else(no_folder)?;
        return shard_targets(args, folder, shard, work, list);
    }
    let document = args.document();
    // The document is the output itself, and so has an empty part name.
    let mut parts: Vec<_> = document.iter().map(|_| String::new()).collect();
    let images = args.images(&work.recipe.material);
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
        // Number the output itself, too, so that each frame has its own document and sidecar.
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

/// Returns the paths of a shard's files. Their directory is created here and remains, since other runs may need it
/// before this one is done.
fn shard_targets(
    args: &Args,
    folder: &Path,
    shard: Shard,
    work: &Work,
    list: &List,
) -> Result<Targets> {
    list.check_folder(folder)?;
    let kinds = args.material.map_kinds(&work.recipe.material).into_iter();
    let file = |kind: MapKind| folder.join(list.file(args.frame, shard.place, kind));
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

/// Chooses the format of an image, and checks that the format can store its content.
fn image(layers: Layers, asked: Option<Format>, target: &Target) -> Result<Image> {
    let format = baking::format(asked, target)?;
    format.check(layers.content(), target)?;
    Ok(Image { layers, format })
}

/// Claims the file of an image's import settings for Unity, unless it exists. Existing settings may have been edited in
/// Unity, and are not replaced.
fn claim_meta(
    image: &Target,
    layers: Layers,
    claimed: &mut Claimed,
    job: &mut Job<'_>,
) -> Result<()> {
    let Some(path) = image.path() else {
        return Ok(());
    };
    let mut meta = path.as_os_str().to_owned();
    meta.push(".meta");
    let meta = PathBuf::from(meta);
    if !meta.exists() {
        let output = job.claim_text(&Target::Path(meta))?;
        claimed.metas.push((output, layers, image.name()));
    }
    Ok(())
}

/// Claims the file of the lit preview. It is a PNG if the maps are neither PNG nor OpenEXR.
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

/// Returns an error unless the target has the document's file extension.
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
    /// Returns whether a shard's file exists and need not be baked again. Such a file is complete, and its directory's
    /// name shows that it belongs to the shard's list.
    fn is_finished(&self, target: &Target) -> bool {
        let is_there = |path: &Path| path.exists();
        self.shard.is_some() && !self.files.force && target.path().is_some_and(is_there)
    }
}

impl Claimed {
    /// Returns the kinds of all maps that the images contain, without duplicates.
    pub(super) fn map_kinds(&self) -> Vec<MapKind> {
        let mut kinds: Vec<MapKind> = Vec::new();
        for kind in self.images.iter().flat_map(|image| image.layers.kinds()) {
            if !kinds.contains(&kind) {
                kinds.push(kind);
            }
        }
        kinds
    }

    /// Bakes the images and writes them, and writes the document that embeds or references them.
    pub(super) fn write(
        &self,
        job: &mut Job<'_>,
        bake: Bake<'_>,
        recipe: &Recipe,
        progress: &Progress,
    ) -> Result<()> {
        let Some((output, document)) = self.document else {
            return baking::write(job, bake, &self.files, progress);
        };
        let text = match document {
            Document::Glb => {
                let images = baking::encode(bake, &self.images, progress)?;
                let layers = self.images.iter().map(|image| image.layers);
                return job.write(output, &glb(recipe, layers.zip(images))?);
            }
            Document::Mtlx => mtlx,
            Document::Tres => tres,
        };
        baking::write(job, bake, &self.files, progress)?;
        let name = |file: &MapFile| (file.image.layers, job.target(file.output).name());
        let names: Vec<_> = self.files.iter().map(name).collect();
        job.write(output, text(recipe, &names).as_bytes())
    }

    /// Writes the import settings of the images.
    pub(super) fn write_metas(&self, job: &Job<'_>, recipe: &Recipe) -> Result<()> {
        for (output, layers, image) in &self.metas {
            let meta = unity::meta(recipe, *layers, image);
            job.write(*output, meta.as_bytes())?;
        }
        Ok(())
    }

    /// Returns the files of the images.
    pub(super) fn files(&self) -> &[MapFile] {
        &self.files
    }
}
