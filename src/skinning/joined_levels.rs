//! Levels of detail made by hand: several models become the levels of one model (thesis A sections 2 and 9.3). The error of
//! each level is measured.

mod errors;
mod looks;
mod rig;
mod tree;

use super::at_rest::at_rest;
use super::levels::ERROR_MARGIN;
use super::merged::morphs;
use super::pose::{Moment, moments_in, poses_of};
use crate::InputError;
use crate::asset::mesh::{Mesh, MeshLevel};
use crate::asset::{Clip, Model, Skin};
use crate::shared::lod::object::OBJECT_LEVELS;
use errors::{Level, errors};
use looks::Looks;
use rig::bones;

/// Joins models as the levels of detail of one model: `models[0]` is level 0, the finest, and `models[1]` is level 1. An
/// artist or another program made the models.
///
/// The meshes of all models stay separate meshes. A mesh of `models[l]` has triangles at level `l` alone. A mesh that is
/// the same in several models is kept once and has its triangles at each of their levels. Equal materials, images and skins
/// are kept once as well. Each mesh keeps its own material. The meshes have no partners, so the levels cannot geomorph.
/// All other transitions work.
///
/// If `models[0]` has clips, the result has its skeleton and its clips. The bones of the other models are matched by name,
/// unless both skeletons have the same names and parents in the same order. Each mesh keeps its inverse bind matrices. If
/// `models[0]` has no clips, the result is static: every model is baked at rest ([`at_rest`](super::at_rest())).
///
/// # Errors of levels
///
/// The error of a level is the largest distance between its surface and that of level 0, in both directions, in the
/// model's units. It is measured in 60 poses a second of every clip, or at rest for a static model. Samples are vertices,
/// midpoints of triangles, and a lattice in each triangle with 2 to 16 steps along its edges. Along an edge of the mean
/// length of level 0, level 0 has 4 steps, and the other levels have 2. 3 % are added for poses and points in between.
///
/// Errors increase: a level whose error is not above that of the finer level gets the next larger number. It is then always
/// chosen in place of the finer level, unless levels are chosen by distance or size.
///
/// # Costs
///
/// Skinning a level also skins the vertices of all coarser levels, which are usually few. Picking and bounding spheres
/// count the vertices of all levels. [`add_levels`](super::add_levels) refuses the result.
///
/// ```
/// use relievo::ops::skinning::join_levels;
///
/// let near = relievo_samples::creature()?;
/// let mut far = near.clone(); // or `Model::from_file(Path::new("far.glb"))?`
/// far.meshes[0].indices.truncate(3 * 2000);
/// let joined = join_levels(&[near, far])?;
/// assert_eq!(joined.meshes.len(), 2);
/// assert!(joined.meshes[0].triangles(1).is_empty() && joined.meshes[1].triangles(0).is_empty());
/// assert!(joined.meshes[0].levels[0].error > 0.1);
/// # Ok::<(), relievo::InputError>(())
/// ```
///
/// # Errors
/// [`InputError`] in these cases:
///
/// - there are fewer than 2 or more than 8 models, a model is invalid, has no triangle, or has levels itself;
/// - `models[0]` has no clips, and another model has; or `models[0]` is skinned, and another model is not;
/// - a bone that a mesh follows has no bone of its name in `models[0]`, or more than one (`models[1].skins[0].bones[7]`);
/// - a mesh of another model has morph targets, and no mesh of `models[0]` has the same weights in every clip;
/// - a clip takes more than an hour.
pub fn join_levels(models: &[Model]) -> Result<Model, InputError> {
    InputError::check_within("models.len", models.len(), 2..=MOST)?;
    let clips: Vec<usize> = (0..models[0].clips.len()).collect();
    join_levels_in(models, &Examined { clips: &clips, poses: poses_of, is_at_rest: false })
}

/// Largest number of levels, and of models.
const MOST: usize = OBJECT_LEVELS as usize;

/// The poses in which joined levels are measured.
#[derive(Debug, Clone, Copy)]
pub struct Examined<'a> {
    /// Indices of the clips.
    pub clips: &'a [usize],
    /// Number of poses of a clip, evenly spaced from start to end.
    pub poses: fn(&Clip) -> Result<usize, InputError>,
    /// Whether the rest pose counts as well. It always counts without clips.
    pub is_at_rest: bool,
}

