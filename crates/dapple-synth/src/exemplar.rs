//! The exemplar: the example image of a synthesis, and its Gaussian pyramid.
//!
//! References: Peter J. Burt and Edward H. Adelson, "The Laplacian Pyramid as a Compact Image Code", IEEE Transactions
//! on Communications, 1983, DOI 10.1109/TCOM.1983.1095851, for the pyramid; Greg Turk, "Texture Synthesis on Surfaces",
//! SIGGRAPH 2001, DOI 10.1145/383259.383297, section 5.2, for its use.
//!
//! Pixel `(a, b)` of a level is at pixel `(2a, 2b)` of the next finer level. It is the weighted mean of the pixels
//! around that position, with the weights 1-4-6-4-1 along both axes. A side of `n` pixels is reduced to `n / 2` pixels,
//! rounded up. Values are not quantized between levels.
//!
//! If the exemplar has a mask, only usable pixels count in a mean (normalized convolution; Hans Knutsson and Carl-Fredrik
//! Westin, "Normalized and Differential Convolution", CVPR 1993, DOI 10.1109/CVPR.1993.341081). A pixel is usable if the
//! four pixels that it covers are usable. Requiring all 25 pixels would enlarge a hole by up to two pixels on each side
//! of each level. On the third level of a 64 × 64 image, a hole of 12 columns would have 6 of the 16 columns.
//!
//! A wrapping level with an odd side has no coarser version that wraps: adjacent pixels would be two apart, but the
//! last and the first only one apart. All coarser levels then have cut edges. [`Exemplar::edges`] returns the edge mode
//! of a level.

use crate::domain::Plain;
use crate::error::{SynthError, SynthErrorKind};
use crate::grid::Grid;
use crate::guides::Guides;
use crate::side_by_side::SideBySide;
use dapple_color::LinearRgb;
use dapple_raster::{Raster, Wrap};

/// Maximum number of levels of a pyramid.
pub(crate) const MAX_LEVELS: usize = 16;

/// Maximum absolute value of a pixel times the square root of its weight. Up to this limit, no sum of squares can
/// overflow.
const MAX_VALUE: f32 = 1e12;

dapple_raster::named! {
    /// Content past the edges of an exemplar, or of a texture in the plane.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
    #[non_exhaustive]
    pub enum Edges {
        /// Nothing: neighborhoods of an exemplar that reach past an edge are not compared.
        #[default]
        Cut = "cut",
        /// The image again, which is a tile.
        Wrap = "wrap",
    }
}

impl Edges {
    /// Returns the wrapping rule for positions past an edge.
    pub(crate) fn wrap(self) -> Wrap {
        match self {
            Self::Cut => Wrap::Mirror,
            Self::Wrap => Wrap::Repeat,
        }
    }
}

/// Example image whose neighborhoods are matched, with one or more channels per pixel.
#[derive(Clone, Debug, PartialEq)]
pub struct Exemplar {
    pub(crate) size: [u32; 2],
    pub(crate) n_channels: usize,
    pub(crate) edges: Edges,
    /// `n_channels` values per pixel, row by row.
    pub(crate) pixels: Vec<f32>,
    /// Mask that is true for pixels that textures may use; `None` if all are usable.
    pub(crate) usable: Option<Vec<bool>>,
    /// Rectangles of the images in a layout, each with its own edges; empty for a single image.
    pub(crate) areas: Vec<Area>,
    /// Guides, which control where in a texture each part of the exemplar is used.
    pub(crate) guides: Guides,
}

/// A rectangle of pixels.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Area {
    /// First column and row.
    pub(crate) first: [u32; 2],
    /// Column and row after the last.
    pub(crate) end: [u32; 2],
}

impl Area {
    pub(crate) fn contains(self, place: [u32; 2]) -> bool {
        (0..2).all(|axis| (self.first[axis]..self.end[axis]).contains(&place[axis]))
    }

