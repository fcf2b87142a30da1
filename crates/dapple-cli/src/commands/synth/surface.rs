//! Synthesizes a texture on a mesh, and writes its output files.

use super::corners::{own_uvs, shading};
use super::example_mesh::ExampleMesh;
use super::material::{MaterialMaps, alpha_mode, is_of};
use super::options::AtlasName;
use super::reading::Input;
use super::tiles::Tiles;
use super::{Args, STEPS, advise, guides, shown};
use crate::encode::{Clear, Cover, Format, default_format, encode, encode_with_alpha, ramped};
use crate::error::{Exit, Hint, usage};
use crate::input;
use crate::job::{Context, Job, eprintln_if_possible};
use crate::output::{OutputIdx, Target};
use crate::progress::Progress;
use anyhow::{Context as _, Result, bail};
use core::ops::ControlFlow;
use dapple::color::{LinearRgba, NormalY};
use dapple::mesh::{EncodedImage, Material, Mesh, Model, Repair, Surface, TileMaterial};
use dapple::mesh_io::{FORMATS, MaterialPlace, MeshFormat, writable_endings};
use dapple::points::glam::{DVec2, DVec3};
use dapple::raster::Raster;
use dapple::recipe::MapKind;
use dapple::synth::{
    Atlas, AtlasReport, Direction, Exemplar, Hierarchy, HierarchyOptions, MeshExemplar,
    Orientation, SurfaceTexture, SynthError, Synthesizer, bake_colors, bake_colors_alpha,
    bake_normals, bake_values, repeats_of_sites, site_model, textured_model,
};
use dapple::tile::Map;
use serde_json::json;
use std::path::Path;

