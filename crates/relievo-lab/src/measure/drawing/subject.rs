//! The model of a crowd as a scene takes it: with one clip, levels of detail, and clay where it has no material.

use image::{Rgba, RgbaImage};
use relievo::InputError;
use relievo::asset::material::{Material, Sampling, Texture};
use relievo::asset::{Mesh, Model};
use relievo::ops::skinning::clusters::Clusters;
use relievo::ops::skinning::{add_levels, poses_of};
use relievo::scene::Transition;
use relievo::scene::mesh::moving_merged;

use crate::measure::levels::LevelReport;
use crate::measure::options::{Detail, Subject};
use crate::measure::progress::{Listener, during};

/// A model that is drawn.
pub(crate) struct DrawnModel {
    pub model: Model,
    /// Number of clusters of an instance in full detail.
    pub clusters: u64,
    /// Its levels of detail, itself included.
    pub levels: Vec<LevelReport>,
    /// How they change.
    pub transition: Transition,
}

impl DrawnModel {
    /// Prepares a model for one of its clips; with levels of detail unless `detail` is full.
    pub fn new(subject: Subject<'_>, detail: Detail, listener: Listener<'_>) -> Result<Self, InputError> {
        let clip = subject.clip()?;
        if subject.model.meshes.is_empty() {
            let bound = "must be at least 1";
            return Err(InputError::new("model.meshes.len", 0, bound));
        }
        let mut model = subject.with_one_clip()?;
        clothe(&mut model);
        let poses = poses_of(clip)?;
        if detail == Detail::Full {
            model.meshes.iter_mut().for_each(|mesh| mesh.levels.clear());
        } else {
            during(listener, "simplifying", || add_levels(&mut model, &[0], poses))?;
        }
        let merged = moving_merged(&model)?;
        let clusters = |mesh: &Mesh| {
            let clusters = Clusters::new(mesh, &merged.model.skins, &merged.model.skeleton)?;
            Ok(u64::from(clusters.level(0).clusters))
        };
        let clusters = merged.model.meshes.iter().map(clusters).sum::<Result<u64, InputError>>()?;
        let morphs = matches!(detail, Detail::Geomorph { .. }) && !merged.errors.is_empty();
        let transition = if morphs { Transition::Geomorph } else { Transition::Hard };
        Ok(Self { clusters, levels: LevelReport::of(&merged), transition, model })
    }

    /// Number of triangles of an instance in full detail.
    pub fn triangles(&self) -> u64 {
        self.model.meshes.iter().map(|mesh| mesh.indices.len() as u64 / 3).sum()
    }
}

/// Gives the meshes that lack a material a checkerboard of clay in two colours.
fn clothe(model: &mut Model) {
    if model.meshes.iter().all(|mesh| mesh.material.is_some()) {
        return;
    }
    let square = |x: u32, y: u32| match (x / 16 + y / 16) % 2 {
        0 => Rgba([214, 150, 104, 255]),
        _ => Rgba([150, 82, 52, 255]),
    };
    let (clay, image) = (model.materials.len(), model.images.len());
    model.images.push(RgbaImage::from_fn(64, 64, square).into());
    let texture = Some(Texture { image, sampling: Sampling::default() });
    model.materials.push(Material { texture, ..Material::opaque("clay", [1.0; 4]) });
    for mesh in model.meshes.iter_mut().filter(|mesh| mesh.material.is_none()) {
        mesh.material = Some(clay);
    }
}
