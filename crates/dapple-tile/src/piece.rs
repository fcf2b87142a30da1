//! Pieces of copies of a tile along one axis, and maps that are covered with such pieces.

use crate::TileError;
use dapple_raster::Raster;

/// A run of pixels, along one axis, within a copy of a tile.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Piece {
    /// Index of the copy. Copy 0 starts at pixel 0 of the plane.
    pub(crate) copy: i64,
    /// First pixel of the run, relative to the start of the copy.
    pub(crate) from: u32,
    /// Number of pixels.
    pub(crate) count: u32,
}

/// Returns the pieces of copies, each `side` pixels long, that cover the pixels `first..first + length` of the plane.
///
/// Beyond the largest `i64`, coordinates wrap around to the smallest, in the middle of a copy.
pub(crate) fn pieces(first: i64, length: u32, side: u32) -> Vec<Piece> {
    let mut pieces = Vec::new();
    let mut done = 0;
    while done < length {
        let at = first.wrapping_add(done.into());
        let from = at.rem_euclid(side.into()) as u32;
        // Number of pixels up to the largest coordinate, where coordinates wrap around.
        let before_end =
            u32::try_from(i64::MAX.saturating_sub(at)).map_or(u32::MAX, |n| n.saturating_add(1));
        // A piece ends with its copy, with the map, or with the coordinates.
        let count = (side - from).min(length - done).min(before_end);
        pieces.push(Piece {
            copy: at.div_euclid(side.into()),
            from,
            count,
        });
        done += count;
    }
    pieces
}

/// Builds a map that is covered with pieces of copies, one for each column and row of pieces.
pub(crate) fn lay<'a>(
    [columns, rows]: [&[Piece]; 2],
    copy: impl Fn([usize; 2]) -> &'a Raster<f32> + Sync,
) -> Result<Raster<f32>, TileError> {
    // For each row of the map, find the index of its piece and the row within the copy.
    let rows = (0..).zip(rows).flat_map(|(index, piece)| {
        (piece.from..piece.from + piece.count).map(move |row| (index, row))
    });
    let rows: Vec<(usize, u32)> = rows.collect();
    let width = columns.iter().map(|piece| piece.count).sum();
    Ok(Raster::from_rows([width, rows.len() as u32], |row| {
        let (below, row) = rows[row as usize];
        let copy = &copy;
        (0..).zip(columns).flat_map(move |(beside, piece)| {
            let pixels = &copy([beside, below]).row(row)[piece.from as usize..];
            pixels[..piece.count as usize].iter().copied()
        })
    })?)
}

#[cfg(test)]
mod tests {
    use super::pieces;

    #[test]
    fn pieces_cover_every_pixel_with_its_own() {
        for side in [1, 2, 7, 40] {
            for first in [0, -1, 5, -93, i64::MIN, i64::MAX, i64::MAX - 20] {
                let mut at = first;
                for piece in pieces(first, 75, side) {
                    for pixel in piece.from..piece.from + piece.count {
                        let expected = [at.div_euclid(side.into()), at.rem_euclid(side.into())];
                        assert_eq!([piece.copy, pixel.into()], expected, "{first}, {side}");
                        at = at.wrapping_add(1);
                    }
                }
                assert_eq!(at, first.wrapping_add(75));
            }
        }
        assert!(pieces(3, 0, 9).is_empty());
    }
}
