//! Reads the materials of OBJ models, with images, from material libraries.

use std::collections::HashMap;
use std::io::ErrorKind;
use std::path::{Path, PathBuf};

use image::RgbaImage;
use image::imageops::{FilterType, resize};

use super::library::{Entry, entries};
use super::maps::{Map, slashes};
use crate::InputError;
use crate::asset::beside::path_below;
use crate::asset::gltf::Beside;
use crate::asset::gltf::budget::Budget;
use crate::asset::gltf::materials::decode;
use crate::asset::material::{Alpha, Material, Pbr, Sampling, Texture, Wrapping};
use crate::asset::mesh::COORDINATE_LIMIT;

/// Materials of an OBJ model, from the libraries that it names. Only materials that the model uses are read, each once, with
/// their images.
pub(super) struct Materials<'a> {
    beside: Option<Beside<'a>>,
    budget: Budget,
    entries: HashMap<String, Entry>,
    known: HashMap<String, usize>,
    of_images: HashMap<[Option<PathBuf>; 2], usize>,
    pub materials: Vec<Material>,
    /// Images, the top row first.
    pub images: Vec<RgbaImage>,
    /// For each material, the map whose offset and scale apply to texture coordinates, if there is one.
    moves: Vec<Option<Map>>,
}

impl<'a> Materials<'a> {
    /// Reads libraries. Each is given by the line of its statement and the text after `mtllib`.
    ///
    /// # Errors
    /// [`InputError`] for a library that exists and cannot be read.
    pub fn new(beside: Option<Beside<'a>>, libraries: &[(usize, String)]) -> Result<Self, InputError> {
        let mut found = Self {
            beside,
            budget: Budget::default(),
            entries: HashMap::new(),
            known: HashMap::new(),
            of_images: HashMap::new(),
            materials: Vec::new(),
            images: Vec::new(),
            moves: Vec::new(),
        };
        for (line, text) in libraries {
            // The text after `mtllib` may be several names, or one name with spaces.
            if !found.library(*line, text)? && text.contains(char::is_whitespace) {
                for name in text.split_whitespace() {
                    found.library(*line, name)?;
                }
            }
        }
        Ok(found)
    }

    /// Reads one library; false if no library has this name. If a material's name repeats, the first material counts.
    fn library(&mut self, line: usize, name: &str) -> Result<bool, InputError> {
        let Some(beside) = self.beside else { return Ok(false) };
        let refused = |bound: String| {
            let shown: String = name.chars().take(60).collect();
            InputError::new(format!("line {line}"), format!("mtllib {shown}"), bound)
        };
        let Some(path) = path_below(&slashes(name)) else {
            return Err(refused("must be a file in the folder of the model or below".to_owned()));
        };
        let bytes = match beside(&path) {
            Ok(bytes) => bytes,
            Err(error) if error.kind() == ErrorKind::NotFound => return Ok(false),
            Err(error) => return Err(refused(format!("cannot be read: {error}"))),
        };
        self.budget.add_bytes(bytes.len());
        for entry in entries(&path.to_string_lossy(), &bytes)? {
            self.entries.entry(entry.name.clone()).or_insert(entry);
        }
        Ok(true)
    }

    /// Reads a material on its first use. Returns its index in `materials`; `None` if no library has a material of this name.
    ///
    /// # Errors
    /// [`InputError`] with the line, for an image that cannot be read.
    pub fn read(&mut self, name: &str) -> Result<Option<usize>, InputError> {
        if let Some(known) = self.known.get(name) {
            return Ok(Some(*known));
        }
        let Some(entry) = self.entries.get(name).cloned() else { return Ok(None) };
        let (texture, has_alpha) = self.texture(&entry)?;
        let (normal, normal_scale) = self.normal(&entry)?;
        let [red, green, blue] = entry.color.map(|channel| linear(channel) as f32);
        let alpha = if has_alpha || entry.opacity < 1.0 { Alpha::Dithered } else { Alpha::Opaque };
        let color = [red, green, blue, entry.opacity as f32];
        let name = name.to_owned();
        let pbr = Pbr {
            metallic: entry.metallic as f32,
            roughness: entry.roughness as f32,
            emissive: entry.emissive.map(|channel| linear(channel) as f32),
            ..Pbr::default()
        };
        self.materials.push(Material {
            name: name.clone(),
            color,
            texture,
            normal,
            normal_scale,
            alpha,
            pbr,
        });
        let map = entry.color_map.or(entry.opacity_map);
        self.moves.push(map.filter(|map| map.offset != [0.0; 2] || map.scale != [1.0; 2]));
        self.known.insert(name, self.materials.len() - 1);
        Ok(Some(self.materials.len() - 1))
    }

    /// Applies the offset and the scale of a material's map to texture coordinates, in place; v points down.
    ///
    /// # Errors
    /// [`InputError`] with the line of the map, for coordinates that leave the allowed range.
    pub fn move_coordinates(&self, material: usize, all: &mut [[f32; 2]]) -> Result<(), InputError> {
        let Some(map) = &self.moves[material] else { return Ok(()) };
        let ([right, up], [wide, high]) = (map.offset, map.scale);
        for uv in all {
            let [u, v] = uv.map(f64::from);
            let moved = [(u * wide + right) as f32, (1.0 - ((1.0 - v) * high + up)) as f32];
            if !moved.iter().all(|x| x.abs() <= COORDINATE_LIMIT) {
                return Err(
                    map.refused(format!("must keep texture coordinates within ±{COORDINATE_LIMIT:e}"))
                );
            }
            *uv = moved;
        }
        Ok(())
    }

