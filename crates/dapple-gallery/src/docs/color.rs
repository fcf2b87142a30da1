//! Renders the rows of images for the documentation of `dapple-color`.

use super::picture::{BANNER, COLORS, GRAYS, banner_of, colored, rounded, shaded};
use super::{Documented, Strip};
use crate::Panel;
use dapple_color::{
    ColorRamp, HeightPlane, LinearRgb, Normal, NormalOptions, NormalY, Outside, Palette, normal_map,
};
use dapple_color::{ColorStop, Interpolation};
use dapple_raster::{Field, Raster, Window, Wrap};
use dapple_worley::{Combination, Worley2, hash::Seed};
use glam::DVec2;

/// The folder of the crate and its rows of images, in the order of its documentation.
pub(super) const DOCUMENTED: Documented = Documented {
    folder: "crates/dapple-color",
    strips: &[
        INTERPOLATION,
        OUTSIDE,
        PALETTE,
        palette("palette-gray", || of(Palette::Gray)),
        palette("palette-lagoon", || of(Palette::Lagoon)),
        palette("palette-ember", || of(Palette::Ember)),
        palette("palette-terrain", || of(Palette::Terrain)),
        palette("palette-cow", || of(Palette::Cow)),
        palette("palette-giraffe", || of(Palette::Giraffe)),
        palette("palette-labels", || of(Palette::Labels)),
        NORMAL_MAP,
    ],
    banner: || {
        let height = height(BANNER)?;
        let mut panels = vec![shaded("", &height, GRAYS)];
        for palette in [
            Palette::Lagoon,
            Palette::Ember,
            Palette::Terrain,
            Palette::Giraffe,
        ] {
            panels.push(painted("", palette, &height));
        }
        panels.push(normals("", &height, &NormalOptions::default())?);
        banner_of(&panels)
    },
};

/// Width and height of a bar, in pixels.
const BAR: [u32; 2] = [192, 20];

/// Width and height of an image, in pixels.
const SMALL: u32 = 72;

const INTERPOLATION: Strip = Strip {
    name: "interpolation",
    caption: "Five stops",
    render: || {
        let kinds = [
            ("linear", Interpolation::Linear),
            ("stepped", Interpolation::Stepped),
            ("smooth", Interpolation::Smooth),
        ];
        let bars = kinds.map(|(label, kind)| bar(label, &ramp()?.with_interpolation(kind), 1.0));
        bars.into_iter().collect()
    },
};

const OUTSIDE: Strip = Strip {
    name: "outside",
    caption: "Values from 0 to 3",
    render: || {
        let kinds = [("clamp", Outside::Clamp), ("repeat", Outside::Repeat)];
        let bars = kinds.map(|(label, kind)| bar(label, &ramp()?.with_outside(kind), 3.0));
        bars.into_iter().collect()
    },
};

const PALETTE: Strip = Strip {
    name: "palette",
    caption: "A height as gray, and in three palettes",
    render: || {
        let height = height(SMALL)?;
        let palettes = [
            ("lagoon", Palette::Lagoon),
            ("ember", Palette::Ember),
            ("terrain", Palette::Terrain),
        ];
        let painted = palettes.map(|(label, palette)| painted(label, palette, &height));
        let mut panels = vec![shaded("the height", &height, GRAYS)];
        panels.extend(painted);
        Ok(panels)
    },
};

const NORMAL_MAP: Strip = Strip {
    name: "normal-map",
    caption: "",
    render: || {
        let height = height(SMALL)?;
        let mut panels = vec![shaded("a height", &height, GRAYS)];
        for (label, y) in [("OpenGL", NormalY::OpenGl), ("DirectX", NormalY::DirectX)] {
            let options = NormalOptions {
                y,
                ..NormalOptions::default()
            };
            panels.push(normals(label, &height, &options)?);
        }
        Ok(panels)
    },
};

const fn palette(name: &'static str, render: fn() -> anyhow::Result<Vec<Panel>>) -> Strip {
    Strip {
        name,
        caption: "",
        render,
    }
}

/// Renders a palette as a bar. Categorical palettes get bands without transitions.
fn of(palette: Palette) -> anyhow::Result<Vec<Panel>> {
    let ramp = match palette {
        Palette::Cow | Palette::Labels => ColorRamp::bands(&palette.colors())?,
        _ => palette.ramp(),
    };
    Ok(vec![bar("its colors", &ramp, 1.0)?])
}

/// Returns a ramp with unevenly spaced stops.
fn ramp() -> anyhow::Result<ColorRamp> {
    let stops = [
        (0.0, [20_u8, 24, 60]),
        (0.2, [40, 110, 140]),
        (0.5, [240, 220, 160]),
        (0.7, [220, 100, 50]),
        (1.0, [80, 20, 40]),
    ];
    let stops = stops.map(|(position, codes)| ColorStop {
        position,
        color: LinearRgb::from_srgb(codes),
    });
    Ok(ColorRamp::new(stops)?)
}

/// Renders a color ramp as a bar, for values from 0 at the left to `end` at the right.
fn bar(label: &str, ramp: &ColorRamp, end: f32) -> anyhow::Result<Panel> {
    let value = |column: u32| (column as f32 + 0.5) * end / BAR[0] as f32;
    let colors = Raster::from_fn(BAR, |column, _| ramp.at(value(column)))?;
    Ok(Panel::color(label, colors))
}

/// Returns a height map that repeats, with `side` × `side` pixels.
fn height(side: u32) -> anyhow::Result<Raster<f32>> {
    let bumps = Worley2::new(Seed(5))
        .with_period([Some(3); 2])?
        .combine(Combination::F1)
        .normalized()?;
    let window = Window::new(DVec2::ZERO, DVec2::splat(3.0), [side; 2])?;
    Ok(bumps.to_raster(&window)?.map(|value| 1.0 - value))
}

/// Returns a height map colored by a palette, with as many colors as a gray image has shades.
fn painted(label: &str, palette: Palette, height: &Raster<f32>) -> Panel {
    let height = height.map(|&value| rounded(value, GRAYS));
    Panel::color(label, palette.ramp().apply(&height))
}

fn normals(label: &str, height: &Raster<f32>, options: &NormalOptions) -> anyhow::Result<Panel> {
    let options = NormalOptions {
        plane: HeightPlane {
            wrap: [Wrap::Repeat; 2],
            ..options.plane
        },
        ..*options
    };
    let normals = normal_map(height, &options)?;
    let colors = normals.map(|normal: &Normal| LinearRgb::from_srgb(normal.to_codes::<u8>()));
    Ok(colored(label, &colors, COLORS))
}
