//! Small cells: every feature point is put into the few pixels about it.
//!
//! Where a cell has only a few pixels, looking for the points that matter to each tile takes longer than comparing
//! them. So a block has planes for the `K` smallest keys of its pixels, and every point goes into a square of 8 × 8 or
//! 16 × 16 pixels about it. All points nearer to a pixel than half of that square have been compared there then, and
//! its keys are right if the `K`-th is smaller than that.

use super::block::{Block, Memory};
use super::kernel::{greater, lesser};
use super::sieve::{Keep, Points};
use super::{BLOCK_COLUMNS, LANES};
use crate::fixed::STEP;
use crate::metric::{Norm, with_norm};
use crate::sink::Values;
use crate::{Axes, Space};
use fearless_simd::{Level, dispatch, f32x8, f32x16, i32x8, i32x16, prelude::*};

/// Half of the sides of the squares.
const HALVES: [usize; 2] = [4, 8];

/// By how much of a pixel a pixel may lie beside its place: well below what [`SURE`] leaves.
const UNEVEN: f32 = 0.001;

/// Squares may begin this many pixels before those of the block.
const MARGIN: usize = 2 * HALVES[1];

/// The numbers from a row of a plane to the next.
const STRIDE: usize = BLOCK_COLUMNS + 2 * MARGIN;

/// The numbers of a plane from the first to the last pixel of a square.
const SPAN_8: usize = 7 * STRIDE + 8;
const SPAN_16: usize = 15 * STRIDE + 16;

/// The largest part of half a square that is relied upon: the place of a point among the pixels is rounded.
const SURE: f32 = 0.999;

/// By how many cells the distance of a point from a block of up to 1000 cells may be rounded, and more.
const ROUNDING: f32 = 0.001;

/// How a block is filled.
#[derive(Clone, Copy, Debug)]
pub(super) struct Splat {
    /// Half of the side of a square, in pixels.
    half: usize,
    /// The same in cells, or a little less.
    pub(super) reach: f32,
    /// Steps from one column to the next, and from one row to the next along the axis that goes with the rows.
    pixel: [f32; 2],
    /// The axis that goes with the rows.
    row_axis: usize,
}

