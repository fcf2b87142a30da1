//! The C ABI of the WebAssembly module. The worker calls functions that take and return only numbers, so no bindings
//! are generated.
//!
//! To send a message, the worker calls [`alloc`], writes the bytes there, and calls [`receive`]. It calls [`step`] while
//! there is work, and [`poll`] until the queue of results is empty; [`reply`] and [`reply_length`] locate the bytes of
//! the last result.
#![expect(
    unsafe_code,
    reason = "exported names need `no_mangle`, and the clock is imported from the worker; no memory is touched"
)]

use crate::{Made, Page};
use std::cell::RefCell;

#[link(wasm_import_module = "worker")]
unsafe extern "C" {
    /// Returns the milliseconds since an arbitrary moment.
    safe fn now() -> f64;
}

/// The state of the module: a page and the buffers of both directions.
struct Module {
    page: Page,
    message: Vec<u8>,
    reply: Vec<u8>,
}

thread_local! {
    static MODULE: RefCell<Module> = RefCell::new(Module {
        page: Page::new(|| now()),
        message: Vec::new(),
        reply: Vec::new(),
    });
}

fn with<T>(act: impl FnOnce(&mut Module) -> T) -> T {
    MODULE.with_borrow_mut(act)
}

/// Allocates a message of `length` bytes and returns its address.
#[unsafe(no_mangle)]
extern "C" fn alloc(length: usize) -> *mut u8 {
    with(|module| {
        module.message.clear();
        module.message.resize(length, 0);
        module.message.as_mut_ptr()
    })
}

/// Processes the message that was written to [`alloc`]'s address.
#[unsafe(no_mangle)]
extern "C" fn receive() {
    with(|module| {
        let message = core::mem::take(&mut module.message);
        module.page.receive(&message);
    });
}

/// Works for some milliseconds, and returns whether there is more to do.
#[unsafe(no_mangle)]
extern "C" fn step() -> bool {
    with(|module| module.page.step())
}

/// Removes a result from the queue, and returns its kind: 1 for a message, 2 for an image, 3 for a file, 0 if the queue
/// is empty.
#[unsafe(no_mangle)]
extern "C" fn poll() -> u32 {
    with(|module| {
        let (kind, bytes) = match module.page.poll() {
            None => (0, Vec::new()),
            Some(Made::Message(text)) => (1, text.into_bytes()),
            Some(Made::Picture(bytes)) => (2, bytes),
            Some(Made::File(bytes)) => (3, bytes),
        };
        module.reply = bytes;
        kind
    })
}

/// Returns the address of the last result of [`poll`].
#[unsafe(no_mangle)]
extern "C" fn reply() -> *const u8 {
    with(|module| module.reply.as_ptr())
}

/// Returns the number of bytes of the last result of [`poll`].
#[unsafe(no_mangle)]
extern "C" fn reply_length() -> usize {
    with(|module| module.reply.len())
}
