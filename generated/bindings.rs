/// Of `animation/`.
pub mod animation {
/// Of `animation/bounds.wgsl`.
pub mod bounds {
use crate::gpu::bind::prelude::*;

/// The kernel `animation/bounds`, compiled.
///
/// # Errors
/// What the driver's compiler reports.
pub fn kernel(gpu: &Gpu) -> Result<Kernel, GpuError> {
    Kernel::new(gpu, &shaders::ANIMATION_BOUNDS, &[])
}

/// Resources of bind group 0 of `animation/bounds`.
#[derive(Debug, Clone, Copy)]
pub struct Group<'a> {
    /// Parameters of the kernel.
    pub params: &'a Uniform<crate::shared::animation::bounds::BoundsParams>,
    /// Model matrices: three rows per bone of each instance.
    pub model_matrices: Slice<'a, [f32; 4]>,
    /// Radius of each bone in the bone's own space.
    pub bone_radii: Slice<'a, f32>,
    /// Out: lower and upper corner of each instance's box.
    pub bounds: Slice<'a, [f32; 4]>,
}

impl Group<'_> {
    /// Binds them.
    ///
    /// # Errors
    /// [`GpuError::Validation`] where the device refuses one.
    pub fn bind(&self, gpu: &Gpu, kernel: &Kernel) -> Result<BindGroup, GpuError> {
        kernel.layouts.bind_group(gpu, &shaders::ANIMATION_BOUNDS, 0, &[
            (0, self.params.raw().as_entire_binding()),
            (1, self.model_matrices.resource()),
            (2, self.bone_radii.resource()),
            (3, self.bounds.resource()),
        ])
    }
}

}
/// Of `animation/budget.wgsl`.
pub mod budget {
use crate::gpu::bind::prelude::*;

/// Override constants of `animation/budget`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Constants {
    /// Stage of the kernel: one of the constants below.
    pub stage: u32,
}

impl Default for Constants {
    fn default() -> Self {
        Self {
            stage: 0,
        }
    }
}

impl Constants {
    /// Name and value of each.
    pub fn list(&self) -> Vec<(&'static str, f64)> {
        vec![
            ("STAGE", self.stage.into()),
        ]
    }
}

/// The kernel `animation/budget`, compiled.
///
/// # Errors
/// What the driver's compiler reports.
pub fn kernel(gpu: &Gpu, constants: &Constants) -> Result<Kernel, GpuError> {
    Kernel::new(gpu, &shaders::ANIMATION_BUDGET, &constants.list())
}

/// Resources of bind group 0 of `animation/budget`.
#[derive(Debug, Clone, Copy)]
pub struct Group<'a> {
    /// Parameters of the kernel.
    pub params: &'a Uniform<crate::shared::animation::budget::BudgetParams>,
    /// Level of detail of each instance.
    pub lods: Slice<'a, crate::shared::animation::gate_state::Lod>,
    /// Clip clock of each instance.
    pub clip_clocks: Slice<'a, crate::shared::animation::gate_state::ClipClock>,
    /// Per skeleton tier and clip: the index of the clip's last row in `table`, then one bit per bone of the tier that the clip moves.
    /// After all tiers, two bit sets per tier: all of its bones, and the bones that no gate skips.
    pub animated_bones: Slice<'a, u32>,
    /// Per row and bone: the accumulated motion (x) and its increase up to the next row (y). In a clip's last row, x is the motion
    /// over the whole clip.
    pub table: Slice<'a, [u32; 2]>,
    /// Accumulated motion of each bone of each instance when the bone was last sampled.
    pub sampled: Slice<'a, u32>,
    /// Out: the bones that are sampled, one bit per bone. A second section in the same layout is for bones that are sampled ahead.
    /// All its bits become 0.
    pub bits: Slice<'a, u32>,
    /// Ranks of bones: for each word of `bits`, 16 words with two ranks each. Then one bit per bone, set for bones of the lowest
    /// rank that is served.
    pub ranks: Slice<'a, u32>,
    /// Number of bones of each rank; then the values at the indices FORCED, LOWEST and ROOM. From TIES on: per instance, the number
    /// of bones of the lowest served rank.
    pub tally: Slice<'a, u32>,
}

impl Group<'_> {
    /// Binds them.
    ///
    /// # Errors
    /// [`GpuError::Validation`] where the device refuses one.
    pub fn bind(&self, gpu: &Gpu, kernel: &Kernel) -> Result<BindGroup, GpuError> {
        kernel.layouts.bind_group(gpu, &shaders::ANIMATION_BUDGET, 0, &[
            (0, self.params.raw().as_entire_binding()),
            (1, self.lods.resource()),
            (2, self.clip_clocks.resource()),
            (3, self.animated_bones.resource()),
            (4, self.table.resource()),
            (5, self.sampled.resource()),
            (6, self.bits.resource()),
            (7, self.ranks.resource()),
            (8, self.tally.resource()),
        ])
    }
}

}
/// Of `animation/clip_clock.wgsl`.
pub mod clip_clock {
use crate::gpu::bind::prelude::*;

/// The kernel `animation/clip_clock`, compiled.
///
/// # Errors
/// What the driver's compiler reports.
pub fn kernel(gpu: &Gpu) -> Result<Kernel, GpuError> {
    Kernel::new(gpu, &shaders::ANIMATION_CLIP_CLOCK, &[])
}

/// Resources of bind group 0 of `animation/clip_clock`.
#[derive(Debug, Clone, Copy)]
pub struct Group<'a> {
    /// Parameters of the kernel.
    pub params: &'a Uniform<crate::shared::animation::clip_clock::ClipClockParams>,
    /// Clip and playback of each instance, layer by layer.
    pub instances: Slice<'a, crate::shared::animation::instance::AnimationInstance>,
    /// Location of each clip's data in the set.
    pub clips: Slice<'a, crate::shared::animation::clip::ClipEntry>,
    /// Timelines of all clips.
    pub timelines: Slice<'a, crate::shared::animation::clip::Timeline>,
    /// Key times of all timelines, in seconds.
    pub times: Slice<'a, f32>,
    /// Level of detail of each instance.
    pub lods: Slice<'a, crate::shared::animation::gate_state::Lod>,
    /// Weights of the layers above the base layer, layer by layer, one per instance.
    pub layer_weights: Slice<'a, f32>,
    /// State of each instance in the last frame. x: clip + 1, with the skeleton tier from bit TIER_SHIFT on, and with BLENDED if layers
    /// were above the clip; 0 if no pose is stored. y: hash of the clips of these layers. z: time inside the clip. w: look-ahead time inside the clip. Times are f32 as bits.
    pub history: Slice<'a, [u32; 4]>,
    /// Out: clip clock of each instance.
    pub clip_clocks: Slice<'a, crate::shared::animation::gate_state::ClipClock>,
}

impl Group<'_> {
    /// Binds them.
    ///
    /// # Errors
    /// [`GpuError::Validation`] where the device refuses one.
    pub fn bind(&self, gpu: &Gpu, kernel: &Kernel) -> Result<BindGroup, GpuError> {
        kernel.layouts.bind_group(gpu, &shaders::ANIMATION_CLIP_CLOCK, 0, &[
            (0, self.params.raw().as_entire_binding()),
            (1, self.instances.resource()),
            (2, self.clips.resource()),
            (3, self.timelines.resource()),
            (4, self.times.resource()),
            (5, self.lods.resource()),
            (6, self.layer_weights.resource()),
            (7, self.history.resource()),
            (8, self.clip_clocks.resource()),
        ])
    }
}

}
/// Of `animation/compact.wgsl`.
pub mod compact {
use crate::gpu::bind::prelude::*;

/// Override constants of `animation/compact`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Constants {
    /// Stage of the kernel: one of the constants below.
    pub stage: u32,
}

impl Default for Constants {
    fn default() -> Self {
        Self {
            stage: 0,
        }
    }
}

impl Constants {
    /// Name and value of each.
    pub fn list(&self) -> Vec<(&'static str, f64)> {
        vec![
            ("STAGE", self.stage.into()),
        ]
    }
}

/// The kernel `animation/compact`, compiled.
///
/// # Errors
/// What the driver's compiler reports.
pub fn kernel(gpu: &Gpu, constants: &Constants) -> Result<Kernel, GpuError> {
    Kernel::new(gpu, &shaders::ANIMATION_COMPACT, &constants.list())
}

/// Resources of bind group 0 of `animation/compact`.
#[derive(Debug, Clone, Copy)]
pub struct Group<'a> {
    /// Parameters of the kernel.
    pub params: &'a Uniform<crate::shared::animation::compact::CompactParams>,
    /// Three bit sets of the same layout, each with one bit per bone of each instance, in the order of bones: the bones that are
    /// sampled, those of them that are sampled ahead, and the bones whose model matrices this frame updates.
    pub bits: Slice<'a, u32>,
    /// Bones in their order, parents first.
    pub slots: Slice<'a, crate::shared::animation::order::Slot>,
    /// Updated bones, one bit per slot of each instance. The bits accumulate over frames until all readers have processed them.
    pub updated_bones: Slice<'a, u32>,
    /// Per instance. In: the number of active pairs. Out, after SCAN: the number of active pairs of all preceding instances.
    pub counts: Slice<'a, u32>,
    /// Out: active pairs, instance * bones + bone, with PAIR_AHEAD if the bone is sampled ahead.
    pub pairs: Slice<'a, u32>,
    /// Out: numbers of workgroups along x, y and z for one thread per pair, and the number of pairs (w).
    pub pair_dispatch: Slice<'a, [u32; 4]>,
    /// Out: indices of the instances with active pairs.
    pub updated_instances: Slice<'a, u32>,
    /// Out: dispatches, as numbers of workgroups along x, y and z. The first dispatch has one thread per updated instance; its w is
    /// the number of updated instances. Every other dispatch has several threads per updated instance. Its w is this number of
    /// threads, which is also an input.
    pub instance_dispatches: Slice<'a, [u32; 4]>,
}

impl Group<'_> {
    /// Binds them.
    ///
    /// # Errors
    /// [`GpuError::Validation`] where the device refuses one.
    pub fn bind(&self, gpu: &Gpu, kernel: &Kernel) -> Result<BindGroup, GpuError> {
        kernel.layouts.bind_group(gpu, &shaders::ANIMATION_COMPACT, 0, &[
            (0, self.params.raw().as_entire_binding()),
            (1, self.bits.resource()),
            (2, self.slots.resource()),
            (3, self.updated_bones.resource()),
            (4, self.counts.resource()),
            (5, self.pairs.resource()),
            (6, self.pair_dispatch.resource()),
            (7, self.updated_instances.resource()),
            (8, self.instance_dispatches.resource()),
        ])
    }
}

}
/// Of `animation/drive.wgsl`.
pub mod drive {
use crate::gpu::bind::prelude::*;

/// The kernel `animation/drive`, compiled.
///
/// # Errors
/// What the driver's compiler reports.
pub fn kernel(gpu: &Gpu) -> Result<Kernel, GpuError> {
    Kernel::new(gpu, &shaders::ANIMATION_DRIVE, &[])
}

/// Resources of bind group 0 of `animation/drive`.
#[derive(Debug, Clone, Copy)]
pub struct Group<'a> {
    /// Parameters of the kernel.
    pub params: &'a Uniform<crate::shared::animation::drive::DriveParams>,
    /// Words with driven bones.
    pub driven: Slice<'a, crate::shared::animation::drive::DrivenWord>,
    /// Level of detail of each instance.
    pub lods: Slice<'a, crate::shared::animation::gate_state::Lod>,
    /// Two bit sets of the same layout, each with one bit per bone of each instance, in the order of bones: the bones that are
    /// sampled, and those of them that are sampled ahead.
    pub bits: Slice<'a, u32>,
}

impl Group<'_> {
    /// Binds them.
    ///
    /// # Errors
    /// [`GpuError::Validation`] where the device refuses one.
    pub fn bind(&self, gpu: &Gpu, kernel: &Kernel) -> Result<BindGroup, GpuError> {
        kernel.layouts.bind_group(gpu, &shaders::ANIMATION_DRIVE, 0, &[
            (0, self.params.raw().as_entire_binding()),
            (1, self.driven.resource()),
            (2, self.lods.resource()),
            (3, self.bits.resource()),
        ])
    }
}

}
/// Of `animation/gate.wgsl`.
pub mod gate {
use crate::gpu::bind::prelude::*;

/// Override constants of `animation/gate`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Constants {
    /// Mode of the gate: one of the constants below.
    pub mode: u32,
}

impl Default for Constants {
    fn default() -> Self {
        Self {
            mode: 0,
        }
    }
}

impl Constants {
    /// Name and value of each.
    pub fn list(&self) -> Vec<(&'static str, f64)> {
        vec![
            ("MODE", self.mode.into()),
        ]
    }
}

/// The kernel `animation/gate`, compiled.
///
/// # Errors
/// What the driver's compiler reports.
pub fn kernel(gpu: &Gpu, constants: &Constants) -> Result<Kernel, GpuError> {
    Kernel::new(gpu, &shaders::ANIMATION_GATE, &constants.list())
}

/// Resources of bind group 0 of `animation/gate`.
#[derive(Debug, Clone, Copy)]
pub struct Group<'a> {
    /// Parameters of the kernel.
    pub params: &'a Uniform<crate::shared::animation::gate::GateParams>,
    /// Level of detail of each instance.
    pub lods: Slice<'a, crate::shared::animation::gate_state::Lod>,
    /// Clip clock of each instance.
    pub clip_clocks: Slice<'a, crate::shared::animation::gate_state::ClipClock>,
    /// Per skeleton tier and clip: the index of the clip's last row in `table`, then one bit per bone of the tier that the clip moves.
    /// After all tiers, two bit sets per tier: all of its bones, and the bones that no gate skips.
    pub animated_bones: Slice<'a, u32>,
    /// Rows of the gate's table. With SKIP_PERIOD, they hold priorities, four per vector. With BOUNDED, they hold per bone the
    /// accumulated motion (x) and its increase up to the next row (y). In a clip's last row, x is the motion over the whole clip,
    /// and y the bone's encoded error budget.
    pub table: Slice<'a, [u32; 2]>,
    /// Accumulated motion of each bone of each instance when the bone was last sampled.
    pub sampled: Slice<'a, u32>,
    /// Remaining error budget of each bone with a child that is not the next bone in the order.
    pub remaining: Slice<'a, u32>,
    /// Three bit sets of the same layout, each with one bit per bone of each instance, in the order of bones: the bones that are
    /// sampled, those of them that are sampled ahead, and the bones whose model matrices this frame updates.
    pub bits: Slice<'a, u32>,
}

impl Group<'_> {
    /// Binds them.
    ///
    /// # Errors
    /// [`GpuError::Validation`] where the device refuses one.
    pub fn bind(&self, gpu: &Gpu, kernel: &Kernel) -> Result<BindGroup, GpuError> {
        kernel.layouts.bind_group(gpu, &shaders::ANIMATION_GATE, 0, &[
            (0, self.params.raw().as_entire_binding()),
            (1, self.lods.resource()),
            (2, self.clip_clocks.resource()),
            (3, self.animated_bones.resource()),
            (4, self.table.resource()),
            (5, self.sampled.resource()),
            (6, self.remaining.resource()),
            (7, self.bits.resource()),
        ])
    }
}

}
/// Of `animation/keyframe_cursor.wgsl`.
pub mod keyframe_cursor {
use crate::gpu::bind::prelude::*;

/// Override constants of `animation/keyframe_cursor`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Constants {
    /// Whether only listed instances are handled.
    pub compacted: bool,
}

impl Default for Constants {
    fn default() -> Self {
        Self {
            compacted: false,
        }
    }
}

impl Constants {
    /// Name and value of each.
    pub fn list(&self) -> Vec<(&'static str, f64)> {
        vec![
            ("COMPACTED", self.compacted.into()),
        ]
    }
}

/// The kernel `animation/keyframe_cursor`, compiled.
///
/// # Errors
/// What the driver's compiler reports.
pub fn kernel(gpu: &Gpu, constants: &Constants) -> Result<Kernel, GpuError> {
    Kernel::new(gpu, &shaders::ANIMATION_KEYFRAME_CURSOR, &constants.list())
}

