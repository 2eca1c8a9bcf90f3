//! Data of a crowd on the device: the clips that it plays, and the cursors, local transforms and model matrices of its instances.

use crate::animation::clip_set::{ClipEntry, ClipSet, SetTrack, Timeline};
use crate::animation::instance::Instance;
use crate::animation::layers;
use crate::animation::layers::{AnimationLayer, MAX_LAYERS};
use crate::animation::model_matrices::ModelMatrices;
use crate::asset::keyframe::KeyframeCursor;
use crate::asset::keyframe::RotationPath;
use crate::asset::transform::Transform;
use crate::gpu::{Buffer, Gpu, GpuError};
use crate::shared::animation::clip::SetTrack as PackedTrack;
use crate::{Error, InputError};

/// Local transform in the kernels' layout: translation x, y, z and scale x; the rotation; scale y, scale z and two unused words.
pub type Local = [[f32; 4]; 3];

/// Converts a transform to the kernels' layout.
pub fn packed(transform: &Transform) -> Local {
    let ([x, y, z], [sx, sy, sz]) = (transform.translation, transform.scale);
    [[x, y, z, sx], transform.rotation, [sy, sz, 0.0, 0.0]]
}

/// Converts a transform from the kernels' layout.
pub fn unpacked(local: &Local) -> Transform {
    let [[x, y, z, sx], rotation, [sy, sz, ..]] = *local;
    Transform { translation: [x, y, z], rotation, scale: [sx, sy, sz] }
}

/// A clip set on the device.
#[derive(Debug, Clone)]
pub struct ClipBuffers {
    /// One entry per clip: its timelines, duration and first row in gate tables.
    pub clips: Buffer<ClipEntry>,
    /// Three tracks per bone and clip: translation, rotation, scale.
    pub tracks: Buffer<PackedTrack>,
    /// Timelines of all clips, one clip after another.
    pub timelines: Buffer<Timeline>,
    /// Key times of all timelines, in seconds.
    pub times: Buffer<f32>,
    /// Key values of all tracks.
    pub values: Buffer<[f32; 4]>,
    /// Number of keyframe cursors per instance: the largest number of timelines in any clip.
    pub timelines_a_clip: usize,
    /// Whether any track is a cubic spline.
    pub has_splines: bool,
}

impl ClipBuffers {
    /// Uploads a clip set to the device.
    ///
    /// # Errors
    /// [`GpuError`] for errors of the device.
    pub fn new(gpu: &Gpu, set: &ClipSet) -> Result<Self, GpuError> {
        let tracks: Vec<PackedTrack> = set.tracks().iter().map(SetTrack::packed).collect();
        Ok(Self {
            clips: Buffer::constant(gpu, "clips", set.clips())?,
            tracks: Buffer::constant(gpu, "tracks", &tracks)?,
            timelines: Buffer::constant(gpu, "timelines", set.timelines())?,
            times: Buffer::constant(gpu, "times", set.times())?,
            values: Buffer::constant(gpu, "values", set.values())?,
            timelines_a_clip: set.timelines_a_clip(),
            has_splines: set.has_splines(),
        })
    }
}

/// Animated instances of one skeleton on the device. The caller may read and bind all buffers.
#[derive(Debug, Clone)]
pub struct Crowd {
    /// The clip that each instance plays, per layer, at index `layer · len + instance`. The caller may rewrite the buffer:
    /// `write_at` at `layer · len` replaces one layer. Every clip index must exist in the set.
    pub instances: Buffer<Instance>,
    /// Keyframe cursors, written by [`crate::animation::keyframe_cursor::KeyframeCursorPass`]: [`ClipSet::timelines_a_clip`]
    /// cursors per entry of `instances`.
    pub cursors: Buffer<KeyframeCursor>,
    /// Weights of the layers above the base, 0..=1. The first part holds one weight per instance and layer, at `(layer − 1) · len
    /// + instance`. The second part holds a mask per layer, with one value per bone. The caller may rewrite the weights
    /// ([`Crowd::set_weights`]).
    pub layer_weights: Buffer<f32>,
    /// Local transforms, written by [`crate::animation::sample::SamplePass`], at index `instance · bones + bone`.
    pub locals: Buffer<Local>,
    /// Model matrices, written by [`crate::animation::local_to_model::LocalToModelPass`].
    pub model_matrices: ModelMatrices,
    /// Number of bones of the skeleton.
    pub bones: usize,
    /// Number of layers, including the base: 1 if each instance plays one clip.
    pub layers: usize,
    /// Number of clips in the crowd's clip set.
    pub(crate) clips: usize,
    path: RotationPath,
}

