//! Synthesis on a plane or a torus: the passes of surface synthesis, with pixels as sites.
//!
//! References: Li-Yi Wei and Marc Levoy, "Fast Texture Synthesis using Tree-structured Vector Quantization", SIGGRAPH
//! 2000, DOI 10.1145/344779.345009, for the plane; Greg Turk, "Texture Synthesis on Surfaces", SIGGRAPH 2001, DOI
//! 10.1145/383259.383297, for the passes.
//!
//! Every pixel of the texture is a site. Neighborhoods are read directly from the pixel grid. Only values of the
//! coarser level are interpolated, at half pixels. A level has half as many pixels along each axis as the next finer
//! one, rounded up.
//!
//! The sweep visits sites in scanline order. If rows wrap, this order is a single chain around the torus, because each
//! pixel depends on the one before it. On such rows the coarsest level keeps the scanline order. Finer levels, where
//! every pixel has a color before the sweep refines it, use slanted wavefronts instead. These run on all cores, and
//! change the texture no more than another seed does.

mod enlarge;
mod pieces;
mod repair;
mod tile;

pub use repair::repair_levels;

use crate::candidates::halves;
use crate::detail;
use crate::domain::{Colors, Samples, Square, Start, SynthesisDomain, UNKNOWN};
use crate::engine::{self, Callback, Progress};
use crate::grid::{self, Grid};
use crate::guides::Targets;
use crate::neighborhood::Reads;
use crate::wavefront::WavefrontSchedule;
use crate::{CoarserCenter, Edges, Exemplar, Options, Pyramid, SynthError, SynthErrorKind};
use core::ops::ControlFlow;
use dapple_raster::{Raster, Wrap};

pub use tile::tile_plane;

/// Maximum number of pixels of a texture. Synthesis needs about 200 bytes per pixel.
const MAX_PIXELS: u64 = 1 << 26;

/// Slant of a wavefront, in columns to the left per row: one more than the reach of a 7 × 7 neighborhood.
const SLANT: u32 = 4;

/// A texture in the plane, stored as the source pixel in the exemplar for every texture pixel.
#[derive(Clone, Debug, PartialEq)]
pub struct PlaneTexture {
    sources: Raster<[u32; 2]>,
    edges: [Edges; 2],
    exemplar_size: [u32; 2],
    exemplar_edges: Edges,
}

/// Synthesizes a texture of `size` pixels, at most 2^26 in total, that looks like an exemplar.
///
/// `edges` sets the boundary handling of columns and rows: [`Edges::Wrap`] makes the texture tile seamlessly along that
/// axis.
///
#[cfg_attr(doc, doc = include_str!("../docs/synthesize-plane.md"))]
///
/// # Errors
///
/// If the exemplar is too small, options are out of range, there are zero or too many pixels, or a wrapping side is not
/// divisible by 2^(number of levels - 1).
///
/// # Examples
///
/// ```
/// use dapple_raster::Raster;
/// use dapple_synth::{Edges, Exemplar, Options, synthesize_plane};
///
/// let checker = Raster::from_fn([16, 16], |x, y| f32::from((x / 4 + y / 4) % 2 == 0))?;
/// let exemplar = Exemplar::from_planes(&[(&checker, 1.0)], Edges::Wrap)?;
/// let texture = synthesize_plane(&exemplar, [24, 20], [Edges::Wrap; 2], &Options::default())?;
/// assert_eq!(texture.transfer(&checker)?.size(), [24, 20]);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn synthesize_plane(
    exemplar: &Exemplar,
    size: [u32; 2],
    edges: [Edges; 2],
    options: &Options,
) -> Result<PlaneTexture, SynthError> {
    synthesize_plane_with(
        exemplar,
        size,
        edges,
        options,
        |_| ControlFlow::Continue(()),
    )
}

/// Synthesizes a texture like [`synthesize_plane`], with a callback that receives the progress and can cancel.
///
/// # Errors
///
/// Same as [`synthesize_plane`], or [`SynthErrorKind::Cancelled`](crate::SynthErrorKind::Cancelled) if the callback
/// breaks.
pub fn synthesize_plane_with(
    exemplar: &Exemplar,
    size: [u32; 2],
    edges: [Edges; 2],
    options: &Options,
    mut callback: impl FnMut(Progress) -> ControlFlow<()>,
) -> Result<PlaneTexture, SynthError> {
    let pyramid = exemplar.pyramid(options.n_levels)?;
    let domain = PlaneDomain::new(size, edges, options)?;
    PlaneTexture::grown(&domain, &pyramid, options, &mut callback)
}