/// Resources of bind group 0 of `animation/keyframe_cursor`.
#[derive(Debug, Clone, Copy)]
pub struct Group<'a> {
    /// Parameters of the kernel.
    pub params: &'a Uniform<crate::shared::animation::keyframe_cursor::KeyframeCursorParams>,
    /// Clip and playback of each instance, layer by layer.
    pub instances: Slice<'a, crate::shared::animation::instance::AnimationInstance>,
    /// Location of each clip's data in the set.
    pub clips: Slice<'a, crate::shared::animation::clip::ClipEntry>,
    /// Timelines of all clips.
    pub timelines: Slice<'a, crate::shared::animation::clip::Timeline>,
    /// Key times of all timelines, in seconds.
    pub times: Slice<'a, f32>,
    /// Out: the cursors of all layers, then the base layer's cursors at the look-ahead time.
    pub cursors: Slice<'a, crate::shared::animation::clip::KeyframeCursor>,
    /// Indices of the listed instances.
    pub updated_instances: Slice<'a, u32>,
    /// Arguments of dispatches. In the first vector, w is the number of listed instances.
    pub dispatches: Slice<'a, [u32; 4]>,
    /// State of the gate's clip clocks, per instance: z is the time inside the base layer's clip, w the look-ahead time, both as
    /// bits.
    pub history: Slice<'a, [u32; 4]>,
}

impl Group<'_> {
    /// Binds them.
    ///
    /// # Errors
    /// [`GpuError::Validation`] where the device refuses one.
    pub fn bind(&self, gpu: &Gpu, kernel: &Kernel) -> Result<BindGroup, GpuError> {
        kernel.layouts.bind_group(gpu, &shaders::ANIMATION_KEYFRAME_CURSOR, 0, &[
            (0, self.params.raw().as_entire_binding()),
            (1, self.instances.resource()),
            (2, self.clips.resource()),
            (3, self.timelines.resource()),
            (4, self.times.resource()),
            (5, self.cursors.resource()),
            (6, self.updated_instances.resource()),
            (7, self.dispatches.resource()),
            (8, self.history.resource()),
        ])
    }
}

}
/// Of `animation/local_to_model.wgsl`.
pub mod local_to_model {
use crate::gpu::bind::prelude::*;

/// Override constants of `animation/local_to_model`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Constants {
    /// Whether only updated slots of listed instances are walked.
    pub compacted: bool,
}

impl Default for Constants {
    fn default() -> Self {
        Self {
            compacted: false,
        }
    }
}

impl Constants {
    /// Name and value of each.
    pub fn list(&self) -> Vec<(&'static str, f64)> {
        vec![
            ("COMPACTED", self.compacted.into()),
        ]
    }
}

/// The kernel `animation/local_to_model`, compiled.
///
/// # Errors
/// What the driver's compiler reports.
pub fn kernel(gpu: &Gpu, constants: &Constants) -> Result<Kernel, GpuError> {
    Kernel::new(gpu, &shaders::ANIMATION_LOCAL_TO_MODEL, &constants.list())
}

/// Resources of bind group 0 of `animation/local_to_model`.
#[derive(Debug, Clone, Copy)]
pub struct Group<'a> {
    /// Parameters of the kernel.
    pub params: &'a Uniform<crate::shared::animation::local_to_model::LocalToModelParams>,
    /// Bones in their order, parents first.
    pub slots: Slice<'a, crate::shared::animation::order::Slot>,
    /// Chains of slots, level by level of the hierarchy.
    pub chains: Slice<'a, crate::shared::animation::order::Chain>,
    /// Updated bones: from `first_word` on, one bit per slot of each instance.
    pub updated_bones: Slice<'a, u32>,
    /// Indices of the updated instances.
    pub updated_instances: Slice<'a, u32>,
    /// Arguments of dispatches. In the first vector, w is the number of updated instances.
    pub dispatches: Slice<'a, [u32; 4]>,
    /// Local transforms, three vectors per bone: translation and scale x; rotation; scale y and z.
    pub locals: Slice<'a, [f32; 4]>,
    /// Out: model matrices, three rows per bone of each instance.
    pub model_matrices: Slice<'a, [f32; 4]>,
}

impl Group<'_> {
    /// Binds them.
    ///
    /// # Errors
    /// [`GpuError::Validation`] where the device refuses one.
    pub fn bind(&self, gpu: &Gpu, kernel: &Kernel) -> Result<BindGroup, GpuError> {
        kernel.layouts.bind_group(gpu, &shaders::ANIMATION_LOCAL_TO_MODEL, 0, &[
            (0, self.params.raw().as_entire_binding()),
            (1, self.slots.resource()),
            (2, self.chains.resource()),
            (3, self.updated_bones.resource()),
            (4, self.updated_instances.resource()),
            (5, self.dispatches.resource()),
            (6, self.locals.resource()),
            (7, self.model_matrices.resource()),
        ])
    }
}

}
/// Of `animation/sample.wgsl`.
pub mod sample {
use crate::gpu::bind::prelude::*;

/// Override constants of `animation/sample`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Constants {
    /// Whether only the listed pairs of instance and bone are sampled.
    pub compacted: bool,
    /// Whether the clips of further layers are blended over the base layer.
    pub layered: bool,
    /// Whether rotations are interpolated linearly and then normalized, instead of spherically.
    pub nlerp: bool,
    /// Whether any track is a spline. Without splines, threads need not wait for the loads of the spline branch.
    pub splines: bool,
}

impl Default for Constants {
    fn default() -> Self {
        Self {
            compacted: false,
            layered: false,
            nlerp: false,
            splines: true,
        }
    }
}

impl Constants {
    /// Name and value of each.
    pub fn list(&self) -> Vec<(&'static str, f64)> {
        vec![
            ("COMPACTED", self.compacted.into()),
            ("LAYERED", self.layered.into()),
            ("NLERP", self.nlerp.into()),
            ("SPLINES", self.splines.into()),
        ]
    }
}

/// The kernel `animation/sample`, compiled.
///
/// # Errors
/// What the driver's compiler reports.
pub fn kernel(gpu: &Gpu, constants: &Constants) -> Result<Kernel, GpuError> {
    Kernel::new(gpu, &shaders::ANIMATION_SAMPLE, &constants.list())
}

/// Resources of bind group 0 of `animation/sample`.
#[derive(Debug, Clone, Copy)]
pub struct Group<'a> {
    /// Parameters of the kernel.
    pub params: &'a Uniform<crate::shared::animation::sample::SampleParams>,
    /// Clip and playback of each instance, layer by layer. Cursors have the same order.
    pub instances: Slice<'a, crate::shared::animation::instance::AnimationInstance>,
    /// Three tracks per bone and clip: translation, rotation and scale.
    pub tracks: Slice<'a, crate::shared::animation::clip::SetTrack>,
    /// Values of the keys of all tracks.
    pub values: Slice<'a, [f32; 4]>,
    /// Cursor words (`cursor_of_words`), layer by layer. After all layers: the base layer's cursors at the look-ahead time.
    pub cursors: Slice<'a, [u32; 2]>,
    /// Pairs of instance and bone to be sampled: instance * bones + bone. Pairs with PAIR_AHEAD are sampled at the look-ahead time.
    pub pairs: Slice<'a, u32>,
    /// Numbers of workgroups of the dispatch (xyz), and the number of pairs (w).
    pub dispatched: Slice<'a, [u32; 4]>,
    /// Out: local transforms, three vectors per bone: translation and scale x; rotation; scale y and z.
    pub locals: Slice<'a, [f32; 4]>,
    /// Weights of the layers above the base layer: one weight per instance, layer by layer. Then a mask for each of these layers,
    /// with one value per bone.
    pub layer_weights: Slice<'a, f32>,
}

impl Group<'_> {
    /// Binds them.
    ///
    /// # Errors
    /// [`GpuError::Validation`] where the device refuses one.
    pub fn bind(&self, gpu: &Gpu, kernel: &Kernel) -> Result<BindGroup, GpuError> {
        kernel.layouts.bind_group(gpu, &shaders::ANIMATION_SAMPLE, 0, &[
            (0, self.params.raw().as_entire_binding()),
            (1, self.instances.resource()),
            (2, self.tracks.resource()),
            (3, self.values.resource()),
            (4, self.cursors.resource()),
            (5, self.pairs.resource()),
            (6, self.dispatched.resource()),
            (7, self.locals.resource()),
            (8, self.layer_weights.resource()),
        ])
    }
}

}
}
/// Of `baseline/`.
pub mod baseline {
/// Of `baseline/copy.wgsl`.
pub mod copy {
use crate::gpu::bind::prelude::*;

/// The kernel `baseline/copy`, compiled.
///
/// # Errors
/// What the driver's compiler reports.
pub fn kernel(gpu: &Gpu) -> Result<Kernel, GpuError> {
    Kernel::new(gpu, &shaders::BASELINE_COPY, &[])
}

/// Resources of bind group 0 of `baseline/copy`.
#[derive(Debug, Clone, Copy)]
pub struct Group<'a> {
    /// Parameters of the kernel.
    pub params: &'a Uniform<crate::shared::baseline::copy::CopyParams>,
    /// Vectors to copy.
    pub source: Slice<'a, [u32; 4]>,
    /// Out: the copied vectors.
    pub destination: Slice<'a, [u32; 4]>,
}

impl Group<'_> {
    /// Binds them.
    ///
    /// # Errors
    /// [`GpuError::Validation`] where the device refuses one.
    pub fn bind(&self, gpu: &Gpu, kernel: &Kernel) -> Result<BindGroup, GpuError> {
        kernel.layouts.bind_group(gpu, &shaders::BASELINE_COPY, 0, &[
            (0, self.params.raw().as_entire_binding()),
            (1, self.source.resource()),
            (2, self.destination.resource()),
        ])
    }
}

}
/// Of `baseline/gather.wgsl`.
pub mod gather {
use crate::gpu::bind::prelude::*;

/// Override constants of `baseline/gather`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Constants {
    /// Whether tracks are looked up in tables, as sampling does. If false, tracks are evenly spaced, so that only keys are read.
    pub tables: bool,
}

impl Default for Constants {
    fn default() -> Self {
        Self {
            tables: true,
        }
    }
}

impl Constants {
    /// Name and value of each.
    pub fn list(&self) -> Vec<(&'static str, f64)> {
        vec![
            ("TABLES", self.tables.into()),
        ]
    }
}

/// The kernel `baseline/gather`, compiled.
///
/// # Errors
/// What the driver's compiler reports.
pub fn kernel(gpu: &Gpu, constants: &Constants) -> Result<Kernel, GpuError> {
    Kernel::new(gpu, &shaders::BASELINE_GATHER, &constants.list())
}

/// Resources of bind group 0 of `baseline/gather`.
#[derive(Debug, Clone, Copy)]
pub struct Group<'a> {
    /// Parameters of the kernel.
    pub params: &'a Uniform<crate::shared::baseline::gather::GatherParams>,
    /// Clip and playback of each instance.
    pub instances: Slice<'a, crate::shared::animation::instance::AnimationInstance>,
    /// Three tracks per bone and clip: translation, rotation and scale.
    pub tracks: Slice<'a, crate::shared::animation::clip::SetTrack>,
    /// One cursor per instance, in two words: the key, and the fraction as bits.
    pub cursors: Slice<'a, [u32; 2]>,
    /// Values of the keys of all tracks.
    pub values: Slice<'a, [u32; 4]>,
    /// Out: three vectors per pair of instance and bone.
    pub gathered: Slice<'a, [u32; 4]>,
}

impl Group<'_> {
    /// Binds them.
    ///
    /// # Errors
    /// [`GpuError::Validation`] where the device refuses one.
    pub fn bind(&self, gpu: &Gpu, kernel: &Kernel) -> Result<BindGroup, GpuError> {
        kernel.layouts.bind_group(gpu, &shaders::BASELINE_GATHER, 0, &[
            (0, self.params.raw().as_entire_binding()),
            (1, self.instances.resource()),
            (2, self.tracks.resource()),
            (3, self.cursors.resource()),
            (4, self.values.resource()),
            (5, self.gathered.resource()),
        ])
    }
}

}
/// Of `baseline/loads.wgsl`.
pub mod loads {
use crate::gpu::bind::prelude::*;

/// The kernel `baseline/loads`, compiled.
///
/// # Errors
/// What the driver's compiler reports.
pub fn kernel(gpu: &Gpu) -> Result<Kernel, GpuError> {
    Kernel::new(gpu, &shaders::BASELINE_LOADS, &[])
}

/// Resources of bind group 0 of `baseline/loads`.
#[derive(Debug, Clone, Copy)]
pub struct Group<'a> {
    /// Parameters of the kernel.
    pub params: &'a Uniform<crate::shared::baseline::loads::LoadsParams>,
    /// Texture to read. Only the red channel is used.
    pub texels: &'a wgpu::TextureView,
    /// Out: sum of each thread's texels, row by row.
    pub sums: Slice<'a, f32>,
}

impl Group<'_> {
    /// Binds them.
    ///
    /// # Errors
    /// [`GpuError::Validation`] where the device refuses one.
    pub fn bind(&self, gpu: &Gpu, kernel: &Kernel) -> Result<BindGroup, GpuError> {
        kernel.layouts.bind_group(gpu, &shaders::BASELINE_LOADS, 0, &[
            (0, self.params.raw().as_entire_binding()),
            (1, wgpu::BindingResource::TextureView(self.texels)),
            (2, self.sums.resource()),
        ])
    }
}

}
/// Of `baseline/texels.wgsl`.
pub mod texels {
use crate::gpu::bind::prelude::*;

/// The kernel `baseline/texels`, compiled.
///
/// # Errors
/// What the driver's compiler reports.
pub fn kernel(gpu: &Gpu) -> Result<Kernel, GpuError> {
    Kernel::new(gpu, &shaders::BASELINE_TEXELS, &[])
}

/// Resources of bind group 0 of `baseline/texels`.
#[derive(Debug, Clone, Copy)]
pub struct Group<'a> {
    /// Parameters of the kernel.
    pub params: &'a Uniform<crate::shared::baseline::texels::TexelsParams>,
    /// Heights of all windows, row by row, in 1/65536 units.
    pub windows: Slice<'a, i32>,
    /// Zones of the ground and their textures.
    pub zones: Slice<'a, crate::shared::terrain::tiles::MapZone>,
    /// Texels of all textures, two words each.
    pub texels: Slice<'a, [u32; 2]>,
    /// Position of the first pixel of each map, in 2^-22 tiles.
    pub places: Slice<'a, [u32; 2]>,
    /// Out: one word per pixel.
    pub words: Slice<'a, u32>,
}

impl Group<'_> {
    /// Binds them.
    ///
    /// # Errors
    /// [`GpuError::Validation`] where the device refuses one.
    pub fn bind(&self, gpu: &Gpu, kernel: &Kernel) -> Result<BindGroup, GpuError> {
        kernel.layouts.bind_group(gpu, &shaders::BASELINE_TEXELS, 0, &[
            (0, self.params.raw().as_entire_binding()),
            (1, self.windows.resource()),
            (2, self.zones.resource()),
            (3, self.texels.resource()),
            (4, self.places.resource()),
            (5, self.words.resource()),
        ])
    }
}

}
/// Of `baseline/words.wgsl`.
pub mod words {
use crate::gpu::bind::prelude::*;

/// The kernel `baseline/words`, compiled.
///
/// # Errors
/// What the driver's compiler reports.
pub fn kernel(gpu: &Gpu) -> Result<Kernel, GpuError> {
    Kernel::new(gpu, &shaders::BASELINE_WORDS, &[])
}

/// Resources of bind group 0 of `baseline/words`.
#[derive(Debug, Clone, Copy)]
pub struct Group<'a> {
    /// Parameters of the kernel.
    pub params: &'a Uniform<crate::shared::baseline::words::WordsParams>,
    /// Out: random words, row by row.
    pub words: Slice<'a, [u32; 4]>,
}

