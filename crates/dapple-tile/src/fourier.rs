//! The discrete Fourier transform of any length, with the same bits everywhere.
