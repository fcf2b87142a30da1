//! Flow control for images sent to a page: one in flight per map; stale ones are dropped.

use crate::{Picture, Shown};
use std::collections::{BTreeMap, VecDeque};

/// The images that wait for the page to acknowledge earlier ones.
#[derive(Default)]
pub(super) struct Flow {
    lanes: BTreeMap<Shown, Lane>,
}

#[derive(Default)]
struct Lane {
    /// Whether an image has been sent and not been acknowledged yet.
    is_busy: bool,
    waiting: VecDeque<Picture>,
}

impl Flow {
    /// Queues an image. Returns it if it can be sent immediately.
    pub(super) fn put(&mut self, picture: Picture) -> Option<Picture> {
        let lane = self.lanes.entry(picture.shown).or_default();
        let is_outdated = |old: &Picture| {
            old.generation != picture.generation || (old.is_draft && !picture.is_draft)
        };
        lane.waiting.retain(|old| !is_outdated(old));
        if lane.is_busy {
            lane.waiting.push_back(picture);
            return None;
        }
        lane.is_busy = true;
        Some(picture)
    }

    /// Handles the page's acknowledgement of an image. Returns the map's next image to send, if any.
    pub(super) fn drawn(&mut self, map: u16) -> Option<Picture> {
        let lane = self.lanes.iter_mut().find(|(shown, _)| shown.code() == map);
        let (_, lane) = lane?;
        let next = lane.waiting.pop_front();
        lane.is_busy = next.is_some();
        next
    }
}