impl Group<'_> {
    /// Binds them.
    ///
    /// # Errors
    /// [`GpuError::Validation`] where the device refuses one.
    pub fn bind(&self, gpu: &Gpu, kernel: &Kernel) -> Result<BindGroup, GpuError> {
        kernel.layouts.bind_group(gpu, &shaders::BASELINE_WORDS, 0, &[
            (0, self.params.raw().as_entire_binding()),
            (1, self.words.resource()),
        ])
    }
}

}
}
/// Of `lod/`.
pub mod lod {
/// Of `lod/assign.wgsl`.
pub mod assign {
use crate::gpu::bind::prelude::*;

/// The kernel `lod/assign`, compiled.
///
/// # Errors
/// What the driver's compiler reports.
pub fn kernel(gpu: &Gpu) -> Result<Kernel, GpuError> {
    Kernel::new(gpu, &shaders::LOD_ASSIGN, &[])
}

/// Counts that give the least lengths of the buffers of `lod/assign`.
#[derive(Debug, Clone, Copy)]
pub struct Lengths {
    /// Number of instances.
    pub instances: usize,
}

/// Resources of bind group 0 of `lod/assign`.
#[derive(Debug, Clone, Copy)]
pub struct Buffers<'a> {
    /// Per instance of the scene: the displacement that the frame's views allow, and the distance of the nearest eye.
    pub allowed: &'a Buffer<crate::shared::lod::allowed::Allowed>,
    /// Per instance of the object: the level of detail for gates. In: that of the last frame.
    pub lods: &'a Buffer<crate::shared::animation::gate_state::Lod>,
    /// Out, per instance of the object: the level of detail for skinning.
    pub instance_lods: &'a Buffer<crate::shared::skinning::instance_lod::InstanceLod>,
    /// All instances of the scene.
    pub instances: &'a Buffer<crate::shared::lod::instance::SceneInstance>,
    /// Per instance of the scene: the finest level that the frame's views draw.
    pub finest: &'a Buffer<u32>,
}

impl Buffers<'_> {
    /// Binds them.
    ///
    /// # Errors
    /// [`InputError`](crate::InputError) for a buffer that is too short; [`GpuError::Validation`] where the device refuses one.
    pub fn bind(&self, gpu: &Gpu, kernel: &Kernel, params: &Uniform<crate::shared::lod::assign::AssignParams>, lengths: &Lengths) -> Result<BindGroup, crate::Error> {
        let Lengths { instances } = *lengths;
        self.allowed.check_holds("allowed", instances)?;
        self.lods.check_holds("lods", instances)?;
        self.instance_lods.check_holds("instance_lods", instances)?;
        self.instances.check_holds("instances", instances)?;
        self.finest.check_holds("finest", instances)?;
        Ok(kernel.layouts.bind_group(gpu, &shaders::LOD_ASSIGN, 0, &[
            (0, params.raw().as_entire_binding()),
            (1, self.allowed.slice().resource()),
            (2, self.lods.slice().resource()),
            (3, self.instance_lods.slice().resource()),
            (4, self.instances.slice().resource()),
            (5, self.finest.slice().resource()),
        ])?)
    }
}

}
/// Of `lod/attach.wgsl`.
pub mod attach {
use crate::gpu::bind::prelude::*;

/// The kernel `lod/attach`, compiled.
///
/// # Errors
/// What the driver's compiler reports.
pub fn kernel(gpu: &Gpu) -> Result<Kernel, GpuError> {
    Kernel::new(gpu, &shaders::LOD_ATTACH, &[])
}

/// Counts that give the least lengths of the buffers of `lod/attach`.
#[derive(Debug, Clone, Copy)]
pub struct Lengths {
    /// Number of attachments.
    pub attachments: usize,
    /// Number of instances.
    pub instances: usize,
    /// Number of placements.
    pub placements: usize,
}

/// Resources of bind group 0 of `lod/attach`.
#[derive(Debug, Clone, Copy)]
pub struct Buffers<'a> {
    /// The view for which placements are written.
    pub view: &'a Uniform<crate::shared::lod::view::SelectView>,
    /// Attached meshes. Only the first `AttachParams::attached` entries are valid.
    pub attachments: &'a Buffer<crate::shared::lod::attach::Attachment>,
    /// Model matrices: three rows per bone of each instance of the character.
    pub model_matrices: &'a Buffer<[f32; 4]>,
    /// All instances of the scene.
    pub instances: &'a Buffer<crate::shared::lod::instance::SceneInstance>,
    /// Per instance of the scene: the displacement that the frame's views allow; negative if no view sees the instance.
    pub allowed: &'a Buffer<crate::shared::lod::allowed::Allowed>,
    /// Three rows per instance of the scene: the transform from model space to positions relative to the corner of the view's cell.
    /// From index `first_last` on: the last frame's transforms, relative to the corner of the same cell. Out: the rows of attached
    /// meshes.
    pub placements: &'a Buffer<[[f32; 4]; 3]>,
    /// All instances of the scene in the state of the last frame. If the last frame is not kept, this is the same buffer as
    /// `instances`.
    pub last_instances: &'a Buffer<crate::shared::lod::instance::SceneInstance>,
    /// Two entries per attachment, initially zero: the bone's transform in even frames and in odd frames.
    pub kept: &'a Buffer<crate::shared::lod::attach::KeptBone>,
}

impl Buffers<'_> {
    /// Binds them.
    ///
    /// # Errors
    /// [`InputError`](crate::InputError) for a buffer that is too short; [`GpuError::Validation`] where the device refuses one.
    pub fn bind(&self, gpu: &Gpu, kernel: &Kernel, params: &Uniform<crate::shared::lod::attach::AttachParams>, lengths: &Lengths) -> Result<BindGroup, crate::Error> {
        let Lengths { attachments, instances, placements } = *lengths;
        self.allowed.check_holds("allowed", instances)?;
        self.placements.check_holds("placements", placements)?;
        self.last_instances.check_holds("last_instances", instances)?;
        self.kept.check_holds("kept", 2 * attachments)?;
        Ok(kernel.layouts.bind_group(gpu, &shaders::LOD_ATTACH, 0, &[
            (0, params.raw().as_entire_binding()),
            (1, self.view.raw().as_entire_binding()),
            (2, self.attachments.slice().resource()),
            (3, self.model_matrices.slice().resource()),
            (4, self.instances.slice().resource()),
            (5, self.allowed.slice().resource()),
            (6, self.placements.slice().resource()),
            (7, self.last_instances.slice().resource()),
            (8, self.kept.slice().resource()),
        ])?)
    }
}

}
/// Of `lod/budget.wgsl`.
pub mod budget {
use crate::gpu::bind::prelude::*;

/// Override constants of `lod/budget`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Constants {
    /// Stage of the kernel: one of the constants below.
    pub stage: u32,
}

impl Default for Constants {
    fn default() -> Self {
        Self {
            stage: 0,
        }
    }
}

impl Constants {
    /// Name and value of each.
    pub fn list(&self) -> Vec<(&'static str, f64)> {
        vec![
            ("STAGE", self.stage.into()),
        ]
    }
}

/// The kernel `lod/budget`, compiled.
///
/// # Errors
/// What the driver's compiler reports.
pub fn kernel(gpu: &Gpu, constants: &Constants) -> Result<Kernel, GpuError> {
    Kernel::new(gpu, &shaders::LOD_BUDGET, &constants.list())
}

/// Counts that give the least lengths of the buffers of `lod/budget`.
#[derive(Debug, Clone, Copy)]
pub struct Lengths {
    /// Number of blocks.
    pub blocks: usize,
}

/// Resources of bind group 0 of `lod/budget`.
#[derive(Debug, Clone, Copy)]
pub struct Buffers<'a> {
    /// The view that shares the budget.
    pub view: &'a Uniform<crate::shared::lod::view::SelectView>,
    /// The objects of the scene.
    pub objects: &'a Buffer<crate::shared::lod::object::LodObject>,
    /// Object index of each block of instances; `NO_OBJECT` for none.
    pub block_objects: &'a Buffer<u32>,
    /// Metric word of each instance in the view.
    pub metrics: &'a Buffer<u32>,
    /// Decision word of each instance in the last frame; valid if `SelectView::is_next` is 1.
    pub decisions: &'a Buffer<u32>,
    /// State of the budget. In: the state of the last frame. Out: the state of this frame.
    pub state: &'a Buffer<crate::shared::lod::budget_state::BudgetState>,
    /// Sums and histograms of the budget.
    pub work: &'a Buffer<crate::shared::lod::budget::BudgetWork>,
}

impl Buffers<'_> {
    /// Binds them.
    ///
    /// # Errors
    /// [`InputError`](crate::InputError) for a buffer that is too short; [`GpuError::Validation`] where the device refuses one.
    pub fn bind(&self, gpu: &Gpu, kernel: &Kernel, params: &Uniform<crate::shared::lod::budget::BudgetParams>, lengths: &Lengths) -> Result<BindGroup, crate::Error> {
        let Lengths { blocks } = *lengths;
        self.objects.check_holds("objects", 1)?;
        self.metrics.check_holds("metrics", crate::shared::lod::object::BLOCK as usize * blocks)?;
        self.decisions.check_holds("decisions", crate::shared::lod::object::BLOCK as usize * blocks)?;
        self.state.check_holds("state", 1)?;
        self.work.check_holds("work", 1)?;
        Ok(kernel.layouts.bind_group(gpu, &shaders::LOD_BUDGET, 0, &[
            (0, params.raw().as_entire_binding()),
            (1, self.view.raw().as_entire_binding()),
            (2, self.objects.slice().resource()),
            (3, self.block_objects.slice().resource()),
            (4, self.metrics.slice().resource()),
            (5, self.decisions.slice().resource()),
            (6, self.state.slice().resource()),
            (7, self.work.slice().resource()),
        ])?)
    }
}

}
/// Of `lod/decide.wgsl`.
pub mod decide {
use crate::gpu::bind::prelude::*;

/// The kernel `lod/decide`, compiled.
///
/// # Errors
/// What the driver's compiler reports.
pub fn kernel(gpu: &Gpu) -> Result<Kernel, GpuError> {
    Kernel::new(gpu, &shaders::LOD_DECIDE, &[])
}

/// Counts that give the least lengths of the buffers of `lod/decide`.
#[derive(Debug, Clone, Copy)]
pub struct Lengths {
    /// Number of blocks.
    pub blocks: usize,
}

/// Resources of bind group 0 of `lod/decide`.
#[derive(Debug, Clone, Copy)]
pub struct Buffers<'a> {
    /// The view. `SelectView::blocks` may be less than the length of `block_objects`.
    pub view: &'a Uniform<crate::shared::lod::view::SelectView>,
    /// The objects of the scene.
    pub objects: &'a Buffer<crate::shared::lod::object::LodObject>,
    /// Object index of each block of instances. The instances of a block with `NO_OBJECT` are left unchanged.
    pub block_objects: &'a Buffer<u32>,
    /// Metric word of each instance in the view.
    pub metrics: &'a Buffer<u32>,
    /// Decision word of each instance. In: the decisions of the last frame, if `SelectView::is_next` is 1. Out: the decisions of
    /// this frame; 0 if the view does not see the instance.
    pub decisions: &'a Buffer<u32>,
    /// Out, per instance: the decision word of the last frame; 0 if the view was not in that frame.
    pub last_decisions: &'a Buffer<u32>,
    /// Out, per block: the number of the block's instances in each of `OBJECT_LISTS` lists.
    pub counts: &'a Buffer<u32>,
    /// Out, per instance: the finest level that the frame's views draw; `UNSEEN_LEVEL` if no view sees the instance.
    pub finest: &'a Buffer<u32>,
    /// State of the view's triangle budget, with the factors that coarsen levels.
    pub budget: &'a Buffer<crate::shared::lod::budget_state::BudgetState>,
}

impl Buffers<'_> {
    /// Binds them.
    ///
    /// # Errors
    /// [`InputError`](crate::InputError) for a buffer that is too short; [`GpuError::Validation`] where the device refuses one.
    pub fn bind(&self, gpu: &Gpu, kernel: &Kernel, lengths: &Lengths) -> Result<BindGroup, crate::Error> {
        let Lengths { blocks } = *lengths;
        self.objects.check_holds("objects", 1)?;
        self.metrics.check_holds("metrics", crate::shared::lod::object::BLOCK as usize * blocks)?;
        self.decisions.check_holds("decisions", crate::shared::lod::object::BLOCK as usize * blocks)?;
        self.last_decisions.check_holds("last_decisions", crate::shared::lod::object::BLOCK as usize * blocks)?;
        self.counts.check_holds("counts", crate::shared::lod::object::OBJECT_LISTS as usize * blocks)?;
        self.finest.check_holds("finest", crate::shared::lod::object::BLOCK as usize * blocks)?;
        self.budget.check_holds("budget", 1)?;
        Ok(kernel.layouts.bind_group(gpu, &shaders::LOD_DECIDE, 0, &[
            (0, self.view.raw().as_entire_binding()),
            (1, self.objects.slice().resource()),
            (2, self.block_objects.slice().resource()),
            (3, self.metrics.slice().resource()),
            (4, self.decisions.slice().resource()),
            (5, self.last_decisions.slice().resource()),
            (6, self.counts.slice().resource()),
            (7, self.finest.slice().resource()),
            (8, self.budget.slice().resource()),
        ])?)
    }
}

}
/// Of `lod/list.wgsl`.
pub mod list {
use crate::gpu::bind::prelude::*;

/// Override constants of `lod/list`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Constants {
    /// Stage of the kernel: one of the constants below.
    pub stage: u32,
}

impl Default for Constants {
    fn default() -> Self {
        Self {
            stage: 0,
        }
    }
}

impl Constants {
    /// Name and value of each.
    pub fn list(&self) -> Vec<(&'static str, f64)> {
        vec![
            ("STAGE", self.stage.into()),
        ]
    }
}

/// The kernel `lod/list`, compiled.
///
/// # Errors
/// What the driver's compiler reports.
pub fn kernel(gpu: &Gpu, constants: &Constants) -> Result<Kernel, GpuError> {
    Kernel::new(gpu, &shaders::LOD_LIST, &constants.list())
}

/// Resources of bind group 0 of `lod/list`.
#[derive(Debug, Clone, Copy)]
pub struct Group<'a> {
    /// Parameters of the kernel.
    pub params: &'a Uniform<crate::shared::lod::list::ListParams>,
    /// The objects of the scene.
    pub objects: Slice<'a, crate::shared::lod::object::LodObject>,
    /// Object index of each block of instances; `NO_OBJECT` for none.
    pub block_objects: Slice<'a, u32>,
    /// Decision word of each instance.
    pub decisions: Slice<'a, u32>,
    /// Counts per block and list. In: the number of instances. Out: the number of instances in the object's preceding blocks.
    pub counts: Slice<'a, u32>,
    /// Out: list entries of all objects.
    pub lists: Slice<'a, u32>,
    /// Arguments of draws: `OBJECT_LISTS` draws per part of each object. Out: their instance counts.
    pub arguments: Slice<'a, crate::shared::lod::object::SceneDraw>,
}

impl Group<'_> {
    /// Binds them.
    ///
    /// # Errors
    /// [`GpuError::Validation`] where the device refuses one.
    pub fn bind(&self, gpu: &Gpu, kernel: &Kernel) -> Result<BindGroup, GpuError> {
        kernel.layouts.bind_group(gpu, &shaders::LOD_LIST, 0, &[
            (0, self.params.raw().as_entire_binding()),
            (1, self.objects.resource()),
            (2, self.block_objects.resource()),
            (3, self.decisions.resource()),
            (4, self.counts.resource()),
            (5, self.lists.resource()),
            (6, self.arguments.resource()),
        ])
    }
}

}
/// Of `lod/select.wgsl`.
pub mod select {
use crate::gpu::bind::prelude::*;

/// The kernel `lod/select`, compiled.
///
/// # Errors
/// What the driver's compiler reports.
pub fn kernel(gpu: &Gpu) -> Result<Kernel, GpuError> {
    Kernel::new(gpu, &shaders::LOD_SELECT, &[])
}

/// Counts that give the least lengths of the buffers of `lod/select`.
#[derive(Debug, Clone, Copy)]
pub struct Lengths {
    /// Number of blocks.
    pub blocks: usize,
}

/// Resources of bind group 0 of `lod/select`.
#[derive(Debug, Clone, Copy)]
pub struct Buffers<'a> {
    /// The view. `SelectView::blocks` may be less than the length of `block_objects`.
    pub view: &'a Uniform<crate::shared::lod::view::SelectView>,
    /// The objects of the scene.
    pub objects: &'a Buffer<crate::shared::lod::object::LodObject>,
    /// Object index of each block of instances. The instances of a block with `NO_OBJECT` are left unchanged.
    pub block_objects: &'a Buffer<u32>,
    /// The instances of all blocks.
    pub instances: &'a Buffer<crate::shared::lod::instance::SceneInstance>,
    /// Out, per instance: the displacement that all views of the frame allow, and the distance of the nearest eye. Only views that
    /// see the instance count.
    pub allowed: &'a Buffer<crate::shared::lod::allowed::Allowed>,
    /// Out, per instance: the metric word; `UNSEEN_METRIC` if the view does not see the instance.
    pub metrics: &'a Buffer<u32>,
    /// Three rows per visible instance: the transform from model space to positions relative to the corner of the view's cell. In:
    /// the rows of the last frame, if `SelectView::is_next` is 1. Out: the rows of this frame.
    pub placements: &'a Buffer<[[f32; 4]; 3]>,
    /// Decision word of each instance in the last frame; valid if `SelectView::is_next` is 1.
    pub decisions: &'a Buffer<u32>,
    /// One bit per instance: whether its object is drawn in this view with this instance. Objects whose views draw different instances,
    /// such as endless terrain, clear bits.
    pub shown: &'a Buffer<u32>,
}

