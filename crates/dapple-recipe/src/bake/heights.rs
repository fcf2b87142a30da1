//! Computes the heights of a band and its margin, and the values of plan steps that both the height and other maps
//! read.

use super::maps::{NORMAL_HALO, beside_height, curvature_options, maps, occlusion_options};
use super::supersample::Supersample;
use super::{MapKind, MapRows};
use crate::plan::{Known, TileSamples, with_margin};
use crate::{Plan, RecipeError, Values, Whole};
use dapple_color::continue_heights;
use dapple_raster::{Raster, Window};
use std::sync::Arc;

/// Maximum number of pixels, in a band with its margin, at which the values of shared steps are stored in addition to
/// the heights: eight times as many as in a default band, or 32 MiB for each step. Above it, the other maps recompute
/// all their steps.
const SHARED_PIXELS: usize = 1 << 23;

/// Computes the heights of bands. Rows that two bands share are computed once.
#[derive(Clone, Debug)]
pub(super) struct Heights {
    /// Whether any baked map is the height or is computed from it.
    wanted: bool,
    /// Halo of the heights, in columns and rows of pixels: the maximum distance at which a map reads them around a
    /// pixel.
    halo: [u32; 2],
    /// For each axis along which heights are extrapolated past the sides of the tile, the first pixel of the tile and
    /// the pixel after its last one; `None` for other axes.
    sides: [Option<[i64; 2]>; 2],
    /// Indices of the plan steps that both the height and other maps depend on.
    shared: Vec<usize>,
    /// The bottom rows of the previous band, with the steps that it computed, for the margin of the next band.
    last: Option<Rows>,
    /// Indices of the plan steps whose values neighborhoods read, such as the input of a blur.
    sources: Vec<usize>,
    /// Margin around a band in which the values of `sources` are needed, in columns and rows of samples.
    reach: [u32; 2],
    supersample: Supersample,
    /// The bottom rows of the previous band, with the values of `sources`.
    last_sources: Option<Rows>,
}

/// The values of several plan steps at the samples of a window, one entry of `values` per step.
#[derive(Clone, Debug)]
struct Rows {
    window: Window,
    values: Vec<Values>,
}

/// The heights of a band with a margin.
pub(super) struct Margined {
    pub(super) raster: Option<Raster<f32>>,
    pub(super) halo: [u32; 2],
    /// The values of shared plan steps, with their window: the band and its margin.
    pub(super) shared: Box<Known>,
    /// Supersampling of the maps that are not computed from the heights.
    pub(super) supersample: Supersample,
}

impl Heights {
    pub(super) fn new(
        plan: &Plan,
        tile: &TileSamples,
        supersample: Supersample,
        maps: &[MapKind],
    ) -> Result<Self, RecipeError> {
        let continues = plan.continues_heights();
        let TileSamples { window, extent } = *tile;
        let side =
            |axis: usize| [0, 1].map(|end| window.first[axis] + end * i64::from(window.size[axis]));
        let mut heights = Self {
            wanted: false,
            halo: [0; 2],
            sides: [0, 1].map(|axis| continues[axis].then(|| side(axis))),
            shared: plan.shared_with_height(&beside_height(plan, maps)),
            last: None,
            sources: Vec::new(),
            reach: [0; 2],
            supersample,
            last_sources: None,
        };
        for map in maps {
            let halo = match map {
                MapKind::Height => [0; 2],
                MapKind::Normal => NORMAL_HALO,
                MapKind::Occlusion | MapKind::Orm => {
                    occlusion_options(plan, extent)?.halo(window.size)
                }
                MapKind::Curvature => curvature_options(plan, extent)?.halo(window.size),
                MapKind::Albedo
                | MapKind::Roughness
                | MapKind::Metallic
                | MapKind::Emission
                | MapKind::Opacity
                | MapKind::Specular
                | MapKind::Clearcoat => continue,
            };
            heights.wanted = true;
            heights.halo = [heights.halo[0].max(halo[0]), heights.halo[1].max(halo[1])];
        }
        let mut steps = beside_height(plan, maps);
        if heights.wanted {
            steps.push(plan.channels().height);
        }
        let (sources, margin) = plan.sources(&supersample.window(&window), &steps)?;
        heights.sources = sources;
        let halo = supersample.samples(heights.halo);
        heights.reach = [0, 1].map(|axis| halo[axis].saturating_add(margin[axis]));
        Ok(heights)
    }

    /// Computes the maps of a band. Reuses heights that it shares with the previous band.
    pub(super) fn maps(
        &mut self,
        plan: &Plan,
        whole: &Whole,
        band: &Window,
        tile: &TileSamples,
        kinds: &[MapKind],
    ) -> Result<Vec<(MapKind, MapRows)>, RecipeError> {
        let heights = self.of(plan, whole, band)?;
        maps(plan, whole, band, tile, &heights, kinds)
    }

