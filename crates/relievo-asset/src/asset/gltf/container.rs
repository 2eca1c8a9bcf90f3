//! Splits a GLB into its JSON and its binary chunk (glTF 2.0, chapter 4). The crate `gltf` also has a reader for GLB, but that
//! reader panics on a header with a length below 12.

use crate::InputError;

/// The JSON of a document, and its binary chunk if it is a GLB.
pub struct Container<'a> {
    pub json: &'a [u8],
    pub binary: Option<&'a [u8]>,
}

const JSON: u32 = 0x4e4f_534a;
const BINARY: u32 = 0x004e_4942;

impl<'a> Container<'a> {
    /// Splits a GLB into JSON and binary chunk. Bytes that do not begin with the magic number of GLB are taken as JSON.
    pub fn new(bytes: &'a [u8]) -> Result<Self, InputError> {
        if !bytes.starts_with(b"glTF") {
            return Ok(Self { json: bytes, binary: None });
        }
        let word = |at: usize| {
            let word = bytes.get(at..).and_then(|rest| rest.first_chunk()).copied();
            let cut_off = || InputError::new("GLB", format!("[{} bytes]", bytes.len()), "is cut off");
            word.map(u32::from_le_bytes).ok_or_else(cut_off)
        };
        let (version, length) = (word(4)?, word(8)? as usize);
        InputError::check(version == 2, "GLB.version", version, || "must be 2")?;
        InputError::check_within("GLB.length", length, 12..=bytes.len())?;
        let mut found = Self { json: &[], binary: None };
        let mut at = 12;
        for chunk in 0.. {
            if at == length {
                break;
            }
            let size = word(at)? as usize;
            let kind = word(at + 4)?;
            let data = bytes.get(at + 8..).and_then(|rest| rest.get(..size)).ok_or_else(|| {
                let bound = format!("must be at most {}", length.saturating_sub(at + 8));
                InputError::new(format!("GLB.chunks[{chunk}].length"), size, bound)
            })?;
            match (chunk, kind) {
                (0, JSON) => found.json = data,
                (0, other) => {
                    let bound = "must be JSON";
                    return Err(InputError::new("GLB.chunks[0].type", format!("{other:#010x}"), bound));
                }
                (1, BINARY) => found.binary = Some(data),
                // glTF allows readers to skip chunks of unknown type.
                _ => {}
            }
            at += 8 + size;
        }
        Ok(found)
    }
}
