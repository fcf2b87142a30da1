//! The methods of `dapple copies`, and their options.

use crate::error::{Hint, usage};
use crate::node::{Flag, NodeArgs, NodeFlags};
use crate::words::NamedValueParser;
use anyhow::Result;
use dapple::hash::Seed;
use dapple::raster::Named;
use dapple::tile::{BorderSource, CornerTiles, Disturbance, Map, MatchBorders, TileError};
use serde::Serialize;

/// Maximum number of tiles for the method `corners`.
const CORNERS_MAX: usize = 4;

dapple::raster::named! {
    /// The method by which copies vary.
    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    enum Name {
        /// One tile: each copy keeps its border and has another piece of the tile inside.
        Disturb = "disturb",
        /// Two to four tiles: pieces of them by random colors at their corners.
        Corners = "corners",
        /// Any number of tiles: all get the border of the first.
        Borders = "borders",
    }
}

/// Options of the method.
#[derive(clap::Args, Clone, Debug, Serialize)]
pub(super) struct MethodArgs {
    /// Method [default: by the number of tiles].
    #[arg(long, value_parser = NamedValueParser::<Name>::all(), help_heading = MethodFlags::HEADING)]
    method: Option<Name>,

    #[command(flatten)]
    #[serde(flatten)]
    node: NodeArgs<MethodFlags>,
}

/// Marker for the flags that come from the recipe nodes `disturb`, `match_borders` and `corner_tiles`. Unlike in
/// recipes, the default widths depend on the size of the tiles.
#[derive(Clone, Debug)]
struct MethodFlags;

impl NodeFlags for MethodFlags {
    const KIND: &'static str = "";
    const HEADING: Option<&'static str> = Some("Method");
    const FLAGS: &'static [Flag] = &[
        Flag::new("disturb/frozen", "frozen")
            .only_with("method", &["disturb"])
            .with_default("4, or 1/8 of the shorter side"),
        Flag::new("disturb/margin", "margin")
            .only_with("method", &["disturb"])
            .with_default("1/4 of the shorter side"),
        Flag::new("match_borders/options/width", "width")
            .only_with("method", &["borders"])
            .with_default("1/4 of the shorter side"),
        Flag::new("match_borders/options/source", "source").only_with("method", &["borders"]),
        Flag::new("corner_tiles/width", "share")
            .only_with("method", &["corners"])
            .with_default("0.75"),
    ];
}

/// A method with its options. An option is `None` if its default depends on the tiles.
#[derive(Clone, Copy, Debug)]
pub(super) enum Method {
    Disturb {
        frozen: Option<u32>,
        margin: Option<u32>,
    },
    Corners {
        share: f64,
    },
    Borders {
        width: Option<u32>,
        source: BorderSource,
    },
}

impl MethodArgs {
    /// Returns the method and its options for `count` input tiles. `writes_tiles` is true if the tiles themselves are
    /// written instead of a map of copies.
    ///
    /// # Errors
    ///
    /// If the method does not allow this number of tiles, or an option of another method was given.
    pub(super) fn method(&self, count: usize, writes_tiles: bool) -> Result<Method> {
        let name = self.method.unwrap_or(match count {
            1 => Name::Disturb,
            2..=CORNERS_MAX => Name::Corners,
            _ => Name::Borders,
        });
        self.node.check_used("method", &[("method", name.name())])?;
        match name {
            Name::Disturb if count != 1 => Err(usage(format!(
                "--method disturb takes one tile, and there are {count}"
            ))
            .hint("take --method corners or borders")),
            Name::Disturb if writes_tiles => Err(usage(
                "--tiles has no effect on disturb, whose copies are all different",
            )
            .hint("add --size WxH, or more tiles")),
            Name::Corners if !(2..=CORNERS_MAX).contains(&count) => Err(usage(format!(
                "--method corners takes 2 to {CORNERS_MAX} tiles, and there are {count}"
            ))
            .hint("take --method borders for more, or disturb for one")),
            Name::Disturb => Ok(Method::Disturb {
                frozen: self.node.get("frozen")?,
                margin: self.node.get("margin")?,
            }),
            Name::Corners => Ok(Method::Corners {
                share: self.node.get("share")?.unwrap_or_default(),
            }),
            Name::Borders => Ok(Method::Borders {
                width: self.node.get("width")?,
                source: self.node.get("source")?.unwrap_or_default(),
            }),
        }
    }
}

