//! Statistics of frames, counted on the device and read back some frames later without waiting.

mod counts;
mod times;
pub(super) mod view;

pub(super) use counts::SceneCounts;
pub(super) use times::StageTimer;

use crate::Error;
use crate::scene::Scene;
use crate::scene::handles::ObjectId;

/// Largest number of frames whose statistics are in flight. If that many are in flight, the next frame is not counted.
pub(super) const FRAMES: usize = 8;

/// The work of a scene's characters in one frame.
#[derive(Debug, Clone, PartialEq)]
pub struct SceneStatistics {
    /// Number of the frame: the number of frames that the scene recorded before it.
    pub frame: u64,
    /// One entry per character, in the order in which they were added.
    pub characters: Vec<CharacterStatistics>,
}

/// The work of one character in one frame, summed over its instances.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct CharacterStatistics {
    /// The character.
    pub object: ObjectId,
    /// Number of bones interpolated between keyframes.
    pub bones: u32,
    /// Number of skinned clusters, each of up to 64 vertices.
    pub clusters: u32,
}

/// GPU time of each stage of a frame, in milliseconds.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize)]
pub struct StageTimes {
    /// Number of the frame, counted as in [`SceneStatistics::frame`].
    #[serde(skip)]
    pub frame: u64,
    /// Time of culling, level selection and list building, for all views together.
    pub select: f64,
    /// Time of choosing the bones to sample, and of listing them.
    pub gate: f64,
    /// Time of sampling bones, and of computing the weights of morph targets.
    pub sample: f64,
    /// Time of computing model matrices, and the placements of attached meshes.
    pub local_to_model: f64,
    /// Time of assigning pages and computing palettes, of applying morph targets, and of skinning.
    pub skin: f64,
}

impl StageTimes {
    /// The sum of the times of all stages, in milliseconds.
    pub fn total(&self) -> f64 {
        self.select + self.gate + self.sample + self.local_to_model + self.skin
    }
}

/// The instances and triangles that a view drew in one frame.
#[derive(Debug, Clone, PartialEq)]
pub struct ViewStatistics {
    /// Number of the frame, counted as in [`SceneStatistics::frame`].
    pub frame: u64,
    /// Upper bound of the error of all drawn instances, in pixels. It is the limit of the view's
    /// [`Quality`](crate::scene::Quality), unless an object's levels of detail were coarser. An object's levels may be
    /// coarser because of a budget, the object's own settings, or a lack of memory ([`Scene::lod_bias`]). It is also larger where a
    /// package's quantization ([`Mesh::error`](crate::asset::Mesh::error)) exceeds the limit at full detail. It is infinite if the
    /// bound of any object is, and while endless terrain lacks detail.
    pub pixels: f32,
    /// The effect of the view's budget of triangles; `None` if the view has no budget.
    pub budget: Option<BudgetStatistics>,
    /// One entry per object, in the order in which they were added.
    pub objects: Vec<ObjectStatistics>,
}

/// The effect of a budget of triangles in one frame ([`Quality::triangles`](crate::scene::Quality::triangles)).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BudgetStatistics {
    /// The largest factor that the budget applied to objects of any rank, at least 1. The factor multiplies the metric
    /// by which levels of detail are chosen.
    pub factor: f32,
    /// Whether even the coarsest levels of detail had too many triangles.
    pub is_missed: bool,
    /// Whether the budget ended all fades, because the two levels of each fade had too many triangles.
    pub fades_ended: bool,
}

/// The instances and triangles of one object that a view drew in one frame.
#[derive(Debug, Clone, PartialEq)]
pub struct ObjectStatistics {
    /// The object.
    pub object: ObjectId,
    /// Upper bound of the error of the object's instances, in pixels. It is infinite if the object's settings bound no error: levels
    /// of detail that another criterion than [`Criterion::Error`](crate::scene::Criterion::Error) chooses, and gates and influences
    /// that do not depend on the error ([`CharacterOptions`](crate::scene::CharacterOptions)).
    pub pixels: f32,
    /// One entry per level of detail, the finest first.
    pub levels: Vec<LevelStatistics>,
}

/// The instances and triangles of one level of detail that a view drew in one frame.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct LevelStatistics {
    /// Number of drawn instances.
    pub instances: u32,
    /// Number of triangles of these instances, including back faces.
    pub triangles: u64,
}

impl ObjectStatistics {
    /// Number of drawn instances, summed over all levels of detail.
    pub fn instances(&self) -> u32 {
        self.levels.iter().map(|level| level.instances).sum()
    }

    /// Number of drawn triangles, summed over all levels of detail.
    pub fn triangles(&self) -> u64 {
        self.levels.iter().map(|level| level.triangles).sum()
    }
}

impl Scene {
    /// Turns statistics on or off, from the next frame on. In each frame, statistics cost a copy of a few bytes per
    /// object, view and character. On a device with timestamps, each stage also takes a compute pass of its own. The
    /// first frame with statistics allocates memory.
    ///
    /// # Errors
    /// [`crate::gpu::GpuError`].
    ///
    /// # Examples
    ///
    /// ```no_run
    /// # use relievo::scene::{Scene, View};
    /// # fn example(scene: &mut Scene, view: &mut View) -> Result<(), relievo::Error> {
    /// scene.set_statistics(true)?; // once
    /// // In each frame; the counts are some frames old.
    /// for object in view.statistics().map_or(&[][..], |counted| &counted.objects) {
    ///     println!("{:?}: {} triangles", object.object, object.triangles());
    /// }
    /// if let Some(times) = scene.stage_times() {
    ///     println!("skinning: {} of {}", times.skin, times.total());
    /// }
    /// # Ok(())
    /// # }
    /// ```
    pub fn set_statistics(&mut self, counted: bool) -> Result<(), Error> {
        self.counted = counted;
        self.counts = None;
        self.timer = if counted { StageTimer::new(&self.gpu)? } else { None };
        Ok(())
    }

    /// The statistics of the last frame whose counts have arrived. `None` if statistics are off
    /// ([`Scene::set_statistics`]), and before the first counts arrive. The call does not wait. Counts arrive when the
    /// device has executed the frame and is polled; each submission polls the device.
    pub fn statistics(&mut self) -> Option<&SceneStatistics> {
        self.counts.as_mut()?.last()
    }

    /// The stage times of the last frame whose times have arrived. `None` if statistics are off
    /// ([`Scene::set_statistics`]), before the first times arrive, and on a device without `TIMESTAMP_QUERY`.
    ///
    /// The device's clock measures the times. A software adapter executes a pass only when its results are needed. The
    /// times then leave out the driver's work before and after the pass, mainly compilation and waiting for threads.
    pub fn stage_times(&mut self) -> Option<&StageTimes> {
        self.timer.as_mut()?.last()
    }

    /// The number of frames recorded so far.
    pub fn frames(&self) -> u64 {
        self.frames
    }
}
