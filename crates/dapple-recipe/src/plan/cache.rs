//! A cache of computed values, shared by plans of similar recipes.
//!
//! The key of a step describes all data that its values depend on: its node, the tile, the seed, the time, and its
//! inputs. If a later plan has a step with the same key, its field and its values at the same pixels are reused. A step
//! with other options still reuses the parts that these options do not change, such as nets of control points. A plan
//! with a cache computes the same bits as a plan without.

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
/// Clones share one cache.
#[derive(Clone)]
pub struct PlanCache {
    kept: Arc<Mutex<Kept>>,
    /// Reusable parts of steps without inputs.
    parts: Parts,
    max_bytes: usize,
}

/// The id of the key of a step, unique for the lifetime of the cache.
pub(crate) type StepId = u64;

/// The pixels of a window as a map key, in which floats are compared by their bits.
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
    /// The next free id.
    next: StepId,
    ids: BTreeMap<String, StepId>,
    /// Total size of the keys, in bytes.
    id_bytes: usize,
    /// The ids of steps that change with time.
    timed: BTreeSet<StepId>,
    /// Steps without inputs, each with the number of the last plan that used it.
    sources: BTreeMap<StepId, (Source, u64)>,
    n_plans: u64,
    values: BTreeMap<(StepId, Pixels), (Arc<Values>, u64)>,
    /// The keys of the stored values by their last use, oldest first.
    uses: BTreeMap<u64, (StepId, Pixels)>,
    n_uses: u64,
    bytes: usize,
    pictures: Vec<Picture>,
}

/// A step that has no inputs, in its cacheable form.
enum Source {
    Field(Arc<dyn Field>),
    Colors(Arc<VectorTexture<3>>),
}

/// Maximum total size of the keys, in bytes. The cache is cleared before a key would exceed it.
const MAX_ID_BYTES: usize = 1 << 26;
/// Number of plans after which an unused step without inputs is dropped, with its parts. Such a step may be a texture
/// with many points.
const MAX_AGE: u64 = 4;
/// Maximum number of images that the cache recognizes. The cache is cleared before it would exceed this number.
const MAX_PICTURES: usize = 64;

impl PlanCache {
    /// Creates an empty cache that holds at most `max_bytes` bytes of values.
    #[must_use]
    pub fn new(max_bytes: usize) -> Self {
        Self {
            kept: Arc::default(),
            parts: Parts::keeping(),
            max_bytes,
        }
    }

    /// Returns the total size of the stored values, in bytes.
    #[must_use]
    pub fn bytes(&self) -> usize {
        self.lock().bytes
    }

    /// Returns whether the values of `steps` steps in a window fit in half of the cache. Larger ones would evict most
    /// of the other values.
    pub(super) fn has_room(&self, steps: usize, window: &Window) -> bool {
        let bytes = steps
            .saturating_mul(window.n_pixels())
            .saturating_mul(size_of::<LinearRgb>());
        bytes <= self.max_bytes / 2
    }

    /// Returns the reusable parts of steps without inputs, for steps with other options.
    pub(super) fn parts(&self) -> &Parts {
        &self.parts
    }

    /// Begins a plan. Drops steps, and parts of steps, that the last [`MAX_AGE`] plans did not use.
    pub(super) fn begin(&self) {
        self.parts.begin(MAX_AGE);
        let mut kept = self.lock();
        kept.n_plans += 1;
        let now = kept.n_plans;
        kept.sources.retain(|_, (_, used)| *used + MAX_AGE >= now);
    }

    /// Returns the id of a key. A key that is not stored gets a new id.
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

    /// Returns whether the step with this id is known to change with time.
    pub(super) fn is_timed(&self, id: StepId) -> bool {
        self.lock().timed.contains(&id)
    }

    /// Records that a step changes with time, and returns its id at `time`.
    pub(super) fn at_time(&self, id: StepId, time: f64) -> StepId {
        self.lock().timed.insert(id);
        self.id(format!("{id} at {}", time.to_bits()))
    }

    /// Returns a new id without a key, for a step that cannot be cached.
    pub(super) fn new_id(&self) -> StepId {
        let mut kept = self.lock();
        kept.next += 1;
        kept.next - 1
    }

    /// Returns a number that identifies an image. Two images have the same number if they share their pixels in memory.
    pub(super) fn picture_id(&self, picture: &Picture) -> usize {
        let mut kept = self.lock();
        if kept.pictures.len() >= MAX_PICTURES {
            kept.forget_all();
        }
        // The address identifies the image: the cache holds a reference, so that no other image can get the same
        // address.
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

    /// Returns the stored step with this id; `None` if it is not stored. Only steps without inputs are stored.
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

    /// Stores a step if it is a field or a color texture, which have no inputs.
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

    /// Returns the stored values of a step at the pixels of a window, and marks them as used; `None` if they are not
    /// stored.
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

    /// Stores the values of a step at the pixels of a window, and drops the least recently used values past the size
    /// limit.
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
    /// Clears the cache. Ids are not reused, so that existing plans are not confused with new ones.
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
    /// Returns the size of the values, in bytes.
    fn bytes(&self) -> usize {
        match self {
            Self::Numbers(numbers) => size_of_val(&numbers[..]),
            Self::Colors(colors) => size_of_val(&colors[..]),
        }
    }
}
