//! The studio without a server: sessions, drawing and export in a worker of the browser.
//!
//! `cargo xtask web` compiles this crate to WebAssembly and puts it beside the page of `dapple-studio`, into a folder that
//! any host can serve. A [`Page`] is what a socket with its thread is elsewhere: it hears messages, works in steps of some
//! milliseconds, between which a worker hears what is new, and gives what it made. `abi` is what the worker calls; it is
//! there on `wasm32` only. The bits are those of the command: the kernels are the same, in registers of 128 bits.
#![cfg_attr(not(target_arch = "wasm32"), forbid(unsafe_code))]

#[cfg(target_arch = "wasm32")]
mod abi;
mod drawing;
mod export;
mod page;

pub use page::{Made, Page};
