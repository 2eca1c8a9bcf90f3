//! What the benchmarks of `kernels/skinning/` share: a mesh of 10,000 vertices around 64 bones.

use crate::Error;
use crate::asset::Model;
use crate::asset::mesh::smooth_normals;
use crate::asset::morph::MorphDelta;
use crate::asset::transform::rows;
use crate::asset::{Influence, Influences, Mesh, MorphTarget};
use crate::gpu::Gpu;
use crate::skinning::buffers::{MeshBuffers, SkinnedCrowd};
use crate::skinning::clusters::Clusters;
use crate::skinning::instance_lod::InstanceLod;
use crate::skinning::verify::{Shape, random_model};
use crate::skinning::vertex::Blend;

/// Vertices of the mesh: 100 rings of 100.
pub(crate) const RING: usize = 100;

/// Number of bones along the mesh.
pub(crate) const BONES: usize = 64;

/// Numbers of instances of the cases.
pub(crate) const CROWDS: [usize; 3] = [1, 100, 1000];

/// The InstanceLods of a crowd of which one instance in `every` is seen.
pub(crate) fn seen_of(instances: usize, every: usize) -> Vec<InstanceLod> {
    let one = |at: usize| if at.is_multiple_of(every) { InstanceLod::FULL } else { InstanceLod::UNSEEN };
    (0..instances).map(one).collect()
}

/// A tube along its bones. Each vertex follows the `influences` bones that are nearest to it.
pub(crate) fn tube(influences: usize, targets: usize) -> Result<Model, Error> {
    let shape = Shape { bones: 2 * BONES, vertices: 1, influences: 1, targets: 0, levels: 0 };
    let mut model = random_model(1, shape)?;
    let vertices: Vec<[f32; 2]> = (0..RING * RING)
        .map(|vertex| [(vertex % RING) as f32 / RING as f32, (vertex / RING) as f32 / RING as f32])
        .collect();
    let position = |[around, along]: &[f32; 2]| {
        let (sine, cosine) = (around * std::f32::consts::TAU).sin_cos();
        [0.1 * cosine, *along, 0.1 * sine]
    };
    let positions: Vec<_> = vertices.iter().map(position).collect();
    let corner = |ring: usize, side: usize| (ring * RING + side % RING) as u32;
    let quad = |at: usize| {
        let (ring, side) = (at / RING, at % RING);
        let [a, b, c, d] =
            [corner(ring, side), corner(ring, side + 1), corner(ring + 1, side + 1), corner(ring + 1, side)];
        [a, c, b, a, d, c]
    };
    let indices: Vec<u32> = (0..(RING - 1) * RING).flat_map(quad).collect();
    let follows = |[_, along]: &[f32; 2]| {
        let first = (along * (BONES - influences) as f32) as u32;
        (0..influences as u32)
            .map(|at| Influence { bone: first + at, weight: 1.0 + (at * 5 % 3) as f32 })
            .collect()
    };
    let delta = |vertex| MorphDelta {
        position: [0.0, 0.01 * f32::from(vertex % 4 == 0), 0.0],
        ..MorphDelta::default()
    };
    let target = MorphTarget::new(&(0..RING * RING).map(delta).collect::<Vec<_>>());
    model.meshes[0] = Mesh {
        normals: smooth_normals(&positions, &indices),
        tangents: vec![[0.0, 1.0, 0.0, 1.0]; positions.len()],
        influences: Influences::new("tube", BONES, vertices.iter().map(follows))?,
        uv: vertices,
        positions,
        indices,
        targets: vec![target; targets],
        weights: vec![0.0; targets],
        levels: vec![],
        partners: vec![],
        ..model.meshes[0].clone()
    };
    Ok(model)
}

/// A mesh on the device, and instances with one palette each.
pub(crate) struct Scene {
    pub(crate) model: Model,
    pub(crate) mesh: MeshBuffers,
    pub(crate) clusters: Clusters,
    pub(crate) crowd: SkinnedCrowd,
}

impl Scene {
    pub(crate) fn new(gpu: &Gpu, influences: usize, targets: usize, instances: usize) -> Result<Self, Error> {
        Self::of(gpu, tube(influences, targets)?, instances)
    }

    pub(crate) fn of(gpu: &Gpu, model: Model, instances: usize) -> Result<Self, Error> {
        let (mesh, clusters) = MeshBuffers::new(gpu, &model, &model.meshes[0])?;
        let crowd = SkinnedCrowd::new(gpu, &mesh, instances, Blend::Linear)?;
        let bones: Vec<_> = model.skins[0].inverse_binds.iter().map(rows).collect();
        let palette: Vec<[f32; 4]> = bones.as_flattened().repeat(instances);
        crowd.palette.write(gpu, &palette)?;
        Ok(Self { model, mesh, clusters, crowd })
    }
}