    /// Returns the rectangle of the pixels of the next coarser level whose positions lie in this one.
    fn halved(self) -> Self {
        Self {
            first: self.first.map(|at| at.div_ceil(2)),
            end: self.end.map(|at| at.div_ceil(2)),
        }
    }

    /// Returns the five positions along an axis that are averaged for position `at` of the coarser level.
    fn taps(self, axis: usize, at: u32, wrap: Wrap) -> [usize; 5] {
        let [first, end] = [self.first, self.end].map(|corner| corner[axis]);
        // Pixel (i, j) of the coarser level is centered on pixel (2i, 2j).
        let center = 2 * i64::from(at) - i64::from(first);
        [-2, -1, 0, 1, 2].map(|step| (first + wrap.index(center + step, end - first)) as usize)
    }
}

/// Gaussian pyramid of an exemplar: the exemplar and its reduced versions, finest first.
#[derive(Clone, Debug, PartialEq)]
pub struct Pyramid {
    pub(crate) levels: Vec<Exemplar>,
}

impl Exemplar {
    /// Creates an exemplar from a color image. Colors are compared as sRGB codes from 0 to 1, as in the paper.
    ///
    /// The codes have 16 bits, so the values of 8-bit files are exact. Channels outside 0 to 1 are clamped for
    /// matching.
    ///
    /// # Errors
    ///
    /// [`SynthErrorKind::NotFinite`] if a color is not finite.
    pub fn new(image: &Raster<LinearRgb>, edges: Edges) -> Result<Self, SynthError> {
        for (pixel, color) in image.pixels().iter().enumerate() {
            for value in color.to_array() {
                check_finite(value, pixel, image.width())?;
            }
        }
        let code = |code: u16| f32::from(code) / f32::from(u16::MAX);
        let codes = |color: &LinearRgb| color.to_srgb::<u16>().map(code);
        Ok(Self {
            size: image.size(),
            n_channels: 3,
            edges,
            pixels: image.pixels().iter().flat_map(codes).collect(),
            usable: None,
            areas: Vec::new(),
            guides: Guides::default(),
        })
    }

    /// Creates an exemplar from arbitrary planes, each with a weight on its squared differences.
    ///
    /// The planes are not normalized. Heights from 0 to 1 with a weight of 1 count as much as one color channel. Values
    /// are stored multiplied by the square root of their weight; [`pixels`](Self::pixels) returns these products.
    ///
    /// # Errors
    ///
    /// If there are no planes, if their sizes differ, if a weight is not positive and finite, or if a value is not
    /// finite or, times the square root of its weight, beyond 10^12.
    pub fn from_planes(planes: &[(&Raster<f32>, f32)], edges: Edges) -> Result<Self, SynthError> {
        let Some((first, _)) = planes.first() else {
            return Err(SynthError::new(SynthErrorKind::Count {
                what: "planes of the exemplar",
                count: 0,
                needed: "at least 1",
            }));
        };
        let (rasters, weights): (Vec<_>, Vec<_>) = planes.iter().copied().unzip();
        Ok(Self {
            size: first.size(),
            n_channels: planes.len(),
            edges,
            pixels: interleaved(&rasters, &roots(&weights)?)?,
            usable: None,
            areas: Vec::new(),
            guides: Guides::default(),
        })
    }

