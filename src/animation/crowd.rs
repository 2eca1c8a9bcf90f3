//! A crowd's data on the device: the clips that it plays and, per instance, cursors, local transforms and model matrices.

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

/// A local transform in the kernels' layout: translation and scale x; rotation; scale y, scale z and two unused words.
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

/// A set of clips on the device.
#[derive(Debug, Clone)]
pub struct ClipBuffers {
    /// One entry per clip.
    pub clips: Buffer<ClipEntry>,
    /// Three tracks per bone and clip.
    pub tracks: Buffer<PackedTrack>,
    /// Timelines, clip by clip.
    pub timelines: Buffer<Timeline>,
    /// Key times in seconds.
    pub times: Buffer<f32>,
    /// Values of all tracks.
    pub values: Buffer<[f32; 4]>,
    /// Number of cursors per instance.
    pub timelines_a_clip: usize,
    /// Whether any track is a cubic spline.
    pub has_splines: bool,
}

impl ClipBuffers {
    /// Uploads a set.
    ///
    /// # Errors
    /// [`GpuError`].
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

/// Instances of one skeleton on the device. The caller may read and bind all buffers.
#[derive(Debug, Clone)]
pub struct Crowd {
    /// Clip that each instance plays, per layer, at `layer · len + instance`. The caller may rewrite it; `write_at` from
    /// `layer · len` on replaces one layer. Clips must exist in the set.
    pub instances: Buffer<Instance>,
    /// Cursors that [`crate::animation::keyframe_cursor::KeyframeCursorPass`] writes: [`ClipSet::timelines_a_clip`] for each
    /// entry of `instances`.
    pub cursors: Buffer<KeyframeCursor>,
    /// Weights of the layers above the base, 0..=1. First, for each layer, one weight per instance at
    /// `(layer − 1) · len + instance`; then, for each layer, a mask with one value per bone. Weights may be rewritten
    /// ([`Crowd::set_weights`]).
    pub layer_weights: Buffer<f32>,
    /// Local transforms that [`crate::animation::sample::SamplePass`] writes, at `instance · bones + bone`.
    pub locals: Buffer<Local>,
    /// Model matrices that [`crate::animation::local_to_model::LocalToModelPass`] writes.
    pub model_matrices: ModelMatrices,
    /// Number of bones of the skeleton.
    pub bones: usize,
    /// Number of layers, including the base: 1 if each instance plays one clip.
    pub layers: usize,
    /// Number of clips of the set.
    pub(crate) clips: usize,
    path: RotationPath,
}

impl Crowd {
    /// Allocates a crowd with one layer, for instances of a set's clips.
    ///
    /// # Errors
    /// [`InputError`] for no instances, and for instances of a clip that the set does not have; [`GpuError`].
    pub fn new(gpu: &Gpu, set: &ClipSet, instances: &[Instance]) -> Result<Self, Error> {
        Self::layered(gpu, set, instances, &[])
    }

    /// Allocates a crowd with layers above the base, for instances of a set's clips.
    ///
    /// # Errors
    /// [`InputError`] for no instances, for instances of a clip that the set does not have, for more than [`MAX_LAYERS`]
    /// layers, and for layers that do not match ([`AnimationLayer::validate`]); [`GpuError`].
    pub fn layered(
        gpu: &Gpu,
        set: &ClipSet,
        base: &[Instance],
        layers: &[AnimationLayer],
    ) -> Result<Self, Error> {
        let (count, bones) = (base.len(), set.bones());
        let pairs = count.saturating_mul(bones);
        // Shaders count vectors in u32.
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

    /// Returns the crowd with another rotation path between keys. The gate tables and the sampling pass must use the same path.
    #[must_use]
    pub fn with_path(self, path: RotationPath) -> Self {
        Self { path, ..self }
    }

    /// Rotation path between keys: slerp unless [`Crowd::with_path`] chose another.
    pub fn path(&self) -> RotationPath {
        self.path
    }

    /// Model matrices of all bones, at `instance · bones + bone`, written by
    /// [`crate::animation::local_to_model::LocalToModelPass`].
    pub fn model_matrices(&self) -> &ModelMatrices {
        &self.model_matrices
    }

    /// Replaces the weights of a layer, one per instance; layers above the base are numbered from 1.
    ///
    /// # Errors
    /// [`InputError`] for the base or a layer that the crowd does not have, for a number of weights that is not
    /// one per instance, and for weights outside 0..=1; [`GpuError`].
    pub fn set_weights(&self, gpu: &Gpu, layer: usize, weights: &[f32]) -> Result<(), Error> {
        if !(1..self.layers).contains(&layer) {
            let bound = format!("must be in 1..{}, a layer above the base", self.layers);
            return Err(InputError::new("layer", layer, bound).into());
        }
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

    /// Number of bones over all instances.
    pub fn pairs(&self) -> usize {
        self.len() * self.bones
    }
}

/// All weights, then all masks.
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