impl Buffers<'_> {
    /// Binds them.
    ///
    /// # Errors
    /// [`InputError`](crate::InputError) for a buffer that is too short; [`GpuError::Validation`] where the device refuses one.
    pub fn bind(&self, gpu: &Gpu, kernel: &Kernel, lengths: &Lengths) -> Result<BindGroup, crate::Error> {
        let Lengths { blocks } = *lengths;
        self.objects.check_holds("objects", 1)?;
        self.instances.check_holds("instances", crate::shared::lod::object::BLOCK as usize * blocks)?;
        self.allowed.check_holds("allowed", crate::shared::lod::object::BLOCK as usize * blocks)?;
        self.metrics.check_holds("metrics", crate::shared::lod::object::BLOCK as usize * blocks)?;
        self.placements.check_holds("placements", crate::shared::lod::object::BLOCK as usize * blocks)?;
        self.decisions.check_holds("decisions", crate::shared::lod::object::BLOCK as usize * blocks)?;
        self.shown.check_holds("shown", 2 * blocks)?;
        Ok(kernel.layouts.bind_group(gpu, &shaders::LOD_SELECT, 0, &[
            (0, self.view.raw().as_entire_binding()),
            (1, self.objects.slice().resource()),
            (2, self.block_objects.slice().resource()),
            (3, self.instances.slice().resource()),
            (4, self.allowed.slice().resource()),
            (5, self.metrics.slice().resource()),
            (6, self.placements.slice().resource()),
            (7, self.decisions.slice().resource()),
            (8, self.shown.slice().resource()),
        ])?)
    }
}

}
/// Of `lod/sorted.wgsl`.
pub mod sorted {
use crate::gpu::bind::prelude::*;

/// The kernel `lod/sorted`, compiled.
///
/// # Errors
/// What the driver's compiler reports.
pub fn kernel(gpu: &Gpu) -> Result<Kernel, GpuError> {
    Kernel::new(gpu, &shaders::LOD_SORTED, &[])
}

/// Counts that give the least lengths of the buffers of `lod/sorted`.
#[derive(Debug, Clone, Copy)]
pub struct Lengths {
    /// Number of sorted.
    pub sorted: usize,
}

/// Resources of bind group 0 of `lod/sorted`.
#[derive(Debug, Clone, Copy)]
pub struct Buffers<'a> {
    /// The parts to draw. Their instances, first draws and objects must be valid indices of `decisions`, `arguments` and `objects`.
    pub sorted: &'a Buffer<crate::shared::lod::sorted::SortedDraw>,
    /// Decision word of each instance of the scene.
    pub decisions: &'a Buffer<u32>,
    /// Arguments of draws: one draw per list, for each part of each object.
    pub arguments: &'a Buffer<crate::shared::lod::object::SceneDraw>,
    /// Out: one draw per entry of `sorted`.
    pub draws: &'a Buffer<crate::shared::lod::object::SceneDraw>,
    /// Out: the single list entry of each draw.
    pub entries: &'a Buffer<u32>,
    /// The objects of the scene.
    pub objects: &'a Buffer<crate::shared::lod::object::LodObject>,
}

impl Buffers<'_> {
    /// Binds them.
    ///
    /// # Errors
    /// [`InputError`](crate::InputError) for a buffer that is too short; [`GpuError::Validation`] where the device refuses one.
    pub fn bind(&self, gpu: &Gpu, kernel: &Kernel, params: &Uniform<crate::shared::lod::sorted::SortedParams>, lengths: &Lengths) -> Result<BindGroup, crate::Error> {
        let Lengths { sorted } = *lengths;
        self.sorted.check_holds("sorted", sorted)?;
        self.draws.check_holds("draws", sorted)?;
        self.entries.check_holds("entries", sorted)?;
        self.objects.check_holds("objects", 1)?;
        Ok(kernel.layouts.bind_group(gpu, &shaders::LOD_SORTED, 0, &[
            (0, params.raw().as_entire_binding()),
            (1, self.sorted.slice().resource()),
            (2, self.decisions.slice().resource()),
            (3, self.arguments.slice().resource()),
            (4, self.draws.slice().resource()),
            (5, self.entries.slice().resource()),
            (6, self.objects.slice().resource()),
        ])?)
    }
}

}
}
/// Of `render/`.
pub mod render {
/// Of `render/scene_mesh.wgsl`.
pub mod scene_mesh {
use crate::gpu::bind::prelude::*;

/// Override constants of `render/scene_mesh`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Constants {
    /// Whether the shadow map shadows surfaces.
    pub shadowed: bool,
    /// Method by which list entries with fade words are drawn: one of the constants below. The renderer sets it for lists of
    /// instances that fade.
    pub fade: u32,
    /// Whether the mesh is seen from both sides. If true, back faces reverse their normals.
    pub double_sided: bool,
    /// Whether one of the part's materials has a texture.
    pub textured: bool,
    /// Whether one of the part's materials has a normal map.
    pub normal_mapped: bool,
    /// Whether the mesh's levels of detail change by geomorphs.
    pub morphed: bool,
}

impl Default for Constants {
    fn default() -> Self {
        Self {
            shadowed: false,
            fade: 0,
            double_sided: false,
            textured: false,
            normal_mapped: false,
            morphed: false,
        }
    }
}

impl Constants {
    /// Name and value of each.
    pub fn list(&self) -> Vec<(&'static str, f64)> {
        vec![
            ("relievo_SHADOWED", self.shadowed.into()),
            ("relievo_FADE", self.fade.into()),
            ("relievo_DOUBLE_SIDED", self.double_sided.into()),
            ("relievo_TEXTURED", self.textured.into()),
            ("relievo_NORMAL_MAPPED", self.normal_mapped.into()),
            ("relievo_MORPHED", self.morphed.into()),
        ]
    }
}

/// The layouts of the bind groups of `render/scene_mesh`.
///
/// # Errors
/// [`GpuError::Validation`] where the device's limits do not permit them.
pub fn layouts(gpu: &Gpu) -> Result<Layouts, GpuError> {
    Layouts::new(gpu, &shaders::RENDER_SCENE_MESH)
}

/// Resources of bind group 0 of `render/scene_mesh`.
#[derive(Debug, Clone, Copy)]
pub struct Group<'a> {
    /// The view that is drawn.
    pub view: &'a Uniform<crate::shared::render::scene_view::SceneView>,
    /// Per instance of the scene, three rows: the transform from model space to positions relative to the corner of the view's cell.
    /// These transforms are valid for instances that the view sees. If the scene keeps its last frame, a second set follows: one
    /// transform per instance of the last frame, valid for meshes attached to bones.
    pub placements: Slice<'a, [[f32; 4]; 3]>,
    /// All instances of the scene.
    pub instances: Slice<'a, crate::shared::lod::instance::SceneInstance>,
    /// All instances in the state of the last frame. If the scene does not keep its last frame, this is the current state.
    pub last_instances: Slice<'a, crate::shared::lod::instance::SceneInstance>,
    /// Shadow map: distance along the light to the nearest caster. 0 is the sun's near plane; 1 means that there is no caster.
    pub shadow_map: &'a wgpu::TextureView,
    /// Comparison sampler: compares a distance with four texels, and filters the four results.
    pub shadow_sampler: &'a wgpu::Sampler,
    /// Per instance of the scene: the view's decision word in the last frame; 0 if the view did not see the instance in that frame.
    pub last_decisions: Slice<'a, u32>,
}

impl Group<'_> {
    /// Binds them.
    ///
    /// # Errors
    /// [`GpuError::Validation`] where the device refuses one.
    pub fn bind(&self, gpu: &Gpu, layouts: &Layouts) -> Result<BindGroup, GpuError> {
        layouts.bind_group(gpu, &shaders::RENDER_SCENE_MESH, 0, &[
            (0, self.view.raw().as_entire_binding()),
            (1, self.placements.resource()),
            (2, self.instances.resource()),
            (3, self.last_instances.resource()),
            (4, wgpu::BindingResource::TextureView(self.shadow_map)),
            (5, wgpu::BindingResource::Sampler(self.shadow_sampler)),
            (6, self.last_decisions.resource()),
        ])
    }
}

/// Resources of bind group 1 of `render/scene_mesh`.
#[derive(Debug, Clone, Copy)]
pub struct Group1<'a> {
    /// The chunk that is drawn.
    pub scene_object: &'a Uniform<crate::shared::render::scene_instances::SceneObject>,
    /// Vertices, five pairs of floats each: position, normal and tangent.
    pub vertices: Slice<'a, [f32; 2]>,
    /// Texture coordinates, one pair per vertex of the mesh.
    pub texture_coordinates: Slice<'a, [f32; 2]>,
    /// Two tables with one entry per vertex of the mesh. The first table, from 0, has the index of the vertex's material in the
    /// part's table. The second table, from `MeshParams.partners`, has partner words.
    pub material_of: Slice<'a, u32>,
    /// Page of each cluster of each instance of the object, if vertices lie in pages.
    pub page_table: Slice<'a, u32>,
    /// Location of the mesh's vertex data.
    pub mesh: &'a Uniform<crate::shared::render::scene_vertex::MeshParams>,
}

impl Group1<'_> {
    /// Binds them.
    ///
    /// # Errors
    /// [`GpuError::Validation`] where the device refuses one.
    pub fn bind(&self, gpu: &Gpu, layouts: &Layouts) -> Result<BindGroup, GpuError> {
        layouts.bind_group(gpu, &shaders::RENDER_SCENE_MESH, 1, &[
            (0, self.scene_object.raw().as_entire_binding()),
            (1, self.vertices.resource()),
            (2, self.texture_coordinates.resource()),
            (3, self.material_of.resource()),
            (4, self.page_table.resource()),
            (5, self.mesh.raw().as_entire_binding()),
        ])
    }
}

/// Resources of bind group 2 of `render/scene_mesh`.
#[derive(Debug, Clone, Copy)]
pub struct Group2<'a> {
    /// Materials of the part that is drawn.
    pub materials: Slice<'a, crate::shared::render::scene_mesh::SceneMaterial>,
    /// Textures with colour and alpha, one per layer.
    pub albedo: &'a wgpu::TextureView,
    /// Normal maps, one per layer. Their green channel points up the image, against v.
    pub normals: &'a wgpu::TextureView,
    /// Sampler of the colour textures.
    pub filtering: &'a wgpu::Sampler,
    /// Sampler of the normal maps.
    pub normal_filtering: &'a wgpu::Sampler,
}

impl Group2<'_> {
    /// Binds them.
    ///
    /// # Errors
    /// [`GpuError::Validation`] where the device refuses one.
    pub fn bind(&self, gpu: &Gpu, layouts: &Layouts) -> Result<BindGroup, GpuError> {
        layouts.bind_group(gpu, &shaders::RENDER_SCENE_MESH, 2, &[
            (0, self.materials.resource()),
            (1, wgpu::BindingResource::TextureView(self.albedo)),
            (2, wgpu::BindingResource::TextureView(self.normals)),
            (3, wgpu::BindingResource::Sampler(self.filtering)),
            (4, wgpu::BindingResource::Sampler(self.normal_filtering)),
        ])
    }
}

}
/// Of `render/scene_relief.wgsl`.
pub mod scene_relief {
use crate::gpu::bind::prelude::*;

/// Override constants of `render/scene_relief`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Constants {
    /// Whether the shadow map shadows surfaces.
    pub shadowed: bool,
    /// Whether the colour pass writes the depth of the surface (true) or of the polygon (false).
    pub own_depth: bool,
    /// Whether depth is reversed: 1 at the near plane, and smaller with distance.
    pub reversed: bool,
    /// Method by which list entries with fade words are drawn: one of the constants below. The renderer sets it for lists of
    /// instances that fade.
    pub fade: u32,
    /// Whether the mesh's levels of detail change by geomorphs.
    pub morphed: bool,
    /// Tracing method: one of the constants of wgsl/surface/trace.wgsl.
    pub method: u32,
    /// Kind of self-shadow: one of the constants of wgsl/surface/sunlit.wgsl.
    pub shadow: u32,
    /// Whether normals come from the normal map instead of the heights.
    pub normal_map: bool,
    /// Direction of the normal map's green channel. If true, it points up the image, against v, as in glTF and OpenGL. If false, it
    /// points down the image, as in Direct3D.
    pub green_up: bool,
    /// Whether to discard points outside the range of uv that the mesh covers.
    pub silhouette: bool,
    /// Whether to choose the mip level of the heights from the size of a pixel, once per fragment.
    pub choose_mip: bool,
}

impl Default for Constants {
    fn default() -> Self {
        Self {
            shadowed: false,
            own_depth: false,
            reversed: false,
            fade: 0,
            morphed: false,
            method: 3,
            shadow: 0,
            normal_map: false,
            green_up: true,
            silhouette: false,
            choose_mip: false,
        }
    }
}

impl Constants {
    /// Name and value of each.
    pub fn list(&self) -> Vec<(&'static str, f64)> {
        vec![
            ("relievo_SHADOWED", self.shadowed.into()),
            ("relievo_OWN_DEPTH", self.own_depth.into()),
            ("relievo_REVERSED", self.reversed.into()),
            ("relievo_FADE", self.fade.into()),
            ("relievo_MORPHED", self.morphed.into()),
            ("relievo_METHOD", self.method.into()),
            ("relievo_SHADOW", self.shadow.into()),
            ("relievo_NORMAL_MAP", self.normal_map.into()),
            ("relievo_GREEN_UP", self.green_up.into()),
            ("relievo_SILHOUETTE", self.silhouette.into()),
            ("relievo_CHOOSE_MIP", self.choose_mip.into()),
        ]
    }
}

/// The layouts of the bind groups of `render/scene_relief`.
///
/// # Errors
/// [`GpuError::Validation`] where the device's limits do not permit them.
pub fn layouts(gpu: &Gpu) -> Result<Layouts, GpuError> {
    Layouts::new(gpu, &shaders::RENDER_SCENE_RELIEF)
}

/// Resources of bind group 0 of `render/scene_relief`.
#[derive(Debug, Clone, Copy)]
pub struct Group<'a> {
    /// The view that is drawn.
    pub view: &'a Uniform<crate::shared::render::scene_view::SceneView>,
    /// Per instance of the scene, three rows: the transform from model space to positions relative to the corner of the view's cell.
    /// These transforms are valid for instances that the view sees. If the scene keeps its last frame, a second set follows: one
    /// transform per instance of the last frame, valid for meshes attached to bones.
    pub placements: Slice<'a, [[f32; 4]; 3]>,
    /// All instances of the scene.
    pub instances: Slice<'a, crate::shared::lod::instance::SceneInstance>,
    /// All instances in the state of the last frame. If the scene does not keep its last frame, this is the current state.
    pub last_instances: Slice<'a, crate::shared::lod::instance::SceneInstance>,
    /// Shadow map: distance along the light to the nearest caster. 0 is the sun's near plane; 1 means that there is no caster.
    pub shadow_map: &'a wgpu::TextureView,
    /// Comparison sampler: compares a distance with four texels, and filters the four results.
    pub shadow_sampler: &'a wgpu::Sampler,
    /// Per instance of the scene: the view's decision word in the last frame; 0 if the view did not see the instance in that frame.
    pub last_decisions: Slice<'a, u32>,
}

impl Group<'_> {
    /// Binds them.
    ///
    /// # Errors
    /// [`GpuError::Validation`] where the device refuses one.
    pub fn bind(&self, gpu: &Gpu, layouts: &Layouts) -> Result<BindGroup, GpuError> {
        layouts.bind_group(gpu, &shaders::RENDER_SCENE_RELIEF, 0, &[
            (0, self.view.raw().as_entire_binding()),
            (1, self.placements.resource()),
            (2, self.instances.resource()),
            (3, self.last_instances.resource()),
            (4, wgpu::BindingResource::TextureView(self.shadow_map)),
            (5, wgpu::BindingResource::Sampler(self.shadow_sampler)),
            (6, self.last_decisions.resource()),
        ])
    }
}

/// Resources of bind group 1 of `render/scene_relief`.
#[derive(Debug, Clone, Copy)]
pub struct Group1<'a> {
    /// The chunk that is drawn.
    pub scene_object: &'a Uniform<crate::shared::render::scene_instances::SceneObject>,
    /// Vertices, five pairs of floats each: position, normal and tangent.
    pub vertices: Slice<'a, [f32; 2]>,
    /// Texture coordinates, one pair per vertex of the mesh.
    pub texture_coordinates: Slice<'a, [f32; 2]>,
    /// Two tables with one entry per vertex of the mesh. The first table, from 0, has the index of the vertex's material in the
    /// part's table. The second table, from `MeshParams.partners`, has partner words.
    pub material_of: Slice<'a, u32>,
    /// Page of each cluster of each instance of the object, if vertices lie in pages.
    pub page_table: Slice<'a, u32>,
    /// Location of the mesh's vertex data.
    pub mesh: &'a Uniform<crate::shared::render::scene_vertex::MeshParams>,
}

