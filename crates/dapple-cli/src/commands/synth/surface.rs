//! Synthesis on a mesh, and the files that it gives.

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

/// The kind of output of a textured mesh.
#[derive(Clone, Copy, Debug)]
pub(super) enum Product {
    /// The mesh with its texture.
    Model(&'static MeshFormat),
    /// The sites as a mesh, in a format without textures.
    Sites(&'static MeshFormat),
    /// The texture alone.
    Texture,
}

/// The first bytes of a PNG file.
const PNG: &[u8] = b"\x89PNG\r\n\x1a\n";
/// The endings of the names of images.
const IMAGES: [&str; 4] = ["png", "exr", "npy", "r16"];

/// The format of what has no name, in a stream or a folder.
const DEFAULT_ENDING: &str = "glb";

/// The outputs that were claimed.
struct Claimed {
    product: Product,
    /// The name of the output without its ending.
    stem: String,
    /// The output; the textures of unit squares, if it is one for each.
    main: Vec<OutputIdx>,
    /// The files beside that of the mesh, such as material and textures, with their names.
    beside: Vec<(String, OutputIdx)>,
    /// The files of each map, as many as layouts; none of those that are beside the mesh already.
    maps: Vec<Vec<OutputIdx>>,
    /// The format of textures that are files of their own.
    format: Format,
}

/// Reads the mesh, and says what of it and of the example is not used.
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

/// The unit squares of the mesh's own texture coordinates that get a texture each; none if there is one texture.
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

/// Says what of a mesh is not used, unless the command is quiet.
pub(super) fn announce(context: &Context, path: &Path, model: &Model) {
    if let Some(line) = input::not_used(path, model).filter(|_| !context.quiet) {
        eprintln_if_possible(&line);
    }
}

/// The sites for an example, and a note of the number of times that it repeats across the mesh, if it is an image of `size`
/// pixels and not a mesh.
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

/// Covers the mesh.
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
    let (repaired, repair) = model.mesh.repair();
    if !context.quiet && repair.before != repair.after {
        eprintln_if_possible(&format!("{}: repaired; see dapple info", mesh.display()));
    }
    let surface = Surface::new(repaired).with_context(|| mesh.display().to_string())?;
    // What is refused is refused before charts are cut, which takes long.
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
    // Through what is transparent the inside is seen.
    let double_sided = model.material.double_sided
        || repair.before.back_to_back_faces > 0
        || input.base.alpha.is_some();
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

/// The values of the guides at the sites of the mesh.
fn guide_columns(
    input: &Input,
    synthesizer: &Synthesizer,
    model: &Model,
    repair: &Repair,
) -> Result<Vec<Vec<f32>>> {
    let targets: Vec<_> = input.guides.iter().map(|guide| &guide.target).collect();
    guides::at_sites(&targets, synthesizer, model, repair)
}

/// Synthesizes the texture at the sites of the mesh, from a mesh if the example is one; `columns` are the guides.
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

/// The layout of a texture map, for the JSON file beside the output.
fn atlas_json(atlas: AtlasReport) -> serde_json::Value {
    json!({
        "pieces": atlas.pieces,
        "texels_used": atlas.used,
        "stretch": atlas.stretch,
    })
}

/// The sites of an example that is a mesh.
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

/// The layouts of the textures of a mesh.
#[derive(Default)]
pub(super) struct Layouts {
    /// The layout of the texture; one for each unit square if there are `tiles`, and none for a mesh of sites.
    pub(super) atlases: Vec<Atlas>,
    /// The unit squares that get a texture each, in the order of the layouts.
    tiles: Vec<TileMaterial>,
    /// The mesh's own texture coordinates, if there are `tiles`.
    own_uvs: Option<Vec<[DVec2; 3]>>,
}

impl From<Atlas> for Layouts {
    /// The layout of one texture.
    fn from(atlas: Atlas) -> Self {
        Self {
            atlases: vec![atlas],
            ..Self::default()
        }
    }
}

impl Layouts {
    /// The layout of one texture, or those of all unit squares that get one each.
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

    /// The layouts of unit squares: the mesh's own texture coordinates, in a texture for each.
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

    /// The layouts, for the JSON file beside the output: an object, or a list of one for each unit square.
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

/// A mesh with its texture, not baked yet.
pub(super) struct Covered {
    pub(super) synthesizer: Synthesizer,
    pub(super) texture: SurfaceTexture,
    pub(super) layouts: Layouts,
    /// The normals of the corners of all faces.
    pub(super) shading: Vec<[DVec3; 3]>,
    /// Whether faces are seen from both sides.
    pub(super) double_sided: bool,
    pub(super) input: Input,
}

impl Product {
    /// What the ending of an output asks for.
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

/// The part of the help that says what the ending of the output gives.
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
    /// A map of the example, as a texture of the mesh in a layout.
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

    /// The texture that is shown, and its alpha if the example has one.
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

    /// The colors of the sites.
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

/// The output, and its kind.
fn output(args: &Args, mesh: &Path) -> Result<(Target, Product)> {
    let ending = args.image.format.map_or(DEFAULT_ENDING, Format::ending);
    let target = args.target(mesh, ending)?;
    let product = Product::of(&target)?;
    Ok((target, product))
}

/// Claims the output, what belongs to it, and the maps.
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
        // The names of the files of the writer are known before: they have the stem of the model.
        let has_normals = args.map.iter().any(|map| is_of(&map.name, MapKind::Normal))
            || example.is_some_and(|example| example.has(MapKind::Normal));
        for name in names_beside(format, path, has_normals, tiles)? {
            let output = job.claim(&Target::Path(path.with_file_name(&name)))?;
            beside.push((name, output));
        }
    }
    // Those that go into the model are files of their own as well, for other programs.
    let mut maps = Vec::new();
    for name in args.map_names() {
        let target = target.part(name)?.with_ending(format.ending());
        let first = match tiles.first() {
            Some(tile) => target.tile(tile.number)?,
            None => target.clone(),
        };
        let file = first.path().and_then(Path::file_name);
        // The normals of an OBJ have the name of the map.
        let is_beside = is_of(name, MapKind::Normal)
            && beside.iter().any(|(name, _)| file == Some(name.as_ref()));
        if !is_beside && !matches!(product, Product::Sites(_)) {
            maps.push(claim_tiles(&target, tiles, job)?);
        } else {
            maps.push(Vec::new());
        }
    }
    // Those of the example's material go into the new one alone.
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

/// Claims a file for each unit square, or for the only texture.
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

/// The names of the files beside that of a mesh: those of an empty mesh with as many textures.
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

/// Bakes and writes everything.
fn write(args: &Args, claimed: &Claimed, covered: &Covered, job: &mut Job<'_>) -> Result<()> {
    if let Product::Sites(format) = claimed.product {
        let (synthesizer, texture) = (&covered.synthesizer, &covered.texture);
        let mut model = site_model(synthesizer, covered.site_colors(args)?)?;
        args.displace_sites(&mut model, synthesizer, texture, &covered.input)?;
        return write_model(format, claimed, &model, job);
    }
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

/// The input mesh with its texture. A gray one becomes a color, which is what models have.
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

/// The layout of the texture.
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

/// The surface with its sites and their directions.
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

/// The sites with pixels of the sizes that the user asked for.
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

/// The directions that the user gave.
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
