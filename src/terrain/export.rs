//! Heights in files: raw `i32`, 16-bit PNG (written and read), SHA-256 hashes, and features sampled from a PNG.

use std::io::{BufReader, BufWriter, Write};
use std::path::Path;

use sha2::{Digest, Sha256};

use crate::terrain::config::{Config, HEIGHT_ONE};
use crate::terrain::features::FeatureFile;
use crate::{Error, InputError};

/// The mapping of a height PNG, in height units: sample 0 is `low`, sample 65535 is `high`, and those between
/// are linear. The PNG's text chunk `relievo-heights` stores it as `low high`.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize)]
pub struct HeightRange {
    /// Height of sample 0.
    pub low: f64,
    /// Height of sample 65535.
    pub high: f64,
}

const CHUNK: &str = "relievo-heights";

impl HeightRange {
    /// The smallest range that holds all of `heights`, which are in 1/65536 units.
    pub fn of(heights: &[i32]) -> Self {
        let low = heights.iter().min().copied().unwrap_or(0);
        let high = heights.iter().max().copied().unwrap_or(0);
        Self { low: f64::from(low) / HEIGHT_ONE, high: f64::from(high) / HEIGHT_ONE }
    }

    /// The smallest range that holds both ranges.
    pub fn union(self, other: Self) -> Self {
        Self { low: self.low.min(other.low), high: self.high.max(other.high) }
    }

    fn sample(&self, height: i32) -> u16 {
        let span = self.high - self.low;
        if span <= 0.0 {
            return 0;
        }
        ((f64::from(height) / HEIGHT_ONE - self.low) / span * 65_535.0).round().clamp(0.0, 65_535.0) as u16
    }

    /// The height of a PNG sample, in height units.
    pub fn height(&self, sample: u16) -> f64 {
        self.low + (self.high - self.low) * f64::from(sample) / 65_535.0
    }
}

/// The bytes of heights, little-endian.
pub fn to_bytes(heights: &[i32]) -> Vec<u8> {
    heights.iter().flat_map(|height| height.to_le_bytes()).collect()
}

/// SHA-256 of the little-endian heights, as hexadecimal digits.
pub fn sha256(heights: &[i32]) -> String {
    Sha256::digest(to_bytes(heights)).iter().map(|byte| format!("{byte:02x}")).collect()
}

/// A copy of a field with `width` samples per row, without its outermost `samples` rings.
pub fn cropped(field: &[i32], width: usize, samples: usize) -> Vec<i32> {
    let inner = width - 2 * samples;
    let rows = field.chunks_exact(width).skip(samples).take(inner);
    rows.flat_map(|row| &row[samples..samples + inner]).copied().collect()
}

/// Writes heights, rows of `width`, as a 16-bit greyscale PNG.
///
/// # Errors
/// [`Error::Output`] when the file cannot be written.
pub fn write_png(path: &Path, heights: &[i32], width: u32, range: HeightRange) -> Result<(), Error> {
    let failed = |error: &dyn std::fmt::Display| Error::output(path, error);
    let file = std::fs::File::create(path).map_err(|error| failed(&error))?;
    let mut encoder = png::Encoder::new(BufWriter::new(file), width, heights.len() as u32 / width.max(1));
    encoder.set_color(png::ColorType::Grayscale);
    encoder.set_depth(png::BitDepth::Sixteen);
    let text = format!("{} {}", range.low, range.high);
    encoder.add_text_chunk(CHUNK.to_owned(), text).map_err(|error| failed(&error))?;
    let samples: Vec<u8> = heights.iter().flat_map(|height| range.sample(*height).to_be_bytes()).collect();
    let mut writer = encoder.write_header().map_err(|error| failed(&error))?;
    writer.write_image_data(&samples).map_err(|error| failed(&error))?;
    writer.finish().map_err(|error| failed(&error))
}

