//! Renders jobs. A job builds the recipe's plan, then renders a draft, the maps or a node, the thumbnails, and the lit
//! preview.

use crate::message::{NodeTime, Output, Reply, Shape, View};
use crate::picture::{of_colors, of_values};
use crate::{Document, Graph, Picture, Shown, StudioError, rgba};
use dapple::color::LinearRgb;
use dapple::raster::Raster;
use dapple::recipe::{
    Bake, BakeOptions, Images, MapKind, Picture as Values, Plan, PlanCache, PlanLimits, Recipe,
    RecipeError, RecipeErrorKind, Region, RendererError,
};
use std::sync::Arc;

/// Maximum side of an image, in pixels.
pub const MAX_SIDE: u32 = 4096;
/// Maximum side of a tile that is shown in part, in pixels.
pub(crate) const MAX_TILE: u32 = 1 << 16;
/// Maximum and minimum of the longer side of a draft, in pixels.
const DRAFT_SIDES: [u32; 2] = [256, 64];
/// Thresholds for a draft's rendering time, in milliseconds. Above the first, the size of the next draft is halved;
/// below the second, it is doubled.
const DRAFT_MS: [f64; 2] = [8.0, 2.5];
/// Maximum side of a thumbnail, in pixels.
const THUMBNAIL_SIDE: u32 = 64;
/// Maximum number of node thumbnails, which limits their codes to those below the codes of recipes.
const MOST_THUMBNAILS: usize = 800;
/// Pixels per band. Rendering checks between bands whether the job has been superseded.
const BAND_PIXELS: u32 = 1 << 15;
/// Number of pixels in each part of a map that is sent. Parts are large because the page redraws its whole image for
/// each.
const SENT_PIXELS: usize = 1 << 20;
/// Time in milliseconds after which smaller parts are sent, and the number of pixels in such a part. If a page scales
/// an image down, the boundaries between parts are slightly visible. For this reason, small images are never divided.
const LATE: (f64, usize) = (100.0, 1 << 18);

/// Work limits of a recipe in the studio.
pub(crate) const LIMITS: PlanLimits = PlanLimits {
    control_points: 1 << 18,
    wavelet_cells: 1 << 22,
    synthesized_pixels: 1 << 22,
    values: 1024,
    warps: 16,
    pixels: 1 << 27,
};

/// A rendering job.
#[derive(Clone, Debug)]
pub struct Job {
    /// The generation, which counts the states of recipe and view.
    pub generation: u32,
    /// Revision of the text.
    pub rev: u64,
    /// The document to render.
    pub document: Arc<Document>,
    /// The images that the page shows.
    pub view: View,
}

/// A lit preview to be rendered by the host.
#[derive(Clone, Copy, Debug)]
pub struct Lit<'a> {
    /// The recipe of the material.
    pub recipe: &'a Recipe,
    /// The images that the recipe names.
    pub images: &'a Images,
    /// Phase of the looping animation, from 0 to 1.
    pub time: f64,
    /// The shape that carries the material.
    pub shape: Shape,
}

/// The host of a renderer. It supplies images and a clock, and receives the output.
pub trait RenderHost {
    /// Loads the images that a recipe names.
    ///
    /// # Errors
    ///
    /// If an image cannot be loaded.
    fn images(&self, recipe: &Recipe) -> Result<Images, StudioError>;

    /// Renders the preview of a lit material. By default, previews are not supported.
    ///
    /// # Errors
    ///
    /// If previews are not supported, or the recipe is refused.
    fn preview(&self, lit: &Lit<'_>) -> Result<Raster<LinearRgb>, StudioError> {
        let _ = lit;
        Err(StudioError::new("lit previews cannot be drawn here"))
    }

    /// Returns the plan of a recipe with all nodes on a GPU, with the same bits. By default and without a GPU, maps are
    /// rendered on the CPU.
    fn on_gpu(&self, recipe: &Recipe, plan: &Plan) -> Option<Plan> {
        let _ = (recipe, plan);
        None
    }

    /// Receives the error of a plan [on the GPU](Self::on_gpu). The renderer uses the CPU instead.
    fn gpu_failed(&self, error: &RendererError) {
        let _ = error;
    }

    /// Returns the milliseconds since an arbitrary moment.
    fn now(&self) -> f64;

