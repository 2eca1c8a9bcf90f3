//! The crowd with its skin, on screen: looks at the same frames, each with what it takes and how far its vertices lie
//! from where full animation and full skinning put them.

use glam::{Mat4, Vec3, camera};
use image::{Rgba, RgbaImage};
use relievo::animation::{Gate, Lod};
use relievo::asset::Affine;
use relievo::asset::Light;
use relievo::gpu::{Buffer, Gpu, TimedBy, Timer};
use relievo::render::skinned::{SkinnedInstances, SkinnedRenderer, SkinnedScene};
use relievo::render::target::{COLOR_FORMAT, Target};
use relievo::render::{Albedo, ColorTexture};
use relievo::skinning::Extent;
use relievo::skinning::frame::SkinFrame;
use relievo::skinning::instance_lod::InstanceLod;
use relievo::skinning::lod::{LevelRanges, LodJob, LodPass, LodView, NO_FADE, list_words};
use relievo::skinning::morph_weights::{MorphWeightsJob, MorphWeightsPass, WeightSet};
use relievo::skinning::vertex::Blend;
use relievo::surface::mips::Mips;
use relievo::{Error, InputError};

use super::device::Device;
use super::gates::frame;
use super::plan::{FIELD_OF_VIEW, LINES};
use super::play::middle;
use super::skinning::Skinning;
use super::stage::{Scene, Stage};
use super::triangles::Triangles;
use super::vertices::{Figures, Seen, Skinned, Spread};

/// Frames of a run that are timed.
const TIMED: u32 = 45;

/// Steps of the fade.
const STEPS: u32 = 64;

/// Linear.
const SKY: [f64; 3] = [0.02, 0.025, 0.03];

/// Width of the picture over its height.
const ASPECT: [u32; 2] = [16, 9];

/// In pixels.
const PICTURE: [u32; 2] = [LINES * ASPECT[0] / ASPECT[1], LINES];

/// Who animates.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum By {
    /// The crowd under the gate; clusters with a bone that moved are skinned.
    Gate,
    /// Everything of everybody, in animation and skinning.
    All,
}

/// How a crowd is animated, skinned and drawn.
#[derive(Debug, Clone, Copy)]
pub struct Way {
    pub by: By,
    pub skinning: Skinning,
    pub triangles: Triangles,
}

/// Looks at a crowd. The first is what the others are compared with.
pub struct Drawing<'a> {
    gpu: &'a Gpu,
    stage: &'a Stage<'a>,
    scene: &'a Scene,
    device: Device,
    timer: Timer,
    target: Target,
    looks: Vec<Look>,
}

/// A way to animate and skin, and its own vertices.
struct Look {
    way: Way,
    meshes: Vec<Drawable>,
    times: Times,
    spread: Spread,
    /// Those that were skinned, and all.
    clusters: [u64; 2],
    /// Those that were drawn, and all.
    triangles: [u64; 2],
}

/// Nanoseconds, frame by frame.
#[derive(Default)]
struct Times {
    frame: Vec<f64>,
    compute: Vec<f64>,
    draw: Vec<f64>,
    skin: Vec<f64>,
}

struct Drawable {
    skin: SkinFrame,
    /// Where each of the mesh's vertices lies among an instance's.
    places: Vec<u32>,
    lod: LodJob,
    weights: MorphWeightsJob,
    scene: SkinnedScene,
}

impl<'a> Drawing<'a> {
    /// A look for each of `ways`.
    pub fn new(
        gpu: &'a Gpu,
        stage: &'a Stage<'a>,
        scene: &'a Scene,
        (gate, lods): (&Gate, &[Lod]),
        ways: &[Way],
    ) -> Result<Self, Error> {
        let device = Device::new(gpu, stage, gate, lods)?;
        let world = World::new(gpu, stage, scene)?;
        Ok(Self {
            looks: ways.iter().map(|way| world.look(&device, *way)).collect::<Result<_, Error>>()?,
            target: Target::new(gpu, PICTURE)?,
            timer: Timer::for_drawing(gpu)?,
            gpu,
            stage,
            scene,
            device,
        })
    }

