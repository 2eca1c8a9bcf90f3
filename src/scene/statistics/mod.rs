//! What frames did, counted on the device, and read some frames later without a wait.

mod counts;
mod times;
pub(super) mod view;

pub(super) use counts::SceneCounts;
pub(super) use times::StageTimer;

use crate::Error;
use crate::scene::Scene;
use crate::scene::handles::ObjectId;

/// The number of frames whose statistics may be on their way. If all of them are, a frame goes uncounted.
pub(super) const FRAMES: usize = 8;

/// What the characters of a scene took in a frame.
#[derive(Debug, Clone, PartialEq)]
pub struct SceneStatistics {
    /// The frame: the number of frames that the scene had recorded before it.
    pub frame: u64,
    /// One for each character, in the order in which they were added.
    pub characters: Vec<CharacterStatistics>,
}

/// What a character took in a frame, all instances together.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct CharacterStatistics {
    /// The character.
    pub object: ObjectId,
    /// Number of bones that were interpolated between keys.
    pub bones: u32,
    /// Number of clusters, of up to 64 vertices each, that were skinned.
    pub clusters: u32,
}

/// How long the stages of a frame took on the device, in milliseconds.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize)]
pub struct StageTimes {
    /// The frame, as [`SceneStatistics::frame`].
    #[serde(skip)]
    pub frame: u64,
    /// Culling, levels of detail and lists, of all views.
    pub select: f64,
    /// The decision which bones are sampled, and their lists.
    pub gate: f64,
    /// Samples of bones, and weights of morph targets.
    pub sample: f64,
    /// Model matrices, and the placements of attached meshes.
    pub local_to_model: f64,
    /// Pages, palettes, morph targets and skinning.
    pub skin: f64,
}

impl StageTimes {
    /// The sum of all stages.
    pub fn total(&self) -> f64 {
        self.select + self.gate + self.sample + self.local_to_model + self.skin
    }
}

/// What a view saw in a frame.
#[derive(Debug, Clone, PartialEq)]
pub struct ViewStatistics {
    /// The frame, as [`SceneStatistics::frame`].
    pub frame: u64,
    /// The largest number of pixels by which anything may have been off: that of [`Quality`](crate::scene::Quality), or that
    /// of the object for which levels of detail had to be coarser ([`Scene::lod_bias`]).
    pub pixels: f32,
    /// One for each object, in the order in which they were added.
    pub objects: Vec<ObjectStatistics>,
}

/// What a view saw of an object.
#[derive(Debug, Clone, PartialEq)]
pub struct ObjectStatistics {
    /// The object.
    pub object: ObjectId,
    /// The number of pixels by which its instances may have been off.
    pub pixels: f32,
    /// One for each level of detail, the finest first.
    pub levels: Vec<LevelStatistics>,
}

/// What a view saw of a level of detail of an object.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct LevelStatistics {
    /// Number of instances that were drawn.
    pub instances: u32,
    /// Number of their triangles, those that turn away included.
    pub triangles: u64,
}

impl ObjectStatistics {
    /// Number of instances of all levels.
    pub fn instances(&self) -> u32 {
        self.levels.iter().map(|level| level.instances).sum()
    }

    /// Number of triangles of all levels.
    pub fn triangles(&self) -> u64 {
        self.levels.iter().map(|level| level.triangles).sum()
    }
}

impl Scene {
    /// Counts what frames do, from the next one on, or no longer. A frame then also copies some bytes for each object, view and
    /// character, and, where the device has timestamps, takes a compute pass for each stage. The first such frame
    /// allocates.
    ///
    /// # Errors
    /// [`crate::gpu::GpuError`].
    pub fn set_statistics(&mut self, counted: bool) -> Result<(), Error> {
        self.counted = counted;
        self.counts = None;
        self.timer = if counted { StageTimer::new(&self.gpu)? } else { None };
        Ok(())
    }

    /// The statistics of the last frame whose counts have arrived; `None` before the first, and unless
    /// [`Scene::set_statistics`] asked for them. Nothing is waited for: they arrive when the device has executed the frame and
    /// is polled, as each submission does.
    pub fn statistics(&mut self) -> Option<&SceneStatistics> {
        self.counts.as_mut()?.last()
    }

    /// How long the stages of the last frame took whose times have arrived. `None` before the first, unless
    /// [`Scene::set_statistics`] asked for them, and on a device without `TIMESTAMP_QUERY`.
    ///
    /// The clock is the device's. A software adapter executes a pass when the results are needed, and its clock
    /// hides what the driver does before and after: compilation, above all, and waiting for its threads.
    pub fn stage_times(&mut self) -> Option<&StageTimes> {
        self.timer.as_mut()?.last()
    }

    /// The number of frames that were recorded so far.
    pub fn frames(&self) -> u64 {
        self.frames
    }
}
