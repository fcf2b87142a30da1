//! A grid of bins that says which control points can have a weight where.
//!
//! Every bin lists the control points, and images of them, whose supports reach into it, in the order in which weights
//! are summed; so the time for a position does not depend on the number of points. The grid covers the domain. On an
//! axis that does not wrap, the bins of the border reach out as far as there are positions.
//!
//! What a position needs of a candidate is one [`Record`]. Records lie in memory along a Z-shaped curve through the plane,
//! so that the candidates of a position are near each other whatever the order of the points.

use crate::net::{AxisBlock, BLOCK, Instance, Net};
use glam::DVec2;

/// How many bins there are for each instance: more bins, fewer candidates in each. With 3, a position has some 7
/// candidates, of which 4 have a weight.
const BINS_PER_INSTANCE: f64 = 3.0;

/// The most bins along one axis.
const BINS_LIMIT: f64 = 16_384.0;

/// A candidate: a control point, or an image of one.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Record {
    /// Its first axes; not an [`AxisBlock`], whose alignment would make a record fill two cache lines.
    pub(crate) x: [f32; BLOCK],
    pub(crate) y: [f32; BLOCK],
    pub(crate) center: DVec2,
    /// Its place among the instances.
    pub(crate) instance: u32,
    /// The control point.
    pub(crate) point: u32,
    /// Whether it has more axes than the first ones.
    pub(crate) has_more: bool,
}

/// The grid.
#[derive(Debug)]
pub(crate) struct Bins {
    size: [usize; 2],
    origin: DVec2,
    /// Bins per unit of length.
    per_unit: DVec2,
    /// The candidates of bin `b` are `candidates[offsets[b]..offsets[b + 1]]`, each the index of a record.
    offsets: Vec<u32>,
    candidates: Vec<u32>,
    records: Vec<Record>,
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
            offsets: Vec::new(),
            candidates: Vec::new(),
            records: Vec::new(),
        };
        let places = bins.place_records(net);
        bins.list_candidates(net, &places);
        bins
    }

    /// The candidates at a position (which [`Net::local`] has brought into range), as indices of records.
    #[inline(always)]
    pub(crate) fn candidates(&self, position: DVec2) -> &[u32] {
        let bin = self.bin(1, position.y) * self.size[0] + self.bin(0, position.x);
        let (start, end) = (self.offsets[bin] as usize, self.offsets[bin + 1] as usize);
        &self.candidates[start..end]
    }

    #[inline(always)]
    pub(crate) fn record(&self, candidate: u32) -> &Record {
        &self.records[candidate as usize]
    }

    /// The bin of a coordinate along an axis; what lies outside belongs to the border.
    #[inline(always)]
    fn bin(&self, axis: usize, coordinate: f64) -> usize {
        // A negative number becomes zero.
        let bin = (coordinate - self.origin[axis]) * self.per_unit[axis];
        (bin as usize).min(self.size[axis] - 1)
    }

    /// Makes the records, along the curve. Returns the record of each instance.
    fn place_records(&mut self, net: &Net) -> Vec<u32> {
        let key = |instance: &Instance| {
            // There are at most 2^14 bins along an axis.
            let [column, row] = [0, 1].map(|axis| self.bin(axis, instance.center[axis]) as u32);
            spread_bits(column) | spread_bits(row) << 1
        };
        let mut order: Vec<(u32, u32)> = net.instances.iter().map(key).zip(0..).collect();
        order.sort_unstable();
        let mut places = vec![0; order.len()];
        for (place, &(_, index)) in (0..).zip(&order) {
            let instance = &net.instances[index as usize];
            let blocks = net.blocks(instance);
            places[index as usize] = place;
            self.records.push(Record {
                x: blocks[0].x,
                y: blocks[0].y,
                center: instance.center,
                instance: index,
                point: instance.point,
                has_more: blocks.len() > 1,
            });
        }
        places
    }

    /// Lists the candidates of every bin, in the order of the instances.
    fn list_candidates(&mut self, net: &Net, places: &[u32]) {
        let mut entries = Vec::new();
        self.offsets = vec![0; self.size[0] * self.size[1] + 1];
        for (instance, &place) in net.instances.iter().zip(places) {
            let [columns, rows] = [0, 1].map(|axis| {
                self.bin(axis, instance.min[axis])..=self.bin(axis, instance.max[axis])
            });
            for row in rows {
                for column in columns.clone() {
                    if self.touches(net, instance, [column, row]) {
                        let bin = row * self.size[0] + column;
                        // There are at most 2^28 bins.
                        entries.push((bin as u32, place));
                        self.offsets[bin + 1] += 1;
                    }
                }
            }
        }
        for bin in 1..self.offsets.len() {
            self.offsets[bin] += self.offsets[bin - 1];
        }
        let mut next = self.offsets.clone();
        self.candidates = vec![0; entries.len()];
        for (bin, place) in entries {
            let next = &mut next[bin as usize];
            self.candidates[*next as usize] = place;
            *next += 1;
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

/// The lower 16 bits, each with a zero before it.
fn spread_bits(bits: u32) -> u32 {
    let bits = (bits | bits << 8) & 0x00FF_00FF;
    let bits = (bits | bits << 4) & 0x0F0F_0F0F;
    let bits = (bits | bits << 2) & 0x3333_3333;
    (bits | bits << 1) & 0x5555_5555
}
