//! Compiled shaders of a device, by their text.
//!
//! Where the values of a recipe are [uploaded](crate::Gpu::upload_values), all states of a slider have one text.

use crate::device::{Device, Pipeline};
use crate::{GpuError, GpuErrorKind};
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, OnceLock, PoisonError};
use std::thread;

/// Maximum number of shaders that are kept.
const MAX_KEPT: usize = 64;

/// Maximum number of shaders that are compiled in the background at once.
const MAX_COMPILING: usize = 2;

/// A shader that is compiled once, by the first thread that needs it.
type Cell = Arc<OnceLock<Result<Pipeline, GpuError>>>;

/// Compiles a shader, or waits for the thread that compiles it.
fn compiled(device: &Device, wgsl: &str, cell: &Cell) -> Result<Pipeline, GpuError> {
    let compile = || {
        let compiled = Pipeline::new(device, wgsl);
        device.pipelines.n_compiled.fetch_add(1, Ordering::Relaxed);
        compiled
    };
    cell.get_or_init(compile).clone()
}

/// The shaders of a device that were used last.
#[derive(Debug, Default)]
pub(crate) struct Pipelines {
    /// The shader that was not used for the longest time comes first.
    kept: Mutex<Vec<(String, Cell)>>,
    n_compiled: AtomicU64,
}

impl Pipelines {
    /// Returns the compiled shader of a text.
    ///
    /// # Errors
    ///
    /// If the device refuses the shader, or [`Compiling`](GpuErrorKind::Compiling) if it compiles in the background.
    pub(crate) fn get(device: &Device, wgsl: &str) -> Result<Pipeline, GpuError> {
        let pipelines = &device.pipelines;
        let compiling = || GpuError::new(GpuErrorKind::Compiling);
        let (cell, is_new) = pipelines.cell(device, wgsl).ok_or_else(compiling)?;
        let compiled = match (cell.get(), device.is_background) {
            (Some(compiled), _) => compiled.clone(),
            (None, false) => compiled(device, wgsl, &cell),
            (None, true) if !is_new => return Err(compiling()),
            (None, true) => {
                let (on, text, shared) = (device.clone(), wgsl.to_owned(), cell.clone());
                let thread = thread::Builder::new().name("shader".to_owned());
                match thread.spawn(move || compiled(&on, &text, &shared)) {
                    Ok(_) => return Err(compiling()),
                    Err(_) => compiled(device, wgsl, &cell),
                }
            }
        };
        if compiled.is_err() {
            // A device that had too little memory may have more later.
            pipelines.lock().retain(|(text, _)| text != wgsl);
        }
        compiled
    }

    /// Returns how many shaders were compiled.
    pub(crate) fn n_compiled(&self) -> u64 {
        self.n_compiled.load(Ordering::Relaxed)
    }

    /// Returns the cell of a text, and whether it is new. `None` if it is, and enough shaders compile in the background.
    fn cell(&self, device: &Device, wgsl: &str) -> Option<(Cell, bool)> {
        let mut kept = self.lock();
        if let Some(at) = kept.iter().position(|(text, _)| text == wgsl) {
            kept[at..].rotate_left(1);
            return kept.last().map(|(_, cell)| (cell.clone(), false));
        }
        let compiling = kept.iter().filter(|(_, cell)| cell.get().is_none());
        if device.is_background && compiling.count() >= MAX_COMPILING {
            return None;
        }
        if kept.len() >= MAX_KEPT {
            kept.remove(0);
        }
        let cell = Cell::default();
        kept.push((wgsl.to_owned(), cell.clone()));
        Some((cell, true))
    }

    fn lock(&self) -> MutexGuard<'_, Vec<(String, Cell)>> {
        self.kept.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

#[cfg(test)]
mod tests {
    use super::{MAX_KEPT, Pipelines};
    use crate::GpuErrorKind;
    use crate::device::Device;
    use crate::exactness::tests::device;

    /// Returns the number of compiled shaders after that of `number` was needed.
    fn n_compiled_after(device: &Device, number: usize) -> u64 {
        let text = format!("@compute @workgroup_size(64) fn main() {{}} // {number}");
        Pipelines::get(device, &text).expect("a shader");
        device.pipelines.n_compiled()
    }

    #[test]
    fn the_shaders_that_were_used_last_are_kept() {
        let Some(device) = device() else { return };
        for number in 0..MAX_KEPT {
            assert_eq!(n_compiled_after(&device, number), number as u64 + 1);
        }
        let all = MAX_KEPT as u64;
        assert_eq!(n_compiled_after(&device, 0), all);
        // The shader that was not used for the longest time is dropped.
        assert_eq!(n_compiled_after(&device, MAX_KEPT), all + 1);
        assert_eq!(n_compiled_after(&device, 0), all + 1);
        assert_eq!(n_compiled_after(&device, 1), all + 2);
    }

    #[test]
    fn a_shader_in_the_background_is_an_error_until_it_is_compiled() {
        let Some(mut device) = device() else { return };
        device.is_background = true;
        let text = "@compute @workgroup_size(64) fn main() {}";
        let error = Pipelines::get(&device, text).expect_err("it is not compiled");
        assert_eq!(*error.kind(), GpuErrorKind::Compiling);
        // Wait for the other thread.
        device.is_background = false;
        Pipelines::get(&device, text).expect("a shader");
        device.is_background = true;
        Pipelines::get(&device, text).expect("a shader");
        assert_eq!(device.pipelines.n_compiled(), 1);
    }

    #[test]
    fn a_shader_that_is_refused_is_an_error() {
        let Some(device) = device() else { return };
        for _ in 0..2 {
            let error = Pipelines::get(&device, "fn main() {").expect_err("no shader");
            assert!(
                matches!(error.kind(), GpuErrorKind::Refused { .. }),
                "{error}"
            );
        }
        assert!(device.pipelines.lock().is_empty());
    }
}
