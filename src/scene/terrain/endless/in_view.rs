//! Endless terrain in a view: the nodes that the view draws, and how their vertices move.

use std::sync::{Arc, Mutex};

use crate::Error;
use crate::gpu::{Buffer, Gpu, GpuError, Group, Staged, Uniform, Upload as _};
use crate::lod::LodCamera;
use crate::scene::camera::Camera;
use crate::scene::layouts::SceneLayouts;
use crate::scene::object_kind::KindInView;
use crate::scene::terrain::in_view::{nowhere, seen_from};
use crate::shared::render::scene_terrain::{TerrainNode, TerrainView};

/// The nodes of a view, by their places in the pool.
#[derive(Debug)]
pub(super) struct ViewTable {
    pub nodes: Vec<TerrainNode>,
    /// One bit per place: whether the view draws the node.
    pub shown: Vec<u32>,
    pub cameras: [LodCamera; 4],
    pub camera_count: u32,
    /// The part of the allowed displacement that levels of detail may use.
    pub fraction: f32,
}

/// The resources of an endless terrain for one view.
#[derive(Debug)]
pub(super) struct EndlessInView {
    uniform: Uniform<TerrainView>,
    nodes: Buffer<TerrainNode>,
    /// Bind group 1.
    group: Group,
    /// The tables of all views of the frame.
    tables: Arc<Mutex<Vec<ViewTable>>>,
    /// World units between samples.
    spacing: f64,
    /// Number of the terrain's object.
    object: u32,
}

impl EndlessInView {
    pub fn new(
        gpu: &Gpu,
        layouts: &SceneLayouts,
        (spacing, object): (f64, u32),
        (capacity, tables): (usize, Arc<Mutex<Vec<ViewTable>>>),
    ) -> Result<Self, GpuError> {
        let uniform = Uniform::new(gpu, "terrain in a view", &nowhere(object))?;
        let nodes = Buffer::new(gpu, "nodes in a view", capacity)?;
        Ok(Self { group: layouts.ground(gpu, &uniform, &nodes)?, uniform, nodes, tables, spacing, object })
    }
}

impl KindInView for EndlessInView {
    fn group(&self) -> &Group {
        &self.group
    }

    fn stage(&self, staged: &mut Staged, camera: &Camera, number: usize) -> Result<Vec<u32>, Error> {
        let tables = self.tables.lock().unwrap_or_else(std::sync::PoisonError::into_inner);
        let Some(table) = tables.get(number) else { return Ok(Vec::new()) };
        let ViewTable { cameras, camera_count, fraction, .. } = *table;
        let view = seen_from(camera, self.spacing, self.object);
        staged.uniform(&self.uniform, &TerrainView { cameras, camera_count, fraction, ..view })?;
        staged.elements(&self.nodes, 0, &table.nodes)?;
        Ok(table.shown.clone())
    }
}
