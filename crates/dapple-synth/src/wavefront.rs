//! Wavefront schedule: the order in which threads visit the sites of a pass.
//!
//! A site runs after every earlier site of the sweep that it may read, and before every later site that may read it.
//! Independent sites run in parallel. So the texture has the same bits as in a sequential sweep, with any number of
//! threads.
//!
//! Sites that wait for no other come first, then sites that wait only for these, and so on. Each position in this order
//! is a turn. Threads take turns in order, and each turn specifies how many turns at the start of the schedule must be
//! finished before it runs. Threads rarely have to wait.

use crate::cells::Cells;
use core::hint::spin_loop;
use core::ops::Range;
use core::sync::atomic::{AtomicUsize, Ordering};
use dapple_raster::Groups;

/// Number of spins before a waiting thread yields its core.
const LOOKS: u32 = 64;

/// Wavefront schedule of sites for several threads.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct WavefrontSchedule {
    /// Site of each turn.
    sites: Vec<u32>,
    /// For each turn, the number of turns at the start of the schedule that must be finished before it runs.
    waits: Vec<u32>,
}

impl WavefrontSchedule {
    /// Builds a sequential schedule, in which every turn waits for all turns before it.
    pub(crate) fn in_order(order: Vec<u32>) -> Self {
        Self {
            waits: (0..order.len() as u32).collect(),
            sites: order,
        }
    }

    /// Schedules the sites of `order` with as little waiting as possible.
    ///
    /// Every site is at one of `n_places` positions, and may read sites at nearby positions. `latest` returns the
    /// largest mark at the positions near a site, including its own. Nearness must be symmetric.
    pub(crate) fn new(
        order: &[u32],
        n_places: usize,
        place: impl Fn(u32) -> usize,
        latest: impl Fn(u32, &[u32]) -> u32,
    ) -> Self {
        // A mark is one more than the generation of the last site at a position, and 0 before the first site.
        let mut marks = vec![0; n_places];
        // Generation of each site: one more than the latest generation it waits for.
        let generations: Vec<u32> = order
            .iter()
            .map(|&site| {
                let generation = latest(site, &marks);
                marks[place(site)] = generation + 1;
                generation
            })
            .collect();
        let sites = by_generation(order, &generations);
        // In the new order, find the last turn that each site waits for.
        marks.fill(0);
        let waits = sites
            .iter()
            .zip(1..)
            .map(|(&site, over)| {
                let wait = latest(site, &marks);
                marks[place(site)] = over;
                wait
            })
            .collect();
        Self { sites, waits }
    }

    /// Builds a schedule in which a site waits for earlier sites in the same cell and in nearby cells.
    pub(crate) fn by_cells(order: &[u32], cells: &Cells) -> Self {
        let latest = |site, marks: &[u32]| {
            let near = cells.near(cells.of_site(site)).iter();
            let marks = near.flat_map(|near| &marks[near.start as usize..near.end as usize]);
            marks.copied().max().unwrap_or(0)
        };
        Self::new(order, cells.n_cells(), |site| cells.of_site(site), latest)
    }

    /// Returns the number of turns.
    pub(crate) fn len(&self) -> usize {
        self.sites.len()
    }

    /// Returns the site of a turn, and the number of turns at the start of the schedule that must be finished before it
    /// runs.
    pub(crate) fn turn(&self, turn: usize) -> (u32, usize) {
        (self.sites[turn], self.waits[turn] as usize)
    }
}

/// Sorts the sites of `order` by generation. Sites of one generation keep their order.
fn by_generation(order: &[u32], generations: &[u32]) -> Vec<u32> {
    let n_generations = generations
        .iter()
        .max()
        .map_or(0, |&last| last as usize + 1);
    let groups = Groups::sort(n_generations, generations);
    groups
        .items
        .iter()
        .map(|&turn| order[turn as usize])
        .collect()
}

/// Shared state of a run: the turn that each thread has, within a range of turns. All turns before the range are
/// finished.
#[derive(Debug)]
pub(crate) struct WavefrontProgress {
    /// First turn that no thread has taken.
    next: AtomicUsize,
    end: usize,
    /// Current turn of each thread; all earlier turns of the thread are finished. `usize::MAX` for a thread without a
    /// turn.
    ///
    /// All accesses are sequentially consistent. Before a thread without a turn takes one, it publishes a lower bound
    /// of it. A thread that took its turn earlier and did not see the bound therefore waits only for still earlier
    /// turns.
    turns: Vec<AtomicUsize>,
}

