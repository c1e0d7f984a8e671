//! Where do the document and its buffers lie?
//!
//! In a `.glb`, in a `.gltf` with base64 within, or beside it. No file outside the scene's folder is read.

use super::document::Document;
use crate::base::error::{Error, Result};
use crate::base::names::printable;
use base64::Engine;
use base64::alphabet;
use base64::engine::DecodePaddingMode;
use base64::engine::general_purpose::{GeneralPurpose, GeneralPurposeConfig};
use std::borrow::Cow;
use std::fmt::Display;
use std::fs::File;
use std::io::Read;
use std::path::{Path, PathBuf};

/// Most bytes of a file, and of all buffers together: 2 GiB.
const LARGEST_FILE: u64 = 2 << 30;
/// Most bytes of a document: 256 MiB hold about two million nodes.
const LARGEST_DOCUMENT: usize = 256 << 20;

/// Base64 with or without padding at its end.
const BASE64: GeneralPurpose = GeneralPurpose::new(
    &alphabet::STANDARD,
    GeneralPurposeConfig::new()
        .with_decode_padding_mode(DecodePaddingMode::Indifferent)
        .with_decode_allow_trailing_bits(true),
);
/// What some editors put before a text in UTF-8.
const BYTE_ORDER_MARK: &[u8] = b"\xef\xbb\xbf";

const MAGIC: &[u8; 4] = b"glTF";
const JSON: u32 = u32::from_le_bytes(*b"JSON");
const BIN: u32 = u32::from_le_bytes(*b"BIN\0");

/// What a file is made of.
pub(super) struct Container<'b> {
    pub(super) json: &'b [u8],
    /// The binary chunk of a `.glb` that has one.
    pub(super) chunk: Option<&'b [u8]>,
    /// Bytes after the end of a `.glb`.
    pub(super) after: usize,
}

/// The name of the file that is read, for errors.
#[derive(Clone, Copy)]
pub(super) struct Source<'a>(pub(super) &'a Path);