    /// Computes the heights of a band with its margin. Reuses rows that it shares with the previous band.
    fn of(&mut self, plan: &Plan, whole: &Whole, band: &Window) -> Result<Margined, RecipeError> {
        let samples = self.supersample.window(band);
        let mut shared = self.sources(plan, whole, &samples)?.into_vec();
        let halo = self.halo;
        if !self.wanted {
            return Ok(Margined {
                supersample: self.supersample,
                raster: None,
                halo,
                shared: shared.into(),
            });
        }
        let pixels = with_margin(band, halo);
        let window = self.supersample.window(&pixels);
        let mut steps = vec![plan.channels().height];
        if window.n_pixels() <= SHARED_PIXELS {
            let is_new = |step: &&usize| !shared.iter().any(|(known, _)| known == *step);
            steps.extend(self.shared.iter().filter(is_new));
        }
        let mut rows = Rows::from(self.last.take(), &window, &steps);
        rows.complete(plan, whole, &window, &steps, &shared)?;
        self.last = rows.for_next(&samples, self.supersample.samples(halo)[1]);
        // Extrapolate the heights past the sides of the tile.
        let mut values = rows.values.into_iter();
        let heights = values.next().unwrap_or(Values::Numbers(Vec::new()));
        let heights = self.supersample.average(heights, pixels.size[0]);
        let mut raster = Raster::from_vec(pixels.size, heights.into_grays())?;
        let in_window = |axis: usize| {
            let sides = self.sides[axis]?;
            Some(sides.map(|side| side - pixels.first[axis]))
        };
        continue_heights(&mut raster, [0, 1].map(in_window));
        let values = values.map(|values| (window, Arc::new(values)));
        shared.extend(steps[1..].iter().copied().zip(values));
        Ok(Margined {
            supersample: self.supersample,
            raster: Some(raster),
            halo,
            shared: shared.into(),
        })
    }

    /// Computes the values that the neighborhoods of a band read. `band` is a window of samples. Reuses rows shared
    /// with the previous band. Returns an empty list if the values would take too much memory; each neighborhood then
    /// computes its inputs itself.
    fn sources(
        &mut self,
        plan: &Plan,
        whole: &Whole,
        band: &Window,
    ) -> Result<Box<Known>, RecipeError> {
        let window = with_margin(band, self.reach);
        let [width, height] = window.size.map(u64::from);
        if self.sources.is_empty() || width * height > SHARED_PIXELS as u64 {
            return Ok(Box::default());
        }
        let mut rows = Rows::from(self.last_sources.take(), &window, &self.sources);
        rows.complete(plan, whole, &window, &self.sources, &[])?;
        self.last_sources = rows.for_next(band, self.reach[1]);
        let values = rows.values.into_iter();
        let values = values.map(|values| (window, Arc::new(values)));
        Ok(self.sources.iter().copied().zip(values).collect())
    }
}

impl Rows {
    /// Creates a set without rows. Its window starts at the top of `window` and has the same width.
    fn none(window: &Window) -> Self {
        let [width, _] = window.size;
        Self {
            window: Window {
                size: [width, 0],
                ..*window
            },
            values: Vec::new(),
        }
    }

    /// Returns the stored rows of `last` if they are the first rows of `window` and hold values of `steps`; otherwise
    /// an empty set.
    fn from(last: Option<Self>, window: &Window, steps: &[usize]) -> Self {
        last.filter(|last| last.values.len() == steps.len())
            .and_then(|last| last.rows_from(window.first[1]))
            .unwrap_or_else(|| Self::none(window))
    }

    /// Returns the rows that the next band, below `band`, reads again: `margin` rows above its top. `None` if there is
    /// no margin.
    fn for_next(&self, band: &Window, margin: u32) -> Option<Self> {
        let next = band.first[1].saturating_add(band.size[1].into());
        let rows = (margin > 0).then(|| self.rows_from(next.saturating_sub(margin.into())));
        rows.flatten()
    }

    /// Returns the rows from `first` to the last one; `None` if row `first` is not stored.
    fn rows_from(&self, first: i64) -> Option<Self> {
        let [width, rows] = self.window.size;
        let above = u32::try_from(first.checked_sub(self.window.first[1])?).ok()?;
        let left = rows.checked_sub(above).filter(|&left| left > 0)?;
        let pixels = above as usize * width as usize..rows as usize * width as usize;
        Some(Self {
            window: Window {
                first: [self.window.first[0], first],
                size: [width, left],
                ..self.window
            },
            values: self
                .values
                .iter()
                .map(|values| values.part(pixels.clone()))
                .collect(),
        })
    }

    /// Computes the values of `steps` in the remaining rows of the window, and appends them.
    fn complete(
        &mut self,
        plan: &Plan,
        whole: &Whole,
        window: &Window,
        steps: &[usize],
        known: &Known,
    ) -> Result<(), RecipeError> {
        let [width, made] = self.window.size;
        let rest = Window {
            first: [window.first[0], window.first[1] + i64::from(made)],
            size: [width, window.size[1] - made],
            ..*window
        };
        if rest.size[1] > 0 {
            let below = plan.values(whole, &rest, steps, known)?;
            if self.values.is_empty() {
                self.values = below;
            } else {
                for (values, below) in self.values.iter_mut().zip(&below) {
                    values.append(below);
                }
            }
        }
        self.window = *window;
        Ok(())
    }
}
