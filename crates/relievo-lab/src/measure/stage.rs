//! A crowd before a camera, with the tables that all gates need.

use relievo::InputError;
use relievo::asset::{Clip, bone_radii};
use relievo::ops::animation::instance::{Instance, Wrap};
use relievo::ops::animation::lod::OMEGA_ONE;
use relievo::ops::animation::order::Order;
use relievo::ops::animation::priority::{Priorities, USER_DEFAULT};
use relievo::ops::animation::{
    AnimatedBones, BoundTable, ClipSet, ExpectationTable, Gate, Lod, PriorityTable, Projection,
};

use crate::measure::extent::Extent;
use crate::measure::gates::{GateMode, PATH, TICKS};
use crate::measure::options::{CrowdOptions, FIELD_OF_VIEW, LINES, NEAR, Subject};
use crate::measure::placement::{Placements, chance};

/// A crowd, its clip, and the tables that all gates need.
pub(crate) struct Stage<'a> {
    pub subject: Subject<'a>,
    pub clip: &'a Clip,
    pub options: &'a CrowdOptions,
    pub order: Order,
    pub set: ClipSet,
    /// For each bone, the distance in metres from its origin at which errors are measured: its length.
    pub radii: Vec<f32>,
    /// For each bone, the radius that gates bound: that of `radii`, or, if the crowd is drawn, of its
    /// furthest vertex.
    watched: Vec<f32>,
    pub instances: Vec<Instance>,
    pub metres_a_unit: f32,
    pub projection: Projection,
    /// The height above its origin of the middle of the model at rest, in metres.
    middle: f32,
}

impl<'a> Stage<'a> {
    /// Prepares the crowd. If it is drawn, gates bound the error of every vertex.
    pub(crate) fn new(
        subject: Subject<'a>,
        options: &'a CrowdOptions,
        is_drawn: bool,
    ) -> Result<Self, InputError> {
        let (clip, skeleton) = (subject.clip()?, &subject.model.skeleton);
        let set = ClipSet::new(&[clip])?;
        let lengths = skeleton.lengths();
        let Extent { largest, middle } = Extent::new(skeleton)?;
        let metres_a_unit = (largest / f64::from(options.size)) as f32;
        let starts = (0..options.instances as u32).map(|at| clip.duration() * chance(options.seed, at, 0));
        // Rounded up, so that the radius reaches all the points.
        let radii: Vec<f32> = lengths.iter().map(|length| (*length as f32).next_up()).collect();
        let meshes = if is_drawn { &subject.model.meshes[..] } else { &[] };
        let vertices = bone_radii(skeleton.len(), &subject.model.skins, meshes);
        let watched = radii.iter().zip(&vertices).map(|(bone, vertex)| bone.max(*vertex)).collect();
        Ok(Self {
            order: Order::new(skeleton),
            set,
            watched,
            radii,
            instances: starts.map(|start| Instance::new(0, Wrap::Loop, start, 1.0)).collect(),
            metres_a_unit,
            projection: Projection::new(LINES, FIELD_OF_VIEW, NEAR * metres_a_unit),
            middle: middle as f32,
            subject,
            clip,
            options,
        })
    }

    /// Makes a gate for the clip, with its table.
    pub(crate) fn gate(&self, mode: &GateMode) -> Result<Gate, InputError> {
        let (skeleton, clips) = (&self.subject.model.skeleton, [self.clip]);
        let Self { order, set, watched, .. } = self;
        let animated_bones = || AnimatedBones::new(order, set, &clips);
        let mut user = vec![USER_DEFAULT; skeleton.len()];
        for (name, priority) in &self.options.priorities {
            let path = format!("priorities.{name}");
            user[self.subject.model.bone(name).map_err(|error| InputError { path, ..error })?] = *priority;
        }
        let mut gate = match *mode {
            GateMode::Off => Gate::Off(animated_bones()?),
            GateMode::Uniform => Gate::Uniform(animated_bones()?),
            GateMode::Random => Gate::Random(animated_bones()?),
            GateMode::SkipPeriod { period, weights } => {
                let priorities = Priorities::new(skeleton, self.clip, Wrap::Loop, &weights, &user)?;
                let table = PriorityTable::new(order, set, &clips, &[priorities])?;
                Gate::SkipPeriod { table, period: (period * f64::from(TICKS)).round() as u32 }
            }
            GateMode::Budget { bones } => {
                let table = ExpectationTable::new(skeleton, set, &clips, watched, PATH)?;
                Gate::Budget { table, bones }
            }
            GateMode::Bounded { .. } => Gate::Bounded(BoundTable::new(skeleton, set, &clips, watched, PATH)?),
        };
        gate.never_skip(order, &user.iter().map(|priority| *priority == 1.0).collect::<Vec<_>>())?;
        Ok(gate)
    }

    /// Number of bones of all instances.
    pub(crate) fn pairs(&self) -> usize {
        self.instances.len() * self.set.bones()
    }

    /// The placements of the layout, `distance` units before the camera.
    pub(crate) fn placements(&self, distance: f32) -> Placements {
        let Self { options, metres_a_unit, middle, .. } = *self;
        Placements::of_layout(options, metres_a_unit, middle, distance * metres_a_unit)
    }

    /// Places all instances at one point of the optical axis, each turned by another angle, so far away that
    /// they are `tall_pixels` large.
    pub(crate) fn line_up(&self, tall_pixels: f32) -> Placements {
        let extent = self.options.size * self.metres_a_unit;
        let depth = extent * self.projection.focal_pixels / tall_pixels;
        Placements::at_one_place(self.instances.len(), [0.0, -self.middle, depth])
    }

    /// The level of detail of each instance, with errors of `pixels` allowed.
    pub(crate) fn lods(&self, placements: &Placements, gate: &Gate, pixels: f32) -> Vec<Lod> {
        let depth = |origin: &[f32; 3]| origin[2].max(self.projection.near);
        let nearest = placements.origins.iter().map(depth).fold(f32::INFINITY, f32::min);
        let lod = |origin: &[f32; 3]| {
            // The distance on the ground: the camera's height does not count.
            let distance = origin[0].hypot(origin[2]) / self.metres_a_unit;
            let allowed = match gate {
                Gate::Bounded(table) if table.radius() > 0.0 => {
                    table.units(self.projection.allowed(*origin, table.radius(), pixels))
                }
                _ => 0,
            };
            let weight = (65535.0 * nearest / depth(origin)).round().clamp(1.0, 65535.0) as u32;
            Lod { omega: self.options.range.omega(distance), allowed, weight, ..Lod::FULL }
        };
        placements.origins.iter().map(lod).collect()
    }
}

/// The mean of Ω over instances.
pub(crate) fn mean_omega(lods: &[Lod]) -> f64 {
    lods.iter().map(|lod| f64::from(lod.omega)).sum::<f64>() / (lods.len() as f64 * f64::from(OMEGA_ONE))
}

/// Number of bones of an instance that its clip moves.
pub(crate) fn animated_bones(gate: &Gate) -> usize {
    gate.animated_bones().count(0)
}
