//! Draws a crowd with its skin in several variants ("looks") that show the same frames, and measures the time
//! of each and how far its vertices lie from those of full animation and full skinning.

mod look;
mod world;

use image::RgbaImage;

use super::device::Device;
use super::gates::frame;
use super::options::{CrowdOptions, DrawnOptions, MeshDetail, SkinningDetail};
use super::placement::Placements;
use super::stage::{LINES, Stage};
use super::vertices::{FrameCost, Seen, Skinned};
use crate::animation::{Gate, Lod};
use crate::gpu::{Gpu, TimedBy, Timer};
use crate::render::target::Target;
use crate::{Error, InputError};
use look::Look;
use world::World;

/// Largest number of frames of a run that are timed.
const TIMED: u32 = 45;

/// Colour of the background, in linear light.
const SKY: [f64; 3] = [0.02, 0.025, 0.03];

/// Width and height of the picture, as a ratio.
const ASPECT: [u32; 2] = [16, 9];

/// Width and height of the picture, in pixels.
const PICTURE: [u32; 2] = [LINES * ASPECT[0] / ASPECT[1], LINES];

/// Which of the two crowds animates a look.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Animation {
    /// The crowd under the gate; clusters with a bone that moved are skinned.
    Gated,
    /// The crowd in full; all bones are sampled and all clusters are skinned.
    Full,
}

/// How a crowd is animated, skinned and drawn.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Variant {
    pub animation: Animation,
    pub skinning: SkinningDetail,
    pub mesh: MeshDetail,
}

impl Variant {
    /// The variant without level of detail.
    pub(crate) const FULL: Self =
        Self { animation: Animation::Full, skinning: SkinningDetail::Full, mesh: MeshDetail::Full };

    /// The variant that draws by these options, with all bones animated.
    pub(crate) fn of(drawn: &DrawnOptions) -> Self {
        Self { skinning: drawn.skinning, mesh: drawn.mesh, ..Self::FULL }
    }
}

/// Number of turns in which each variant is timed once as a whole and once in its parts, and once all of them
/// in their skinning.
fn turns(variants: usize) -> usize {
    2 * variants + 1
}

/// Refuses a number of frames that is too small to take each time of each variant once.
pub(crate) fn check_frames(options: &CrowdOptions, variants: usize) -> Result<(), InputError> {
    let least = turns(variants);
    if options.frames as usize >= least {
        return Ok(());
    }
    let bound = format!("must be at least {least}, as the crowd is drawn");
    Err(InputError::new("frames", options.frames, bound))
}

/// Looks at one crowd. All looks are compared with the first.
pub(crate) struct Drawing<'a> {
    gpu: &'a Gpu,
    stage: &'a Stage<'a>,
    placements: &'a Placements,
    device: Device,
    timer: Timer,
    target: Target,
    looks: Vec<Look>,
}

impl<'a> Drawing<'a> {
    /// Makes a look for each of `variants`.
    pub(crate) fn new(
        gpu: &'a Gpu,
        stage: &'a Stage<'a>,
        placements: &'a Placements,
        (gate, lods): (&Gate, &[Lod]),
        variants: &[Variant],
    ) -> Result<Self, Error> {
        let device = Device::new(gpu, stage, gate, lods)?;
        let world = World::new(gpu, stage, placements)?;
        let looks = variants.iter().map(|variant| world.look(&device, *variant)).collect::<Result<_, _>>()?;
        Ok(Self {
            looks,
            target: Target::new(gpu, PICTURE)?,
            timer: Timer::for_drawing(gpu)?,
            gpu,
            stage,
            placements,
            device,
        })
    }

    /// Plays all frames, and returns the cost of each look. Calls `step` after each frame.
    pub(crate) fn run(&mut self, step: impl Fn()) -> Result<Vec<FrameCost>, Error> {
        let CrowdOptions { frames, rate, .. } = *self.stage.options;
        let mut timed = 0..;
        for number in 0..=frames {
            self.device.set(number)?;
            let (_, elapsed) = frame(number, rate);
            for mesh in self.looks.iter().flat_map(|look| &look.meshes) {
                mesh.weights.set(self.gpu, elapsed)?;
            }
            if number > 0 && number % frames.div_ceil(TIMED) == 0 {
                let turn = timed.next().unwrap_or(0) % turns(self.looks.len());
                self.play_timed(turn)?;
                self.compare()?;
            } else {
                self.gpu.run("frame", |encoder| {
                    self.device.gated.frame.record(encoder);
                    let gated = |look: &&Look| look.variant.animation == Animation::Gated;
                    self.looks.iter().filter(gated).for_each(|look| look.compute(encoder));
                })?;
            }
            step();
        }
        Ok(self.looks.iter().map(Look::cost).collect())
    }

