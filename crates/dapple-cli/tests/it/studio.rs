//! Tests of the studio as a subcommand.

use crate::support::{Folder, assert_done, assert_refused};
use dapple::recipe::Recipe;
use serde_json::{Value, json};
use std::fs;
use std::io::{BufRead as _, BufReader, Read as _, Write as _};
use std::net::TcpStream;
use std::process::{Child, Command, Stdio};
use std::time::Duration;
use tungstenite::{Message, WebSocket};

/// A running studio. The process is killed on drop.
struct Studio {
    child: Child,
    port: u16,
    token: String,
}

impl Drop for Studio {
    fn drop(&mut self) {
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

impl Studio {
    fn new(mut command: Command) -> Self {
        let mut child = command.stdout(Stdio::piped()).spawn().unwrap();
        let mut url = String::new();
        BufReader::new(child.stdout.take().unwrap())
            .read_line(&mut url)
            .unwrap();
        let (address, token) = url.trim().split_once("/#t=").unwrap();
        let port = address.rsplit_once(':').unwrap().1.parse().unwrap();
        let token = token.to_owned();
        Self { child, port, token }
    }

    fn stream(&self) -> TcpStream {
        let stream = TcpStream::connect(("127.0.0.1", self.port)).unwrap();
        stream
            .set_read_timeout(Some(Duration::from_secs(60)))
            .unwrap();
        stream
    }

    fn page(&self) -> WebSocket<TcpStream> {
        let host = format!("127.0.0.1:{}", self.port);
        let request = tungstenite::http::Request::builder()
            .uri(format!("ws://{host}/ws?t={}", self.token))
            .header("Host", &host)
            .header("Origin", format!("http://{host}"))
            .header("Connection", "Upgrade")
            .header("Upgrade", "websocket")
            .header("Sec-WebSocket-Version", "13")
            .header("Sec-WebSocket-Key", "AAAAAAAAAAAAAAAAAAAAAA==")
            .body(())
            .unwrap();
        tungstenite::client(request, self.stream()).unwrap().0
    }

    /// Requests a path from the studio by HTTP, and returns the body of the response.
    fn get(&self, path: &str) -> Vec<u8> {
        let (port, token) = (self.port, &self.token);
        let mut stream = self.stream();
        let request = format!(
            "GET {path} HTTP/1.1\r\nHost: 127.0.0.1:{port}\r\nx-dapple-token: {token}\r\nConnection: close\r\n\r\n"
        );
        stream.write_all(request.as_bytes()).unwrap();
        let mut answer = Vec::new();
        stream.read_to_end(&mut answer).unwrap();
        let head = answer
            .windows(4)
            .position(|end| end == b"\r\n\r\n")
            .unwrap();
        answer.split_off(head + 4)
    }
}

/// Waits for the next message of the type `name`.
fn until(page: &mut WebSocket<TcpStream>, name: &str) -> Value {
    loop {
        if let Message::Text(text) = page.read().unwrap() {
            let message: Value = serde_json::from_str(&text).unwrap();
            if message["type"] == name {
                return message;
            }
            assert_ne!(message["type"], "refused", "{message}");
        }
    }
}

/// Waits for the next error message.
fn refusal(page: &mut WebSocket<TcpStream>) -> Value {
    loop {
        if let Message::Text(text) = page.read().unwrap() {
            let message: Value = serde_json::from_str(&text).unwrap();
            if message["type"] == "refused" {
                return message;
            }
        }
    }
}

#[test]
fn exports_are_the_files_of_a_bake() {
    let folder = Folder::new("studio-export");
    let text = Recipe::builtin_text("rock").unwrap();
    fs::write(folder.path("mine.toml"), text).unwrap();
    let studio = Studio::new(folder.command(&["studio", "--no-open", "mine.toml"]));
    let mut page = studio.page();
    assert_eq!(until(&mut page, "document")["text"], text);
    for (export, options) in [
        (
            json!({ "size": [48, 32], "maps": ["height", "normal", "orm"] }),
            "--maps height,normal,orm",
        ),
        (
            json!({ "size": [48, 32], "preset": "unreal" }),
            "--preset unreal",
        ),
        (
            json!({ "size": [48, 32], "maps": ["albedo"], "format": "exr" }),
            "--maps albedo --format exr",
        ),
        (
            json!({ "size": [48, 32], "maps": ["normal"], "normal_y": "directx" }),
            "--maps normal --normal-y directx",
        ),
    ] {
        let mut message = export.clone();
        message["type"] = json!("export");
        page.send(Message::text(message.to_string())).unwrap();
        let exported = until(&mut page, "exported");
        let words = [
            "bake",
            "mine.toml",
            "--size",
            "48x32",
            "--force",
            "-o",
            "out/",
        ];
        let _ = fs::remove_dir_all(folder.path("out"));
        assert_done(
            &folder.run(&[&words[..], &options.split(' ').collect::<Vec<_>>()].concat()),
            options,
        );
        let mut baked: Vec<_> = fs::read_dir(folder.path("out"))
            .unwrap()
            .map(|entry| entry.unwrap().path())
            .collect();
        baked.sort();
        let files = exported["files"].as_array().unwrap();
        assert_eq!(files.len(), baked.len(), "{exported}");
        for (file, path) in files.iter().zip(baked) {
            let name = file["name"].as_str().unwrap();
            assert_eq!(path.file_name().unwrap(), name);
            let id = exported["id"].as_str().unwrap();
            assert!(
                studio.get(&format!("/export/{id}/{name}")) == fs::read(path).unwrap(),
                "{name}"
            );
        }
    }
    page.send(Message::text(
        json!({ "type": "export", "format": "bmp" }).to_string(),
    ))
    .unwrap();
    assert_eq!(refusal(&mut page)["what"], "export");
}

#[test]
fn a_watched_recipe_is_shown_where_no_output_is_named() {
    let folder = Folder::new("studio-watch");
    fs::write(folder.path("mine.toml"), "dapple = 1\n[material]\n").unwrap();
    let studio = Studio::new(folder.command(&["watch", "--no-open", "mine.toml"]));
    let mut page = studio.page();
    let hello = until(&mut page, "hello");
    assert_eq!(
        (&hello["mode"], &hello["open"]),
        (&json!("watch"), &json!("mine.toml"))
    );
    until(&mut page, "values");
    fs::write(
        folder.path("mine.toml"),
        "dapple = 1\n[material]\nheight = 0.75\n",
    )
    .unwrap();
    assert_eq!(
        until(&mut page, "disk")["text"],
        "dapple = 1\n[material]\nheight = 0.75\n"
    );
    page.send(Message::text(
        json!({ "type": "save", "file": "mine.toml", "text": "", "overwrite": true }).to_string(),
    ))
    .unwrap();
    assert_eq!(refusal(&mut page)["what"], "save");
    assert_eq!(
        fs::read_to_string(folder.path("mine.toml")).unwrap(),
        "dapple = 1\n[material]\nheight = 0.75\n"
    );
}

#[test]
#[cfg(unix)]
fn the_browser_is_given_a_private_file_and_not_the_secret() {
    use std::os::unix::fs::PermissionsExt as _;
    let folder = Folder::new("studio-browser");
    for name in ["bin", "tmp"] {
        fs::create_dir(folder.path(name)).unwrap();
    }
    // Under every name of a program that opens browsers.
    for name in [
        "xdg-open",
        "gio",
        "gnome-open",
        "kde-open",
        "open",
        "wslview",
    ] {
        let program = folder.path("bin").join(name);
        fs::write(
            &program,
            "#!/bin/sh\nprintf '%s' \"$*\" > told.new\nmv told.new told\n",
        )
        .unwrap();
        fs::set_permissions(program, fs::Permissions::from_mode(0o755)).unwrap();
    }
    let mut command = folder.command(&["studio", "rock"]);
    let path = std::env::var("PATH").unwrap();
    command
        .env("PATH", format!("{}:{path}", folder.path("bin").display()))
        .env("TMPDIR", folder.path("tmp"))
        .env("HOME", folder.path("tmp"));
    let studio = Studio::new(command);
    let begun = std::time::Instant::now();
    while !folder.path("told").exists() {
        assert!(begun.elapsed() < Duration::from_secs(60), "no browser");
        std::thread::sleep(Duration::from_millis(20));
    }
    let told = fs::read_to_string(folder.path("told")).unwrap();
    assert!(!told.contains(&studio.token), "{told}");
    let way = folder.path("tmp").join(told.rsplit('/').next().unwrap());
    assert!(told.ends_with(&way.display().to_string()), "{told}");
    assert_eq!(
        fs::metadata(&way).unwrap().permissions().mode() & 0o777,
        0o600
    );
    let url = format!("http://127.0.0.1:{}/#t={}", studio.port, studio.token);
    assert!(fs::read_to_string(&way).unwrap().contains(&url));
    // It is removed when the page is there.
    let mut page = studio.page();
    until(&mut page, "hello");
    assert!(!way.exists());
}

#[test]
fn with_once_it_ends_when_the_last_page_is_closed() {
    let folder = Folder::new("studio-once");
    let mut studio = Studio::new(folder.command(&["studio", "--no-open", "--once", "cow"]));
    let mut page = studio.page();
    until(&mut page, "document");
    drop(page);
    let begun = std::time::Instant::now();
    while studio.child.try_wait().unwrap().is_none() {
        assert!(begun.elapsed() < Duration::from_secs(60), "it goes on");
        std::thread::sleep(Duration::from_millis(50));
    }
    assert!(studio.child.wait().unwrap().success(), "it has ended well");
}

#[test]
fn only_recipes_in_toml_are_opened() {
    let folder = Folder::new("studio-refused");
    fs::write(folder.path("a.json"), "{}").unwrap();
    assert_refused(
        &folder.run(&["studio", "--no-open", "a.json"]),
        2,
        "TOML",
        "a recipe in JSON",
    );
    assert_refused(
        &folder.run(&["studio", "--no-open", "flagston"]),
        2,
        "flagstone",
        "no recipe",
    );
    let taken = std::net::TcpListener::bind(("127.0.0.1", 0)).unwrap();
    let port = taken.local_addr().unwrap().port().to_string();
    assert_refused(
        &folder.run(&["studio", "--no-open", "--port", &port]),
        1,
        "port",
        "a port that is taken",
    );
}
