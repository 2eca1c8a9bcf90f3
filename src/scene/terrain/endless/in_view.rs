//! Endless terrain in a view: the nodes that the view draws, and how their vertices move.

use std::sync::{Arc, Mutex, PoisonError};

use glam::DVec3;

use crate::Error;
use crate::gpu::{Buffer, Gpu, GpuError, Group, Staged, Uniform, Upload as _};
use crate::scene::layouts::SceneLayouts;
use crate::scene::object_kind::{KindInView, ViewOfFrame};
use crate::scene::placement::Placement;
use crate::scene::terrain::in_view::{nowhere, seen_from};
use crate::shared::render::scene_terrain::{TerrainFrame, TerrainNode, TerrainView};

/// The nodes of a view, by their places in the pool.
#[derive(Debug)]
pub(super) struct ViewTable {
    pub nodes: Vec<TerrainNode>,
    /// One bit per place: whether the view draws the node.
    pub shown: Vec<u32>,
    /// The cameras that permit displacements of vertices, and the part that levels of detail may use.
    pub allows: TerrainFrame,
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
    /// `ViewTable::allows` of the view's last frame, and the corner of its cell then.
    last: Mutex<Option<(TerrainFrame, DVec3)>>,
    /// World units between samples.
    spacing: f64,
    /// Number of the terrain's object.
    object: u32,
}

impl EndlessInView {
    pub fn new(
        gpu: &Gpu,
        layouts: &SceneLayouts,
        spacing: f64,
        object: u32,
        capacity: usize,
        tables: Arc<Mutex<Vec<ViewTable>>>,
    ) -> Result<Self, GpuError> {
        let uniform = Uniform::new(gpu, "terrain in a view", &nowhere(object))?;
        let nodes = Buffer::new(gpu, "nodes in a view", capacity)?;
        let group = layouts.ground(gpu, &uniform, &nodes)?;
        Ok(Self { group, uniform, nodes, tables, last: Mutex::new(None), spacing, object })
    }
}

impl KindInView for EndlessInView {
    fn group(&self) -> &Group {
        &self.group
    }

    fn stage(&self, staged: &mut Staged, view: ViewOfFrame<'_>) -> Result<Vec<u32>, Error> {
        let ViewOfFrame { camera, number, is_next } = view;
        let tables = self.tables.lock().unwrap_or_else(PoisonError::into_inner);
        let Some(table) = tables.get(number) else { return Ok(Vec::new()) };
        let corner = Placement::corner(camera.cell);
        let mut last = self.last.lock().unwrap_or_else(PoisonError::into_inner);
        let before = last.filter(|_| is_next).map(|(frame, from)| seen_in(frame, from - corner));
        let frames = [table.allows, before.unwrap_or(table.allows)];
        let view = seen_from(camera, self.spacing, self.object);
        staged.uniform(&self.uniform, &TerrainView { frames, ..view })?;
        staged.elements(&self.nodes, 0, &table.nodes)?;
        *last = Some((table.allows, corner));
        Ok(table.shown.clone())
    }
}

/// Moves the cameras of a view's last frame into the cell of this frame. `moved` is the way from this cell's corner to that of the
/// last frame's cell, in world units.
fn seen_in(mut last: TerrainFrame, moved: DVec3) -> TerrainFrame {
    for camera in &mut last.cameras {
        camera.eye = (camera.eye.as_dvec3() + moved).as_vec3();
    }
    last
}
