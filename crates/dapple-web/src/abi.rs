//! The functions that the worker calls, with the C ABI: numbers in, numbers out.
//!
//! The worker writes a message into the memory that [`room`] names and calls [`hear`]; it calls [`step`] while there is
//! work, and [`take`] until nothing is left. A page and its buffers are the only state.
#![expect(
    unsafe_code,
    reason = "names for the worker need `no_mangle`, and the clock is a function of the worker; no memory is touched"
)]

use crate::{Made, Page};
use std::cell::RefCell;

#[link(wasm_import_module = "worker")]
unsafe extern "C" {
    /// Milliseconds since some moment.
    safe fn now() -> f64;
}

/// A page, a message to it, and what was taken of it last.
struct Door {
    page: Page,
    given: Vec<u8>,
    taken: Vec<u8>,
}

thread_local! {
    static DOOR: RefCell<Door> = RefCell::new(Door {
        page: Page::new(|| now()),
        given: Vec::new(),
        taken: Vec::new(),
    });
}

fn with<T>(act: impl FnOnce(&mut Door) -> T) -> T {
    DOOR.with_borrow_mut(act)
}

/// Where a message of this many bytes is to be written.
#[unsafe(no_mangle)]
extern "C" fn room(length: usize) -> *mut u8 {
    with(|door| {
        door.given.clear();
        door.given.resize(length, 0);
        door.given.as_mut_ptr()
    })
}

/// Hears the message that was written.
#[unsafe(no_mangle)]
extern "C" fn hear() {
    with(|door| {
        let given = core::mem::take(&mut door.given);
        door.page.hear(&given);
    });
}

/// Works for some milliseconds, and says whether there is more to do.
#[unsafe(no_mangle)]
extern "C" fn step() -> bool {
    with(|door| door.page.step())
}

/// Takes what was made: 1 for a message, 2 for a picture, 3 for a file, and 0 where nothing is left.
#[unsafe(no_mangle)]
extern "C" fn take() -> u32 {
    with(|door| {
        let (kind, bytes) = match door.page.take() {
            None => (0, Vec::new()),
            Some(Made::Message(text)) => (1, text.into_bytes()),
            Some(Made::Picture(bytes)) => (2, bytes),
            Some(Made::File(bytes)) => (3, bytes),
        };
        door.taken = bytes;
        kind
    })
}

/// Where the bytes of what was taken are.
#[unsafe(no_mangle)]
extern "C" fn taken() -> *const u8 {
    with(|door| door.taken.as_ptr())
}

/// How many bytes were taken.
#[unsafe(no_mangle)]
extern "C" fn taken_length() -> usize {
    with(|door| door.taken.len())
}