/// The kind of output for a mesh.
#[derive(Clone, Copy, Debug)]
pub(super) enum Product {
    /// The mesh with its texture.
    Model(&'static MeshFormat),
    /// A mesh whose vertices are the sites, in a format without textures.
    Sites(&'static MeshFormat),
    /// The texture alone.
    Texture,
}

/// The signature of a PNG file.
const PNG: &[u8] = b"\x89PNG\r\n\x1a\n";
/// The file extensions of images.
const IMAGES: [&str; 4] = ["png", "exr", "npy", "r16"];

/// The file extension if the output is standard output or a directory.
const DEFAULT_ENDING: &str = "glb";

/// Output files of a texture on a mesh, after they are claimed.
struct Claimed {
    product: Product,
    /// The file name of the output without its extension.
    stem: String,
    /// The output file, or a file for the texture of each UDIM tile.
    main: Vec<OutputIdx>,
    /// The files next to the mesh, such as materials and textures, with their names.
    beside: Vec<(String, OutputIdx)>,
    /// For each map, its files, one per atlas. Empty for a map that is only embedded, or that is written next to the
    /// mesh.
    maps: Vec<Vec<OutputIdx>>,
    /// The format for textures in separate files.
    format: Format,
}

/// Reads the mesh, and prints which parts of the mesh and the example are not used.
fn read_target(
    args: &Args,
    mesh: &Path,
    product: Product,
    example: Option<&ExampleMesh>,
    context: &Context,
) -> Result<Model> {
    let mut model = input::model(mesh)?;
    model.tiles = squares(args, product, &model);
    announce(context, mesh, &model);
    if let Some(example) = example {
        announce(context, &args.exemplar, &example.model);
    }
    Ok(model)
}

/// Returns the UDIM tiles that each get a separate texture. Empty if the mesh gets a single texture, or a new atlas.
fn squares(args: &Args, product: Product, model: &Model) -> Vec<TileMaterial> {
    let takes_several = match product {
        Product::Texture => true,
        Product::Model(format) => format.material_place() == MaterialPlace::Beside,
        Product::Sites(_) => false,
    };
    let numbers = model.unit_squares();
    if args.surface.atlas() != AtlasName::Uv || !takes_several || numbers.len() < 2 {
        return Vec::new();
    }
    let tile = |number| TileMaterial {
        number,
        material: Material::default(),
    };
    numbers.into_iter().map(tile).collect()
}

/// Prints the parts of a mesh that are not used, unless the command is quiet.
pub(super) fn announce(context: &Context, path: &Path, model: &Model) {
    if let Some(line) = input::not_used(path, model).filter(|_| !context.quiet) {
        eprintln_if_possible(&line);
    }
}

/// Returns the options for the sites on the mesh. If the example is an image of `size` pixels, also returns a note on
/// how many times it repeats across the mesh.
fn sites(
    args: &Args,
    is_mesh: bool,
    surface: &Surface,
    size: [u32; 2],
) -> Result<(HierarchyOptions, Option<String>)> {
    if is_mesh {
        if args.surface.repeat.is_some() {
            let error = usage("--repeat takes an example that is an image, not a mesh");
            return Err(error.hint("--example-sites sets the size of its features"));
        }
        return Ok((args.surface.sites(&args.matching), None));
    }
    let sites = args.surface.sites_on(surface, size, &args.matching);
    let sites = sites.map_err(advise)?;
    let repeats = repeats_of_sites(surface, size, sites.n_sites);
    let note = format!(
        "{} sites: the example repeats about {repeats:.1} times across the mesh",
        sites.n_sites
    );
    Ok((sites, Some(note)))
}

/// Synthesizes a texture on the mesh, bakes it, and writes the output files.
pub(super) fn run(args: &Args, mesh: &Path, context: &Context) -> Result<Exit> {
    let mut job = Job::new(context, "synth", &args.image.files);
    let example = args.read_example_mesh()?;
    let output = output(args, mesh)?;
    let model = read_target(args, mesh, output.1, example.as_ref(), context)?;
    let claimed = claim(args, output, example.as_ref(), &model.tiles, &mut job)?;
    let input = match &example {
        Some(example) => args.read_with(example)?,
        None => args.read()?,
    };
    // Repair the mesh.
    let (repaired, repair) = model.mesh.repair();
    if !context.quiet && repair.before != repair.after {
        eprintln_if_possible(&format!("{}: repaired; see dapple info", mesh.display()));
    }
    let surface = Surface::new(repaired).with_context(|| mesh.display().to_string())?;
    // Check all options before charts are cut, which takes long.
    let size = input.layout.size_of(0);
    let (sites, note) = sites(args, example.is_some(), &surface, size)?;
    sites.check(&surface).map_err(advise)?;
    let directions = directions(args.surface.directions.as_deref())?;
    let layouts = match claimed.product {
        Product::Sites(_) => Layouts::default(),
        _ => Layouts::new(args, &surface, &model, &repair, context)?,
    };
    let shading = shading(args.surface.crease(), &surface, &model, &repair);
    let laid_out = layouts.report(&surface);
    // Make a transparent texture double-sided, because the inside of the mesh is visible through it.
    let double_sided = model.material.double_sided
        || repair.before.back_to_back_faces > 0
        || input.base.alpha.is_some();
    // Place the sites, and orient them.
    let spinner = Progress::spinner("scattering sites", context);
    let synthesizer = synthesizer(surface, args, &sites, &directions).map_err(advise)?;
    let synthesizer = scaled(synthesizer, args, &model, &repair)?;
    let exemplar = example.map(|example| exemplar_of_mesh(args, example, &input.exemplar));
    let exemplar = exemplar.transpose()?;
    drop(spinner);
    if let Some(note) = note.filter(|_| !context.quiet) {
        eprintln_if_possible(&note);
    }
    let columns = guide_columns(&input, &synthesizer, &model, &repair)?;
    let texture = grown(
        args,
        &input,
        &synthesizer,
        exemplar.as_ref(),
        &columns,
        context,
    )?;
    let spinner = Progress::spinner("baking", context);
    write(
        args,
        &claimed,
        &Covered {
            synthesizer,
            texture,
            layouts,
            shading,
            double_sided,
            input,
        },
        &mut job,
    )?;
    drop(spinner);
    let repaired = repair.before != repair.after;
    job.finish(
        args,
        json!({ "repaired": repaired, "double_sided": double_sided, "atlas": laid_out }),
    )?;
    Ok(Exit::Done)
}

/// Samples the guides at the sites of the mesh. The result has a column for each guide.
fn guide_columns(
    input: &Input,
    synthesizer: &Synthesizer,
    model: &Model,
    repair: &Repair,
) -> Result<Vec<Vec<f32>>> {
    let targets: Vec<_> = input.guides.iter().map(|guide| &guide.target).collect();
    guides::at_sites(&targets, synthesizer, model, repair)
}

/// Synthesizes the texture at the sites of the mesh. The example is an image, or a mesh if `exemplar` is given.
/// `columns` has the guide values at the sites, one column per guide.
fn grown(
    args: &Args,
    input: &Input,
    synthesizer: &Synthesizer,
    exemplar: Option<&MeshExemplar>,
    columns: &[Vec<f32>],
    context: &Context,
) -> Result<SurfaceTexture> {
    let progress = Progress::bar("synthesizing", STEPS.into(), context);
    let options = args.matching.options(&args.surface);
    let columns: Vec<_> = columns.iter().map(Vec::as_slice).collect();
    let callback = shown(&progress);
    let texture = match exemplar {
        Some(exemplar) => synthesizer.lift(exemplar, &columns, &options, callback),
        None => synthesizer.synthesize_guided(&input.exemplar, &columns, &options, callback),
    };
    texture.map_err(advise)
}

/// Returns statistics of an atlas as JSON, for the sidecar.
fn atlas_json(atlas: AtlasReport) -> serde_json::Value {
    json!({
        "pieces": atlas.pieces,
        "texels_used": atlas.used,
        "stretch": atlas.stretch,
    })
}

/// Builds an exemplar from a mesh, by placing sites on it and sampling its texture at them.
pub(super) fn exemplar_of_mesh(
    args: &Args,
    example: ExampleMesh,
    texture: &Exemplar,
) -> Result<MeshExemplar> {
    let directions = directions(args.surface.example_directions.as_deref())?;
    let sites = args.surface.example_sites(&args.matching);
    let source = Synthesizer::new(example.surface, &directions, &sites).map_err(advise)?;
    MeshExemplar::new(source, &example.uvs, texture).map_err(advise)
}

/// The atlases of the textures of a mesh.
#[derive(Default)]
pub(super) struct Layouts {
    /// The atlases of the texture: one per UDIM tile if there are `tiles`, otherwise one. Empty if the output is a mesh
    /// of sites.
    pub(super) atlases: Vec<Atlas>,
    /// The UDIM tiles that get a texture each, in the order of the atlases.
    tiles: Vec<TileMaterial>,
    /// The texture coordinates in the mesh file; `None` without `tiles`.
    own_uvs: Option<Vec<[DVec2; 3]>>,
}

impl From<Atlas> for Layouts {
    /// Creates the layout of a mesh with a single texture.
    fn from(atlas: Atlas) -> Self {
        Self {
            atlases: vec![atlas],
            ..Self::default()
        }
    }
}

impl Layouts {
    /// Builds the atlas of a single texture, or one atlas for each UDIM tile.
    fn new(
        args: &Args,
        surface: &Surface,
        model: &Model,
        repair: &Repair,
        context: &Context,
    ) -> Result<Self> {
        match model.tiles.is_empty() {
            true => Ok(Self::from(atlas(args, surface, model, repair, context)?)),
            false => Self::of_tiles(args, surface, model, repair),
        }
    }

    /// Builds one atlas for each UDIM tile, from the texture coordinates in the mesh file.
    fn of_tiles(args: &Args, surface: &Surface, model: &Model, repair: &Repair) -> Result<Self> {
        let numbers: Vec<_> = model.tiles.iter().map(|tile| tile.number).collect();
        let own_uvs = own_uvs(surface, model, repair)?;
        let n_tiles = numbers.len();
        let tiles = Tiles::new(numbers, &own_uvs)?;
        let (side, padding) = (args.surface.side(), args.surface.padding());
        let atlas = |tile| {
            let uvs = tiles.uvs_of(tile);
            Atlas::from_uvs(surface, &uvs, [side; 2], padding.unwrap_or(side)).map_err(advise)
        };
        Ok(Self {
            atlases: (0..n_tiles).map(atlas).collect::<Result<_>>()?,
            tiles: model.tiles.clone(),
            own_uvs: Some(own_uvs),
        })
    }

    /// Returns statistics of the atlases as JSON, for the sidecar: an object, or a list with one object per UDIM tile.
    fn report(&self, surface: &Surface) -> serde_json::Value {
        let reports = self.atlases.iter();
        let mut reports: Vec<_> = reports
            .map(|atlas| atlas_json(atlas.report(surface)))
            .collect();
        match reports.len() {
            0 | 1 => reports.pop().unwrap_or_default(),
            _ => reports.into(),
        }
    }
}

/// A mesh with its synthesized texture, before baking.
pub(super) struct Covered {
    pub(super) synthesizer: Synthesizer,
    pub(super) texture: SurfaceTexture,
    pub(super) layouts: Layouts,
    /// The normals at the corners of all faces.
    pub(super) shading: Vec<[DVec3; 3]>,
    /// Whether faces are visible from both sides.
    pub(super) double_sided: bool,
    pub(super) input: Input,
}

impl Product {
    /// Chooses the kind of output by the file extension of a target.
    pub(super) fn of(target: &Target) -> Result<Self> {
        let ending = match target {
            Target::Stdout if target.ending().is_empty() => DEFAULT_ENDING.to_owned(),
            _ => target.ending(),
        };
        if IMAGES.contains(&ending.as_str()) {
            return Ok(Self::Texture);
        }
        let mut formats = FORMATS.iter();
        match formats.find(|format| format.written_ending() == Some(&ending)) {
            Some(format) if format.material_place() == MaterialPlace::Nowhere => {
                Ok(Self::Sites(format))
            }
            Some(format) => Ok(Self::Model(format)),
            None => {
                let error = usage(format!("{target}: nothing is written as {ending:?}"));
                let endings: Vec<_> = writable_endings().chain(IMAGES).collect();
                Err(error.hint(format!("let the name end in .{}", endings.join(", ."))))
            }
        }
    }
}

/// Returns the help text that lists the kind of output for each file extension.
pub(super) fn endings() -> String {
    let mut text = "What the ending of the output gives for a mesh:".to_owned();
    for format in FORMATS {
        let what = match format.material_place() {
            MaterialPlace::Inside => "the mesh with its texture in one file",
            MaterialPlace::Beside => "the mesh, with its material and texture in files beside it",
            MaterialPlace::Nowhere if !format.has_colors() => {
                "the sites as a mesh alone, with --displace"
            }
            MaterialPlace::Nowhere => "the sites as a mesh, with a color for each and no texture",
        };
        if let Some(ending) = format.written_ending() {
            text += &format!("\n  .{ending:<11} {what}");
        }
    }
    text + "\n  .png, .exr   the texture alone"
}

impl Covered {
    /// Bakes the texture for the mesh that corresponds to a map of the example.
    pub(super) fn bake(&self, map: &Map, atlas: &Atlas) -> Result<Map> {
        let (synthesizer, texture) = (&self.synthesizer, &self.texture);
        Ok(match map {
            Map::Value(raster) => Map::Value(bake_values(synthesizer, texture, raster, atlas)?),
            Map::Color(raster) => Map::Color(bake_colors(synthesizer, texture, raster, atlas)?),
            Map::Normal(raster) => Map::Normal(bake_normals(
                synthesizer,
                texture,
                raster,
                NormalY::OpenGl,
                atlas,
                &self.shading,
            )?),
        })
    }

    /// Bakes the base texture, with its alpha if the example has alpha.
    pub(super) fn bake_base(&self, atlas: &Atlas) -> Result<(Map, Option<Raster<f32>>)> {
        let base = &self.input.base;
        let (Map::Color(colors), Some(alpha)) = (&base.map, &base.alpha) else {
            return Ok((self.bake(&base.map, atlas)?, None));
        };
        let pixels = colors.zip_map(alpha, |&color, &alpha| LinearRgba { color, alpha })?;
        let baked = bake_colors_alpha(&self.synthesizer, &self.texture, &pixels, atlas)?;
        let alpha = baked.map(|pixel| pixel.alpha);
        Ok((Map::Color(baked.map(|pixel| pixel.color)), Some(alpha)))
    }

    /// Returns the color of each site.
    fn site_colors(&self, args: &Args) -> Result<Vec<LinearRgba>> {
        let map = ramped(self.input.base.map.clone(), args.image.ramp.as_ref());
        let colors: Vec<_> = match &map {
            Map::Color(raster) => self.texture.transfer(raster)?,
            Map::Value(raster) => {
                let values = self.texture.transfer(raster)?;
                let color = |value| self.input.base.color_of(value);
                values.into_iter().map(color).collect()
            }
            Map::Normal(_) => bail!("normals are no colors"),
        };
        let Some(alpha) = &self.input.base.alpha else {
            return Ok(colors.into_iter().map(LinearRgba::opaque).collect());
        };
        let pixels = colors.into_iter().zip(self.texture.transfer(alpha)?);
        let pixel = |(color, alpha)| LinearRgba { color, alpha };
        Ok(pixels.map(pixel).collect())
    }
}

/// Returns the output path and the kind of output.
fn output(args: &Args, mesh: &Path) -> Result<(Target, Product)> {
    let ending = args.image.format.map_or(DEFAULT_ENDING, Format::ending);
    let target = args.target(mesh, ending)?;
    let product = Product::of(&target)?;
    Ok((target, product))
}

/// Checks the options against the kind of output, and claims the output, the files next to it, the maps and the
/// sidecar.
fn claim(
    args: &Args,
    (target, product): (Target, Product),
    example: Option<&ExampleMesh>,
    tiles: &[TileMaterial],
    job: &mut Job<'_>,
) -> Result<Claimed> {
    let format = match product {
        Product::Texture => Format::choose(args.image.format, &target, Format::Png16)?,
        _ => args.image.format.unwrap_or(Format::Png8),
    };
    let is_png = matches!(format, Format::Png8 | Format::Png16);
    if !is_png && !matches!(product, Product::Texture) {
        return Err(usage("textures of models are PNG").hint("add --format png8 or png16"));
    }
    if matches!(product, Product::Sites(_)) && args.detail.is_some() {
        return Err(usage("a mesh of sites shows no detail").hint("write .glb or .obj"));
    }
    let is_displaced = args.surface.displace.is_some();
    if let Product::Sites(format) = product
        && !format.has_colors()
        && !is_displaced
    {
        let error = usage(format!("{} holds no colors", format.name()));
        return Err(error.hint("add --displace LENGTH, or write .ply"));
    }
    if matches!(product, Product::Texture) && is_displaced {
        return Err(usage("--displace has no effect on an image").hint("write .glb, .obj or .ply"));
    }
    let is_used = |name: &str| {
        args.matching.weight_of(name) > 0.0 || is_displaced && is_of(name, MapKind::Height)
    };
    if matches!(product, Product::Sites(_)) && args.map.iter().any(|map| !is_used(&map.name)) {
        return Err(
            usage("a mesh of sites has colors and no further maps").hint("write .glb or .obj")
        );
    }
    let main = match product {
        Product::Texture => claim_tiles(&target, tiles, job)?,
        _ => vec![job.claim(&target)?],
    };
    let mut beside = Vec::new();
    if let (Product::Model(format), Some(path)) = (product, target.path()) {
        // Claim the files that the writer of the format will add, whose names follow from the stem.
        let has_normals = args.map.iter().any(|map| is_of(&map.name, MapKind::Normal))
            || example.is_some_and(|example| example.has(MapKind::Normal));
        for name in names_beside(format, path, has_normals, tiles)? {
            let output = job.claim(&Target::Path(path.with_file_name(&name)))?;
            beside.push((name, output));
        }
    }
    // Claim a separate file for each map, also for maps that are embedded in the model, for other programs.
    let mut maps = Vec::new();
    for name in args.map_names() {
        let target = target.part(name)?.with_ending(format.ending());
        let first = match tiles.first() {
            Some(tile) => target.tile(tile.number)?,
            None => target.clone(),
        };
        let file = first.path().and_then(Path::file_name);
        // The normal map of an OBJ file already has the name of the map.
        let is_beside = is_of(name, MapKind::Normal)
            && beside.iter().any(|(name, _)| file == Some(name.as_ref()));
        if !is_beside && !matches!(product, Product::Sites(_)) {
            maps.push(claim_tiles(&target, tiles, job)?);
        } else {
            maps.push(Vec::new());
        }
    }
    // Maps of the example's material are embedded only, without separate files.
    let n_maps = maps.len() + example.map_or(0, |example| example.maps.len());
    maps.resize_with(n_maps, Vec::new);
    job.claim_sidecar(&target)?;
    Ok(Claimed {
        product,
        stem: target.path().map(stem).unwrap_or_default(),
        main,
        beside,
        maps,
        format,
    })
}

/// Claims a file for each UDIM tile, or one file if the mesh has a single texture.
fn claim_tiles(
    target: &Target,
    tiles: &[TileMaterial],
    job: &mut Job<'_>,
) -> Result<Vec<OutputIdx>> {
    if tiles.is_empty() {
        return Ok(vec![job.claim(target)?]);
    }
    let tiles = tiles.iter();
    tiles
        .map(|tile| job.claim(&target.tile(tile.number)?))
        .collect()
}

/// Returns the names of the files that a format writes next to a mesh. They are found by writing an empty mesh with the
/// same textures.
fn names_beside(
    format: &MeshFormat,
    path: &Path,
    has_normals: bool,
    tiles: &[TileMaterial],
) -> Result<Vec<String>> {
    let mut model = Model::from(Mesh::default());
    let image = EncodedImage::new(PNG.to_vec())?;
    model.material.base_color = Some(image.clone());
    if has_normals {
        model.material.normal = Some(image);
    }
    model.tiles = tiles.to_vec();
    for tile in &mut model.tiles {
        tile.material = model.material.clone();
    }
    let mut files = format.write(&model, &stem(path))?;
    files.pop();
    Ok(files.into_iter().map(|file| file.name).collect())
}

/// Bakes the textures and writes all files.
fn write(args: &Args, claimed: &Claimed, covered: &Covered, job: &mut Job<'_>) -> Result<()> {
    if let Product::Sites(format) = claimed.product {
        let (synthesizer, texture) = (&covered.synthesizer, &covered.texture);
        let mut model = site_model(synthesizer, covered.site_colors(args)?)?;
        args.displace_sites(&mut model, synthesizer, texture, &covered.input)?;
        return write_model(format, claimed, &model, job);
    }
    // Bake the texture and the maps in each atlas.
    let is_deep = covered.input.base.is_deep;
    let mut models = Vec::new();
    for (at, atlas) in covered.layouts.atlases.iter().enumerate() {
        let (base, alpha) = covered.bake_base(atlas)?;
        let base = ramped(base, args.image.ramp.as_ref());
        let mut maps = MaterialMaps::default();
        for (outputs, (name, example)) in claimed.maps.iter().zip(&covered.input.maps) {
            let map = covered.bake(&example.map, atlas)?;
            if let Product::Model(_) = claimed.product {
                maps.add(name, &map, example, claimed.format)?;
            }
            if let Some(&output) = outputs.get(at) {
                job.write_image(output, map, example.is_deep, &args.image)?;
            }
        }
        if let Product::Model(_) = claimed.product {
            let mut model = model(args, covered, atlas, &base, alpha.as_ref())?;
            maps.put_into(&mut model.material, claimed.format)?;
            models.push(model);
            continue;
        }
        let cover = Cover::of(alpha.as_ref(), false, Clear::NOT_WRAPPED);
        job.write_with_alpha(claimed.main[at], base, cover, is_deep, &args.image)?;
    }
    // Combine the models of all UDIM tiles into one, displace it, and write it.
    let Product::Model(format) = claimed.product else {
        return Ok(());
    };
    let mut tiles = covered.layouts.tiles.clone();
    for (tile, model) in tiles.iter_mut().zip(&models) {
        tile.material = model.material.clone();
    }
    let mut model = models.swap_remove(0);
    model.tiles = tiles;
    if let Some(own_uvs) = &covered.layouts.own_uvs {
        model.uvs = Some(own_uvs.clone());
    }
    let (synthesizer, texture) = (&covered.synthesizer, &covered.texture);
    args.displace_mesh(&mut model, synthesizer, texture, &covered.input)?;
    write_model(format, claimed, &model, job)
}

/// Builds a model from the input mesh and its new textures. Gray textures are converted to colors, since models require
/// colors.
fn model(
    args: &Args,
    covered: &Covered,
    atlas: &Atlas,
    base: &Map,
    alpha: Option<&Raster<f32>>,
) -> Result<Model> {
    let example = &covered.input.base;
    let base = match base {
        Map::Value(values) => Map::Color(values.map(|&value| example.color_of(value))),
        other => other.clone(),
    };
    let default = default_format(&base, example.is_deep);
    let format = args.image.format.unwrap_or(default);
    let png = match (&base, alpha) {
        (Map::Color(colors), Some(alpha)) => {
            encode_with_alpha(colors, Cover::straight(alpha, Clear::NOT_WRAPPED), format)?
        }
        _ => encode(&base, format)?,
    };
    let mut model = textured_model(
        covered.synthesizer.surface(),
        atlas,
        covered.shading.clone(),
        EncodedImage::new(png)?,
    )?;
    model.material.double_sided = covered.double_sided;
    if let Some(alpha) = &example.alpha {
        model.material.alpha = alpha_mode(alpha);
    }
    Ok(model)
}

/// Writes the files of a model to their claimed outputs.
fn write_model(format: &MeshFormat, claimed: &Claimed, model: &Model, job: &Job<'_>) -> Result<()> {
    for file in format.write(model, &claimed.stem)? {
        let beside = claimed.beside.iter().find(|(name, _)| *name == file.name);
        let output = beside.map_or(claimed.main[0], |(_, output)| *output);
        job.write(output, &file.bytes)?;
    }
    Ok(())
}

fn stem(path: &Path) -> String {
    path.file_stem()
        .unwrap_or_default()
        .to_string_lossy()
        .into_owned()
}

/// Builds the atlas of the texture with the method given by `--atlas`.
fn atlas(
    args: &Args,
    surface: &Surface,
    model: &Model,
    repair: &Repair,
    context: &Context,
) -> Result<Atlas> {
    let (side, padding) = (args.surface.side(), args.surface.padding());
    let atlas = match (args.surface.atlas(), padding) {
        (AtlasName::Charts, padding) => {
            let progress = Progress::bar("cutting charts", STEPS.into(), context);
            Atlas::charts_with(surface, side, padding, |part| {
                progress.set((part * f64::from(STEPS)) as u64);
                ControlFlow::Continue(())
            })
        }
        (AtlasName::Area, None) => Atlas::by_area(surface, side),
        (AtlasName::Area, Some(padding)) => Atlas::by_area_padded(surface, side, padding),
        (AtlasName::Uniform, None) => Atlas::uniform(surface, side),
        (AtlasName::Uniform, Some(padding)) => Atlas::uniform_padded(surface, side, padding),
        (AtlasName::Uv, padding) => {
            let uvs = own_uvs(surface, model, repair)?;
            Atlas::from_uvs(surface, &uvs, [side; 2], padding.unwrap_or(side))
        }
    };
    atlas.map_err(advise)
}

/// Places sites on the surface, and computes their orientation field from the given directions.
fn synthesizer(
    surface: Surface,
    args: &Args,
    sites: &HierarchyOptions,
    directions: &[Direction],
) -> Result<Synthesizer, SynthError> {
    let hierarchy = Hierarchy::new(&surface, sites)?;
    let symmetry = args.surface.symmetry.unwrap_or_default();
    let axis = Orientation::AXIS;
    let orientation = Orientation::symmetric(&hierarchy, directions, axis, symmetry)?;
    Synthesizer::from_parts(surface, hierarchy, orientation, None)
}

/// Sets the scale at each site: from the image `--scale` or, with `--scales` alone, from the orientation field.
fn scaled(
    synthesizer: Synthesizer,
    args: &Args,
    model: &Model,
    repair: &Repair,
) -> Result<Synthesizer> {
    let scaled = match (args.read_scale()?, args.guides.scales) {
        (Some(scale), _) => {
            let mut columns = guides::at_sites(&[&scale], &synthesizer, model, repair)?;
            synthesizer.with_scales(columns.remove(0))
        }
        (None, Some(bounds)) => synthesizer.with_conformal_scales(bounds.0),
        (None, None) => return Ok(synthesizer),
    };
    scaled.map_err(advise)
}

/// Reads directions from a file in CSV or JSON. Returns an empty list without a file.
fn directions(path: Option<&Path>) -> Result<Vec<Direction>> {
    let Some(path) = path else {
        return Ok(Vec::new());
    };
    let text = input::text(path)?;
    let is_json = text.trim_start().starts_with(['[', '{']);
    let directions = if is_json {
        Direction::parse_json(&text)
    } else {
        Direction::parse_csv(&text)
    };
    let directions = directions.with_context(|| path.display().to_string())?;
    if directions.is_empty() {
        bail!("{} has no directions", path.display());
    }
    Ok(directions)
}
