//! Who plays, and where the camera stands.

use relievo::InputError;
use relievo::animation::gate::reference::scramble;
use relievo::animation::instance::{Instance, Wrap};
use relievo::animation::local_to_model::reference::local_to_model;
use relievo::animation::lod::OMEGA_ONE;
use relievo::animation::order::Order;
use relievo::animation::{ClipSet, Gate, Lod, Projection};
#[cfg(feature = "gpu")]
use relievo::asset::Model;
use relievo::skinning;

use super::Layout;
use super::gates::{Mode, Source};
use super::plan::Plan;
#[cfg(feature = "gpu")]
use super::triangles::{Levelled, Triangles};
#[cfg(feature = "gpu")]
use crate::progress::during;

/// A crowd, its clip, and what all gates need.
pub struct Stage<'a> {
    pub plan: &'a Plan,
    pub order: Order,
    pub set: ClipSet,
    /// Metres from each bone, along its axes, where errors are measured: its length.
    pub bone_radii: Vec<f32>,
    /// How far gates keep watch: as far, and where the crowd is drawn, to the last vertex.
    watched: Vec<f32>,
    pub instances: Vec<Instance>,
    pub metres_a_unit: f32,
    pub projection: Projection,
    /// What each mesh does in the clip, where the crowd is drawn.
    #[cfg(feature = "gpu")]
    pub extents: Vec<skinning::Extent>,
    /// The model with levels of detail, where the crowd is drawn with these.
    #[cfg(feature = "gpu")]
    pub levelled: Option<Levelled>,
    /// The middle of the model's height at rest, metres.
    middle: f32,
}

/// Where instances are: seen from a camera, x right, y up, z ahead, metres.
pub struct Scene {
    pub origins: Vec<[f32; 3]>,
    /// Sine and cosine of the turn about the vertical axis; 0 faces the camera.
    pub turns: Vec<[f32; 2]>,
}

impl<'a> Stage<'a> {
    pub fn new(plan: &'a Plan) -> Result<Self, InputError> {
        let skeleton = &plan.model.skeleton;
        let set = ClipSet::new(&[&plan.clip])?;
        let lengths = skeleton.lengths();
        let [low, high] = extents(&local_to_model(skeleton, &skeleton.rest()), &lengths);
        let extent = (0..3).map(|axis| high[axis] - low[axis]).fold(0.0, f64::max);
        if !(extent > 0.0 && extent.is_finite()) {
            let bound = "must be finite and above 0: the model at rest is a point";
            return Err(InputError::new("model.extent", extent, bound));
        }
        let metres_a_unit = (extent / f64::from(plan.size)) as f32;
        let starts = (0..plan.instances as u32).map(|at| plan.clip.duration() * chance(plan.seed, at, 0));
        // Up, so that it reaches all the points.
        let bone_radii: Vec<f32> = lengths.iter().map(|length| (*length as f32).next_up()).collect();
        let meshes = if plan.drawn.is_some() { &plan.model.meshes[..] } else { &[] };
        let vertices = relievo::asset::bone_radii(skeleton.len(), &plan.model.skins, meshes);
        Ok(Self {
            order: Order::new(skeleton),
            set,
            watched: bone_radii.iter().zip(&vertices).map(|(bone, vertex)| bone.max(*vertex)).collect(),
            bone_radii,
            instances: starts.map(|start| Instance::new(0, Wrap::Loop, start, 1.0)).collect(),
            metres_a_unit,
            projection: plan.projection(metres_a_unit),
            #[cfg(feature = "gpu")]
            extents: extents_of(plan, meshes.len())?,
            #[cfg(feature = "gpu")]
            levelled: match plan.triangles {
                Triangles::Bounded(_) => {
                    Some(Levelled::new(&plan.model, plan.clip_index, skinning::poses_of(&plan.clip)?)?)
                }
                Triangles::All => None,
            },
            middle: ((low[1] + high[1]) / 2.0) as f32,
            plan,
        })
    }

    /// The model, with levels of detail or without.
    #[cfg(feature = "gpu")]
    pub fn model(&self, triangles: Triangles) -> &Model {
        match (triangles, &self.levelled) {
            (Triangles::Bounded(_), Some(levelled)) => &levelled.model,
            _ => &self.plan.model,
        }
    }

    /// A gate of the clip; `budget` is that of [`Mode::Budget`], in bones.
    pub fn gate(&self, mode: Mode, budget: u32) -> Result<Gate, InputError> {
        let source = Source {
            skeleton: &self.plan.model.skeleton,
            clip: &self.plan.clip,
            order: &self.order,
            set: &self.set,
            bone_radii: &self.watched,
            weights: &self.plan.weights,
        };
        source.gate(mode, self.plan.period, budget)
    }

    /// Bones of all instances.
    pub fn pairs(&self) -> usize {
        self.instances.len() * self.set.bones()
    }

