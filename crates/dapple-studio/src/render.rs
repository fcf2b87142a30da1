//! Drawing: a plan of the recipe, a draft, the maps, the node that is looked at, and thumbnails, the newest first.

use crate::message::{NodeTime, Output, Reply, Shape, View};
use crate::picture::{of_colors, of_values};
use crate::{Document, Graph, Picture, Shown, StudioError, rgba};
use dapple::color::LinearRgb;
use dapple::raster::Raster;
use dapple::recipe::{
    Bake, BakeOptions, Images, MapKind, Picture as Values, Plan, PlanCache, PlanLimits, Recipe,
    RecipeError, Region,
};
use std::sync::Arc;

/// The longest side of a picture, in pixels.
pub const MAX_SIDE: u32 = 4096;
/// The longest side of a tile of which a part is shown, in pixels.
pub(crate) const MAX_TILE: u32 = 1 << 16;
/// The longest and the shortest longer side of a draft, in pixels.
const DRAFT_SIDES: [u32; 2] = [256, 64];
/// The milliseconds for which a draft is fast enough, and those for which a larger one is, too.
const DRAFT_MS: [f64; 2] = [8.0, 2.5];
/// The longest side of a thumbnail, in pixels.
const THUMBNAIL_SIDE: u32 = 64;
/// The most thumbnails: their numbers end before those of recipes.
const MOST_THUMBNAILS: usize = 800;
/// The pixels that are drawn before it is asked again whether they are still wanted.
const BAND_PIXELS: u32 = 1 << 15;
/// The most pixels of a part of a map: a page draws all of its picture anew for each.
const SENT_PIXELS: usize = 1 << 20;
/// The milliseconds after which parts are sent that are smaller, and their fewest pixels: where a picture that is shown
/// smaller is divided shows a little, so that small ones never are.
const LATE: (f64, usize) = (100.0, 1 << 18);

/// The limits of work of a recipe in the studio.
pub(crate) const LIMITS: PlanLimits = PlanLimits {
    control_points: 1 << 18,
    wavelet_cells: 1 << 22,
    synthesized_pixels: 1 << 22,
    values: 1024,
    warps: 16,
    pixels: 1 << 27,
};

/// Something to be drawn.
#[derive(Clone, Debug)]
pub struct Job {
    /// Counts the states of the recipe and the view.
    pub generation: u32,
    /// The state of the text.
    pub rev: u64,
    /// The recipe.
    pub document: Arc<Document>,
    /// The pictures of it that the page shows.
    pub view: View,
}

/// A material in light, which the command draws.
#[derive(Clone, Copy, Debug)]
pub struct Lit<'a> {
    /// The recipe of the material.
    pub recipe: &'a Recipe,
    /// The images that the recipe names.
    pub images: &'a Images,
    /// The part of a loop that has passed, from 0 to 1.
    pub time: f64,
    /// The shape that the material is on.
    pub shape: Shape,
}

/// The surroundings of a renderer: images, a clock, and a receiver of what is drawn.
pub trait RenderHost {
    /// The images that a recipe names.
    ///
    /// # Errors
    ///
    /// If one of them cannot be had.
    fn images(&self, recipe: &Recipe) -> Result<Images, StudioError>;

    /// The picture of a lit material; by default there is none.
    ///
    /// # Errors
    ///
    /// If there is no such picture here, or the recipe is refused.
    fn preview(&self, lit: &Lit<'_>) -> Result<Raster<LinearRgb>, StudioError> {
        let _ = lit;
        Err(StudioError::new("lit previews cannot be drawn here"))
    }

    /// Milliseconds since some moment.
    fn now(&self) -> f64;

    /// Whether a job of this generation is still wanted.
    fn is_wanted(&self, generation: u32) -> bool;

    /// Takes a picture or a message.
    fn put(&self, output: Output);
}

/// Draws jobs, and keeps what the next one may need again.
#[derive(Debug)]
pub struct Renderer {
    pub(crate) memory: PlanCache,
    planned: Option<Planned>,
    /// The longest side of the next draft, in pixels.
    draft_side: u32,
    /// The last document that was reported to be without mistakes.
    told: Option<Arc<Document>>,
}

