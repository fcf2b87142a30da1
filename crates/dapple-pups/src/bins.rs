//! A grid of bins that says which control points can have a weight where.
//!
//! Every bin lists the control points, and images of them, whose supports reach into it, in the order in which weights
//! are summed; so the time for a position does not depend on the number of points. The grid covers the domain. On an
//! axis that does not wrap, the bins of the border reach out as far as there are positions.
//!
//! With many points, that time is spent waiting for memory, and the less there is of it, the more of it is near. So a bin
//! has 16 bytes, and the numbers in it lead to records that lie in strips, column by column: the candidates of a position
//! are near each other whatever the order of the points.

use crate::net::{AxisBlock, BLOCK, Instance, Net};
use glam::DVec2;

/// How many bins there are for each instance: more bins, fewer candidates in each, and more memory. With 3, a position has
/// some 7 candidates, of which 4 have a weight, and mostly no more than a bin holds.
const BINS_PER_INSTANCE: f64 = 3.0;

/// The most bins along one axis.
const BINS_LIMIT: f64 = 16_384.0;

/// How many rows of bins make a strip.
const STRIP: usize = 4;

/// How many candidates are evaluated together.
pub(crate) const GROUP: usize = 8;

/// Up to eight candidates, in their order, as the places of their records in the strips about the bin; or where else to
/// look.
#[derive(Clone, Copy, Debug)]
#[repr(align(16))]
struct Bin([u16; GROUP]);

impl Bin {
    /// Stands for no candidate.
    const NONE: u16 = u16::MAX;
    /// Stands first in a bin that has candidates with more axes than a block holds, more candidates than eight, or some
    /// that are too far away; the two halves of where they are listed follow.
    const ELSEWHERE: u16 = Self::NONE - 1;

    /// The bin with some candidates, whose records are counted from `base`; nothing if they do not fit.
    fn of(candidates: &[u32], base: u32) -> Option<Self> {
        let mut bin = Self([Self::NONE; GROUP]);
        for (index, &candidate) in candidates.iter().enumerate() {
            let record = Some(candidate).filter(|&candidate| candidate < LONG)?;
            let place = u16::try_from(record.checked_sub(base)?).ok()?;
            *bin.0.get_mut(index)? = Some(place).filter(|&place| place < Self::ELSEWHERE)?;
        }
        Some(bin)
    }

    fn elsewhere(start: u32) -> Self {
        let mut bin = Self([Self::NONE; GROUP]);
        // Cut into its halves.
        bin.0[..3].copy_from_slice(&[Self::ELSEWHERE, start as u16, (start >> 16) as u16]);
        bin
    }
}

/// Marks a candidate with more axes than a block holds. In the memory of any machine there are less than 2^30 instances.
const LONG: u32 = 1 << 30;

/// Ends the candidates of a crowded bin.
const END: u32 = u32::MAX;

/// Up to eight candidates, ready to be evaluated.
pub(crate) struct Candidates {
    /// Their records; the first of all where there is no candidate.
    pub(crate) records: [u32; GROUP],
    /// One for a candidate, zero for none.
    pub(crate) ones: [f32; GROUP],
    /// Which have more axes than a block holds, as bits.
    pub(crate) long: u32,
    /// Leads to the candidates that come after them.
    pub(crate) next: Option<u32>,
}

/// The grid, and what it knows of instances: their records.
#[derive(Debug)]
pub(crate) struct Bins {
    size: [usize; 2],
    origin: DVec2,
    /// Bins per unit of length.
    per_unit: DVec2,
    bins: Vec<Bin>,
    /// Where the records of each strip of bins are counted from.
    bases: Vec<u32>,
    /// The candidates of bins that cannot hold them, each followed by [`END`].
    crowded: Vec<u32>,
    /// The first axes of each record.
    pub(crate) axes: Vec<AxisBlock>,
    pub(crate) centers: Vec<DVec2>,
    /// The places of the records among the instances.
    pub(crate) instances: Vec<u32>,
    /// The control points of the records.
    pub(crate) points: Vec<u32>,
}

