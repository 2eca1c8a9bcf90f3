//! How far what a view of a scene draws lies from its place, in pixels.
//!
//! Two surfaces of each instance are compared: the model at full detail, posed by the CPU references at the time of the
//! scene; and what is drawn, that is the triangles in the draw of the list that the view has put the instance into, between
//! the vertices that the device has skinned, with bones that keep old poses and influences that have faded, and moved as far
//! towards the next coarser level as the view has moved them. Both have
//! samples: vertices, the middles of edges and those of triangles, as far as they lie inside the view volume, hidden or not.
//! The partner of a sample is the same vertex if the other surface has it and the vertex is not on its way to another. Otherwise it is the nearest point on the other
//! surface, among all triangles of the same primitive (which collapses made which triangle is not recorded; of joined levels,
//! among all triangles). The
//! displacement is the distance between sample and partner in the picture.
//!
//! Terrain and reliefs have one level of detail and are not measured.

use std::collections::{HashMap, HashSet};

use eye::{Eye, is_inside};
use glam::{DMat4, DQuat, DVec2, DVec3, DVec4};
use rayon::prelude::*;
use relievo::asset::{Affine, Model};
use relievo::ops::lod::OBJECT_LEVELS;
use relievo::scene::query::{DrawnAs, DrawnInstance};
use relievo::scene::{Camera, ClipTime, InstanceId, ObjectId, Placement, Scene, View};
use relievo::{Error, InputError, ops::skinning};
use serde::Serialize;
use surface::{Primitive, Sample, Surface, Watched};

use crate::distance::tree::Tree;

mod eye;
mod surface;

/// How far the instances of a frame are drawn from their places, in one view.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize)]
pub struct Displacement {
    /// The number of pixels that the view permits.
    pub pixels: f32,
    /// The largest displacement of a sample, in pixels.
    pub largest: f64,
    /// The largest displacement of a sample in the world, in world units.
    pub largest_in_world: f64,
    /// The largest change, in pixels, of the offset of a vertex's partner since the frame that was measured before; 0 if
    /// there was none.
    pub jump: f64,
    /// Number of samples inside the view volume, of both surfaces.
    pub samples: u64,
    /// Number of samples that are nearer to the eye than the near plane and their own displacement, and therefore do not
    /// count.
    pub left_out: u64,
    /// Number of samples of instances that the view does not draw.
    pub missing: u64,
    /// Number of instances that are drawn, level by level, also of those that the meter leaves out.
    pub levels: [u64; OBJECT_LEVELS as usize],
}

/// Measures the displacement of meshes and characters of a scene, frame by frame.
pub struct DisplacementMeter {
    watched: Vec<Watched>,
    /// The instances that are measured in a frame.
    which: Which,
    /// The offsets of partners of vertices in the last frame, in pixels.
    last: HashMap<Vertex, DVec2>,
}

/// Some of an object's instances.
enum Which {
    /// At most so many, evenly spread.
    AtMost(usize),
    /// These, of all objects.
    These(HashSet<InstanceId>),
}

/// A vertex of an instance: of which merged mesh, and its index in it.
type Vertex = (InstanceId, usize, u32);

/// What was found in the samples of an instance, with the index of the merged mesh.
type FoundInMeshes = Vec<(usize, Found)>;

/// What was found in some samples.
#[derive(Default)]
struct Found {
    all: Displacement,
    /// The offsets of vertices.
    offsets: Vec<(u32, DVec2)>,
}

/// A surface between its points, as a matrix projects it.
struct Side<'a> {
    surface: &'a Surface,
    points: &'a [DVec3],
    tree: Option<Tree>,
    /// Which vertices are on their way to others, if any is.
    moves: &'a [bool],
    clip: &'a DMat4,
}

impl Default for DisplacementMeter {
    fn default() -> Self {
        Self::new()
    }
}

impl DisplacementMeter {
    /// A meter that watches nothing yet, and measures all instances of what it will watch.
    pub fn new() -> Self {
        Self::of_at_most(usize::MAX)
    }

    /// A meter that watches nothing yet. In each frame it measures at most so many instances of an object, at least one: each
    /// so-manieth of those that the view may show, in the order of [`Scene::instances`], beginning with the first.
    pub fn of_at_most(instances: usize) -> Self {
        Self { watched: Vec::new(), which: Which::AtMost(instances.max(1)), last: HashMap::new() }
    }

    /// Measures these instances alone from now on, of whatever it watches.
    pub fn choose(&mut self, instances: impl IntoIterator<Item = InstanceId>) {
        self.which = Which::These(instances.into_iter().collect());
    }

    /// Watches an object of a scene, which was added as this model: a mesh or a character.
    ///
    /// # Errors
    /// [`InputError`] for an object that is not of the scene, and for a model that cannot be added to one.
    pub fn watch(&mut self, scene: &Scene, object: ObjectId, model: &Model) -> Result<(), InputError> {
        self.watched.push(Watched::new(scene, object, model)?);
        Ok(())
    }