/// As [`join_levels`], but measured in other poses.
///
/// # Errors
/// The same errors as [`join_levels`].
pub fn join_levels_in(models: &[Model], examined: &Examined<'_>) -> Result<Model, InputError> {
    InputError::check_within("models.len", models.len(), 2..=MOST)?;
    for (at, model) in models.iter().enumerate() {
        check(model).map_err(|error| error.below(&format!("models[{at}]")))?;
    }
    let is_static = models[0].clips.is_empty();
    let mut joined = match is_static {
        true => joined_static(models)?,
        false => joined_moving(models)?,
    };
    let moments = moments(&joined.model, examined)?;
    let levels: Vec<Level> = (0..models.len()).map(|level| joined.level(level)).collect();
    let found = errors(&joined.model, &levels, &moments);
    joined.set_levels(&increasing(&found));
    Ok(joined.model)
}

/// The moments at which levels are measured, at least one.
fn moments(model: &Model, examined: &Examined<'_>) -> Result<Vec<Moment>, InputError> {
    let mut moments = Vec::new();
    for clip in examined.clips {
        moments.extend(moments_in(*clip, (examined.poses)(&model.clips[*clip])?));
    }
    if moments.is_empty() || examined.is_at_rest {
        moments.push(Moment::Rest);
    }
    Ok(moments)
}

/// The errors of levels 1, 2 … in the model's units, each above the error before. `distances` are the measured ones.
fn increasing(distances: &[f64]) -> Vec<f32> {
    let mut last = 0.0_f32;
    let error = |distance: &f64| {
        // The smallest normal number, because devices may round smaller ones to 0.
        let least = last.next_up().max(f32::MIN_POSITIVE);
        last = (ERROR_MARGIN * (*distance as f32).next_up()).max(least);
        last
    };
    distances.iter().map(error).collect()
}

/// Checks one model: valid meshes and materials, at least one triangle, and no levels.
fn check(model: &Model) -> Result<(), InputError> {
    for (at, mesh) in model.meshes.iter().enumerate() {
        model.check_mesh(at)?;
        model.check_material(at)?;
        if !mesh.levels.is_empty() {
            let bound = "must be 0: each model becomes one level";
            return Err(InputError::new(format!("meshes[{at}].levels.len"), mesh.levels.len(), bound));
        }
    }
    match model.meshes.iter().any(|mesh| !mesh.indices.is_empty()) {
        true => Ok(()),
        false => Err(InputError::new("meshes", "none", "must have a triangle")),
    }
}

/// A model under construction, and the levels at which each of its meshes has triangles.
struct Joined {
    model: Model,
    shown: Vec<Vec<usize>>,
}

impl Joined {
    /// Starts with the skeleton and the clips of `near`.
    fn new(near: &Model) -> Self {
        let model = Model {
            skeleton: near.skeleton.clone(),
            skins: Vec::new(),
            clips: near.clips.clone(),
            motion: None,
            meshes: Vec::new(),
            skinned: 0,
            materials: Vec::new(),
            images: Vec::new(),
        };
        Self { model, shown: Vec::new() }
    }

    /// Adds the meshes of a model as a level, without meshes that have no triangles. `bones` has, for each bone of the
    /// model's skins, the bone of the joined skeleton: one list per skin.
    fn add(&mut self, level: usize, model: &Model, bones: &[Vec<u32>]) {
        let materials = Looks::new(&mut self.model).add(model);
        let mut skins: Vec<Option<usize>> = vec![None; model.skins.len()];
        for (at, mesh) in model.meshes.iter().enumerate().filter(|(_, mesh)| !mesh.indices.is_empty()) {
            let skin = *skins[mesh.skin].get_or_insert_with(|| {
                let skin = Skin { bones: bones[mesh.skin].clone(), ..model.skins[mesh.skin].clone() };
                index_of(&mut self.model.skins, skin, |a, b| {
                    (&a.bones, &a.inverse_binds) == (&b.bones, &b.inverse_binds)
                })
            });
            let material = mesh.material.map(|material| materials[material]);
            let mesh = Mesh { skin, material, partners: Vec::new(), ..mesh.clone() };
            if let Some(same) = self.model.meshes.iter().position(|other| is_same(other, &mesh)) {
                self.shown[same].push(level);
                continue;
            }
            // Skinned meshes come first.
            let is_skinned = at < model.skinned;
            let place = if is_skinned { self.model.skinned } else { self.model.meshes.len() };
            self.model.skinned += usize::from(is_skinned);
            self.model.meshes.insert(place, mesh);
            self.shown.insert(place, vec![level]);
        }
    }

