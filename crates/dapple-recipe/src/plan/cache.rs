//! A memory of computed values, shared by plans of similar recipes.
//!
//! A step is identified by a description of all data from which its values follow: its node, the tile, the seed, the
//! time, and its inputs. If a later plan has a step with the same description, its fields and its values at the same
//! pixels are reused. A step with other options still takes over the parts that these do not change, such as nets of
//! control points. The bits are those of a plan without a memory.

use super::{Picture, Step};
use crate::Values;
use dapple_color::LinearRgb;
use dapple_pups::VectorTexture;
use dapple_raster::{Field, Parts, Window};
use std::collections::{BTreeMap, BTreeSet};
use std::fmt;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

/// Values and steps of plans, for reuse in later plans: see [`Plan::new_with_cache`](super::Plan::new_with_cache).
///
/// Clones share the same memory.
#[derive(Clone)]
pub struct PlanCache {
    kept: Arc<Mutex<Kept>>,
    /// Parts of steps without inputs.
    parts: Parts,
    max_bytes: usize,
}

/// The number of a description, unique for the lifetime of the memory.
pub(crate) type StepId = u64;

/// The pixels of a window, in a form that can be compared.
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
    /// The total number of bytes of the descriptions.
    id_bytes: usize,
    /// The numbers of steps that change with time.
    timed: BTreeSet<StepId>,
    /// Steps without inputs, with the last plan that used each.
    sources: BTreeMap<StepId, (Source, u64)>,
    n_plans: u64,
    values: BTreeMap<(StepId, Pixels), (Arc<Values>, u64)>,
    /// The stored values by their last use, oldest first.
    uses: BTreeMap<u64, (StepId, Pixels)>,
    n_uses: u64,
    bytes: usize,
    pictures: Vec<Picture>,
}

/// A step without inputs.
enum Source {
    Field(Arc<dyn Field>),
    Colors(Arc<VectorTexture<3>>),
}

/// The largest number of bytes of descriptions; past it, the memory is cleared.
const MAX_ID_BYTES: usize = 1 << 26;
/// The largest age, in plans, of an unused step without inputs and of its parts. It may be a texture with many points.
const MAX_AGE: u64 = 4;
/// The largest number of images that are recognized.
const MAX_PICTURES: usize = 64;

impl PlanCache {
    /// A memory for values of at most `max_bytes` bytes.
    #[must_use]
    pub fn new(max_bytes: usize) -> Self {
        Self {
            kept: Arc::default(),
            parts: Parts::keeping(),
            max_bytes,
        }
    }

    /// The number of bytes of the stored values.
    #[must_use]
    pub fn bytes(&self) -> usize {
        self.lock().bytes
    }

    /// Whether the values of some steps at a window fit without evicting most others.
    pub(super) fn has_room(&self, steps: usize, window: &Window) -> bool {
        let bytes = steps
            .saturating_mul(window.n_pixels())
            .saturating_mul(size_of::<LinearRgb>());
        bytes <= self.max_bytes / 2
    }

    /// Parts of steps without inputs, for steps made with other options.
    pub(super) fn parts(&self) -> &Parts {
        &self.parts
    }

    /// Begins a plan, and drops steps and parts of steps that the last plans did not use.
    pub(super) fn begin(&self) {
        self.parts.begin(MAX_AGE);
        let mut kept = self.lock();
        kept.n_plans += 1;
        let now = kept.n_plans;
        kept.sources.retain(|_, (_, used)| *used + MAX_AGE >= now);
    }

    /// The number of a description; a new one if it is unknown.
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

    /// Whether the step with this number has used the time so far.
    pub(super) fn is_timed(&self, id: StepId) -> bool {
        self.lock().timed.contains(&id)
    }

    /// The number of a step that changes with time, at a time.
    pub(super) fn at_time(&self, id: StepId, time: f64) -> StepId {
        self.lock().timed.insert(id);
        self.id(format!("{id} at {}", time.to_bits()))
    }

    /// A number without a description.
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
        // The address identifies the image, since a stored image cannot be replaced by others at the same address.
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

    /// A stored step without inputs.
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

    /// Stores a step if it has no inputs.
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

    /// Stores the values of a step at the pixels of a window, and drops the least recently used ones.
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

impl fmt::Debug for PlanCache {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let kept = self.lock();
        f.debug_struct("PlanCache")
            .field("values", &kept.values.len())
            .field("bytes", &kept.bytes)
            .finish()
    }
}

impl Kept {
    /// Clears the memory. Numbers continue, so that existing plans are not confused with new ones.
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
        let bits = |vector: [f64; 2]| vector.map(f64::to_bits);
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
    /// The number of bytes of the values.
    fn bytes(&self) -> usize {
        match self {
            Self::Numbers(numbers) => size_of_val(&numbers[..]),
            Self::Colors(colors) => size_of_val(&colors[..]),
        }
    }
}