    /// Forgets the frame that was measured last, as if the next one were the first: its jump is 0.
    pub fn forget_last(&mut self) {
        self.last.clear();
    }

    /// Measures what a view shows of the objects that are watched, in the last frame that was recorded. It must be
    /// submitted, and nothing in the scene may have changed since. Waits for the device.
    ///
    /// # Errors
    /// [`InputError`] for a view without a frame, and for a drawn vertex that was not skinned; [`relievo::gpu::GpuError`].
    pub fn measure(&mut self, scene: &Scene, view: &View) -> Result<Displacement, Error> {
        let Some(camera) = view.camera() else {
            return Err(InputError::new("view.camera", "none", "must be set").into());
        };
        let eye = Eye::new(camera)?;
        let mut frame = Displacement { pixels: view.quality().pixels, ..Displacement::default() };
        let mut offsets = HashMap::new();
        for watched in &mut self.watched {
            let all = scene.drawn_instances(view, watched.object)?;
            let drawn = all.iter().filter_map(|instance| instance.drawn);
            drawn.for_each(|drawn| frame.levels[drawn.list as usize / 2] += 1);
            let measured: Vec<_> = match &self.which {
                Which::AtMost(most) => {
                    let each = all.len().div_ceil(*most).max(1);
                    all.into_iter().step_by(each).collect()
                }
                Which::These(these) => {
                    all.into_iter().filter(|drawn| these.contains(&drawn.instance)).collect()
                }
            };
            for DrawnAs { list, .. } in measured.iter().filter_map(|instance| instance.drawn) {
                watched.read_list(scene, view, list)?;
            }
            for (instance, found) in found_of(scene, watched, &measured, camera, &eye)? {
                for (mesh, found) in found {
                    frame = frame.and(found.all);
                    let vertex = |(vertex, offset)| ((instance.instance, mesh, vertex), offset);
                    offsets.extend(found.offsets.into_iter().map(vertex));
                }
            }
        }
        let change = |(vertex, offset): (&Vertex, &DVec2)| Some(self.last.get(vertex)?.distance(*offset));
        frame.jump = offsets.iter().filter_map(change).fold(0.0, f64::max);
        self.last = offsets;
        Ok(frame)
    }
}

impl Displacement {
    /// The same figures for both of two frames: the largest displacements, and sums of samples and instances.
    #[must_use]
    pub fn and(self, other: Self) -> Self {
        Self {
            pixels: self.pixels.max(other.pixels),
            largest: self.largest.max(other.largest),
            largest_in_world: self.largest_in_world.max(other.largest_in_world),
            jump: self.jump.max(other.jump),
            samples: self.samples + other.samples,
            left_out: self.left_out + other.left_out,
            missing: self.missing + other.missing,
            levels: std::array::from_fn(|level| self.levels[level] + other.levels[level]),
        }
    }
}

/// The number of instances whose vertices are read at once.
const READ: usize = 64;

/// What is found in the samples of each instance.
fn found_of<'a>(
    scene: &Scene,
    watched: &Watched,
    instances: &'a [DrawnInstance],
    camera: &Camera,
    eye: &Eye,
) -> Result<Vec<(&'a DrawnInstance, FoundInMeshes)>, Error> {
    let mut all = Vec::with_capacity(instances.len());
    for part in instances.chunks(READ) {
        let vertices = watched.vertices(scene, part)?;
        let subject = |(at, instance): (usize, &'a DrawnInstance)| {
            // The instances of a static mesh share their vertices.
            let vertices = vertices.get(at).or(vertices.first()).map_or(&[][..], Vec::as_slice);
            let placement = scene.placement(instance.instance)?;
            Ok(Measurable { instance, vertices, placement, time: scene.clip_time(instance.instance)? })
        };
        let subjects: Vec<_> = part.iter().enumerate().map(subject).collect::<Result<_, Error>>()?;
        let found = |subject: &Measurable<'a, '_>| {
            Ok((subject.instance, instance_found(watched, subject, camera, eye)?))
        };
        all.extend(subjects.par_iter().map(found).collect::<Result<Vec<_>, Error>>()?);
    }
    Ok(all)
}

/// An instance that is measured, with what the scene tells of it.
struct Measurable<'a, 'b> {
    instance: &'a DrawnInstance,
    /// The vertices that are drawn, mesh by mesh.
    vertices: &'b [Vec<Option<skinning::Vertex>>],
    placement: Placement,
    time: Option<ClipTime>,
}

