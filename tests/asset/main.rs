//! Models as Wavefront OBJ, and models written.

mod damaged;
mod materials;
mod obj;
mod package;
mod stored;
mod written;

use std::collections::HashMap;
use std::io::Cursor;
use std::path::Path;

use image::RgbaImage;
use relievo::InputError;
use relievo::asset::Model;

/// Files beside a model.
#[derive(Default)]
struct Folder(HashMap<String, Vec<u8>>);

impl Folder {
    /// The folder with another file.
    fn with(mut self, name: &str, bytes: impl Into<Vec<u8>>) -> Self {
        self.0.insert(name.to_owned(), bytes.into());
        self
    }

    fn read(&self, text: &str) -> Result<Model, InputError> {
        self.read_bytes(text.as_bytes())
    }

    fn read_bytes(&self, text: &[u8]) -> Result<Model, InputError> {
        let beside = |name: &Path| {
            let found = self.0.get(&name.to_string_lossy().into_owned());
            found.cloned().ok_or_else(|| std::io::ErrorKind::NotFound.into())
        };
        let model = Model::from_obj_beside(text, &beside)?;
        check(&model);
        Ok(model)
    }
}

/// Checks that a model is valid throughout.
fn check(model: &Model) {
    for skin in &model.skins {
        skin.validate(&model.skeleton).expect("a valid skin");
    }
    for mesh in &model.meshes {
        mesh.validate(&model.skins).expect("a valid mesh");
        model.material(mesh).expect("a valid material");
    }
}

/// Reads OBJ that names no files.
fn read(text: &str) -> Result<Model, InputError> {
    Folder::default().read(text)
}

fn png(image: &RgbaImage) -> Vec<u8> {
    let mut bytes = Cursor::new(Vec::new());
    image.write_to(&mut bytes, image::ImageFormat::Png).expect("encoded");
    bytes.into_inner()
}

/// A sequence of words that a seed decides.
struct Words(u64);

impl Words {
    fn below(&mut self, bound: usize) -> usize {
        self.0 = self.0.wrapping_mul(0x5851_f42d_4c95_7f2d).wrapping_add(0x1405_7b7e_f767_814f);
        ((self.0 >> 33) % bound as u64) as usize
    }
}
