//! The native half of the Python package `dapple-textures`: the crates of dapple, with NumPy arrays in and out.
//!
//! A call checks what it is given while it holds the interpreter, and works without it, on threads of its own
//! ([`threads`]). Fields are descriptions that are made again in other processes ([`function`]).

mod arrays;
mod color_field;
mod data;
mod error;
mod field;
mod function;
mod generators;
mod grid;
mod points;
mod pups;
mod seed;
mod threads;

use pyo3::prelude::*;

/// What the package is made of.
#[pymodule]
mod _native {
    #[pymodule_export]
    use crate::color_field::ColorField;
    #[pymodule_export]
    use crate::error::DappleError;
    #[pymodule_export]
    use crate::field::{_field_from_description, Field, constant};
    #[pymodule_export]
    use crate::generators::{Worley, gradient_noise, wavelet_noise, worley};
    #[pymodule_export]
    use crate::points::{
        _graph_from_description, Domain, Graph, Points, delaunay, extend_poisson_disk, gabriel,
        jittered_grid, k_nearest, nested_poisson_disk, poisson_disk, spectrum, white_noise, yao,
    };
    #[pymodule_export]
    use crate::pups::{
        _partition_from_description, _texture, _texture_defaults, Partition, angle_orientations,
        biased_labels, grouped_labels, outward_orientations, pups, random_labels,
        random_orientations, random_values, reference_labels,
    };
    #[pymodule_export]
    use crate::threads::{set_threads, threads};

    use pyo3::prelude::*;

    #[pymodule_init]
    fn init(module: &Bound<'_, PyModule>) -> PyResult<()> {
        module.add("__version__", env!("CARGO_PKG_VERSION"))
    }
}