    /// The layout, so many units before the camera.
    pub fn scene(&self, distance: f32) -> Scene {
        let count = self.instances.len();
        let columns = (count as f64).sqrt().ceil() as usize;
        let rows = count.div_ceil(columns);
        let spacing = self.plan.spacing * self.plan.size * self.metres_a_unit;
        let [width, depth] = [columns - 1, rows - 1].map(|gaps| gaps as f32 * spacing);
        let number = |at: usize, of: u32| chance(self.plan.seed, at as u32, of);
        let place = |at: usize| match self.plan.layout {
            Layout::Grid => [(at % columns) as f32 * spacing - width / 2.0, (at / columns) as f32 * spacing],
            Layout::Random => [(number(at, 1) - 0.5) * width, number(at, 2) * depth],
        };
        let places: Vec<_> = (0..count).map(place).collect();
        let nearest = places.iter().map(|place| place[1]).fold(f32::INFINITY, f32::min);
        let front = distance * self.metres_a_unit - nearest;
        let turn = |at| match self.plan.layout {
            Layout::Grid => [0.0, 1.0],
            Layout::Random => around(number(at, 3)),
        };
        Scene {
            origins: places.iter().map(|[x, z]| [*x, -self.middle, z + front]).collect(),
            turns: (0..count).map(turn).collect(),
        }
    }

    /// All instances at one place on the axis, as large as the plan says, turned every way.
    pub fn line_up(&self) -> Scene {
        let extent = self.plan.size * self.metres_a_unit;
        let depth = extent * self.projection.focal_pixels / self.plan.tall;
        let count = self.instances.len();
        Scene {
            origins: vec![[0.0, -self.middle, depth]; count],
            turns: (0..count).map(|at| around(at as f32 / count as f32)).collect(),
        }
    }

    /// What gates know of a scene's instances, with errors of so many pixels allowed.
    pub fn lods(&self, scene: &Scene, gate: &Gate, pixels: f32) -> Vec<Lod> {
        let depth = |origin: &[f32; 3]| origin[2].max(self.projection.near);
        let nearest = scene.origins.iter().map(depth).fold(f32::INFINITY, f32::min);
        let lod = |origin: &[f32; 3]| {
            // On the ground: the camera's height is no distance.
            let distance = origin[0].hypot(origin[2]) / self.metres_a_unit;
            let allowed = match gate {
                Gate::Bounded(table) if table.radius() > 0.0 => {
                    table.units(self.projection.allowed(*origin, table.radius(), pixels))
                }
                _ => 0,
            };
            let weight = (65535.0 * nearest / depth(origin)).round().clamp(1.0, 65535.0) as u32;
            Lod { omega: self.plan.range.omega(distance), allowed, weight, flags: 0 }
        };
        scene.origins.iter().map(lod).collect()
    }
}

/// The mean of Ω over instances.
pub fn mean_omega(lods: &[Lod]) -> f64 {
    lods.iter().map(|lod| f64::from(lod.omega)).sum::<f64>() / (lods.len() as f64 * f64::from(OMEGA_ONE))
}

/// Bones of an instance that its clip moves.
pub fn moving_bones(gate: &Gate) -> usize {
    gate.animated_bones().count(0)
}

#[cfg(feature = "gpu")]
fn extents_of(plan: &Plan, meshes: usize) -> Result<Vec<skinning::Extent>, InputError> {
    if meshes == 0 {
        return Ok(Vec::new());
    }
    let poses = skinning::poses_of(&plan.clip)?;
    let extent = |mesh| skinning::Extent::new(&plan.model, mesh, &[plan.clip_index], poses);
    during("measuring", || (0..meshes).map(extent).collect())
}

/// The corners of a box around bones and as far as they are long.
fn extents(models: &[relievo::asset::Affine], lengths: &[f64]) -> [[f64; 3]; 2] {
    let mut corners = [[f64::INFINITY; 3], [f64::NEG_INFINITY; 3]];
    for (model, length) in models.iter().zip(lengths) {
        for (axis, row) in model.iter().enumerate() {
            let bone_radius = length * f64::from(row[0].hypot(row[1]).hypot(row[2]));
            // A bone points somewhere: half its length is its middle.
            corners[0][axis] = corners[0][axis].min(f64::from(row[3]) - bone_radius / 2.0);
            corners[1][axis] = corners[1][axis].max(f64::from(row[3]) + bone_radius / 2.0);
        }
    }
    corners
}

/// 0 to below 1: a number of an instance.
fn chance(seed: u32, instance: u32, of: u32) -> f32 {
    let word = scramble(scramble(scramble(seed).wrapping_add(instance)).wrapping_add(of));
    (word >> 8) as f32 / (1 << 24) as f32
}

fn around(fraction: f32) -> [f32; 2] {
    let (sine, cosine) = (fraction * std::f32::consts::TAU).sin_cos();
    [sine, cosine]
}
