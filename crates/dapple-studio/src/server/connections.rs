//! Accepts connections, with limits on their number and on their idle time.
//!
//! Every process on this machine can connect. The limits keep such connections from using up the file handles that
//! saving and the pages need.

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

/// Maximum number of simultaneous connections, not counting the sockets of pages. Further connections wait. A process
/// may have 256 handles on macOS.
const MOST_CONNECTIONS: usize = 128;
/// Maximum time to receive the head of a request, and to keep an idle connection open.
const SILENCE: Duration = Duration::from_secs(5);
/// Time that pending responses get to finish when the server ends.
const LAST: Duration = Duration::from_secs(10);
/// Delay before retrying when the system has no free handle.
const PAUSE: Duration = Duration::from_millis(100);

/// Accepts connections until the server [ends](Shared::ended).
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
    // Wait for pending responses, and abandon those that take longer.
    let all = free.acquire_many(MOST_CONNECTIONS as u32);
    let _ = tokio::time::timeout(LAST, all).await;
}

/// Accepts the next connection, with a permit.
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

/// Answers the requests of a connection in a separate task.
fn answer_on(
    stream: TcpStream,
    place: Option<OwnedSemaphorePermit>,
    shared: Arc<Shared>,
    mut end: Receiver<()>,
) {
    // Send small messages without delay.
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
        // Errors of the connection are ignored, since no one is left to receive them.
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
