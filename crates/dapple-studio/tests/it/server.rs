//! Tests of the server over sockets.

use dapple::color::LinearRgb;
use dapple::raster::Raster;
use dapple::recipe::{Images, Recipe};
use dapple_studio::{Export, ExportedFile, Host, Lit, Named, ServeOptions, StudioError, serve};
use serde_json::{Value, json};
use std::fs;
use std::io::{Read as _, Write as _};
use std::net::{TcpListener, TcpStream};
use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::channel;
use std::time::{Duration, Instant};
use tempfile::TempDir;
use tungstenite::{Message, WebSocket};

/// A host whose exports consist of a single dummy file.
///
/// An export waits while the folder has a file `wait`. If it is stopped during the wait, it writes a file `stopped`.
struct TestHost;

impl Host for TestHost {
    fn images(&self, _: &Recipe, _: &Path) -> Result<Images, StudioError> {
        Ok(Images::new())
    }

    fn export(
        &self,
        recipe: &Recipe,
        folder: &Path,
        _: &Export,
        stop: &Arc<AtomicBool>,
    ) -> Result<Vec<ExportedFile>, StudioError> {
        while folder.join("wait").exists() {
            if stop.load(Ordering::SeqCst) {
                fs::write(folder.join("stopped"), "").unwrap();
                return Err(StudioError::new("stopped in the middle"));
            }
            std::thread::sleep(Duration::from_millis(10));
        }
        let name = format!("{} 1.txt", recipe.name);
        Ok(vec![ExportedFile {
            name,
            bytes: b"made".to_vec(),
        }])
    }

    fn preview(&self, _: &Lit<'_>) -> Result<Raster<LinearRgb>, StudioError> {
        Ok(Raster::filled([2, 1], LinearRgb::WHITE).unwrap())
    }

    fn presets(&self) -> Vec<Named> {
        Vec::new()
    }
}

/// A running server for a temporary folder.
pub(crate) struct Server {
    pub(crate) folder: TempDir,
    pub(crate) port: u16,
    pub(crate) token: String,
}

pub(crate) type Page = WebSocket<TcpStream>;

impl Server {
    pub(crate) fn new(recipe: Option<&str>) -> Self {
        Self::of(Self::folder(), recipe, None)
    }

    /// Creates a folder with a recipe and another text file.
    pub(crate) fn folder() -> TempDir {
        let folder = tempfile::tempdir().unwrap();
        fs::write(
            folder.path().join("my.toml"),
            "dapple = 1\nname = \"mine\"\n[material]\nheight = 0.25\n",
        )
        .unwrap();
        fs::write(folder.path().join("secret.txt"), "secret").unwrap();
        folder
    }

    /// Starts a server for a folder.
    pub(crate) fn of(folder: TempDir, recipe: Option<&str>, public_url: Option<&str>) -> Self {
        // The printed address contains the port only without a public URL, so choose a free port here.
        let free = public_url.map(|_| TcpListener::bind("127.0.0.1:0").unwrap());
        let port = free.map_or(0, |free| free.local_addr().unwrap().port());
        let options = ServeOptions {
            port,
            no_open: true,
            public_url: public_url.map(str::to_owned),
            recipe: recipe.map(str::to_owned),
            folder: folder.path().to_owned(),
            ..ServeOptions::default()
        };
        let (sender, urls) = channel();
        // The thread ends with the test process.
        std::thread::spawn(move || {
            serve(options, Arc::new(TestHost), |url| {
                sender.send(url.to_owned()).unwrap();
            })
            .unwrap();
        });
        let url = urls.recv_timeout(Duration::from_secs(20)).unwrap();
        let (address, token) = url.rsplit_once("#t=").unwrap();
        assert_eq!(token.len(), 32, "{url}");
        let port = match public_url {
            Some(_) => port,
            None => {
                let port = address.strip_prefix("http://127.0.0.1:").unwrap();
                port.strip_suffix('/').unwrap().parse().unwrap()
            }
        };
        assert_eq!(
            public_url.unwrap_or(address),
            address,
            "the printed address"
        );
        let token = token.to_owned();
        Self {
            folder,
            port,
            token,
        }
    }

    pub(crate) fn stream(&self) -> TcpStream {
        let stream = TcpStream::connect(("127.0.0.1", self.port)).unwrap();
        stream
            .set_read_timeout(Some(Duration::from_secs(30)))
            .unwrap();
        stream
    }

