//! Writes a model as Wavefront OBJ, with its material library and images.

use std::collections::HashMap;
use std::fmt::Display;
use std::io::{self, Write};

use super::materials::encoded;
use crate::InputError;
use crate::asset::images::png;
use crate::asset::material::{Alpha, Material, Texture, Wrapping};
use crate::asset::{Mesh, Model};

/// Input for one object of the file: vertices, and triangles with vertex indices from 0.
#[doc(hidden)]
pub struct Object<'a, P, T> {
    /// Name of the object. Without a name, the triangles belong to the previous object. Whitespace becomes `_`, because a space
    /// would end the name and a line break would end the statement.
    pub name: Option<&'a str>,
    /// Name of the material, in a library that the file already names.
    pub material: Option<&'a str>,
    /// Position of each vertex.
    pub positions: P,
    /// Texture coordinates of each vertex; v points down the image.
    pub uv: &'a [[f32; 2]],
    /// One normal per vertex, or an empty list.
    pub normals: &'a [[f32; 3]],
    /// Triangles, counter-clockwise seen from outside.
    pub triangles: T,
}

/// Writes objects into one file, one after the other. Numbers are written with all digits that their type needs.
#[doc(hidden)]
pub struct ObjWriter<W> {
    out: W,
    /// Number of the next vertex in the file, counted from 1.
    next: u64,
}

impl<W: Write> ObjWriter<W> {
    /// A writer of a new file.
    pub fn new(out: W) -> Self {
        Self { out, next: 1 }
    }

    /// Writes a comment line.
    pub fn comment(&mut self, text: impl Display) -> io::Result<()> {
        writeln!(self.out, "# {text}")
    }

    /// Writes a statement that names a material library beside the file.
    pub fn library(&mut self, name: &str) -> io::Result<()> {
        writeln!(self.out, "mtllib {name}")
    }

    /// Writes an object. The number of texture coordinates must equal the number of positions.
    pub fn object<N: Display>(
        &mut self,
        object: Object<'_, impl IntoIterator<Item = [N; 3]>, impl IntoIterator<Item = [u32; 3]>>,
    ) -> io::Result<()> {
        let Object { name, material, positions, uv, normals, triangles } = object;
        let out = &mut self.out;
        if let Some(name) = name {
            writeln!(out, "o {}", word(name))?;
        }
        for [x, y, z] in positions {
            writeln!(out, "v {x} {y} {z}")?;
        }
        for [u, v] in uv {
            writeln!(out, "vt {u} {}", Upwards(*v))?;
        }
        for [x, y, z] in normals {
            writeln!(out, "vn {x} {y} {z}")?;
        }
        if let Some(material) = material {
            writeln!(out, "usemtl {material}")?;
        }
        for triangle in triangles {
            let [a, b, c] = triangle.map(|corner| self.next + u64::from(corner));
            match normals {
                [] => writeln!(out, "f {a}/{a} {b}/{b} {c}/{c}")?,
                _ => writeln!(out, "f {a}/{a}/{a} {b}/{b}/{b} {c}/{c}/{c}")?,
            }
        }
        self.next += uv.len() as u64;
        Ok(())
    }
}

/// Prints v, which points down in memory, as 1 − v, because OBJ counts v from the bottom. The digits suffice to restore v if
/// the reader subtracts the number from 1 in double precision.
struct Upwards(f32);

impl Display for Upwards {
    fn fmt(&self, out: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let short = (1.0 - self.0).to_string();
        match short.parse::<f64>().is_ok_and(|read| (1.0 - read) as f32 == self.0) {
            true => out.write_str(&short),
            false => write!(out, "{}", 1.0 - f64::from(self.0)),
        }
    }
}

fn word(name: &str) -> String {
    let word: String = name.chars().map(|c| if c.is_whitespace() { '_' } else { c }).collect();
    // A name starting with `#` would be read as a comment.
    if word.is_empty() || word.starts_with('#') { format!("_{word}") } else { word }
}

