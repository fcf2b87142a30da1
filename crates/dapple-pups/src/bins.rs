//! A grid of bins. Each bin lists the control points that can have a weight in it.
//!
//! Every bin lists the instances (control points and their periodic images) whose supports intersect it, in the order
//! of summation. The time to evaluate a position therefore does not depend on the number of points. The grid covers
//! the domain. On an axis that does not wrap, the border bins extend to the limits of the evaluated positions.
//!
//! With many points, evaluation is limited by memory latency, so the data is compact and local. A bin takes 16 bytes.
//! It lists indices of records. A record holds the data of an instance, and records are sorted by strips of bins and
//! by column. The candidates of a position are therefore near each other in memory, whatever the order of the points.

use crate::net::{AxisBlock, BLOCK, Instance, Net};
use dapple_raster::Groups;
use glam::DVec2;

/// Number of bins for each instance. More bins mean fewer candidates in each, but more memory. With 3, a position has
/// about 7 candidates; 4 of them have a nonzero weight. Most bins then hold all their candidates.
const BINS_PER_INSTANCE: f64 = 3.0;

/// Maximum number of bins along one axis.
const BINS_LIMIT: f64 = 16_384.0;

/// Height of a strip of bins that share a base for their record indices, in bins.
const STRIP: usize = 4;

/// Number of candidates that are evaluated together, one per lane.
pub(crate) const GROUP: usize = 8;

/// The candidates of a bin, in order. Elements are record indices relative to the strip's base. If the candidates do
/// not fit, the bin holds the index of a list in [`Bins::crowded`] instead.
#[derive(Clone, Copy, Debug)]
#[repr(align(16))]
struct Bin([u16; GROUP]);

impl Bin {
    /// Marks an unused slot.
    const NONE: u16 = u16::MAX;
    /// First element of a bin that does not hold its candidates: there are more than eight, one has several blocks of
    /// axes, or a record is too far from the base. The next two elements are the low and high half of an index into
    /// [`Bins::crowded`].
    const ELSEWHERE: u16 = Self::NONE - 1;

    /// Packs candidates into a bin, with record indices relative to `base`. Returns `None` if they do not fit.
    fn of(candidates: &[u32], base: u32) -> Option<Self> {
        let mut bin = Self([Self::NONE; GROUP]);
        for (index, &candidate) in candidates.iter().enumerate() {
            // Fail if the candidate has more than one block of axes, is too far from the base, or is the ninth.
            let record = Some(candidate).filter(|&candidate| candidate < LONG)?;
            let place = u16::try_from(record.checked_sub(base)?).ok()?;
            *bin.0.get_mut(index)? = Some(place).filter(|&place| place < Self::ELSEWHERE)?;
        }
        Some(bin)
    }

    fn elsewhere(start: u32) -> Self {
        let mut bin = Self([Self::NONE; GROUP]);
        // Split the index into two halves.
        bin.0[..3].copy_from_slice(&[Self::ELSEWHERE, start as u16, (start >> 16) as u16]);
        bin
    }
}

/// Flag of a candidate with several blocks of axes. Record indices do not need this bit, since fewer than 2^30
/// instances fit into memory.
const LONG: u32 = 1 << 30;

/// Marks the end of a list in [`Bins::crowded`].
const END: u32 = u32::MAX;

/// A group of up to eight candidates, unpacked for evaluation.
pub(crate) struct Candidates {
    /// Record index of each candidate; 0 in unused slots.
    pub(crate) records: [u32; GROUP],
    /// 1 for a candidate, 0 for an unused slot.
    pub(crate) ones: [f32; GROUP],
    /// Bit mask of the candidates that have several blocks of axes.
    pub(crate) long: u32,
    /// Index in `crowded` at which the bin's candidates continue; `None` after the last group.
    pub(crate) next: Option<u32>,
}

/// The grid of bins, and the records of the instances.
#[derive(Debug)]
pub(crate) struct Bins {
    /// Numbers of columns and rows of bins.
    size: [usize; 2],
    origin: DVec2,
    /// Number of bins per unit of length, along each axis.
    per_unit: DVec2,
    bins: Vec<Bin>,
    /// For each strip of bins, the record index that the strip's bins are relative to.
    bases: Vec<u32>,
    /// Lists of candidates for bins that cannot hold them. Each list ends with [`END`].
    crowded: Vec<u32>,
    /// First block of axes of each record.
    pub(crate) axes: Vec<AxisBlock>,
    pub(crate) centers: Vec<DVec2>,
    /// Instance index of each record.
    pub(crate) instances: Vec<u32>,
    /// Control point index of each record.
    pub(crate) points: Vec<u32>,
}

