//! Seamless rasters of wavelet noise, weighted band by band.
