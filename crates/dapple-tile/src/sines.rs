//! The periodic Fourier projector.
