//! Measures how far drawn vertices lie from those of the crowd in full, and what drawing a crowd costs.

use glam::Vec3;
use rayon::prelude::*;
use serde::Serialize;

use super::errors::{Errors, length};
use super::placement::{Placement, Placements};
use super::tally::Tally;
use crate::animation::Projection;
use crate::skinning::MeshLevels;
use crate::skinning::instance_lod::InstanceLod;
use crate::skinning::vertex::Vertex;

/// The cost of animating, skinning and drawing a crowd, as medians over the frames that were timed; and the
/// errors of its vertices in these frames.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct FrameCost {
    /// The time of gate, placements, sampling, concatenation, visibility, skinning and drawing in one
    /// submission.
    pub frame_nanoseconds: f64,
    /// The time of all that precedes the drawing, submitted alone.
    pub compute_nanoseconds: f64,
    /// The time of the drawing, submitted alone.
    pub draw_nanoseconds: f64,
    /// The time of palettes, the choice of clusters and the skinning of vertices, divided by the number of
    /// all vertices of the crowd.
    pub nanoseconds_per_vertex: f64,
    /// Share of all clusters that were skinned, 0 to 1.
    pub skinned_fraction: f64,
    /// Number of triangles that were drawn, divided by those of all meshes at level 0.
    pub triangle_fraction: f64,
    /// The distance of each vertex of the full crowd from the vertex that was drawn or, if a coarser mesh
    /// lacks the vertex, from the surface that was drawn.
    pub vertex_error: Errors,
}

/// Collects the distances between the vertices of two crowds.
#[derive(Clone)]
pub(crate) struct VertexMeter {
    metres: Tally,
    pixels: Tally,
    unseen: u64,
}

impl Default for VertexMeter {
    fn default() -> Self {
        Self { metres: Tally::new(), pixels: Tally::new(), unseen: 0 }
    }
}

/// The vertices of a mesh, instance by instance.
#[derive(Clone, Copy)]
pub(crate) struct Skinned<'a> {
    pub vertices: &'a [Vertex],
    /// For each vertex of the mesh, its index among the vertices of an instance.
    pub slots: &'a [u32],
}

impl Skinned<'_> {
    /// The position of a vertex, if `vertices` holds those of one instance only.
    fn position(&self, vertex: u32) -> Vec3 {
        Vec3::from(self.vertices[self.slots[vertex as usize] as usize].position)
    }
}

/// Which level of a mesh each instance is drawn with.
#[derive(Clone, Copy)]
pub(crate) struct Seen<'a> {
    /// The level of detail of each instance; those that are out of view are not skinned.
    pub instance_lods: &'a [InstanceLod],
    /// For a mesh with levels of detail: the levels, and the mesh's own level at each level of an instance.
    pub levels: Option<(&'a MeshLevels, &'a [u32])>,
}

impl Seen<'_> {
    /// The levels of the mesh and the index in them of the level that an instance is drawn with; `None` for
    /// the mesh itself.
    fn level(&self, instance: usize) -> Option<(&MeshLevels, usize)> {
        let (levels, own) = self.levels?;
        let own = own.get(self.instance_lods[instance].mesh_lod as usize).or(own.last())?;
        // The mesh's own level 1 is the first of its coarser levels.
        Some((levels, (*own as usize).checked_sub(1)?))
    }
}

impl VertexMeter {
    /// Adds a frame of a mesh: the distance of each of its vertices from what is drawn.
    pub(crate) fn add(
        &mut self,
        (placements, projection): (&Placements, Projection),
        seen: Seen<'_>,
        stale: Skinned<'_>,
        fresh: Skinned<'_>,
    ) {
        let count = placements.origins.len();
        let vertices = fresh.slots.len().max(1);
        // The instances are split into as many parts as there are threads.
        let each = count.div_ceil(rayon::current_num_threads());
        let lists =
            stale.vertices.par_chunks(each * vertices).zip(fresh.vertices.par_chunks(each * vertices));
        let part = |(part, (stales, freshes)): (usize, (&[Vertex], &[Vertex]))| {
            let mut found = Self::default();
            let instances = stales.chunks(vertices).zip(freshes.chunks(vertices));
            for (instance, (stales, freshes)) in (part * each..).zip(instances) {
                if seen.instance_lods[instance].max_influences == 0 {
                    found.unseen += vertices as u64;
                    continue;
                }
                let drawn = Skinned { vertices: stales, ..stale };
                let wanted = Skinned { vertices: freshes, ..fresh };
                found.add_instance(
                    &placements.get(instance, projection),
                    seen.level(instance),
                    drawn,
                    wanted,
                );
            }
            found
        };
        let parts: Vec<Self> = lists.enumerate().map(part).collect();
        for part in parts {
            self.metres.merge(&part.metres);
            self.pixels.merge(&part.pixels);
            self.unseen += part.unseen;
        }
    }

    /// Adds the vertices of one instance.
    fn add_instance(
        &mut self,
        placement: &Placement,
        level: Option<(&MeshLevels, usize)>,
        drawn: Skinned<'_>,
        wanted: Skinned<'_>,
    ) {
        for vertex in 0..wanted.slots.len() {
            let point = wanted.position(vertex as u32);
            let nearest = match level {
                None => drawn.position(vertex as u32),
                Some((levels, level)) => {
                    levels.nearest(level, vertex, point, |vertex| drawn.position(vertex))
                }
            };
            let point = point.to_array().map(f64::from);
            let offset = std::array::from_fn(|axis| f64::from(nearest[axis]) - point[axis]);
            self.metres.add(length(offset));
            match placement.pixels(point, offset) {
                None => self.unseen += 1,
                Some([pixels, _]) => self.pixels.add(pixels),
            }
        }
    }

    pub(crate) fn errors(&self) -> Errors {
        Errors::of(&self.metres, &self.pixels, self.unseen)
    }
}
