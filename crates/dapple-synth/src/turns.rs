//! The order in which threads share the sites of a pass.
//!
//! A site waits for all earlier sites of the sweep that it may read, and all later ones wait for it; what is left over is
//! free. So the texture has the bits of the sites one after the other in the order of the sweep, on any number of
//! threads.
//!
//! Sites that wait for no other come first, then those that wait only for these, and so on. Threads take turns in this
//! order, and each turn says how many of the turns before it must be over; seldom does one have to wait.

use crate::cells::Cells;
use core::hint::spin_loop;
use core::ops::Range;
use core::sync::atomic::{AtomicUsize, Ordering};

/// How often a thread looks again before it lets others use its core.
const LOOKS: u32 = 64;

/// Sites in an order in which several threads may visit them.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Turns {
    sites: Vec<u32>,
    /// For each turn, how many turns from the first one on must be over before it.
    waits: Vec<u32>,
}

impl Turns {
    /// The sites one after the other.
    pub(crate) fn in_order(order: Vec<u32>) -> Self {
        Self {
            waits: (0..order.len() as u32).collect(),
            sites: order,
        }
    }

    /// The sites of `order` with as little waiting as can be.
    ///
    /// Every site has a place, of which there are `n_places`, and may read sites at places near its own. `latest` gives
    /// the largest mark at the places near a site, its own among them: places are near each other, or both are not.
    pub(crate) fn new(
        order: &[u32],
        n_places: usize,
        place: impl Fn(u32) -> usize,
        latest: impl Fn(u32, &[u32]) -> u32,
    ) -> Self {
        let mut marks = vec![0; n_places];
        let generations: Vec<u32> = order
            .iter()
            .map(|&site| {
                let generation = latest(site, &marks);
                marks[place(site)] = generation + 1;
                generation
            })
            .collect();
        let sites = by_generation(order, &generations);
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

    /// Turns of sites that wait for those of the same and of nearby cells.
    pub(crate) fn by_cells(order: &[u32], cells: &Cells) -> Self {
        let latest = |site, marks: &[u32]| {
            let near = cells.near(cells.of_site(site)).iter();
            let marks = near.flat_map(|near| &marks[near.start as usize..near.end as usize]);
            marks.copied().max().unwrap_or(0)
        };
        Self::new(order, cells.n_cells(), |site| cells.of_site(site), latest)
    }

    /// The number of turns.
    pub(crate) fn len(&self) -> usize {
        self.sites.len()
    }

    /// The site of a turn, and how many turns from the first one on must be over before it.
    pub(crate) fn turn(&self, turn: usize) -> (u32, usize) {
        (self.sites[turn], self.waits[turn] as usize)
    }
}

/// The sites of `order`, those of the first generation first; each generation in the given order.
fn by_generation(order: &[u32], generations: &[u32]) -> Vec<u32> {
    let n_generations = generations
        .iter()
        .max()
        .map_or(0, |&last| last as usize + 1);
    let mut next = vec![0_usize; n_generations];
    for &generation in generations {
        next[generation as usize] += 1;
    }
    let mut first = 0;
    for next in &mut next {
        (*next, first) = (first, first + *next);
    }
    let mut sites = vec![0; order.len()];
    for (&site, &generation) in order.iter().zip(generations) {
        let at = &mut next[generation as usize];
        sites[*at] = site;
        *at += 1;
    }
    sites
}

/// Where threads say which turns they have: some turns in a row, all turns before them being over.
#[derive(Debug)]
pub(crate) struct Board {
    /// The first turn that no thread has.
    next: AtomicUsize,
    end: usize,
    /// Each thread's turn; all that it had before is over. Of a thread that has none, the largest number.
    ///
    /// All orderings are sequentially consistent: a thread that has no turn and takes one shows a number before it does,
    /// so that a thread that had a turn earlier and did not see the number waits only for turns that are still earlier.
    turns: Vec<AtomicUsize>,
}

impl Board {
    pub(crate) fn new(turns: Range<usize>, n_threads: usize) -> Self {
        Self {
            next: AtomicUsize::new(turns.start),
            end: turns.end,
            turns: (0..n_threads)
                .map(|_| AtomicUsize::new(usize::MAX))
                .collect(),
        }
    }

    /// Ends the turn of a thread and takes its next one.
    pub(crate) fn take(&self, thread: usize) -> Option<usize> {
        let shown = &self.turns[thread];
        shown.store(self.next.load(Ordering::SeqCst), Ordering::SeqCst);
        let turn = self.next.fetch_add(1, Ordering::SeqCst);
        let turn = if turn < self.end { turn } else { usize::MAX };
        shown.store(turn, Ordering::SeqCst);
        (turn < usize::MAX).then_some(turn)
    }

    /// Waits until the first turns are over.
    pub(crate) fn wait(&self, until: usize) {
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
    use super::{Board, Turns};
    use std::sync::Mutex;

    /// Places on a line, of which those are near that are at most two apart.
    fn on_a_line(order: &[u32]) -> Turns {
        let latest = |site: u32, marks: &[u32]| {
            let last = marks.len().min(site as usize + 3);
            *marks[(site as usize).saturating_sub(2)..last]
                .iter()
                .max()
                .unwrap()
        };
        Turns::new(order, order.len(), |site| site as usize, latest)
    }

    #[test]
    fn sites_wait_for_the_latest_near_one() {
        let turns = on_a_line(&[0, 4, 1, 8, 5, 2, 3, 6, 7]);
        // 0, 4 and 8 are free; 1 waits for 0, 5 for 4; 2 for 4, 0 and 1; 3 for all of these; and so on.
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
        for turns in [on_a_line(&order), Turns::in_order(order.clone())] {
            let board = Board::new(0..turns.len(), 5);
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
