//! Accessors: typed arrays in buffers, including strided and sparse ones.

use super::document::{Accessor, Sparse};
use super::{Source, wrong};
use crate::MeshIoError;

/// Values of an accessor, as a flat list.
pub(super) struct Column {
    /// Number of components per element, such as 3 for positions.
    pub(super) width: usize,
    pub(super) values: Vec<f64>,
}

/// Number of values that the accessors of a file may still produce.
///
/// Accessors may share bytes, represent zeros, and be used by many nodes, so a small file can claim a large amount of
/// memory. The limit is four values per byte of the file plus 2^24.
pub(super) struct Budget {
    left: usize,
}

/// Component type of an accessor.
#[derive(Clone, Copy)]
enum Component {
    I8,
    U8,
    I16,
    U16,
    U32,
    F32,
}

/// Bytes and layout of the elements in a buffer view.
struct Elements<'a> {
    bytes: &'a [u8],
    stride: usize,
    width: usize,
    component: Component,
}

impl Budget {
    pub(super) fn new(n_bytes: usize) -> Self {
        let left = n_bytes.saturating_mul(4).saturating_add(1 << 24);
        Self { left }
    }

    /// Subtracts `count` from the remaining values; fails if fewer are left.
    pub(super) fn take(&mut self, count: usize) -> Result<(), MeshIoError> {
        let left = self.left.checked_sub(count);
        self.left = left.ok_or_else(|| wrong("it says much more than it has bytes for"))?;
        Ok(())
    }
}

impl Source<'_> {
    /// Returns the number of elements of an accessor.
    pub(super) fn count(&self, index: usize) -> Result<usize, MeshIoError> {
        Ok(self.accessor(index)?.count)
    }

    /// Returns whether an accessor has no bytes in the file and therefore represents zeros.
    pub(super) fn is_without_bytes(&self, index: usize) -> Result<bool, MeshIoError> {
        let accessor = self.accessor(index)?;
        Ok(accessor.buffer_view.is_none() && accessor.sparse.is_none())
    }

    /// Reads an accessor's values as indices.
    pub(super) fn indices(
        &self,
        index: usize,
        budget: &mut Budget,
    ) -> Result<Vec<u32>, MeshIoError> {
        let kind = Component::new(self.accessor(index)?.component_type);
        let column = self.column(index, false, budget)?;
        if column.width != 1 || !kind.is_some_and(Component::is_index) {
            return Err(wrong(format!(
                "accessor {index} has a type that is not for indices"
            )));
        }
        // Integers below 2^32 are exact.
        Ok(column.values.iter().map(|&index| index as u32).collect())
    }

    /// Reads an accessor's values.
    ///
    /// Integers become fractions if they are normalized, or if `fractions` is set because the attribute is always
    /// fractional.
    pub(super) fn column(
        &self,
        index: usize,
        fractions: bool,
        budget: &mut Budget,
    ) -> Result<Column, MeshIoError> {
        let accessor = self.accessor(index)?;
        let (component, width) = Component::new(accessor.component_type)
            .zip(width(&accessor.shape))
            .ok_or_else(|| wrong(format!("accessor {index} has a type that there is not")))?;
        let count = accessor.count.saturating_mul(width);
        budget.take(count)?;
        let mut values = match accessor.buffer_view {
            None => vec![0.0; count],
            Some(view) => {
                let elements = self.elements(view, accessor.byte_offset, component, width)?;
                elements.read(accessor.count)?
            }
        };
        if let Some(sparse) = &accessor.sparse {
            self.replace(sparse, component, width, &mut values, budget)?;
        }
        if accessor.normalized || fractions {
            values
                .iter_mut()
                .for_each(|value| *value = component.fraction(*value));
        }
        Ok(Column { width, values })
    }

    fn accessor(&self, index: usize) -> Result<&Accessor, MeshIoError> {
        let accessor = self.document.accessors.get(index);
        accessor.ok_or_else(|| wrong(format!("there is no accessor {index}")))
    }

    fn elements(
        &self,
        view: usize,
        offset: usize,
        component: Component,
        width: usize,
    ) -> Result<Elements<'_>, MeshIoError> {
        let bytes = self.view(view)?.get(offset..);
        let bytes =
            bytes.ok_or_else(|| wrong(format!("an accessor begins past buffer view {view}")))?;
        let size = component.size() * width;
        let stride = self.document.buffer_views[view].byte_stride.unwrap_or(size);
        if stride < size {
            return Err(wrong(format!(
                "the stride of buffer view {view} is less than an element"
            )));
        }
        Ok(Elements {
            bytes,
            stride,
            width,
            component,
        })
    }

    /// Overwrites the elements that a sparse accessor substitutes.
    fn replace(
        &self,
        sparse: &Sparse,
        component: Component,
        width: usize,
        values: &mut [f64],
        budget: &mut Budget,
    ) -> Result<(), MeshIoError> {
        budget.take(sparse.count.saturating_mul(width + 1))?;
        let kind = sparse.indices.component_type.and_then(Component::new);
        let kind = kind
            .filter(|kind| kind.is_index())
            .ok_or_else(|| wrong("sparse indices have a type that is not for indices"))?;
        let places = self.elements(
            sparse.indices.buffer_view,
            sparse.indices.byte_offset,
            kind,
            1,
        )?;
        let elements = self.elements(
            sparse.values.buffer_view,
            sparse.values.byte_offset,
            component,
            width,
        )?;
        let (places, elements) = (places.read(sparse.count)?, elements.read(sparse.count)?);
        for (place, element) in places.into_iter().zip(elements.chunks_exact(width)) {
            let first = (place as usize).saturating_mul(width);
            let target = values.get_mut(first..first.saturating_add(width));
            target
                .ok_or_else(|| wrong("a sparse index is too large"))?
                .copy_from_slice(element);
        }
        Ok(())
    }
}