/// The samples of a 16-bit greyscale PNG, and its mapping if the file states one.
#[derive(Debug, Clone, PartialEq)]
pub struct HeightImage {
    /// Columns.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// Samples, row by row.
    pub samples: Vec<u16>,
    /// The mapping, if relievo wrote the file.
    pub range: Option<HeightRange>,
}

impl HeightImage {
    /// Reads a PNG.
    ///
    /// # Errors
    /// [`Error::File`] for a file that cannot be read or is not a 16-bit greyscale PNG.
    pub fn from_file(path: &Path) -> Result<Self, Error> {
        let file = std::fs::File::open(path).map_err(|error| Error::file(path, error))?;
        let decoder = png::Decoder::new(BufReader::new(file));
        let mut reader = decoder.read_info().map_err(|error| Error::file(path, error))?;
        let info = reader.info();
        let (color, depth) = (info.color_type, info.bit_depth);
        if color != png::ColorType::Grayscale || depth != png::BitDepth::Sixteen {
            let bound = format!("is a {depth:?}-bit {color:?} PNG; heights need 16-bit greyscale");
            return Err(Error::file(path, bound));
        }
        let (width, height) = (info.width, info.height);
        if u64::from(width) * u64::from(height) > 1 << 28 {
            return Err(Error::file(
                path,
                format!("is {width} × {height}; height images have at most 2^28 samples"),
            ));
        }
        let range = (info.uncompressed_latin1_text.iter())
            .find(|chunk| chunk.keyword == CHUNK)
            .and_then(|chunk| chunk.text.split_once(' '))
            .and_then(|(low, high)| Some(HeightRange { low: low.parse().ok()?, high: high.parse().ok()? }));
        let size = reader.output_buffer_size().ok_or_else(|| Error::file(path, "is too large to read"))?;
        let mut bytes = vec![0; size];
        reader.next_frame(&mut bytes).map_err(|error| Error::file(path, error))?;
        let samples = bytes.chunks_exact(2).map(|pair| u16::from_be_bytes([pair[0], pair[1]])).collect();
        Ok(Self { width, height, samples, range })
    }

    /// Features from every `every`-th sample: column i and row j of the image stand for sample (i, j), counted
    /// from the first sample of patch `origin`, over a grid of `patches`. Samples beyond the image or the grid
    /// are left out.
    ///
    /// # Errors
    /// [`InputError`] for an `every` of 0.
    pub fn features(
        &self,
        config: &Config,
        origin: [i32; 2],
        patches: [u32; 2],
        every: u32,
        range: HeightRange,
    ) -> Result<Vec<FeatureFile>, InputError> {
        if every == 0 {
            return Err(InputError::new("every", every, "must be at least 1"));
        }
        let edge = config.patch_size - 1;
        let mut files = Vec::new();
        for (py, px) in (0..patches[1]).flat_map(|py| (0..patches[0]).map(move |px| (py, px))) {
            let (left, top) = (u64::from(px) * u64::from(edge), u64::from(py) * u64::from(edge));
            let mut heights = Vec::new();
            for y in (0..=edge).filter(|y| (top + u64::from(*y)).is_multiple_of(every.into())) {
                for x in (0..=edge).filter(|x| (left + u64::from(*x)).is_multiple_of(every.into())) {
                    let (column, row) = (left + u64::from(x), top + u64::from(y));
                    if column < self.width.into() && row < self.height.into() {
                        let sample = self.samples[(row * u64::from(self.width) + column) as usize];
                        heights.extend([f64::from(x), f64::from(y), range.height(sample)]);
                    }
                }
            }
            let patch_coordinates = [origin[0].wrapping_add(px as i32), origin[1].wrapping_add(py as i32)];
            files.push(FeatureFile { patch_coordinates, precomputed_heights: heights });
        }
        Ok(files)
    }
}

/// Writes bytes to a new file.
///
/// # Errors
/// [`Error::Output`] when the file cannot be written.
pub fn write_bytes(path: &Path, bytes: &[u8]) -> Result<(), Error> {
    let write = || std::fs::File::create(path)?.write_all(bytes);
    write().map_err(|error: std::io::Error| Error::output(path, error))
}