/// Synthesizes a texture like [`synthesize_plane_with`], controlled by guides: planes that match parts of the texture
/// with parts of the exemplar. The exemplar must have the same number of [guides](Exemplar::with_guides). The texture
/// has the size of the planes.
///
/// [`Options::evenness`] has no effect.
///
/// # Errors
///
/// Same as [`synthesize_plane_with`]; [`SynthErrorKind::Count`](crate::SynthErrorKind::Count) if there are no guides,
/// or if their number differs from the exemplar's; [`SynthErrorKind::Raster`](crate::SynthErrorKind::Raster) if their
/// sizes differ; and [`SynthErrorKind::NotFinite`](crate::SynthErrorKind::NotFinite) if a value is not finite.
///
/// # Examples
///
/// ```
/// use core::ops::ControlFlow;
/// use dapple_raster::Raster;
/// use dapple_synth::{Edges, Exemplar, Options, synthesize_plane_guided};
///
/// // Stripes, narrow on the left and wide on the right; the texture has the wide ones at the top.
/// let stripes = Raster::from_fn([64, 32], |x, y| match x < 32 {
///     true => f32::from(y / 2 % 2 == 0),
///     false => f32::from(y / 4 % 2 == 0),
/// })?;
/// let is_wide = Raster::from_fn([64, 32], |x, _| f32::from(x >= 32))?;
/// let exemplar = Exemplar::from_planes(&[(&stripes, 1.0)], Edges::Cut)?.with_guides(&[(&is_wide, 1.0)])?;
/// let wanted = Raster::from_fn([48, 48], |_, y| f32::from(y < 24))?;
/// let texture = synthesize_plane_guided(
///     &exemplar,
///     &[&wanted],
///     [Edges::Cut; 2],
///     &Options::default(),
///     |_| ControlFlow::Continue(()),
/// )?;
/// assert!(texture.sources().row(12)[24][0] >= 32);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn synthesize_plane_guided(
    exemplar: &Exemplar,
    guides: &[&Raster<f32>],
    edges: [Edges; 2],
    options: &Options,
    mut callback: impl FnMut(Progress) -> ControlFlow<()>,
) -> Result<PlaneTexture, SynthError> {
    let Some(first) = guides.first() else {
        return Err(SynthError::new(SynthErrorKind::Count {
            what: "guides",
            count: 0,
            needed: "at least 1",
        }));
    };
    let pyramid = exemplar.pyramid(options.n_levels)?;
    let mut domain = PlaneDomain::new(first.size(), edges, options)?;
    let targets = Targets::of_plane(exemplar, guides, &domain.sizes, domain.wrap)?;
    domain.targets = Some(targets);
    PlaneTexture::grown(&domain, &pyramid, options, &mut callback)
}

impl PlaneTexture {
    /// Runs the passes of a synthesis and returns the texture.
    fn grown(
        domain: &PlaneDomain,
        pyramid: &Pyramid,
        options: &Options,
        callback: Callback<'_>,
    ) -> Result<Self, SynthError> {
        let mut levels = engine::run(domain, pyramid, options, callback)?;
        let exemplar = &pyramid.levels()[0];
        let width = exemplar.size[0];
        let sources = levels.swap_remove(0).into_iter();
        let sources = sources
            .map(|pixel| [pixel % width, pixel / width])
            .collect();
        Ok(Self {
            sources: Raster::from_vec(domain.sizes[0], sources)?,
            edges: domain.edges,
            exemplar_size: exemplar.size,
            exemplar_edges: exemplar.edges,
        })
    }

    /// Creates a texture from the [`sources`](Self::sources) of an earlier synthesis, for example to transfer further
    /// maps.
    ///
    /// `exemplar_size` is in pixels. `edges` and `exemplar_edges` set the boundary handling of the texture and of the
    /// exemplar.
    ///
    /// # Errors
    ///
    /// [`SynthErrorKind::Source`](crate::SynthErrorKind::Source) if a source is outside the exemplar.
    pub fn from_sources(
        sources: Raster<[u32; 2]>,
        edges: [Edges; 2],
        exemplar_size: [u32; 2],
        exemplar_edges: Edges,
    ) -> Result<Self, SynthError> {
        let is_outside = |source: &[u32; 2]| (0..2).any(|axis| source[axis] >= exemplar_size[axis]);
        match sources.pixels().iter().find(|source| is_outside(source)) {
            Some(&source) => Err(SynthError::new(SynthErrorKind::Source {
                source,
                exemplar: exemplar_size,
            })),
            None => Ok(Self {
                sources,
                edges,
                exemplar_size,
                exemplar_edges,
            }),
        }
    }