impl Group1<'_> {
    /// Binds them.
    ///
    /// # Errors
    /// [`GpuError::Validation`] where the device refuses one.
    pub fn bind(&self, gpu: &Gpu, layouts: &Layouts) -> Result<BindGroup, GpuError> {
        layouts.bind_group(gpu, &shaders::RENDER_SCENE_RELIEF, 1, &[
            (0, self.scene_object.raw().as_entire_binding()),
            (1, self.vertices.resource()),
            (2, self.texture_coordinates.resource()),
            (3, self.material_of.resource()),
            (4, self.page_table.resource()),
            (5, self.mesh.raw().as_entire_binding()),
        ])
    }
}

/// Resources of bind group 2 of `render/scene_relief`.
#[derive(Debug, Clone, Copy)]
pub struct Group2<'a> {
    /// Parameters of the relief.
    pub relief: &'a Uniform<crate::shared::render::scene_relief::ReliefParams>,
    /// Parameters of the ray march.
    pub march: &'a Uniform<crate::shared::surface::ray::SurfaceMarch>,
    /// Height map: the red channel is the height, 0 to 1.
    pub heights: &'a wgpu::TextureView,
    /// Acceleration map of the tracing method. Methods without an acceleration map accept any texture.
    pub acceleration: &'a wgpu::TextureView,
    /// Colour texture.
    pub albedo: &'a wgpu::TextureView,
    /// Normal map. Any texture may be bound if `NORMAL_MAP` is false.
    pub normals: &'a wgpu::TextureView,
    /// Sampler of the colour texture.
    pub filtering: &'a wgpu::Sampler,
    /// Sampler of the normal map.
    pub normal_filtering: &'a wgpu::Sampler,
}

impl Group2<'_> {
    /// Binds them.
    ///
    /// # Errors
    /// [`GpuError::Validation`] where the device refuses one.
    pub fn bind(&self, gpu: &Gpu, layouts: &Layouts) -> Result<BindGroup, GpuError> {
        layouts.bind_group(gpu, &shaders::RENDER_SCENE_RELIEF, 2, &[
            (0, self.relief.raw().as_entire_binding()),
            (1, self.march.raw().as_entire_binding()),
            (2, wgpu::BindingResource::TextureView(self.heights)),
            (3, wgpu::BindingResource::TextureView(self.acceleration)),
            (4, wgpu::BindingResource::TextureView(self.albedo)),
            (5, wgpu::BindingResource::TextureView(self.normals)),
            (6, wgpu::BindingResource::Sampler(self.filtering)),
            (7, wgpu::BindingResource::Sampler(self.normal_filtering)),
        ])
    }
}

}
/// Of `render/scene_terrain.wgsl`.
pub mod scene_terrain {
use crate::gpu::bind::prelude::*;

/// Override constants of `render/scene_terrain`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Constants {
    /// Whether the shadow map shadows surfaces.
    pub shadowed: bool,
    /// Method by which list entries with fade words are drawn: one of the constants below. The renderer sets it for lists of
    /// instances that fade.
    pub fade: u32,
    /// Whether to draw a wireframe: triangle edges on unlit, dark ground.
    pub wireframe: bool,
}

impl Default for Constants {
    fn default() -> Self {
        Self {
            shadowed: false,
            fade: 0,
            wireframe: false,
        }
    }
}

impl Constants {
    /// Name and value of each.
    pub fn list(&self) -> Vec<(&'static str, f64)> {
        vec![
            ("relievo_SHADOWED", self.shadowed.into()),
            ("relievo_FADE", self.fade.into()),
            ("relievo_WIREFRAME", self.wireframe.into()),
        ]
    }
}

/// The layouts of the bind groups of `render/scene_terrain`.
///
/// # Errors
/// [`GpuError::Validation`] where the device's limits do not permit them.
pub fn layouts(gpu: &Gpu) -> Result<Layouts, GpuError> {
    Layouts::new(gpu, &shaders::RENDER_SCENE_TERRAIN)
}

/// Resources of bind group 0 of `render/scene_terrain`.
#[derive(Debug, Clone, Copy)]
pub struct Group<'a> {
    /// The view that is drawn.
    pub view: &'a Uniform<crate::shared::render::scene_view::SceneView>,
    /// Shadow map: distance along the light to the nearest caster. 0 is the sun's near plane; 1 means that there is no caster.
    pub shadow_map: &'a wgpu::TextureView,
    /// Comparison sampler: compares a distance with four texels, and filters the four results.
    pub shadow_sampler: &'a wgpu::Sampler,
}

impl Group<'_> {
    /// Binds them.
    ///
    /// # Errors
    /// [`GpuError::Validation`] where the device refuses one.
    pub fn bind(&self, gpu: &Gpu, layouts: &Layouts) -> Result<BindGroup, GpuError> {
        layouts.bind_group(gpu, &shaders::RENDER_SCENE_TERRAIN, 0, &[
            (0, self.view.raw().as_entire_binding()),
            (4, wgpu::BindingResource::TextureView(self.shadow_map)),
            (5, wgpu::BindingResource::Sampler(self.shadow_sampler)),
        ])
    }
}

/// Resources of bind group 1 of `render/scene_terrain`.
#[derive(Debug, Clone, Copy)]
pub struct Group1<'a> {
    /// Placement of the terrain in the view.
    pub ground: &'a Uniform<crate::shared::render::scene_terrain::TerrainView>,
    /// How each patch is drawn in the view. Read only if the terrain is endless.
    pub nodes: Slice<'a, crate::shared::render::scene_terrain::TerrainNode>,
}

impl Group1<'_> {
    /// Binds them.
    ///
    /// # Errors
    /// [`GpuError::Validation`] where the device refuses one.
    pub fn bind(&self, gpu: &Gpu, layouts: &Layouts) -> Result<BindGroup, GpuError> {
        layouts.bind_group(gpu, &shaders::RENDER_SCENE_TERRAIN, 1, &[
            (0, self.ground.raw().as_entire_binding()),
            (1, self.nodes.resource()),
        ])
    }
}

/// Resources of bind group 2 of `render/scene_terrain`.
#[derive(Debug, Clone, Copy)]
pub struct Group2<'a> {
    /// Parameters of the terrain's patches.
    pub terrain: &'a Uniform<crate::shared::render::scene_terrain::TerrainParams>,
    /// Heights of all windows, row by row, in 1/65536 world units.
    pub heights: Slice<'a, i32>,
    /// The patch of each instance.
    pub patches: Slice<'a, crate::shared::render::scene_terrain::TerrainPatch>,
    /// Zones of the ground.
    pub zones: Slice<'a, crate::shared::terrain::zones::Zone>,
    /// Textures of the zones, one layer per zone.
    pub textures: &'a wgpu::TextureView,
    /// Sampler of the zone textures.
    pub texture_sampler: &'a wgpu::Sampler,
    /// One bit per vertex of a patch with holes, row by row, from a whole word on: whether triangles at this vertex are left out.
    pub holes: Slice<'a, u32>,
    /// Normals of all nodes but those of level 0, row by row: x in the low half of a word and z in the high half.
    pub normals: Slice<'a, u32>,
}

impl Group2<'_> {
    /// Binds them.
    ///
    /// # Errors
    /// [`GpuError::Validation`] where the device refuses one.
    pub fn bind(&self, gpu: &Gpu, layouts: &Layouts) -> Result<BindGroup, GpuError> {
        layouts.bind_group(gpu, &shaders::RENDER_SCENE_TERRAIN, 2, &[
            (0, self.terrain.raw().as_entire_binding()),
            (1, self.heights.resource()),
            (2, self.patches.resource()),
            (3, self.zones.resource()),
            (4, wgpu::BindingResource::TextureView(self.textures)),
            (5, wgpu::BindingResource::Sampler(self.texture_sampler)),
            (6, self.holes.resource()),
            (7, self.normals.resource()),
        ])
    }
}

}
}
/// Of `skinning/`.
pub mod skinning {
/// Of `skinning/morph.wgsl`.
pub mod morph {
use crate::gpu::bind::prelude::*;

/// Override constants of `skinning/morph`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Constants {
    /// Whether the output lies in pages. If so, clusters without a page are skipped.
    pub paged: bool,
}

impl Default for Constants {
    fn default() -> Self {
        Self {
            paged: false,
        }
    }
}

impl Constants {
    /// Name and value of each.
    pub fn list(&self) -> Vec<(&'static str, f64)> {
        vec![
            ("PAGED", self.paged.into()),
        ]
    }
}

/// The kernel `skinning/morph`, compiled.
///
/// # Errors
/// What the driver's compiler reports.
pub fn kernel(gpu: &Gpu, constants: &Constants) -> Result<Kernel, GpuError> {
    Kernel::new(gpu, &shaders::SKINNING_MORPH, &constants.list())
}

/// Resources of bind group 0 of `skinning/morph`.
#[derive(Debug, Clone, Copy)]
pub struct Group<'a> {
    /// Parameters of the kernel.
    pub params: &'a Uniform<crate::shared::skinning::morph::MorphParams>,
    /// Vertices of the mesh, five pairs of floats each.
    pub vertices: Slice<'a, [f32; 2]>,
    /// Index of each vertex's first delta. The last element is the number of deltas.
    pub offsets: Slice<'a, u32>,
    /// Three vectors per delta: position (xyz) with the target as bits (w); normal; tangent.
    pub deltas: Slice<'a, [f32; 4]>,
    /// Weights of the targets, instance by instance.
    pub weights: Slice<'a, f32>,
    /// Selection of the clusters to morph. With PAGED, it is the page of each cluster of each instance; otherwise, the words of each
    /// instance's `InstanceLod`.
    pub seen: Slice<'a, u32>,
    /// Pairs of cluster and instance to be skinned: cluster * instances + instance.
    pub pairs: Slice<'a, u32>,
    /// Numbers of workgroups of the dispatch (xyz), and the number of pairs (w).
    pub dispatched: Slice<'a, [u32; 4]>,
    /// Out: morphed vertices in the layout of `vertices`, instance by instance or page by page.
    pub morphed: Slice<'a, [f32; 2]>,
}

impl Group<'_> {
    /// Binds them.
    ///
    /// # Errors
    /// [`GpuError::Validation`] where the device refuses one.
    pub fn bind(&self, gpu: &Gpu, kernel: &Kernel) -> Result<BindGroup, GpuError> {
        kernel.layouts.bind_group(gpu, &shaders::SKINNING_MORPH, 0, &[
            (0, self.params.raw().as_entire_binding()),
            (1, self.vertices.resource()),
            (2, self.offsets.resource()),
            (3, self.deltas.resource()),
            (4, self.weights.resource()),
            (5, self.seen.resource()),
            (6, self.pairs.resource()),
            (7, self.dispatched.resource()),
            (8, self.morphed.resource()),
        ])
    }
}

}
/// Of `skinning/morph_weights.wgsl`.
pub mod morph_weights {
use crate::gpu::bind::prelude::*;

/// The kernel `skinning/morph_weights`, compiled.
///
/// # Errors
/// What the driver's compiler reports.
pub fn kernel(gpu: &Gpu) -> Result<Kernel, GpuError> {
    Kernel::new(gpu, &shaders::SKINNING_MORPH_WEIGHTS, &[])
}

/// Resources of bind group 0 of `skinning/morph_weights`.
#[derive(Debug, Clone, Copy)]
pub struct Group<'a> {
    /// Parameters of the kernel.
    pub params: &'a Uniform<crate::shared::skinning::morph_weights::MorphWeightsParams>,
    /// Clip and playback of each instance.
    pub instances: Slice<'a, crate::shared::animation::instance::AnimationInstance>,
    /// Location of each clip's morph weights.
    pub entries: Slice<'a, crate::shared::skinning::morph_weights::WeightEntry>,
    /// Level of detail of each instance, which tells whether the instance is visible.
    pub instance_lods: Slice<'a, crate::shared::skinning::instance_lod::InstanceLod>,
    /// Key times of all timelines, in seconds.
    pub times: Slice<'a, f32>,
    /// Values of the keys of all clips, key by key, one value per target.
    pub values: Slice<'a, f32>,
    /// Out: weights of the targets, instance by instance.
    pub weights: Slice<'a, f32>,
}

impl Group<'_> {
    /// Binds them.
    ///
    /// # Errors
    /// [`GpuError::Validation`] where the device refuses one.
    pub fn bind(&self, gpu: &Gpu, kernel: &Kernel) -> Result<BindGroup, GpuError> {
        kernel.layouts.bind_group(gpu, &shaders::SKINNING_MORPH_WEIGHTS, 0, &[
            (0, self.params.raw().as_entire_binding()),
            (1, self.instances.resource()),
            (2, self.entries.resource()),
            (3, self.instance_lods.resource()),
            (4, self.times.resource()),
            (5, self.values.resource()),
            (6, self.weights.resource()),
        ])
    }
}

}
/// Of `skinning/pages.wgsl`.
pub mod pages {
use crate::gpu::bind::prelude::*;

/// The kernel `skinning/pages`, compiled.
///
/// # Errors
/// What the driver's compiler reports.
pub fn kernel(gpu: &Gpu) -> Result<Kernel, GpuError> {
    Kernel::new(gpu, &shaders::SKINNING_PAGES, &[])
}

/// Resources of bind group 0 of `skinning/pages`.
#[derive(Debug, Clone, Copy)]
pub struct Group<'a> {
    /// Parameters of the kernel.
    pub params: &'a Uniform<crate::shared::skinning::pages::PageParams>,
    /// Level of detail of each instance.
    pub instance_lods: Slice<'a, crate::shared::skinning::instance_lod::InstanceLod>,
    /// Number of clusters of each instance that have a page, counted from the first cluster.
    pub held: Slice<'a, u32>,
    /// Page of each cluster of each instance, or `NO_PAGE`.
    pub table: Slice<'a, u32>,
    /// Stack of the indices of free pages. The last one is handed out first.
    pub stack: Slice<'a, u32>,
    /// State of the page assignment.
    pub state: Slice<'a, crate::shared::skinning::pages::PageState>,
}

impl Group<'_> {
    /// Binds them.
    ///
    /// # Errors
    /// [`GpuError::Validation`] where the device refuses one.
    pub fn bind(&self, gpu: &Gpu, kernel: &Kernel) -> Result<BindGroup, GpuError> {
        kernel.layouts.bind_group(gpu, &shaders::SKINNING_PAGES, 0, &[
            (0, self.params.raw().as_entire_binding()),
            (1, self.instance_lods.resource()),
            (2, self.held.resource()),
            (3, self.table.resource()),
            (4, self.stack.resource()),
            (5, self.state.resource()),
        ])
    }
}

}
/// Of `skinning/palette.wgsl`.
pub mod palette {
use crate::gpu::bind::prelude::*;

/// Override constants of `skinning/palette`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Constants {
    /// Whether palettes hold dual quaternions and stretches instead of matrices.
    pub dual: bool,
}

impl Default for Constants {
    fn default() -> Self {
        Self {
            dual: false,
        }
    }
}

impl Constants {
    /// Name and value of each.
    pub fn list(&self) -> Vec<(&'static str, f64)> {
        vec![
            ("DUAL", self.dual.into()),
        ]
    }
}

/// The kernel `skinning/palette`, compiled.
///
/// # Errors
/// What the driver's compiler reports.
pub fn kernel(gpu: &Gpu, constants: &Constants) -> Result<Kernel, GpuError> {
    Kernel::new(gpu, &shaders::SKINNING_PALETTE, &constants.list())
}

/// Resources of bind group 0 of `skinning/palette`.
#[derive(Debug, Clone, Copy)]
pub struct Group<'a> {
    /// Parameters of the kernel.
    pub params: &'a Uniform<crate::shared::skinning::palette::PaletteParams>,
    /// Bone word of each bone of the skin: its index in the skeleton, and the tier of the skeleton that it belongs to.
    /// packed SkinBone: index 24, tier 8
    pub bones: Slice<'a, u32>,
    /// Inverse bind matrices: three rows per bone of the skin.
    pub inverse_binds: Slice<'a, [f32; 4]>,
    /// Model matrices: three rows per bone of the skeleton and instance.
    pub model_matrices: Slice<'a, [f32; 4]>,
    /// Level of detail of each instance.
    pub instance_lods: Slice<'a, crate::shared::skinning::instance_lod::InstanceLod>,
    /// Out: three rows per bone of the skin and instance. With DUAL, four vectors: the rotation, the dual part, the diagonal of the
    /// stretch, and the elements of the stretch above the diagonal.
    pub palette: Slice<'a, [f32; 4]>,
}

