//! A scene file that was read: what it says, and which files it names.

use std::collections::BTreeSet;
use std::path::PathBuf;

use super::camera::CameraPath;
use super::entries::{EntryKind, ObjectEntry, Source, TerrainEntry};
use crate::asset::Light;
use crate::scene::{Quality, Transition};
use crate::terrain::config::ZoneTexture;

/// A scene as its file describes it, checked. Files that it names are not read yet.
#[derive(Debug, Clone, PartialEq)]
pub struct SceneFile {
    pub(super) terrain: Option<TerrainEntry>,
    /// Those of `meshes`, then those of `characters`.
    pub(super) objects: Vec<ObjectEntry>,
    pub(super) light: Light,
    pub(super) shadow: Option<SunOptions>,
    pub(super) camera: CameraPath,
    pub(super) quality: Quality,
    pub(super) transition: Transition,
    pub(super) background: [f32; 3],
}

/// The shadow of the sun in a scene file, as [`SunShadow`](crate::render::SunShadow) takes it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SunOptions {
    /// Texels along an edge of the map, 16 to 8192.
    pub size: u32,
    /// World units ahead of the camera up to which surfaces lie in shadow, beyond its near plane.
    pub range: f32,
}

impl Default for SunOptions {
    /// 2048 texels, 100 units.
    fn default() -> Self {
        Self { size: 2048, range: 100.0 }
    }
}

impl SceneFile {
    /// The camera.
    pub fn camera(&self) -> &CameraPath {
        &self.camera
    }

    /// How fine the scene is drawn.
    pub fn quality(&self) -> Quality {
        self.quality
    }

    /// The files that the scene names, relative to its own, in ascending order, each once. A browser can fetch them before
    /// it loads the scene. Buffers, images and material libraries beside `.gltf` and `.obj` files are
    /// not among them; `.glb` files need none.
    pub fn files(&self) -> Vec<PathBuf> {
        let mut found = BTreeSet::new();
        let mut add = |source: &Source| {
            if let Source::File(path) = source {
                found.insert(path.clone());
            }
        };
        for entry in &self.objects {
            add(&entry.source);
            if let EntryKind::Relief(relief) = &entry.kind {
                add(&relief.heights);
                relief.albedo.iter().chain(&relief.normals).for_each(&mut add);
            }
        }
        let zones = self.terrain.iter().flat_map(|terrain| &terrain.recipe.config.zones);
        found.extend(zones.filter_map(|zone| match &zone.texture {
            Some(ZoneTexture::File(path)) => Some(path.clone()),
            _ => None,
        }));
        found.into_iter().collect()
    }
}
