//! Exported files, kept in memory for download.

use super::ExportedFile;
use super::page::content_type;
use crate::message::FileSize;
use axum::body::Bytes;
use axum::http::StatusCode;
use axum::http::header::{CONTENT_DISPOSITION, CONTENT_TYPE};
use axum::response::{IntoResponse as _, Response};
use std::collections::VecDeque;
use std::sync::{Mutex, MutexGuard, PoisonError};

/// Maximum number of stored exports. Older ones are dropped.
const KEPT: usize = 4;

/// The most recent exports.
#[derive(Default)]
pub(super) struct Exports {
    all: Mutex<Made>,
}

#[derive(Default)]
struct Made {
    count: u64,
    /// Exports by id, oldest first, each with its files. A file's bytes are shared with its downloads.
    exports: VecDeque<(String, Vec<(String, Bytes)>)>,
}

impl Exports {
    /// Stores files, and returns the id of the export with the lengths of the files.
    pub(super) fn keep(&self, files: Vec<ExportedFile>) -> (String, Vec<FileSize>) {
        let sizes = files.iter().map(|file| FileSize {
            name: file.name.clone(),
            bytes: file.bytes.len(),
        });
        let sizes: Vec<_> = sizes.collect();
        let files = files.into_iter().map(|file| (file.name, file.bytes.into()));
        let files = files.collect();
        let mut made = self.lock();
        made.count += 1;
        let id = made.count.to_string();
        made.exports.push_back((id.clone(), files));
        while made.exports.len() > KEPT {
            made.exports.pop_front();
        }
        (id, sizes)
    }

    /// Answers a download from an address such as `1/rock_height.png`.
    pub(super) fn get(&self, address: &str) -> Response {
        let Some((id, name)) = address.split_once('/') else {
            return StatusCode::NOT_FOUND.into_response();
        };
        let made = self.lock();
        let export = made.exports.iter().find(|(known, _)| known == id);
        let file =
            export.and_then(|(_, files)| files.iter().find(|(known, _)| is_name(name, known)));
        let Some((name, bytes)) = file else {
            return StatusCode::NOT_FOUND.into_response();
        };
        // Names consist of the names of recipes and maps. Replace characters that would break the header.
        let plain: String = name
            .chars()
            .map(|c| {
                if c.is_ascii_graphic() && c != '"' && c != '\\' {
                    c
                } else {
                    '_'
                }
            })
            .collect();
        let headers = [
            (CONTENT_TYPE, content_type(name).to_owned()),
            (
                CONTENT_DISPOSITION,
                format!("attachment; filename=\"{plain}\""),
            ),
        ];
        (headers, bytes.clone()).into_response()
    }

    fn lock(&self) -> MutexGuard<'_, Made> {
        self.all.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// Returns whether a percent-encoded name of an address equals the name of a file.
fn is_name(address: &str, name: &str) -> bool {
    super::files::decoded(address).as_deref() == Some(name)
}
