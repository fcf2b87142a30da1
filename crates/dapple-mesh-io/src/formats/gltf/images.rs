//! Replaces images in a file and preserves the rest of the document.

use super::container::Container;
use super::document::Document;
use super::{Source, parse, write, wrong};
use crate::{FileResolver, MeshIoError};
use dapple_mesh::EncodedImage;
use serde_json::{Map, Value, json};
use std::borrow::Cow;
use std::collections::BTreeMap;
use std::ops::Range;

/// A document that is being edited, with the bytes of its merged buffer.
struct Draft {
    value: Value,
    bin: Vec<u8>,
    /// Number of references to each buffer view in the document.
    uses: BTreeMap<u64, usize>,
    /// New contents of existing buffer views.
    contents: BTreeMap<usize, Vec<u8>>,
}

/// Encodes a glTF or GLB file as GLB with some images replaced.
///
/// `replaced` contains pairs of an image and its replacement. Every image in the file whose bytes equal the first is
/// replaced by the second. The rest of the document is unchanged: materials, nodes, skins, animations, extensions.
/// Buffers are merged into one, and external images become part of the file. A texture whose image is replaced loses
/// the alternatives in other formats, which viewers would prefer.
///
/// # Errors
///
/// Same as [`read`](super::read) for the container, the JSON and missing buffers;
/// [`MeshIoErrorKind::Size`](crate::MeshIoErrorKind::Size) if the file would have 2^32 bytes or more.
pub fn replace_images(
    bytes: &[u8],
    resolve: &mut FileResolver<'_>,
    replaced: &[(EncodedImage, EncodedImage)],
) -> Result<Vec<u8>, MeshIoError> {
    let container = Container::read(bytes)?;
    let document: Document = parse(container.json)?;
    let value: Value = parse(container.json)?;
    if !value.is_object() {
        return Err(wrong("the document is no object"));
    }
    let buffers = container.buffers(&document, resolve);
    let source = Source { document, buffers };
    // A view of a missing buffer would refer to bytes of another buffer after merging.
    let mut views = source.document.buffer_views.iter();
    let is_missing = |at: usize| matches!(source.buffers.get(at), Some(None));
    if let Some(view) = views.find(|view| is_missing(view.buffer)) {
        return Err(source.missing(view.buffer));
    }
    let mut draft = Draft {
        uses: BTreeMap::new(),
        bin: Vec::new(),
        contents: BTreeMap::new(),
        value,
    };
    count_views(&draft.value, &mut draft.uses);
    draft.join_buffers(&source.buffers);
    for (at, image) in source.document.images.iter().enumerate() {
        let Some(bytes) = source.image_bytes(image, resolve) else {
            continue;
        };
        let is_inside = image
            .uri
            .as_ref()
            .is_none_or(|uri| uri.starts_with("data:"));
        if let Some((_, new)) = replaced.iter().find(|(old, _)| old.bytes() == bytes) {
            draft.set_image(at, new.bytes().to_vec(), new.format().media_type());
            draft.drop_copies(at);
        } else if let (false, Some(media_type)) = (is_inside, media_type(&bytes)) {
            draft.set_image(at, bytes, media_type);
        }
    }
    draft.file()
}

/// Returns the media type of an image by its signature, for the formats that occur in glTF files.
fn media_type(bytes: &[u8]) -> Option<&'static str> {
    match bytes {
        [
            b'R',
            b'I',
            b'F',
            b'F',
            _,
            _,
            _,
            _,
            b'W',
            b'E',
            b'B',
            b'P',
            ..,
        ] => Some("image/webp"),
        [0xab, b'K', b'T', b'X', b' ', b'2', b'0', 0xbb, ..] => Some("image/ktx2"),
        _ => {
            let image = EncodedImage::new(bytes.to_vec()).ok()?;
            Some(image.format().media_type())
        }
    }
}