impl Bins {
    pub(crate) fn new(net: &Net) -> Self {
        let size = net.domain.size;
        let side = (size.x * size.y / (net.instances.len() as f64 * BINS_PER_INSTANCE)).sqrt();
        let count = |axis: usize| (size[axis] / side).ceil().clamp(1.0, BINS_LIMIT);
        let counts = DVec2::new(count(0), count(1));
        let mut bins = Self {
            size: [counts.x as usize, counts.y as usize],
            origin: net.domain.origin,
            per_unit: counts / size,
            bins: Vec::new(),
            bases: Vec::new(),
            crowded: Vec::new(),
            axes: Vec::new(),
            centers: Vec::new(),
            instances: Vec::new(),
            points: Vec::new(),
        };
        let places = bins.place_records(net);
        let (offsets, candidates) = bins.list_candidates(net, &places);
        bins.pack(&offsets, &candidates);
        bins
    }

    /// The first candidates at a position (which [`Net::local`] has brought into range).
    #[inline(always)]
    pub(crate) fn first_candidates(&self, position: DVec2) -> Candidates {
        let row = self.bin(1, position.y);
        let Bin(places) = self.bins[row * self.size[0] + self.bin(0, position.x)];
        if places[0] == Bin::ELSEWHERE {
            return self.next_candidates(u32::from(places[1]) | u32::from(places[2]) << 16);
        }
        let base = self.bases[row / STRIP];
        let is_none = |place| place == Bin::NONE;
        Candidates {
            records: places.map(|place| {
                if is_none(place) {
                    0
                } else {
                    base + u32::from(place)
                }
            }),
            ones: places.map(|place| if is_none(place) { 0.0 } else { 1.0 }),
            long: 0,
            next: None,
        }
    }

    /// The candidates of a crowded bin, from a place in their list on.
    pub(crate) fn next_candidates(&self, start: u32) -> Candidates {
        let mut candidates = Candidates {
            records: [0; GROUP],
            ones: [0.0; GROUP],
            long: 0,
            next: None,
        };
        for (lane, &candidate) in self.crowded[start as usize..].iter().enumerate() {
            if candidate == END {
                break;
            }
            if lane == GROUP {
                candidates.next = Some(start + GROUP as u32);
                break;
            }
            candidates.records[lane] = candidate & !LONG;
            candidates.ones[lane] = 1.0;
            candidates.long |= u32::from(candidate & LONG != 0) << lane;
        }
        candidates
    }

    /// The bin of a coordinate along an axis; what lies outside belongs to the border.
    #[inline(always)]
    fn bin(&self, axis: usize, coordinate: f64) -> usize {
        // A negative number becomes zero.
        let bin = (coordinate - self.origin[axis]) * self.per_unit[axis];
        // There are at most 2^14 bins along an axis.
        (bin as u32 as usize).min(self.size[axis] - 1)
    }

    /// Makes the records, strip by strip. Returns the record of each instance.
    fn place_records(&mut self, net: &Net) -> Vec<u32> {
        let key = |instance: &Instance| {
            let [column, row] = [0, 1].map(|axis| self.bin(axis, instance.center[axis]));
            (row / STRIP, column, row)
        };
        let mut order: Vec<_> = net.instances.iter().map(key).zip(0..).collect();
        order.sort_unstable();
        let mut places = vec![0; order.len()];
        for (place, &(_, index)) in (0..).zip(&order) {
            let instance = &net.instances[index as usize];
            let blocks = net.blocks(instance);
            places[index as usize] = place;
            self.axes.push(blocks[0]);
            self.centers.push(instance.center);
            self.instances.push(index);
            self.points.push(instance.point);
        }
        places
    }

