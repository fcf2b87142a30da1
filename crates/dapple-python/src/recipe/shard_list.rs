//! Shards: regions of a map that are baked independently.

use crate::error::Result;
use crate::grid::size as size_of;
use dapple::recipe::{Region, Shards};
use pyo3::exceptions::PyIndexError;
use pyo3::prelude::*;
use std::hash::{DefaultHasher, Hash, Hasher};

/// Splits an image into shards. Each is a window as a pair of (first row, first column) and (rows, columns), row by
/// row.
///
/// A shard is the region that one machine bakes; the last shards in each row and column are cropped at the border.
/// The shards are the same as those of `dapple shards`.
///
/// Parameters
/// ----------
/// size : int or tuple of int
///     (rows, columns), or one number for both.
/// shard : int or tuple of int
///     The size of a shard, (rows, columns), or one number for both.
///
/// Returns
/// -------
/// ShardList
///     The shards.
///
/// Raises
/// ------
/// DappleError
///     If a size is not one or two integers of at least 1.
#[pyfunction]
pub(crate) fn shards(size: &Bound<'_, PyAny>, shard: &Bound<'_, PyAny>) -> Result<ShardList> {
    let shards = Shards::new(size_of(size)?, size_of(shard)?)?;
    Ok(ShardList { shards })
}

/// The shards of an image: a sequence that takes no memory, however long it is.
#[pyclass(frozen, module = "dapple_textures")]
pub(crate) struct ShardList {
    shards: Shards,
}

/// Numbers of rows and columns.
type Sides = (u32, u32);

#[pymethods]
impl ShardList {
    /// Returns the number of shards along each column and each row.
    #[getter]
    fn grid(&self) -> Sides {
        let [columns, rows] = self.shards.grid();
        (rows, columns)
    }

    fn __len__(&self) -> usize {
        usize::try_from(self.shards.len()).unwrap_or(usize::MAX)
    }

    fn __getitem__(&self, index: i64) -> Result<(Sides, Sides)> {
        let index = if index < 0 {
            self.shards.len().checked_add_signed(index)
        } else {
            u64::try_from(index).ok()
        };
        let region = index.and_then(|index| self.shards.get(index));
        let Region {
            first: [column, row],
            size: [columns, rows],
        } = region.ok_or_else(|| PyIndexError::new_err("there are fewer shards"))?;
        Ok(((row, column), (rows, columns)))
    }

    fn __eq__(&self, other: &Bound<'_, PyAny>) -> bool {
        other
            .cast::<Self>()
            .is_ok_and(|other| other.get().shards == self.shards)
    }

    fn __hash__(&self) -> u64 {
        let mut hasher = DefaultHasher::new();
        self.shards.hash(&mut hasher);
        hasher.finish()
    }

    fn __reduce__(&self, py: Python<'_>) -> Result<(Py<PyAny>, (Sides, Sides))> {
        let make = py.import("dapple_textures._native")?.getattr("shards")?;
        let sides =
            [self.shards.size(), self.shards.shard()].map(|[columns, rows]| (rows, columns));
        Ok((make.unbind(), sides.into()))
    }
}