    /// Returns whether a job of this generation is still current.
    fn is_wanted(&self, generation: u32) -> bool;

    /// Receives an image or a message.
    fn put(&self, output: Output);
}

/// Renders jobs and caches values for the next ones.
#[derive(Debug)]
pub struct Renderer {
    pub(crate) cache: PlanCache,
    planned: Option<Planned>,
    /// The longer side of the next draft, in pixels.
    draft_side: u32,
    /// The last document that was reported to the page as valid.
    told: Option<Arc<Document>>,
}

/// Maximum size of the cached node values, in bytes.
const MEMORY: usize = 1 << 29;

impl Renderer {
    /// Creates a renderer with a cache, which other renderers may share.
    #[must_use]
    pub fn new(cache: &PlanCache) -> Self {
        Self {
            cache: cache.clone(),
            planned: None,
            // The first draft should appear soon, and the cost of the recipe is not known yet.
            draft_side: DRAFT_SIDES[0] / 2,
            told: None,
        }
    }

    /// Creates an empty cache for one or more renderers.
    #[must_use]
    pub fn cache() -> PlanCache {
        PlanCache::new(MEMORY)
    }
}

impl Default for Renderer {
    fn default() -> Self {
        Self::new(&Self::cache())
    }
}

/// A cached plan with the document, phase and images from which it was built.
#[derive(Debug)]
struct Planned {
    document: Arc<Document>,
    time: f64,
    plan: Arc<Plan>,
    /// The plan with all nodes on a GPU.
    on_gpu: Option<Plan>,
    /// The images that the plan was built with.
    images: Images,
}

/// The reason why rendering ends early.
enum Stop {
    /// A newer job supersedes this one.
    Outdated,
    /// The recipe was refused.
    Refused(RecipeError),
    /// Something else failed, such as loading an image.
    Other(StudioError),
}

impl From<RecipeError> for Stop {
    fn from(error: RecipeError) -> Self {
        Self::Refused(error)
    }
}

impl From<StudioError> for Stop {
    fn from(error: StudioError) -> Self {
        Self::Other(error)
    }
}

impl Renderer {
    /// Renders a job. Returns early if a newer job supersedes it.
    pub fn draw(&mut self, job: &Job, world: &dyn RenderHost) {
        let Ok(recipe) = job.document.recipe() else {
            return;
        };
        match self.draw_all(job, recipe, world) {
            Ok(()) | Err(Stop::Outdated) => {}
            Err(Stop::Refused(error)) => {
                let items = vec![job.document.diagnostic(&error)];
                world.put(
                    Reply::Diagnostics {
                        rev: job.rev,
                        items,
                    }
                    .into(),
                );
            }
            Err(Stop::Other(error)) => world.put(Reply::refused("view", &error).into()),
        }
    }

    fn draw_all(&mut self, job: &Job, recipe: &Recipe, world: &dyn RenderHost) -> Result<(), Stop> {
        let start = world.now();
        let plan = match self.plan(job, recipe, world) {
            Ok(plan) => plan,
            Err(error) => {
                self.told = None;
                put_graph(job, None, world);
                return Err(error);
            }
        };
        // Render the draft and the full images.
        let mut pass = Pass {
            job,
            world,
            plan: &plan,
            on_gpu: self
                .planned
                .as_ref()
                .and_then(|planned| planned.on_gpu.as_ref()),
            start,
            draft_side: self.draft_side,
        };
        let drawn = pass.draw();
        self.draft_side = pass.draft_side;
        // Send the graph and the empty list of errors once per document.
        let is_told = |told: &Arc<Document>| Arc::ptr_eq(told, &job.document);
        let is_new = !self.told.as_ref().is_some_and(is_told);
        if is_new {
            put_graph(job, Some(&plan), world);
        }
        drawn?;
        if is_new {
            self.told = Some(job.document.clone());
            let (rev, items) = (job.rev, Vec::new());
            world.put(Reply::Diagnostics { rev, items }.into());
        }
        // Render the thumbnails and the lit preview last.
        pass.thumbnails()?;
        let planned = self.planned.as_ref();
        planned.map_or(Ok(()), |planned| pass.preview(recipe, &planned.images))
    }