impl Source<'_> {
    /// An error at a path of the document.
    pub(super) fn wrong(&self, field: impl Display, message: impl Display) -> Error {
        self.error(None, field, message)
    }

    fn error(&self, line: Option<usize>, field: impl Display, message: impl Display) -> Error {
        let (field, message) = (printable(&field.to_string()), printable(&message.to_string()));
        Error::Input { file: self.0.to_owned(), line, field, message }
    }

    /// The file's bytes.
    pub(super) fn read(&self) -> Result<Vec<u8>> {
        let bytes = read(self.0, LARGEST_FILE + 1)?;
        if bytes.len() as u64 > LARGEST_FILE {
            return Err(self.wrong("", format_args!("the file is larger than {LARGEST_FILE} bytes, the most")));
        }
        Ok(bytes)
    }

    /// The JSON of a file, and the binary chunk if it has one.
    pub(super) fn split<'b>(&self, bytes: &'b [u8]) -> Result<Container<'b>> {
        let is_glb = self.0.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("glb"));
        if !is_glb && !bytes.starts_with(MAGIC) {
            return Ok(Container { json: bytes, chunk: None, after: 0 });
        }
        let (header, mut rest) = bytes.split_at_checked(12).ok_or_else(|| {
            self.wrong("header", format_args!("the file has {} bytes; a .glb begins with 12 of header", bytes.len()))
        })?;
        if !header.starts_with(MAGIC) {
            let found = header[..4].escape_ascii();
            return Err(self.wrong("header.magic", format_args!("\"{found}\" is given; a .glb begins with \"glTF\"")));
        }
        let (version, length) = (number(&header[4..]), number(&header[8..]));
        if version != 2 {
            return Err(self.wrong("header.version", format_args!("{version} is given; version 2 is read here")));
        }
        let Some((within, after)) = (length as usize).checked_sub(12).and_then(|length| rest.split_at_checked(length))
        else {
            let found = bytes.len();
            return Err(self.wrong(
                "header.length",
                format_args!("{length} bytes are announced and {found} are there: the file is broken off or patched"),
            ));
        };
        rest = within;
        let after = after.len();
        let mut chunks = [None; 2];
        let mut at = 0;
        while !rest.is_empty() {
            let refuse = |message: &dyn Display| self.wrong(format_args!("chunks[{at}].length"), message);
            let (head, left) =
                rest.split_at_checked(8).ok_or_else(|| refuse(&"is missing: the file ends in a chunk's head"))?;
            let (length, kind) = (number(head), number(&head[4..]));
            let (body, following) = left
                .split_at_checked(length as usize)
                .ok_or_else(|| refuse(&format_args!("{length} bytes are announced and {} are left", left.len())))?;
            match (at, kind) {
                (0, JSON) => chunks[0] = Some(body),
                (1, BIN) => chunks[1] = Some(body),
                (0, _) => return Err(self.wrong("chunks[0].type", "the first chunk of a .glb is its JSON")),
                // The specification has readers skip chunks that they do not know.
                _ => {}
            }
            (rest, at) = (following, at + 1);
        }
        let json = chunks[0].ok_or_else(|| self.wrong("chunks[0]", "is missing: a .glb holds a chunk of JSON"))?;
        Ok(Container { json, chunk: chunks[1], after })
    }

    /// The document that JSON spells.
    pub(super) fn document<'b>(&self, json: &'b [u8]) -> Result<Document<'b>> {
        if json.len() > LARGEST_DOCUMENT {
            return Err(self.wrong("", format_args!("the JSON is larger than {LARGEST_DOCUMENT} bytes, the most")));
        }
        let json = json.strip_prefix(BYTE_ORDER_MARK).unwrap_or(json);
        if json.trim_ascii().is_empty() {
            return Err(self.wrong("", "the file is empty; a glTF document has at least an `asset` and a `scenes`"));
        }
        serde_json::from_slice(json).or_else(|_| {
            // Once more, slower, keeping track of where.
            let mut deserializer = serde_json::Deserializer::from_slice(json);
            let wrong = match serde_path_to_error::deserialize(&mut deserializer) {
                Ok(document) => return deserializer.end().map(|()| document).map_err(|e| self.not_json("", &e)),
                Err(wrong) => wrong,
            };
            // The whole document is `.`, a key that is none `?`.
            Err(self.not_json(wrong.path().to_string().trim_end_matches(['.', '?']), wrong.inner()))
        })
    }

    fn not_json(&self, field: &str, error: &serde_json::Error) -> Error {
        let text = error.to_string();
        let place = format!(" at line {} column {}", error.line(), error.column());
        let message = text.strip_suffix(&place).unwrap_or(&text);
        self.error(Some(error.line()), field, format_args!("{message} (column {})", error.column()))
    }

    /// The bytes of every buffer; `chunk` is the binary chunk of a `.glb`.
    pub(super) fn buffers<'b>(&self, document: &Document, chunk: Option<&'b [u8]>) -> Result<Vec<Cow<'b, [u8]>>> {
        let mut total = 0u64;
        let buffer = |(i, buffer): (usize, &super::document::Buffer)| {
            let length = buffer.byte_length;
            total = total.saturating_add(length);
            if total > LARGEST_FILE {
                return Err(self.wrong(
                    format_args!("buffers[{i}].byteLength"),
                    format_args!("{length} is given; all buffers together may have {LARGEST_FILE} bytes"),
                ));
            }
            let bytes = match (&buffer.uri, chunk) {
                (Some(uri), _) => Cow::Owned(self.fetch(&format_args!("buffers[{i}].uri"), uri, length)?),
                (None, Some(chunk)) if i == 0 => Cow::Borrowed(chunk),
                (None, _) => {
                    let text = "is missing; the name of a file beside this one or data in base64 is asked for";
                    return Err(self.wrong(format_args!("buffers[{i}].uri"), text));
                }
            };
            if (bytes.len() as u64) < length {
                let found = bytes.len();
                return Err(self.wrong(
                    format_args!("buffers[{i}].byteLength"),
                    format_args!("{length} bytes are announced and {found} are there"),
                ));
            }
            Ok(bytes)
        };
        document.buffers.iter().enumerate().map(buffer).collect()
    }

    /// At most `length` bytes that a URI names, which the document gives at `field`; all of them where it holds them.
    pub(super) fn fetch(&self, field: &dyn Display, uri: &str, length: u64) -> Result<Vec<u8>> {
        let refuse = |message: &dyn Display| self.wrong(field, message);
        if let Some(data) = uri.strip_prefix("data:") {
            let (_, data) = data
                .split_once(";base64,")
                .ok_or_else(|| refuse(&"this data is not in base64, the one way that is read here"))?;
            return BASE64.decode(data).map_err(|error| refuse(&format_args!("this is no base64: {error}")));
        }
        let shown = || uri.chars().take(80).collect::<String>();
        let path = beside(uri).ok_or_else(|| {
            refuse(&format_args!(
                "\"{}\" is given; the name of a file in the scene's folder is asked for, without a scheme, `..` \
                 or a leading slash",
                shown()
            ))
        })?;
        let folder = self.0.parent().unwrap_or(Path::new(""));
        let path = folder.join(path);
        if !path.is_file() {
            return Err(refuse(&format_args!("there is no file {}", path.display())));
        }
        let folder = if folder.as_os_str().is_empty() { Path::new(".") } else { folder };
        let [inside, whole] = [folder, &path].map(|path| path.canonicalize().map_err(Error::io("read", path)));
        if !whole?.starts_with(inside?) {
            let text = "is given, a link out of the scene's folder; copy the file there";
            return Err(refuse(&format_args!("\"{}\" {text}", shown())));
        }
        read(&path, length)
    }
}

/// At most so many bytes of a file.
fn read(path: &Path, most: u64) -> Result<Vec<u8>> {
    let mut bytes = Vec::new();
    let file = File::open(path).map_err(Error::io("read", path))?;
    file.take(most).read_to_end(&mut bytes).map_err(Error::io("read", path))?;
    Ok(bytes)
}

/// The path that a relative URI names, within the folder; `None` for anything else.
fn beside(uri: &str) -> Option<PathBuf> {
    let mut decoded = Vec::with_capacity(uri.len());
    let mut bytes = uri.bytes();
    while let Some(byte) = bytes.next() {
        decoded.push(match byte {
            b'%' => {
                let mut digit = || char::from(bytes.next()?).to_digit(16);
                (digit()? * 16 + digit()?) as u8
            }
            other => other,
        });
    }
    let path = String::from_utf8(decoded).ok()?;
    // A colon is a scheme or a drive; a backslash parts folders on some systems.
    let inside = !path.is_empty()
        && !path.contains([':', '\\', '\0'])
        && path.split('/').all(|part| !part.is_empty() && part != "..");
    inside.then(|| path.into())
}

fn number(bytes: &[u8]) -> u32 {
    u32::from_le_bytes([bytes[0], bytes[1], bytes[2], bytes[3]])
}