impl Splat {
    /// How to fill a block whose pixels need points as far away as `distance`, if it can be filled in this way.
    pub(super) fn new<const N: usize>(block: &Block<'_, N>, distance: f32) -> Option<Self>
    where
        Axes: Space<N>,
    {
        let plane = block.picture.plane;
        let [u, v]: [[f64; N]; 2] = [plane.u.into(), plane.v.into()];
        let mut row_axes = (1..N).filter(|&axis| v[axis] != 0.0);
        let row_axis = row_axes.next()?;
        if row_axes.next().is_some() {
            return None;
        }
        let window = block.picture.window;
        let frequency = block.picture.frequency;
        let pixel = [
            (u[0] * window.pixel.x * frequency) as f32,
            (v[row_axis] * window.pixel.y * frequency) as f32,
        ];
        let smaller = pixel[0].abs().min(pixel[1].abs());
        let larger = pixel[0].abs().max(pixel[1].abs());
        for half in HALVES {
            let reach = half as f32 * smaller * SURE;
            // Pixels far from square make squares of pixels that reach too far along one axis.
            if reach >= distance && larger <= 2.0 * smaller && reach < 3.0 {
                let pixel = pixel.map(|cells| cells / STEP);
                return Some(Self {
                    half,
                    reach,
                    pixel,
                    row_axis,
                });
            }
        }
        None
    }

    /// Whether pixels are as evenly spaced as squares need it: far from zero, `f64` may not tell them apart.
    pub(super) fn is_even<const N: usize>(&self, lines: &[Vec<i32>; N]) -> bool {
        let is_even = |axis: usize, pixel: f32| {
            let line = &lines[axis][..lines[axis].len() - LANES];
            line.iter().enumerate().all(|(index, &steps)| {
                let expected = line[0] as f32 + index as f32 * pixel;
                (steps as f32 - expected).abs() <= UNEVEN * pixel.abs()
            })
        };
        is_even(0, self.pixel[0]) && is_even(self.row_axis, self.pixel[1])
    }

    /// Fills the pixels of a block whose table is made.
    pub(super) fn render<const N: usize>(
        &self,
        block: &Block<'_, N>,
        (values, out): (&Values, &mut [&mut [f32]]),
        memory: &mut Memory<N>,
    ) where
        Axes: Space<N>,
    {
        let (level, depth) = (block.level, values.tone.depth());
        with_norm!(block.picture.worley.metric, norm => match depth {
            1 => self.render_with::<_, N, 1>(level, norm, block, (values, out), memory),
            2 => self.render_with::<_, N, 2>(level, norm, block, (values, out), memory),
            _ => self.render_with::<_, N, 4>(level, norm, block, (values, out), memory),
        });
    }

    fn render_with<M: Norm, const N: usize, const K: usize>(
        &self,
        level: Level,
        norm: M,
        block: &Block<'_, N>,
        (values, out): (&Values, &mut [&mut [f32]]),
        memory: &mut Memory<N>,
    ) where
        Axes: Space<N>,
    {
        let pixels = memory.pixel_box(0..block.range.len(), 0..block.n_rows);
        let Memory {
            table,
            list,
            near,
            runs,
            lines,
            planes,
            ..
        } = memory;
        let all = table.cells;
        let last = core::array::from_fn(|axis| (all.last[axis] - all.first[axis]) as i32);
        table.runs([[0; N], last], runs);
        let points = Points {
            steps: &table.steps,
            numbers: None,
            runs,
            wants_numbers: false,
        };
        let n_rows = block.n_rows + 2 * MARGIN;
        for plane in planes.iter_mut().take(K) {
            plane.clear();
            plane.resize(STRIDE * n_rows, f32::INFINITY);
        }
        let planes: &mut [Vec<f32>; K] = (&mut planes[..K]).try_into().expect("K is at most 4");
        let key = norm.key_along_one_axis(self.reach);
        let generous = norm.key_along_one_axis(self.reach + ROUNDING);
        dispatch!(level, simd => {
            list.sift(simd, norm, points, (&pixels, Keep::Within(generous)), near);
            let row_axis = &lines[self.row_axis];
            for first in (0..list.len).step_by(LANES) {
                let lefts = self.corners(simd, 0, &list.steps[0][first..], lines[0][0]);
                let tops = self.corners(simd, 1, &list.steps[self.row_axis][first..], row_axis[0]);
                for lane in 0..LANES.min(list.len - first) {
                    let mut point = [0; N];
                    for axis in 0..N {
                        point[axis] = list.steps[axis][first + lane];
                    }
                    let corner = [lefts[lane], tops[lane]];
                    if self.half == HALVES[0] {
                        self.put::<_, _, N, K, 8, SPAN_8>(simd, norm, (point, corner, lines), planes);
                    } else {
                        self.put::<_, _, N, K, 16, SPAN_16>(simd, norm, (point, corner, lines), planes);
                    }
                }
            }
        });
        let limit = norm.tightened(key);
        for (row, out) in out.iter_mut().enumerate() {
            let first = (row + MARGIN) * STRIDE + MARGIN;
            let keys = planes
                .each_ref()
                .map(|plane| &plane[first..first + BLOCK_COLUMNS]);
            let out = &mut out[block.range.clone()];
            let unknown = dispatch!(level, simd => resolve(simd, norm, (values, limit), keys, out));
            for (column, before) in unknown {
                let place = block
                    .picture
                    .place(block.range.start + column, block.first + row);
                out[column] = before;
                values.put_one(block.picture.worley, place, &mut out[column]);
            }
        }
    }

    /// The first column or row of the squares about sixteen points, from their coordinates and that of the first pixel.
    #[inline(always)]
    fn corners<S: Simd>(&self, simd: S, along: usize, points: &[i32], first: i32) -> [i32; LANES] {
        let ahead = i32x16::from_slice(simd, &points[..LANES]) - first;
        let pixels = ahead.to_float::<f32x16<S>>() * self.pixel[along].recip();
        let corner = pixels.floor().to_int::<i32x16<S>>() - (self.half as i32 - 1);
        let mut corners = [0; LANES];
        corner.store_slice(&mut corners);
        corners
    }

    /// Puts a point into the `W × W` pixels from `corner` on; these span `SPAN` numbers of a plane.
    #[inline(always)]
    fn put<S: Simd, M: Norm, const N: usize, const K: usize, const W: usize, const SPAN: usize>(
        &self,
        simd: S,
        norm: M,
        (point, [left, top], lines): ([i32; N], [i32; 2], &[Vec<i32>; N]),
        planes: &mut [Vec<f32>; K],
    ) {
        // What lies further out than the margin touches no pixel.
        let margin = MARGIN as i32;
        if left < -margin || top < -margin || (left + margin) as usize + W > STRIDE {
            return;
        }
        let first = (top + margin) as usize * STRIDE + (left + margin) as usize;
        if first + SPAN > planes[0].len() {
            return;
        }
        let mut row_terms = [0.0; W];
        for part in 0..W / 8 {
            let mut key = f32x8::splat(simd, 0.0);
            for axis in (1..N).rev() {
                let steps = if axis == self.row_axis {
                    load(simd, &lines[axis], top + 8 * part as i32)
                } else {
                    i32x8::splat(simd, lines[axis][0])
                };
                let term = norm.terms((steps - point[axis]).to_float::<f32x8<S>>() * STEP);
                key = if axis == N - 1 {
                    term
                } else {
                    norm.joins(term, key)
                };
            }
            key.store_slice(&mut row_terms[part * 8..part * 8 + 8]);
        }
        let spans = planes.each_mut().map(|plane| -> &mut [f32; SPAN] {
            (&mut plane[first..first + SPAN])
                .try_into()
                .expect("as many as were cut out")
        });
        for part in 0..W / 8 {
            let steps = load(simd, &lines[0], left + 8 * part as i32);
            let terms = norm.terms((steps - point[0]).to_float::<f32x8<S>>() * STEP);
            for row in 0..W {
                let at = row * STRIDE + part * 8;
                let mut key = norm.joins(terms, f32x8::splat(simd, row_terms[row]));
                for rank in 0..K {
                    let best = f32x8::from_slice(simd, &spans[rank][at..at + 8]);
                    lesser(best, key).store_slice(&mut spans[rank][at..at + 8]);
                    key = greater(best, key);
                }
            }
        }
    }
}

/// Turns keys into values; returns the pixels whose last key is not below the limit, and what was there before.
#[inline(always)]
fn resolve<S: Simd, M: Norm, const K: usize>(
    simd: S,
    norm: M,
    (values, limit): (&Values, f32),
    planes: [&[f32]; K],
    out: &mut [f32],
) -> Vec<(usize, f32)> {
    let mut unknown = Vec::new();
    let values = values.lanes::<S, K>(simd);
    for (at, out) in (0..).step_by(LANES).zip(out.chunks_mut(LANES)) {
        let mut keys = [f32x16::splat(simd, 0.0); K];
        for rank in 0..K {
            keys[rank] = f32x16::from_slice(simd, &planes[rank][at..at + LANES]);
        }
        let mut wrong = !keys[K - 1].simd_lt(limit).to_bitmask() & (u64::MAX >> (64 - out.len()));
        while wrong != 0 {
            let lane = wrong.trailing_zeros() as usize;
            unknown.push((at + lane, out[lane]));
            wrong &= wrong - 1;
        }
        if out.len() == LANES {
            values.put(norm, keys, out);
        } else {
            values.put_part(norm, keys, out);
        }
    }
    unknown
}

/// Eight numbers of a line that goes on beyond its ends.
#[inline(always)]
fn load<S: Simd>(simd: S, line: &[i32], first: i32) -> i32x8<S> {
    if first >= 0 && first as usize + 8 <= line.len() {
        return i32x8::from_slice(simd, &line[first as usize..][..8]);
    }
    // Pixels beyond the ends are not looked at; any place will do.
    let mut steps = [line[0]; 8];
    for (lane, steps) in steps.iter_mut().enumerate() {
        if let Ok(at) = usize::try_from(first + lane as i32) {
            *steps = line[at.min(line.len() - 1)];
        }
    }
    i32x8::from_slice(simd, &steps)
}