impl Model {
    /// Writes the model as Wavefront OBJ. Returns names and bytes of files: first `{name}.obj`, then, if meshes have materials,
    /// the library `{name}.mtl` and its images as PNG.
    ///
    /// Each mesh becomes an object with the mesh's name. Positions, normals and texture coordinates stay unchanged, in the
    /// mesh's own space. If the model has a skeleton, convert it with `relievo::ops::skinning::at_rest` first.
    ///
    /// Colours, opacity, textures and normal maps are written. OBJ cannot express skins, clips, morph targets, levels of
    /// detail, tangents, double-sided triangles, filters, and the threshold of [`Alpha::Mask`]; these are not written. Of joined
    /// levels, the finest is written.
    ///
    /// [`Model::from_obj`] reads the same numbers back. Positions, normals and triangles are equal to the bit. Texture
    /// coordinates are equal to the bit if v is 0 or above 2⁻²⁹, and otherwise within 2⁻⁵³.
    ///
    /// # Errors
    /// [`InputError`] for a name that is not a plain file name, for an invalid mesh or material, and for images that PNG cannot
    /// hold.
    pub fn to_obj(&self, name: &str) -> Result<Vec<(String, Vec<u8>)>, InputError> {
        if name.is_empty()
            || name.contains(|c: char| c.is_whitespace() || c.is_control() || "/\\:#".contains(c))
        {
            return Err(InputError::new(
                "name",
                name,
                "must be a file name without spaces and any of / \\ : #",
            ));
        }
        let library = Library::new(self, name)?;
        let mut text = Vec::new();
        let mut writer = ObjWriter::new(&mut text);
        // Writing to memory does not fail.
        let failed = |error: io::Error| InputError::new("OBJ", name, error.to_string());
        if !library.names.is_empty() {
            writer.library(&format!("{name}.mtl")).map_err(failed)?;
        }
        for (at, mesh) in self.meshes.iter().enumerate() {
            self.check_mesh(at)?;
            if mesh.is_of_coarse_levels() {
                continue;
            }
            writer.object(object(mesh, library.material(mesh))).map_err(failed)?;
        }
        let mut files = vec![(format!("{name}.obj"), text)];
        if !library.names.is_empty() {
            files.push((format!("{name}.mtl"), library.text.into_bytes()));
            files.extend(library.images);
        }
        Ok(files)
    }
}

fn object<'a>(
    mesh: &'a Mesh,
    material: Option<&'a str>,
) -> Object<'a, impl Iterator<Item = [f32; 3]>, impl Iterator<Item = [u32; 3]>> {
    Object {
        name: Some(&mesh.name),
        material,
        positions: mesh.positions.iter().copied(),
        uv: &mesh.uv,
        normals: &mesh.normals,
        triangles: mesh.indices.as_chunks().0.iter().copied(),
    }
}

/// A material library that is being written.
#[derive(Default)]
struct Library {
    text: String,
    /// For each material that meshes use, by its index: its name in the library.
    names: HashMap<usize, String>,
    /// A name that no material of the library has.
    none: String,
    /// File names and bytes of images.
    images: Vec<(String, Vec<u8>)>,
}

impl Library {
    fn new(model: &Model, name: &str) -> Result<Self, InputError> {
        let mut library = Self::default();
        for mesh in &model.meshes {
            let (Some(index), Some(material)) = (mesh.material, model.material(mesh)?) else { continue };
            if library.names.contains_key(&index) {
                continue;
            }
            let mut own = word(&material.name);
            if library.names.values().any(|other| *other == own) {
                own = format!("{own}_{index}");
            }
            let mut image = |texture: Option<Texture>| -> Result<Option<String>, InputError> {
                let Some(Texture { image, .. }) = texture else { return Ok(None) };
                let file = format!("{name}_{image}.png");
                if library.images.iter().all(|(known, _)| *known != file) {
                    library.images.push((file.clone(), png(model, image)?));
                }
                Ok(Some(file))
            };
            let (color, normal) = (image(material.texture)?, image(material.normal)?);
            library.text += &entry(&own, material, color, normal);
            library.names.insert(index, own);
        }
        library.none = "none".to_owned();
        while library.names.values().any(|name| *name == library.none) {
            library.none.push('_');
        }
        Ok(library)
    }

    /// Name of the material to write for a mesh. A mesh without a material gets a name that the library lacks. Otherwise, the
    /// mesh would get the material of the previous mesh.
    fn material(&self, mesh: &Mesh) -> Option<&str> {
        let named = mesh.material.and_then(|material| self.names.get(&material));
        named.or_else(|| (!self.names.is_empty()).then_some(&self.none)).map(String::as_str)
    }
}

/// Text of a material's statements. `texture` and `normal` are the file names of its images.
fn entry(name: &str, material: &Material, texture: Option<String>, normal: Option<String>) -> String {
    let [red, green, blue] = [0, 1, 2].map(|channel: usize| encoded(material.color[channel].into()));
    let mut text = format!("newmtl {name}\nKd {red} {green} {blue}\n");
    let pbr = &material.pbr;
    if pbr.emissive != [0.0; 3] {
        let [red, green, blue] = pbr.emissive.map(|channel| encoded(channel.into()));
        text += &format!("Ke {red} {green} {blue}\n");
    }
    if [pbr.metallic, pbr.roughness] != [0.0, 1.0] {
        text += &format!("Pm {}\nPr {}\n", pbr.metallic, pbr.roughness);
    }
    let is_transparent = material.alpha != Alpha::Opaque;
    if is_transparent {
        text += &format!("d {}\n", material.color[3]);
    }
    let clamp = |texture: Option<Texture>| {
        let is_clamped = texture.is_some_and(|texture| texture.sampling.wrap == [Wrapping::Clamp; 2]);
        if is_clamped { "-clamp on " } else { "" }
    };
    if let Some(file) = texture {
        let clamp = clamp(material.texture);
        text += &format!("map_Kd {clamp}{file}\n");
        if is_transparent {
            text += &format!("map_d {clamp}{file}\n");
        }
    }
    if let Some(file) = normal {
        text += &format!("norm {}-bm {} {file}\n", clamp(material.normal), material.normal_scale);
    }
    text + "\n"
}