    /// Appends the channels of another exemplar of the same size. `weight` scales their squared differences. For
    /// example, the colors of a material can be matched together with its heights. This exemplar's edges, mask and
    /// guides are retained.
    ///
    /// # Errors
    ///
    /// [`SynthErrorKind::Count`] if the sizes differ. [`SynthErrorKind::Range`] if `weight` is not positive and finite,
    /// or if a value times the square root of `weight` is beyond 10^12.
    ///
    /// # Examples
    ///
    /// Match colors together with heights that count half as much as one color channel.
    ///
    /// ```
    /// use dapple_color::LinearRgb;
    /// use dapple_raster::Raster;
    /// use dapple_synth::{Edges, Exemplar};
    ///
    /// let height = Raster::from_fn([16, 16], |x, y| f32::from((x / 4 + y / 4) % 2 == 0))?;
    /// let color = height.map(|&height| LinearRgb::gray(0.2 + 0.1 * height));
    /// let heights = Exemplar::from_planes(&[(&height, 1.0)], Edges::Wrap)?;
    /// let material = Exemplar::new(&color, Edges::Wrap)?.with_channels(&heights, 0.5)?;
    /// assert_eq!(material.n_channels(), 4);
    /// # Ok::<(), dapple_synth::SynthError>(())
    /// ```
    pub fn with_channels(self, other: &Self, weight: f32) -> Result<Self, SynthError> {
        for (axis, what) in [
            "columns of the added channels",
            "rows of the added channels",
        ]
        .into_iter()
        .enumerate()
        {
            if other.size[axis] != self.size[axis] {
                return Err(SynthError::new(SynthErrorKind::Count {
                    what,
                    count: other.size[axis] as usize,
                    needed: "as many as the exemplar has",
                }));
            }
        }
        // Values times the root of the weight have squared differences times the weight.
        let root = roots(&[weight])?[0];
        let counts = [self.n_channels, other.n_channels];
        let mut pixels = Vec::with_capacity(self.pixels.len() + other.pixels.len());
        let own = self.pixels.chunks_exact(counts[0].max(1));
        for (own, beside) in own.zip(other.pixels.chunks_exact(counts[1].max(1))) {
            pixels.extend_from_slice(own);
            for value in beside {
                let scaled = value * root;
                check_weighted(scaled)?;
                pixels.push(scaled);
            }
        }
        Ok(Self {
            n_channels: counts[0] + counts[1],
            pixels,
            ..self
        })
    }

    /// Excludes the pixels at which `mask` is false. Textures use neither these pixels nor any pixel whose neighborhood
    /// contains one of them.
    ///
    /// # Errors
    ///
    /// [`SynthErrorKind::Raster`] if `mask` is not the same size as the exemplar.
    pub fn with_mask(self, mask: &Raster<bool>) -> Result<Self, SynthError> {
        mask.check_same_size(self.size)?;
        let usable = Some(mask.pixels().to_vec());
        Ok(Self { usable, ..self })
    }

