//! Tests of access control: which requests the server answers and which files a page can reach.

use super::server::{Page, Server, refusal, say, until};
use serde_json::{Value, json};
use std::fs;
use std::path::Path;

const RECIPE: &str = "dapple = 1\n[material]\nheight = 0.25\n";

/// Returns the HTTP status of a socket upgrade with this host and origin.
fn upgrade(server: &Server, host: &str, origin: &str) -> u16 {
    let headers = [
        format!("Host: {host}"),
        format!("Origin: {origin}"),
        "Upgrade: websocket".to_owned(),
        "Connection: Upgrade".to_owned(),
        "Sec-WebSocket-Version: 13".to_owned(),
        "Sec-WebSocket-Key: AAAAAAAAAAAAAAAAAAAAAA==".to_owned(),
    ];
    server.head(&format!("/ws?t={}", server.token), &headers)
}

#[test]
fn only_our_own_page_is_answered() {
    let server = Server::new(None);
    let ws = format!("/ws?t={}", server.token);
    let upgrade = [
        "Connection: Upgrade",
        "Upgrade: websocket",
        "Sec-WebSocket-Version: 13",
        "Sec-WebSocket-Key: AAAAAAAAAAAAAAAAAAAAAA==",
    ];
    let with = |more: &[&'static str]| [more, &upgrade[..]].concat();
    for (path, headers, status) in [
        ("/", vec!["Host: HOST"], 200),
        (
            "/",
            vec![
                "Host: HOST",
                "Origin: ORIGIN",
                "Sec-Fetch-Site: same-origin",
            ],
            200,
        ),
        ("/", vec![], 400),
        ("/", vec!["Host: evil.example"], 403),
        ("/", vec!["Host: 127.0.0.1"], 200),
        ("/", vec!["Host: HOST", "Origin: http://evil.example"], 403),
        ("/", vec!["Host: HOST", "Origin: null"], 403),
        ("/", vec!["Host: HOST", "Sec-Fetch-Site: cross-site"], 403),
        ("/", vec!["Host: HOST", "Sec-Fetch-Site: same-site"], 403),
        ("/ws", with(&["Host: HOST", "Origin: ORIGIN"]), 403),
        ("/ws?t=00", with(&["Host: HOST", "Origin: ORIGIN"]), 403),
        (&ws, with(&["Host: HOST"]), 403),
        (
            &ws,
            with(&["Host: HOST", "Origin: http://localhost:1"]),
            403,
        ),
        (&ws, with(&["Host: evil.example", "Origin: ORIGIN"]), 403),
        ("/export/1/a.png", vec!["Host: HOST"], 403),
        (
            "/image/a.png",
            vec!["Host: HOST", "x-dapple-token: wrong"],
            403,
        ),
        ("/nothing.js", vec!["Host: HOST"], 404),
    ] {
        let found = server.status(path, &headers);
        assert!(
            found == status || (status == 400 && found == 403),
            "{path} {headers:?}: {found}"
        );
    }
    let answer = server.get("/", &["Host: HOST"]);
    let answer = answer.to_lowercase();
    for part in [
        "content-security-policy: default-src 'self'",
        "frame-ancestors 'none'",
        "nosniff",
        "no-referrer",
    ] {
        assert!(answer.contains(part), "{part} in {answer}");
    }
    assert!(!answer.contains("access-control"), "{answer}");
}

#[test]
fn any_name_and_port_of_this_machine_is_answered_and_no_other() {
    let server = Server::new(None);
    let own = format!(":{}", server.port);
    for name in ["127.0.0.1", "localhost", "[::1]", "LOCALHOST", "127.9.8.7"] {
        for port in [own.as_str(), ":9177", ""] {
            let host = format!("{name}{port}");
            assert_eq!(server.head("/", &[format!("Host: {host}")]), 200, "{host}");
            // A proxy may use TLS toward the browser.
            for scheme in ["http", "https"] {
                let origin = format!("{scheme}://{host}");
                assert_eq!(upgrade(&server, &host, &origin), 101, "{origin}");
            }
            for origin in [
                "http://evil.example",
                "http://localhost:1",
                "null",
                "",
                "file://",
            ] {
                assert_eq!(upgrade(&server, &host, origin), 403, "{host} from {origin}");
            }
        }
    }
    for name in [
        "evil.example",
        "localhost.evil.example",
        "127.0.0.1.evil.example",
        "127.0.0.1@evil.example",
        "evil-localhost",
        "2130706433",
        "0.0.0.0",
        "128.0.0.1",
        "[::2]",
        "",
    ] {
        let host = format!("{name}{own}");
        let answer = server.get("/", &[&format!("Host: {host}")]);
        // Invalid hosts are rejected with 400.
        let is_refused = answer.starts_with("HTTP/1.1 403") || answer.starts_with("HTTP/1.1 400");
        assert!(is_refused, "{host}: {answer}");
        assert_ne!(upgrade(&server, &host, &format!("http://{host}")), 101);
    }
    let refusal = server.get("/", &["Host: studio.example:5177"]);
    for advice in ["http://localhost:", "--public-url"] {
        assert!(refusal.contains(advice), "{refusal}");
    }
    let answer = server.get("/", &["Host: HOST"]).to_lowercase();
    assert!(answer.contains("connect-src 'self';"), "{answer}");
    assert!(!answer.contains("ws://"), "{answer}");
}

#[test]
fn a_public_url_is_one_more_name_for_the_page() {
    let server = Server::of(Server::folder(), None, Some("https://studio.example/5177/"));
    for (host, origin, status) in [
        ("studio.example", "https://studio.example", 101),
        ("STUDIO.example:443", "https://studio.example", 101),
        // A proxy may send the server's own name as the host.
        ("localhost:5177", "https://studio.example", 101),
        ("localhost:5177", "http://localhost:5177", 101),
        ("localhost:5177", "http://studio.example", 403),
        ("studio.example", "http://localhost:5177", 403),
        ("evil.example", "https://studio.example", 403),
        ("studio.example", "https://evil.example", 403),
        ("studio.example:444", "https://studio.example", 403),
    ] {
        assert_eq!(
            upgrade(&server, host, origin),
            status,
            "{host} from {origin}"
        );
    }
}

#[test]
fn a_link_of_another_site_opens_the_page_and_nothing_else() {
    let server = Server::new(None);
    let ways = |site: &str, mode: &str, target: &str| {
        [
            "Host: HOST".to_owned(),
            format!("Sec-Fetch-Site: {site}"),
            format!("Sec-Fetch-Mode: {mode}"),
            format!("Sec-Fetch-Dest: {target}"),
        ]
    };
    let status = |path: &str, headers: [String; 4]| {
        server.status(path, &headers.each_ref().map(String::as_str))
    };
    assert_eq!(status("/", ways("cross-site", "navigate", "document")), 200);
    assert_eq!(status("/", ways("cross-site", "navigate", "iframe")), 403);
    assert_eq!(status("/", ways("cross-site", "no-cors", "script")), 403);
    assert_eq!(status("/", ways("same-site", "cors", "empty")), 403);
    assert_eq!(
        status(
            "/assets/studio.js",
            ways("cross-site", "navigate", "document")
        ),
        403
    );
    let image = format!("/image/a.png?t={}", server.token);
    assert_eq!(
        status(&image, ways("cross-site", "navigate", "document")),
        403
    );
}

/// Opens a file and returns its text.
fn open(page: &mut Page, file: &str) -> Value {
    say(page, &json!({ "type": "open", "file": file }));
    until(page, "document")["text"].clone()
}

fn save(page: &mut Page, file: &str, text: &str) {
    say(
        page,
        &json!({ "type": "save", "file": file, "text": text, "overwrite": true }),
    );
}

/// Files that a page must not reach: files of other programs, and hidden recipes.
const OTHERS: [(&str, &str); 10] = [
    (".env", "SECRET=1\n"),
    (".git/config", "[core]\n"),
    ("notes/id_rsa", "secret\n"),
    (
        "Cargo.toml",
        "[package]\nname = \"dapple\"\ndescription = \"\"\"\ndapple = 1\n\"\"\"\n",
    ),
    ("pyproject.toml", "[project]\ndapple = 1\n"),
    ("broken.toml", "[project\ndapple = 1\n"),
    ("recipe.txt", RECIPE),
    (".hidden.toml", RECIPE),
    (".config/hidden.toml", RECIPE),
    ("under/.config/hidden.toml", RECIPE),
];

/// Starts a server for a folder with these files, some recipes, and a hidden image.
fn cluttered() -> Server {
    let server = Server::new(Some("my.toml"));
    let recipes = [
        ("good.toml", RECIPE),
        ("under/good.toml", RECIPE),
        // A recipe that is being edited is not valid TOML.
        ("half.toml", HALF),
        (".hidden.png", "image"),
    ];
    for (name, text) in OTHERS.into_iter().chain(recipes) {
        let path = server.folder.path().join(name);
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        fs::write(path, text).unwrap();
    }
    server
}

const HALF: &str = "# mine\ndapple = 1\n[material\n";

#[test]
fn only_recipes_are_opened_and_replaced() {
    let server = cluttered();
    let path = |name: &str| server.folder.path().join(name);
    let mut page = server.page();
    until(&mut page, "document");
    for (name, text) in OTHERS {
        say(&mut page, &json!({ "type": "open", "file": name }));
        let refused = refusal(&mut page);
        assert_eq!(refused["what"], "open", "{name}: {refused}");
        save(&mut page, name, RECIPE);
        let refused = refusal(&mut page);
        assert_eq!(refused["what"], "save", "{name}: {refused}");
        assert_eq!(fs::read_to_string(path(name)).unwrap(), text);
    }
    // Files of other programs and device names of Windows are rejected as new names.
    for (name, text) in [
        ("rust-toolchain.toml", "[toolchain]\n"),
        ("con.toml", RECIPE),
        ("COM7.a.toml", RECIPE),
    ] {
        save(&mut page, name, text);
        assert_eq!(refusal(&mut page)["what"], "save", "{name}");
        assert!(!path(name).exists());
    }
    for name in ["good.toml", "under/good.toml"] {
        assert_eq!(open(&mut page, name), RECIPE);
    }
    assert_eq!(open(&mut page, "half.toml"), HALF);
    save(&mut page, "half.toml", RECIPE);
    until(&mut page, "saved");
    assert_eq!(fs::read_to_string(path("half.toml")).unwrap(), RECIPE);
    let token = format!("x-dapple-token: {}", server.token);
    let status = server.status("/image/.hidden.png", &["Host: HOST", &token]);
    assert_eq!(status, 404);
}

#[test]
fn a_mark_before_a_recipe_is_neither_shown_nor_saved() {
    let server = cluttered();
    let path = |name: &str| server.folder.path().join(name);
    fs::write(path("marked.toml"), format!("\u{feff}{RECIPE}")).unwrap();
    let wide: Vec<u8> = RECIPE.encode_utf16().flat_map(u16::to_le_bytes).collect();
    fs::write(path("wide.toml"), wide).unwrap();
    let mut page = server.page();
    until(&mut page, "document");
    assert_eq!(open(&mut page, "marked.toml"), RECIPE);
    say(&mut page, &json!({ "type": "open", "file": "wide.toml" }));
    let refused = refusal(&mut page);
    let message = refused["message"].as_str().unwrap();
    assert!(message.contains("UTF-16, but must be UTF-8"), "{message}");
}

#[test]
fn a_save_removes_what_ended_saves_have_left() {
    let server = cluttered();
    let path = |name: &str| server.folder.path().join(name);
    fs::write(path(".dapple-x.part"), "half a recipe").unwrap();
    let mut page = server.page();
    until(&mut page, "document");
    save(&mut page, "new.toml", RECIPE);
    until(&mut page, "saved");
    assert!(!path(".dapple-x.part").exists());
}

#[test]
fn a_file_that_is_read_only_is_not_replaced() {
    let server = cluttered();
    let path = server.folder.path().join("good.toml");
    let mut permissions = fs::metadata(&path).unwrap().permissions();
    permissions.set_readonly(true);
    fs::set_permissions(&path, permissions).unwrap();
    let mut page = server.page();
    until(&mut page, "document");
    save(&mut page, "good.toml", "dapple = 1\n");
    let refused = refusal(&mut page);
    assert_eq!(refused["what"], "save", "{refused}");
    assert_eq!(refused["message"], "good.toml is read-only");
    assert_eq!(fs::read_to_string(&path).unwrap(), RECIPE);
}

#[test]
#[cfg(unix)]
fn links_within_the_folder_are_names_of_recipes_but_not_of_what_is_hidden() {
    use std::os::unix::fs::symlink;
    let server = cluttered();
    let path = |name: &str| server.folder.path().join(name);
    for (link, to) in [
        ("link.toml", ".hidden.toml"),
        ("link.png", ".hidden.png"),
        ("inside.toml", "good.toml"),
    ] {
        symlink(to, path(link)).unwrap();
    }
    let mut page = server.page();
    until(&mut page, "document");
    let token = format!("x-dapple-token: {}", server.token);
    let status = server.status("/image/link.png", &["Host: HOST", &token]);
    assert_eq!(status, 404);
    say(&mut page, &json!({ "type": "open", "file": "link.toml" }));
    assert_eq!(refusal(&mut page)["what"], "open");
    // Saving replaces the target of the link, and the link remains.
    assert_eq!(open(&mut page, "inside.toml"), RECIPE);
    let text = "dapple = 1\n[material]\nheight = 0.5\n";
    save(&mut page, "inside.toml", text);
    until(&mut page, "saved");
    assert_eq!(fs::read_to_string(path("good.toml")).unwrap(), text);
    assert!(path("inside.toml").is_symlink());
}

/// Overwrites a file in place.
fn write(path: &Path, text: &str) {
    fs::write(path, text).unwrap();
}

#[test]
#[cfg(unix)]
fn the_recipe_that_was_named_is_opened_followed_and_saved_through_its_link() {
    let elsewhere = tempfile::tempdir().unwrap();
    let real = elsewhere.path().join("real.toml");
    write(&real, RECIPE);
    write(&elsewhere.path().join("other.toml"), RECIPE);
    let folder = Server::folder();
    for (link, to) in [("link.toml", "real.toml"), ("other.toml", "other.toml")] {
        std::os::unix::fs::symlink(elsewhere.path().join(to), folder.path().join(link)).unwrap();
    }
    let server = Server::of(folder, Some("link.toml"), None);
    let mut page = server.page();
    assert_eq!(until(&mut page, "document")["text"], RECIPE);
    // Writing the target of the link in place causes no event in the folder.
    let text = "dapple = 1\n[material]\nheight = 0.125\n";
    write(&real, text);
    assert_eq!(until(&mut page, "disk")["text"], text);
    let text = "dapple = 1\n[material]\nheight = 0.75\n";
    save(&mut page, "link.toml", text);
    until(&mut page, "saved");
    assert_eq!(fs::read_to_string(&real).unwrap(), text);
    assert!(server.folder.path().join("link.toml").is_symlink());
    // Links to other files are still rejected.
    say(&mut page, &json!({ "type": "open", "file": "other.toml" }));
    assert_eq!(refusal(&mut page)["what"], "open");
}

#[test]
fn a_save_is_told_while_another_file_of_the_folder_changes_all_the_time() {
    let server = Server::new(Some("my.toml"));
    let mut page = server.page();
    until(&mut page, "document");
    let log = server.folder.path().join("log.txt");
    let is_over = std::sync::atomic::AtomicBool::new(false);
    std::thread::scope(|scope| {
        scope.spawn(|| {
            while !is_over.load(std::sync::atomic::Ordering::SeqCst) {
                write(&log, "more");
                std::thread::sleep(std::time::Duration::from_millis(5));
            }
        });
        let text = "dapple = 1\n[material]\nheight = 0.625\n";
        write(&server.folder.path().join("my.toml"), text);
        let told = until(&mut page, "disk");
        is_over.store(true, std::sync::atomic::Ordering::SeqCst);
        assert_eq!(told["text"], text);
    });
}
