//! What a server answers with: bytes in memory or in the store, with their encodings.

use axum::body::Bytes;
use object_store::path::Path;

use super::compress::{Encoding, compressed};
use crate::sha256;

/// A file of a server.
#[derive(Debug, Clone)]
pub(super) struct Resource {
    pub media: &'static str,
    /// SHA-256 of the content without encoding.
    pub hash: String,
    pub length: u64,
    pub content: Content,
    /// The content in other encodings, each smaller than the content.
    pub encoded: Vec<(Encoding, Bytes)>,
    pub lifetime: Lifetime,
}

#[derive(Debug, Clone)]
pub(super) enum Content {
    Memory(Bytes),
    /// An object of the cache.
    Stored(Path),
}

/// How long a client may use a file without asking again.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Lifetime {
    /// For ever: the path contains the hash of the content.
    Immutable,
    /// It must ask each time, and gets a short answer if nothing has changed.
    Revalidated,
}

/// Whether a file may be compressed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Compression {
    /// In each encoding in which it becomes smaller.
    Allowed,
    /// Never, as it is compressed already, or short.
    Never,
}

impl Resource {
    /// A file in memory.
    pub fn new(bytes: Vec<u8>, media: &'static str, lifetime: Lifetime, compression: Compression) -> Self {
        let encoded = match compression {
            Compression::Allowed => compressed(&bytes),
            Compression::Never => Vec::new(),
        };
        let (hash, length) = (sha256(&bytes), bytes.len() as u64);
        Self { media, hash, length, content: Content::Memory(bytes.into()), encoded, lifetime }
    }

    /// A file whose media type is that of its name. Text is compressed.
    pub fn named(bytes: Vec<u8>, name: &str, lifetime: Lifetime) -> Self {
        let media = media_type(name);
        let is_text = media.starts_with("text/") || media.contains("json") || media.contains("wasm");
        let compression = if is_text { Compression::Allowed } else { Compression::Never };
        Self::new(bytes, media, lifetime, compression)
    }

    /// Number of bytes in memory.
    pub fn memory(&self) -> u64 {
        let own = match &self.content {
            Content::Memory(bytes) => bytes.len(),
            Content::Stored(_) => 0,
        };
        (own + self.encoded.iter().map(|(_, bytes)| bytes.len()).sum::<usize>()) as u64
    }
}

/// The media type of a file name.
pub(super) fn media_type(name: &str) -> &'static str {
    match name.rsplit_once('.').map_or("", |(_, ending)| ending) {
        "html" => "text/html; charset=utf-8",
        "js" => "text/javascript",
        "css" => "text/css",
        "json" => "application/json",
        "wasm" => "application/wasm",
        "png" => "image/png",
        "jpg" | "jpeg" => "image/jpeg",
        "webp" => "image/webp",
        "svg" => "image/svg+xml",
        "glb" => "model/gltf-binary",
        "gltf" => "model/gltf+json",
        "obj" => "model/obj",
        "txt" | "md" => "text/plain; charset=utf-8",
        _ => "application/octet-stream",
    }
}