impl Crowd {
    /// Allocates a crowd with one layer: each instance plays one clip of the set.
    ///
    /// # Errors
    /// [`InputError`] if `instances` is empty or an instance's clip is not in the set; [`GpuError`] for errors of the device.
    pub fn new(gpu: &Gpu, set: &ClipSet, instances: &[Instance]) -> Result<Self, Error> {
        Self::layered(gpu, set, instances, &[])
    }

    /// Allocates a crowd with layers above the base. `base` and the layers play clips of the set.
    ///
    /// # Errors
    /// [`GpuError`] for errors of the device; [`InputError`] in these cases:
    ///
    /// - `base` is empty;
    /// - an instance's clip is not in the set;
    /// - there are more than [`MAX_LAYERS`] layers, including the base;
    /// - a layer does not match the crowd ([`AnimationLayer::validate`]).
    pub fn layered(
        gpu: &Gpu,
        set: &ClipSet,
        base: &[Instance],
        layers: &[AnimationLayer],
    ) -> Result<Self, Error> {
        let (count, bones) = (base.len(), set.bones());
        let pairs = count.saturating_mul(bones);
        // Shaders index the three vectors of each local transform in u32.
        if base.is_empty() || pairs.saturating_mul(3) > 1 << 31 {
            let bound = format!("must be at least 1 and at most {}", (1_u64 << 31) / 3 / bones as u64);
            return Err(InputError::new("instances.len", count, bound).into());
        }
        InputError::check_below("layers.len", layers.len(), MAX_LAYERS)?;
        base.iter().try_for_each(|instance| instance.validate(set.clips().len()))?;
        for (at, layer) in layers.iter().enumerate() {
            layer.validate(&format!("layers[{at}]"), count, set.clips().len(), bones)?;
        }
        let instances = layers::all_instances(base, layers);
        Ok(Self {
            cursors: Buffer::new(gpu, "cursors", (instances.len() + count) * set.timelines_a_clip())?,
            instances: Buffer::from_slice(gpu, "instances", &instances)?,
            layer_weights: Buffer::from_slice(gpu, "layer_weights", &all_layer_weights(layers, bones))?,
            locals: Buffer::new(gpu, "locals", pairs)?,
            model_matrices: ModelMatrices::new(&Buffer::new(gpu, "model matrices", pairs)?),
            bones,
            layers: 1 + layers.len(),
            clips: set.clips().len(),
            path: RotationPath::default(),
        })
    }

    /// Sets the rotation path between keys and returns the crowd. The gate tables and the sampling pass must use the same path.
    #[must_use]
    pub fn with_path(self, path: RotationPath) -> Self {
        Self { path, ..self }
    }

    /// Rotation path between keys: slerp by default; [`Crowd::with_path`] changes it.
    pub fn path(&self) -> RotationPath {
        self.path
    }

    /// Model matrices of all bones, at index `instance · bones + bone`. [`crate::animation::local_to_model::LocalToModelPass`]
    /// writes them.
    pub fn model_matrices(&self) -> &ModelMatrices {
        &self.model_matrices
    }

    /// Replaces the weights of a layer above the base with `weights`, one per instance. Layer 1 is the first layer above the
    /// base.
    ///
    /// # Errors
    /// [`InputError`] if `layer` is 0 (the base) or does not exist, if there is not one weight per instance, and for weights
    /// outside 0..=1; [`GpuError`] for errors of the device.
    pub fn set_weights(&self, gpu: &Gpu, layer: usize, weights: &[f32]) -> Result<(), Error> {
        let bound = || format!("must be in 1..{}, a layer above the base", self.layers);
        InputError::check((1..self.layers).contains(&layer), "layer", layer, bound)?;
        InputError::check_len("weights", weights.len(), self.len(), "an instance")?;
        layers::check_weights("weights", weights)?;
        Ok(self.layer_weights.write_at(gpu, (layer - 1) * self.len(), weights)?)
    }

    /// Number of instances.
    pub fn len(&self) -> usize {
        self.instances.len() / self.layers
    }

    /// Always false: a crowd has at least one instance.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Number of (instance, bone) pairs: instances times bones per skeleton.
    pub fn pairs(&self) -> usize {
        self.len() * self.bones
    }
}

/// Contents of `Crowd::layer_weights`: the weights of all layers, then the masks of all layers.
fn all_layer_weights(layers: &[AnimationLayer], bones: usize) -> Vec<f32> {
    let mut layer_weights: Vec<f32> = layers.iter().flat_map(|layer| &layer.weights).copied().collect();
    for layer in layers {
        match &layer.mask {
            Some(mask) => layer_weights.extend(mask),
            None => layer_weights.resize(layer_weights.len() + bones, 1.0),
        }
    }
    layer_weights
}