impl WavefrontProgress {
    pub(crate) fn new(turns: Range<usize>, n_threads: usize) -> Self {
        Self {
            next: AtomicUsize::new(turns.start),
            end: turns.end,
            turns: (0..n_threads)
                .map(|_| AtomicUsize::new(usize::MAX))
                .collect(),
        }
    }

    /// Ends a thread's turn and takes the next one. Returns `None` if no turn is left.
    pub(crate) fn take(&self, thread: usize) -> Option<usize> {
        let shown = &self.turns[thread];
        // Publish a lower bound before taking a turn.
        shown.store(self.next.load(Ordering::SeqCst), Ordering::SeqCst);
        let turn = self.next.fetch_add(1, Ordering::SeqCst);
        let turn = if turn < self.end { turn } else { usize::MAX };
        shown.store(turn, Ordering::SeqCst);
        (turn < usize::MAX).then_some(turn)
    }

    /// Waits until all turns before `until` are finished.
    pub(crate) fn wait(&self, until: usize) {
        // Each thread takes its turns in ascending order, so its current turn is its first unfinished one.
        for shown in &self.turns {
            let mut looks = 0;
            while shown.load(Ordering::SeqCst) < until {
                looks += 1;
                if looks < LOOKS {
                    spin_loop();
                } else {
                    std::thread::yield_now();
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{WavefrontProgress, WavefrontSchedule};
    use std::sync::Mutex;

    /// Returns a schedule for positions on a line, where two positions are near if they are at most two apart.
    fn on_a_line(order: &[u32]) -> WavefrontSchedule {
        let latest = |site: u32, marks: &[u32]| {
            let last = marks.len().min(site as usize + 3);
            *marks[(site as usize).saturating_sub(2)..last]
                .iter()
                .max()
                .unwrap()
        };
        WavefrontSchedule::new(order, order.len(), |site| site as usize, latest)
    }

    #[test]
    fn sites_wait_for_the_latest_near_one() {
        let turns = on_a_line(&[0, 4, 1, 8, 5, 2, 3, 6, 7]);
        // Sites 0, 4 and 8 wait for no other; 1 waits for 0, and 5 for 4; 2 for 4, 0 and 1; 3 for all of these; and so
        // on.
        let sites: Vec<(u32, usize)> = (0..turns.len()).map(|turn| turns.turn(turn)).collect();
        let expected = [
            (0, 0),
            (4, 0),
            (8, 0),
            (1, 1),
            (5, 2),
            (2, 4),
            (3, 6),
            (6, 5),
            (7, 8),
        ];
        assert_eq!(sites[..3], expected[..3], "free ones");
        assert_eq!(sites.len(), expected.len(), "all of them");
        for (turn, (site, wait)) in sites.iter().enumerate() {
            let near = |other: u32| site.abs_diff(other) <= 2;
            let latest = sites[..turn].iter().rposition(|&(other, _)| near(other));
            assert_eq!(*wait, latest.map_or(0, |latest| latest + 1), "{site}");
        }
    }

    #[test]
    fn turns_are_taken_once_and_not_before_those_waited_for_are_over() {
        let order: Vec<u32> = (0..400).map(|at| at * 177 % 400).collect();
        for turns in [
            on_a_line(&order),
            WavefrontSchedule::in_order(order.clone()),
        ] {
            let board = WavefrontProgress::new(0..turns.len(), 5);
            let over = Mutex::new(Vec::new());
            std::thread::scope(|scope| {
                for thread in 0..5 {
                    let (turns, board, over) = (&turns, &board, &over);
                    scope.spawn(move || {
                        while let Some(turn) = board.take(thread) {
                            let (site, wait) = turns.turn(turn);
                            board.wait(wait);
                            let mut over = over.lock().unwrap();
                            let first = over.iter().filter(|(before, _)| *before < wait).count();
                            assert_eq!(first, wait, "turn {turn}");
                            over.push((turn, site));
                        }
                    });
                }
            });
            let mut over = over.into_inner().unwrap();
            over.sort_unstable();
            let mut sites: Vec<u32> = over.iter().map(|&(_, site)| site).collect();
            assert!(
                over.iter().map(|&(turn, _)| turn).eq(0..400),
                "each turn once"
            );
            sites.sort_unstable();
            assert!(sites.into_iter().eq(0..400), "each site once");
        }
    }
}
