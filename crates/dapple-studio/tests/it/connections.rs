//! Tests of the limits on connections and pages, and of requests that run during an export.

use super::server::{Server, say, until};
use serde_json::json;
use std::fs;
use std::io::{Read as _, Write as _};
use std::time::{Duration, Instant};

#[test]
fn silent_connections_are_closed_and_do_not_keep_others_out() {
    let server = Server::new(None);
    let start = Instant::now();
    // Open more connections than the limit, half of them in the middle of a request.
    let mut silent: Vec<_> = (0..300).map(|_| server.stream()).collect();
    for stream in silent.iter_mut().step_by(2) {
        stream.write_all(b"GET / HTTP/1.1\r\nHost: 127").unwrap();
    }
    assert_eq!(server.status("/", &["Host: HOST"]), 200);
    let mut answer = Vec::new();
    // The server may send a response before it closes the connection.
    let _ = silent[0].read_to_end(&mut answer);
    let text = String::from_utf8_lossy(&answer);
    assert!(!text.contains(" 200 "), "{text}");
    // With a limit of 128, 300 connections take three rounds of 5 seconds.
    assert!(
        start.elapsed() < Duration::from_secs(25),
        "{:?}",
        start.elapsed()
    );
}

#[test]
fn pages_that_come_together_share_the_places_that_there_are() {
    let server = Server::new(None);
    let path = format!("/ws?t={}", server.token);
    let head = format!("GET {path} HTTP/1.1\r\n{}\r\n\r\n", upgrade().join("\r\n"));
    let mut streams: Vec<_> = (0..60).map(|_| server.stream()).collect();
    for stream in &mut streams {
        stream.write_all(head.as_bytes()).unwrap();
    }
    let statuses = streams.iter_mut().map(|stream| {
        let mut line = [0; 12];
        stream.read_exact(&mut line).unwrap();
        String::from_utf8_lossy(&line).into_owned()
    });
    let statuses: Vec<_> = statuses.collect();
    let count = |status: &str| {
        statuses
            .iter()
            .filter(|line| line.ends_with(status))
            .count()
    };
    assert_eq!((count("101"), count("503")), (16, 44), "{statuses:?}");
    // The permits are free again once the pages are closed.
    drop(streams);
    let start = Instant::now();
    while server.head(&path, &upgrade()) != 101 {
        assert!(start.elapsed() < Duration::from_secs(20));
        std::thread::sleep(Duration::from_millis(20));
    }
}

fn upgrade() -> [String; 6] {
    [
        "Host: localhost".to_owned(),
        "Origin: http://localhost".to_owned(),
        "Upgrade: websocket".to_owned(),
        "Connection: Upgrade".to_owned(),
        "Sec-WebSocket-Version: 13".to_owned(),
        "Sec-WebSocket-Key: AAAAAAAAAAAAAAAAAAAAAA==".to_owned(),
    ]
}

#[test]
fn a_page_is_drawn_while_its_export_is_made() {
    let server = Server::new(Some("my.toml"));
    let mut page = server.page();
    until(&mut page, "document");
    let wait = server.folder.path().join("wait");
    fs::write(&wait, "").unwrap();
    say(&mut page, &json!({ "type": "export", "size": [16, 16] }));
    say(
        &mut page,
        &json!({ "type": "view", "size": [16, 16], "maps": ["height"], "paused": false }),
    );
    assert_eq!(until(&mut page, "picture")["size"], json!([16, 16]));
    // Reports also run during an export.
    say(&mut page, &json!({ "type": "code", "kind": "toml" }));
    until(&mut page, "code");
    fs::remove_file(&wait).unwrap();
    until(&mut page, "exported");
}
