//! Computes the colors of a source's finest sites, as means of its texture.

use super::Origin;
use super::origin::Place;
use crate::domain::Colors;
use crate::guides::Guides;
use crate::{Edges, Exemplar, SiteGraph, SiteIdx, columns};
use dapple_raster::Wrap;
use glam::{DVec2, Vec2};

/// Maximum number of sample points along the side of a site's square. If a square spans more texels than this, samples
/// are more than a texel apart and some texels are skipped.
const POINTS_MAX: u32 = 8;

/// Builds the finest level, in which the finest sites are stored as an image with one row.
pub(super) fn at_sites(origin: &Origin, texture: &Exemplar) -> Exemplar {
    let texels = origin.texels(texture.size);
    let reader = Reader { origin, texture };
    let n_sites = origin.hierarchy().sites().len();
    let sites = columns::column(n_sites, |site| reader.site(site as u32, &texels));
    let n = texture.n_channels;
    let mut pixels = Vec::with_capacity(n_sites * n);
    let mut values = Vec::with_capacity(n_sites * texture.n_guides());
    for site in &sites {
        pixels.extend_from_slice(&site.values[..n]);
        values.extend_from_slice(&site.values[n..]);
    }
    let is_usable = sites.iter().map(|site| site.is_usable).collect::<Vec<_>>();
    let graph = origin.hierarchy().levels()[0].graph();
    Exemplar {
        size: [n_sites as u32, 1],
        n_channels: n,
        edges: Edges::Cut,
        pixels,
        // Neighborhoods interpolate between sites, so neighbors of unusable sites are excluded, too.
        usable: texture.usable.as_ref().map(|_| eroded(&is_usable, graph)),
        areas: Vec::new(),
        guides: Guides {
            roots: texture.guides.roots.clone(),
            values,
        },
    }
}

/// Returns, for each site, whether the site and all its neighbors are usable.
pub(super) fn eroded(usable: &[bool], graph: &SiteGraph) -> Vec<bool> {
    let all = |site: usize| {
        let mut neighbors = graph.neighbors(SiteIdx(site as u32)).iter();
        usable[site] && neighbors.all(|neighbor| usable[neighbor.index()])
    };
    (0..usable.len()).map(all).collect()
}

/// Averaged values of a site.
struct Site {
    /// Values of the channels, followed by the values of the guides.
    values: Vec<f32>,
    /// Whether all averaged texels are usable.
    is_usable: bool,
}

/// Reads a texture at points of the source surface.
struct Reader<'a> {
    origin: &'a Origin,
    texture: &'a Exemplar,
}

impl Reader<'_> {
    /// Averages the texture over a square of one pixel around `site`. `texels` is the side length of a pixel in texels,
    /// for each face.
    fn site(&self, site: u32, texels: &[f32]) -> Site {
        let point = self.origin.hierarchy().sites().points()[site as usize];
        // Take about one sample for each texel, up to the limit.
        let side = texels[point.face.index()].ceil();
        let n = (side as u32).clamp(1, POINTS_MAX);
        let n_values = self.texture.n_channels + self.texture.n_guides();
        let mut mean = Site {
            values: vec![0.0; n_values],
            is_usable: true,
        };
        // Walk to the points of a regular grid in the square.
        let part = 1.0 / (n * n) as f32;
        for [column, row] in (0..n).flat_map(|row| (0..n).map(move |column| [column, row])) {
            let off = Vec2::new(column as f32 + 0.5, row as f32 + 0.5) / n as f32 - 0.5;
            let walk = self.origin.walk(Place { site, off });
            self.add(self.origin.uv(walk.point), part, &mut mean);
        }
        mean
    }

    /// Adds the bilinear sample at the texture coordinates `uv`, with the weight `part`, to `mean`.
    fn add(&self, uv: DVec2, part: f32, mean: &mut Site) {
        let Exemplar { size, usable, .. } = self.texture;
        let colors = self.texture.plain();
        // The center of texel i is at i + 0.5.
        let at = uv * DVec2::from(size.map(f64::from)) - 0.5;
        let first = at.floor();
        let after = (at - first).as_vec2();
        let wrap = self.texture.edges.wrap();
        let index = |at: f64, step: i64, n: u32| Wrap::index(wrap, at as i64 + step, n) as usize;
        for (down, of_row) in [(0, 1.0 - after.y), (1, after.y)] {
            for (right, of_column) in [(0, 1.0 - after.x), (1, after.x)] {
                let row = index(first.y, down, size[1]);
                let texel = row * size[0] as usize + index(first.x, right, size[0]);
                let weight = part * of_row * of_column;
                let guides = self.texture.guides.of(texel);
                let values = colors.of(texel).iter().chain(guides);
                for (sum, value) in mean.values.iter_mut().zip(values) {
                    *sum += weight * value;
                }
                mean.is_usable &= usable.as_ref().is_none_or(|usable| usable[texel]);
            }
        }
    }
}
