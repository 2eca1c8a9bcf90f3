//! Stores heights in files: as raw `i32` and as 16-bit PNG (written and read); samples features from a PNG; and writes all
//! files of a batch of patches.

use std::io::{BufReader, BufWriter};
use std::path::{Path, PathBuf};

use relievo::ops::terrain::config::{HEIGHT_ONE, TerrainConfig};
use relievo::ops::terrain::export::sha256;
use relievo::ops::terrain::features::FeatureFile;
use relievo::ops::terrain::mesh::HeightField;
use relievo::{Error, InputError};

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
    fn height(&self, sample: u16) -> f64 {
        self.low + (self.high - self.low) * f64::from(sample) / 65_535.0
    }
}

/// Writes heights, rows of `width`, as a 16-bit greyscale PNG.
///
/// # Errors
/// [`Error::Output`] when the file cannot be written.
fn write_png(path: &Path, heights: &[i32], width: u32, range: HeightRange) -> Result<(), Error> {
    let samples: Vec<u8> = heights.iter().flat_map(|height| range.sample(*height).to_be_bytes()).collect();
    let write = || -> Result<(), png::EncodingError> {
        let file = BufWriter::new(std::fs::File::create(path)?);
        let mut encoder = png::Encoder::new(file, width, heights.len() as u32 / width.max(1));
        encoder.set_color(png::ColorType::Grayscale);
        encoder.set_depth(png::BitDepth::Sixteen);
        encoder.add_text_chunk(CHUNK.to_owned(), format!("{} {}", range.low, range.high))?;
        let mut writer = encoder.write_header()?;
        writer.write_image_data(&samples)?;
        writer.finish()
    };
    write().map_err(|error| Error::output(path, error))
}

/// The heights of several patches, to be written as files.
#[derive(Debug, Clone, Copy)]
pub struct Batch<'a> {
    /// The configuration that the heights were computed from.
    pub config: &'a TerrainConfig,
    /// Coordinates of the patches: column and row.
    pub patches: &'a [[i32; 2]],
    /// The heights of each patch, patchSize² of them in 1/65536 height units.
    pub heights: &'a [Vec<i32>],
    /// The heights that black and white stand for in all PNGs.
    pub range: HeightRange,
    /// Whether each patch is also written as a mesh.
    pub obj: bool,
}

/// The report of a patch that was written.
#[derive(Debug, Clone, PartialEq, Eq, serde::Serialize)]
pub struct PatchReport {
    /// The patch's column.
    pub px: i32,
    /// The patch's row.
    pub py: i32,
    /// Number of samples along an edge.
    pub size: u32,
    /// SHA-256 of the little-endian heights, as hexadecimal digits.
    pub sha256: String,
}

impl Batch<'_> {
    /// Writes `heights_<px>_<py>.png` ([`write_png`]) and `heights_<px>_<py>.i32` (little-endian) for each
    /// patch, and, if meshes are asked for, `patch_<px>_<py>.obj` at the patch's place in the world. `place`
    /// returns the path for a file name; `progress` is called for each patch.
    ///
    /// # Errors
    /// [`Error::Output`] if a file cannot be written.
    pub fn write(
        &self,
        mut place: impl FnMut(String) -> PathBuf,
        progress: impl Fn(),
    ) -> Result<Vec<PatchReport>, Error> {
        let size = self.config.patch_size;
        let mut reports = Vec::new();
        for ([px, py], heights) in self.patches.iter().zip(self.heights) {
            write_png(&place(format!("heights_{px}_{py}.png")), heights, size, self.range)?;
            let bytes: Vec<u8> = heights.iter().flat_map(|height| height.to_le_bytes()).collect();
            write_bytes(&place(format!("heights_{px}_{py}.i32")), &bytes)?;
            if self.obj {
                self.write_obj(&place(format!("patch_{px}_{py}.obj")), heights, [*px, *py])?;
            }
            reports.push(PatchReport { px: *px, py: *py, size, sha256: sha256(heights) });
            progress();
        }
        Ok(reports)
    }

    fn write_obj(&self, path: &Path, heights: &[i32], patch: [i32; 2]) -> Result<(), Error> {
        let size = self.config.patch_size;
        let first = patch.map(|index| i64::from(index) * (i64::from(size) - 1));
        let field = HeightField::new(heights.to_vec(), size as usize, self.config.terrain_scale);
        let mut text = Vec::new();
        if let Some(field) = field {
            field.write_obj(&mut text, first).map_err(|error| Error::output(path, error))?;
        }
        write_bytes(path, &text)
    }

    /// Whether a file's name is one that [`Batch::write`] gives to some patch.
    pub fn is_name(name: &str) -> bool {
        let Some((stem, extension)) = name.rsplit_once('.') else { return false };
        let coordinates = match extension {
            "png" | "i32" => stem.strip_prefix("heights_"),
            "obj" => stem.strip_prefix("patch_"),
            _ => None,
        };
        let canonical = |text: &str| text.parse::<i32>().is_ok_and(|number| number.to_string() == text);
        coordinates
            .and_then(|text| text.split_once('_'))
            .is_some_and(|(px, py)| canonical(px) && canonical(py))
    }
}

/// The samples of a 16-bit greyscale PNG, and its mapping if the file states one.
#[derive(Debug, Clone, PartialEq)]
pub struct HeightImage {
    /// Number of columns.
    pub width: u32,
    /// Number of rows.
    pub height: u32,
    /// Samples, row by row.
    pub samples: Vec<u16>,
    /// The mapping to heights, if relievo wrote the file.
    pub range: Option<HeightRange>,
}

impl HeightImage {
    /// Reads a 16-bit greyscale PNG.
    ///
    /// # Errors
    /// [`Error::File`] for a file that cannot be read or is not a 16-bit greyscale PNG.
    pub fn from_file(path: &Path) -> Result<Self, Error> {
        let refused = |error: &dyn std::fmt::Display| Error::file(path, error);
        let file = std::fs::File::open(path).map_err(|error| refused(&error))?;
        let mut reader =
            png::Decoder::new(BufReader::new(file)).read_info().map_err(|error| refused(&error))?;
        let info = reader.info();
        let (color, depth) = (info.color_type, info.bit_depth);
        if color != png::ColorType::Grayscale || depth != png::BitDepth::Sixteen {
            return Err(refused(&format!("is a {depth:?}-bit {color:?} PNG; heights need 16-bit greyscale")));
        }
        let (width, height) = (info.width, info.height);
        if u64::from(width) * u64::from(height) > 1 << 28 {
            let bound = format!("is {width} × {height}; height images have at most 2^28 samples");
            return Err(refused(&bound));
        }
        let range = (info.uncompressed_latin1_text.iter())
            .find(|chunk| chunk.keyword == CHUNK)
            .and_then(|chunk| chunk.text.split_once(' '))
            .and_then(|(low, high)| Some(HeightRange { low: low.parse().ok()?, high: high.parse().ok()? }));
        let size = reader.output_buffer_size().ok_or_else(|| refused(&"is too large to read"))?;
        let mut bytes = vec![0; size];
        reader.next_frame(&mut bytes).map_err(|error| refused(&error))?;
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
        config: &TerrainConfig,
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

fn write_bytes(path: &Path, bytes: &[u8]) -> Result<(), Error> {
    std::fs::write(path, bytes).map_err(|error| Error::output(path, error))
}
