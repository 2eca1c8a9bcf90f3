//! One way to draw a crowd: a scene with its own share of the permitted pixels, and its measurements.

use relievo::Error;
use relievo::gpu::{Gpu, GpuError};
use relievo::ops::lod::OBJECT_LEVELS;
use relievo::render::{Layer, Renderer};
use relievo::scene::{
    BoneGate, Camera, CharacterOptions, DistanceRange as Range, ObjectId, Play, Scene, View,
};

use crate::measure::displacement::{Displacement, DisplacementMeter};
use crate::measure::drawing::cost::FrameCost;
use crate::measure::drawing::parts::Parts;
use crate::measure::drawing::subject::DrawnModel;
use crate::measure::frames::DrawnLevel;
use crate::measure::stage::Stage;
use crate::measure::tally::middle;

/// The most instances whose displacement is measured in a frame.
const MEASURED: usize = 16;

/// A scene with a crowd, and its measurements so far.
pub(super) struct Look {
    pub scene: Scene,
    /// Whether bones keep old poses, so that what a frame does depends on those before.
    pub is_gated: bool,
    view: View,
    crowd: ObjectId,
    meter: DisplacementMeter,
    pub times: Times,
    counted: Counted,
}

/// Times in nanoseconds, one per timed frame.
#[derive(Default)]
pub(super) struct Times {
    pub frame: Vec<f64>,
    pub compute: Vec<f64>,
    pub draw: Vec<f64>,
}

/// Sums over the frames that were measured.
#[derive(Default)]
struct Counted {
    frames: u64,
    bones: u64,
    clusters: u64,
    triangles: u64,
    /// Of the last frame.
    levels: [DrawnLevel; OBJECT_LEVELS as usize],
    displacement: Displacement,
}

impl Look {
    /// A scene of the crowd of a stage before a camera.
    pub(super) fn new(
        gpu: &Gpu,
        stage: &Stage<'_>,
        drawn: &DrawnModel,
        placements: &[relievo::scene::Placement],
        camera: Camera,
        parts: &Parts,
    ) -> Result<Self, Error> {
        let (quality, budget) = parts.quality();
        let mut scene = Scene::new(gpu)?;
        let world = |units: f32| units * stage.metres_a_unit;
        let Range { min, max } = stage.options.range;
        let range = Range { min: world(min), max: world(max) };
        let (gate, influences) = (parts.bone_gate(range), parts.influence_lod(range));
        let priorities = stage.options.priorities.iter().map(|(bone, priority)| (bone.as_str(), *priority));
        let priorities = if gate == BoneGate::Off { Default::default() } else { priorities.collect() };
        let tiers = parts.tiers.clone();
        let options = CharacterOptions { gate, influences, priorities, tiers, ..CharacterOptions::default() };
        let crowd = scene.add_character_with(&drawn.model, placements.len(), &options)?;
        scene.set_error_budget(budget)?;
        if parts.mesh > 0.0 {
            scene.set_level_of_detail(crowd, &drawn.transition.into())?;
        }
        for (placement, instance) in placements.iter().zip(&stage.instances) {
            let spawned = scene.spawn(crowd, *placement)?;
            scene.play(spawned, &Play { start: -f64::from(instance.start), ..Play::new("0") })?;
        }
        let mut view = scene.view(quality)?;
        view.set(camera)?;
        let mut meter = DisplacementMeter::of_at_most(MEASURED);
        meter.watch(&scene, crowd, &drawn.model)?;
        let (is_gated, times, counted) = (gate != BoneGate::Off, Times::default(), Counted::default());
        Ok(Self { scene, is_gated, view, crowd, meter, times, counted })
    }

    /// Records all that precedes the drawing.
    pub(super) fn compute(&mut self, encoder: &mut wgpu::CommandEncoder) -> Result<(), Error> {
        self.scene.record(encoder, &mut [&mut self.view])
    }

    pub(super) fn draw(
        &self,
        renderer: &Renderer,
        pass: &mut wgpu::RenderPass<'_>,
    ) -> Result<(), relievo::InputError> {
        renderer.draw(pass, &self.scene, &self.view, Layer::Color)?;
        renderer.draw(pass, &self.scene, &self.view, Layer::Transparent)
    }

    /// Reads back what the last frame did, which was counted, and measures it; the change of displacements since the frame
    /// before too unless it begins a pair.
    pub(super) fn measure(&mut self, begins: bool) -> Result<(), Error> {
        let frame = self.scene.frames().wrapping_sub(1);
        let late = || GpuError::Internal { reason: format!("the counts of frame {frame} have not arrived") };
        let scene = self.scene.statistics().filter(|all| all.frame == frame).ok_or_else(late)?;
        let own = scene.characters.iter().find(|own| own.object == self.crowd).copied().ok_or_else(late)?;
        let seen = self.view.statistics().filter(|all| all.frame == frame).ok_or_else(late)?;
        let counted = &mut self.counted;
        counted.frames += 1;
        counted.bones += u64::from(own.bones);
        counted.clusters += u64::from(own.clusters);
        counted.levels = Default::default();
        let levels = seen.objects.iter().filter(|object| object.object == self.crowd);
        for (sum, level) in counted.levels.iter_mut().zip(levels.flat_map(|object| &object.levels)) {
            *sum = DrawnLevel { instances: level.instances.into(), triangles: level.triangles };
            counted.triangles += level.triangles;
        }
        if begins {
            self.meter.forget_last();
        }
        counted.displacement = counted.displacement.and(self.meter.measure(&self.scene, &self.view)?);
        Ok(())
    }

    pub(super) fn cost(&self, drawn: &DrawnModel, instances: usize) -> FrameCost {
        let Times { frame, compute, draw } = &self.times;
        let [frame, compute, draw] = [frame, compute, draw].map(|times| middle(times.clone()).unwrap_or(0.0));
        let Counted { frames, bones, clusters, triangles, levels, displacement } = &self.counted;
        let mean = |sum: &u64| *sum as f64 / (*frames).max(1) as f64;
        let fraction = |sum: &u64, each: u64| mean(sum) / (instances as u64 * each).max(1) as f64;
        let pixels = self.view.quality().pixels;
        FrameCost {
            pixels,
            frame_nanoseconds: frame,
            compute_nanoseconds: compute,
            draw_nanoseconds: draw,
            bones: mean(bones),
            clusters: mean(clusters),
            skinned_fraction: fraction(clusters, drawn.clusters),
            triangle_fraction: fraction(triangles, drawn.triangles()),
            levels: *levels,
            displacement: Displacement { pixels, ..*displacement },
        }
    }
}
