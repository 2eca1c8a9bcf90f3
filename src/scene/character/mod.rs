//! Characters. The device samples their bones, and morphs and skins their vertices, in as much detail as the views need.

mod drawn;
mod driven;
mod kind;
mod layers;
#[cfg(not(target_arch = "wasm32"))]
mod measured;
mod played;
mod posed;
mod provide;
mod runtime;

use crate::Error;
use crate::animation::{BoundTable, ClipSet, Gate, RootMotion, RotationPath};
use crate::asset::mesh::bone_radii;
use crate::gpu::Gpu;
use crate::scene::instances::Changed;
use crate::scene::mesh;
use crate::scene::object_kind::{Fitted, Replaced};
use crate::scene::options::{CharacterOptions, bone_of};
use crate::scene::paging::Held;
use crate::scene::playing::Playing;
use crate::shared::lod::assign::AssignParams;
use crate::skinning::bounding_sphere::{BoundingSphere, followed};
use crate::skinning::instance_lod::InstanceLod;
use crate::skinning::merged::Merged;
use crate::skinning::{Extent, poses_of};
use driven::Driven;
use layers::{CharacterLayer, Reach};
use runtime::{Runtime, Shared};

/// A character and all of its instances.
#[derive(Debug)]
pub(super) struct Character {
    merged: Merged,
    /// Length of one unit of the motion table, in model units. The gate uses this table to decide which bones to sample.
    unit: f32,
    /// Largest displacement of a vertex, in model units, per unit of the influence fade λ ([`Extent::stray`]).
    stray: f32,
    /// Radius per bone: the largest distance between the bone and a vertex that follows it, in bone space; `None` without
    /// such a vertex.
    radii: Vec<Option<f32>>,
    /// Bounding sphere per clip.
    spheres: Vec<BoundingSphere>,
    plays: Vec<Playing>,
    changed: Changed,
    /// Origin of the device's `f32` times, as a scene time in seconds.
    epoch: f64,
    /// Whether the vertex positions of the last frame are kept, for velocities.
    keeps_last: bool,
    driven: Driven,
    layers: Vec<CharacterLayer>,
    /// Bounds of bone positions in blends of clips; `None` without layers.
    reach: Option<Reach>,
    /// Root motion of each clip; `None` unless the character was added with root motion.
    motions: Option<Vec<RootMotion>>,
    shared: Shared,
    /// Device data of each chunk (group of instances), in ascending order of instances.
    runtimes: Vec<Runtime>,
    /// Resources replaced since the last frame.
    replaced: Replaced,
    /// Whether the device has run out of memory. If so, chunks are no longer divided.
    is_memory_short: bool,
    /// Per instance: the smallest recent metric (distance or allowed displacement). Used while levels fade over time.
    held: Vec<Held>,
}

impl Character {
    /// Creates a character from a merged model with clips, for `capacity` instances.
    pub fn new(
        gpu: &Gpu,
        mut merged: Merged,
        options: &CharacterOptions<'_>,
        (capacity, keeps_last): (usize, bool),
    ) -> Result<Self, Error> {
        let motions = options.root_motion.map(|root| root.take(&mut merged.model)).transpose()?;
        let model = &merged.model;
        let clips: Vec<_> = model.clips.iter().collect();
        let set = ClipSet::new(&clips)?;
        let radii = bone_radii(model.skeleton.len(), &model.skins, &model.meshes);
        let table = BoundTable::new(&model.skeleton, &set, &clips, &radii, RotationPath::default())?;
        let unit = table.unit();
        let poses = clips.iter().map(|clip| poses_of(clip)).collect::<Result<Vec<_>, _>>()?;
        let every: Vec<usize> = (0..clips.len()).collect();
        let stray = Extent::of_model(model, &every, poses.into_iter().max().unwrap_or(1))?.stray;
        let spheres = every.iter().map(|clip| BoundingSphere::in_clip(model, *clip)).collect();
        let bone = |name: &str| bone_of(model, name);
        let layers = CharacterLayer::of_masks(model, &options.layers, bone, capacity)?;
        let masks = layers.iter().map(|layer| layer.mask.clone()).collect();
        let shared = Shared::new(gpu, model, (set, Gate::Bounded(table)), masks)?;
        let follows = radii.iter().zip(followed(model));
        let radii: Vec<_> = follows.map(|(radius, follows)| follows.then_some(*radius)).collect();
        let reach = (!layers.is_empty()).then(|| Reach::new(model, &radii));
        let plays = vec![Playing::REST; capacity];
        let runtimes = Runtime::all(gpu, model, &shared, 0..capacity, keeps_last)?;
        let mut changed = Changed::default();
        changed.all(capacity);
        let (epoch, is_memory_short) = (0.0, false);
        Ok(Self {
            merged,
            unit,
            stray,
            radii,
            spheres,
            plays,
            changed,
            epoch,
            keeps_last,
            driven: Driven::default(),
            layers,
            reach,
            motions,
            shared,
            runtimes,
            replaced: Replaced::Nothing,
            is_memory_short,
            held: Vec::new(),
        })
    }

    fn start_afresh(&mut self, capacity: usize) {
        self.is_memory_short = false;
        self.plays.resize(capacity, Playing::REST);
        self.changed.all(capacity);
        self.layers.iter_mut().for_each(|layer| layer.resize(capacity));
        // A new scene starts with epoch 0. With the same epoch, start times are rounded as in a new scene.
        self.epoch = 0.0;
    }

    /// A sphere around an instance that plays the first clip, in model space.
    pub fn sphere(&self) -> BoundingSphere {
        self.spheres[0]
    }

    /// The error of each level of detail, in model units.
    pub fn errors(&self) -> Vec<f32> {
        mesh::errors(&self.merged)
    }

    /// Prepares the jobs that assign levels of detail to instances, unless they are up to date with the layout.
    fn fit_levels(&mut self, gpu: &Gpu, fitted: &Fitted<'_>) -> Result<(), Error> {
        for (runtime, chunk) in self.runtimes.iter_mut().zip(fitted.chunks) {
            let params = AssignParams {
                first: chunk.range.first,
                instances: 0,
                max_influences: InstanceLod::FULL.max_influences,
                bone_fraction: fitted.budget.bones,
                influence_fraction: fitted.budget.influences,
                unit: self.unit,
                stray: self.stray,
            };
            runtime.fit(gpu, fitted.layout, fitted.assign, params)?;
        }
        Ok(())
    }
}
