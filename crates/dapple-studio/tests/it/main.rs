//! The studio through its public doors: sessions without a socket, and the server with one.

mod drawing;
mod messages;
#[cfg(feature = "server")]
mod server;
mod world;
