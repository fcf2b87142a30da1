//! Files that are changed by other programs.

use notify::{RecommendedWatcher, RecursiveMode, Watcher as _};
use std::path::Path;
use std::time::Duration;
use tokio::sync::watch::{Receiver, Sender, channel};

/// How long files are quiet before they are read: programs write in several steps.
pub(super) const QUIET: Duration = Duration::from_millis(50);

/// Tells pages that something in a folder has changed.
pub(super) struct Disk {
    changes: Receiver<u64>,
    /// Watches as long as it lives; none where the system cannot.
    _watcher: Option<RecommendedWatcher>,
}

impl Disk {
    /// Watches a folder, since programs save a file by putting another in its place.
    pub(super) fn new(folder: &Path) -> Self {
        let (sender, changes) = channel(0);
        Self {
            changes,
            _watcher: watcher(folder, sender),
        }
    }

    /// Counts the changes.
    pub(super) fn changes(&self) -> Receiver<u64> {
        self.changes.clone()
    }
}

fn watcher(folder: &Path, sender: Sender<u64>) -> Option<RecommendedWatcher> {
    let tell = move |event: notify::Result<notify::Event>| {
        if event.is_ok_and(|event| !event.kind.is_access()) {
            sender.send_modify(|count| *count = count.wrapping_add(1));
        }
    };
    let mut watcher = notify::recommended_watcher(tell).ok()?;
    watcher.watch(folder, RecursiveMode::NonRecursive).ok()?;
    Some(watcher)
}
