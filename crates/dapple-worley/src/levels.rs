//! The SIMD levels that code is compiled for.
//!
//! On x86-64 these are SSE2, AVX2 and AVX-512. Nearly all processors with SSE4.2 have AVX2, and to compile everything a
//! fourth time for the others takes a quarter of the time that this crate takes to compile.

/// Runs an operation with the registers of a level, as `fearless_simd::dispatch!` does.
#[cfg(target_arch = "x86_64")]
macro_rules! dispatch {
    ($level:expr, $simd:ident => $op:expr) => {{
        use fearless_simd::Simd as _;
        let level: fearless_simd::Level = $level;
        if let Some($simd) = level.as_avx512() {
            $simd.vectorize(
                #[inline(always)]
                || $op,
            )
        } else if let Some($simd) = level.as_avx2() {
            $simd.vectorize(
                #[inline(always)]
                || $op,
            )
        } else {
            baseline!($simd => $op)
        }
    }};
}

#[cfg(not(target_arch = "x86_64"))]
macro_rules! dispatch {
    ($level:expr, $simd:ident => $op:expr) => {
        fearless_simd::dispatch!($level, $simd => $op)
    };
}

/// Runs an operation with the registers that every processor has: for what gains little from larger ones.
#[cfg(target_arch = "x86_64")]
macro_rules! baseline {
    ($simd:ident => $op:expr) => {{
        use fearless_simd::Simd as _;
        let baseline = fearless_simd::Level::baseline().as_sse2();
        let $simd = baseline.expect("SSE2 is a part of x86-64");
        $simd.vectorize(
            #[inline(always)]
            || $op,
        )
    }};
}

#[cfg(not(target_arch = "x86_64"))]
macro_rules! baseline {
    ($simd:ident => $op:expr) => {
        fearless_simd::dispatch!(fearless_simd::Level::baseline(), $simd => $op)
    };
}
