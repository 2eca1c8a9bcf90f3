//! A crowd before a camera, with what all gates need.

use super::gates::{GateMode, Source};
use super::levels::Levelled;
use super::options::{CrowdOptions, DrawnOptions, MeshDetail, NEAR, SkinningDetail, Subject};
use super::placement::{Placements, chance};
use super::progress::{Listener, during};
use crate::InputError;
use crate::animation::instance::{Instance, Wrap};
use crate::animation::local_to_model::reference::local_to_model;
use crate::animation::lod::OMEGA_ONE;
use crate::animation::order::Order;
use crate::animation::{ClipSet, Gate, Lod, Projection};
use crate::asset::{Affine, Clip, Model, bone_radii};
use crate::skinning::{Extent, poses_of};

/// Lines of the picture.
pub(crate) const LINES: u32 = 1080;

/// Radians, vertical.
pub(crate) const FIELD_OF_VIEW: f32 = std::f32::consts::FRAC_PI_3;

/// A crowd, its clip, and what all gates need.
pub(crate) struct Stage<'a> {
    pub subject: Subject<'a>,
    pub clip: &'a Clip,
    pub options: &'a CrowdOptions,
    pub order: Order,
    pub set: ClipSet,
    /// Metres from each bone, along its axes, where errors are measured: its length.
    pub radii: Vec<f32>,
    /// How far gates keep watch: as far, and where the crowd is drawn, to the last vertex.
    watched: Vec<f32>,
    pub instances: Vec<Instance>,
    pub metres_a_unit: f32,
    pub projection: Projection,
    /// What each mesh does in the clip, where the crowd is drawn.
    pub extents: Vec<Extent>,
    /// The model with levels of detail, where the crowd is drawn with these.
    pub levelled: Option<Levelled>,
    /// The middle of the model's height at rest, metres.
    middle: f32,
}

impl<'a> Stage<'a> {
    /// With its meshes where it is drawn.
    pub(crate) fn new(
        subject: Subject<'a>,
        options: &'a CrowdOptions,
        drawn: Option<&DrawnOptions>,
        listener: Listener<'_>,
    ) -> Result<Self, InputError> {
        let (clip, skeleton) = (subject.clip()?, &subject.model.skeleton);
        let set = ClipSet::new(&[clip])?;
        let lengths = skeleton.lengths();
        let [low, high] = corners(&local_to_model(skeleton, &skeleton.rest()), &lengths);
        let extent = (0..3).map(|axis| high[axis] - low[axis]).fold(0.0, f64::max);
        if !(extent > 0.0 && extent.is_finite()) {
            let bound = "must be finite and above 0: the model at rest is a point";
            return Err(InputError::new("model.extent", extent, bound));
        }
        let metres_a_unit = (extent / f64::from(options.size)) as f32;
        let starts = (0..options.instances as u32).map(|at| clip.duration() * chance(options.seed, at, 0));
        // Up, so that it reaches all the points.
        let radii: Vec<f32> = lengths.iter().map(|length| (*length as f32).next_up()).collect();
        let meshes = if drawn.is_some() { &subject.model.meshes[..] } else { &[] };
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
            extents: extents(subject, clip, meshes.len(), listener)?,
            levelled: levelled(subject, clip, drawn, listener)?,
            middle: ((low[1] + high[1]) / 2.0) as f32,
            subject,
            clip,
            options,
        })
    }

    /// The model, with levels of detail or without.
    pub(crate) fn model(&self, mesh: MeshDetail) -> &Model {
        match (mesh, &self.levelled) {
            (MeshDetail::Bounded { .. }, Some(levelled)) => &levelled.model,
            _ => self.subject.model,
        }
    }

    /// A gate of the clip.
    pub(crate) fn gate(&self, mode: &GateMode) -> Result<Gate, InputError> {
        let Self { subject, clip, order, set, watched, .. } = self;
        Source { skeleton: &subject.model.skeleton, clip, order, set, radii: watched }.gate(mode)
    }

    /// Bones of all instances.
    pub(crate) fn pairs(&self) -> usize {
        self.instances.len() * self.set.bones()
    }

    /// The layout, so many units before the camera.
    pub(crate) fn placements(&self, distance: f32) -> Placements {
        let Self { options, metres_a_unit, middle, .. } = *self;
        Placements::of_layout(options, metres_a_unit, middle, distance * metres_a_unit)
    }

    /// All instances at one place on the axis, so many pixels large, turned every way.
    pub(crate) fn line_up(&self, tall_pixels: f32) -> Placements {
        let extent = self.options.size * self.metres_a_unit;
        let depth = extent * self.projection.focal_pixels / tall_pixels;
        Placements::at_one_place(self.instances.len(), [0.0, -self.middle, depth])
    }

    /// What gates know of instances, with errors of so many pixels allowed.
    pub(crate) fn lods(&self, placements: &Placements, gate: &Gate, pixels: f32) -> Vec<Lod> {
        let depth = |origin: &[f32; 3]| origin[2].max(self.projection.near);
        let nearest = placements.origins.iter().map(depth).fold(f32::INFINITY, f32::min);
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
            Lod { omega: self.options.range.omega(distance), allowed, weight, flags: 0 }
        };
        placements.origins.iter().map(lod).collect()
    }

    /// Metres from where on a mesh fades and from where on it is rigid, if it ever is.
    pub(crate) fn fade(&self, skinning: SkinningDetail, mesh: usize) -> Option<[f32; 2]> {
        let range = self.options.range;
        match skinning {
            SkinningDetail::Full | SkinningDetail::Truncate { .. } => None,
            SkinningDetail::Fade => Some([range.min, range.max].map(|units| units * self.metres_a_unit)),
            SkinningDetail::Bounded { pixels } => {
                Some(self.extents[mesh].fade_range(&self.projection, pixels))
            }
        }
    }

    /// Metres from where on a mesh is as at levels 1, 2 … of the character.
    pub(crate) fn level_begins(&self, detail: MeshDetail, mesh: usize) -> Vec<f32> {
        match (detail, &self.levelled) {
            (MeshDetail::Bounded { pixels }, Some(levelled)) => {
                self.extents[mesh].level_ranges(&self.projection, pixels, levelled.errors.iter().copied())
            }
            _ => Vec::new(),
        }
    }
}

