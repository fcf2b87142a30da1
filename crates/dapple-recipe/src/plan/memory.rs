//! What plans have made, for later plans of recipes that are like theirs.
//!
//! A step is known by a description of all that its values follow from: its node, the tile, the seed, the time, and the
//! steps that it is made of. Where a later plan has a step with the same description, its fields need not be made again,
//! nor its values at the same pixels. The bits are those of a plan without a memory.

use super::{Picture, Step};
use crate::Values;
use dapple_color::LinearRgb;
use dapple_pups::VectorTexture;
use dapple_raster::{Field, Window};
use std::collections::{BTreeMap, BTreeSet};
use std::fmt;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

/// What plans have made, for later plans: see [`Plan::new_with_memory`](super::Plan::new_with_memory).
///
/// Copies of a memory are the same memory.
#[derive(Clone)]
pub struct Memory {
    kept: Arc<Mutex<Kept>>,
    max_bytes: usize,
}

/// The number of a description. It is never given to another one.
pub(crate) type StepId = u64;

/// The pixels of a window, as they can be compared.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
struct Pixels {
    origin: [u64; 2],
    pixel: [u64; 2],
    first: [i64; 2],
    size: [u32; 2],
    scale: [u64; 2],
}

#[derive(Default)]
struct Kept {
    next: StepId,
    ids: BTreeMap<String, StepId>,
    /// The bytes of all descriptions.
    id_bytes: usize,
    /// What changes with time.
    timed: BTreeSet<StepId>,
    /// Steps that are made of no other, with the plan that used each last.
    sources: BTreeMap<StepId, (Source, u64)>,
    n_plans: u64,
    values: BTreeMap<(StepId, Pixels), (Arc<Values>, u64)>,
    /// What was used when, from the longest ago on.
    uses: BTreeMap<u64, (StepId, Pixels)>,
    n_uses: u64,
    bytes: usize,
    pictures: Vec<Picture>,
}

/// A step that is made of no other.
enum Source {
    Field(Arc<dyn Field>),
    Colors(Arc<VectorTexture<3>>),
}

/// The most bytes of descriptions; past that, all is forgotten.
const MAX_ID_BYTES: usize = 1 << 26;
/// How many plans ago a step that is made of no other was used at most. It may be a texture with many points.
const MAX_AGE: u64 = 4;
/// The most images that are known again.
const MAX_PICTURES: usize = 64;

impl Memory {
    /// A memory that keeps values of at most so many bytes.
    #[must_use]
    pub fn new(max_bytes: usize) -> Self {
        Self {
            kept: Arc::default(),
            max_bytes,
        }
    }

    /// The bytes of the values that are kept.
    #[must_use]
    pub fn bytes(&self) -> usize {
        self.lock().bytes
    }

    /// Whether the values of a number of steps at a window may be kept without forgetting most others.
    pub(super) fn has_room(&self, steps: usize, window: &Window) -> bool {
        let bytes = steps
            .saturating_mul(window.n_pixels())
            .saturating_mul(size_of::<LinearRgb>());
        bytes <= self.max_bytes / 2
    }

    /// Begins a plan, and forgets the textures that the last ones did not use.
    pub(super) fn begin(&self) {
        let mut kept = self.lock();
        kept.n_plans += 1;
        let now = kept.n_plans;
        kept.sources.retain(|_, (_, used)| *used + MAX_AGE >= now);
    }

    /// The number of a description.
    pub(super) fn id(&self, description: String) -> StepId {
        let mut kept = self.lock();
        if let Some(&id) = kept.ids.get(&description) {
            return id;
        }
        if kept.id_bytes + description.len() > MAX_ID_BYTES {
            kept.forget_all();
        }
        kept.id_bytes += description.len();
        let id = kept.next;
        kept.next += 1;
        kept.ids.insert(description, id);
        id
    }

    /// Whether what has this number has changed with time so far.
    pub(super) fn is_timed(&self, id: StepId) -> bool {
        self.lock().timed.contains(&id)
    }

    /// The number of what changes with time, at a time.
    pub(super) fn at_time(&self, id: StepId, time: f64) -> StepId {
        self.lock().timed.insert(id);
        self.id(format!("{id} at {}", time.to_bits()))
    }

    /// A number that no description has.
    pub(super) fn new_id(&self) -> StepId {
        let mut kept = self.lock();
        kept.next += 1;
        kept.next - 1
    }