    /// Plays all frames, and says of each look what it took. `step` is called after each frame.
    pub fn run(&mut self, step: impl Fn()) -> Result<Vec<Figures>, Error> {
        let frames = self.stage.plan.frames;
        let mut turns = 0..;
        for number in 0..=frames {
            self.device.set(number)?;
            let (_, elapsed) = frame(number, self.stage.plan.rate);
            for mesh in self.looks.iter().flat_map(|look| &look.meshes) {
                mesh.weights.set(self.gpu, elapsed)?;
            }
            if number > 0 && number % frames.div_ceil(TIMED) == 0 {
                let turn = turns.next().unwrap_or(0) % (2 * self.looks.len() + 1);
                self.play_timed(turn)?;
                self.compare()?;
            } else {
                self.gpu.run("frame", |encoder| {
                    self.device.gated.frame.record(encoder);
                    self.looks
                        .iter()
                        .filter(|look| look.way.by == By::Gate)
                        .for_each(|look| look.compute(encoder));
                })?;
            }
            step();
        }
        Ok(self.looks.iter().map(Look::figures).collect())
    }

    /// What clock takes the times.
    pub fn timed_by(gpu: &Gpu) -> Result<TimedBy, Error> {
        Ok(Timer::for_drawing(gpu)?.timed_by())
    }

    /// A picture of the last frame.
    pub fn picture(&self, look: usize) -> Result<RgbaImage, Error> {
        let look = &self.looks[look];
        self.target.draw(self.gpu, SKY, |pass| look.meshes.iter().for_each(|mesh| mesh.scene.draw(pass)))?;
        Ok(self.target.read(self.gpu)?)
    }

    /// A frame of all looks. The gated crowd can be stepped once alone, so that looks take turns: one is timed as a
    /// whole, or what is computed and what is drawn apart; in the last turn, of each look its skinning.
    fn play_timed(&mut self, turn: usize) -> Result<(), Error> {
        let Self { gpu, timer, target, device, looks, .. } = self;
        let animate = |by: By, encoder: &mut wgpu::CommandEncoder| match by {
            By::Gate => device.gated.frame.record(encoder),
            By::All => device.full.record(encoder),
        };
        let timed = |record: &dyn Fn(&mut wgpu::CommandEncoder)| -> Result<f64, Error> {
            Ok(timer.measure(gpu, record)?.nanoseconds)
        };
        let chosen = (turn < 2 * looks.len()).then_some(turn / 2);
        for by in [By::Gate, By::All] {
            if chosen.is_none_or(|chosen| looks[chosen].way.by != by) {
                gpu.run("animation", |encoder| animate(by, encoder))?;
            }
        }
        if let Some(chosen) = chosen {
            let look = &looks[chosen];
            let compute = |encoder: &mut wgpu::CommandEncoder| {
                animate(look.way.by, encoder);
                look.compute(encoder);
            };
            let draw = |encoder: &mut wgpu::CommandEncoder| look.draw(target, encoder);
            if turn.is_multiple_of(2) {
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
        }
        for (index, look) in looks.iter_mut().enumerate() {
            match chosen {
                None => {
                    gpu.run("decisions", |encoder| look.decide(encoder))?;
                    look.times.skin.push(timed(&|encoder| look.skin(encoder))?);
                }
                Some(chosen) if chosen == index => {}
                Some(_) => gpu.run("skinning", |encoder| look.compute(encoder))?,
            }
        }
        Ok(())
    }

    /// Reads all looks back, and compares them with the first.
    fn compare(&mut self) -> Result<(), Error> {
        for mesh in 0..self.stage.plan.model.meshes.len() {
            let first = &self.looks[0].meshes[mesh];
            let fresh = first.skin.skinned.read_blocking(self.gpu)?;
            let places = first.places.clone();
            let fresh = Skinned { vertices: &fresh, places: &places };
            for look in &mut self.looks {
                let Drawable { skin, places, .. } = &look.meshes[mesh];
                let own = skin.skinned.read_blocking(self.gpu)?;
                let instance_lods = skin.crowd.instance_lods.read_blocking(self.gpu)?;
                let levelled = self.stage.levelled.as_ref().filter(|_| look.way.triangles != Triangles::All);
                let levels = levelled.map(|levelled| (&levelled.levels[mesh], &levelled.own[mesh][..]));
                let seen = Seen { instance_lods: &instance_lods, levels };
                look.spread.add(self.stage, self.scene, seen, Skinned { vertices: &own, places }, fresh);
                let levels = instance_lods.iter().filter(|instance_lod| instance_lod.max_influences > 0);
                let levels = levels.map(|instance_lod| skin.clusters.level(instance_lod.mesh_lod));
                let clusters = match look.way.by {
                    By::All => levels.clone().map(|level| level.clusters).sum(),
                    By::Gate => skin.active.dispatched.read_blocking(self.gpu)?[3],
                };
                let drawn: u64 = levels.map(|level| u64::from(level.indices)).sum();
                let all = skin.crowd.instances as u64;
                let full = skin.clusters.level(0);
                for (sums, found) in [
                    (&mut look.clusters, [clusters.into(), all * u64::from(full.clusters)]),
                    (&mut look.triangles, [drawn, all * u64::from(full.indices)]),
                ] {
                    *sums = [sums[0] + found[0], sums[1] + found[1]];
                }
            }
        }
        Ok(())
    }
}

impl Look {
    /// Palettes, the choice of clusters, and vertices.
    fn skin(&self, encoder: &mut wgpu::CommandEncoder) {
        for mesh in &self.meshes {
            match self.way.by {
                By::Gate => mesh.skin.record_updated_bones(encoder),
                By::All => mesh.skin.record_all(encoder),
            }
        }
    }

