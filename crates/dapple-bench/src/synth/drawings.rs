//! Draws exemplars in short code, so that no files are needed. They are of the same kinds as the paper's exemplars.
//!
//! All of them tile. Positions range from 0 to 1 along both axes, with v pointing down. Colors are sRGB codes from 0
//! to 255.

use crate::sets::SEED;
use anyhow::Result;
use dapple_color::LinearRgb;
use dapple_hash::{hash2, unit_f64};
use dapple_raster::Raster;
use glam::DVec2;

/// Number of samples along each side of a pixel.
const N_SAMPLES: u32 = 4;

/// A drawing: a function that returns the color at a position.
pub(super) type Drawing = fn(DVec2) -> [f64; 3];

/// Draws a square image, rounded to 8-bit sRGB codes.
pub(super) fn draw(drawing: Drawing, side: u32) -> Result<Raster<LinearRgb>> {
    let n_samples = side * N_SAMPLES;
    let place = |index: u32| (f64::from(index) + 0.5) / f64::from(n_samples);
    Ok(Raster::from_fn([side; 2], |column, row| {
        let mut sums = [0.0; 3];
        for y in row * N_SAMPLES..(row + 1) * N_SAMPLES {
            for x in column * N_SAMPLES..(column + 1) * N_SAMPLES {
                let color = drawing(DVec2::new(place(x), place(y)));
                for (sum, code) in sums.iter_mut().zip(color) {
                    *sum += code / f64::from(N_SAMPLES * N_SAMPLES);
                }
            }
        }
        LinearRgb::from_srgb(sums.map(|code| (code + 0.5).clamp(0.0, 255.0) as u8))
    })?)
}

/// Draws a checkerboard with slightly wavy lines.
pub(super) fn checker(at: DVec2) -> [f64; 3] {
    let sway = DVec2::new(wave(5.0 * at.y + at.x), wave(5.0 * at.x - at.y + 0.3));
    let square = ((at + 0.013 * sway) * 6.0).floor();
    if (square.x + square.y) as i64 % 2 == 0 {
        [236.0; 3]
    } else {
        [12.0; 3]
    }
}

/// Draws pale suction cups with rims on red skin.
pub(super) fn suckers(at: DVec2) -> [f64; 3] {
    let near = nearest(at, 4, 0.5);
    let part = near.distance / (0.3 + 0.15 * roll(near.cell, 3));
    match part {
        part if part > 1.0 => mix([120.0, 40.0, 20.0], [190.0, 90.0, 50.0], part - 1.0),
        part if part > 0.75 => [70.0, 20.0, 12.0],
        part => mix([90.0, 40.0, 20.0], [250.0, 225.0, 180.0], 1.6 * part),
    }
}

/// Draws rows of round scales, each overlapping the row below it.
pub(super) fn scales(at: DVec2) -> [f64; 3] {
    let [across, down] = [8.0, 12.0];
    // Upper rows lie on top of lower ones: the first row whose scale reaches this far down is visible.
    let row = (at.y * down).floor() as i64;
    for row in row - 1..=row + 1 {
        let shift = 0.5 * row.rem_euclid(2) as f64;
        let x = at.x * across - shift;
        let column = x.floor();
        let place = DVec2::new(x - column - 0.5, (at.y * down - row as f64) * 0.5);
        let distance = place.length() / 0.72;
        if distance < 1.0 {
            let cell = [(column as i64).rem_euclid(8), row.rem_euclid(12)];
            let color = mix([60.0, 110.0, 60.0], [150.0, 190.0, 90.0], roll(cell, 0));
            return color.map(|code| code * (1.1 - 0.7 * distance * distance));
        }
    }
    [25.0, 40.0, 25.0]
}

/// Draws strands woven over and under each other.
pub(super) fn weave(at: DVec2) -> [f64; 3] {
    let scaled = at * 8.0;
    let cell = scaled.floor();
    let place = scaled - cell - 0.5;
    let over = (cell.x + cell.y) as i64 % 2 == 0;
    let [across, along, strand] = if over {
        [place.y, place.x, cell.y]
    } else {
        [place.x, place.y, cell.x]
    };
    // Each strand has its own shade; otherwise all copies of two strands would be equal.
    let strand = roll([(strand as i64).rem_euclid(8), i64::from(over)], 10);
    let shade = (0.7 + 0.4 * strand) * (1.0 - 3.2 * across * across) * (1.0 - 1.2 * along * along);
    let color = if over {
        [215.0, 170.0, 90.0]
    } else {
        [120.0, 70.0, 50.0]
    };
    if across.abs() > 0.42 {
        return [30.0, 22.0, 18.0];
    }
    color.map(|code| code * shade)
}

/// Draws lines of illegible letters.
pub(super) fn text(at: DVec2) -> [f64; 3] {
    let scaled = at * DVec2::new(22.0, 14.0);
    let letter = scaled.floor();
    let cell = [
        (letter.x as i64).rem_euclid(22),
        (letter.y as i64).rem_euclid(14),
    ];
    // A letter is drawn on a grid of three by five squares, with a gap to the right and below.
    let place = ((scaled - letter) * DVec2::new(4.0, 6.0)).floor();
    let inside = place.x < 3.0 && place.y < 5.0;
    // There are 24 letters; about one cell in six is a space.
    let kind = (roll(cell, 1) * 29.0) as i64;
    let stroke = roll([kind, (place.x + 3.0 * place.y) as i64], 2) < 0.5;
    if inside && kind < 24 && stroke {
        [30.0, 30.0, 40.0]
    } else {
        [238.0, 232.0, 215.0]
    }
}

