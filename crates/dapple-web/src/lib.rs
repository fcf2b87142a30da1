//! The studio without a server: sessions, rendering and export in a web worker.
//!
//! `cargo xtask web` compiles this crate to WebAssembly and puts it next to the page of `dapple-studio`, into a
//! folder that any static host can serve. A [`Page`] replaces the socket and the threads of the server. It receives
//! messages and works in steps of some milliseconds, so that the worker can process new messages between steps.
//! Results are put into a queue. The module `abi`, on `wasm32` only, exports the functions that the worker calls. The
//! output is bit-identical to the output of the command: the kernels are the same, with 128-bit registers.
#![cfg_attr(not(target_arch = "wasm32"), forbid(unsafe_code))]

#[cfg(target_arch = "wasm32")]
mod abi;
mod drawing;
mod export;
mod page;

pub use page::{Made, Page};