    /// Sends a request and returns the response. In headers, `HOST` and `ORIGIN` stand for the valid values.
    pub(crate) fn get(&self, path: &str, headers: &[&str]) -> String {
        let mut stream = self.stream();
        let mut request = format!("GET {path} HTTP/1.1\r\nConnection: close\r\n");
        for header in headers {
            let header = header
                .replace("HOST", &format!("127.0.0.1:{}", self.port))
                .replace("ORIGIN", &format!("http://127.0.0.1:{}", self.port));
            request += &format!("{header}\r\n");
        }
        stream
            .write_all(format!("{request}\r\n").as_bytes())
            .unwrap();
        let mut answer = Vec::new();
        stream.read_to_end(&mut answer).unwrap();
        String::from_utf8_lossy(&answer).into_owned()
    }

    /// Sends a request and returns its status. Reads only the status line, since an upgraded connection stays open.
    pub(crate) fn head(&self, path: &str, headers: &[String]) -> u16 {
        let mut stream = self.stream();
        let request = format!("GET {path} HTTP/1.1\r\n{}\r\n\r\n", headers.join("\r\n"));
        stream.write_all(request.as_bytes()).unwrap();
        let mut line = [0; 12];
        stream.read_exact(&mut line).unwrap();
        String::from_utf8_lossy(&line[9..]).parse().unwrap()
    }

    pub(crate) fn status(&self, path: &str, headers: &[&str]) -> u16 {
        let answer = self.get(path, headers);
        answer
            .split(' ')
            .nth(1)
            .unwrap_or_default()
            .parse()
            .unwrap_or(0)
    }

    /// Connects a page, and waits for its greeting.
    pub(crate) fn page(&self) -> Page {
        self.greeted().0
    }

    /// Connects a page, and returns it with its greeting.
    pub(crate) fn greeted(&self) -> (Page, Value) {
        self.greeted_at("")
    }

    /// Connects a page, and returns it with its greeting. `more` is appended to the query of its address.
    pub(crate) fn greeted_at(&self, more: &str) -> (Page, Value) {
        let (port, token) = (self.port, &self.token);
        let request = tungstenite::http::Request::builder()
            .uri(format!("ws://127.0.0.1:{port}/ws?t={token}{more}"))
            .header("Host", format!("127.0.0.1:{}", self.port))
            .header("Origin", format!("http://127.0.0.1:{}", self.port))
            .header("Connection", "Upgrade")
            .header("Upgrade", "websocket")
            .header("Sec-WebSocket-Version", "13")
            .header("Sec-WebSocket-Key", "AAAAAAAAAAAAAAAAAAAAAA==")
            .body(())
            .unwrap();
        let (mut page, _) = tungstenite::client(request, self.stream()).unwrap();
        let hello = until(&mut page, "hello");
        (page, hello)
    }
}

pub(crate) fn say(page: &mut Page, message: &Value) {
    page.send(Message::text(message.to_string())).unwrap();
}

/// Returns the next message. Images are acknowledged and reported by their headers.
pub(crate) fn next(page: &mut Page) -> Value {
    loop {
        match page.read().unwrap() {
            Message::Text(text) => return serde_json::from_str(&text).unwrap(),
            Message::Binary(bytes) => {
                let number = |at: usize| u32::from_le_bytes(bytes[at..at + 4].try_into().unwrap());
                let map = u16::from_le_bytes([bytes[8], bytes[9]]);
                say(
                    page,
                    &json!({ "type": "ack", "generation": number(4), "map": map }),
                );
                return json!({ "type": "picture", "generation": number(4), "size": [number(20), number(24)], "bytes": bytes.len() });
            }
            _ => {}
        }
    }
}

/// Skips to the next message of a type.
pub(crate) fn until(page: &mut Page, name: &str) -> Value {
    loop {
        let message = next(page);
        if message["type"] == name {
            return message;
        }
        assert_ne!(message["type"], "refused", "{message}");
    }
}

/// Skips to the next refusal.
pub(crate) fn refusal(page: &mut Page) -> Value {
    loop {
        let message = next(page);
        if message["type"] == "refused" {
            return message;
        }
    }
}

#[test]
fn the_view_of_the_address_is_drawn_without_a_message() {
    let server = Server::new(Some("my.toml"));
    let view = "&view=%7B%22size%22:[32,32],%22maps%22:[%22height%22],%22paused%22:false%7D";
    let (mut page, _) = server.greeted_at(view);
    let picture = until(&mut page, "picture");
    assert_eq!(picture["size"], json!([32, 32]));
    assert_eq!(picture["bytes"], 32 + 32 * 32, "a byte for each pixel");
    // An invalid view is ignored.
    let (mut page, _) = server.greeted_at("&view=%7B%22size%22:0%7D");
    until(&mut page, "document");
    say(
        &mut page,
        &json!({ "type": "view", "size": [8, 8], "maps": ["height"], "paused": false }),
    );
    assert_eq!(until(&mut page, "picture")["size"], json!([8, 8]));
}

