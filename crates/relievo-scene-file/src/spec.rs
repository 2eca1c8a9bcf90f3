//! The checked contents of a scene file, and the list of files that it names.

use std::collections::BTreeSet;
use std::path::PathBuf;

use relievo::asset::Light;
use relievo::ops::terrain::config::ZoneTexture;
use relievo::scene::{Quality, Transition};

use super::camera::CameraPath;
use super::entries::{EntryKind, HoleEntry, ObjectEntry, Source, TerrainEntry};

/// A checked scene file. The files that it names are not read yet.
#[derive(Debug, Clone, PartialEq)]
pub struct SceneFile {
    pub(super) terrain: Option<TerrainEntry>,
    /// The entries of `meshes`, then the entries of `characters`.
    pub(super) objects: Vec<ObjectEntry>,
    pub(super) light: Light,
    pub(super) shadow: Option<SunOptions>,
    pub(super) camera: CameraPath,
    pub(super) quality: Quality,
    pub(super) transition: Transition,
    pub(super) background: [f32; 3],
}

/// Options of the sun's shadow in a scene file, for [`SunShadow`](relievo::render::SunShadow).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SunOptions {
    /// Texels along an edge of the map, 16 to 8192.
    pub size: u32,
    /// Distance ahead of the camera, in world units, up to which surfaces receive shadow. It must exceed the near plane's
    /// distance.
    pub range: f32,
}

impl Default for SunOptions {
    /// A map of 2048 × 2048 texels, and a range of 100 world units.
    fn default() -> Self {
        Self { size: 2048, range: 100.0 }
    }
}

impl SceneFile {
    /// The camera and its path over time.
    pub fn camera(&self) -> &CameraPath {
        &self.camera
    }

    /// The quality: how finely the scene is drawn.
    pub fn quality(&self) -> Quality {
        self.quality
    }

    /// Paths of the files that the scene names, relative to the scene file, ascending, without duplicates.
    ///
    /// A browser can fetch these files before it loads the scene. The list lacks the buffers, images and material libraries that
    /// `.gltf` and `.obj` files name. `.glb` files name none.
    pub fn files(&self) -> Vec<PathBuf> {
        let mut found = BTreeSet::new();
        let mut add = |source: &Source| {
            if let Source::File(path) = source {
                found.insert(path.clone());
            }
        };
        for entry in &self.objects {
            entry.source.names().iter().for_each(&mut add);
            if let EntryKind::Relief(relief) = &entry.kind {
                add(&relief.heights);
                relief.albedo.iter().chain(&relief.normals).for_each(&mut add);
            }
        }
        found.extend(self.terrain.iter().flat_map(|terrain| terrain.features.clone()));
        let elevation = self.terrain.iter().filter_map(|terrain| terrain.elevation.as_ref());
        found.extend(elevation.map(|elevation| elevation.file.clone()));
        let holes = self.terrain.iter().filter_map(|terrain| terrain.holes.as_ref()).flatten();
        found.extend(holes.filter_map(|hole| match hole {
            HoleEntry::Image { file, .. } => Some(file.clone()),
            HoleEntry::Circle(_) => None,
        }));
        let zones = self.terrain.iter().flat_map(|terrain| &terrain.recipe.config.zones);
        found.extend(zones.filter_map(|zone| match &zone.texture {
            Some(ZoneTexture::File(path)) => Some(path.clone()),
            _ => None,
        }));
        found.into_iter().collect()
    }
}