    /// Divides the exemplar into the images of `layout`. Each image has its own edges and is mirrored past them. Pixels
    /// between the images are excluded.
    ///
    /// Each image is matched separately. Otherwise no neighborhood would remain on small levels, where nearly all reach
    /// past an edge. Endless textures only use the layout as a [mask](Self::with_mask).
    ///
    /// # Errors
    ///
    /// [`SynthErrorKind::Raster`] if `layout` is not the same size as the exemplar.
    ///
    /// # Examples
    ///
    /// ```
    /// use dapple_raster::Raster;
    /// use dapple_synth::{Edges, Exemplar, Options, SideBySide, Turned, synthesize_plane};
    ///
    /// let bars = Raster::from_fn([16, 16], |x, _| f32::from(x % 4 == 0))?;
    /// let layout = SideBySide::new(&[bars.size()])?.with_turned(Turned::Quarters)?;
    /// let turned = layout.join(&[&bars], 0.0)?;
    /// let exemplar = Exemplar::from_planes(&[(&turned, 1.0)], Edges::Cut)?.with_layout(&layout)?;
    /// let options = Options { n_levels: 3, ..Options::default() };
    /// let texture = synthesize_plane(&exemplar, [32, 32], [Edges::Cut; 2], &options)?;
    /// assert!(texture.sources().pixels().iter().all(|&source| layout.image_at(source).is_some()));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn with_layout(self, layout: &SideBySide) -> Result<Self, SynthError> {
        let mut mask = layout.mask()?;
        mask.check_same_size(self.size)?;
        let areas = layout.areas();
        // A single image of the full size needs no areas.
        if areas.len() == 1 && areas[0].end == self.size {
            return Ok(self);
        }
        // Combine the layout's mask with an earlier one.
        if let Some(usable) = &self.usable {
            let own = Raster::from_fn(self.size, |x, y| {
                usable[y as usize * self.size[0] as usize + x as usize]
            })?;
            mask = mask.zip_map(&own, |&is_within, &is_usable| is_within && is_usable)?;
        }
        let exemplar = self.with_mask(&mask)?;
        Ok(Self { areas, ..exemplar })
    }

    /// Returns the rectangles of the images, or a single rectangle, the whole exemplar, if there is only one image.
    pub(crate) fn areas(&self) -> Vec<Area> {
        if self.areas.is_empty() {
            let [first, end] = [[0; 2], self.size];
            return vec![Area { first, end }];
        }
        self.areas.clone()
    }

    /// Reduces the exemplar by an integer factor of at least 1: each square of `factor` × `factor` pixels becomes one
    /// pixel, their mean. Incomplete squares at the right and bottom are dropped. A square that contains an excluded
    /// pixel is excluded.
    ///
    /// Synthesis from the reduced exemplar takes a fraction of the time and memory. The texture shows the full detail
    /// with [`PlaneTexture::transfer`](crate::PlaneTexture::transfer).
    ///
    /// # Errors
    ///
    /// [`SynthErrorKind::Range`] if `factor` is 0 or larger than the shorter side.
    pub fn reduced(&self, factor: u32) -> Result<Self, SynthError> {
        let side = self.size[0].min(self.size[1]);
        let holds = (1..=side).contains(&factor);
        SynthError::check(holds, "factor", factor.into(), "from 1 to the shorter side")?;
        let size = self.size.map(|side| side / factor);
        let [width, columns] = [self.size[0], factor].map(|side| side as usize);
        // Indices of the pixels of a square.
        let square = |x: u32, y: u32| {
            let rows = y as usize * columns..(y as usize + 1) * columns;
            rows.flat_map(move |row| {
                let first = row * width + x as usize * columns;
                first..first + columns
            })
        };
        let squares = || (0..size[1]).flat_map(move |y| (0..size[0]).map(move |x| square(x, y)));
        let area = f64::from(factor) * f64::from(factor);
        // Sum in f64, in row order.
        let means = |values: &[f32], n: usize| {
            let mut means = Vec::with_capacity(size[0] as usize * size[1] as usize * n);
            for square in squares() {
                for channel in 0..n {
                    let values = square.clone().map(|at| f64::from(values[at * n + channel]));
                    means.push((values.sum::<f64>() / area) as f32);
                }
            }
            means
        };
        let usable = self.usable.as_ref();
        let is_usable = |usable: &Vec<bool>| {
            squares()
                .map(|mut square| square.all(|at| usable[at]))
                .collect()
        };
        // If pixels were dropped, the image no longer wraps.
        let is_whole = size.map(|side| side * factor) == self.size;
        Ok(Self {
            size,
            n_channels: self.n_channels,
            edges: if is_whole { self.edges } else { Edges::Cut },
            pixels: means(&self.pixels, self.n_channels),
            usable: usable.map(is_usable),
            areas: self
                .areas
                .iter()
                .map(|area| Area {
                    // Keep the squares that are entirely within the image.
                    first: area.first.map(|at| at.div_ceil(factor)),
                    end: area.end.map(|at| at / factor),
                })
                .collect(),
            guides: Guides {
                values: means(&self.guides.values, self.n_guides()),
                roots: self.guides.roots.clone(),
            },
        })
    }

    /// Builds a pyramid with `n_levels` levels, from 1 to 16. This exemplar is the finest level.
    ///
    /// # Errors
    ///
    /// [`SynthErrorKind::Range`] if `n_levels` is not from 1 to 16.
    pub fn pyramid(&self, n_levels: usize) -> Result<Pyramid, SynthError> {
        let holds = (1..=MAX_LEVELS).contains(&n_levels);
        SynthError::check(holds, "number of levels", n_levels as f64, "from 1 to 16")?;
        let levels = core::iter::successors(Some(self.clone()), |finer| Some(finer.halved()));
        Ok(Pyramid {
            levels: levels.take(n_levels).collect(),
        })
    }

    /// Returns the size in pixels: columns and rows.
    #[must_use]
    pub fn size(&self) -> [u32; 2] {
        self.size
    }

    /// Returns the number of values per pixel.
    #[must_use]
    pub fn n_channels(&self) -> usize {
        self.n_channels
    }

    /// Returns the edge mode of the exemplar.
    #[must_use]
    pub fn edges(&self) -> Edges {
        self.edges
    }

    /// Returns the values that are matched: [`n_channels`](Self::n_channels) per pixel, row by row from the top.
    #[must_use]
    pub fn pixels(&self) -> &[f32] {
        &self.pixels
    }

    /// Returns the pixels as a grid with the wrapping rule of the edges; past cut edges the image is mirrored.
    pub(crate) fn grid(&self) -> Grid<Plain<'_>> {
        Grid {
            colors: self.plain(),
            size: self.size,
            wrap: [self.edges.wrap(); 2],
        }
    }

    /// Returns whether textures may use the pixel with index `pixel`.
    pub(crate) fn is_usable(&self, pixel: usize) -> bool {
        let usable = self.usable.as_ref();
        usable.is_none_or(|usable| usable[pixel])
    }

    /// Returns the index of the pixel at `place`, wrapped if the exemplar wraps; `None` past a cut edge.
    pub(crate) fn pixel_at(&self, place: [i64; 2]) -> Option<usize> {
        let [width, height] = self.size.map(i64::from);
        let [column, row] = match self.edges {
            Edges::Wrap => [place[0].rem_euclid(width), place[1].rem_euclid(height)],
            Edges::Cut => place,
        };
        let is_within = (0..width).contains(&column) && (0..height).contains(&row);
        is_within.then_some((row * width + column) as usize)
    }

    /// Returns the values of all pixels.
    pub(crate) fn plain(&self) -> Plain<'_> {
        Plain {
            values: &self.pixels,
            n_channels: self.n_channels,
        }
    }

    /// Returns the image blurred along both axes; `blur` is the weight of each of the two neighbors along an axis.
    fn blurred(&self, blur: f32) -> Self {
        let n = self.n_channels;
        let [width, height] = self.size.map(|side| side as usize);
        let [wrap_x, wrap_y] = self.grid().wrap;
        let mixed = |from: &[f32], at: usize, steps: [usize; 2], offset: usize| {
            let [a, b] = steps.map(|step| from[step * n + offset]);
            // Add differences, so that a constant image does not change in a single bit.
            let own = from[at * n + offset];
            own + blur * ((a - own) + (b - own))
        };
        let beside = |at: usize, side: usize, wrap: Wrap| {
            [-1, 1].map(|step| wrap.index(at as i64 + step, side as u32) as usize)
        };
        // Blur along the rows.
        let mut across = Vec::with_capacity(self.pixels.len());
        for row in self.pixels.chunks_exact(width * n) {
            for at in 0..width {
                let steps = beside(at, width, wrap_x);
                across.extend((0..n).map(|channel| mixed(row, at, steps, channel)));
            }
        }
        // Blur along the columns.
        let mut pixels = Vec::with_capacity(self.pixels.len());
        for at in 0..height {
            let steps = beside(at, height, wrap_y).map(|row| row * width);
            let of = |offset| mixed(&across, at * width, steps, offset);
            pixels.extend((0..width * n).map(of));
        }
        Self {
            pixels,
            ..self.clone()
        }
    }

    /// Returns this exemplar reduced to the next coarser level of the pyramid.
    fn halved(&self) -> Self {
        let half = self.size.map(|side| side.div_ceil(2));
        // An odd side is not a whole number of coarser pixels, so the coarser level cannot wrap.
        let odd = self.size.iter().any(|side| side % 2 == 1);
        let grid = self.grid();
        let areas = self.areas();
        // A coarser pixel is usable if the four pixels that it covers are usable.
        let usable = self.usable.as_ref().map(|usable| {
            let is_usable = |x: u32, y: u32| {
                let is_within = |area: &&Area| area.halved().contains([x, y]);
                let Some(area) = areas.iter().find(is_within) else {
                    return false;
                };
                let columns = area.taps(0, x, grid.wrap[0]);
                let rows = area.taps(1, y, grid.wrap[1]);
                let pixel = |x: usize, y: usize| usable[y * self.size[0] as usize + x];
                covered(rows).all(|y| covered(columns).all(|x| pixel(x, y)))
            };
            let row = |y| (0..half[0]).map(move |x| is_usable(x, y));
            (0..half[1]).flat_map(row).collect()
        });
        Self {
            size: half,
            n_channels: self.n_channels,
            edges: if odd { Edges::Cut } else { self.edges },
            pixels: match &self.usable {
                Some(usable) => self.means_of_usable(usable, &areas),
                None => halved(&grid, &areas),
            },
            usable,
            areas: self.areas.iter().map(|area| area.halved()).collect(),
            guides: self.guides.halved(self.size, grid.wrap, &areas),
        }
    }

    /// Returns the values of the next coarser level: weighted means of the usable pixels alone.
    fn means_of_usable(&self, usable: &[bool], areas: &[Area]) -> Vec<f32> {
        let n = self.n_channels;
        // Append the mask as a channel. Its mean is the total weight of the usable pixels.
        let mut values = Vec::with_capacity(usable.len() * (n + 1));
        for (color, &is_usable) in self.pixels.chunks_exact(n).zip(usable) {
            let weight = f32::from(is_usable);
            values.extend(color.iter().map(|value| value * weight));
            values.push(weight);
        }
        let colors = Plain {
            values: &values,
            n_channels: n + 1,
        };
        let Grid { size, wrap, .. } = self.grid();
        let means = halved(&Grid { colors, size, wrap }, areas);
        // A total weight of 0 leaves a value of 0.
        let mut pixels = Vec::with_capacity(means.len() / (n + 1) * n);
        for mean in means.chunks_exact(n + 1) {
            let weight = mean[n].max(f32::MIN_POSITIVE);
            pixels.extend(mean[..n].iter().map(|value| value / weight));
        }
        pixels
    }
}