impl Group<'_> {
    /// Binds them.
    ///
    /// # Errors
    /// [`GpuError::Validation`] where the device refuses one.
    pub fn bind(&self, gpu: &Gpu, kernel: &Kernel) -> Result<BindGroup, GpuError> {
        kernel.layouts.bind_group(gpu, &shaders::SKINNING_PALETTE, 0, &[
            (0, self.params.raw().as_entire_binding()),
            (1, self.bones.resource()),
            (2, self.inverse_binds.resource()),
            (3, self.model_matrices.resource()),
            (4, self.instance_lods.resource()),
            (5, self.palette.resource()),
        ])
    }
}

}
/// Of `skinning/select.wgsl`.
pub mod select {
use crate::gpu::bind::prelude::*;

/// Override constants of `skinning/select`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Constants {
    /// Whether the dispatch stores the instances' state for the next frame, instead of selecting clusters.
    pub finish: bool,
    /// With FINISH, whether the updated bones are cleared.
    pub clear: bool,
    /// Whether the positions of the last frame are kept.
    pub keep: bool,
}

impl Default for Constants {
    fn default() -> Self {
        Self {
            finish: false,
            clear: false,
            keep: false,
        }
    }
}

impl Constants {
    /// Name and value of each.
    pub fn list(&self) -> Vec<(&'static str, f64)> {
        vec![
            ("FINISH", self.finish.into()),
            ("CLEAR", self.clear.into()),
            ("KEEP", self.keep.into()),
        ]
    }
}

/// The kernel `skinning/select`, compiled.
///
/// # Errors
/// What the driver's compiler reports.
pub fn kernel(gpu: &Gpu, constants: &Constants) -> Result<Kernel, GpuError> {
    Kernel::new(gpu, &shaders::SKINNING_SELECT, &constants.list())
}

/// Resources of bind group 0 of `skinning/select`.
#[derive(Debug, Clone, Copy)]
pub struct Group<'a> {
    /// Parameters of the kernel.
    pub params: &'a Uniform<crate::shared::skinning::select::SelectParams>,
    /// Bone set of each cluster, one bit per bone, for one skeleton tier after the other.
    pub masks: Slice<'a, u32>,
    /// Set of updated bones of each instance, one bit per bone.
    pub updated_bones: Slice<'a, u32>,
    /// Level of detail of each instance.
    pub instance_lods: Slice<'a, crate::shared::skinning::instance_lod::InstanceLod>,
    /// Weights of the targets as bits, instance by instance.
    pub weights: Slice<'a, u32>,
    /// Index of each vertex's first delta. The last element is the number of deltas.
    pub offsets: Slice<'a, u32>,
    /// State of each instance after the last frame: its InstanceLod, the number of frames for which it has been visible (at most 2),
    /// and its weights.
    pub skinned: Slice<'a, u32>,
    /// Out: pairs to be skinned, cluster * instances + instance. With KEEP, the state of every pair follows: `CLUSTER_STILL`,
    /// `CLUSTER_MOVED` or `CLUSTER_FRESH`.
    pub pairs: Slice<'a, u32>,
    /// Arguments of the skinning dispatch.
    pub dispatched: Slice<'a, crate::shared::skinning::select::Dispatched>,
}

impl Group<'_> {
    /// Binds them.
    ///
    /// # Errors
    /// [`GpuError::Validation`] where the device refuses one.
    pub fn bind(&self, gpu: &Gpu, kernel: &Kernel) -> Result<BindGroup, GpuError> {
        kernel.layouts.bind_group(gpu, &shaders::SKINNING_SELECT, 0, &[
            (0, self.params.raw().as_entire_binding()),
            (1, self.masks.resource()),
            (2, self.updated_bones.resource()),
            (3, self.instance_lods.resource()),
            (4, self.weights.resource()),
            (5, self.offsets.resource()),
            (6, self.skinned.resource()),
            (7, self.pairs.resource()),
            (8, self.dispatched.resource()),
        ])
    }
}

}
/// Of `skinning/skin.wgsl`.
pub mod skin {
use crate::gpu::bind::prelude::*;

/// Override constants of `skinning/skin`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Constants {
    /// Whether the palette holds dual quaternions and stretches instead of matrices.
    pub dual: bool,
    /// Whether each instance has morphed vertices of its own, in the layout of the output. If false, all instances use the mesh's
    /// vertices.
    pub morphed: bool,
    /// Whether the output lies in pages. If so, clusters without a page are skipped.
    pub paged: bool,
    /// Whether the positions of the last frame are kept; only with PAGED.
    pub keep: bool,
}

impl Default for Constants {
    fn default() -> Self {
        Self {
            dual: false,
            morphed: false,
            paged: false,
            keep: false,
        }
    }
}

impl Constants {
    /// Name and value of each.
    pub fn list(&self) -> Vec<(&'static str, f64)> {
        vec![
            ("DUAL", self.dual.into()),
            ("MORPHED", self.morphed.into()),
            ("PAGED", self.paged.into()),
            ("KEEP", self.keep.into()),
        ]
    }
}

/// The kernel `skinning/skin`, compiled.
///
/// # Errors
/// What the driver's compiler reports.
pub fn kernel(gpu: &Gpu, constants: &Constants) -> Result<Kernel, GpuError> {
    Kernel::new(gpu, &shaders::SKINNING_SKIN, &constants.list())
}

/// Resources of bind group 0 of `skinning/skin`.
#[derive(Debug, Clone, Copy)]
pub struct Group<'a> {
    /// Parameters of the kernel.
    pub params: &'a Uniform<crate::shared::skinning::skin::SkinParams>,
    /// Vertices, five pairs of floats each: position, normal, tangent and handedness.
    pub vertices: Slice<'a, [f32; 2]>,
    /// Two words per cluster, for one skeleton tier after the other: the index of its influences, and the largest number of influences
    /// per vertex. Influences are columns
    /// of CLUSTER words: first the bones, two per word, then the weights of all but the strongest bone, in descending order.
    pub influences: Slice<'a, u32>,
    /// Three rows per bone and instance. With DUAL, four vectors per bone and instance.
    pub palette: Slice<'a, [f32; 4]>,
    /// Level of detail of each instance.
    pub instance_lods: Slice<'a, crate::shared::skinning::instance_lod::InstanceLod>,
    /// Pairs to be skinned: cluster * instances + instance. With KEEP, the state of every pair follows, as written by
    /// skinning/select.
    pub pairs: Slice<'a, u32>,
    /// Numbers of workgroups of the dispatch (xyz), and the number of pairs (w).
    pub dispatched: Slice<'a, [u32; 4]>,
    /// Out: skinned vertices in the layout of `vertices`, instance by instance or page by page. With KEEP, the last positions
    /// follow, two pairs per vertex; the fourth number is unused.
    pub skinned: Slice<'a, [f32; 2]>,
    /// Page of each cluster of each instance, with PAGED.
    pub page_table: Slice<'a, u32>,
}

impl Group<'_> {
    /// Binds them.
    ///
    /// # Errors
    /// [`GpuError::Validation`] where the device refuses one.
    pub fn bind(&self, gpu: &Gpu, kernel: &Kernel) -> Result<BindGroup, GpuError> {
        kernel.layouts.bind_group(gpu, &shaders::SKINNING_SKIN, 0, &[
            (0, self.params.raw().as_entire_binding()),
            (1, self.vertices.resource()),
            (2, self.influences.resource()),
            (3, self.palette.resource()),
            (4, self.instance_lods.resource()),
            (5, self.pairs.resource()),
            (6, self.dispatched.resource()),
            (7, self.skinned.resource()),
            (8, self.page_table.resource()),
        ])
    }
}

}
}
/// Of `surface/`.
pub mod surface {
/// Of `surface/cone_map.wgsl`.
pub mod cone_map {
use crate::gpu::bind::prelude::*;

/// The kernel `surface/cone_map`, compiled.
///
/// # Errors
/// What the driver's compiler reports.
pub fn kernel(gpu: &Gpu) -> Result<Kernel, GpuError> {
    Kernel::new(gpu, &shaders::SURFACE_CONE_MAP, &[])
}

/// Resources of bind group 0 of `surface/cone_map`.
#[derive(Debug, Clone, Copy)]
pub struct Group<'a> {
    /// Parameters of the kernel.
    pub params: &'a Uniform<crate::shared::surface::cone_map::ConeParams>,
    /// Heights of all maps, row by row, 0 to 1.
    pub heights: Slice<'a, f32>,
    /// Max-mip pyramids of all maps.
    pub pyramids: Slice<'a, f32>,
    /// Out, per cell: height of the highest corner (x), and radius of the cone in cells at height 1 above the corner (y).
    pub cones: Slice<'a, [f32; 2]>,
}

impl Group<'_> {
    /// Binds them.
    ///
    /// # Errors
    /// [`GpuError::Validation`] where the device refuses one.
    pub fn bind(&self, gpu: &Gpu, kernel: &Kernel) -> Result<BindGroup, GpuError> {
        kernel.layouts.bind_group(gpu, &shaders::SURFACE_CONE_MAP, 0, &[
            (0, self.params.raw().as_entire_binding()),
            (1, self.heights.resource()),
            (2, self.pyramids.resource()),
            (3, self.cones.resource()),
        ])
    }
}

}
/// Of `surface/height_pyramid.wgsl`.
pub mod height_pyramid {
use crate::gpu::bind::prelude::*;

/// The kernel `surface/height_pyramid`, compiled.
///
/// # Errors
/// What the driver's compiler reports.
pub fn kernel(gpu: &Gpu) -> Result<Kernel, GpuError> {
    Kernel::new(gpu, &shaders::SURFACE_HEIGHT_PYRAMID, &[])
}

/// Resources of bind group 0 of `surface/height_pyramid`.
#[derive(Debug, Clone, Copy)]
pub struct Group<'a> {
    /// Parameters of the kernel.
    pub params: &'a Uniform<crate::shared::surface::height_pyramid::PyramidParams>,
    /// Heights of all maps, row by row, 0 to 1.
    pub heights: Slice<'a, f32>,
    /// Max-mip pyramids of all maps.
    pub pyramids: Slice<'a, f32>,
}

impl Group<'_> {
    /// Binds them.
    ///
    /// # Errors
    /// [`GpuError::Validation`] where the device refuses one.
    pub fn bind(&self, gpu: &Gpu, kernel: &Kernel) -> Result<BindGroup, GpuError> {
        kernel.layouts.bind_group(gpu, &shaders::SURFACE_HEIGHT_PYRAMID, 0, &[
            (0, self.params.raw().as_entire_binding()),
            (1, self.heights.resource()),
            (2, self.pyramids.resource()),
        ])
    }
}

}
/// Of `surface/relief.wgsl`.
pub mod relief {
use crate::gpu::bind::prelude::*;

/// Override constants of `surface/relief`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Constants {
    /// Tracing method: one of the constants of wgsl/surface/trace.wgsl.
    pub method: u32,
}

impl Default for Constants {
    fn default() -> Self {
        Self {
            method: 0,
        }
    }
}

impl Constants {
    /// Name and value of each.
    pub fn list(&self) -> Vec<(&'static str, f64)> {
        vec![
            ("METHOD", self.method.into()),
        ]
    }
}

/// The kernel `surface/relief`, compiled.
///
/// # Errors
/// What the driver's compiler reports.
pub fn kernel(gpu: &Gpu, constants: &Constants) -> Result<Kernel, GpuError> {
    Kernel::new(gpu, &shaders::SURFACE_RELIEF, &constants.list())
}

/// Resources of bind group 0 of `surface/relief`.
#[derive(Debug, Clone, Copy)]
pub struct Group<'a> {
    /// Parameters of the ray march.
    pub march: &'a Uniform<crate::shared::surface::ray::SurfaceMarch>,
    /// Height map: the red channel is the height, 0 to 1.
    pub heights: &'a wgpu::TextureView,
    /// Acceleration map of the method. Methods without an acceleration map accept any texture.
    pub acceleration: &'a wgpu::TextureView,
    /// Rays to trace.
    pub rays: Slice<'a, crate::shared::surface::ray::SurfaceRay>,
    /// Out: hit of each ray.
    pub hits: Slice<'a, crate::shared::surface::ray::SurfaceHit>,
}

impl Group<'_> {
    /// Binds them.
    ///
    /// # Errors
    /// [`GpuError::Validation`] where the device refuses one.
    pub fn bind(&self, gpu: &Gpu, kernel: &Kernel) -> Result<BindGroup, GpuError> {
        kernel.layouts.bind_group(gpu, &shaders::SURFACE_RELIEF, 0, &[
            (0, self.march.raw().as_entire_binding()),
            (1, wgpu::BindingResource::TextureView(self.heights)),
            (2, wgpu::BindingResource::TextureView(self.acceleration)),
            (3, self.rays.resource()),
            (4, self.hits.resource()),
        ])
    }
}

}
/// Of `surface/shade.wgsl`.
pub mod shade {
use crate::gpu::bind::prelude::*;

/// Override constants of `surface/shade`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Constants {
    /// Tracing method of hard shadow: one of the constants of wgsl/surface/trace.wgsl.
    pub method: u32,
}

impl Default for Constants {
    fn default() -> Self {
        Self {
            method: 0,
        }
    }
}

impl Constants {
    /// Name and value of each.
    pub fn list(&self) -> Vec<(&'static str, f64)> {
        vec![
            ("METHOD", self.method.into()),
        ]
    }
}

/// The kernel `surface/shade`, compiled.
///
/// # Errors
/// What the driver's compiler reports.
pub fn kernel(gpu: &Gpu, constants: &Constants) -> Result<Kernel, GpuError> {
    Kernel::new(gpu, &shaders::SURFACE_SHADE, &constants.list())
}

/// Resources of bind group 0 of `surface/shade`.
#[derive(Debug, Clone, Copy)]
pub struct Group<'a> {
    /// View and shadow parameters.
    pub view: &'a Uniform<crate::shared::surface::shade::ShadeView>,
    /// Parameters of the ray march.
    pub march: &'a Uniform<crate::shared::surface::ray::SurfaceMarch>,
    /// Height map: the red channel is the height, 0 to 1.
    pub heights: &'a wgpu::TextureView,
    /// Acceleration map of the method. Methods without an acceleration map accept any texture.
    pub acceleration: &'a wgpu::TextureView,
    /// Points to shade.
    pub points: Slice<'a, crate::shared::surface::shade::ShadePoint>,
    /// Out: shading of each point.
    pub shades: Slice<'a, crate::shared::surface::shade::Shade>,
}

impl Group<'_> {
    /// Binds them.
    ///
    /// # Errors
    /// [`GpuError::Validation`] where the device refuses one.
    pub fn bind(&self, gpu: &Gpu, kernel: &Kernel) -> Result<BindGroup, GpuError> {
        kernel.layouts.bind_group(gpu, &shaders::SURFACE_SHADE, 0, &[
            (0, self.view.raw().as_entire_binding()),
            (1, self.march.raw().as_entire_binding()),
            (2, wgpu::BindingResource::TextureView(self.heights)),
            (3, wgpu::BindingResource::TextureView(self.acceleration)),
            (4, self.points.resource()),
            (5, self.shades.resource()),
        ])
    }
}

}
/// Of `surface/tangent.wgsl`.
pub mod tangent {
use crate::gpu::bind::prelude::*;

/// The kernel `surface/tangent`, compiled.
///
/// # Errors
/// What the driver's compiler reports.
pub fn kernel(gpu: &Gpu) -> Result<Kernel, GpuError> {
    Kernel::new(gpu, &shaders::SURFACE_TANGENT, &[])
}

/// Resources of bind group 0 of `surface/tangent`.
#[derive(Debug, Clone, Copy)]
pub struct Group<'a> {
    /// Parameters of the kernel.
    pub params: &'a Uniform<crate::shared::surface::tangent::TangentParams>,
    /// Positions, three floats per vertex.
    pub positions: Slice<'a, f32>,
    /// Normals, three words per vertex. They are read as bits, because normals may be infinite or NaN, and a shader may assume that
    /// floats are finite.
    pub normals: Slice<'a, u32>,
    /// Texture coordinates, two floats per vertex.
    pub texture_coordinates: Slice<'a, f32>,
    /// Indices of the triangles' vertices, three per triangle.
    pub indices: Slice<'a, u32>,
    /// Index in `corners` of each vertex's first corner. The last element is the number of corners.
    pub offsets: Slice<'a, u32>,
    /// Corners of each vertex, as positions in `indices`.
    pub corners: Slice<'a, u32>,
    /// Out: unit tangent of each vertex (xyz), and handedness w, 1 or -1.
    pub tangents: Slice<'a, [f32; 4]>,
}