#[test]
fn files_outside_of_the_folder_are_neither_read_nor_written() {
    let server = Server::new(None);
    let outside = tempfile::tempdir().unwrap();
    fs::write(outside.path().join("other.png"), "image").unwrap();
    fs::write(outside.path().join("other.toml"), "dapple = 1").unwrap();
    fs::write(server.folder.path().join("in.png"), "image").unwrap();
    #[cfg(unix)]
    for name in ["other.png", "other.toml"] {
        let link = server.folder.path().join(name);
        std::os::unix::fs::symlink(outside.path().join(name), link).unwrap();
    }
    let token = format!("x-dapple-token: {}", server.token);
    for (path, status) in [
        ("/image/in.png", 200),
        ("/image/other.png", 404),
        ("/image/secret.txt", 404),
        ("/image/../in.png", 404),
        ("/image/%2e%2e%2fin.png", 404),
        ("/image//etc/passwd", 404),
        ("/image/%00.png", 404),
        ("/image/%ff.png", 404),
        ("/image/%", 404),
    ] {
        assert_eq!(
            server.status(path, &["Host: HOST", &token]),
            status,
            "{path}"
        );
    }
    let mut page = server.page();
    for file in [
        "other.toml",
        "../my.toml",
        "/etc/passwd",
        "",
        ".",
        "secret.txt\0",
    ] {
        say(&mut page, &json!({ "type": "open", "file": file }));
        assert_eq!(refusal(&mut page)["what"], "open", "{file}");
    }
    for file in [
        "../new.toml",
        "a/b.toml",
        "new.txt",
        ".new.toml",
        "other.toml",
        "a\\b.toml",
    ] {
        say(
            &mut page,
            &json!({ "type": "save", "file": file, "text": "dapple = 1", "overwrite": true }),
        );
        assert_eq!(refusal(&mut page)["what"], "save", "{file}");
    }
    let mut names: Vec<_> = fs::read_dir(server.folder.path())
        .unwrap()
        .map(|entry| entry.unwrap().file_name())
        .collect();
    names.sort();
    assert!(
        !names
            .iter()
            .any(|name| name.to_string_lossy().contains("new")),
        "{names:?}"
    );
    assert_eq!(
        fs::read(outside.path().join("other.toml")).unwrap(),
        b"dapple = 1"
    );
}

#[test]
fn images_outside_of_the_folder_are_refused() {
    let server = Server::new(None);
    let mut page = server.page();
    let text = "dapple = 1\n[nodes.a.image]\nfile = \"../x.png\"\n[material]\nheight = \"a\"\n";
    say(&mut page, &json!({ "type": "doc", "rev": 1, "text": text }));
    say(&mut page, &json!({ "type": "view", "paused": false }));
    let message = refusal(&mut page);
    assert!(
        message["message"]
            .as_str()
            .unwrap()
            .contains("not in the folder"),
        "{message}"
    );
}

#[test]
fn a_saved_file_is_never_one_that_was_not_seen() {
    let server = Server::new(Some("my.toml"));
    let mut page = server.page();
    let document = until(&mut page, "document");
    let path = server.folder.path().join("my.toml");
    let save = |text: &str, seen: &Value| json!({ "type": "save", "file": "my.toml", "text": text, "seen": seen });
    say(
        &mut page,
        &save("dapple = 1\n[material]\n", &document["hash"]),
    );
    let saved = until(&mut page, "saved");
    assert_eq!(
        fs::read_to_string(&path).unwrap(),
        "dapple = 1\n[material]\n"
    );
    fs::write(&path, "dapple = 1\n[material]\nheight = 0.75\n").unwrap();
    let disk = until(&mut page, "disk");
    assert_eq!(disk["text"], "dapple = 1\n[material]\nheight = 0.75\n");
    say(&mut page, &save("lost", &saved["hash"]));
    let refused = refusal(&mut page);
    assert_eq!(
        (&refused["what"], &refused["reason"]),
        (&json!("save"), &json!("changed_on_disk"))
    );
    say(
        &mut page,
        &json!({ "type": "save", "file": "my.toml", "text": "new", "overwrite": true }),
    );
    until(&mut page, "saved");
    assert_eq!(fs::read_to_string(&path).unwrap(), "new");
}

