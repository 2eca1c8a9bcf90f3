//! A package as its bytes arrive.

use std::ops::Range;

use relievo::InputError;
use relievo::asset::package::{PackageChunk, PackageHeader};

/// Bytes before the header's length is known.
const PRELUDE: u64 = 40;

/// Bytes of the first request when nothing is known of a package.
const FIRST: u64 = 32 << 10;

/// No header ends behind this byte.
const LONGEST: u64 = 1 << 21;

/// The parts of a package that have arrived: the beginning of header, model and levels, and the beginning of the images.
///
/// ```
/// use relievo_delivery::client::PackageStream;
///
/// # let rock = relievo_samples::rock()?.into();
/// # let file = relievo::ops::skinning::cook(&rock, &mut |_| std::ops::ControlFlow::Continue(()))?.expect("not broken off");
/// let mut stream = PackageStream::new();
/// // Level 0 is the finest.
/// while let Some(range) = stream.missing(0) {
///     let end = range.end.min(file.len() as u64);
///     stream.push(range.start, &file[range.start as usize..end as usize])?; // as it arrives
/// }
/// assert_eq!(stream.level(), Some(0));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug, Clone, Default)]
pub struct PackageStream {
    /// Header, model and levels.
    front: Region,
    images: Region,
    header: Option<PackageHeader>,
    /// Bytes of the first request; 0 for the default.
    first: u64,
}

/// A range of a file of which the beginning is there.
#[derive(Debug, Clone, Default)]
struct Region {
    /// Index of the first byte in the file.
    start: u64,
    bytes: Vec<u8>,
    /// The end in the file of the chunks that are complete.
    checked: u64,
}

