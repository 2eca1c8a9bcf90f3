//! Pages of skinned vertices: the CPU reference of `kernels/skinning/pages.wgsl`.

use super::NO_PAGE;
use crate::skinning::instance_lod::InstanceLod;

/// The vertex pages that all instances of a mesh share.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Pages {
    /// The page of each cluster of each instance, at index `instance · clusters + cluster`, or [`NO_PAGE`].
    pub table: Vec<u32>,
    /// Number of pages that each instance holds. They belong to its first clusters.
    pub held: Vec<u32>,
    /// Free pages, as a stack: the last entry is assigned first.
    pub free: Vec<u32>,
    /// Number of instances that lacked a page in the last frame.
    pub short: u32,
    clusters: usize,
}

impl Pages {
    /// Makes `pages` free pages, for `instances` instances of a mesh with `clusters` clusters.
    pub fn new(instances: usize, clusters: usize, pages: u32) -> Self {
        let table = vec![NO_PAGE; instances * clusters];
        Self { table, held: vec![0; instances], free: (0..pages).rev().collect(), short: 0, clusters }
    }

    /// Frees the pages that instances no longer need, then assigns pages to instances that need more. Both steps go
    /// through instances in order. `levels` has the number of clusters at each level of detail.
    ///
    /// # Panics
    /// If `levels` is empty, or if `lods` has fewer entries than there are instances.
    pub fn deal(&mut self, lods: &[InstanceLod], levels: &[u32]) {
        let last = levels.len() - 1;
        let needed: Vec<u32> = (lods.iter())
            .map(|lod| if lod.max_influences == 0 { 0 } else { levels[last.min(lod.mesh_lod as usize)] })
            .collect();
        let rows = || self.table.chunks_exact(self.clusters);
        assert_eq!(rows().len(), lods.len());
        for (instance, needs) in needed.iter().enumerate() {
            let row = &mut self.table[instance * self.clusters..][..self.clusters];
            for entry in row[..self.held[instance] as usize].iter_mut().skip(*needs as usize).rev() {
                self.free.push(std::mem::replace(entry, NO_PAGE));
            }
            self.held[instance] = self.held[instance].min(*needs);
        }
        self.short = 0;
        for (instance, needs) in needed.iter().enumerate() {
            let row = &mut self.table[instance * self.clusters..][..self.clusters];
            while self.held[instance] < *needs {
                let Some(page) = self.free.pop() else {
                    self.short += 1;
                    break;
                };
                row[self.held[instance] as usize] = page;
                self.held[instance] += 1;
            }
        }
    }
}