/// The most bytes of values of nodes that are kept.
const MEMORY: usize = 1 << 29;

impl Renderer {
    /// A renderer that keeps what it made in a memory, which others may use, too.
    #[must_use]
    pub fn new(memory: &PlanCache) -> Self {
        Self {
            memory: memory.clone(),
            planned: None,
            // The first picture is to be there soon, and nothing is known of the recipe yet.
            draft_side: DRAFT_SIDES[0] / 2,
            told: None,
        }
    }

    /// An empty memory for one or several renderers.
    #[must_use]
    pub fn memory() -> PlanCache {
        PlanCache::new(MEMORY)
    }
}

impl Default for Renderer {
    fn default() -> Self {
        Self::new(&Self::memory())
    }
}

/// The plan of a text at a time.
#[derive(Debug)]
struct Planned {
    document: Arc<Document>,
    time: f64,
    plan: Arc<Plan>,
    /// The images that it was made with.
    images: Images,
}

/// The reason why drawing ends early.
enum Stop {
    /// Something newer is wanted.
    Outdated,
    /// The recipe was refused.
    Refused(RecipeError),
    /// Something else was refused.
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
    /// Draws a job, as far as it is wanted.
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
        let mut pass = Pass {
            job,
            world,
            plan: &plan,
            start,
            draft_side: self.draft_side,
        };
        let drawn = pass.draw();
        self.draft_side = pass.draft_side;
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
        pass.thumbnails()?;
        let planned = self.planned.as_ref();
        planned.map_or(Ok(()), |planned| pass.preview(recipe, &planned.images))
    }

    /// The plan of a job.
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
            &self.memory,
        )?);
        let document = job.document.clone();
        self.planned = Some(Planned {
            document,
            time,
            plan: plan.clone(),
            images,
        });
        Ok(plan)
    }
}

/// Whether images are the very same, without a look at their pixels.
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

/// A plan within the limits of the studio.
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

/// One drawing of a job.
struct Pass<'a> {
    job: &'a Job,
    world: &'a dyn RenderHost,
    plan: &'a Plan,
    start: f64,
    draft_side: u32,
}

/// A region of a tile at a scale.
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
            // Some recipes have no smaller picture, such as those whose tiles have a whole number of pixels.
            match self.draw_frame(draft, true) {
                Ok(()) => self.choose_draft(),
                Err(Stop::Refused(_)) => {}
                Err(stop) => return Err(stop),
            }
        }
        self.draw_frame(frame, false)
    }

    /// Makes the next draft smaller if this one was slow, and larger if it was fast.
    fn choose_draft(&mut self) {
        let ms = self.world.now() - self.start;
        let ([slow, fast], [largest, smallest]) = (DRAFT_MS, DRAFT_SIDES);
        if ms > slow {
            self.draft_side = (self.draft_side / 2).max(smallest);
        } else if ms < fast {
            self.draft_side = (self.draft_side * 2).min(largest);
        }
    }

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

    fn draw_frame(&self, frame: Frame, is_draft: bool) -> Result<(), Stop> {
        let nodes = match &self.job.view.node {
            Some(node) => Some(vec![self.node(node, frame, is_draft)?]),
            None => {
                self.maps(frame, is_draft)?;
                None
            }
        };
        self.rendered(is_draft, nodes);
        Ok(())
    }

    fn maps(&self, frame: Frame, is_draft: bool) -> Result<(), Stop> {
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
        let mut sent = self.world.now();
        for band in Bake::new(self.plan, &options)? {
            // A draft that was begun is shown: else none would be while changes come faster than it is drawn.
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

    /// A small picture of each node.
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
            // A node that cannot be seen on its own has no thumbnail.
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

    /// Draws the material in light, with the exact renderer.
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
    /// The largest smaller picture that is a draft and whose pixels begin where those of this one do.
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

/// The maps of these names, each once.
///
/// # Errors
///
/// If there is no map of one of the names.
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

/// The size of a picture of a tile whose longer side has so many pixels.
pub(crate) fn size_of(extent: [f64; 2], longest: u32) -> [u32; 2] {
    let longer = extent[0].max(extent[1]);
    extent.map(|side| (side / longer * f64::from(longest)).round().max(1.0) as u32)
}