impl Method {
    /// Returns the names of the tiles in the set that is generated from `count` tiles, in the order of
    /// [`Tiles::tiles`].
    pub(super) fn tile_names(self, count: usize) -> Vec<String> {
        let Self::Corners { .. } = self else {
            return (1..=count).map(|tile| tile.to_string()).collect();
        };
        let corner = |index: usize, place: u32| (index / count.pow(place) % count + 1).to_string();
        (0..count.pow(4))
            .map(|index| [0, 1, 2, 3].map(|place| corner(index, place)).concat())
            .collect()
    }
}

/// A method, and the maps of each input tile. There is at least one tile.
#[derive(Clone, Copy, Debug)]
pub(super) struct Tiles<'a> {
    pub(super) method: Method,
    pub(super) materials: &'a [Vec<Map>],
}

impl Tiles<'_> {
    /// Renders a map of copies.
    ///
    /// # Errors
    ///
    /// If the method fails, for example because the tiles are too small.
    pub(super) fn render(&self, seed: Seed, size: [u32; 2]) -> Result<Vec<Map>, TileError> {
        match self.method {
            Method::Disturb { frozen, margin } => {
                let shorter = self.shorter();
                let default = Disturbance::new(seed);
                let disturbance = Disturbance {
                    frozen: frozen.unwrap_or(default.frozen.min(shorter / 8)),
                    margin: margin.unwrap_or(shorter / 4),
                    seed,
                };
                disturbance.render_maps(&self.materials[0], [0, 0], size)
            }
            Method::Corners { share } => {
                // Let the map repeat along each axis along which it is a whole number of tiles.
                let side = self.materials[0][0].size();
                let period = [0, 1].map(|axis| {
                    let tiles = size[axis] / side[axis];
                    size[axis].is_multiple_of(side[axis]).then_some(tiles)
                });
                let tiles = self.corners(share)?.with_period(period)?;
                tiles.render(seed, [0, 0], size)
            }
            Method::Borders { width, source } => {
                let borders = self.borders(width, source);
                borders.render(self.materials, seed, [0, 0], size)
            }
        }
    }

    /// Generates the set of tiles, in the order of [`tile_names`](Method::tile_names).
    ///
    /// # Errors
    ///
    /// If the method fails, for example because the tiles are too small.
    pub(super) fn tiles(&self) -> Result<Vec<Vec<Map>>, TileError> {
        match self.method {
            Method::Corners { share } => self.corners(share)?.all(),
            Method::Borders { width, source } => {
                self.borders(width, source).apply_maps(self.materials)
            }
            Method::Disturb { .. } => Ok(Vec::new()),
        }
    }

    fn corners(&self, share: f64) -> Result<CornerTiles, TileError> {
        CornerTiles::new(self.materials)?.with_width(share)
    }

    fn borders(&self, width: Option<u32>, source: BorderSource) -> MatchBorders {
        MatchBorders {
            width: width.unwrap_or((self.shorter() / 4).max(1)),
            source,
        }
    }

    fn shorter(&self) -> u32 {
        let [width, height] = self.materials[0][0].size();
        width.min(height)
    }
}

#[cfg(test)]
mod tests {
    use super::Method;

    #[test]
    fn tiles_of_corners_are_named_by_the_tiles_at_their_corners() {
        let names = Method::Corners { share: 0.5 }.tile_names(3);
        assert_eq!(names.len(), 81);
        assert_eq!(names[..4], ["1111", "2111", "3111", "1211"]);
        // The library counts corners as digits: a + b C + c C² + d C³.
        assert_eq!(names[2 + 3 + 27], "3212");
    }
}
