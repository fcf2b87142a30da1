//! Positions on a source surface, which are the sources of a lifted texture.

use crate::detail::Detail;
use crate::magnify::footprints;
use crate::places::{self, Frame, Frames, Sourced};
use crate::{Edges, Hierarchy, Options, Sources, SynthError, SynthErrorKind, Synthesizer, columns};
use dapple_mesh::{SurfacePoint, Walk};
use dapple_raster::Raster;
use glam::{DVec2, DVec3, Vec2, Vec3};
use std::sync::Arc;

/// Maximum difference between the distance of two positions in space and their distance along the surface, in pixels.
/// If the distance in space is larger by more, the positions are on different sheets.
const SHEETS: f32 = 1.0;

/// Maximum absolute texture coordinate, for which texel indices of any map fit an integer.
const UV_MAX: f64 = 1e6;

/// Source surface of a lifted texture.
#[derive(Clone, Debug)]
pub(crate) struct Origin {
    pub(crate) synthesizer: Synthesizer,
    /// Texture coordinates of the corners of each face, with integer offsets removed.
    pub(crate) uvs: Vec<[DVec2; 3]>,
    /// Edge mode of the texture.
    pub(crate) edges: Edges,
    frames: Vec<Frame>,
    /// Spacing of the finest sites, in units of the mesh.
    spacing: f32,
}

/// A position on the source: a finest site and an offset in the site's frame, in pixels.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Place {
    pub(crate) site: u32,
    pub(crate) off: Vec2,
}

/// Sources of a texture's finest sites.
#[derive(Clone, Debug)]
pub(crate) struct LiftedPlaces {
    pub(crate) origin: Arc<Origin>,
    pub(crate) of_site: Vec<Place>,
    /// Whether texels interpolate the values of sites, as in the paper, instead of sampling the source's maps.
    pub(crate) is_mixed: bool,
}

impl Origin {
    pub(super) fn new(
        synthesizer: Synthesizer,
        uvs: &[[DVec2; 3]],
        edges: Edges,
    ) -> Result<Self, SynthError> {
        if uvs.len() != synthesizer.surface().mesh().faces().len() {
            return Err(SynthError::new(SynthErrorKind::Count {
                what: "faces with uv",
                count: uvs.len(),
                needed: "as many as the mesh has",
            }));
        }
        let parts = uvs.iter().flatten().flat_map(DVec2::to_array);
        for part in parts {
            let holds = part.abs() <= UV_MAX;
            SynthError::check(holds, "texture coordinate", part, "from -1e6 to 1e6")?;
        }
        let place = |uvs: &[DVec2; 3]| {
            // Move the face to the unit square of its centroid.
            let turns = ((uvs[0] + uvs[1] + uvs[2]) / 3.0).floor();
            uvs.map(|uv| uv - turns)
        };
        let synthesizer = synthesizer.without_scales();
        let spacing = synthesizer.hierarchy().levels()[0].spacing();
        Ok(Self {
            uvs: uvs.iter().map(place).collect(),
            edges,
            frames: Frames::new(&synthesizer, &[]).of_site,
            spacing: spacing as f32,
            synthesizer,
        })
    }

    pub(crate) fn hierarchy(&self) -> &Hierarchy {
        self.synthesizer.hierarchy()
    }

    /// Walks from the site of `place` by its offset. Returns the surface point, and the source's down direction there,
    /// in the plane of its face.
    pub(crate) fn walk(&self, place: Place) -> Walk {
        let surface = self.synthesizer.surface();
        let point = self.hierarchy().sites().points()[place.site as usize];
        let orientation = self.synthesizer.orientation().vectors()[place.site as usize];
        // Express the offset in the plane of the site's face.
        let down = surface
            .flatten(point.face, orientation)
            .normalize_or(DVec2::X);
        let off = place.off.as_dvec2();
        // The paper's P (right) is O (down) rotated by a quarter turn counterclockwise.
        let way = down.perp() * off.x + down * off.y;
        let length = way.length();
        if length == 0.0 {
            return Walk {
                point,
                direction: down,
                left: 0.0,
            };
        }
        let along = way / length;
        let walk = surface.walk(point, along, length * f64::from(self.spacing));
        Walk {
            // Rotate the direction of the walk's end by the angle from the offset to down.
            direction: DVec2::new(along.dot(down), along.perp_dot(down)).rotate(walk.direction),
            ..walk
        }
    }

    /// Returns the texture coordinates at `point`.
    pub(crate) fn uv(&self, point: SurfacePoint) -> DVec2 {
        let weights = self.synthesizer.surface().weights(point);
        let corners = self.uvs[point.face.index()].iter().zip(weights);
        corners.map(|(&uv, weight)| uv * weight).sum()
    }

    /// Returns the side length of a pixel on each face, in texels of a map of the given size; 0 for a face without an
    /// area in the map.
    pub(crate) fn texels(&self, size: [u32; 2]) -> Vec<f32> {
        let sides = footprints(&self.synthesizer, &self.uvs, size).into_iter();
        sides
            .map(|side| if side > 0.0 { 1.0 / side } else { 0.0 })
            .collect()
    }