impl Pyramid {
    /// Returns all levels blurred along both axes; `blur` is the weight of each of the two neighbors along an axis.
    pub(crate) fn blurred(&self, blur: f32) -> Self {
        Self {
            levels: self
                .levels
                .iter()
                .map(|level| level.blurred(blur))
                .collect(),
        }
    }

    /// Returns the levels, finest first.
    #[must_use]
    pub fn levels(&self) -> &[Exemplar] {
        &self.levels
    }
}

/// Returns an error if `value` is not finite. `pixel` is its index in an image of the given width.
fn check_finite(value: f32, pixel: usize, width: u32) -> Result<(), SynthError> {
    if value.is_finite() {
        return Ok(());
    }
    // A raster has at most 2^31 pixels.
    let pixel = pixel as u32;
    Err(SynthError::new(SynthErrorKind::NotFinite {
        column: pixel % width,
        row: pixel / width,
        value,
    }))
}

/// Returns an error if sums of squares of `scaled` could overflow. `scaled` is a value times the square root of its
/// weight.
fn check_weighted(scaled: f32) -> Result<(), SynthError> {
    let holds = scaled.abs() <= MAX_VALUE;
    let range = "from -1e12 to 1e12";
    SynthError::check(holds, "weighted value of a pixel", scaled.into(), range)
}