    /// Returns the source of each pixel: column and row in the exemplar.
    #[must_use]
    pub fn sources(&self) -> &Raster<[u32; 2]> {
        &self.sources
    }

    /// Transfers a map of the exemplar to the texture: every pixel gets the map's value at its source. The exemplar's
    /// image yields the texture's colors; maps of height, normals or roughness follow the same sources.
    ///
    /// The map's size may be an integer multiple of the exemplar's, such as the photograph that the exemplar was
    /// downsampled from. The result is then larger than the texture by the same factor, and has all the detail of the
    /// map without further synthesis. Each of its pixels is a pixel of the map: neighbors from one contiguous piece of
    /// the exemplar are copied as a whole, and the border between two pieces is smooth.
    ///
    /// # Errors
    ///
    /// [`SynthErrorKind::Detail`](crate::SynthErrorKind::Detail) if the map's size is not a multiple of the exemplar's,
    /// [`SynthErrorKind::Raster`](crate::SynthErrorKind::Raster) if the result would be too large.
    pub fn transfer<T: Copy + Send + Sync>(
        &self,
        map: &Raster<T>,
    ) -> Result<Raster<T>, SynthError> {
        let factor = detail::factor(map.size(), self.exemplar_size)?;
        if factor == 1 {
            let pixel = |&[column, row]: &[u32; 2]| map.row(row)[column as usize];
            return Ok(self.sources.map(pixel));
        }
        let size = self.sources.size().map(|side| side.saturating_mul(factor));
        let magnified = enlarge::Enlarged {
            sources: &self.sources,
            wrap: self.edges.map(Edges::wrap),
            size: self.exemplar_size.map(i64::from),
            edges: self.exemplar_edges,
            factor: i64::from(factor),
        };
        Ok(Raster::from_rows(size, |row| {
            let source = move |column| magnified.source([column, row]);
            let sources = (0..size[0]).map(source);
            sources.map(|[column, row]| map.row(row)[column as usize])
        })?)
    }
}

/// Fails if a size has zero pixels or more than [`MAX_PIXELS`].
pub(crate) fn check_pixels(size: [u32; 2]) -> Result<(), SynthError> {
    let n_pixels = u64::from(size[0]) * u64::from(size[1]);
    let holds = (1..=MAX_PIXELS).contains(&n_pixels);
    SynthError::check(holds, "number of pixels", n_pixels as f64, "from 1 to 2^26")
}

/// Pixels of the texture on all levels, as sites for the engine.
#[derive(Clone, Debug)]
struct PlaneDomain {
    /// Sizes of the levels in pixels, the finest first.
    sizes: Vec<[u32; 2]>,
    edges: [Edges; 2],
    wrap: [Wrap; 2],
    center: CoarserCenter,
    /// Initial pixels of the sites of each level, for repairs; empty for other syntheses, which start from random
    /// pixels.
    starts: Vec<Start>,
    targets: Option<Targets>,
}

impl PlaneDomain {
    fn new(size: [u32; 2], edges: [Edges; 2], options: &Options) -> Result<Self, SynthError> {
        check_pixels(size)?;
        let halvings = options.n_levels.saturating_sub(1).min(31) as u32;
        for (side, edges) in size.into_iter().zip(edges) {
            let holds = edges == Edges::Cut || side % (1 << halvings) == 0;
            let range = "divisible by 2 once per level but the last";
            SynthError::check(holds, "side of a wrapping texture", side.into(), range)?;
        }
        let halved = |size: &[u32; 2]| Some(size.map(|side| side.div_ceil(2)));
        let sizes = core::iter::successors(Some(size), halved);
        Ok(Self {
            sizes: sizes.take(options.n_levels).collect(),
            edges,
            wrap: edges.map(Edges::wrap),
            center: options.center,
            starts: Vec::new(),
            targets: None,
        })
    }

    /// Returns the index of the site at a column and row, wrapped where the edge wraps; `None` past a cut edge.
    fn index(&self, level: usize, place: [i64; 2]) -> Option<usize> {
        let size = self.sizes[level];
        let mut at = [0; 2];
        for axis in 0..2 {
            let side = i64::from(size[axis]);
            at[axis] = match self.edges[axis] {
                Edges::Wrap => place[axis].rem_euclid(side),
                Edges::Cut if (0..side).contains(&place[axis]) => place[axis],
                Edges::Cut => return None,
            };
        }
        Some((at[1] * i64::from(size[0]) + at[0]) as usize)
    }