/// The mean of Ω over instances.
pub(crate) fn mean_omega(lods: &[Lod]) -> f64 {
    lods.iter().map(|lod| f64::from(lod.omega)).sum::<f64>() / (lods.len() as f64 * f64::from(OMEGA_ONE))
}

/// Bones of an instance that its clip moves.
pub(crate) fn moving_bones(gate: &Gate) -> usize {
    gate.animated_bones().count(0)
}

/// What each of so many meshes does in the clip.
fn extents(
    subject: Subject<'_>,
    clip: &Clip,
    meshes: usize,
    listener: Listener<'_>,
) -> Result<Vec<Extent>, InputError> {
    if meshes == 0 {
        return Ok(Vec::new());
    }
    let poses = poses_of(clip)?;
    let extent = |mesh| Extent::new(subject.model, mesh, &[subject.clip], poses);
    during(listener, "measuring", || (0..meshes).map(extent).collect())
}

/// The model with levels, where these are drawn.
fn levelled(
    subject: Subject<'_>,
    clip: &Clip,
    drawn: Option<&DrawnOptions>,
    listener: Listener<'_>,
) -> Result<Option<Levelled>, InputError> {
    match drawn.map(|drawn| drawn.mesh) {
        Some(MeshDetail::Bounded { .. }) => {
            let poses = poses_of(clip)?;
            during(listener, "simplifying", || Levelled::new(subject.model, subject.clip, poses)).map(Some)
        }
        Some(MeshDetail::Full) | None => Ok(None),
    }
}

/// The corners of a box around bones and as far as they are long.
fn corners(models: &[Affine], lengths: &[f64]) -> [[f64; 3]; 2] {
    let mut corners = [[f64::INFINITY; 3], [f64::NEG_INFINITY; 3]];
    for (model, length) in models.iter().zip(lengths) {
        for (axis, row) in model.iter().enumerate() {
            let extent = length * f64::from(row[0].hypot(row[1]).hypot(row[2]));
            // A bone points somewhere: half its length is its middle.
            corners[0][axis] = corners[0][axis].min(f64::from(row[3]) - extent / 2.0);
            corners[1][axis] = corners[1][axis].max(f64::from(row[3]) + extent / 2.0);
        }
    }
    corners
}