    /// Who is seen and how far they fade, and the weights of their morph targets.
    fn decide(&self, encoder: &mut wgpu::CommandEncoder) {
        for mesh in &self.meshes {
            mesh.lod.record(encoder);
            mesh.weights.record(encoder);
        }
    }

    /// The same, and skinning.
    fn compute(&self, encoder: &mut wgpu::CommandEncoder) {
        self.decide(encoder);
        self.skin(encoder);
    }

    fn draw(&self, target: &Target, encoder: &mut wgpu::CommandEncoder) {
        target.record(encoder, SKY, |pass| self.meshes.iter().for_each(|mesh| mesh.scene.draw(pass)));
    }

    fn figures(&self) -> Figures {
        let vertices: usize = self.meshes.iter().map(|mesh| mesh.skin.skinned.len()).sum();
        let Times { frame, compute, draw, skin } = &self.times;
        let [frame, compute, draw, skin] =
            [frame, compute, draw, skin].map(|times| middle(times.clone()).unwrap_or(0.0));
        Figures {
            frame_nanoseconds: frame,
            compute_nanoseconds: compute,
            draw_nanoseconds: draw,
            nanoseconds_per_vertex: skin / vertices as f64,
            skinned_fraction: fraction(self.clusters),
            triangle_fraction: fraction(self.triangles),
            vertex_error: self.spread.errors(),
        }
    }
}

fn fraction([some, all]: [u64; 2]) -> f64 {
    some as f64 / all.max(1) as f64
}

/// What all looks share.
struct World<'a> {
    gpu: &'a Gpu,
    stage: &'a Stage<'a>,
    placements: Buffer<Affine>,
    clip_from_world: Mat4,
    renderer: SkinnedRenderer,
    /// One a mesh.
    albedos: Vec<Albedo>,
}

impl<'a> World<'a> {
    fn new(gpu: &'a Gpu, stage: &'a Stage<'a>, scene: &Scene) -> Result<Self, Error> {
        if stage.plan.model.meshes.is_empty() {
            let bound = "must be at least one that is not compressed with Draco";
            return Err(InputError::new("model.meshes", "none", bound).into());
        }
        let deepest = scene.origins.iter().map(|origin| origin[2]).fold(0.0, f32::max);
        let far = 2.0 * deepest + 4.0 * stage.plan.size * stage.metres_a_unit;
        let aspect = ASPECT[0] as f32 / ASPECT[1] as f32;
        let projection =
            camera::rh::proj::directx::perspective(FIELD_OF_VIEW, aspect, stage.projection.near, far);
        let checks = ColorTexture::new(gpu, &checks(), true)?.into();
        Ok(Self {
            placements: Buffer::from_slice(gpu, "placements", &placements(scene))?,
            // The camera is at the origin and looks along -Z.
            clip_from_world: projection,
            renderer: SkinnedRenderer::new(gpu, COLOR_FORMAT)?,
            albedos: Albedo::of_meshes(gpu, &stage.plan.model, &checks, ColorTexture::new)?,
            gpu,
            stage,
        })
    }

