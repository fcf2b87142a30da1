//! Files that were made for a page to download. They lie in memory.

use super::ExportedFile;
use super::page::content_type;
use crate::message::FileSize;
use axum::body::Bytes;
use axum::http::StatusCode;
use axum::http::header::{CONTENT_DISPOSITION, CONTENT_TYPE};
use axum::response::{IntoResponse as _, Response};
use std::collections::VecDeque;
use std::sync::{Mutex, MutexGuard, PoisonError};

/// How many exports are kept.
const KEPT: usize = 4;

/// The last exports.
#[derive(Default)]
pub(super) struct Exports {
    all: Mutex<Made>,
}

#[derive(Default)]
struct Made {
    count: u64,
    /// The content of a file is shared with the downloads of it.
    exports: VecDeque<(String, Vec<(String, Bytes)>)>,
}

impl Exports {
    /// Keeps some files, and gives the name under which they lie, with their lengths.
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

    /// The file of an address such as `1/rock_height.png`.
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
        // Names are made of plain characters: those of recipes and maps.
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

/// Whether a name of an address, with its percent signs, is that of a file.
fn is_name(address: &str, name: &str) -> bool {
    super::files::decoded(address).as_deref() == Some(name)
}