/// What is found in the samples of an instance: for each primitive, its merged mesh and both directions.
fn instance_found(
    watched: &Watched,
    Measurable { instance, vertices, placement, time }: &Measurable<'_, '_>,
    camera: &Camera,
    eye: &Eye,
) -> Result<FoundInMeshes, Error> {
    let placed = placed(placement, camera.cell);
    let right = transformed(&watched.posed(*time), &placed);
    let Some(drawn) = &instance.drawn else {
        let missing = |Primitive { mesh, full, .. }: &Primitive| {
            (*mesh, inside(&Side::new(full, &right[*mesh], &eye.right, None)))
        };
        return Ok(watched.primitives.par_iter().map(missing).collect());
    };
    let shown = transformed(&watched.drawn(vertices, drawn)?, &matrix(&drawn.placement));
    let moves = watched.moves(drawn);
    let nothing = Surface::default();
    let both = |Primitive { mesh, full, lists, .. }: &Primitive| {
        let coarse = lists[drawn.list as usize].as_ref().unwrap_or(&nothing);
        let full = Side::new(full, &right[*mesh], &eye.right, Some(&moves[*mesh]));
        let coarse = Side::new(coarse, &shown[*mesh], &eye.drawn, Some(&moves[*mesh]));
        let back = Found { offsets: Vec::new(), ..compared(eye, &coarse, &full) };
        [(*mesh, compared(eye, &full, &coarse)), (*mesh, back)]
    };
    Ok(watched.primitives.par_iter().flat_map_iter(both).collect())
}

impl<'a> Side<'a> {
    /// `moves` are the vertices that are on their way, if it is searched for partners.
    fn new(surface: &'a Surface, points: &'a [DVec3], clip: &'a DMat4, moves: Option<&'a [bool]>) -> Self {
        let tree = moves.and_then(|_| surface.tree(points));
        Self { surface, points, tree, moves: moves.unwrap_or_default(), clip }
    }

    /// A sample's position, and where it is projected to if that is inside the view volume.
    fn seen(&self, sample: &Sample) -> Option<(DVec3, DVec4)> {
        let point = sample.position(self.points);
        let clip = *self.clip * point.extend(1.0);
        is_inside(clip).then_some((point, clip))
    }

    /// Whether a vertex is on its way to another.
    fn moves(&self, vertex: u32) -> bool {
        self.moves.get(vertex as usize).is_some_and(|moves| *moves)
    }

    /// The partner of a sample of the other side.
    fn partner(&self, sample: &Sample, point: DVec3) -> Option<DVec3> {
        match sample {
            Sample::Vertex(vertex) if self.surface.has(sample) && !self.moves(*vertex) => {
                Some(self.points[*vertex as usize])
            }
            _ => {
                let same = self.surface.has(sample).then(|| sample.position(self.points));
                self.tree.as_ref().map(|tree| tree.nearest_point(point, same))
            }
        }
    }
}

/// Counts the samples inside the view volume, none of which is drawn.
fn inside(side: &Side<'_>) -> Found {
    let samples = side.surface.samples.iter().filter(|sample| side.seen(sample).is_some()).count() as u64;
    let all = Displacement { samples, missing: samples, ..Displacement::default() };
    Found { all, offsets: Vec::new() }
}

/// Compares the samples of one surface with their partners on the other. A sample without any counts as infinitely far.
fn compared(eye: &Eye, from: &Side<'_>, to: &Side<'_>) -> Found {
    let add = |mut found: Found, sample: &Sample| {
        let Some((point, clip)) = from.seen(sample) else { return found };
        let partner = to.partner(sample, point);
        let off = partner.map_or(f64::INFINITY, |partner| partner.distance(point));
        found.all.samples += 1;
        if off.is_finite() && eye.is_too_near(point, off) {
            found.all.left_out += 1;
            return found;
        }
        let offset = partner
            .map_or(DVec2::INFINITY, |partner| eye.pixel(*to.clip * partner.extend(1.0)) - eye.pixel(clip));
        found.all.largest = found.all.largest.max(offset.length());
        found.all.largest_in_world = found.all.largest_in_world.max(off);
        if let Sample::Vertex(vertex) = sample {
            found.offsets.push((*vertex, offset));
        }
        found
    };
    let all = from.surface.samples.par_iter().fold(Found::default, add);
    all.reduce(Found::default, Found::and)
}

impl Found {
    fn and(mut self, mut other: Self) -> Self {
        self.offsets.append(&mut other.offsets);
        Self { all: self.all.and(other.all), ..self }
    }
}

/// The transform from the model's space to the corner of a cell.
pub(super) fn placed(placement: &Placement, cell: [i32; 3]) -> DMat4 {
    let cells = |axis: usize| f64::from(placement.cell[axis]) - f64::from(cell[axis]);
    let corner = DVec3::from([0, 1, 2].map(cells)) * f64::from(Placement::CELL);
    let [x, y, z, w] = placement.turn.to_array().map(f64::from);
    let turn = DQuat::from_xyzw(x, y, z, w).normalize();
    let at = corner + placement.offset.as_dvec3();
    DMat4::from_scale_rotation_translation(placement.scale.as_dvec3(), turn, at)
}

/// A matrix of three rows.
pub(super) fn matrix(rows: &Affine) -> DMat4 {
    let [x, y, z] = rows.map(|row| DVec4::from(row.map(f64::from)));
    DMat4::from_cols(x, y, z, DVec4::W).transpose()
}

fn transformed(meshes: &[Vec<DVec3>], matrix: &DMat4) -> Vec<Vec<DVec3>> {
    let all = |points: &Vec<DVec3>| points.iter().map(|point| matrix.transform_point3(*point)).collect();
    meshes.iter().map(all).collect()
}