impl Group<'_> {
    /// Binds them.
    ///
    /// # Errors
    /// [`GpuError::Validation`] where the device refuses one.
    pub fn bind(&self, gpu: &Gpu, kernel: &Kernel) -> Result<BindGroup, GpuError> {
        kernel.layouts.bind_group(gpu, &shaders::SURFACE_TANGENT, 0, &[
            (0, self.params.raw().as_entire_binding()),
            (1, self.positions.resource()),
            (2, self.normals.resource()),
            (3, self.texture_coordinates.resource()),
            (4, self.indices.resource()),
            (5, self.offsets.resource()),
            (6, self.corners.resource()),
            (7, self.tangents.resource()),
        ])
    }
}

}
}
/// Of `terrain/`.
pub mod terrain {
/// Of `terrain/blend.wgsl`.
pub mod blend {
use crate::gpu::bind::prelude::*;

/// The kernel `terrain/blend`, compiled.
///
/// # Errors
/// What the driver's compiler reports.
pub fn kernel(gpu: &Gpu) -> Result<Kernel, GpuError> {
    Kernel::new(gpu, &shaders::TERRAIN_BLEND, &[])
}

/// Resources of bind group 0 of `terrain/blend`.
#[derive(Debug, Clone, Copy)]
pub struct Group<'a> {
    /// Parameters of the kernel.
    pub params: &'a Uniform<crate::shared::terrain::blend::MapParams>,
    /// Heights of all windows, row by row, in 1/65536 units.
    pub windows: Slice<'a, i32>,
    /// Zones of the ground and their textures.
    pub zones: Slice<'a, crate::shared::terrain::tiles::MapZone>,
    /// Texels of all textures: linear colour and height, 16 bits each.
    pub texels: Slice<'a, [u32; 2]>,
    /// Position of the first pixel of each map, in 2^-22 tiles.
    pub places: Slice<'a, [u32; 2]>,
    /// Out: sRGB pixels, RGBA with 8 bits each, red in the lowest byte.
    pub pixels: Slice<'a, u32>,
}

impl Group<'_> {
    /// Binds them.
    ///
    /// # Errors
    /// [`GpuError::Validation`] where the device refuses one.
    pub fn bind(&self, gpu: &Gpu, kernel: &Kernel) -> Result<BindGroup, GpuError> {
        kernel.layouts.bind_group(gpu, &shaders::TERRAIN_BLEND, 0, &[
            (0, self.params.raw().as_entire_binding()),
            (1, self.windows.resource()),
            (2, self.zones.resource()),
            (3, self.texels.resource()),
            (4, self.places.resource()),
            (5, self.pixels.resource()),
        ])
    }
}

}
/// Of `terrain/border.wgsl`.
pub mod border {
use crate::gpu::bind::prelude::*;

/// Override constants of `terrain/border`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Constants {
    /// Whether the neighbours lie in `others`, a separate buffer of patches, instead of `heights`.
    pub others: bool,
}

impl Default for Constants {
    fn default() -> Self {
        Self {
            others: false,
        }
    }
}

impl Constants {
    /// Name and value of each.
    pub fn list(&self) -> Vec<(&'static str, f64)> {
        vec![
            ("OTHERS", self.others.into()),
        ]
    }
}

/// The kernel `terrain/border`, compiled.
///
/// # Errors
/// What the driver's compiler reports.
pub fn kernel(gpu: &Gpu, constants: &Constants) -> Result<Kernel, GpuError> {
    Kernel::new(gpu, &shaders::TERRAIN_BORDER, &constants.list())
}

/// Resources of bind group 0 of `terrain/border`.
#[derive(Debug, Clone, Copy)]
pub struct Group<'a> {
    /// Parameters of the kernel.
    pub params: &'a Uniform<crate::shared::terrain::border::BorderParams>,
    /// Heights of all patches, row by row, in 1/65536 units.
    pub heights: Slice<'a, i32>,
    /// Per entry of `order`: the index of the patch to the left (x), to the right (y), above (z) and below (w). With `NONE`, the
    /// samples at this border do not move.
    pub neighbours: Slice<'a, [u32; 4]>,
    /// Indices of patches, dispatch by dispatch. The patches of one dispatch do not depend on each other.
    pub order: Slice<'a, u32>,
    /// Heights of the patches in the separate buffer, used with OTHERS.
    pub others: Slice<'a, i32>,
}

impl Group<'_> {
    /// Binds them.
    ///
    /// # Errors
    /// [`GpuError::Validation`] where the device refuses one.
    pub fn bind(&self, gpu: &Gpu, kernel: &Kernel) -> Result<BindGroup, GpuError> {
        kernel.layouts.bind_group(gpu, &shaders::TERRAIN_BORDER, 0, &[
            (0, self.params.raw().as_entire_binding()),
            (1, self.heights.resource()),
            (2, self.neighbours.resource()),
            (3, self.order.resource()),
            (4, self.others.resource()),
        ])
    }
}

}
/// Of `terrain/despike.wgsl`.
pub mod despike {
use crate::gpu::bind::prelude::*;

/// Override constants of `terrain/despike`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Constants {
    /// Feature mode: one of the constants above.
    pub features: u32,
}

impl Default for Constants {
    fn default() -> Self {
        Self {
            features: 0,
        }
    }
}

impl Constants {
    /// Name and value of each.
    pub fn list(&self) -> Vec<(&'static str, f64)> {
        vec![
            ("FEATURES", self.features.into()),
        ]
    }
}

/// The kernel `terrain/despike`, compiled.
///
/// # Errors
/// What the driver's compiler reports.
pub fn kernel(gpu: &Gpu, constants: &Constants) -> Result<Kernel, GpuError> {
    Kernel::new(gpu, &shaders::TERRAIN_DESPIKE, &constants.list())
}

/// Resources of bind group 0 of `terrain/despike`.
#[derive(Debug, Clone, Copy)]
pub struct Group<'a> {
    /// Parameters of the kernel.
    pub params: &'a Uniform<crate::shared::terrain::despike::DespikeParams>,
    /// Heights of all windows, row by row, in 1/65536 units.
    pub windows: Slice<'a, i32>,
    /// Out: heights of the inner samples of all windows, in 1/65536 units.
    pub outputs: Slice<'a, i32>,
}

impl Group<'_> {
    /// Binds them.
    ///
    /// # Errors
    /// [`GpuError::Validation`] where the device refuses one.
    pub fn bind(&self, gpu: &Gpu, kernel: &Kernel) -> Result<BindGroup, GpuError> {
        kernel.layouts.bind_group(gpu, &shaders::TERRAIN_DESPIKE, 0, &[
            (0, self.params.raw().as_entire_binding()),
            (1, self.windows.resource()),
            (2, self.outputs.resource()),
        ])
    }
}

/// Resources of bind group 1 of `terrain/despike`.
#[derive(Debug, Clone, Copy)]
pub struct Group1<'a> {
    /// Words of all feature grids.
    pub feature_words: Slice<'a, crate::shared::terrain::features::FeatureWord>,
    /// Heights of the features, in 1/65536 world units.
    pub feature_heights: Slice<'a, i32>,
}

impl Group1<'_> {
    /// Binds them.
    ///
    /// # Errors
    /// [`GpuError::Validation`] where the device refuses one.
    pub fn bind(&self, gpu: &Gpu, kernel: &Kernel) -> Result<BindGroup, GpuError> {
        kernel.layouts.bind_group(gpu, &shaders::TERRAIN_DESPIKE, 1, &[
            (0, self.feature_words.resource()),
            (1, self.feature_heights.resource()),
        ])
    }
}

}
/// Of `terrain/height.wgsl`.
pub mod height {
use crate::gpu::bind::prelude::*;

/// Override constants of `terrain/height`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Constants {
    /// Feature mode: one of the constants above.
    pub features: u32,
    /// Distribution of the random offsets: one of the constants OFFSET_*.
    pub distribution: u32,
}

impl Default for Constants {
    fn default() -> Self {
        Self {
            features: 0,
            distribution: 0,
        }
    }
}

impl Constants {
    /// Name and value of each.
    pub fn list(&self) -> Vec<(&'static str, f64)> {
        vec![
            ("FEATURES", self.features.into()),
            ("DISTRIBUTION", self.distribution.into()),
        ]
    }
}

/// The kernel `terrain/height`, compiled.
///
/// # Errors
/// What the driver's compiler reports.
pub fn kernel(gpu: &Gpu, constants: &Constants) -> Result<Kernel, GpuError> {
    Kernel::new(gpu, &shaders::TERRAIN_HEIGHT, &constants.list())
}

/// Resources of bind group 0 of `terrain/height`.
#[derive(Debug, Clone, Copy)]
pub struct Group<'a> {
    /// Parameters of the level.
    pub level: &'a Uniform<crate::shared::terrain::level::Level>,
    /// World coordinates of the first fine point of each window, in multiples of the spacing.
    pub origins: Slice<'a, [i32; 2]>,
    /// Heights of the coarse points of all windows, row by row, in 1/65536 units.
    pub coarse: Slice<'a, i32>,
    /// Out: heights of the fine points of all windows, row by row, in 1/65536 units.
    pub fine: Slice<'a, i32>,
}

impl Group<'_> {
    /// Binds them.
    ///
    /// # Errors
    /// [`GpuError::Validation`] where the device refuses one.
    pub fn bind(&self, gpu: &Gpu, kernel: &Kernel) -> Result<BindGroup, GpuError> {
        kernel.layouts.bind_group(gpu, &shaders::TERRAIN_HEIGHT, 0, &[
            (0, self.level.raw().as_entire_binding()),
            (1, self.origins.resource()),
            (2, self.coarse.resource()),
            (3, self.fine.resource()),
        ])
    }
}

/// Resources of bind group 1 of `terrain/height`.
#[derive(Debug, Clone, Copy)]
pub struct Group1<'a> {
    /// Words of all feature grids.
    pub feature_words: Slice<'a, crate::shared::terrain::features::FeatureWord>,
    /// Heights of the features, in 1/65536 world units.
    pub feature_heights: Slice<'a, i32>,
}

impl Group1<'_> {
    /// Binds them.
    ///
    /// # Errors
    /// [`GpuError::Validation`] where the device refuses one.
    pub fn bind(&self, gpu: &Gpu, kernel: &Kernel) -> Result<BindGroup, GpuError> {
        kernel.layouts.bind_group(gpu, &shaders::TERRAIN_HEIGHT, 1, &[
            (0, self.feature_words.resource()),
            (1, self.feature_heights.resource()),
        ])
    }
}

}
/// Of `terrain/hydraulic.wgsl`.
pub mod hydraulic {
use crate::gpu::bind::prelude::*;

/// The kernel `terrain/hydraulic`, compiled.
///
/// # Errors
/// What the driver's compiler reports.
pub fn kernel(gpu: &Gpu) -> Result<Kernel, GpuError> {
    Kernel::new(gpu, &shaders::TERRAIN_HYDRAULIC, &[])
}

/// Resources of bind group 0 of `terrain/hydraulic`.
#[derive(Debug, Clone, Copy)]
pub struct Group<'a> {
    /// Parameters of the kernel.
    pub params: &'a Uniform<crate::shared::terrain::hydraulic::HydraulicParams>,
    /// Heights of all windows, row by row, in 1/65536 units.
    pub windows: Slice<'a, i32>,
    /// Out: heights of the ground at the inner samples of all windows, in 1/65536 units.
    pub outputs: Slice<'a, i32>,
    /// State of each sample: water (x) and sediment (y) in 1/65536 height units, then the shares that leave, in 1/32768. z: to the
    /// west (low half) and east (high half). w: to the north (low half) and south (high half).
    pub flows: Slice<'a, [i32; 4]>,
    /// Out: state of each inner sample, in the layout of `flows`.
    pub flow_outputs: Slice<'a, [i32; 4]>,
}

impl Group<'_> {
    /// Binds them.
    ///
    /// # Errors
    /// [`GpuError::Validation`] where the device refuses one.
    pub fn bind(&self, gpu: &Gpu, kernel: &Kernel) -> Result<BindGroup, GpuError> {
        kernel.layouts.bind_group(gpu, &shaders::TERRAIN_HYDRAULIC, 0, &[
            (0, self.params.raw().as_entire_binding()),
            (1, self.windows.resource()),
            (2, self.outputs.resource()),
            (3, self.flows.resource()),
            (4, self.flow_outputs.resource()),
        ])
    }
}

}
/// Of `terrain/limit.wgsl`.
pub mod limit {
use crate::gpu::bind::prelude::*;

/// The kernel `terrain/limit`, compiled.
///
/// # Errors
/// What the driver's compiler reports.
pub fn kernel(gpu: &Gpu) -> Result<Kernel, GpuError> {
    Kernel::new(gpu, &shaders::TERRAIN_LIMIT, &[])
}

/// Resources of bind group 0 of `terrain/limit`.
#[derive(Debug, Clone, Copy)]
pub struct Group<'a> {
    /// Parameters of the kernel.
    pub params: &'a Uniform<crate::shared::terrain::limit::LimitParams>,
    /// Heights of all regions before erosion, row by row, in 1/65536 units.
    pub origins: Slice<'a, i32>,
    /// Eroded heights.
    pub eroded: Slice<'a, i32>,
    /// For each region, the index of its first height among the eroded ones.
    pub corners: Slice<'a, u32>,
    /// Out: heights of all regions, row by row.
    pub heights: Slice<'a, i32>,
}

impl Group<'_> {
    /// Binds them.
    ///
    /// # Errors
    /// [`GpuError::Validation`] where the device refuses one.
    pub fn bind(&self, gpu: &Gpu, kernel: &Kernel) -> Result<BindGroup, GpuError> {
        kernel.layouts.bind_group(gpu, &shaders::TERRAIN_LIMIT, 0, &[
            (0, self.params.raw().as_entire_binding()),
            (1, self.origins.resource()),
            (2, self.eroded.resource()),
            (3, self.corners.resource()),
            (4, self.heights.resource()),
        ])
    }
}

}
/// Of `terrain/morph.wgsl`.
pub mod morph {
use crate::gpu::bind::prelude::*;

/// The kernel `terrain/morph`, compiled.
///
/// # Errors
/// What the driver's compiler reports.
pub fn kernel(gpu: &Gpu) -> Result<Kernel, GpuError> {
    Kernel::new(gpu, &shaders::TERRAIN_MORPH, &[])
}

/// Resources of bind group 0 of `terrain/morph`.
#[derive(Debug, Clone, Copy)]
pub struct Group<'a> {
    /// Parameters of the kernel.
    pub params: &'a Uniform<crate::shared::terrain::morph::MorphParams>,
    /// Heights at time 0, in 1/65536 units.
    pub start_heights: Slice<'a, [i32; 4]>,
    /// Heights at time 65536, in 1/65536 units.
    pub target_heights: Slice<'a, [i32; 4]>,
    /// Out: blended heights. The last vector may extend past the last height, into the padding of the buffers.
    pub heights: Slice<'a, [i32; 4]>,
}

impl Group<'_> {
    /// Binds them.
    ///
    /// # Errors
    /// [`GpuError::Validation`] where the device refuses one.
    pub fn bind(&self, gpu: &Gpu, kernel: &Kernel) -> Result<BindGroup, GpuError> {
        kernel.layouts.bind_group(gpu, &shaders::TERRAIN_MORPH, 0, &[
            (0, self.params.raw().as_entire_binding()),
            (1, self.start_heights.resource()),
            (2, self.target_heights.resource()),
            (3, self.heights.resource()),
        ])
    }
}

}
/// Of `terrain/node.wgsl`.
pub mod node {
use crate::gpu::bind::prelude::*;

/// Override constants of `terrain/node`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Constants {
    /// Stage of the kernel: one of the constants below.
    pub stage: u32,
}

impl Default for Constants {
    fn default() -> Self {
        Self {
            stage: 0,
        }
    }
}

impl Constants {
    /// Name and value of each.
    pub fn list(&self) -> Vec<(&'static str, f64)> {
        vec![
            ("STAGE", self.stage.into()),
        ]
    }
}

/// The kernel `terrain/node`, compiled.
///
/// # Errors
/// What the driver's compiler reports.
pub fn kernel(gpu: &Gpu, constants: &Constants) -> Result<Kernel, GpuError> {
    Kernel::new(gpu, &shaders::TERRAIN_NODE, &constants.list())
}

/// Resources of bind group 0 of `terrain/node`.
#[derive(Debug, Clone, Copy)]
pub struct Group<'a> {
    /// Parameters of the kernel.
    pub params: &'a Uniform<crate::shared::terrain::node::NodeParams>,
    /// Heights of the regions, one after the other, row by row, in 1/65536 world units.
    pub heights: Slice<'a, i32>,
    /// Index of each region's tile and facts; those beyond the end of `tiles` or of `facts` are not written.
    pub slots: Slice<'a, u32>,
    /// Out: the tiles, one after the other: (`size` + 2 · `NODE_MARGIN`)² heights each.
    pub tiles: Slice<'a, i32>,
    /// Inout: the facts of each tile, 0 before. Its largest height + `SIGN`; the complement of its smallest height + `SIGN`; rounded up,
    /// the largest deviation of a finer height from the triangles, the same beside stitched borders, and half the largest second
    /// difference of finer heights.
    pub facts: Slice<'a, u32>,
}

