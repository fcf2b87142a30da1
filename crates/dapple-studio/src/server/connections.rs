//! The connections of the server: how many there are, and for how long one may be silent.
//!
//! Anybody on this machine can connect, so that connections must not use up the handles that Save and the pages need.

use super::{Shared, answer};
use axum::body::Body;
use hyper::server::conn::http1;
use hyper::service::service_fn;
use hyper_util::rt::{TokioIo, TokioTimer};
use std::convert::Infallible;
use std::sync::Arc;
use std::time::Duration;
use tokio::net::{TcpListener, TcpStream};
use tokio::sync::watch::{Receiver, channel};
use tokio::sync::{OwnedSemaphorePermit, Semaphore};

/// The most connections at once, besides the sockets of pages; others wait. A process may have 256 handles on macOS.
const MOST_CONNECTIONS: usize = 128;
/// The longest time in which the head of a request must be there, and for which a connection may be kept for another.
const SILENCE: Duration = Duration::from_secs(5);
/// How long answers may take after the server has ended.
const LAST: Duration = Duration::from_secs(10);
/// The pause after the system had no handle.
const PAUSE: Duration = Duration::from_millis(100);

/// Answers until the server [ends](Shared::ended).
pub(super) async fn serve(listener: TcpListener, shared: Arc<Shared>) {
    let free = Arc::new(Semaphore::new(MOST_CONNECTIONS));
    let (open, end) = channel(());
    let ended = shared.ended();
    tokio::pin!(ended);
    loop {
        tokio::select! {
            (place, stream) = next(&listener, &free) => answer_on(stream, place, shared.clone(), end.clone()),
            () = &mut ended => break,
        }
    }
    drop((listener, open));
    // What takes longer is left.
    let all = free.acquire_many(MOST_CONNECTIONS as u32);
    let _ = tokio::time::timeout(LAST, all).await;
}

/// The next connection with its place among those that there may be.
async fn next(
    listener: &TcpListener,
    free: &Arc<Semaphore>,
) -> (Option<OwnedSemaphorePermit>, TcpStream) {
    let place = free.clone().acquire_owned().await.ok();
    loop {
        match listener.accept().await {
            Ok((stream, _)) => return (place, stream),
            Err(_) => tokio::time::sleep(PAUSE).await,
        }
    }
}

/// Answers the requests of a connection beside all others.
fn answer_on(
    stream: TcpStream,
    place: Option<OwnedSemaphorePermit>,
    shared: Arc<Shared>,
    mut end: Receiver<()>,
) {
    // Small messages do not wait for others.
    let _ = stream.set_nodelay(true);
    let service = service_fn(move |request: hyper::Request<hyper::body::Incoming>| {
        let shared = shared.clone();
        async move { Ok::<_, Infallible>(answer(shared, request.map(Body::new)).await) }
    });
    let connection = http1::Builder::new()
        .timer(TokioTimer::new())
        .header_read_timeout(SILENCE)
        .serve_connection(TokioIo::new(stream), service)
        .with_upgrades();
    drop(tokio::spawn(async move {
        let mut connection = std::pin::pin!(connection);
        // A connection that fails has nobody to tell.
        tokio::select! {
            _ = connection.as_mut() => {}
            _ = end.changed() => {
                connection.as_mut().graceful_shutdown();
                let _ = connection.await;
            }
        }
        drop(place);
    }));
}