    /// Returns the plan of a job. It is the cached plan if document, phase and images are unchanged.
    fn plan(
        &mut self,
        job: &Job,
        recipe: &Recipe,
        world: &dyn RenderHost,
    ) -> Result<Arc<Plan>, Stop> {
        let time = job.view.time;
        let images = world.images(recipe)?;
        if let Some(planned) = &self.planned
            && planned.time == time
            && Arc::ptr_eq(&planned.document, &job.document)
            && is_same(&planned.images, &images)
        {
            return Ok(planned.plan.clone());
        }
        self.planned = None;
        let plan = Arc::new(Plan::new_with_cache(
            recipe,
            &images,
            time,
            &LIMITS,
            &self.cache,
        )?);
        let document = job.document.clone();
        self.planned = Some(Planned {
            document,
            time,
            on_gpu: world.on_gpu(recipe, &plan),
            plan: plan.clone(),
            images,
        });
        Ok(plan)
    }
}

/// Returns whether two sets of images share the same pixel data in memory.
fn is_same(a: &Images, b: &Images) -> bool {
    let is_same = |a: &Values, b: &Values| match (a, b) {
        (Values::Numbers(a), Values::Numbers(b)) => Arc::ptr_eq(a, b),
        (Values::Colors(a), Values::Colors(b)) => Arc::ptr_eq(a, b),
        _ => false,
    };
    a.len() == b.len()
        && a.iter()
            .zip(b)
            .all(|((a, of_a), (b, of_b))| a == b && is_same(of_a, of_b))
}

/// Creates a plan within the limits of the studio.
pub(crate) fn planned(recipe: &Recipe, images: &Images, time: f64) -> Result<Plan, RecipeError> {
    Plan::new_within(recipe, images, time, &LIMITS)
}

/// Sends the graph of a job.
fn put_graph(job: &Job, plan: Option<&Plan>, world: &dyn RenderHost) {
    if let Some(graph) = Graph::new(&job.document, plan) {
        world.put(
            Reply::Graph {
                rev: job.rev,
                graph,
            }
            .into(),
        );
    }
}

/// The rendering of one job.
struct Pass<'a> {
    job: &'a Job,
    world: &'a dyn RenderHost,
    plan: &'a Plan,
    /// The plan for the maps, until the GPU fails.
    on_gpu: Option<&'a Plan>,
    start: f64,
    draft_side: u32,
}

/// A region of a tile at a reduced scale.
#[derive(Clone, Copy)]
struct Frame {
    size: [u32; 2],
    region: Region,
    scale: u32,
}

