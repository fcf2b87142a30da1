//! Parses the header of a PLY file, which lists the elements and their properties.

use super::FORMAT;
use crate::MeshIoError;
use crate::text::{parse, words};

/// The header of a PLY file, which describes the body.
pub(super) struct Header {
    pub(super) encoding: Encoding,
    pub(super) elements: Vec<Element>,
    /// Names of textures, from comments.
    pub(super) textures: Vec<String>,
}

/// Encoding of the body.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Encoding {
    Text,
    Little,
    Big,
}

/// An element of PLY: consecutive items with the same properties, such as vertices.
pub(super) struct Element {
    pub(super) name: String,
    pub(super) count: u64,
    /// Line number in the file, starting at 1.
    pub(super) line: usize,
    pub(super) properties: Vec<Property>,
}

/// A property of the items of an element.
pub(super) struct Property {
    pub(super) name: String,
    pub(super) kind: Kind,
}

/// Kind of a property: a scalar or a list.
#[derive(Clone, Copy)]
pub(super) enum Kind {
    Scalar(Scalar),
    /// A list, with the type of its length and the type of its values.
    List(Scalar, Scalar),
}

/// Scalar type.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Scalar {
    I8,
    U8,
    I16,
    U16,
    I32,
    U32,
    F32,
    F64,
}

impl Header {
    /// Parses the header. Returns it with the remaining bytes.
    pub(super) fn read(bytes: &[u8]) -> Result<(Self, &[u8]), MeshIoError> {
        let mut header = Self {
            encoding: Encoding::Text,
            elements: Vec::new(),
            textures: Vec::new(),
        };
        let (mut rest, mut number, mut known) = (bytes, 0, false);
        loop {
            let end = rest.iter().position(|&byte| byte == b'\n');
            let end = end.ok_or_else(|| MeshIoError::file(FORMAT, "the header does not end"))?;
            let line: Vec<_> = words(&rest[..end]).collect();
            rest = &rest[end + 1..];
            number += 1;
            match (number, line.as_slice()) {
                (1, [b"ply"]) => {}
                (1, _) => {
                    return Err(MeshIoError::file(
                        FORMAT,
                        "line 1: the first line is not `ply`",
                    ));
                }
                (_, [b"comment", b"TextureFile", name @ ..]) if !name.is_empty() => {
                    let name = name.join(b" ".as_slice());
                    let name = String::from_utf8_lossy(&name).replace('\\', "/");
                    header.textures.push(name);
                }
                (_, [] | [b"comment" | b"obj_info", ..]) => {}
                (_, [b"format", encoding, _]) if !known => {
                    header.encoding = named(encoding).ok_or_else(|| wrong(number))?;
                    known = true;
                }
                (_, [b"end_header"]) if known => return Ok((header, rest)),
                (_, line) => header.add(number, line).ok_or_else(|| wrong(number))?,
            }
        }
    }

    /// Parses a line of the header; `None` if the line is invalid.
    fn add(&mut self, number: usize, line: &[&[u8]]) -> Option<()> {
        let text = |word: &[u8]| String::from_utf8_lossy(word).into_owned();
        match line {
            [b"element", name, count] => self.elements.push(Element {
                name: text(name),
                count: parse(count)?,
                line: number,
                properties: Vec::new(),
            }),
            [b"property", b"list", count, item, name] => {
                let (count, item) = (scalar(count)?, scalar(item)?);
                let (name, kind) = (text(name), Kind::List(count, item));
                self.elements
                    .last_mut()?
                    .properties
                    .push(Property { name, kind });
            }
            [b"property", kind, name] => {
                let (name, kind) = (text(name), Kind::Scalar(scalar(kind)?));
                self.elements
                    .last_mut()?
                    .properties
                    .push(Property { name, kind });
            }
            _ => return None,
        }
        Some(())
    }
}

impl Element {
    /// Returns the index of the first property with one of these names.
    pub(super) fn place(&self, names: &[&str]) -> Option<usize> {
        let mut properties = self.properties.iter();
        properties.position(|property| names.contains(&property.name.as_str()))
    }
}

impl Scalar {
    /// Returns the type's size in a binary file, in bytes.
    pub(super) fn size(self) -> usize {
        match self {
            Self::I8 | Self::U8 => 1,
            Self::I16 | Self::U16 => 2,
            Self::I32 | Self::U32 | Self::F32 => 4,
            Self::F64 => 8,
        }
    }
}

fn named(encoding: &[u8]) -> Option<Encoding> {
    Some(match encoding {
        b"ascii" => Encoding::Text,
        b"binary_little_endian" => Encoding::Little,
        b"binary_big_endian" => Encoding::Big,
        _ => return None,
    })
}

fn scalar(name: &[u8]) -> Option<Scalar> {
    Some(match name {
        b"char" | b"int8" => Scalar::I8,
        b"uchar" | b"uint8" => Scalar::U8,
        b"short" | b"int16" => Scalar::I16,
        b"ushort" | b"uint16" => Scalar::U16,
        b"int" | b"int32" => Scalar::I32,
        b"uint" | b"uint32" => Scalar::U32,
        b"float" | b"float32" => Scalar::F32,
        b"double" | b"float64" => Scalar::F64,
        _ => return None,
    })
}

fn wrong(number: usize) -> MeshIoError {
    let why = format!("line {number}: this is nothing that a header of PLY says");
    MeshIoError::file(FORMAT, why)
}
