//! The files of the page, which are embedded in the program if they existed when it was built.

use axum::http::StatusCode;
use axum::http::header::{CONTENT_ENCODING, CONTENT_TYPE};
use axum::response::{Html, IntoResponse as _, Response};
use std::path::Path;

/// The embedded files and their names.
const FILES: &[(&str, &[u8])] = include!(concat!(env!("OUT_DIR"), "/page.rs"));

/// The page shown by a program that was built without the files of the page.
const MISSING: &str = "<!doctype html><html lang=en><title>dapple studio</title><p>The page of the studio is not part \
    of this program: build it with <code>cargo xtask studio</code> in the repository of dapple, which needs Node.</p>";

/// Returns whether the page is embedded in the program.
pub(super) fn is_built() -> bool {
    found(FILES, "index.html").is_some()
}

/// Returns the license texts of third-party code in the page.
pub(super) fn licenses() -> Option<&'static str> {
    let (text, _) = found(FILES, "licenses.md")?;
    std::str::from_utf8(text).ok()
}

/// Finds a file by its name, or by its name with `.gz`. Returns its bytes, and whether they are compressed.
fn found<'a>(files: &[(&str, &'a [u8])], name: &str) -> Option<(&'a [u8], bool)> {
    files.iter().find_map(|(known, bytes)| {
        let is_compressed = known.strip_suffix(".gz") == Some(name);
        (*known == name || is_compressed).then_some((*bytes, is_compressed))
    })
}

/// Answers a request for a file of the page.
pub(super) fn file(path: &str, dist: Option<&Path>) -> Response {
    let name = path.trim_start_matches('/');
    let name = if name.is_empty() { "index.html" } else { name };
    if let Some(dist) = dist {
        return of_folder(name, dist);
    }
    if name == "index.html" && !is_built() {
        return Html(MISSING).into_response();
    }
    let kind = [(CONTENT_TYPE, content_type(name))];
    match found(FILES, name) {
        Some((bytes, false)) => (kind, bytes).into_response(),
        // Every browser decodes gzip.
        Some((bytes, true)) => (kind, [(CONTENT_ENCODING, "gzip")], bytes).into_response(),
        None => StatusCode::NOT_FOUND.into_response(),
    }
}

#[expect(clippy::disallowed_methods, reason = "for those who work on the page")]
fn of_folder(name: &str, dist: &Path) -> Response {
    // Reject hidden files and `..`.
    let is_plain = name
        .split('/')
        .all(|part| !part.is_empty() && !part.starts_with('.'));
    let bytes = is_plain
        .then(|| std::fs::read(dist.join(name)).ok())
        .flatten();
    match bytes {
        Some(bytes) => ([(CONTENT_TYPE, content_type(name))], bytes).into_response(),
        None => StatusCode::NOT_FOUND.into_response(),
    }
}

/// Returns the MIME type of a file, by its extension.
pub(super) fn content_type(name: &str) -> &'static str {
    match name
        .rsplit_once('.')
        .map_or("", |(_, ending)| ending)
        .to_ascii_lowercase()
        .as_str()
    {
        "html" => "text/html; charset=utf-8",
        "js" | "mjs" => "text/javascript; charset=utf-8",
        "css" => "text/css; charset=utf-8",
        "json" | "map" | "gltf" => "application/json",
        "svg" => "image/svg+xml",
        "png" => "image/png",
        "jpg" | "jpeg" => "image/jpeg",
        "webp" => "image/webp",
        "ico" => "image/x-icon",
        "woff2" => "font/woff2",
        "wasm" => "application/wasm",
        "glb" => "model/gltf-binary",
        "mtlx" => "application/xml",
        "toml" | "txt" | "md" => "text/plain; charset=utf-8",
        _ => "application/octet-stream",
    }
}

#[cfg(test)]
mod tests {
    use super::found;

    #[test]
    fn files_may_be_compressed() {
        let files: [(&str, &[u8]); 2] = [("a.js.gz", &[1]), ("b.js", &[2])];
        assert_eq!(found(&files, "a.js"), Some((&[1][..], true)));
        assert_eq!(found(&files, "b.js"), Some((&[2][..], false)));
        assert_eq!(found(&files, "a.js.gz"), Some((&[1][..], false)));
        assert_eq!(found(&files, "c.js"), None);
    }
}
