//! The paper's pseudocode, implemented literally.

use crate::plane::SLANT;
use crate::{
    Candidates, CoarserCenter, Edges, Exemplar, Options, Pass, Pyramid, Reads, Schedule,
    distance_sq,
};
use dapple_hash::hash1;
use dapple_raster::{Raster, Wrap};

/// Colors and sources of a level in the oracle.
struct NaiveLevel {
    size: [u32; 2],
    wrap: [Wrap; 2],
    colors: Vec<Vec<f32>>,
    sources: Vec<u32>,
    /// Values of all guides at each site.
    guides: Vec<Vec<f32>>,
}

impl NaiveLevel {
    /// Returns the color at a position in half pixels: a pixel, or the mean of the two or four pixels around the
    /// position.
    fn color(&self, halves: [i64; 2], channel: usize) -> f32 {
        let at = |step: [i64; 2]| {
            let [x, y] = [0, 1].map(|axis| {
                let place = (halves[axis] + step[axis]).div_euclid(2);
                self.wrap[axis].index(place, self.size[axis])
            });
            self.colors[(y * self.size[0] + x) as usize][channel]
        };
        let sum = (at([0, 0]) + at([1, 0])) + (at([0, 1]) + at([1, 1]));
        0.25 * sum
    }
}

/// Returns the next coarser level of a guide: means with the products of the weights 1-4-6-4-1.
fn coarser_guide(guide: &Raster<f32>, wrap: [Wrap; 2]) -> Raster<f32> {
    let weights = [1.0, 4.0, 6.0, 4.0, 1.0];
    let mean = |x: u32, y: u32| {
        let mut sum = 0.0;
        for (j, row) in (-2..).zip(weights) {
            for (i, column) in (-2..).zip(weights) {
                let [x, y] = [2 * i64::from(x) + i, 2 * i64::from(y) + j];
                sum += row * column * guide.at(x, y, wrap);
            }
        }
        sum / 256.0
    };
    Raster::from_fn(guide.size().map(|side| side.div_ceil(2)), mean).unwrap()
}

/// Runs the paper's pseudocode for any schedule: every site compares with all candidates, in the order of the sweep.
pub(super) fn naive(
    exemplar: &Exemplar,
    size: [u32; 2],
    edges: [Edges; 2],
    options: &Options,
) -> Vec<u32> {
    naive_guided(exemplar, &[], size, edges, options)
}

/// Runs the pseudocode for a texture with guides of weight 1.
pub(super) fn naive_guided(
    exemplar: &Exemplar,
    guides: &[&Raster<f32>],
    size: [u32; 2],
    edges: [Edges; 2],
    options: &Options,
) -> Vec<u32> {
    let mut guides: Vec<Raster<f32>> = guides.iter().map(|&guide| guide.clone()).collect();
    let pyramid = exemplar.pyramid(options.n_levels).unwrap();
    let wrap = edges.map(|edges| {
        if edges == Edges::Wrap {
            Wrap::Repeat
        } else {
            Wrap::Mirror
        }
    });
    let mut levels: Vec<NaiveLevel> = (0..options.n_levels)
        .map(|level| {
            let size = size.map(|side| side.div_ceil(1 << level));
            let n_sites = i64::from(size[0] * size[1]);
            let read = &pyramid.levels()[level];
            let n_pixels = u64::from(read.size()[0] * read.size()[1]);
            let seed = options.seed.child("first colors", level as u64);
            let random = |site| (((hash1(seed, [site], 0) >> 32) * n_pixels) >> 32) as u32;
            let sources: Vec<u32> = (0..n_sites).map(random).collect();
            let colors = sources.iter().map(|&pixel| color_of(read, pixel)).collect();
            let values = |site| guides.iter().map(|guide| guide.pixels()[site]).collect();
            let guides_here = (0..n_sites as usize).map(values).collect();
            guides = guides
                .iter()
                .map(|guide| coarser_guide(guide, wrap))
                .collect();
            NaiveLevel {
                size,
                wrap,
                colors,
                sources,
                guides: guides_here,
            }
        })
        .collect();
    let schedule = options
        .schedule
        .clone()
        .unwrap_or_else(|| Schedule::paper(options.n_levels));
    for pass in &schedule.passes {
        visit(&pyramid, pass, options, &mut levels);
    }
    levels.swap_remove(0).sources
}

fn color_of(exemplar: &Exemplar, pixel: u32) -> Vec<f32> {
    exemplar.pixels()[pixel as usize * 2..][..2].to_vec()
}

fn visit(pyramid: &Pyramid, pass: &Pass, options: &Options, levels: &mut [NaiveLevel]) {
    let candidates = Candidates::new(pyramid, pass, options.center).unwrap();
    let level = pass.level;
    let [width, height] = levels[level].size;
    let mut places: Vec<[u32; 2]> = (0..height)
        .flat_map(|y| (0..width).map(move |x| [x, y]))
        .collect();
    if levels[level].wrap[0] == Wrap::Repeat && level + 1 < levels.len() {
        places.sort_by_key(|[x, y]| x + SLANT * y);
    }
    for [x, y] in places {
        let mut query = Vec::new();
        for part in &pass.parts {
            let read = &levels[level + usize::from(part.reads == Reads::Coarser)];
            let middle = [x, y].map(|at| match (part.reads, options.center) {
                (Reads::Same, _) => 2 * i64::from(at),
                (Reads::Coarser, CoarserCenter::Exact) => i64::from(at),
                (Reads::Coarser, CoarserCenter::Floor) => i64::from(at / 2) * 2,
            });
            for [i, j] in part.offsets() {
                let place = [middle[0] + 2 * i64::from(i), middle[1] + 2 * i64::from(j)];
                query.extend([0, 1].map(|channel| read.color(place, channel) * part.weight.sqrt()));
            }
        }
        let site = (y * width + x) as usize;
        let n_pixels: f32 = pass
            .parts
            .iter()
            .map(|part| part.offsets().len() as f32 * part.weight)
            .sum();
        query.extend(
            levels[level].guides[site]
                .iter()
                .map(|guide| guide * n_pixels.sqrt()),
        );
        let mut best = (f32::INFINITY, 0);
        for row in 0..candidates.len() {
            let distance = distance_sq(&query, candidates.row(row));
            if distance < best.0 {
                best = (distance, row);
            }
        }
        let [column, row] = candidates.pixel(best.1);
        let pixel = row * pyramid.levels()[level].size()[0] + column;
        levels[level].sources[site] = pixel;
        levels[level].colors[site] = color_of(&pyramid.levels()[level], pixel);
    }
}