/// Returns the square roots of `weights`, or an error if a weight is not positive and finite.
pub(crate) fn roots(weights: &[f32]) -> Result<Vec<f32>, SynthError> {
    for &weight in weights {
        let holds = weight > 0.0 && weight.is_finite();
        let range = "above 0 and finite";
        SynthError::check(holds, "weight of a plane", weight.into(), range)?;
    }
    Ok(weights.iter().map(|weight| weight.sqrt()).collect())
}

/// Interleaves planes of the same size pixel by pixel. Each plane is multiplied by its value in `roots`.
pub(crate) fn interleaved(planes: &[&Raster<f32>], roots: &[f32]) -> Result<Vec<f32>, SynthError> {
    let Some(first) = planes.first() else {
        return Ok(Vec::new());
    };
    let n_channels = planes.len();
    let mut pixels = vec![0.0; first.pixels().len() * n_channels];
    for (channel, (plane, root)) in planes.iter().zip(roots).enumerate() {
        first.check_same_size(plane.size())?;
        for (pixel, &value) in plane.pixels().iter().enumerate() {
            let scaled = value * root;
            check_finite(scaled, pixel, plane.width())?;
            check_weighted(scaled)?;
            pixels[pixel * n_channels + channel] = scaled;
        }
    }
    Ok(pixels)
}

