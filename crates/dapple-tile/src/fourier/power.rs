//! Computes the power spectrum of a plane.

use super::lines::columns;
use super::{BAND, Element, Fourier, LANES};
use dapple_raster::parallel;

/// Returns the powers `|F(k)|²` of all frequencies of a plane, row by row, starting with frequency `[0, 0]`.
///
/// `values` are the pixels of a plane of `size`, row by row. Frequencies beyond the middle of a side are negative. The
/// sum of all powers is the sum of all squared values times the number of values.
pub(crate) fn power_spectrum(values: &[f64], size: [usize; 2]) -> Vec<f64> {
    let [width, height] = size;
    let n_halves = height / 2 + 1;
    let spectra = column_spectra(values, width, n_halves);
    let mut powers = row_powers(&spectra, width, n_halves);
    // The spectrum of a real plane at a negative frequency is the conjugate of that at the positive frequency.
    for row in n_halves..height {
        let opposite = (height - row) * width;
        for column in 0..width {
            powers.push(powers[opposite + (width - column) % width]);
        }
    }
    powers
}

/// Computes the spectra of all columns up to the middle frequency, column by column.
fn column_spectra(values: &[f64], width: usize, n_halves: usize) -> Vec<[f64; 2]> {
    let height = values.len() / width;
    let fourier = Fourier::new(height);
    let spectra = parallel::map(width.div_ceil(BAND), |strip| {
        let first = strip * BAND;
        let mut lines = columns(values, width, first);
        fourier.forward(&mut lines);
        // Two real columns are the parts of one complex line; separate their spectra.
        let opposite = |row| (height - row) % height;
        let at = |row: usize, line| half_of_pair(&lines[row], &lines[opposite(row)], line);
        let spectrum = |line| (0..n_halves).map(move |row| at(row, line));
        let spectra = (0..BAND.min(width - first)).flat_map(spectrum);
        spectra.collect::<Vec<_>>()
    });
    spectra.concat()
}

/// Separates the spectrum of a real line that was transformed as the real or imaginary part of a complex line, given
/// the elements at a frequency and at its negative.
fn half_of_pair(element: &Element, opposite: &Element, line: usize) -> [f64; 2] {
    let lane = line % LANES;
    let [re, im] = [element[lane], element[LANES + lane]];
    let [opposite_re, opposite_im] = [opposite[lane], opposite[LANES + lane]];
    // The real part has the spectrum (F(k) + conj F(−k)) / 2, the imaginary part (F(k) − conj F(−k)) / 2i.
    if line < LANES {
        [0.5 * (re + opposite_re), 0.5 * (im - opposite_im)]
    } else {
        [0.5 * (im + opposite_im), 0.5 * (opposite_re - re)]
    }
}

/// Computes the powers of the rows up to the middle one, from the spectra of the columns.
fn row_powers(spectra: &[[f64; 2]], width: usize, n_halves: usize) -> Vec<f64> {
    let fourier = Fourier::new(width);
    let powers = parallel::map(n_halves.div_ceil(LANES), |strip| {
        let rows = strip * LANES..n_halves.min((strip + 1) * LANES);
        // Collect the spectra of these rows, one complex line for each row.
        let mut lines = vec![[0.0; BAND]; width];
        for (element, spectrum) in lines.iter_mut().zip(spectra.chunks_exact(n_halves)) {
            for (lane, [re, im]) in spectrum[rows.clone()].iter().enumerate() {
                element[lane] = *re;
                element[LANES + lane] = *im;
            }
        }
        fourier.forward(&mut lines);
        let power = |element: &Element, lane| {
            let [re, im] = [element[lane], element[LANES + lane]];
            re * re + im * im
        };
        let powers = |lane| lines.iter().map(move |element| power(element, lane));
        (0..rows.len()).flat_map(powers).collect::<Vec<_>>()
    });
    powers.concat()
}