#[test]
fn hostile_messages_do_not_end_the_server() {
    let server = Server::new(Some("cow"));
    let mut page = server.page();
    until(&mut page, "values");
    for message in [
        "",
        "{",
        "null",
        "[]",
        "7",
        "{\"type\":\"nothing\"}",
        "{\"type\":\"view\",\"size\":[-1,2]}",
        "{\"type\":\"patch\",\"rev\":0,\"ops\":[{\"op\":\"set\",\"path\":[\"a\",1.5],\"value\":1}]}",
        "{\"type\":\"doc\",\"rev\":1e99,\"text\":\"\"}",
        "{\"type\":\"export\",\"args\":[\"--force\"]}",
    ] {
        page.send(Message::text(message)).unwrap();
        assert_eq!(refusal(&mut page)["what"], "message", "{message}");
    }
    page.send(Message::text("[".repeat(100_000))).unwrap();
    assert_eq!(refusal(&mut page)["what"], "message");
    page.send(Message::binary(vec![0; 10])).unwrap();
    assert_eq!(refusal(&mut page)["what"], "message");
    let deep = format!("x = {}{}", "[".repeat(10_000), "]".repeat(10_000));
    say(&mut page, &json!({ "type": "doc", "rev": 1, "text": deep }));
    until(&mut page, "diagnostics");
    // A recipe that exceeds the work limits is refused.
    let text = "dapple = 1\n[nodes.a.noise]\nfrequency = 100000\n[material]\nheight = \"a\"\n";
    say(&mut page, &json!({ "type": "doc", "rev": 2, "text": text }));
    say(&mut page, &json!({ "type": "view", "paused": false }));
    until(&mut page, "diagnostics");
    // A message longer than the limit closes the connection.
    let mut other = server.page();
    let _ = other.send(Message::text("x".repeat(9 << 20)));
    let _ = other.read();
    drop(other);
    say(&mut page, &json!({ "type": "open", "builtin": "ice" }));
    assert_eq!(until(&mut page, "document")["name"], "ice");
}

#[test]
fn many_changes_in_a_moment_end_in_the_last_one_with_few_pictures() {
    let server = Server::new(Some("flagstone"));
    let mut page = server.page();
    until(&mut page, "values");
    say(
        &mut page,
        &json!({ "type": "view", "size": [512, 512], "maps": ["height", "normal", "albedo"], "draft": false, "paused": false }),
    );
    until(&mut page, "rendered");
    let start = Instant::now();
    for rev in 0..200_u32 {
        let value = 0.2 + f64::from(rev) / 1000.0;
        let op =
            json!({ "op": "set", "path": ["nodes", "plate", "levels", "from", 1], "value": value });
        say(
            &mut page,
            &json!({ "type": "patch", "rev": rev, "ops": [op], "drag": true }),
        );
    }
    let mut rendered = Vec::new();
    loop {
        let message = next(&mut page);
        if message["type"] == "rendered" {
            rendered.push(message["rev"].as_u64().unwrap());
            if message["rev"] == 200 {
                break;
            }
        }
    }
    let most = 6.0 * start.elapsed().as_secs_f64().max(1.0);
    assert!(
        rendered.len() as f64 <= most,
        "{rendered:?} in {:?}",
        start.elapsed()
    );
    say(&mut page, &json!({ "type": "code", "kind": "toml" }));
    assert!(
        until(&mut page, "code")["text"]
            .as_str()
            .unwrap()
            .contains("[0.06, 0.399]")
    );
}

#[test]
fn exports_are_fetched_with_the_secret() {
    let server = Server::new(Some("my.toml"));
    let mut page = server.page();
    until(&mut page, "values");
    say(
        &mut page,
        &json!({ "type": "export", "size": [16, 16], "maps": ["height"] }),
    );
    let exported = until(&mut page, "exported");
    assert_eq!(
        exported["files"],
        json!([{ "name": "mine 1.txt", "bytes": 4 }])
    );
    let path = format!("/export/{}/mine%201.txt", exported["id"].as_str().unwrap());
    let token = format!("x-dapple-token: {}", server.token);
    assert!(
        server
            .get(&path, &["Host: HOST", &token])
            .ends_with("\r\n\r\nmade")
    );
    assert_eq!(server.status(&path, &["Host: HOST"]), 403);
    assert_eq!(
        server.status("/export/1/other", &["Host: HOST", &token]),
        404
    );
}

