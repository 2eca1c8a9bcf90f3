//! How far skinned vertices lie from fresh ones, and what a look at a crowd takes.

use glam::Vec3;
use rayon::prelude::*;
use relievo::skinning::MeshLevels;
use relievo::skinning::instance_lod::InstanceLod;
use relievo::skinning::vertex::Vertex;
use serde::Serialize;

use super::errors::{Errors, Tally, View, length};
use super::stage::{Scene, Stage};

/// A look at a crowd: medians over frames, and errors of all vertices.
#[derive(Debug, Clone, Copy, Serialize)]
pub struct Figures {
    pub frame_nanoseconds: f64,
    pub compute_nanoseconds: f64,
    pub draw_nanoseconds: f64,
    pub nanoseconds_per_vertex: f64,
    pub skinned_fraction: f64,
    pub triangle_fraction: f64,
    pub vertex_error: Errors,
}

/// Distances between vertices.
#[derive(Clone)]
pub struct Spread {
    metres: Tally,
    pixels: Tally,
    unseen: u64,
}

impl Default for Spread {
    fn default() -> Self {
        Self { metres: Tally::new(), pixels: Tally::new(), unseen: 0 }
    }
}

/// The vertices of a mesh, instance by instance.
#[derive(Clone, Copy)]
pub struct Skinned<'a> {
    pub vertices: &'a [Vertex],
    /// Where each of the mesh's lies among an instance's.
    pub places: &'a [u32],
}

/// What an instance has of a mesh.
#[derive(Clone, Copy)]
pub struct Seen<'a> {
    /// One an instance; those that are out of view are not skinned.
    pub instance_lods: &'a [InstanceLod],
    /// Of a mesh that has levels of detail: for each level of an instance its own.
    pub levels: Option<(&'a MeshLevels, &'a [u32])>,
}

impl Spread {
    /// Adds a frame of a mesh: how far what is drawn lies from each of the mesh's vertices.
    pub fn add(
        &mut self,
        stage: &Stage<'_>,
        scene: &Scene,
        seen: Seen<'_>,
        stale: Skinned<'_>,
        fresh: Skinned<'_>,
    ) {
        let count = stage.instances.len();
        let vertices = fresh.places.len().max(1);
        // As many instances as make a share of the work a processor.
        let each = count.div_ceil(rayon::current_num_threads());
        let lists =
            stale.vertices.par_chunks(each * vertices).zip(fresh.vertices.par_chunks(each * vertices));
        let shares: Vec<Self> = lists
            .enumerate()
            .map(|(fraction, (stales, freshes))| {
                let mut found = Self::default();
                let instances = stales.chunks(vertices).zip(freshes.chunks(vertices));
                for (instance, (stales, freshes)) in (fraction * each..).zip(instances) {
                    let instance_lod = seen.instance_lods[instance];
                    if instance_lod.max_influences == 0 {
                        found.unseen += vertices as u64;
                        continue;
                    }
                    let (origin, turn) = (scene.origins[instance], scene.turns[instance]);
                    let view = View { origin, turn, projection: stage.projection };
                    // Its own level 1 is the first of its levels.
                    let level = seen.levels.and_then(|(levels, own)| {
                        let own = own.get(instance_lod.mesh_lod as usize).or(own.last())?;
                        Some((levels, (*own as usize).checked_sub(1)?))
                    });
                    let own =
                        |vertex: u32| Vec3::from(stales[stale.places[vertex as usize] as usize].position);
                    for vertex in 0..vertices {
                        let wanted = Vec3::from(freshes[fresh.places[vertex] as usize].position);
                        let drawn = match level {
                            None => own(vertex as u32),
                            Some((levels, level)) => levels.nearest(level, vertex, wanted, own),
                        };
                        found.add_one(&view, drawn, wanted);
                    }
                }
                found
            })
            .collect();
        for fraction in shares {
            self.metres.merge(&fraction.metres);
            self.pixels.merge(&fraction.pixels);
            self.unseen += fraction.unseen;
        }
    }

    fn add_one(&mut self, view: &View, drawn: Vec3, wanted: Vec3) {
        let point = wanted.to_array().map(f64::from);
        let way = std::array::from_fn(|axis| f64::from(drawn[axis]) - point[axis]);
        self.metres.add(length(way));
        match view.pixels(point, way) {
            None => self.unseen += 1,
            Some([pixels, _]) => self.pixels.add(pixels),
        }
    }

    pub fn errors(&self) -> Errors {
        Errors::of(&self.metres, &self.pixels, self.unseen)
    }
}
