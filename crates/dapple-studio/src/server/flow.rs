//! Pictures on their way to a page: of each map one at a time, and none that is outdated.

use crate::{Picture, Shown};
use std::collections::{BTreeMap, VecDeque};

/// The pictures that wait until the page has drawn those before.
#[derive(Default)]
pub(super) struct Flow {
    lanes: BTreeMap<Shown, Lane>,
}

#[derive(Default)]
struct Lane {
    /// Whether a picture is under way.
    is_busy: bool,
    waiting: VecDeque<Picture>,
}

impl Flow {
    /// Takes a picture, and gives it back if it can be sent at once.
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

    /// Notes that a picture was drawn, and gives the next one.
    pub(super) fn drawn(&mut self, map: u16) -> Option<Picture> {
        let lane = self.lanes.iter_mut().find(|(shown, _)| shown.code() == map);
        let (_, lane) = lane?;
        let next = lane.waiting.pop_front();
        lane.is_busy = next.is_some();
        next
    }
}
