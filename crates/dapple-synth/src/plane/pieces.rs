//! Finds the pieces that a texture in the plane consists of, and measures how well they fit together.

use super::PlaneTexture;
use crate::{Edges, Exemplar, SynthError};
use dapple_raster::Raster;

/// Half-side length of the window in which texture and exemplar are compared, in pixels.
const HALF: i64 = 2;

/// Marks a pixel that has not been assigned to a piece yet.
const NONE: u32 = u32::MAX;

impl PlaneTexture {
    /// Labels the pieces of the texture: returns the index of each pixel's piece. Adjacent pixels belong to the same
    /// piece if their sources are adjacent in the same direction. Indices start at 0, in row-major order of each
    /// piece's first pixel.
    ///
    /// # Errors
    ///
    /// [`SynthErrorKind::Raster`](crate::SynthErrorKind::Raster) for a texture without pixels, which cannot be
    /// constructed.
    pub fn pieces(&self) -> Result<Raster<u32>, SynthError> {
        let [width, height] = self.sources.size();
        let index = |[column, row]: [u32; 2]| row as usize * width as usize + column as usize;
        let mut pieces = vec![NONE; self.sources.pixels().len()];
        let mut n_pieces = 0;
        let mut open = Vec::new();
        // Flood-fill each piece from its first pixel.
        for first in (0..height).flat_map(|row| (0..width).map(move |column| [column, row])) {
            if pieces[index(first)] != NONE {
                continue;
            }
            open.push(first);
            while let Some(place) = open.pop() {
                // A pixel can be pushed several times. Only its first visit counts, so each pixel is expanded once.
                if pieces[index(place)] == NONE {
                    pieces[index(place)] = n_pieces;
                    let steps = [[1, 0], [0, 1], [-1, 0], [0, -1]];
                    open.extend(
                        steps
                            .into_iter()
                            .filter_map(|step| self.goes_on(place, step)),
                    );
                }
            }
            n_pieces += 1;
        }
        Ok(Raster::from_vec([width, height], pieces)?)
    }

    /// Measures how well pieces fit together. For each pixel, returns the root mean squared difference, at least 0,
    /// between a window of the texture and the window around the pixel's source in the exemplar. The windows extend two
    /// pixels in each direction.
    ///
    /// A difference of 0 means that the texture continues the exemplar. Near a border between pieces it is larger; the
    /// more visible the border, the larger the value. The values that are compared are the exemplar's, multiplied by
    /// the square roots of their weights; for colors, these are sRGB codes from 0 to 1.
    ///
    /// # Errors
    ///
    /// [`SynthErrorKind::Raster`](crate::SynthErrorKind::Raster) if the exemplar is not the same size as the texture's.
    pub fn differences(&self, exemplar: &Exemplar) -> Result<Raster<f32>, SynthError> {
        Raster::filled(self.exemplar_size, ())?.check_same_size(exemplar.size)?;
        let size = self.sources.size();
        Ok(Raster::from_rows(size, |row| {
            (0..size[0]).map(move |column| self.difference(exemplar, [column, row]))
        })?)
    }

    /// Returns the root mean squared difference at a pixel.
    fn difference(&self, exemplar: &Exemplar, place: [u32; 2]) -> f32 {
        let n = exemplar.n_channels;
        let source = self.source(place);
        let (mut sum, mut n_values) = (0.0, 0);
        for step in (-HALF..=HALF).flat_map(|y| (-HALF..=HALF).map(move |x| [x, y])) {
            // Skip pixels past an edge of the texture or of the exemplar.
            let beside = self.beside(place, step);
            let expected = exemplar.pixel_at([source[0] + step[0], source[1] + step[1]]);
            let (Some(beside), Some(expected)) = (beside, expected) else {
                continue;
            };
            let Some(found) = exemplar.pixel_at(self.source(beside)) else {
                continue;
            };
            let pair = [found, expected].map(|pixel| &exemplar.pixels[pixel * n..][..n]);
            for (a, b) in pair[0].iter().zip(pair[1]) {
                sum += (a - b) * (a - b);
            }
            n_values += n;
        }
        (sum / n_values.max(1) as f32).sqrt()
    }

    /// Returns the pixel at an offset from another one, if the sources of the two pixels have the same offset.
    fn goes_on(&self, place: [u32; 2], step: [i64; 2]) -> Option<[u32; 2]> {
        let beside = self.beside(place, step)?;
        let [from, to] = [place, beside].map(|place| self.source(place));
        let is_next = (0..2).all(|axis| {
            let expected = from[axis] + step[axis];
            to[axis]
                == match self.exemplar_edges {
                    Edges::Cut => expected,
                    Edges::Wrap => expected.rem_euclid(self.exemplar_size[axis].into()),
                }
        });
        is_next.then_some(beside)
    }

    /// Returns the pixel at an offset from another one; `None` past a cut edge.
    fn beside(&self, place: [u32; 2], step: [i64; 2]) -> Option<[u32; 2]> {
        let mut beside = [0; 2];
        for axis in 0..2 {
            let side = i64::from(self.sources.size()[axis]);
            let at = i64::from(place[axis]) + step[axis];
            beside[axis] = match self.edges[axis] {
                Edges::Cut if !(0..side).contains(&at) => return None,
                Edges::Cut => at,
                Edges::Wrap => at.rem_euclid(side),
            } as u32;
        }
        Some(beside)
    }

    /// Returns the source of a pixel: column and row in the exemplar.
    fn source(&self, [column, row]: [u32; 2]) -> [i64; 2] {
        self.sources.row(row)[column as usize].map(i64::from)
    }
}

#[cfg(test)]
mod tests;
