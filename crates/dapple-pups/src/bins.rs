//! A grid of bins that says which control points can have a weight where.
//!
//! Every bin lists the control points, and images of them, whose supports reach into it, in the order in which weights
//! are summed; so the time for a position does not depend on the number of points. The grid covers the domain. On an
//! axis that does not wrap, the bins of the border reach out as far as there are positions.
//!
//! With many points, that time is spent waiting for memory. So a bin is a small group of indices in one place, and what
//! they stand for lies in memory along a Z-shaped curve through the plane: the candidates of a position are near each
//! other whatever the order of the points.

use crate::net::{AxisBlock, BLOCK, Instance, Net};
use glam::DVec2;

/// How many bins there are for each instance: more bins, fewer candidates in each. With 4, a position has some 6
/// candidates, of which 4 have a weight, and seldom more than a group holds.
const BINS_PER_INSTANCE: f64 = 4.0;

/// The most bins along one axis.
const BINS_LIMIT: f64 = 16_384.0;

/// How many candidates are evaluated together.
pub(crate) const GROUP: usize = 8;

/// Up to eight candidates, in their order. The last one may be the index of the group that goes on, with the bit
/// [`Group::NEXT`].
#[derive(Clone, Copy, Debug)]
#[repr(align(32))]
pub(crate) struct Group([u32; GROUP]);

impl Group {
    /// Stands for no candidate.
    const NONE: u32 = u32::MAX;
    /// Marks the index of a group.
    const NEXT: u32 = 1 << 31;
    /// Marks a candidate with more axes than a block holds.
    const LONG: u32 = 1 << 30;

    /// A group without candidates.
    const EMPTY: Self = Self([Self::NONE; GROUP]);

    /// The records of the candidates; the first of all where there is no candidate.
    #[inline(always)]
    pub(crate) fn records(&self) -> [u32; GROUP] {
        self.0.map(|entry| {
            if entry < Self::NEXT {
                entry & !Self::LONG
            } else {
                0
            }
        })
    }

    /// Whether there is a candidate.
    #[inline(always)]
    pub(crate) fn has(&self, lane: usize) -> bool {
        self.0[lane] < Self::NEXT
    }

    /// One for a candidate, zero for none.
    #[inline(always)]
    pub(crate) fn ones(&self) -> [f32; GROUP] {
        self.0
            .map(|entry| if entry < Self::NEXT { 1.0 } else { 0.0 })
    }

    /// Whether a candidate has more axes than a block holds.
    #[inline(always)]
    pub(crate) fn is_long(&self, lane: usize) -> bool {
        self.has(lane) && self.0[lane] & Self::LONG != 0
    }

    /// Whether one of the candidates has more axes than a block holds.
    #[inline(always)]
    pub(crate) fn has_long(&self) -> bool {
        let mut long = false;
        for &entry in &self.0 {
            long |= entry & (Self::LONG | Self::NEXT) == Self::LONG;
        }
        long
    }

    /// The group that goes on.
    #[inline(always)]
    fn next(&self) -> Option<usize> {
        let last = self.0[GROUP - 1];
        (last >= Self::NEXT && last != Self::NONE).then_some((last & !Self::NEXT) as usize)
    }
}

/// The grid, and what it knows of instances: their records.
#[derive(Debug)]
pub(crate) struct Bins {
    size: [usize; 2],
    origin: DVec2,
    /// Bins per unit of length.
    per_unit: DVec2,
    /// The first group of each bin, and then those that go on.
    groups: Vec<Group>,
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
            groups: Vec::new(),
            axes: Vec::new(),
            centers: Vec::new(),
            instances: Vec::new(),
            points: Vec::new(),
        };
        let places = bins.place_records(net);
        bins.list_candidates(net, &places);
        bins
    }

    /// The candidates at a position (which [`Net::local`] has brought into range), group by group.
    #[inline(always)]
    pub(crate) fn first_group(&self, position: DVec2) -> &Group {
        &self.groups[self.bin(1, position.y) * self.size[0] + self.bin(0, position.x)]
    }

    /// The candidates that come after those of a group.
    #[inline(always)]
    pub(crate) fn next_group(&self, group: &Group) -> Option<&Group> {
        group.next().map(|next| &self.groups[next])
    }

    /// The bin of a coordinate along an axis; what lies outside belongs to the border.
    #[inline(always)]
    fn bin(&self, axis: usize, coordinate: f64) -> usize {
        // A negative number becomes zero.
        let bin = (coordinate - self.origin[axis]) * self.per_unit[axis];
        // There are at most 2^14 bins along an axis.
        (bin as u32 as usize).min(self.size[axis] - 1)
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
            self.axes.push(blocks[0]);
            self.centers.push(instance.center);
            self.instances.push(index);
            self.points.push(instance.point);
        }
        places
    }

    /// Lists the candidates of every bin, in the order of the instances.
    fn list_candidates(&mut self, net: &Net, places: &[u32]) {
        self.groups = vec![Group::EMPTY; self.size[0] * self.size[1]];
        // Of each bin, its last group and how much of it is used.
        let mut ends: Vec<(u32, u32)> = (0..self.groups.len() as u32).map(|bin| (bin, 0)).collect();
        for (instance, &place) in net.instances.iter().zip(places) {
            let is_long = net.blocks(instance).len() > 1;
            let entry = if is_long { place | Group::LONG } else { place };
            let [columns, rows] = [0, 1].map(|axis| {
                self.bin(axis, instance.min[axis])..=self.bin(axis, instance.max[axis])
            });
            for row in rows {
                for column in columns.clone() {
                    if self.touches(net, instance, [column, row]) {
                        self.push(&mut ends[row * self.size[0] + column], entry);
                    }
                }
            }
        }
    }

    /// Adds a candidate to a bin that ends in a given group.
    fn push(&mut self, (group, used): &mut (u32, u32), entry: u32) {
        if *used as usize == GROUP {
            // There are less than 2^28 bins, and less than 2^30 instances in the memory of any machine.
            let next = self.groups.len() as u32;
            let last = &mut self.groups[*group as usize].0[GROUP - 1];
            let mut group_after = Group::EMPTY;
            group_after.0[0] = core::mem::replace(last, next | Group::NEXT);
            self.groups.push(group_after);
            (*group, *used) = (next, 1);
        }
        self.groups[*group as usize].0[*used as usize] = entry;
        *used += 1;
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
