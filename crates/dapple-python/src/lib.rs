//! The native part of the Python package `dapple-textures`: exposes the dapple crates with NumPy arrays.
//!
//! A call checks its arguments while it holds the interpreter lock. It then releases the lock and works on the
//! package's threads ([`threads`]). Fields are descriptions, from which other processes can rebuild them
//! ([`function`]).

mod arrays;
mod bands;
mod blending;
mod color_field;
mod data;
mod error;
mod field;
mod function;
mod generators;
mod grid;
mod images;
mod maps;
mod meshes;
mod models;
mod options;
mod photos;
mod pictures;
mod points;
mod pups;
mod recipe;
mod seed;
mod shared;
mod synthesis;
mod threads;
mod tiles;
mod watch;

use pyo3::prelude::*;

/// The native module.
#[pymodule]
mod _native {
    #[pymodule_export]
    use crate::bands::{
        wavelet_analyze, wavelet_double, wavelet_halve, wavelet_synthesize, wavelet_tile,
    };
    #[pymodule_export]
    use crate::blending::{blend, blend_map};
    #[pymodule_export]
    use crate::color_field::ColorField;
    #[pymodule_export]
    use crate::error::{DappleError, DappleWarning};
    #[pymodule_export]
    use crate::field::{_field_from_description, Field, constant};
    #[pymodule_export]
    use crate::generators::{Worley, gradient_noise, wavelet_noise, worley};
    #[pymodule_export]
    use crate::images::{decode_image, encode_image, read_image, write_image, write_maps};
    #[pymodule_export]
    use crate::maps::{
        ambient_occlusion, curvature, linear_from_srgb, normal_map, palettes, ramp,
        srgb_from_linear,
    };
    #[pymodule_export]
    use crate::meshes::{mesh_report, read_model};
    #[pymodule_export]
    use crate::models::{_model_from_parts, Model, repair_on, synthesize_along, synthesize_on};
    #[pymodule_export]
    use crate::photos::{estimate_material, even_out, rectify, resize};
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
    use crate::recipe::{_map_info, _plan_from_parts, Plan, Recipe, ShardList, map_names, shards};
    #[pymodule_export]
    use crate::synthesis::{repair, synthesize};
    #[pymodule_export]
    use crate::threads::{set_threads, threads};
    #[pymodule_export]
    use crate::tiles::{
        CornerTiles, disturb, lay_tiles, make_tile, match_borders, rank_equalize, repeat,
        seam_report,
    };

    use crate::arrays;
    use pyo3::prelude::*;

    #[pymodule_init]
    fn init(module: &Bound<'_, PyModule>) -> PyResult<()> {
        arrays::load(module.py())?;
        // Set class attributes, so that attributes are None if an error does not set them.
        let error = module.getattr("DappleError")?;
        for attribute in ["kind", "node", "hint"] {
            error.setattr(attribute, module.py().None())?;
        }
        module.add("__version__", env!("CARGO_PKG_VERSION"))
    }
}
