//! Computes the heights of a band with its margin, and the values that other maps share with the height.

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
    /// Whether any map needs heights.
    wanted: bool,
    /// The largest halo of all maps, in columns and rows. The halo is how far a pixel's value depends on its neighbors,
    /// in pixels.
    halo: [u32; 2],
    /// For each axis along which heights are extrapolated past the sides of the tile, the first pixel of the tile and
    /// the pixel after its last one.
    sides: [Option<[i64; 2]>; 2],
    /// The steps that both the height and other maps depend on.
    shared: Vec<usize>,
    /// The lowest rows of the previous band, which the margin of the next band reuses.
    last: Option<Rows>,
    /// The steps that neighborhoods read, such as the input of a blur.
    sources: Vec<usize>,
    /// How far beyond a band the sources are needed, in columns and rows of samples.
    reach: [u32; 2],
    supersample: Supersample,
    /// The lowest rows of the sources of the previous band.
    last_sources: Option<Rows>,
}

/// The values of several steps at the pixels of a window.
#[derive(Clone, Debug)]
struct Rows {
    window: Window,
    values: Vec<Values>,
}

/// The heights of a band with a margin.
pub(super) struct Margined {
    pub(super) raster: Option<Raster<f32>>,
    pub(super) halo: [u32; 2],
    /// The values of shared steps in the band and a margin.
    pub(super) shared: Box<Known>,
    /// Samples of the pixels of maps that are not computed from the heights.
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

    /// Computes the values that the neighborhoods of a band read, whose samples are `band`. Reuses rows that it shares with
    /// the previous band. Returns nothing if they would take too much memory; neighborhoods then compute them themselves.
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
    /// Creates an empty set of rows that starts at the top of `window`.
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

    /// Returns the first rows of `window`, if `last` has them; otherwise none. `steps` are those of the values.
    fn from(last: Option<Self>, window: &Window, steps: &[usize]) -> Self {
        last.filter(|last| last.values.len() == steps.len())
            .and_then(|last| last.rows_from(window.first[1]))
            .unwrap_or_else(|| Self::none(window))
    }

    /// Returns the rows that the band below `band` needs again with a margin; `None` without a margin.
    fn for_next(&self, band: &Window, margin: u32) -> Option<Self> {
        let next = band.first[1].saturating_add(band.size[1].into());
        let rows = (margin > 0).then(|| self.rows_from(next.saturating_sub(margin.into())));
        rows.flatten()
    }

    /// Returns the rows starting at the row `first`; `None` if that row is not stored.
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

    /// Appends the remaining rows of the window, and computes their values.
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