impl Pass<'_> {
    fn draw(&mut self) -> Result<(), Stop> {
        let view = &self.job.view;
        if view.paused {
            return Ok(());
        }
        let frame = self.frame()?;
        self.world.put(
            Reply::Began {
                generation: self.job.generation,
                size: view.size,
                region: view.region,
                node: view.node.clone(),
                time: view.time,
                draft: view.draft,
            }
            .into(),
        );
        let draft = frame.draft(self.draft_side).filter(|_| view.draft);
        if let Some(draft) = draft {
            // Some recipes cannot be rendered at a smaller size, for example if their tiles need a whole number of
            // pixels. Skip their draft.
            match self.draw_frame(draft, true) {
                Ok(()) => self.choose_draft(),
                Err(Stop::Refused(_)) => {}
                Err(stop) => return Err(stop),
            }
        }
        self.draw_frame(frame, false)
    }

    /// Chooses the size of the next draft from the time that this draft took.
    fn choose_draft(&mut self) {
        let ms = self.world.now() - self.start;
        let ([slow, fast], [largest, smallest]) = (DRAFT_MS, DRAFT_SIDES);
        if ms > slow {
            self.draft_side = (self.draft_side / 2).max(smallest);
        } else if ms < fast {
            self.draft_side = (self.draft_side * 2).min(largest);
        }
    }

    /// Validates the view and returns its frame at full size.
    fn frame(&self) -> Result<Frame, StudioError> {
        let view = &self.job.view;
        let size = view.size;
        let all = Region {
            first: [0; 2],
            size,
        };
        let region = view.region.map_or(all, |area| Region {
            first: area.first,
            size: area.size,
        });
        if region.size.iter().any(|&side| side == 0 || side > MAX_SIDE) {
            return Err(StudioError::new(format!(
                "a side of a picture is from 1 to {MAX_SIDE} pixels"
            )));
        }
        if size.iter().any(|&side| side > MAX_TILE) {
            return Err(StudioError::new(format!(
                "a side of the tile is at most {MAX_TILE} pixels"
            )));
        }
        let is_within = |axis: usize| {
            let end = u64::from(region.first[axis]) + u64::from(region.size[axis]);
            end <= size[axis].into()
        };
        if !(is_within(0) && is_within(1)) {
            return Err(StudioError::new("the region is not within the tile"));
        }
        Ok(Frame {
            size,
            region,
            scale: 1,
        })
    }

    fn draw_frame(&mut self, frame: Frame, is_draft: bool) -> Result<(), Stop> {
        let nodes = match &self.job.view.node {
            Some(node) => Some(vec![self.node(node, frame, is_draft)?]),
            None => {
                self.maps_on_any(frame, is_draft)?;
                None
            }
        };
        self.rendered(is_draft, nodes);
        Ok(())
    }

    /// Renders the maps on the GPU. Without a GPU, and after it fails, the CPU renders them. The bytes are the same, so parts may
    /// be sent twice.
    fn maps_on_any(&mut self, frame: Frame, is_draft: bool) -> Result<(), Stop> {
        if let Some(plan) = self.on_gpu {
            match self.maps(plan, frame, is_draft) {
                Err(Stop::Refused(error)) => match error.kind() {
                    RecipeErrorKind::Renderer(error) => self.world.gpu_failed(error),
                    _ => return Err(Stop::Refused(error)),
                },
                drawn => return drawn,
            }
            self.on_gpu = None;
        }
        self.maps(self.plan, frame, is_draft)
    }

    fn maps(&self, plan: &Plan, frame: Frame, is_draft: bool) -> Result<(), Stop> {
        let options = BakeOptions {
            size: frame.size,
            region: Some(frame.region),
            maps: map_kinds(&self.job.view.maps)?,
            band_pixels: BAND_PIXELS,
            ..BakeOptions::default()
        };
        if options.maps.is_empty() {
            return Ok(());
        }
        self.check_wanted()?;
        let rows = frame.region.size[1];
        let mut parts: Vec<_> = options.maps.iter().map(|_| (0, Vec::new())).collect();
        // Rows accumulate for each map until a part is large enough to send.
        let mut sent = self.world.now();
        for band in Bake::new(plan, &options)? {
            // A draft that has begun is finished. Otherwise no image would appear while changes arrive faster than
            // drafts.
            if !is_draft {
                self.check_wanted()?;
            }
            let band = band?;
            let now = self.world.now();
            let (late_ms, late_pixels) = LATE;
            let is_late = now - sent > late_ms;
            let most = 4 * if is_late { late_pixels } else { SENT_PIXELS };
            for ((kind, map), (first_row, pixels)) in band.maps.iter().zip(&mut parts) {
                pixels.extend(rgba(map));
                let [width, height] = map.size();
                let end = band.first_row + height;
                if pixels.len() < most && end < rows {
                    continue;
                }
                sent = now;
                let [left, top] = frame.region.first;
                self.world.put(Output::Picture(Picture {
                    generation: self.job.generation,
                    shown: Shown::Map(*kind),
                    first: [left, top + *first_row],
                    size: [width, end - *first_row],
                    scale: frame.scale as u16,
                    is_draft,
                    is_last: end == rows,
                    pixels: core::mem::take(pixels),
                }));
                *first_row = end;
            }
        }
        Ok(())
    }

    fn node(&self, node: &str, frame: Frame, is_draft: bool) -> Result<NodeTime, Stop> {
        self.check_wanted()?;
        let start = self.world.now();
        let values = self
            .plan
            .node_picture(node, frame.size, Some(frame.region))?;
        let (pixels, range) = of_values(&values);
        self.world.put(Output::Picture(Picture {
            generation: self.job.generation,
            first: frame.region.first,
            scale: frame.scale as u16,
            is_draft,
            ..Picture::whole(Shown::Node, frame.region.size, pixels)
        }));
        Ok(NodeTime {
            name: node.to_owned(),
            ms: self.world.now() - start,
            range,
        })
    }

    /// Renders a thumbnail of each node.
    fn thumbnails(&self) -> Result<(), Stop> {
        let view = &self.job.view;
        if !view.thumbnails || view.paused {
            return Ok(());
        }
        let Some(graph) = Graph::new(&self.job.document, None) else {
            return Ok(());
        };
        let names: Vec<_> = graph.names().collect();
        let size = size_of(self.plan.extent().to_array(), THUMBNAIL_SIDE);
        let mut times = Vec::new();
        for node in self.plan.node_names() {
            self.check_wanted()?;
            let start = self.world.now();
            // Skip nodes that cannot be rendered on their own.
            let Ok(values) = self.plan.node_picture(node, size, None) else {
                continue;
            };
            let ms = self.world.now() - start;
            let (pixels, range) = of_values(&values);
            let Some(index) = names.iter().position(|name| *name == node) else {
                continue;
            };
            if index >= MOST_THUMBNAILS {
                continue;
            }
            times.push(NodeTime {
                name: node.to_owned(),
                ms,
                range,
            });
            let shown = Shown::Thumbnail(u16::try_from(index).unwrap_or(u16::MAX));
            self.world.put(Output::Picture(Picture {
                generation: self.job.generation,
                ..Picture::whole(shown, size, pixels)
            }));
        }
        self.rendered(false, Some(times));
        Ok(())
    }

    /// Renders the lit preview with the host's CPU renderer.
    fn preview(&self, recipe: &Recipe, images: &Images) -> Result<(), Stop> {
        let view = &self.job.view;
        let Some(exact) = view.exact.as_ref().filter(|_| !view.paused) else {
            return Ok(());
        };
        self.check_wanted()?;
        let picture = self.world.preview(&Lit {
            recipe,
            images,
            time: view.time,
            shape: exact.shape,
        })?;
        self.world.put(Output::Picture(Picture {
            generation: self.job.generation,
            ..Picture::whole(Shown::Preview, picture.size(), of_colors(&picture))
        }));
        Ok(())
    }

    fn rendered(&self, draft: bool, nodes: Option<Vec<NodeTime>>) {
        let Job {
            generation, rev, ..
        } = *self.job;
        let ms = self.world.now() - self.start;
        self.world.put(
            Reply::Rendered {
                generation,
                rev,
                ms,
                draft,
                nodes,
            }
            .into(),
        );
    }

    fn check_wanted(&self) -> Result<(), Stop> {
        if self.world.is_wanted(self.job.generation) {
            Ok(())
        } else {
            Err(Stop::Outdated)
        }
    }
}