/// Draws puzzle pieces in several colors with dark seams.
pub(super) fn puzzle(at: DVec2) -> [f64; 3] {
    let sway = DVec2::new(wave(7.0 * at.y), wave(6.0 * at.x));
    let near = nearest(at + 0.012 * sway, 5, 0.9);
    if near.gap < 0.07 {
        return [35.0, 25.0, 30.0];
    }
    let color = mix(
        [60.0, 90.0, 170.0],
        [230.0, 190.0, 60.0],
        roll(near.cell, 4),
    );
    color.map(|code| code * (0.85 + 0.3 * near.gap.min(0.5)))
}

/// Draws a brick wall in running bond; each brick has its own color and some roughness.
#[cfg(feature = "peers")]
pub(super) fn bricks(at: DVec2) -> [f64; 3] {
    let scaled = at * DVec2::new(4.0, 8.0);
    let row = scaled.y.floor();
    let across = scaled.x - 0.5 * (row as i64 % 2) as f64;
    let cell = [(across.floor() as i64).rem_euclid(4), row as i64];
    let place = DVec2::new(2.0 * (across - across.floor() - 0.5), scaled.y - row - 0.5);
    let inside = (1.0 - place.x.abs()).min(0.5 - place.y.abs());
    let grain = roll([(at.x * 128.0) as i64, (at.y * 128.0) as i64], 5) - 0.5;
    if inside < 0.09 {
        return [186.0, 178.0, 164.0].map(|code| code + 40.0 * grain);
    }
    let color = mix([110.0, 42.0, 32.0], [213.0, 148.0, 104.0], roll(cell, 6));
    let light = 0.85 + 0.3 * roll(cell, 7) + 0.25 * grain - 0.3 * place.y;
    color.map(|code| code * light)
}

/// The jittered point nearest to a position.
struct Nearest {
    /// Cell that contains the point, the same in every copy of the image.
    cell: [i64; 2],
    /// Distance to the point, in cells.
    distance: f64,
    /// Distance to the second nearest point minus the distance to the nearest one, in cells.
    gap: f64,
}

/// Returns the nearest of `n`×`n` points on the unit torus. Each is displaced from the center of its cell by up to half
/// of `jitter` along each axis, in cells.
fn nearest(at: DVec2, n: i64, jitter: f64) -> Nearest {
    let scaled = at * n as f64;
    let mut found: [(f64, [i64; 2]); 2] = [(f64::INFINITY, [0; 2]); 2];
    for y in scaled.y.floor() as i64 - 2..=scaled.y.floor() as i64 + 2 {
        for x in scaled.x.floor() as i64 - 2..=scaled.x.floor() as i64 + 2 {
            let cell = [x, y].map(|index| index.rem_euclid(n));
            let offset = DVec2::new(roll(cell, 8), roll(cell, 9)) - 0.5;
            let point = DVec2::new(x as f64, y as f64) + 0.5 + jitter * offset;
            let distance = point.distance(scaled);
            if distance < found[0].0 {
                found = [(distance, cell), found[0]];
            } else if distance < found[1].0 {
                found[1] = (distance, cell);
            }
        }
    }
    let [(distance, cell), (second, _)] = found;
    Nearest {
        cell,
        distance,
        gap: second - distance,
    }
}

/// Returns a random number from 0 to 1 for a cell. Different values of `index` give independent numbers.
fn roll(cell: [i64; 2], index: u32) -> f64 {
    unit_f64(hash2(SEED.child("bench drawings", 0), cell, index))
}

/// Returns one period of a wave from -1 to 1, built from two parabolas.
fn wave(at: f64) -> f64 {
    let part = at - at.floor();
    if part < 0.5 {
        16.0 * part * (0.5 - part)
    } else {
        -16.0 * (part - 0.5) * (1.0 - part)
    }
}

/// Interpolates linearly from `a` to `b`; `part` is the weight of `b`.
fn mix(a: [f64; 3], b: [f64; 3], part: f64) -> [f64; 3] {
    let part = part.clamp(0.0, 1.0);
    [0, 1, 2].map(|channel| a[channel] + (b[channel] - a[channel]) * part)
}

#[cfg(test)]
mod tests {
    use super::*;

    const DRAWINGS: [(&str, Drawing); 6] = [
        ("checker", checker),
        ("suckers", suckers),
        ("scales", scales),
        ("weave", weave),
        ("text", text),
        ("puzzle", puzzle),
    ];

    #[test]
    fn drawings_repeat() {
        for (name, drawing) in DRAWINGS {
            for step in 0..100 {
                // These positions avoid edges, where rounding could change the color.
                let at = DVec2::new(0.0371, 0.0213) * f64::from(step) + 0.0017;
                let at = at - at.floor();
                let [here, there] = [at, at + 1.0].map(drawing);
                let same = here.iter().zip(there).all(|(a, b)| (a - b).abs() < 1e-6);
                assert!(same, "{name} has {here:?} and {there:?} at {at}");
            }
        }
    }

    #[test]
    fn drawings_have_much_to_synthesize_from() {
        for (name, drawing) in DRAWINGS {
            let picture = draw(drawing, 64).unwrap();
            let light = |color: &LinearRgb| color.to_srgb::<u8>()[1];
            let dark = picture.pixels().iter().filter(|color| light(color) < 110);
            let part = dark.count() as f64 / picture.pixels().len() as f64;
            assert!((0.02..0.98).contains(&part), "{name} is dark in {part}");
        }
    }
}