    /// Marks the sites of a square that are past a cut edge as [`UNKNOWN`].
    fn leave_out_mirrored(&self, halves: [i64; 2], square: &Square, nearest: &mut [u32]) {
        let side = square.side();
        let [first_x, first_y] = halves.map(|at| at.div_euclid(2) - i64::from(square.half));
        for (y, row) in (first_y..).zip(nearest.chunks_exact_mut(side)) {
            for (x, nearest) in (first_x..).zip(row) {
                if self.index(square.reads, [x, y]).is_none() {
                    *nearest = UNKNOWN;
                }
            }
        }
    }

    /// Returns the column and row of a site.
    fn pixel(&self, level: usize, site: u32) -> [u32; 2] {
        let width = self.sizes[level][0];
        [site % width, site / width]
    }
}

impl SynthesisDomain for PlaneDomain {
    /// Half-side length of neighborhoods on the level itself, in pixels.
    type Prepared = i32;
    type Memory = ();

    fn n_sites(&self, level: usize) -> usize {
        let [width, height] = self.sizes[level];
        width as usize * height as usize
    }

    fn start(&self, level: usize) -> Option<&Start> {
        self.starts.get(level)
    }

    fn targets(&self) -> Option<&Targets> {
        self.targets.as_ref()
    }

    fn parent(&self, level: usize, site: u32) -> Option<(u32, [i64; 2])> {
        let [coarser_width, _] = *self.sizes.get(level + 1)?;
        let [column, row] = self.pixel(level, site);
        // The parent of G_k(i, j) is G_k+1(i / 2, j / 2) (section 3).
        let parent = row / 2 * coarser_width + column / 2;
        Some((parent, [column, row].map(|at| i64::from(at % 2))))
    }

    fn order(&self, level: usize) -> Vec<u32> {
        let n_sites = self.n_sites(level) as u32;
        // A repair visits only the sites of its holes.
        if let Some(start) = self.start(level) {
            return repair::order(start, self.sizes[level][0]);
        }
        // Rows that do not wrap, and the coarsest level, use scanline order.
        if self.wrap[0] != Wrap::Repeat || level + 1 == self.sizes.len() {
            return (0..n_sites).collect();
        }
        // Slanted wavefronts: sites on the same line do not read each other.
        // They are `SLANT` columns apart per row, which a neighborhood of 7 × 7 pixels does not reach.
        let line = |site| {
            let [column, row] = self.pixel(level, site);
            u64::from(column) + u64::from(SLANT) * u64::from(row)
        };
        let mut order: Vec<u32> = (0..n_sites).collect();
        order.sort_by_key(|&site| line(site));
        order
    }

    fn prepare(&self, _: usize, same: Option<i32>, _: Option<i32>) -> i32 {
        same.unwrap_or(0)
    }

    fn turns(&self, level: usize, &half: &i32) -> WavefrontSchedule {
        let size = self.sizes[level];
        let side = 2 * half as usize + 1;
        let latest = |site, marks: &[u32]| {
            // Centers of squares are in half pixels.
            let at = self.pixel(level, site).map(|at| 2 * i64::from(at));
            let [columns, rows] = grid::square(at, half, size, self.wrap);
            let mut latest = 0;
            for row in &rows[..side] {
                let line = &marks[row * size[0] as usize..][..size[0] as usize];
                for &column in &columns[..side] {
                    latest = latest.max(line[column]);
                }
            }
            latest
        };
        let order = self.order(level);
        WavefrontSchedule::new(&order, self.n_sites(level), |site| site as usize, latest)
    }

    fn read(
        &self,
        square: Square,
        _: &i32,
        colors: impl Colors,
        samples: &mut Samples,
        (): &mut (),
    ) {
        let reads = if square.reads == square.level {
            Reads::Same
        } else {
            Reads::Coarser
        };
        // Read the values of the neighborhood.
        let at = halves(self.pixel(square.level, square.site), reads, self.center);
        let size = self.sizes[square.reads];
        let wrap = self.wrap;
        let grid = Grid { colors, size, wrap };
        grid.read(at, square.half, square.range(), &mut samples.values);
        // Record the site at each sample.
        let [columns, rows] = grid::square(at, square.half, size, wrap);
        for (row, nearest) in rows
            .iter()
            .zip(samples.nearest.chunks_exact_mut(square.side()))
        {
            for (&column, nearest) in columns.iter().zip(nearest) {
                *nearest = *row as u32 * size[0] + column as u32;
            }
        }
        // During repairs, mirrored sites past a cut edge are not candidates.
        if !self.starts.is_empty() {
            self.leave_out_mirrored(at, &square, &mut samples.nearest);
        }
    }
}

#[cfg(test)]
mod tests;