    /// Returns the offset from `from` to `to`, two nearby finest sites, in pixels.
    pub(super) fn step(&self, to: u32, from: u32) -> Vec2 {
        let [to_place, from_place] = [to, from].map(|site| Place {
            site,
            off: Vec2::ZERO,
        });
        self.flat(self.way(to_place, from_place), to, from)
    }

    /// Converts `way`, an offset in space between two sites, to pixels. Frames rotate along the way, so the mean of the
    /// offsets in both frames approximates the offset in the frame halfway.
    fn flat(&self, way: Vec3, to: u32, from: u32) -> Vec2 {
        let [to, from] = [to, from].map(|site| self.frames[site as usize].flat(way));
        0.5 * (from + to)
    }

    /// Returns the offset in space from the position `from` to the position `to`.
    fn way(&self, to: Place, from: Place) -> Vec3 {
        let positions = self.hierarchy().sites().positions();
        let [to_at, from_at] = [to, from].map(|place| positions[place.site as usize]);
        // The axes of a frame have the length 1 / spacing, and a pixel has the length of a spacing.
        let scale = self.spacing * self.spacing;
        let [to_off, from_off] = [to, from].map(|Place { site, off }| {
            let frame = &self.frames[site as usize];
            (frame.right * off.x + frame.down * off.y) * scale
        });
        (to_at - from_at).as_vec3() + (to_off - from_off)
    }
}

impl LiftedPlaces {
    /// Creates the source positions of sites from their matched source sites. With sub-pixel sources, positions are
    /// averaged with their neighbors' predictions.
    pub(super) fn new(
        hierarchy: &Hierarchy,
        frames: &Frames,
        origin: &Arc<Origin>,
        sources: &[u32],
        options: &Options,
    ) -> Self {
        let place = |&site: &u32| Place {
            site,
            off: Vec2::ZERO,
        };
        let mut lifted = Self {
            origin: Arc::clone(origin),
            of_site: sources.iter().map(place).collect(),
            is_mixed: options.sources == Sources::Pixel,
        };
        if !lifted.is_mixed {
            // All positions move at once (Jacobi iteration), so the order of the sites has no effect.
            for _ in 0..places::N_STEPS {
                let averaged = |site: usize| places::averaged(&lifted, hierarchy, frames, site);
                lifted.of_site = columns::column(sources.len(), averaged);
            }
        }
        lifted
    }

    /// Returns the texel of `map` nearest to the source position of every site.
    pub(crate) fn transfer<T: Copy>(&self, map: &Raster<T>) -> Vec<T> {
        let size = map.size().map(f64::from);
        let wrap = self.origin.edges.wrap();
        let pixel = |&place: &Place| {
            let uv = self.origin.uv(self.origin.walk(place).point);
            let [column, row] = [uv.x * size[0], uv.y * size[1]].map(|at| at.floor() as i64);
            *map.at(column, row, [wrap; 2])
        };
        self.of_site.iter().map(pixel).collect()
    }
}

impl PartialEq for LiftedPlaces {
    /// Compares the positions and the identity of the source. Two equal copies of a source are different.
    fn eq(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.origin, &other.origin)
            && self.of_site == other.of_site
            && self.is_mixed == other.is_mixed
    }
}

impl Sourced for LiftedPlaces {
    type Place = Place;

    #[inline]
    fn of_site(&self, site: usize) -> Place {
        self.of_site[site]
    }

    fn difference(&self, to: Place, from: Place) -> Vec2 {
        if to.site == from.site {
            return to.off - from.off;
        }
        let normals = self.origin.hierarchy().sites().normals();
        let [to_normal, from_normal] = [to, from].map(|place| normals[place.site as usize]);
        let way = self.origin.way(to, from);
        let flat = self.origin.flat(way, to.site, from.site);
        // Positions on different sheets are infinitely far apart.
        let is_far = way.length() > (flat.length() + SHEETS) * self.origin.spacing;
        if is_far || DVec3::dot(to_normal, from_normal) < 0.0 {
            return Vec2::INFINITY;
        }
        flat
    }

    #[inline]
    fn moved(&self, place: Place, by: Vec2) -> Place {
        Place {
            off: place.off + by,
            ..place
        }
    }
}

/// Samples a map of the source at points of its surface.
pub(crate) struct LiftedDetail<'a, const N: usize> {
    origin: &'a Origin,
    detail: Detail<N>,
    size: DVec2,
    texels: Vec<f32>,
}

impl<'a, const N: usize> LiftedDetail<'a, N> {
    /// Prepares `map`, which may have any size, for sampling in the source's texture coordinates.
    pub(crate) fn new(map: Raster<[f32; N]>, origin: &'a Origin) -> Result<Self, SynthError> {
        let size = map.size();
        Ok(Self {
            origin,
            size: DVec2::from(size.map(f64::from)),
            texels: origin.texels(size),
            detail: Detail::new(map, size, origin.edges)?,
        })
    }

    /// Returns the filtered value at `point`. `footprint` is the side length of the square filter region, in pixels.
    pub(crate) fn sample(&self, point: SurfacePoint, footprint: f32) -> [f32; N] {
        let at = self.origin.uv(point) * self.size - 0.5;
        self.detail
            .sample(at.as_vec2(), footprint * self.texels[point.face.index()])
    }
}