/// Returns the values of the next coarser level of `image`; zero outside the rectangles `areas`.
pub(crate) fn halved(image: &Grid<Plain<'_>>, areas: &[Area]) -> Vec<f32> {
    let Grid { colors, size, wrap } = *image;
    let n = colors.n_channels;
    let half = size.map(|side| side.div_ceil(2));
    let mut values = vec![0.0; half[0] as usize * half[1] as usize * n];
    for &area in areas {
        let coarse = area.halved();
        let columns = coarse.first[0]..coarse.end[0];
        let row_len = columns.len() * n;
        // Average along the rows of the rectangle.
        let mut rows = Vec::with_capacity(row_len * (area.end[1] - area.first[1]) as usize);
        for row in area.first[1]..area.end[1] {
            let row = &colors.values[row as usize * size[0] as usize * n..];
            for at in columns.clone() {
                let taps = area.taps(0, at, wrap[0]);
                blend(taps.map(|column| &row[column * n..][..n]), &mut rows);
            }
        }
        // Average five of these rows each.
        let mut blended = Vec::with_capacity(row_len);
        for at in coarse.first[1]..coarse.end[1] {
            let taps = area.taps(1, at, wrap[1]);
            let taps = taps.map(|row| &rows[(row - area.first[1] as usize) * row_len..][..row_len]);
            blended.clear();
            blend(taps, &mut blended);
            let first = (at as usize * half[0] as usize + columns.start as usize) * n;
            values[first..first + row_len].copy_from_slice(&blended);
        }
    }
    values
}

/// Returns the five positions along an axis that are averaged for position `at` of the coarser level.
pub(crate) fn taps(at: u32, side: u32, wrap: Wrap) -> [usize; 5] {
    let center = 2 * i64::from(at);
    [-2, -1, 0, 1, 2].map(|step| wrap.index(center + step, side) as usize)
}

/// Returns those of five [`taps`] that the position of the coarser level covers.
pub(crate) fn covered(taps: [usize; 5]) -> impl Iterator<Item = usize> {
    [taps[2], taps[3]].into_iter()
}

/// Appends the element-wise mean of five slices of equal length, with the weights 1-4-6-4-1.
pub(crate) fn blend([a, b, c, d, e]: [&[f32]; 5], target: &mut Vec<f32>) {
    for i in 0..c.len() {
        target.push(((a[i] + e[i]) + 4.0 * (b[i] + d[i]) + 6.0 * c[i]) / 16.0);
    }
}

#[cfg(test)]
mod tests;