#[test]
fn exports_stop_on_request_and_with_their_page() {
    let server = Server::new(Some("my.toml"));
    let path = |name: &str| server.folder.path().join(name);
    fs::write(path("wait"), "").unwrap();
    let export = json!({ "type": "export", "size": [16, 16], "maps": ["height"] });
    let mut page = server.page();
    until(&mut page, "values");
    // One export runs and one waits.
    say(&mut page, &export);
    say(&mut page, &export);
    say(&mut page, &json!({ "type": "stop" }));
    for _ in 0..2 {
        let refused = until(&mut page, "refused");
        assert_eq!(refused["what"], "export", "{refused}");
        let message = refused["message"].as_str().unwrap();
        assert!(message.contains("stopped"), "{message}");
    }
    // Exports work again after a stop.
    fs::remove_file(path("wait")).unwrap();
    say(&mut page, &export);
    until(&mut page, "exported");
    // Closing the page stops its export.
    fs::write(path("wait"), "").unwrap();
    let _ = fs::remove_file(path("stopped"));
    say(&mut page, &export);
    say(&mut page, &json!({ "type": "seams", "size": [8, 8] }));
    until(&mut page, "seams");
    drop(page);
    let start = Instant::now();
    while !path("stopped").exists() {
        assert!(
            start.elapsed() < Duration::from_secs(20),
            "it is not stopped"
        );
        std::thread::sleep(Duration::from_millis(10));
    }
}

#[test]
fn recipes_of_the_folder_are_listed() {
    let server = Server::new(None);
    fs::write(server.folder.path().join("Cargo.toml"), "[package]").unwrap();
    let (mut page, hello) = server.greeted();
    assert_eq!(hello["files"], json!(["my.toml"]));
    say(&mut page, &json!({ "type": "open", "file": "my.toml" }));
    let document = until(&mut page, "document");
    assert_eq!(
        (&document["name"], &document["file"]),
        (&json!("mine"), &json!("my.toml"))
    );
}

#[test]
fn a_lit_picture_is_that_of_the_program_around_it() {
    let server = Server::new(Some("cow"));
    let mut page = server.page();
    say(
        &mut page,
        &json!({ "type": "view", "size": [16, 16], "maps": [], "paused": false, "exact": { "shape": "torus" } }),
    );
    assert_eq!(until(&mut page, "picture")["size"], json!([2, 1]));
}

#[test]
fn all_recipes_have_small_pictures() {
    let server = Server::new(None);
    let (mut page, hello) = server.greeted();
    say(&mut page, &json!({ "type": "gallery", "size": 24 }));
    let n_recipes = hello["builtins"].as_array().unwrap().len() + 1;
    for _ in 0..n_recipes {
        let picture = until(&mut page, "picture");
        assert!(
            picture["size"].as_array().unwrap().contains(&json!(24)),
            "{picture}"
        );
    }
}

#[test]
fn points_of_labeled_cells_come_with_their_labels() {
    let server = Server::new(None);
    let mut page = server.page();
    let text = "dapple = 1\n[nodes.hide.pups.cells]\nspacing = 0.2\npoints_per_cell = [3, 4]\n[material]\nheight = \"hide\"\n";
    say(&mut page, &json!({ "type": "doc", "rev": 0, "text": text }));
    let points = |page: &mut Page| {
        say(page, &json!({ "type": "points", "node": "hide" }));
        until(page, "points")
    };
    let before = points(&mut page);
    let ops = json!([{ "op": "make_points", "node": "hide" }]);
    say(&mut page, &json!({ "type": "patch", "rev": 0, "ops": ops }));
    until(&mut page, "edits");
    let after = points(&mut page);
    assert_eq!(
        (&before["editable"], &after["editable"]),
        (&json!(false), &json!(true))
    );
    for key in ["points", "values", "edges"] {
        assert_eq!(before[key], after[key], "{key}");
    }
    let values = after["values"].as_array().unwrap();
    for point in after["points"].as_array().unwrap() {
        let label = point["label"].as_u64().unwrap() as usize;
        assert_eq!(point["value"], values[label], "{point}");
    }
    let label = json!(["nodes", "hide", "pups", "points", "points", 0, "label"]);
    let ops = json!([{ "op": "set", "path": label, "value": values.len() - 1 }]);
    say(&mut page, &json!({ "type": "patch", "rev": 1, "ops": ops }));
    until(&mut page, "edits");
    assert_eq!(
        points(&mut page)["points"][0]["label"],
        json!(values.len() - 1)
    );
}