/// Bytes that do not have the hash that they should have. They were dropped.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[error(transparent)]
pub struct Damaged(#[from] pub InputError);

impl PackageStream {
    /// A stream without any bytes.
    pub fn new() -> Self {
        Self::default()
    }

    /// A stream that goes on after the beginning of a file that was fetched in part.
    ///
    /// # Errors
    /// [`Damaged`] for bytes that are not the beginning of a package.
    pub fn resumed(bytes: &[u8]) -> Result<Self, Damaged> {
        let mut stream = Self::new();
        stream.push(0, bytes)?;
        Ok(stream)
    }

    /// Sets how many bytes are asked for as long as nothing is known of the package. A catalog tells where a level ends. By default
    /// it is 32 KiB.
    pub fn expect_first(&mut self, bytes: u64) {
        self.first = bytes;
    }

    /// Number of bytes that are there, complete chunks or not.
    pub fn len(&self) -> u64 {
        (self.front.bytes.len() + self.images.bytes.len()) as u64
    }

    /// Whether no byte is there.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Number of bytes of complete chunks.
    #[cfg(not(target_arch = "wasm32"))]
    pub(super) fn checked(&self) -> u64 {
        self.front.checked + (self.images.checked - self.images.start)
    }

    /// The beginning of the file up to the last chunk that is complete; images only behind the finest level.
    pub fn complete(&self) -> Vec<u8> {
        let own = |region: &Region| region.bytes[..(region.checked - region.start) as usize].to_vec();
        let mut bytes = own(&self.front);
        if self.level() == Some(0) {
            bytes.extend(own(&self.images));
        }
        bytes
    }

    /// The beginning of the file up to the end of a level, counted from 0, the finest. `None` if it is not complete.
    pub fn up_to(&self, level: usize) -> Option<Vec<u8>> {
        let levels = &self.header.as_ref()?.levels;
        let end = levels.get(levels.len().checked_sub(1 + level)?)?.chunk.end;
        (end as u64 <= self.front.checked).then(|| self.front.bytes[..end].to_vec())
    }

    /// The bytes that are there, of complete chunks or not, up to the first that is missing.
    pub fn beginning(&self) -> Vec<u8> {
        self.since(0)
    }

    /// The part of [`PackageStream::beginning`] from index `start` on.
    pub fn since(&self, start: u64) -> Vec<u8> {
        let is_whole = self.header.as_ref().is_some_and(|header| self.front.end() == front_end(header));
        let images = if is_whole { &self.images.bytes[..] } else { &[] };
        let own = self.front.bytes.get(start as usize..).unwrap_or_default();
        let skipped = start.saturating_sub(self.front.end()) as usize;
        [own, images.get(skipped..).unwrap_or_default()].concat()
    }

    /// The header, once it is there.
    pub fn header(&self) -> Option<&PackageHeader> {
        self.header.as_ref()
    }

    /// Number of levels that are complete.
    pub fn levels(&self) -> usize {
        let levels = self.header.iter().flat_map(|header| &header.levels);
        levels.take_while(|level| level.chunk.end as u64 <= self.front.checked).count()
    }

    /// The finest level that is complete, counted from 0, the finest of the package. `None` if there is none yet.
    pub fn level(&self) -> Option<usize> {
        let count = self.levels();
        Some(self.header.as_ref()?.levels.len() - count).filter(|_| count > 0)
    }

    /// Number of images that are complete.
    pub fn images(&self) -> usize {
        let images = self.header.iter().flat_map(|header| &header.images);
        images.take_while(|image| image.end as u64 <= self.images.checked).count()
    }

    /// The bytes of a chunk, if they are complete.
    pub fn chunk(&self, chunk: &PackageChunk) -> Option<&[u8]> {
        let region = if chunk.start as u64 >= self.images.start.max(1) { &self.images } else { &self.front };
        let (start, end) = (chunk.start as u64, chunk.end as u64);
        let is_complete = end <= region.checked && start >= region.start;
        is_complete.then(|| &region.bytes[(start - region.start) as usize..(end - region.start) as usize])
    }

    /// The range of bytes that is missing up to a level, counted from 0, the finest. `None` if nothing is missing. As long as
    /// the header is not there, the end may lie before that of the level, or behind the end of the file.
    pub fn missing(&self, level: usize) -> Option<Range<u64>> {
        let end = match &self.header {
            None => if self.first > 0 { self.first } else { FIRST }.max(self.header_end()),
            Some(header) => {
                let at = header.levels.len().saturating_sub(1 + level);
                header.levels.get(at)?.chunk.end as u64
            }
        };
        let start = self.front.end();
        (start < end).then_some(start..end)
    }

    /// The range of bytes that is missing up to the end of the images; `None` if nothing is missing, or without a header.
    pub fn missing_images(&self) -> Option<Range<u64>> {
        let end = self.header.as_ref()?.images.last()?.end as u64;
        let start = self.images.end();
        (start < end).then_some(start..end)
    }

    /// Adds bytes from index `start` of the file on, and checks every chunk that becomes complete.
    ///
    /// # Errors
    /// [`Damaged`] for a header or a chunk that is not what it should be, and for bytes that do not follow those that are there.
    /// They are dropped, and must be fetched again; what comes before them stays.
    pub fn push(&mut self, start: u64, bytes: &[u8]) -> Result<(), Damaged> {
        let region = match start {
            start if start == self.front.end() => &mut self.front,
            start if self.header.is_some() && start == self.images.end() => &mut self.images,
            _ => {
                let bound = format!("must be {} or {}, what comes next", self.front.end(), self.images.end());
                return Err(InputError::new("package.start", start, bound).into());
            }
        };
        region.bytes.extend_from_slice(bytes);
        let checked = self.check();
        if checked.is_err() {
            self.front.drop_unchecked();
            self.images.drop_unchecked();
        }
        checked
    }

    /// Drops the bytes of chunks that are not complete.
    pub fn drop_unchecked(&mut self) {
        self.front.drop_unchecked();
        self.images.drop_unchecked();
    }

    fn check(&mut self) -> Result<(), Damaged> {
        if self.header.is_none() {
            let is_short = (self.front.bytes.len() as u64) < self.header_end();
            let is_possible = self.front.bytes.len() < 8
                || self.front.bytes.starts_with(b"RLV\n") && self.header_end() <= LONGEST;
            if is_short && is_possible {
                return Ok(());
            }
            let (header, end) = PackageHeader::read(&self.front.bytes)?;
            let images = front_end(&header);
            self.images = Region { start: images, bytes: Vec::new(), checked: images };
            (self.header, self.front.checked) = (Some(header), end as u64);
        }
        let Some(header) = &self.header else { return Ok(()) };
        let levels = header.levels.iter().map(|level| &level.chunk);
        self.front.check(std::iter::once(&header.model).chain(levels), |at| match at.checked_sub(1) {
            None => "package.model".to_owned(),
            Some(level) => format!("package.levels[{level}]"),
        })?;
        let behind = self.front.bytes.split_off(self.front.len_up_to(front_end(header)));
        if self.images.bytes.is_empty() {
            self.images.bytes = behind;
        }
        self.images.check(header.images.iter(), |at| format!("package.images[{at}]"))?;
        // What lies behind the end belongs to nothing.
        self.images.truncate(header.bytes() as u64);
        Ok(())
    }

    /// The end of the header, as far as it is known.
    fn header_end(&self) -> u64 {
        let Some(length) = self.front.bytes.get(4..8) else { return PRELUDE };
        PRELUDE + length.iter().rev().fold(0, |length, byte| length << 8 | u64::from(*byte))
    }
}

/// The end of the levels in the file.
fn front_end(header: &PackageHeader) -> u64 {
    header.levels.last().map_or(header.model.end, |level| level.chunk.end) as u64
}

impl Region {
    fn end(&self) -> u64 {
        self.start + self.bytes.len() as u64
    }

    /// Number of bytes that are there before `end`.
    fn len_up_to(&self, end: u64) -> usize {
        self.bytes.len().min(end.saturating_sub(self.start) as usize)
    }

    fn truncate(&mut self, end: u64) {
        self.bytes.truncate(self.len_up_to(end));
    }

    fn drop_unchecked(&mut self) {
        self.truncate(self.checked);
    }

    /// Checks the chunks that became complete, in their order. `path` names a chunk by its number.
    fn check<'a>(
        &mut self,
        chunks: impl Iterator<Item = &'a PackageChunk>,
        path: impl Fn(usize) -> String,
    ) -> Result<(), InputError> {
        for (at, chunk) in chunks.enumerate() {
            if chunk.end as u64 <= self.checked {
                continue;
            }
            let first = chunk.start as u64 - self.start;
            let range = first as usize..first as usize + chunk.end - chunk.start;
            let Some(bytes) = self.bytes.get(range) else { break };
            chunk.check(&path(at), bytes)?;
            self.checked = chunk.end as u64;
        }
        Ok(())
    }
}
