//! Tests of the studio's public API: sessions without a socket, and the server with sockets.

#![expect(
    clippy::disallowed_methods,
    reason = "tests look at the files of the server, and at the clock"
)]

#[cfg(feature = "server")]
mod access;
#[cfg(feature = "server")]
mod connections;
mod drawing;
mod messages;
mod points;
mod render_host;
#[cfg(feature = "server")]
mod server;
