//! Wavelet noise at any position, in two and three dimensions.
