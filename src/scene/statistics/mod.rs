//! Statistics of frames, counted on the device and read back some frames later without waiting.

mod counts;
mod times;
pub(super) mod view;

pub(super) use counts::SceneCounts;
pub(super) use times::StageTimer;

use crate::Error;
use crate::scene::Scene;
use crate::scene::handles::ObjectId;

/// Largest number of frames whose statistics are in flight. If all are taken, a frame is not counted.
pub(super) const FRAMES: usize = 8;

/// Work that a scene's characters took in a frame.
#[derive(Debug, Clone, PartialEq)]
pub struct SceneStatistics {
    /// Number of the frame: how many frames the scene had recorded before it.
    pub frame: u64,
    /// One entry per character, in the order in which they were added.
    pub characters: Vec<CharacterStatistics>,
}

/// Work that one character took in a frame, all instances together.
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
    /// Number of the frame, as [`SceneStatistics::frame`].
    #[serde(skip)]
    pub frame: u64,
    /// Culling, level selection and list building, of all views.
    pub select: f64,
    /// Choosing the bones to sample, and listing them.
    pub gate: f64,
    /// Sampling of bones, and weights of morph targets.
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

/// What a view drew in a frame.
#[derive(Debug, Clone, PartialEq)]
pub struct ViewStatistics {
    /// Number of the frame, as [`SceneStatistics::frame`].
    pub frame: u64,
    /// Largest possible error of anything, in pixels: that of [`Quality`](crate::scene::Quality), or of the object whose
    /// levels of detail were coarser: by a budget, by its own settings, or for lack of memory ([`Scene::lod_bias`]).
    pub pixels: f32,
    /// The budget of triangles, if the view has one.
    pub budget: Option<BudgetStatistics>,
    /// One entry per object, in the order in which they were added.
    pub objects: Vec<ObjectStatistics>,
}

/// What a budget of triangles did in a frame ([`Quality::triangles`](crate::scene::Quality::triangles)).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BudgetStatistics {
    /// Largest factor of the metric of any rank, 1 or more.
    pub factor: f32,
    /// Whether even the coarsest levels had too many triangles.
    pub is_missed: bool,
    /// Whether all fades ended, because both levels of each had too many triangles.
    pub fades_ended: bool,
}

/// What a view drew of one object.
#[derive(Debug, Clone, PartialEq)]
pub struct ObjectStatistics {
    /// The object.
    pub object: ObjectId,
    /// Largest possible error of its instances, in pixels.
    pub pixels: f32,
    /// One entry per level of detail, the finest first.
    pub levels: Vec<LevelStatistics>,
}

/// What a view drew of one level of an object.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct LevelStatistics {
    /// Number of drawn instances.
    pub instances: u32,
    /// Number of triangles in these instances, back faces included.
    pub triangles: u64,
}

impl ObjectStatistics {
    /// Number of drawn instances, all levels together.
    pub fn instances(&self) -> u32 {
        self.levels.iter().map(|level| level.instances).sum()
    }

    /// Number of drawn triangles, all levels together.
    pub fn triangles(&self) -> u64 {
        self.levels.iter().map(|level| level.triangles).sum()
    }
}

impl Scene {
    /// Turns statistics on or off, from the next frame on. They cost each frame a copy of a few bytes per object, view and
    /// character. On a device with timestamps, each stage also takes a compute pass of its own. The first such frame
    /// allocates memory.
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

    /// The statistics of the last frame whose counts have arrived. `None` before the first, and unless
    /// [`Scene::set_statistics`] turned them on. The call does not wait: counts arrive when the device has executed the
    /// frame and is polled, which each submission does.
    pub fn statistics(&mut self) -> Option<&SceneStatistics> {
        self.counts.as_mut()?.last()
    }

    /// The stage times of the last frame whose times have arrived. `None` before the first, unless
    /// [`Scene::set_statistics`] turned them on, and on a device without `TIMESTAMP_QUERY`.
    ///
    /// The clock is the device's. A software adapter executes a pass only when its results are needed. Its clock then hides
    /// the driver's work before and after, mainly compilation and waiting for threads.
    pub fn stage_times(&mut self) -> Option<&StageTimes> {
        self.timer.as_mut()?.last()
    }

    /// The number of frames recorded so far.
    pub fn frames(&self) -> u64 {
        self.frames
    }
}
