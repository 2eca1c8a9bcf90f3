//! How far skinned vertices lie from fresh ones, and what a look at a crowd takes.

use rayon::prelude::*;
use relievo::skinning::Vertex;
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
    pub skinned_share: f64,
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

impl Spread {
    /// Adds a frame of a mesh; lists are instance by instance. Those that are out of view are not skinned.
    pub fn add(
        &mut self,
        stage: &Stage<'_>,
        scene: &Scene,
        is_seen: &[bool],
        stale: &[Vertex],
        fresh: &[Vertex],
    ) {
        let count = stage.instances.len();
        let vertices = (fresh.len() / count).max(1);
        // As many instances as make a share of the work a processor.
        let each = count.div_ceil(rayon::current_num_threads());
        let lists = stale.par_chunks(each * vertices).zip(fresh.par_chunks(each * vertices));
        let shares: Vec<Self> = lists
            .enumerate()
            .map(|(share, (stale, fresh))| {
                let mut found = Self::default();
                let instances = stale.chunks(vertices).zip(fresh.chunks(vertices));
                for (instance, (stale, fresh)) in (share * each..).zip(instances) {
                    if !is_seen[instance] {
                        found.unseen += fresh.len() as u64;
                        continue;
                    }
                    let (origin, turn) = (scene.origins[instance], scene.turns[instance]);
                    let view = View { origin, turn, lens: stage.lens };
                    stale.iter().zip(fresh).for_each(|(stale, fresh)| found.add_one(&view, stale, fresh));
                }
                found
            })
            .collect();
        for share in shares {
            self.metres.merge(&share.metres);
            self.pixels.merge(&share.pixels);
            self.unseen += share.unseen;
        }
    }

    fn add_one(&mut self, view: &View, stale: &Vertex, fresh: &Vertex) {
        let point = fresh.position.map(f64::from);
        let way = std::array::from_fn(|axis| f64::from(stale.position[axis]) - point[axis]);
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