    /// The triangles of a level: the index of each mesh, and the mesh's triangles.
    fn level(&self, level: usize) -> Level {
        let own = |at: &usize| self.shown[*at].contains(&level);
        (0..self.shown.len()).filter(own).collect()
    }

    /// Sets the levels of all meshes. Each mesh still has its triangles as level 0.
    fn set_levels(&mut self, errors: &[f32]) {
        for (mesh, shown) in self.model.meshes.iter_mut().zip(&self.shown) {
            let own = std::mem::take(&mut mesh.indices);
            let at = |level: usize| if shown.contains(&level) { own.clone() } else { Vec::new() };
            let level = |(level, error): (usize, &f32)| MeshLevel { indices: at(level), error: *error };
            mesh.levels = (1..).zip(errors).map(level).collect();
            mesh.indices = at(0);
        }
    }
}

/// Whether two meshes differ at most in their names.
fn is_same(mesh: &Mesh, other: &Mesh) -> bool {
    let len = |mesh: &Mesh| (mesh.vertices(), mesh.indices.len(), mesh.skin, mesh.material);
    len(mesh) == len(other) && *mesh == Mesh { name: mesh.name.clone(), ..other.clone() }
}

/// The index of an equal element of a list. If there is none, the element is appended.
fn index_of<T>(list: &mut Vec<T>, element: T, is_equal: impl Fn(&T, &T) -> bool) -> usize {
    list.iter().position(|other| is_equal(other, &element)).unwrap_or_else(|| {
        list.push(element);
        list.len() - 1
    })
}

/// Joins models without clips, each at rest.
fn joined_static(models: &[Model]) -> Result<Joined, InputError> {
    let mut joined = None;
    for (at, model) in models.iter().enumerate() {
        if !model.clips.is_empty() {
            let bound = "must be 0: models[0] has no clips, and no level of a static model moves";
            return Err(InputError::new(format!("models[{at}].clips.len"), model.clips.len(), bound));
        }
        let rest = at_rest(model).map_err(|error| error.below(&format!("models[{at}]")))?;
        joined.get_or_insert_with(|| Joined::new(&rest)).add(at, &rest, &[vec![0]]);
    }
    joined.ok_or_else(|| InputError::new("models.len", 0, "must be at least 2"))
}

/// Joins models that move with the clips of the first.
fn joined_moving(models: &[Model]) -> Result<Joined, InputError> {
    let near = &models[0];
    let mut joined = Joined::new(near);
    for (at, model) in models.iter().enumerate() {
        let path = format!("models[{at}]");
        if model.skinned == 0 && near.skinned > 0 {
            let bound = "must be at least 1: models[0] is skinned, and each of its levels follows its bones";
            return Err(InputError::new(format!("{path}.skinned"), 0, bound));
        }
        let own = match at {
            0 => model.skins.iter().map(|skin| skin.bones.clone()).collect(),
            _ => {
                check_targets(near, model).map_err(|error| error.below(&path))?;
                bones(near, model, &path)?
            }
        };
        joined.add(at, model, &own);
    }
    Ok(joined)
}

/// Refuses morph targets that do not have the weights of a mesh of `near` in every clip.
fn check_targets(near: &Model, model: &Model) -> Result<(), InputError> {
    let follows = |mesh: &Mesh| {
        let is_alike =
            |other: &Mesh| (&other.weights, &other.weight_keys) == (&mesh.weights, &mesh.weight_keys);
        !morphs(mesh) || near.meshes.iter().any(is_alike)
    };
    match model.meshes.iter().position(|mesh| !follows(mesh)) {
        None => Ok(()),
        Some(at) => {
            let bound = "must be 0, or a mesh of models[0] must have the same weights in every clip";
            Err(InputError::new(format!("meshes[{at}].targets.len"), model.meshes[at].targets.len(), bound))
        }
    }
}