/// Adds the properties named `bufferView` in a value, recursively, to the counts in `uses`.
fn count_views(value: &Value, uses: &mut BTreeMap<u64, usize>) {
    match value {
        Value::Array(items) => items.iter().for_each(|item| count_views(item, uses)),
        Value::Object(entries) => {
            for (name, item) in entries {
                match item.as_u64().filter(|_| name == "bufferView") {
                    Some(view) => *uses.entry(view).or_default() += 1,
                    None => count_views(item, uses),
                }
            }
        }
        _ => {}
    }
}

/// Returns the index or offset called `name`; 0 if it is missing.
fn number(entries: &Map<String, Value>, name: &str) -> usize {
    let number = entries.get(name).and_then(Value::as_u64);
    number
        .and_then(|number| usize::try_from(number).ok())
        .unwrap_or(0)
}

impl Draft {
    /// Iterates over the objects of a list of the document.
    fn objects(&mut self, name: &str) -> impl Iterator<Item = &mut Map<String, Value>> {
        let list = self.value.get_mut(name).and_then(Value::as_array_mut);
        list.into_iter().flatten().filter_map(Value::as_object_mut)
    }

    /// Merges all buffers into one. Adjusts the offsets of buffer views, and of extensions that name a buffer.
    fn join_buffers(&mut self, buffers: &[Option<Cow<'_, [u8]>>]) {
        let mut starts = Vec::new();
        for buffer in buffers {
            self.bin.resize(self.bin.len().next_multiple_of(4), 0);
            starts.push(self.bin.len());
            self.bin
                .extend(buffer.iter().flat_map(|buffer| buffer.iter()));
        }
        let join = |entries: &mut Map<String, Value>| {
            let Some(&start) = starts
                .get(number(entries, "buffer"))
                .filter(|start| **start > 0)
            else {
                return;
            };
            entries.insert(
                "byteOffset".into(),
                (number(entries, "byteOffset").saturating_add(start)).into(),
            );
            entries.insert("buffer".into(), 0.into());
        };
        for view in self.objects("bufferViews") {
            join(view);
            let extensions = view.get_mut("extensions").and_then(Value::as_object_mut);
            let extensions = extensions.into_iter().flat_map(Map::values_mut);
            let extensions = extensions.filter_map(Value::as_object_mut);
            extensions
                .filter(|entries| entries.contains_key("buffer"))
                .for_each(join);
        }
    }

    /// Replaces the bytes of an image: in its buffer view if nothing else uses that view, otherwise in a new view.
    fn set_image(&mut self, at: usize, bytes: Vec<u8>, media_type: &str) {
        let n_views = self.value["bufferViews"].as_array().map_or(0, Vec::len);
        let image = self.value["images"]
            .get_mut(at)
            .and_then(Value::as_object_mut);
        let Some(image) = image else { return };
        let own = image.get("bufferView").and_then(Value::as_u64);
        let own = own.filter(|own| self.uses.get(own) == Some(&1));
        let own = own
            .and_then(|own| usize::try_from(own).ok())
            .filter(|own| *own < n_views);
        image.remove("uri");
        image.insert("mimeType".into(), media_type.into());
        image.insert("bufferView".into(), own.unwrap_or(n_views).into());
        if own.is_none() {
            if n_views == 0 {
                self.value["bufferViews"] = json!([]);
            }
            if let Some(views) = self.value["bufferViews"].as_array_mut() {
                views.push(json!({ "buffer": 0, "byteLength": 0 }));
            }
        }
        self.contents.insert(own.unwrap_or(n_views), bytes);
    }

    /// Removes alternative images in other formats from the textures that use an image.
    fn drop_copies(&mut self, image: usize) {
        for texture in self.objects("textures") {
            if texture.get("source").and_then(Value::as_u64) != Some(image as u64) {
                continue;
            }
            let Some(extensions) = texture.get_mut("extensions").and_then(Value::as_object_mut)
            else {
                continue;
            };
            extensions.retain(|_, extension| extension.get("source").is_none());
            if extensions.is_empty() {
                texture.remove("extensions");
            }
        }
    }

    /// Returns the byte ranges that no longer have a use because their images were replaced, in order. The length of
    /// each is a multiple of four.
    fn cuts(&mut self) -> Vec<Range<usize>> {
        let contents = core::mem::take(&mut self.contents);
        let (mut freed, mut kept) = (Vec::new(), Vec::new());
        for (at, view) in self.objects("bufferViews").enumerate() {
            let start = number(view, "byteOffset");
            let range = start..start.saturating_add(number(view, "byteLength"));
            let extensions = view.get("extensions").and_then(Value::as_object);
            for other in extensions
                .into_iter()
                .flat_map(Map::values)
                .filter_map(Value::as_object)
            {
                let start = number(other, "byteOffset");
                kept.push(start..start.saturating_add(number(other, "byteLength")));
            }
            if contents.contains_key(&at) {
                freed.push(range);
            } else {
                kept.push(range);
            }
        }
        self.contents = contents;
        kept.sort_by_key(|range| range.start);
        freed.sort_by_key(|range| range.start);
        // Running maximum of the ends of the retained ranges.
        let ends: Vec<_> = kept
            .iter()
            .scan(0, |end, range| {
                *end = range.end.max(*end);
                Some(*end)
            })
            .collect();
        let mut cuts: Vec<Range<usize>> = Vec::new();
        for range in freed {
            let before = kept.partition_point(|other| other.start < range.end);
            let is_shared = before > 0 && ends[before - 1] > range.start;
            let start = range.start.max(cuts.last().map_or(0, |cut| cut.end));
            let end = range.end.min(self.bin.len());
            if !is_shared && start < end {
                cuts.push(start..start + (end - start) / 4 * 4);
            }
        }
        cuts
    }

    /// Encodes the GLB file, without the bytes of replaced images and with the new images at its end.
    fn file(mut self) -> Result<Vec<u8>, MeshIoError> {
        let cuts = self.cuts();
        // Total number of bytes removed up to and including each cut.
        let mut before = vec![0];
        let (mut bin, mut end) = (Vec::new(), 0);
        for cut in &cuts {
            bin.extend(&self.bin[end..cut.start]);
            before.push(before[before.len() - 1] + cut.len());
            end = cut.end;
        }
        bin.extend(&self.bin[end..]);
        let shift = |entries: &mut Map<String, Value>| {
            let at = number(entries, "byteOffset");
            let before = before[cuts.partition_point(|cut| cut.end <= at)];
            if before > 0 {
                entries.insert("byteOffset".into(), (at - before).into());
            }
        };
        let contents = core::mem::take(&mut self.contents);
        for (at, view) in self.objects("bufferViews").enumerate() {
            if let Some(content) = contents.get(&at) {
                bin.resize(bin.len().next_multiple_of(4), 0);
                view.insert("byteOffset".into(), bin.len().into());
                view.insert("byteLength".into(), content.len().into());
                view.insert("buffer".into(), 0.into());
                bin.extend(content);
                continue;
            }
            shift(view);
            let extensions = view.get_mut("extensions").and_then(Value::as_object_mut);
            let extensions = extensions.into_iter().flat_map(Map::values_mut);
            let extensions = extensions.filter_map(Value::as_object_mut);
            extensions
                .filter(|entries| entries.contains_key("buffer"))
                .for_each(shift);
        }
        if !bin.is_empty() {
            let mut buffer = match self.objects("buffers").next() {
                Some(buffer) => core::mem::take(buffer),
                None => Map::new(),
            };
            buffer.remove("uri");
            buffer.insert("byteLength".into(), bin.len().into());
            self.value["buffers"] = json!([buffer]);
        }
        self.value.sort_all_objects();
        write::container(self.value.to_string().into_bytes(), bin)
    }
}
