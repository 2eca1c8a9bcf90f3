//! Transforms of instances and bones on the host.

use glam::{DAffine3, DMat3, DVec3};

use crate::asset::Affine;
use crate::shared::lod::instance::SceneInstance;

/// The model matrices of a character's instances on the device.
#[derive(Debug, Clone, Copy)]
pub(super) struct CharacterMatrices<'a> {
    /// Buffer of the matrices. The matrix of a bone has index instance · bones + bone.
    pub raw: &'a wgpu::Buffer,
    /// Number of bones.
    pub bones: usize,
}

/// An instance's transform from model space to world axes, relative to a cell's corner.
pub(super) fn placed_model(instance: &SceneInstance, cell: [i32; 3]) -> DAffine3 {
    let cells = |axis: usize| f64::from(instance.cell[axis]) - f64::from(cell[axis]);
    let corner = DVec3::from([0, 1, 2].map(cells)) * f64::from(crate::lod::CELL_SIZE);
    let [x, y, z] = instance.axes().map(|axis| axis.as_dvec3());
    let offset = DVec3::from(instance.offset.map(f64::from));
    DAffine3 { matrix3: DMat3::from_cols(x, y, z), translation: corner + offset }
}

/// The transform whose matrix has these three rows.
pub(super) fn affine_of(rows: &Affine) -> DAffine3 {
    let column = |at: usize| DVec3::from(rows.map(|row| f64::from(row[at])));
    DAffine3 { matrix3: DMat3::from_cols(column(0), column(1), column(2)), translation: column(3) }
}

/// The three matrix rows of a transform.
pub(super) fn rows_of(transform: DAffine3) -> Affine {
    let columns =
        [transform.matrix3.x_axis, transform.matrix3.y_axis, transform.matrix3.z_axis, transform.translation];
    std::array::from_fn(|row| columns.map(|column| column[row] as f32))
}
