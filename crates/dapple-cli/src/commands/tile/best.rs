//! Makes tiles by one method, or by the best of all methods.

use super::method::{Candidate, How, MethodArgs};
use super::{advise, synth};
use crate::args::Size;
use crate::error::usage;
use anyhow::Result;
use dapple::tile::{Map, SeamOptions, SeamReports, Seamless};

/// The tiles of all maps, computed by one method.
pub(in crate::commands) struct Made {
    pub(super) candidate: Candidate,
    pub(in crate::commands) tiles: Vec<Map>,
    /// Seam reports of all maps; empty unless the choice of the method needed them.
    pub(super) reports: Vec<SeamReports>,
}

/// Computes the tiles of maps of the same size by a method. For `auto`, computes them with each candidate, and returns
/// those with the best [`Rank`]. Candidates that fail are skipped, unless all fail.
///
/// # Errors
///
/// If no candidate can make tiles.
pub(in crate::commands) fn best(
    method: &MethodArgs,
    maps: &[Map],
    axes: [bool; 2],
    lattice: Option<Size>,
) -> Result<Made> {
    let mut candidates = method.candidates(maps[0].size());
    let make = |candidate: Candidate| -> Result<Made> {
        let tiles = match &candidate.how {
            &How::Seamless(method) => Seamless { method, axes }.apply_maps(maps).map_err(advise)?,
            How::Synth(how) => synth::tiles(maps, axes, how)?,
        };
        Ok(Made {
            tiles,
            reports: Vec::new(),
            candidate,
        })
    };
    if let [_] = candidates.as_slice() {
        return make(candidates.remove(0));
    }
    let (mut best, mut refused): (Option<(Rank, Made)>, _) = (None, None);
    for candidate in candidates {
        let has_passed = best.as_ref().is_some_and(|(rank, _)| !rank.fails);
        if candidate.is_last_resort() && has_passed {
            continue;
        }
        let mut made = match make(candidate) {
            Ok(made) => made,
            Err(error) => {
                refused.get_or_insert(error);
                continue;
            }
        };
        let options = options(axes, lattice, &made.candidate);
        let pairs = maps.iter().zip(&made.tiles);
        let reports = pairs.map(|(map, tile)| SeamReports::beside(map, tile, &options));
        made.reports = reports.collect::<Result<_, _>>()?;
        let rank = Rank::of(&made.reports);
        if best.as_ref().is_none_or(|(least, _)| rank < *least) {
            best = Some((rank, made));
        }
    }
    match (best, refused) {
        (Some((_, made)), _) => Ok(made),
        (None, Some(error)) => Err(error),
        (None, None) => Err(usage("there is no method")),
    }
}

/// Cost of the tiles of a candidate; smaller is better. Tiles that pass the seam report come before tiles that fail.
#[derive(PartialEq, PartialOrd)]
struct Rank {
    fails: bool,
    /// For tiles that pass, the strangeness of their seams; for others, the badness. To it, the lost fraction of the
    /// finest octave is added. The maximum over all channels.
    cost: f64,
}

impl Rank {
    fn of(reports: &[SeamReports]) -> Self {
        let fails = !reports.iter().all(SeamReports::passes);
        let mut cost: f64 = 0.0;
        for of in reports.iter().flat_map(SeamReports::channels) {
            let kept = of.report.kept.as_ref();
            let finest = kept.and_then(|kept| kept.octaves.first());
            let lost = finest.map_or(0.0, |kept| (1.0 - kept).max(0.0));
            // Measures below their limits do not rank tiles: a cut may be softer than a double exposure. Copied parts
            // are less strange than blended ones.
            let strangeness = kept.and_then(|kept| {
                let [fine, coarse] = [kept.strangeness, kept.coarse_strangeness];
                Some(fine?.max(coarse.unwrap_or(0.0)))
            });
            let quality = match strangeness {
                Some(strangeness) if !fails => strangeness,
                _ => of.report.badness(),
            };
            cost = cost.max(quality + lost);
        }
        Self { fails, cost }
    }
}

/// Returns the options of the seam report for a candidate.
pub(super) fn options(
    axes: [bool; 2],
    lattice: Option<Size>,
    candidate: &Candidate,
) -> SeamOptions {
    SeamOptions {
        axes,
        lattice: lattice.map_or(candidate.lattice, |lattice| lattice.0),
    }
}