    /// Combines a material's colour map and opacity map into one texture. Also returns whether there is an opacity map.
    fn texture(&mut self, entry: &Entry) -> Result<(Option<Texture>, bool), InputError> {
        let (color, opacity) = (&entry.color_map, &entry.opacity_map);
        let Some(first) = color.as_ref().or(opacity.as_ref()) else { return Ok((None, false)) };
        let key = [color, opacity].map(|map| map.as_ref().map(|map| entry.folder.join(&map.path)));
        let image = match self.of_images.get(&key) {
            Some(known) => *known,
            None => {
                let color = color.as_ref().map(|map| self.image(entry, map)).transpose()?;
                let opacity = opacity.as_ref().map(|map| self.image(entry, map)).transpose()?;
                let size = opacity.as_ref().map_or((1, 1), RgbaImage::dimensions);
                let white = || RgbaImage::from_pixel(size.0, size.1, image::Rgba([u8::MAX; 4]));
                let mut image = color.map_or_else(white, opaque);
                if let Some(opacity) = opacity {
                    set_opacity(&mut image, opacity);
                }
                self.push(key, image)
            }
        };
        Ok((Some(Texture { image, sampling: sampling(first) }), opacity.is_some()))
    }

    /// Returns the normal map and its scale. The source is `norm`, or else a bump map that has colours.
    fn normal(&mut self, entry: &Entry) -> Result<(Option<Texture>, f32), InputError> {
        let (map, is_certain) = match (&entry.normal_map, &entry.bump_map) {
            (Some(map), _) => (map, true),
            (None, Some(map)) => (map, false),
            (None, None) => return Ok((None, 1.0)),
        };
        let key = [Some(entry.folder.join(&map.path)), None];
        let is_heights = |image: &RgbaImage| {
            !is_certain && image.pixels().all(|texel| texel[0] == texel[1] && texel[1] == texel[2])
        };
        let image = match self.of_images.get(&key) {
            Some(known) if is_heights(&self.images[*known]) => return Ok((None, 1.0)),
            Some(known) => *known,
            None => {
                let image = self.image(entry, map)?;
                if is_heights(&image) {
                    return Ok((None, 1.0));
                }
                self.push(key, opaque(image))
            }
        };
        Ok((Some(Texture { image, sampling: sampling(map) }), map.bump))
    }

    fn push(&mut self, key: [Option<PathBuf>; 2], image: RgbaImage) -> usize {
        self.images.push(image);
        self.of_images.insert(key, self.images.len() - 1);
        self.images.len() - 1
    }

    fn image(&self, entry: &Entry, map: &Map) -> Result<RgbaImage, InputError> {
        let read = |path: &Path| match self.beside {
            Some(beside) => beside(path),
            None => Err(ErrorKind::NotFound.into()),
        };
        let bytes = read(&entry.folder.join(&map.path));
        let bytes = bytes.map_err(|error| map.refused(format!("the image cannot be read: {error}")))?;
        self.budget.add_bytes(bytes.len());
        decode(&self.budget, &map.at.path, &bytes)
            .map_err(|error| map.refused(format!("the image {} {}", map.name, error.bound)))
    }
}

fn sampling(map: &Map) -> Sampling {
    let wrap = if map.is_clamped { Wrapping::Clamp } else { Wrapping::Repeat };
    Sampling { wrap: [wrap; 2], ..Sampling::default() }
}

/// Makes every texel of an image opaque, because only `map_d` sets transparency.
fn opaque(mut image: RgbaImage) -> RgbaImage {
    image.pixels_mut().for_each(|texel| texel[3] = u8::MAX);
    image
}

/// Sets an image's alpha from an opacity image. The source is the alpha of the opacity image if any of its texels is
/// transparent, otherwise its brightness. The opacity image is resized to the size of `image`.
fn set_opacity(image: &mut RgbaImage, mut opacity: RgbaImage) {
    if opacity.dimensions() != image.dimensions() {
        opacity = resize(&opacity, image.width(), image.height(), FilterType::Triangle);
    }
    let has_alpha = opacity.pixels().any(|texel| texel[3] < u8::MAX);
    for (texel, opacity) in image.pixels_mut().zip(opacity.pixels()) {
        let sum: u32 = opacity.0[..3].iter().map(|channel| u32::from(*channel)).sum();
        texel[3] = if has_alpha { opacity[3] } else { (sum / 3) as u8 };
    }
}

/// Converts an sRGB channel, 0 to 1, to linear light. Double precision lets written values be read back unchanged.
pub(super) fn linear(encoded: f64) -> f64 {
    if encoded <= 0.040_45 { encoded / 12.92 } else { libm::pow((encoded + 0.055) / 1.055, 2.4) }
}

/// Converts linear light, 0 to 1, to an sRGB channel. The inverse of [`linear`].
pub(super) fn encoded(linear: f64) -> f64 {
    match linear {
        _ if linear <= 0.040_45 / 12.92 => 12.92 * linear,
        // Returns exactly 1; the formula would round.
        1.0 => 1.0,
        _ => 1.055 * libm::pow(linear, 1.0 / 2.4) - 0.055,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn colours_survive_encoding() {
        for at in 0..=100_000 {
            let value = at as f32 / 100_000.0;
            assert!(linear(encoded(value.into())) as f32 == value, "{value}");
        }
        assert_eq!((linear(1.0), encoded(1.0), linear(0.0)), (1.0, 1.0, 0.0));
        assert!((linear(0.5) - 0.214_041_140_482_232_55).abs() < 1e-15);
    }
}