impl Bins {
    pub(crate) fn new(net: &Net) -> Self {
        let size = net.domain.size;
        // Choose the side length of square bins for the target number of bins.
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

    /// Returns the numbers of columns and rows of bins.
    pub(crate) fn size(&self) -> [u32; 2] {
        self.size.map(|count| count as u32)
    }

    /// Returns the number of bins per unit of length, along each axis.
    pub(crate) fn per_unit(&self) -> DVec2 {
        self.per_unit
    }

    /// Returns the record indices of all candidates of a bin, in order of summation. Bins are counted row by row.
    pub(crate) fn candidates_in(&self, bin: usize) -> Vec<u32> {
        let mut records = Vec::new();
        let mut candidates = self.first_of_bin(bin / self.size[0], bin % self.size[0]);
        loop {
            let used = candidates.records.iter().zip(candidates.ones);
            records.extend(used.filter(|(_, one)| *one > 0.0).map(|(record, _)| record));
            match candidates.next {
                Some(next) => candidates = self.next_candidates(next),
                None => return records,
            }
        }
    }

    /// Returns the first group of candidates at a position, which must be in the range of [`Net::local`].
    #[inline(always)]
    pub(crate) fn first_candidates(&self, position: DVec2) -> Candidates {
        let row = self.bin(1, position.y);
        self.first_of_bin(row, self.bin(0, position.x))
    }

    /// Returns the first group of candidates of a bin.
    #[inline(always)]
    fn first_of_bin(&self, row: usize, column: usize) -> Candidates {
        let Bin(places) = self.bins[row * self.size[0] + column];
        // Read the index of a crowded bin's list from its two halves.
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

    /// Returns the group of candidates that starts at index `start` of `crowded`.
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
            // The group is full: record where the list continues.
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

    /// Returns the column (axis 0) or row (axis 1) of the bin that contains a coordinate. Coordinates outside of the
    /// grid belong to the border bins.
    #[inline(always)]
    fn bin(&self, axis: usize, coordinate: f64) -> usize {
        // The conversion turns negative numbers into zero.
        let bin = (coordinate - self.origin[axis]) * self.per_unit[axis];
        // There are at most 2^14 bins along an axis.
        (bin as u32 as usize).min(self.size[axis] - 1)
    }

    /// Builds the records, sorted by strip, column and row. Returns the record index of each instance.
    fn place_records(&mut self, net: &Net) -> Vec<u32> {
        // Sort by strip, then by column, so that the candidates of a position are near each other in memory.
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

    /// Lists the candidates of every bin, in the order of the instances. The candidates of bin `b` are
    /// `candidates[offsets[b]..offsets[b + 1]]`.
    fn list_candidates(&self, net: &Net, places: &[u32]) -> (Vec<u32>, Vec<u32>) {
        let (mut bins, mut candidates) = (Vec::new(), Vec::new());
        // Of the bins in the bounds of a support, list the candidate in those that the support itself may touch.
        for (instance, &place) in net.instances.iter().zip(places) {
            let is_long = net.blocks(instance).len() > 1;
            let candidate = if is_long { place | LONG } else { place };
            let [columns, rows] = [0, 1].map(|axis| {
                self.bin(axis, instance.min[axis])..=self.bin(axis, instance.max[axis])
            });
            for row in rows {
                for column in columns.clone() {
                    if self.touches(net, instance, [column, row]) {
                        bins.push((row * self.size[0] + column) as u32);
                        candidates.push(candidate);
                    }
                }
            }
        }
        let sorted = Groups::sort(self.size[0] * self.size[1], &bins);
        let items = sorted.items.iter();
        let candidates = items.map(|&item| candidates[item as usize]).collect();
        (sorted.starts, candidates)
    }

    /// Packs the candidates of each bin, and appends the lists that do not fit to `crowded`.
    fn pack(&mut self, offsets: &[u32], candidates: &[u32]) {
        let of = |bin: usize| &candidates[offsets[bin] as usize..offsets[bin + 1] as usize];
        let n_bins = self.size[0] * self.size[1];
        let per_strip = self.size[0] * STRIP;
        for strip in (0..n_bins).step_by(per_strip) {
            let bins = strip..(strip + per_strip).min(n_bins);
            // Marked candidates are larger than all others, so they do not affect the minimum.
            let base = bins.clone().flat_map(of).min().map_or(0, |&least| least);
            self.bases.push(base);
            for bin in bins {
                let packed = Bin::of(of(bin), base).unwrap_or_else(|| {
                    // Fewer than 2^32 candidates fit into memory.
                    let start = self.crowded.len() as u32;
                    self.crowded.extend_from_slice(of(bin));
                    self.crowded.push(END);
                    Bin::elsewhere(start)
                });
                self.bins.push(packed);
            }
        }
    }

    /// Returns whether an instance's support may intersect a bin. It cannot if some axis has `u <= 0` at all four
    /// corners of the bin; see [`Net`] for `u`.
    fn touches(&self, net: &Net, instance: &Instance, bin: [usize; 2]) -> bool {
        // Offsets of the bin's corners from the control point.
        let [x, y] = [0, 1].map(|axis| {
            self.ends(net, axis, bin[axis])
                .map(|end| (end - instance.center[axis]) as f32)
        });
        // Since u is linear, its largest value is at a corner.
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

    /// Returns the bounds of a bin along an axis, with a margin for rounding.
    fn ends(&self, net: &Net, axis: usize, bin: usize) -> [f64; 2] {
        let (origin, size) = (net.domain.origin[axis], net.domain.size[axis]);
        let side = 1.0 / self.per_unit[axis];
        // Rounding may assign a position to the neighboring bin.
        let slack = side * 1e-6 + (origin.abs() + size) * 1e-15;
        let start = origin + side * bin as f64 - slack;
        let end = origin + side * (bin + 1) as f64 + slack;
        if net.domain.wrap[axis] {
            return [start, end];
        }
        // Border bins of an axis that does not wrap extend to the limits of evaluated positions.
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