    /// Lists the candidates of every bin, in the order of the instances: those of bin `b` are
    /// `candidates[offsets[b]..offsets[b + 1]]`.
    fn list_candidates(&self, net: &Net, places: &[u32]) -> (Vec<u32>, Vec<u32>) {
        let mut entries = Vec::new();
        let mut offsets = vec![0; self.size[0] * self.size[1] + 1];
        for (instance, &place) in net.instances.iter().zip(places) {
            let is_long = net.blocks(instance).len() > 1;
            let candidate = if is_long { place | LONG } else { place };
            let [columns, rows] = [0, 1].map(|axis| {
                self.bin(axis, instance.min[axis])..=self.bin(axis, instance.max[axis])
            });
            for row in rows {
                for column in columns.clone() {
                    if self.touches(net, instance, [column, row]) {
                        let bin = row * self.size[0] + column;
                        entries.push((bin, candidate));
                        offsets[bin + 1] += 1;
                    }
                }
            }
        }
        for bin in 1..offsets.len() {
            offsets[bin] += offsets[bin - 1];
        }
        let mut next = offsets.clone();
        let mut candidates = vec![0; entries.len()];
        for (bin, candidate) in entries {
            candidates[next[bin] as usize] = candidate;
            next[bin] += 1;
        }
        (offsets, candidates)
    }

    /// Packs the candidates of bins, and lists those that do not fit.
    fn pack(&mut self, offsets: &[u32], candidates: &[u32]) {
        let of = |bin: usize| &candidates[offsets[bin] as usize..offsets[bin + 1] as usize];
        let n_bins = self.size[0] * self.size[1];
        let per_strip = self.size[0] * STRIP;
        for strip in (0..n_bins).step_by(per_strip) {
            let bins = strip..(strip + per_strip).min(n_bins);
            // A mark makes a number larger.
            let base = bins.clone().flat_map(of).min().map_or(0, |&least| least);
            self.bases.push(base);
            for bin in bins {
                let packed = Bin::of(of(bin), base).unwrap_or_else(|| {
                    // In the memory of any machine there are less than 2^32 of them.
                    let start = self.crowded.len() as u32;
                    self.crowded.extend_from_slice(of(bin));
                    self.crowded.push(END);
                    Bin::elsewhere(start)
                });
                self.bins.push(packed);
            }
        }
    }

    /// Whether the support of an instance reaches into a bin, or may do so.
    fn touches(&self, net: &Net, instance: &Instance, bin: [usize; 2]) -> bool {
        let [x, y] = [0, 1].map(|axis| {
            self.ends(net, axis, bin[axis])
                .map(|end| (end - instance.center[axis]) as f32)
        });
        let can_weigh = |block: &AxisBlock, slot: usize| {
            let u = |x: f32, y: f32| (1.0 - block.y[slot] * y) - block.x[slot] * x;
            u(x[0], y[0])
                .max(u(x[1], y[0]))
                .max(u(x[0], y[1]))
                .max(u(x[1], y[1]))
                > 0.0
        };
        net.blocks(instance)
            .iter()
            .all(|block| (0..BLOCK).all(|slot| can_weigh(block, slot)))
    }

    /// Where a bin begins and ends along an axis.
    fn ends(&self, net: &Net, axis: usize, bin: usize) -> [f64; 2] {
        let (origin, size) = (net.domain.origin[axis], net.domain.size[axis]);
        let side = 1.0 / self.per_unit[axis];
        // Rounding may put a position into the neighboring bin.
        let slack = side * 1e-6 + (origin.abs() + size) * 1e-15;
        let start = origin + side * bin as f64 - slack;
        let end = origin + side * (bin + 1) as f64 + slack;
        if net.domain.wrap[axis] {
            return [start, end];
        }
        let first = if bin == 0 {
            net.local(axis, f64::MIN)
        } else {
            start
        };
        let last = if bin + 1 == self.size[axis] {
            net.local(axis, f64::MAX)
        } else {
            end
        };
        [first, last]
    }
}