    /// The clock that takes the times.
    pub(crate) fn timed_by(gpu: &Gpu) -> Result<TimedBy, Error> {
        Ok(Timer::for_drawing(gpu)?.timed_by())
    }

    /// Draws the last frame of a look.
    pub(crate) fn picture(&self, look: usize) -> Result<RgbaImage, Error> {
        let look = &self.looks[look];
        self.target.draw(self.gpu, SKY, |pass| look.meshes.iter().for_each(|mesh| mesh.scene.draw(pass)))?;
        Ok(self.target.read(self.gpu)?)
    }

    /// Plays a frame of all looks. The gated crowd can advance only once per frame, so looks take turns: each
    /// turn times one look, as a whole or with its compute and its drawing apart. The last turn times the
    /// skinning of every look.
    fn play_timed(&mut self, turn: usize) -> Result<(), Error> {
        let chosen = (turn < 2 * self.looks.len()).then_some(turn / 2);
        for animation in [Animation::Gated, Animation::Full] {
            if chosen.is_none_or(|chosen| self.looks[chosen].variant.animation != animation) {
                self.gpu.run("animation", |encoder| self.device.record(animation, encoder))?;
            }
        }
        if let Some(chosen) = chosen {
            self.time_look(chosen, turn.is_multiple_of(2))?;
        }
        let Self { gpu, timer, looks, .. } = self;
        for (index, look) in looks.iter_mut().enumerate() {
            match chosen {
                None => {
                    gpu.run("decisions", |encoder| look.decide(encoder))?;
                    let skin = timer.measure(gpu, |encoder| look.skin(encoder))?.nanoseconds;
                    look.times.skin.push(skin);
                }
                Some(chosen) if chosen == index => {}
                Some(_) => gpu.run("skinning", |encoder| look.compute(encoder))?,
            }
        }
        Ok(())
    }

    /// Times a look's frame with its animation, as a whole or as compute and drawing.
    fn time_look(&mut self, chosen: usize, is_whole: bool) -> Result<(), Error> {
        let Self { gpu, timer, target, device, looks, .. } = self;
        let look = &looks[chosen];
        let compute = |encoder: &mut wgpu::CommandEncoder| {
            device.record(look.variant.animation, encoder);
            look.compute(encoder);
        };
        let draw = |encoder: &mut wgpu::CommandEncoder| look.draw(target, encoder);
        let timed = |record: &dyn Fn(&mut wgpu::CommandEncoder)| -> Result<f64, Error> {
            Ok(timer.measure(gpu, record)?.nanoseconds)
        };
        if is_whole {
            let frame = timed(&|encoder| {
                compute(encoder);
                draw(encoder);
            })?;
            looks[chosen].times.frame.push(frame);
        } else {
            let [compute, draw] = [timed(&compute)?, timed(&draw)?];
            looks[chosen].times.compute.push(compute);
            looks[chosen].times.draw.push(draw);
        }
        Ok(())
    }

    /// Reads all looks back, and compares them with the first.
    fn compare(&mut self) -> Result<(), Error> {
        let Self { gpu, stage, placements, looks, .. } = self;
        for mesh in 0..stage.subject.model.meshes.len() {
            let first = &looks[0].meshes[mesh];
            let fresh = first.skin.skinned.read_blocking(gpu)?;
            let slots = first.slots.clone();
            let fresh = Skinned { vertices: &fresh, slots: &slots };
            for look in looks.iter_mut() {
                let drawn = &look.meshes[mesh];
                let own = drawn.skin.skinned.read_blocking(gpu)?;
                let stale = Skinned { vertices: &own, slots: &drawn.slots };
                let instance_lods = drawn.skin.crowd.instance_lods.read_blocking(gpu)?;
                let levelled = stage.levelled.as_ref().filter(|_| look.variant.mesh != MeshDetail::Full);
                let levels = levelled.map(|levelled| (&levelled.levels[mesh], &levelled.own[mesh][..]));
                look.errors.add(
                    (placements, stage.projection),
                    Seen { instance_lods: &instance_lods, levels },
                    stale,
                    fresh,
                );
                look.count(gpu, mesh, &instance_lods)?;
            }
        }
        Ok(())
    }
}

impl Device {
    /// Records the animation of a frame of one of the crowds.
    fn record(&self, animation: Animation, encoder: &mut wgpu::CommandEncoder) {
        match animation {
            Animation::Gated => self.gated.frame.record(encoder),
            Animation::Full => self.full.record(encoder),
        }
    }
}
