//! Characters. The device samples their bones, and morphs and skins their vertices, in as much detail as the views need.

mod detail;
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

use std::collections::BTreeSet;

use crate::animation::RootMotion;
use crate::asset::Model;
use crate::gpu::Gpu;
use crate::scene::instances::Changed;
use crate::scene::mesh;
use crate::scene::object_kind::{Fitted, Replaced};
use crate::scene::options::{CharacterOptions, InfluenceLod};
use crate::scene::paging::Held;
use crate::scene::playing::Playing;
use crate::shared::lod::assign::AssignParams;
use crate::skinning::bounding_sphere::{BoundingSphere, followed};
use crate::skinning::merged::Merged;
use crate::skinning::{motion_bounds, spheres};
use crate::{Error, InputError};
use detail::Detail;
pub use detail::SkeletonStatistics;
pub(super) use detail::TICKS;
use driven::Driven;
pub(super) use layers::Weight;
use layers::{CharacterLayer, Reach};
use runtime::{Room, Runtime, Shared};

/// A character and all of its instances.
#[derive(Debug)]
pub(super) struct Character {
    merged: Merged,
    /// Parameters that assign levels of detail, without the scene's error budget.
    assign: AssignParams,
    /// Whether influences fade within the scene's error budget.
    fades_influences: bool,
    /// Whether gate and influences keep the error that views allow.
    keeps_bound: bool,
    /// Instances whose bones are watched.
    watched: BTreeSet<u32>,
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
        capacity: usize,
        keeps_last: bool,
    ) -> Result<Self, Error> {
        let motions = options.root_motion.map(|root| root.take(&mut merged.model)).transpose()?;
        merged.model.motion = Some(motion_bounds(&merged.model)?);
        let model = &merged.model;
        let spheres = model.motion.as_ref().map(spheres).unwrap_or_default();
        let Detail { tiers, set, gate, assign } = Detail::new(options, model, spheres[0].radius)?;
        let bone = |name: &str| model.bone(name);
        let layers = CharacterLayer::of_masks(model, &options.layers, bone, capacity)?;
        let masks = layers.iter().map(|layer| layer.mask.clone()).collect();
        let radii = tiers.bone_radii[..model.skeleton.len()].to_vec();
        let shared = Shared::new(gpu, model, set, gate, tiers, masks)?;
        let follows = radii.iter().zip(followed(model));
        let radii: Vec<_> = follows.map(|(radius, follows)| follows.then_some(*radius)).collect();
        let reach = (!layers.is_empty()).then(|| Reach::new(model, &radii));
        let plays = vec![Playing::REST; capacity];
        let runtimes = Runtime::all(gpu, model, &shared, &Room { slots: 0..capacity, capacity, keeps_last })?;
        let mut changed = Changed::default();
        changed.all(capacity);
        let (epoch, is_memory_short) = (0.0, false);
        Ok(Self {
            merged,
            assign,
            fades_influences: options.influences == InfluenceLod::Bounded,
            keeps_bound: options.gate.is_bounded() && options.influences.is_bounded(),
            watched: BTreeSet::new(),
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

    /// All instances of the character, for `capacity` instances.
    fn room(&self, capacity: usize) -> Room {
        Room { slots: 0..capacity, capacity, keeps_last: self.keeps_last }
    }

    fn start_afresh(&mut self, capacity: usize) {
        self.is_memory_short = false;
        self.plays.resize(capacity, Playing::REST);
        self.changed.all(capacity);
        self.layers.iter_mut().for_each(|layer| layer.resize(capacity));
        // A new scene starts with epoch 0. With the same epoch, start times are rounded as in a new scene.
        self.epoch = 0.0;
    }

    /// Refuses a model that this character's instances cannot go on with.
    ///
    /// # Errors
    /// [`InputError`] for other bones, other clips, or another number of layers.
    pub fn check_successor(&self, model: &Model, options: &CharacterOptions<'_>) -> Result<(), InputError> {
        let own = &self.merged.model;
        let is_same = own.skeleton == model.skeleton;
        InputError::check(is_same, "model.skeleton", "other bones", || "must be that of the old model")?;
        let is_same = options.root_motion.is_some() == self.motions.is_some()
            && (self.motions.is_some() || own.clips == model.clips);
        InputError::check(is_same, "model.clips", "other clips", || "must be those of the old model")?;
        let layers = self.layers.len();
        InputError::check_same("options.layers.len", options.layers.len(), layers, "that of the old model")
    }

    /// Takes over clips, layers and driven bones of all instances from the character whose place this one takes.
    fn take_state(&mut self, last: &mut Self) {
        self.plays = std::mem::take(&mut last.plays);
        self.layers = std::mem::take(&mut last.layers);
        self.driven = std::mem::take(&mut last.driven);
        self.watched = std::mem::take(&mut last.watched);
        self.start_afresh(self.plays.len());
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
                bone_fraction: fitted.budget.bones,
                influence_fraction: if self.fades_influences { fitted.budget.influences } else { 0.0 },
                ..self.assign
            };
            runtime.fit(gpu, fitted.layout, fitted.assign, params)?;
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use crate::asset::{Model, MotionBounds};
    use crate::gpu::{Gpu, Options};
    use crate::scene::{Camera, Placement, Quality, Scene};

    /// Bounds of a hostile package may hide a character, or show it where it is not seen. They do no other harm.
    #[test]
    fn wrong_bounds_are_no_crash() {
        let gpu = Gpu::headless(&Options::default()).expect("the suite needs an adapter");
        let model = crate::samples::creature().expect("valid");
        for (sphere, stray) in [
            ([0.0; 4], 0.0),
            ([f32::MAX; 4], f32::MAX),
            ([-f32::MAX, f32::MAX, 0.0, 1e-30], 1e-30),
            ([1e20, 0.0, 0.0, 0.0], 1e20),
        ] {
            let motion = MotionBounds::new(&model, vec![sphere; model.clips.len()], stray);
            assert!(motion.fit(&model));
            let model = Model { motion: Some(motion), ..model.clone() };
            let mut scene = Scene::new(&gpu).expect("a scene");
            let object = scene.add_character(&model, 2).expect("added");
            assert_eq!(scene.objects.iter().next().expect("one").sphere.radius, sphere[3]);
            let one = scene.spawn(object, Placement::at([0.0, 0.0, -5.0])).expect("room");
            let mut view = scene.view(Quality::pixels(1.0)).expect("a view");
            let camera = Camera::looking_at(glam::Vec3::Y, glam::Vec3::NEG_Z, 0.9, [0.1, 100.0], [64, 64]);
            view.set(camera).expect("a camera");
            scene.set_statistics(true).expect("room");
            for _ in 0..3 {
                scene.advance(0.1).expect("finite");
                let mut encoder = gpu.encoder("frame");
                scene.record(&mut encoder, &mut [&mut view]).expect("recorded");
                gpu.queue().submit([encoder.finish()]);
                gpu.wait().expect("done");
            }
            assert!(view.statistics().is_some() && scene.bounds(one).is_ok());
        }
    }
}
