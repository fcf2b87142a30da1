//! The heights of a band and of a margin about it.

use super::MapKind;
use super::maps::{curvature_options, occlusion_options};
use crate::{Plan, RecipeError, Values, Whole};
use dapple_raster::{Raster, Window};

/// Heights, of which those that two bands share are made once.
#[derive(Clone, Debug)]
pub(super) struct Heights {
    /// Whether a map needs them.
    wanted: bool,
    /// How far the maps look, in pixels.
    halo: [u32; 2],
    /// Those of the last band, with their window.
    last: Option<(Window, Raster<f32>)>,
}

/// The heights of a band with a margin.
pub(super) struct Margined {
    pub(super) raster: Option<Raster<f32>>,
    pub(super) halo: [u32; 2],
}

impl Heights {
    pub(super) fn new(plan: &Plan, tile: &Window, maps: &[MapKind]) -> Result<Self, RecipeError> {
        let mut heights = Self {
            wanted: false,
            halo: [0; 2],
            last: None,
        };
        for map in maps {
            let halo = match map {
                MapKind::Height => [0; 2],
                MapKind::Normal => [1; 2],
                MapKind::Occlusion | MapKind::Orm => occlusion_options(plan)?.halo(tile.size),
                MapKind::Curvature => curvature_options(plan)?.halo(tile.size),
                MapKind::Albedo | MapKind::Roughness | MapKind::Metallic => continue,
            };
            heights.wanted = true;
            heights.halo = [heights.halo[0].max(halo[0]), heights.halo[1].max(halo[1])];
        }
        Ok(heights)
    }

    /// The heights of a band, below or beside the last one.
    pub(super) fn of(
        &mut self,
        plan: &Plan,
        whole: &Whole,
        band: &Window,
    ) -> Result<Margined, RecipeError> {
        let halo = self.halo;
        if !self.wanted {
            return Ok(Margined { raster: None, halo });
        }
        let window = Window {
            first: [0, 1].map(|axis| band.first[axis].saturating_sub(halo[axis].into())),
            size: [0, 1].map(|axis| band.size[axis].saturating_add(halo[axis].saturating_mul(2))),
            ..*band
        };
        let shared = self.last.take().map_or_else(Vec::new, |(last, raster)| {
            let from = window.first[1] - last.first[1];
            let rows = u32::try_from(from).ok().filter(|&from| from < last.size[1]);
            rows.map_or_else(Vec::new, |from| {
                let first = from as usize * last.size[0] as usize;
                raster.pixels()[first..].to_vec()
            })
        });
        let shared_rows = (shared.len() / window.size[0] as usize) as u32;
        let rest = Window {
            first: [window.first[0], window.first[1] + i64::from(shared_rows)],
            size: [window.size[0], window.size[1] - shared_rows],
            ..window
        };
        let mut pixels = shared;
        if rest.size[1] > 0 {
            let made = plan.values(whole, &rest, &[plan.channels().height])?;
            if let Some(Values::Numbers(numbers)) = made.into_iter().next() {
                pixels.extend(numbers);
            }
        }
        let raster = Raster::from_vec(window.size, pixels)?;
        if halo[1] > 0 {
            self.last = Some((window, raster.clone()));
        }
        Ok(Margined {
            raster: Some(raster),
            halo,
        })
    }
}