impl Frame {
    /// Returns the frame of a draft whose longer side has at most `side` pixels. The scale is the smallest power of two
    /// from 2 to 64 that divides all sizes and offsets, so that pixels of both frames are aligned. Returns `None`
    /// without such a scale, or if the frame is small enough already.
    fn draft(self, side: u32) -> Option<Self> {
        let longest = self.region.size[0].max(self.region.size[1]);
        let numbers = [self.size, self.region.first, self.region.size].concat();
        let scales = (1..=6).map(|power| 1_u32 << power);
        let fits = |scale: &u32| numbers.iter().all(|number| number % scale == 0);
        let mut scales = scales.filter(|scale| longest / scale <= side).filter(fits);
        let scale = scales.next().filter(|_| longest > side)?;
        let smaller = |numbers: [u32; 2]| numbers.map(|number| number / scale);
        Some(Self {
            size: smaller(self.size),
            region: Region {
                first: smaller(self.region.first),
                size: smaller(self.region.size),
            },
            scale,
        })
    }
}

/// Parses names of maps and removes duplicates.
///
/// # Errors
///
/// If a name is unknown.
pub fn map_kinds(names: &[String]) -> Result<Vec<MapKind>, StudioError> {
    let mut kinds = Vec::new();
    for name in names {
        let kind = MapKind::from_name(name);
        let kind = kind.ok_or_else(|| StudioError::new(format!("there is no map `{name}`")))?;
        if !kinds.contains(&kind) {
            kinds.push(kind);
        }
    }
    Ok(kinds)
}

/// Returns the size, in pixels, of an image of a tile. Its longer side has `longest` pixels.
pub(crate) fn size_of(extent: [f64; 2], longest: u32) -> [u32; 2] {
    let longer = extent[0].max(extent[1]);
    extent.map(|side| (side / longer * f64::from(longest)).round().max(1.0) as u32)
}
