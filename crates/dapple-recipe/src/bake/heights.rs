//! Computes the heights of a band with its margin, and the values that other maps share with the height.

use super::maps::{NORMAL_HALO, beside_height, curvature_options, maps, occlusion_options};
use super::{MapKind, MapRows};
use crate::plan::{Known, TileSamples};
use crate::{Plan, RecipeError, Values, Whole};
use dapple_color::continue_heights;
use dapple_raster::{Raster, RasterError, Window};
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
    /// The values of shared steps in the band, without its margin.
    pub(super) shared: Box<Known>,
}

impl Heights {
    pub(super) fn new(
        plan: &Plan,
        tile: &TileSamples,
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
        };
        for map in maps {
            let halo = match map {
                MapKind::Height => [0; 2],
                MapKind::Normal => NORMAL_HALO,
                MapKind::Occlusion | MapKind::Orm => {
                    occlusion_options(plan, extent)?.halo(window.size)
                }
                MapKind::Curvature => curvature_options(plan, extent)?.halo(window.size),
                MapKind::Albedo | MapKind::Roughness | MapKind::Metallic => continue,
            };
            heights.wanted = true;
            heights.halo = [heights.halo[0].max(halo[0]), heights.halo[1].max(halo[1])];
        }
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
        let halo = self.halo;
        if !self.wanted {
            return Ok(Margined {
                raster: None,
                halo,
                shared: Box::default(),
            });
        }
        let window = Window {
            first: [0, 1].map(|axis| band.first[axis].saturating_sub(halo[axis].into())),
            size: [0, 1].map(|axis| band.size[axis].saturating_add(halo[axis].saturating_mul(2))),
            ..*band
        };
        // Begin with the rows of the previous band, and compute the rest.
        let mut steps = vec![plan.channels().height];
        if window.n_pixels() <= SHARED_PIXELS {
            steps.extend(&self.shared);
        }
        let last = self.last.take();
        let mut rows = last
            .filter(|last| last.values.len() == steps.len())
            .and_then(|last| last.rows_from(window.first[1]))
            .unwrap_or_else(|| Rows::none(&window));
        rows.complete(plan, whole, &window, &steps)?;
        if halo[1] > 0 {
            let next = band.first[1].saturating_add(band.size[1].into());
            self.last = rows.rows_from(next.saturating_sub(halo[1].into()));
        }
        // Extrapolate the heights past the sides of the tile.
        let mut values = rows.values.into_iter();
        let heights = match values.next() {
            Some(Values::Numbers(heights)) => heights,
            _ => Vec::new(),
        };
        let mut raster = Raster::from_vec(window.size, heights)?;
        let in_window = |axis: usize| {
            let sides = self.sides[axis]?;
            Some(sides.map(|side| side - window.first[axis]))
        };
        continue_heights(&mut raster, [0, 1].map(in_window));
        // Crop the margin from the values of the shared steps.
        let in_band = |(&step, values)| Ok((step, Arc::new(cropped(values, &window, halo, band)?)));
        Ok(Margined {
            raster: Some(raster),
            halo,
            shared: steps[1..]
                .iter()
                .zip(values)
                .map(in_band)
                .collect::<Result<_, RasterError>>()?,
        })
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
    ) -> Result<(), RecipeError> {
        let [width, made] = self.window.size;
        let rest = Window {
            first: [window.first[0], window.first[1] + i64::from(made)],
            size: [width, window.size[1] - made],
            ..*window
        };
        if rest.size[1] > 0 {
            let below = plan.values(whole, &rest, steps, &[])?;
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

/// Crops the values of a window to the band within it.
fn cropped(
    values: Values,
    window: &Window,
    halo: [u32; 2],
    band: &Window,
) -> Result<Values, RasterError> {
    if halo == [0; 2] {
        return Ok(values);
    }
    Ok(match values {
        Values::Numbers(numbers) => Values::Numbers(
            Raster::from_vec(window.size, numbers)?
                .crop(halo, band.size)?
                .into_pixels(),
        ),
        Values::Colors(colors) => Values::Colors(
            Raster::from_vec(window.size, colors)?
                .crop(halo, band.size)?
                .into_pixels(),
        ),
    })
}
