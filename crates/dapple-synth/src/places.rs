//! Sub-pixel sources: the places in the exemplar, between its pixels, that sites are from.
//!
//! A site takes a whole pixel, but lies anywhere beside the sites whose texture it goes on with: so sources are off by half
//! a pixel, and what is read with them has edges that jump from site to site. Here the source of a site is moved to the
//! mean of itself and of what the neighbors predict, a few times. A neighbor predicts its own source, and from there the
//! way to the site in the frame of the texture. One that continues another piece of the exemplar predicts something far
//! away, and has no say.
//!
//! References: our own; that neighbors predict sources is from Michael Ashikhmin, "Synthesizing Natural Textures", I3D
//! 2001, DOI 10.1145/364338.364405.
//!
//! Units: places are in pixels of the exemplar, the middle of the first one at 0, x to the right and y down.

use crate::columns;
use crate::orientation::turned;
use crate::{Edges, Exemplar, Hierarchy, SiteIdx, Symmetry, Synthesizer};
use glam::{DVec2, Vec2, Vec3};

/// How far from each other two predictions of one place may be, in pixels.
pub(crate) const AGREEMENT: f32 = 1.5;

/// The cosine of the angle between the directions of neighbors from which on they are not those of one piece: halfway to a
/// quarter turn.
const SAME_TURN: f32 = 0.707;

/// How often sources are averaged.
pub(crate) const N_STEPS: usize = 8;

/// Places in an exemplar that the finest sites are from.
pub(crate) trait Sourced: Sync {
    /// A place in the exemplar.
    type Place: Copy + Send + Sync;

    /// The source of a site.
    fn of_site(&self, site: usize) -> Self::Place;

    /// The shortest way from one place to another one, in pixels; infinite where there is none.
    fn difference(&self, to: Self::Place, from: Self::Place) -> Vec2;

    /// The place at a way from one.
    fn moved(&self, place: Self::Place, by: Vec2) -> Self::Place;
}

/// The sub-pixel sources of the finest sites.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Places {
    pub(crate) of_site: Vec<Vec2>,
    pub(crate) size: [u32; 2],
    pub(crate) edges: Edges,
}

/// Directions on the surface at a site, in pixels of the exemplar for a length in space.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Frame {
    pub(crate) right: Vec3,
    pub(crate) down: Vec3,
    /// The size of a pixel in spacings.
    pub(crate) scale: f32,
}

/// The frames of the finest sites.
#[derive(Clone, Debug)]
pub(crate) struct Frames {
    pub(crate) of_site: Vec<Frame>,
    /// The quarter turns that neighbors may be off by.
    symmetry: Symmetry,
}

impl Places {
    /// The places of sites that took these pixels.
    pub(crate) fn new(
        hierarchy: &Hierarchy,
        frames: &Frames,
        exemplar: &Exemplar,
        sources: &[u32],
    ) -> Self {
        let [width, _] = exemplar.size;
        let place = |&pixel: &u32| Vec2::new((pixel % width) as f32, (pixel / width) as f32);
        let mut places = Self {
            of_site: sources.iter().map(place).collect(),
            size: exemplar.size,
            edges: exemplar.edges,
        };
        for _ in 0..N_STEPS {
            let averaged = |site: usize| averaged(&places, hierarchy, frames, site);
            let next = columns::column(places.of_site.len(), averaged);
            places.of_site = next;
        }
        places
    }
}

impl Sourced for Places {
    type Place = Vec2;

    #[inline]
    fn of_site(&self, site: usize) -> Vec2 {
        self.of_site[site]
    }

    #[inline]
    fn difference(&self, to: Vec2, from: Vec2) -> Vec2 {
        let way = to - from;
        let size = Vec2::new(self.size[0] as f32, self.size[1] as f32);
        // Mostly there is nothing to take off, and to round is slow without an instruction for it.
        if self.edges == Edges::Cut || way.abs().cmplt(0.5 * size).all() {
            return way;
        }
        way - (way / size).round() * size
    }

    #[inline]
    fn moved(&self, place: Vec2, by: Vec2) -> Vec2 {
        place + by
    }
}

/// The mean of a site's source and those that its neighbors predict, if they agree.
pub(crate) fn averaged<P: Sourced>(
    places: &P,
    hierarchy: &Hierarchy,
    frames: &Frames,
    site: usize,
) -> P::Place {
    let positions = hierarchy.sites().positions();
    let (own, frame) = (places.of_site(site), &frames.of_site[site]);
    let (mut sum, mut count) = (Vec2::ZERO, 1.0);
    let graph = hierarchy.levels()[0].graph();
    for &neighbor in graph.neighbors(SiteIdx(site as u32)) {
        let way = (positions[site] - positions[neighbor.index()]).as_vec3();
        let other = &frames.of_site[neighbor.index()];
        if frames.differ(frame.down, other) {
            continue;
        }
        // Frames turn on the way: the mean of both ends is that of its middle.
        let way = 0.5 * (frame.flat(way) + other.flat(way));
        let predicted = places.moved(places.of_site(neighbor.index()), way);
        let off = places.difference(predicted, own);
        if off.length_squared() < AGREEMENT * AGREEMENT {
            sum += off;
            count += 1.0;
        }
    }
    places.moved(own, sum / count)
}

impl Frame {
    /// A way in space as one in the exemplar.
    #[inline]
    pub(crate) fn flat(&self, way: Vec3) -> Vec2 {
        Vec2::new(way.dot(self.right), way.dot(self.down))
    }
}

impl Frames {
    /// The frames of sites whose exemplar lies turned by these quarter turns, or by none if there are no such numbers.
    pub(crate) fn new(synthesizer: &Synthesizer, quarters: &[u8]) -> Self {
        let (hierarchy, orientation) = (synthesizer.hierarchy(), synthesizer.orientation());
        let spacing = hierarchy.levels()[0].spacing();
        let normals = hierarchy.sites().normals();
        let frame = |site: usize| {
            let quarters = quarters.get(site).copied().unwrap_or(0);
            let scale = synthesizer.scale(site);
            let pixels = 1.0 / (spacing * f64::from(scale));
            let down = turned(orientation.vectors()[site], normals[site], quarters);
            Frame {
                right: (normals[site].cross(down) * pixels).as_vec3(),
                down: (down * pixels).as_vec3(),
                scale,
            }
        };
        Self {
            of_site: (0..normals.len()).map(frame).collect(),
            symmetry: orientation.symmetry(),
        }
    }

    /// How many pixels of the exemplar there is room for.
    pub(crate) fn n_pixels(&self) -> f64 {
        let scales = self.of_site.iter().map(|frame| f64::from(frame.scale));
        scales.map(|scale| 1.0 / (scale * scale)).sum()
    }

    /// By how many quarter turns the exemplar at one site lies turned from how it lies at another one.
    #[inline]
    pub(crate) fn quarters_between(&self, from: usize, to: usize) -> u8 {
        let (own, other) = (&self.of_site[from], self.of_site[to].down);
        let along = |axis: Vec3| f64::from(other.dot(axis));
        self.symmetry
            .quarters_to(DVec2::new(along(own.down), along(own.right)))
    }

    /// Whether the exemplar lies turned at a site, seen from where its down is this direction of any length.
    #[inline]
    pub(crate) fn differ(&self, down: Vec3, other: &Frame) -> bool {
        let lengths = down.length_squared() * other.down.length_squared();
        self.symmetry != Symmetry::One && down.dot(other.down) < SAME_TURN * lengths.sqrt()
    }
}
