//! Image files: PNG with 8 or 16 bits and OpenEXR, with typed errors and limits.