    fn look(&self, device: &Device, way: Way) -> Result<Look, Error> {
        let meshes = 0..self.stage.plan.model.meshes.len();
        Ok(Look {
            way,
            meshes: meshes.map(|mesh| self.drawable(device, way, mesh)).collect::<Result<_, _>>()?,
            times: Times::default(),
            spread: Spread::default(),
            clusters: [0; 2],
            triangles: [0; 2],
        })
    }

    fn drawable(&self, device: &Device, way: Way, index: usize) -> Result<Drawable, Error> {
        let Self { gpu, stage, placements, .. } = self;
        let Way { by, skinning, triangles } = way;
        let (model, count) = (stage.model(triangles), stage.instances.len());
        let levels = LevelRanges::new(&level_begins(stage, triangles, index))?;
        let matrices = match by {
            By::All => device.full.crowd.model_matrices(),
            By::Gate => device.gated.frame.model_matrices(),
        };
        let skin = SkinFrame::new(gpu, model, index, matrices, count, Blend::Linear)?;
        let (mesh, albedo) = (&model.meshes[index], &self.albedos[index]);
        let playing = match by {
            By::All => &device.full.crowd.instances,
            By::Gate => &device.gated.crowd.instances,
        };
        let keys = WeightSet::new(mesh, &stage.set, &[stage.plan.clip_index])?;
        let weights = MorphWeightsPass::new(gpu)?.prepare(gpu, &keys, playing, &skin.crowd)?;
        let drawn = Buffer::new(gpu, "drawn", list_words(count, 1 + levels.distances().len()))?;
        let instances = SkinnedInstances {
            mesh: &skin.mesh,
            skinned: &skin.skinned,
            placements,
            drawn: &drawn,
            albedo,
            light: Light::default(),
        };
        let mut scene = self.renderer.scene(gpu, &instances)?;
        scene.set_camera(gpu, self.clip_from_world)?;
        let [near, far] = fade(stage, skinning, index).unwrap_or(NO_FADE);
        let Extent { center, radius, .. } = stage.extents[index];
        let view = LodView {
            clip_from_world: self.clip_from_world,
            eye: Vec3::ZERO,
            fade_start: near,
            fade_end: far,
            steps: STEPS,
            max_influences: if let Skinning::All(instance_lod) = skinning {
                instance_lod.max_influences
            } else {
                InstanceLod::FULL.max_influences
            },
            center,
            radius,
            levels,
        };
        let lod = LodPass::new(gpu)?.prepare(
            gpu,
            &view,
            placements,
            &skin.crowd.instance_lods,
            &drawn,
            &scene.arguments,
        )?;
        Ok(Drawable { places: skin.clusters.places(), skin, lod, weights, scene })
    }
}

/// Metres from where on a mesh fades and from where on it is rigid, if it ever is.
pub fn fade(stage: &Stage<'_>, skinning: Skinning, mesh: usize) -> Option<[f32; 2]> {
    match skinning {
        Skinning::All(_) => None,
        Skinning::Fade(range) => Some([range.min, range.max].map(|units| units * stage.metres_a_unit)),
        Skinning::Bounded(pixels) => Some(stage.extents[mesh].fade_range(&stage.projection, pixels)),
    }
}

/// Metres from where on a mesh is as at levels 1, 2 … of the character.
pub fn level_begins(stage: &Stage<'_>, triangles: Triangles, mesh: usize) -> Vec<f32> {
    match (triangles, &stage.levelled) {
        (Triangles::Bounded(pixels), Some(levelled)) => {
            stage.extents[mesh].level_ranges(&stage.projection, pixels, levelled.errors.iter().copied())
        }
        _ => Vec::new(),
    }
}

/// From the model's space to the world, whose z comes towards the camera.
fn placements(scene: &Scene) -> Vec<Affine> {
    let place = |([x, y, z], [sine, cosine]): (&[f32; 3], &[f32; 2])| {
        [[*cosine, 0.0, *sine, *x], [0.0, 1.0, 0.0, *y], [-sine, 0.0, *cosine, -z]]
    };
    scene.origins.iter().zip(&scene.turns).map(place).collect()
}

/// Clay in two colours.
fn checks() -> Mips {
    let square = |x: u32, y: u32| match (x / 16 + y / 16) % 2 {
        0 => Rgba([214, 150, 104, 255]),
        _ => Rgba([150, 82, 52, 255]),
    };
    Mips::of_color(RgbaImage::from_fn(64, 64, square))
}
