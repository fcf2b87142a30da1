//! What a texture in the plane is made of: its pieces, and how well they fit.

use super::PlaneTexture;
use crate::{Edges, Exemplar, SynthError};
use dapple_raster::Raster;

/// How far around a pixel the texture is compared with the exemplar, in pixels.
const HALF: i64 = 2;

/// In place of the piece of a pixel that is in none yet.
const NONE: u32 = u32::MAX;

impl PlaneTexture {
    /// For each pixel the number of its piece, from 0, by their first pixels row by row: pixels beside each other are of one
    /// piece if their sources are beside each other in the same way.
    ///
    /// # Errors
    ///
    /// [`SynthErrorKind::Raster`](crate::SynthErrorKind::Raster) for a texture without pixels, which none is.
    pub fn pieces(&self) -> Result<Raster<u32>, SynthError> {
        let [width, height] = self.sources.size();
        let index = |[column, row]: [u32; 2]| row as usize * width as usize + column as usize;
        let mut pieces = vec![NONE; self.sources.pixels().len()];
        let mut n_pieces = 0;
        let mut open = Vec::new();
        for first in (0..height).flat_map(|row| (0..width).map(move |column| [column, row])) {
            if pieces[index(first)] != NONE {
                continue;
            }
            open.push(first);
            while let Some(place) = open.pop() {
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

    /// How unlike the texture around each pixel and the exemplar around its source are: the root of the mean squared
    /// difference of the values within two pixels, at least 0.
    ///
    /// Where it is 0 the exemplar goes on; else a border of pieces is near, and the more it can be seen, the larger it is.
    /// Values are those of the exemplar times the roots of their weights; sRGB codes from 0 to 1 for colors.
    ///
    /// # Errors
    ///
    /// [`SynthErrorKind::Raster`](crate::SynthErrorKind::Raster) for an exemplar of another size than the texture's.
    pub fn differences(&self, exemplar: &Exemplar) -> Result<Raster<f32>, SynthError> {
        Raster::filled(self.exemplar_size, ())?.check_same_size(exemplar.size)?;
        let size = self.sources.size();
        Ok(Raster::from_rows(size, |row| {
            (0..size[0]).map(move |column| self.difference(exemplar, [column, row]))
        })?)
    }

    /// The difference at a pixel.
    fn difference(&self, exemplar: &Exemplar, place: [u32; 2]) -> f32 {
        let n = exemplar.n_channels;
        let source = self.source(place);
        let (mut sum, mut n_values) = (0.0, 0);
        for step in (-HALF..=HALF).flat_map(|y| (-HALF..=HALF).map(move |x| [x, y])) {
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

    /// The pixel a step from another, if its source is as far from that one's.
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

    /// The pixel some steps from another; none past an edge that is cut.
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

    /// The source of a pixel.
    fn source(&self, [column, row]: [u32; 2]) -> [i64; 2] {
        self.sources.row(row)[column as usize].map(i64::from)
    }
}

#[cfg(test)]
mod tests;
