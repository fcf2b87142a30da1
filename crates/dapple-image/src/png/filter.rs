//! Chooses a filter for each row: the one with the smallest sum of absolute differences, as the specification
//! recommends.
//!
//! Each byte is replaced by its difference from a prediction. The prediction uses the bytes of the pixels at the
//! left, above, and above left, which are 0 outside the image.

use dapple_raster::simd;

/// Number of bytes processed in parallel.
const LANES: usize = 64;

/// Number of additions after which a 16-bit lane may overflow. Each absolute difference is at most 128.
const REGISTERS: usize = 256;

const SUB: u8 = 1;
const UP: u8 = 2;
const AVERAGE: u8 = 3;
const PAETH: u8 = 4;

/// Bytes of a row, and the bytes to the left, above and above left of each, which predict it. All have the same length.
#[derive(Clone, Copy)]
pub(super) struct Row<'a> {
    pub(super) here: &'a [u8],
    pub(super) left: &'a [u8],
    pub(super) above: &'a [u8],
    pub(super) corner: &'a [u8],
}

/// Writes the number of the chosen filter, followed by the filtered bytes of a row.
pub(super) fn filter(row: Row<'_>, out: &mut [u8]) {
    simd::dispatch!(simd::level(), simd => choose(row, out));
}

#[inline(always)]
fn choose(row: Row<'_>, out: &mut [u8]) {
    let costs = [
        (cost::<UP>(row), UP),
        (cost::<SUB>(row), SUB),
        (cost::<AVERAGE>(row), AVERAGE),
        (cost::<PAETH>(row), PAETH),
    ];
    // On a tie, the simplest filter wins.
    let (_, kind) = costs
        .into_iter()
        .min_by_key(|&(cost, _)| cost)
        .unwrap_or_default();
    let [number, out @ ..] = out else { return };
    *number = kind;
    match kind {
        SUB => write::<SUB>(row, out),
        UP => write::<UP>(row, out),
        AVERAGE => write::<AVERAGE>(row, out),
        _ => write::<PAETH>(row, out),
    }
}

/// Returns the sum of a row's absolute differences from the predictions of filter `KIND`. Differences are signed bytes.
#[inline(always)]
fn cost<const KIND: u8>(row: Row<'_>) -> u64 {
    let mut sum = 0;
    let part = |bytes| <[u8]>::chunks(bytes, LANES * REGISTERS);
    let parts = part(row.here)
        .zip(part(row.left))
        .zip(part(row.above))
        .zip(part(row.corner));
    for (((here, left), above), corner) in parts {
        let mut lanes = [0; LANES];
        let (here, here_end) = here.as_chunks();
        let (left, left_end) = left.as_chunks();
        let (above, above_end) = above.as_chunks();
        let (corner, corner_end) = corner.as_chunks();
        for (((here, left), above), corner) in here.iter().zip(left).zip(above).zip(corner) {
            add::<KIND>(&mut lanes, here, left, above, corner);
        }
        // Pad the remainder with zeros, which add nothing to the sum.
        let [here, left, above, corner] = [here_end, left_end, above_end, corner_end].map(padded);
        add::<KIND>(&mut lanes, &here, &left, &above, &corner);
        sum += lanes.into_iter().map(u64::from).sum::<u64>();
    }
    sum
}

/// Adds the absolute differences of `LANES` bytes from their predictions to the sums in `lanes`.
#[inline(always)]
fn add<const KIND: u8>(
    lanes: &mut [u16; LANES],
    here: &[u8; LANES],
    left: &[u8; LANES],
    above: &[u8; LANES],
    corner: &[u8; LANES],
) {
    for lane in 0..LANES {
        let predicted = predicted::<KIND>(left[lane], above[lane], corner[lane]);
        let difference = here[lane].wrapping_sub(predicted).cast_signed();
        // The sum cannot overflow, and without a check this is one instruction for many lanes.
        lanes[lane] = lanes[lane].wrapping_add(difference.unsigned_abs().into());
    }
}

fn padded(bytes: &[u8]) -> [u8; LANES] {
    let mut all = [0; LANES];
    all[..bytes.len()].copy_from_slice(bytes);
    all
}

#[inline(always)]
fn write<const KIND: u8>(row: Row<'_>, out: &mut [u8]) {
    let bytes = out
        .iter_mut()
        .zip(row.here)
        .zip(row.left)
        .zip(row.above)
        .zip(row.corner);
    for ((((out, &here), &left), &above), &corner) in bytes {
        *out = here.wrapping_sub(predicted::<KIND>(left, above, corner));
    }
}

#[inline(always)]
fn predicted<const KIND: u8>(left: u8, above: u8, corner: u8) -> u8 {
    match KIND {
        SUB => left,
        UP => above,
        AVERAGE => ((u16::from(left) + u16::from(above)) / 2) as u8,
        _ => paeth(left, above, corner),
    }
}

/// Returns the Paeth predictor: the neighbor nearest to `left + above - corner`; the first one on a tie.
#[inline(always)]
fn paeth(left: u8, above: u8, corner: u8) -> u8 {
    let of = i16::from;
    let [from_left, from_above] = [of(above) - of(corner), of(left) - of(corner)];
    let from_corner = (from_left + from_above).abs();
    let [from_left, from_above] = [from_left.abs(), from_above.abs()];
    let rest = if from_above <= from_corner {
        above
    } else {
        corner
    };
    let is_left = (from_left <= from_above) & (from_left <= from_corner);
    if is_left { left } else { rest }
}