impl Group<'_> {
    /// Binds them.
    ///
    /// # Errors
    /// [`GpuError::Validation`] where the device refuses one.
    pub fn bind(&self, gpu: &Gpu, kernel: &Kernel) -> Result<BindGroup, GpuError> {
        kernel.layouts.bind_group(gpu, &shaders::TERRAIN_NODE, 0, &[
            (0, self.params.raw().as_entire_binding()),
            (1, self.heights.resource()),
            (2, self.slots.resource()),
            (3, self.tiles.resource()),
            (4, self.facts.resource()),
        ])
    }
}

}
/// Of `terrain/node_normals.wgsl`.
pub mod node_normals {
use crate::gpu::bind::prelude::*;

/// The kernel `terrain/node_normals`, compiled.
///
/// # Errors
/// What the driver's compiler reports.
pub fn kernel(gpu: &Gpu) -> Result<Kernel, GpuError> {
    Kernel::new(gpu, &shaders::TERRAIN_NODE_NORMALS, &[])
}

/// Resources of bind group 0 of `terrain/node_normals`.
#[derive(Debug, Clone, Copy)]
pub struct Group<'a> {
    /// Parameters of the kernel.
    pub params: &'a Uniform<crate::shared::terrain::node_normals::NodeNormalsParams>,
    /// Heights of the regions, one after the other, row by row, in 1/65536 world units.
    pub heights: Slice<'a, i32>,
    /// Index of each region's node; nodes beyond the end of `normals` are not written.
    pub slots: Slice<'a, u32>,
    /// Out: the normals of the nodes, one after the other, row by row: x in the low half of a word and z in the high half, in 1/32767.
    pub normals: Slice<'a, u32>,
}

impl Group<'_> {
    /// Binds them.
    ///
    /// # Errors
    /// [`GpuError::Validation`] where the device refuses one.
    pub fn bind(&self, gpu: &Gpu, kernel: &Kernel) -> Result<BindGroup, GpuError> {
        kernel.layouts.bind_group(gpu, &shaders::TERRAIN_NODE_NORMALS, 0, &[
            (0, self.params.raw().as_entire_binding()),
            (1, self.heights.resource()),
            (2, self.slots.resource()),
            (3, self.normals.resource()),
        ])
    }
}

}
/// Of `terrain/noise.wgsl`.
pub mod noise {
use crate::gpu::bind::prelude::*;

/// Override constants of `terrain/noise`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Constants {
    /// Generator of the pipeline: one of the constants NOISE_*.
    pub generator: u32,
}

impl Default for Constants {
    fn default() -> Self {
        Self {
            generator: 0,
        }
    }
}

impl Constants {
    /// Name and value of each.
    pub fn list(&self) -> Vec<(&'static str, f64)> {
        vec![
            ("GENERATOR", self.generator.into()),
        ]
    }
}

/// The kernel `terrain/noise`, compiled.
///
/// # Errors
/// What the driver's compiler reports.
pub fn kernel(gpu: &Gpu, constants: &Constants) -> Result<Kernel, GpuError> {
    Kernel::new(gpu, &shaders::TERRAIN_NOISE, &constants.list())
}

/// Resources of bind group 0 of `terrain/noise`.
#[derive(Debug, Clone, Copy)]
pub struct Group<'a> {
    /// Parameters of the kernel.
    pub params: &'a Uniform<crate::shared::terrain::noise::NoiseParams>,
    /// World coordinates of the first sample of each region, in multiples of the spacing.
    pub origins: Slice<'a, [i32; 2]>,
    /// Out: heights of all regions, row by row, in 1/65536 units.
    pub heights: Slice<'a, i32>,
}

impl Group<'_> {
    /// Binds them.
    ///
    /// # Errors
    /// [`GpuError::Validation`] where the device refuses one.
    pub fn bind(&self, gpu: &Gpu, kernel: &Kernel) -> Result<BindGroup, GpuError> {
        kernel.layouts.bind_group(gpu, &shaders::TERRAIN_NOISE, 0, &[
            (0, self.params.raw().as_entire_binding()),
            (1, self.origins.resource()),
            (2, self.heights.resource()),
        ])
    }
}

}
/// Of `terrain/normals.wgsl`.
pub mod normals {
use crate::gpu::bind::prelude::*;

/// The kernel `terrain/normals`, compiled.
///
/// # Errors
/// What the driver's compiler reports.
pub fn kernel(gpu: &Gpu) -> Result<Kernel, GpuError> {
    Kernel::new(gpu, &shaders::TERRAIN_NORMALS, &[])
}

/// Resources of bind group 0 of `terrain/normals`.
#[derive(Debug, Clone, Copy)]
pub struct Group<'a> {
    /// Parameters of the kernel.
    pub params: &'a Uniform<crate::shared::terrain::normals::NormalsParams>,
    /// Heights of all windows, row by row, in 1/65536 units.
    pub windows: Slice<'a, i32>,
    /// Out: central differences along x and y at the inner samples, in 1/65536 units.
    pub gradients: Slice<'a, [i32; 2]>,
    /// Out: unit normals of the inner samples. Each has three floats, so that the buffer can serve as a vertex buffer.
    pub normals: Slice<'a, f32>,
}

impl Group<'_> {
    /// Binds them.
    ///
    /// # Errors
    /// [`GpuError::Validation`] where the device refuses one.
    pub fn bind(&self, gpu: &Gpu, kernel: &Kernel) -> Result<BindGroup, GpuError> {
        kernel.layouts.bind_group(gpu, &shaders::TERRAIN_NORMALS, 0, &[
            (0, self.params.raw().as_entire_binding()),
            (1, self.windows.resource()),
            (2, self.gradients.resource()),
            (3, self.normals.resource()),
        ])
    }
}

}
/// Of `terrain/pad.wgsl`.
pub mod pad {
use crate::gpu::bind::prelude::*;

/// The kernel `terrain/pad`, compiled.
///
/// # Errors
/// What the driver's compiler reports.
pub fn kernel(gpu: &Gpu) -> Result<Kernel, GpuError> {
    Kernel::new(gpu, &shaders::TERRAIN_PAD, &[])
}

/// Resources of bind group 0 of `terrain/pad`.
#[derive(Debug, Clone, Copy)]
pub struct Group<'a> {
    /// Parameters of the kernel.
    pub params: &'a Uniform<crate::shared::terrain::pad::PadParams>,
    /// Heights of the patches in the buffer of this dispatch, in 1/65536 units.
    pub patches: Slice<'a, i32>,
    /// Out: heights of the windows, row by row.
    pub outputs: Slice<'a, i32>,
    /// Nine indices per patch, row by row: the patch itself and the patches around it. 0xffffffff stands for a missing patch,
    /// 0xfffffffe for a patch in another buffer.
    pub around: Slice<'a, u32>,
}

impl Group<'_> {
    /// Binds them.
    ///
    /// # Errors
    /// [`GpuError::Validation`] where the device refuses one.
    pub fn bind(&self, gpu: &Gpu, kernel: &Kernel) -> Result<BindGroup, GpuError> {
        kernel.layouts.bind_group(gpu, &shaders::TERRAIN_PAD, 0, &[
            (0, self.params.raw().as_entire_binding()),
            (1, self.patches.resource()),
            (2, self.outputs.resource()),
            (3, self.around.resource()),
        ])
    }
}

}
/// Of `terrain/replace.wgsl`.
pub mod replace {
use crate::gpu::bind::prelude::*;

/// The kernel `terrain/replace`, compiled.
///
/// # Errors
/// What the driver's compiler reports.
pub fn kernel(gpu: &Gpu) -> Result<Kernel, GpuError> {
    Kernel::new(gpu, &shaders::TERRAIN_REPLACE, &[])
}

/// Resources of bind group 0 of `terrain/replace`.
#[derive(Debug, Clone, Copy)]
pub struct Group<'a> {
    /// Parameters of the kernel.
    pub params: &'a Uniform<crate::shared::terrain::replace::ReplaceParams>,
    /// The given heights of all regions, row by row, in 1/65536 world units; `NOT_GIVEN` where none is given.
    pub given: Slice<'a, i32>,
    /// Inout: heights of all regions, row by row.
    pub heights: Slice<'a, i32>,
}

impl Group<'_> {
    /// Binds them.
    ///
    /// # Errors
    /// [`GpuError::Validation`] where the device refuses one.
    pub fn bind(&self, gpu: &Gpu, kernel: &Kernel) -> Result<BindGroup, GpuError> {
        kernel.layouts.bind_group(gpu, &shaders::TERRAIN_REPLACE, 0, &[
            (0, self.params.raw().as_entire_binding()),
            (1, self.given.resource()),
            (2, self.heights.resource()),
        ])
    }
}

}
/// Of `terrain/smooth.wgsl`.
pub mod smooth {
use crate::gpu::bind::prelude::*;

/// Override constants of `terrain/smooth`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Constants {
    /// Feature mode: one of the constants above.
    pub features: u32,
    /// Distribution of the random offsets: one of the constants OFFSET_*.
    pub distribution: u32,
    /// Stage of the kernel: one of the constants below.
    pub stage: u32,
}

impl Default for Constants {
    fn default() -> Self {
        Self {
            features: 0,
            distribution: 0,
            stage: 0,
        }
    }
}

impl Constants {
    /// Name and value of each.
    pub fn list(&self) -> Vec<(&'static str, f64)> {
        vec![
            ("FEATURES", self.features.into()),
            ("DISTRIBUTION", self.distribution.into()),
            ("STAGE", self.stage.into()),
        ]
    }
}

/// The kernel `terrain/smooth`, compiled.
///
/// # Errors
/// What the driver's compiler reports.
pub fn kernel(gpu: &Gpu, constants: &Constants) -> Result<Kernel, GpuError> {
    Kernel::new(gpu, &shaders::TERRAIN_SMOOTH, &constants.list())
}

/// Resources of bind group 0 of `terrain/smooth`.
#[derive(Debug, Clone, Copy)]
pub struct Group<'a> {
    /// Parameters of the level.
    pub level: &'a Uniform<crate::shared::terrain::level::Level>,
    /// World coordinates of the first fine point of each window, in multiples of the spacing.
    pub origins: Slice<'a, [i32; 2]>,
    /// Heights of the coarse points of all windows, row by row, in 1/65536 units.
    pub coarse: Slice<'a, i32>,
    /// Out: heights of the fine points of all windows, row by row, in 1/65536 units.
    pub fine: Slice<'a, i32>,
    /// Heights at the centers of all windows' coarse cells, row by row, in 1/65536 units. Cell i lies between the coarse points i + 1
    /// and i + 2, in both directions. The first stage writes them; the second stage reads them.
    pub centers: Slice<'a, i32>,
}

impl Group<'_> {
    /// Binds them.
    ///
    /// # Errors
    /// [`GpuError::Validation`] where the device refuses one.
    pub fn bind(&self, gpu: &Gpu, kernel: &Kernel) -> Result<BindGroup, GpuError> {
        kernel.layouts.bind_group(gpu, &shaders::TERRAIN_SMOOTH, 0, &[
            (0, self.level.raw().as_entire_binding()),
            (1, self.origins.resource()),
            (2, self.coarse.resource()),
            (3, self.fine.resource()),
            (4, self.centers.resource()),
        ])
    }
}

/// Resources of bind group 1 of `terrain/smooth`.
#[derive(Debug, Clone, Copy)]
pub struct Group1<'a> {
    /// Words of all feature grids.
    pub feature_words: Slice<'a, crate::shared::terrain::features::FeatureWord>,
    /// Heights of the features, in 1/65536 world units.
    pub feature_heights: Slice<'a, i32>,
}

impl Group1<'_> {
    /// Binds them.
    ///
    /// # Errors
    /// [`GpuError::Validation`] where the device refuses one.
    pub fn bind(&self, gpu: &Gpu, kernel: &Kernel) -> Result<BindGroup, GpuError> {
        kernel.layouts.bind_group(gpu, &shaders::TERRAIN_SMOOTH, 1, &[
            (0, self.feature_words.resource()),
            (1, self.feature_heights.resource()),
        ])
    }
}

}
/// Of `terrain/thermal.wgsl`.
pub mod thermal {
use crate::gpu::bind::prelude::*;

/// The kernel `terrain/thermal`, compiled.
///
/// # Errors
/// What the driver's compiler reports.
pub fn kernel(gpu: &Gpu) -> Result<Kernel, GpuError> {
    Kernel::new(gpu, &shaders::TERRAIN_THERMAL, &[])
}

/// Resources of bind group 0 of `terrain/thermal`.
#[derive(Debug, Clone, Copy)]
pub struct Group<'a> {
    /// Parameters of the kernel.
    pub params: &'a Uniform<crate::shared::terrain::thermal::ThermalParams>,
    /// Heights of all windows, row by row, in 1/65536 units.
    pub windows: Slice<'a, i32>,
    /// Out: heights of the inner samples of all windows, in 1/65536 units.
    pub outputs: Slice<'a, i32>,
}

impl Group<'_> {
    /// Binds them.
    ///
    /// # Errors
    /// [`GpuError::Validation`] where the device refuses one.
    pub fn bind(&self, gpu: &Gpu, kernel: &Kernel) -> Result<BindGroup, GpuError> {
        kernel.layouts.bind_group(gpu, &shaders::TERRAIN_THERMAL, 0, &[
            (0, self.params.raw().as_entire_binding()),
            (1, self.windows.resource()),
            (2, self.outputs.resource()),
        ])
    }
}

}
/// Of `terrain/wrap.wgsl`.
pub mod wrap {
use crate::gpu::bind::prelude::*;

/// Override constants of `terrain/wrap`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Constants {
    /// Feature mode: one of the constants above.
    pub features: u32,
    /// Distribution of the random offsets: one of the constants OFFSET_*.
    pub distribution: u32,
}

impl Default for Constants {
    fn default() -> Self {
        Self {
            features: 0,
            distribution: 0,
        }
    }
}

impl Constants {
    /// Name and value of each.
    pub fn list(&self) -> Vec<(&'static str, f64)> {
        vec![
            ("FEATURES", self.features.into()),
            ("DISTRIBUTION", self.distribution.into()),
        ]
    }
}

/// The kernel `terrain/wrap`, compiled.
///
/// # Errors
/// What the driver's compiler reports.
pub fn kernel(gpu: &Gpu, constants: &Constants) -> Result<Kernel, GpuError> {
    Kernel::new(gpu, &shaders::TERRAIN_WRAP, &constants.list())
}

/// Resources of bind group 0 of `terrain/wrap`.
#[derive(Debug, Clone, Copy)]
pub struct Group<'a> {
    /// Parameters of the level.
    pub level: &'a Uniform<crate::shared::terrain::level::Level>,
    /// World coordinates of the first fine point of each window, in multiples of the spacing.
    pub origins: Slice<'a, [i32; 2]>,
    /// Heights of the coarse points of all windows, row by row, in 1/65536 units.
    pub coarse: Slice<'a, i32>,
    /// Out: heights of the fine points of all windows, row by row, in 1/65536 units.
    pub fine: Slice<'a, i32>,
}

impl Group<'_> {
    /// Binds them.
    ///
    /// # Errors
    /// [`GpuError::Validation`] where the device refuses one.
    pub fn bind(&self, gpu: &Gpu, kernel: &Kernel) -> Result<BindGroup, GpuError> {
        kernel.layouts.bind_group(gpu, &shaders::TERRAIN_WRAP, 0, &[
            (0, self.level.raw().as_entire_binding()),
            (1, self.origins.resource()),
            (2, self.coarse.resource()),
            (3, self.fine.resource()),
        ])
    }
}

/// Resources of bind group 1 of `terrain/wrap`.
#[derive(Debug, Clone, Copy)]
pub struct Group1<'a> {
    /// Words of all feature grids.
    pub feature_words: Slice<'a, crate::shared::terrain::features::FeatureWord>,
    /// Heights of the features, in 1/65536 world units.
    pub feature_heights: Slice<'a, i32>,
}

impl Group1<'_> {
    /// Binds them.
    ///
    /// # Errors
    /// [`GpuError::Validation`] where the device refuses one.
    pub fn bind(&self, gpu: &Gpu, kernel: &Kernel) -> Result<BindGroup, GpuError> {
        kernel.layouts.bind_group(gpu, &shaders::TERRAIN_WRAP, 1, &[
            (0, self.feature_words.resource()),
            (1, self.feature_heights.resource()),
        ])
    }
}

}
}
