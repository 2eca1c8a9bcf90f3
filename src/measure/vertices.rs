//! How far drawn vertices lie from fresh ones, and what a drawn crowd takes.

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

/// What a crowd takes to be animated, skinned and drawn: medians over the frames that were timed; and its vertices' errors in
/// these.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct FrameCost {
    /// Gate, places, sampling, concatenation, who is seen, skinning, and the drawing, in one submission.
    pub frame_nanoseconds: f64,
    /// What precedes the drawing, alone.
    pub compute_nanoseconds: f64,
    /// The drawing, alone.
    pub draw_nanoseconds: f64,
    /// Palettes, the choice of clusters and vertices, divided by all vertices of the crowd.
    pub nanoseconds_per_vertex: f64,
    /// Clusters that were skinned, of all.
    pub skinned_fraction: f64,
    /// Triangles that were drawn, of all meshes in full.
    pub triangle_fraction: f64,
    /// From all vertices of the full crowd to those drawn, or where a mesh lacks them, to its surface.
    pub vertex_error: Errors,
}

/// Collects distances between vertices.
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
    /// Where each of the mesh's lies among an instance's.
    pub places: &'a [u32],
}

impl Skinned<'_> {
    /// Of an instance whose vertices alone are here.
    fn position(&self, vertex: u32) -> Vec3 {
        Vec3::from(self.vertices[self.places[vertex as usize] as usize].position)
    }
}

/// What instances have of a mesh.
#[derive(Clone, Copy)]
pub(crate) struct Seen<'a> {
    /// One an instance; those that are out of view are not skinned.
    pub instance_lods: &'a [InstanceLod],
    /// Of a mesh that has levels of detail: for each level of an instance its own.
    pub levels: Option<(&'a MeshLevels, &'a [u32])>,
}

impl Seen<'_> {
    /// What an instance has of a mesh: its levels, and which of them, from 0 on, where it is not the mesh itself.
    fn level(&self, instance: usize) -> Option<(&MeshLevels, usize)> {
        let (levels, own) = self.levels?;
        let own = own.get(self.instance_lods[instance].mesh_lod as usize).or(own.last())?;
        // Its own level 1 is the first of its levels.
        Some((levels, (*own as usize).checked_sub(1)?))
    }
}

impl VertexMeter {
    /// Adds a frame of a mesh: how far what is drawn lies from each of the mesh's vertices.
    pub(crate) fn add(
        &mut self,
        (placements, projection): (&Placements, Projection),
        seen: Seen<'_>,
        stale: Skinned<'_>,
        fresh: Skinned<'_>,
    ) {
        let count = placements.origins.len();
        let vertices = fresh.places.len().max(1);
        // As many instances as make a part of the work a processor.
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

    /// The vertices of one instance.
    fn add_instance(
        &mut self,
        placement: &Placement,
        level: Option<(&MeshLevels, usize)>,
        drawn: Skinned<'_>,
        wanted: Skinned<'_>,
    ) {
        for vertex in 0..wanted.places.len() {
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