impl Elements<'_> {
    /// Reads the values of `count` elements.
    fn read(&self, count: usize) -> Result<Vec<f64>, MeshIoError> {
        let size = self.component.size();
        // The last element may be shorter than the stride.
        let needed = count.checked_sub(1).map_or(Some(0), |n| {
            n.checked_mul(self.stride)?.checked_add(size * self.width)
        });
        if needed.is_none_or(|needed| needed > self.bytes.len()) {
            return Err(wrong(
                "an accessor has more elements than its buffer view has bytes for",
            ));
        }
        let mut values = Vec::with_capacity(count * self.width);
        for element in 0..count {
            let element = &self.bytes[element * self.stride..];
            values.extend(
                element
                    .chunks_exact(size)
                    .take(self.width)
                    .map(|bytes| self.component.read(bytes)),
            );
        }
        Ok(values)
    }
}

impl Component {
    fn new(code: u32) -> Option<Self> {
        Some(match code {
            5120 => Self::I8,
            5121 => Self::U8,
            5122 => Self::I16,
            5123 => Self::U16,
            5125 => Self::U32,
            5126 => Self::F32,
            _ => return None,
        })
    }

    fn size(self) -> usize {
        match self {
            Self::I8 | Self::U8 => 1,
            Self::I16 | Self::U16 => 2,
            Self::U32 | Self::F32 => 4,
        }
    }

    /// Returns whether this type is allowed for indices.
    fn is_index(self) -> bool {
        matches!(self, Self::U8 | Self::U16 | Self::U32)
    }

    /// Converts the bytes of a component to a number.
    fn read(self, bytes: &[u8]) -> f64 {
        match (self, bytes) {
            (Self::I8, &[a]) => i8::from_le_bytes([a]).into(),
            (Self::U8, &[a]) => a.into(),
            (Self::I16, &[a, b]) => i16::from_le_bytes([a, b]).into(),
            (Self::U16, &[a, b]) => u16::from_le_bytes([a, b]).into(),
            (Self::U32, &[a, b, c, d]) => u32::from_le_bytes([a, b, c, d]).into(),
            (Self::F32, &[a, b, c, d]) => f32::from_le_bytes([a, b, c, d]).into(),
            // Unreachable: all callers pass the length of the type.
            _ => 0.0,
        }
    }

    /// Returns the fraction that a normalized integer stands for (specification, section 3.6.2.2).
    fn fraction(self, value: f64) -> f64 {
        match self {
            Self::I8 => (value / 127.0).max(-1.0),
            Self::U8 => value / 255.0,
            Self::I16 => (value / 32767.0).max(-1.0),
            Self::U16 => value / 65535.0,
            Self::U32 | Self::F32 => value,
        }
    }
}

fn width(shape: &str) -> Option<usize> {
    Some(match shape {
        "SCALAR" => 1,
        "VEC2" => 2,
        "VEC3" => 3,
        "VEC4" => 4,
        "MAT4" => 16,
        _ => return None,
    })
}