    /// A number for an image, the same for the very same pixels in memory.
    pub(super) fn picture_id(&self, picture: &Picture) -> usize {
        let mut kept = self.lock();
        if kept.pictures.len() >= MAX_PICTURES {
            kept.forget_all();
        }
        // What is kept cannot be replaced by others at the same place in memory.
        let is_it = |other: &Picture| match (other, picture) {
            (Picture::Numbers(a), Picture::Numbers(b)) => Arc::ptr_eq(a, b),
            (Picture::Colors(a), Picture::Colors(b)) => Arc::ptr_eq(a, b),
            _ => false,
        };
        let known = kept.pictures.iter().position(is_it);
        known.unwrap_or_else(|| {
            kept.pictures.push(picture.clone());
            kept.pictures.len() - 1
        })
    }

    /// A step that was made before and is made of no other.
    pub(super) fn source(&self, id: StepId) -> Option<Step> {
        let mut kept = self.lock();
        let now = kept.n_plans;
        let (source, used) = kept.sources.get_mut(&id)?;
        *used = now;
        Some(match source {
            Source::Field(field) => Step::Field(field.clone()),
            Source::Colors(colors) => Step::Colors(colors.clone()),
        })
    }

    /// Keeps a step if it is made of no other.
    pub(super) fn keep_source(&self, id: StepId, step: &Step) {
        let source = match step {
            Step::Field(field) => Source::Field(field.clone()),
            Step::Colors(colors) => Source::Colors(colors.clone()),
            _ => return,
        };
        let mut kept = self.lock();
        let now = kept.n_plans;
        kept.sources.insert(id, (source, now));
    }

    /// The values of a step at the pixels of a window.
    pub(super) fn values(&self, id: StepId, window: &Window) -> Option<Arc<Values>> {
        let mut kept = self.lock();
        let key = (id, Pixels::of(window));
        let (values, used) = kept.values.get(&key)?;
        let (values, used) = (values.clone(), *used);
        kept.uses.remove(&used);
        let now = kept.note_use(key);
        if let Some(entry) = kept.values.get_mut(&key) {
            entry.1 = now;
        }
        Some(values)
    }

    /// Keeps the values of a step at the pixels of a window, and forgets what was not used for the longest time.
    pub(super) fn keep(&self, id: StepId, window: &Window, values: Arc<Values>) {
        let mut kept = self.lock();
        let key = (id, Pixels::of(window));
        kept.forget(key);
        kept.bytes += values.bytes();
        let now = kept.note_use(key);
        kept.values.insert(key, (values, now));
        while kept.bytes > self.max_bytes
            && let Some((_, oldest)) = kept.uses.pop_first()
        {
            kept.forget(oldest);
        }
    }

    fn lock(&self) -> MutexGuard<'_, Kept> {
        self.kept.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl fmt::Debug for Memory {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let kept = self.lock();
        f.debug_struct("Memory")
            .field("values", &kept.values.len())
            .field("bytes", &kept.bytes)
            .finish()
    }
}

impl Kept {
    /// Begins anew. Numbers go on, so that plans that are still there are not mistaken for others.
    fn forget_all(&mut self) {
        *self = Self {
            next: self.next,
            n_plans: self.n_plans,
            ..Self::default()
        };
    }

    fn note_use(&mut self, key: (StepId, Pixels)) -> u64 {
        self.n_uses += 1;
        self.uses.insert(self.n_uses, key);
        self.n_uses
    }

    fn forget(&mut self, key: (StepId, Pixels)) {
        if let Some((values, used)) = self.values.remove(&key) {
            self.uses.remove(&used);
            self.bytes -= values.bytes();
        }
    }
}

impl Pixels {
    fn of(window: &Window) -> Self {
        let bits = |vector: glam::DVec2| vector.to_array().map(f64::to_bits);
        Self {
            origin: bits(window.origin),
            pixel: bits(window.pixel),
            first: window.first,
            size: window.size,
            scale: bits(window.scale),
        }
    }
}

impl Values {
    /// How much memory they take.
    fn bytes(&self) -> usize {
        match self {
            Self::Numbers(numbers) => size_of_val(&numbers[..]),
            Self::Colors(colors) => size_of_val(&colors[..]),
        }
    }
}
