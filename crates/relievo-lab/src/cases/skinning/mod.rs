//! Helpers of the parity and benchmark cases of `kernels/skinning/`.

pub mod morph;
pub mod morph_weights;
pub mod pages;
pub mod palette;
pub mod select;
pub mod skin;

use relievo::asset::mesh::smooth_normals;
use relievo::asset::morph::MorphDelta;
use relievo::asset::skeleton::Skin;
use relievo::asset::transform::{Affine, Transform, column_major, rows};
use relievo::asset::{Influence, Influences, Mesh, MeshLevel, Model, MorphTarget};
use relievo::gpu::Gpu;
use relievo::ops::animation::local_to_model::reference::{affine, product};
use relievo::ops::skinning::buffers::{MeshBuffers, SkinnedCrowd};
use relievo::ops::skinning::clusters::{Clusters, Rig};
use relievo::ops::skinning::instance_lod::InstanceLod;
use relievo::ops::skinning::vertex::{Blend, Vertex};
use relievo::ops::skinning::{level_errors, own_levels};
use relievo::{Error, InputError};

use crate::cases::animation::{Draw, random_skeleton};
use crate::harness::poison::POISON;

/// The sizes of a random mesh and of the skeleton that it follows.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Shape {
    /// Bones of the skeleton; the skin has half of them, at least one.
    pub bones: usize,
    /// Vertices of the mesh.
    pub vertices: usize,
    /// The largest number of influences of a vertex.
    pub influences: usize,
    /// Number of morph targets.
    pub targets: usize,
    /// Number of levels of detail besides the mesh itself; they need three vertices.
    pub levels: usize,
}

/// Shapes with numbers of vertices around the boundaries of clusters and of bones around those of sets, one to
/// eight influences, and no levels, some, and the largest number.
pub(crate) const SHAPES: [Shape; 8] = [
    Shape { bones: 1, vertices: 1, influences: 1, targets: 0, levels: 0 },
    Shape { bones: 9, vertices: 63, influences: 2, targets: 1, levels: 1 },
    Shape { bones: 32, vertices: 64, influences: 3, targets: 0, levels: 0 },
    Shape { bones: 33, vertices: 65, influences: 4, targets: 2, levels: 15 },
    Shape { bones: 64, vertices: 127, influences: 5, targets: 0, levels: 2 },
    Shape { bones: 65, vertices: 500, influences: 7, targets: 3, levels: 3 },
    Shape { bones: 153, vertices: 1000, influences: 8, targets: 2, levels: 15 },
    Shape { bones: 1000, vertices: 129, influences: 8, targets: 1, levels: 1 },
];

/// A model of this shape, with one mesh and no clip.
///
/// # Errors
/// None in practice: the model is checked like any other.
pub(crate) fn random_model(case: u32, shape: Shape) -> Result<Model, InputError> {
    let mut draw = Draw::new(case ^ 0x5c1);
    let skeleton = random_skeleton(case, shape.bones)?;
    let bones: Vec<u32> = (0..shape.bones as u32).rev().step_by(2).collect();
    let inverse_binds = bones.iter().map(|_| column_major(&near_identity(&mut draw))).collect();
    let skin = Skin { name: "random".to_owned(), bones, inverse_binds };
    let vertices = 0..shape.vertices;
    let mesh = Mesh {
        name: "random".to_owned(),
        positions: vertices.clone().map(|_| [0; 3].map(|_| 2.0 * draw.signed())).collect(),
        normals: vertices.clone().map(|_| unit(&mut draw)).collect(),
        tangents: vertices.clone().map(|_| tangent(&mut draw)).collect(),
        uv: vertices.clone().map(|_| [0; 2].map(|_| draw.signed())).collect(),
        levels: levels(&mut draw, shape),
        indices: triangles(shape).collect(),
        double_sided: true,
        influences: influences(&mut draw, shape, skin.bones.len())?,
        targets: (0..shape.targets).map(|_| target(&mut draw, shape.vertices)).collect(),
        weights: vec![0.0; shape.targets],
        ..Mesh::default()
    };
    mesh.validate(std::slice::from_ref(&skin))?;
    let (clips, motion, materials, images) = (vec![], None, vec![], vec![]);
    Ok(Model {
        skeleton,
        skins: vec![skin],
        clips,
        motion,
        meshes: vec![mesh],
        skinned: 1,
        materials,
        images,
    })
}

/// Influences of the mesh on one more tier of the skeleton in odd cases, and none in even cases.
///
/// # Errors
/// None in practice.
pub(crate) fn random_tiers(case: u32, model: &Model, shape: Shape) -> Result<Vec<Influences>, InputError> {
    let mut draw = Draw::new(case ^ 0x71e5);
    (0..case % 2).map(|_| influences(&mut draw, shape, model.skins[0].bones.len())).collect()
}

/// Uploads the mesh of a random model with its tiers.
///
/// # Errors
/// What the device reports.
pub(crate) fn uploaded(
    gpu: &Gpu,
    model: &Model,
    reduced: &[Influences],
) -> Result<(MeshBuffers, Clusters), Error> {
    let rig = Rig { skeleton: &model.skeleton, skins: &model.skins, reduced };
    let own = own_levels(&model.meshes[0], &level_errors(&model.meshes));
    MeshBuffers::of_rig(gpu, &rig, &model.meshes[0], &own)
}

/// All vertices but at most two belong to a triangle.
pub(crate) fn triangles(shape: Shape) -> std::ops::Range<u32> {
    0..shape.vertices as u32 / 3 * 3
}

/// Levels that lose equal numbers of triangles, so that the last two of a large mesh have other clusters.
pub(crate) fn levels(draw: &mut Draw, shape: Shape) -> Vec<MeshLevel> {
    let mut left: Vec<u32> = triangles(shape).step_by(3).collect();
    let all = left.len();
    let mut level = |at: usize| {
        let most = (all * (shape.levels - at)).div_ceil(shape.levels + 1);
        while left.len() > most {
            left.swap_remove(draw.word() as usize % left.len());
        }
        let indices = left.iter().flat_map(|first| *first..first + 3).collect();
        MeshLevel { indices, error: at as f32 }
    };
    (0..shape.levels).map(&mut level).collect()
}

pub(crate) fn unit(draw: &mut Draw) -> [f32; 3] {
    let [x, y, z, w] = draw.rotation();
    glam::Quat::from_xyzw(x, y, z, w).normalize().mul_vec3(glam::Vec3::Y).to_array()
}

pub(crate) fn tangent(draw: &mut Draw) -> [f32; 4] {
    let [x, y, z] = unit(draw);
    [x, y, z, if draw.word().is_multiple_of(2) { 1.0 } else { -1.0 }]
}

/// Random influences, few or many, uneven or equal.
pub(crate) fn influences(draw: &mut Draw, shape: Shape, bones: usize) -> Result<Influences, InputError> {
    let vertex = |_| {
        let count = 1 + draw.word() as usize % shape.influences;
        let is_even = draw.word().is_multiple_of(4);
        let influence = |_| Influence {
            bone: draw.word() % bones as u32,
            weight: if is_even { 1.0 } else { 0.01 + draw.signed().abs() },
        };
        (0..count).map(influence).collect()
    };
    Influences::new("random.weights", bones, (0..shape.vertices).map(vertex).collect::<Vec<_>>())
}

pub(crate) fn target(draw: &mut Draw, vertices: usize) -> MorphTarget {
    let delta = |_| match draw.word() % 3 {
        0 => MorphDelta {
            position: [0; 3].map(|_| draw.signed()),
            normal: [0; 3].map(|_| draw.signed()),
            tangent: [0; 3].map(|_| draw.signed()),
        },
        _ => MorphDelta::default(),
    };
    MorphTarget::new(&(0..vertices).map(delta).collect::<Vec<_>>())
}

/// A small rotation, an uneven stretch and a translation.
pub(crate) fn near_identity(draw: &mut Draw) -> Affine {
    let [x, y, z] = [0; 3].map(|_| 0.2 * draw.signed());
    let w = (1.0 - x * x - y * y - z * z).sqrt();
    let translation = [0; 3].map(|_| draw.signed());
    affine(&Transform {
        translation,
        rotation: [x, y, z, w],
        scale: [0; 3].map(|_| 1.0 + 0.3 * draw.signed()),
    })
}

/// Matrices that are close to each other within an instance, so that their means are as well conditioned as
/// they are. Each instance has a rotation of its own, and some are mirrored.
pub(crate) fn random_matrices(case: u32, bones: usize, instances: usize) -> Vec<Affine> {
    let mut draw = Draw::new(case ^ 0xba1e);
    let mut matrices = Vec::with_capacity(bones * instances);
    for instance in 0..instances {
        let [x, y, z, w] = draw.rotation();
        let rotation = glam::Quat::from_xyzw(x, y, z, w).normalize().to_array();
        let scale = [if instance % 3 == 2 { -1.0 } else { 1.0 }, 1.0, 1.25];
        let common = affine(&Transform { translation: [0; 3].map(|_| 3.0 * draw.signed()), rotation, scale });
        matrices.extend((0..bones).map(|_| product(&common, &near_identity(&mut draw))));
    }
    matrices
}

/// Full, truncated, fading and unseen InstanceLods in turn, half of them at coarse levels, which the mesh may
/// not have. Their tiers are below `tiers`.
pub(crate) fn random_instance_lods(case: u32, instances: usize, tiers: u32) -> Vec<InstanceLod> {
    let mut draw = Draw::new(case ^ 0xfade);
    let instance_lod = |instance: usize, draw: &mut Draw| match (instance as u32 + case) % 5 {
        0 => InstanceLod::FULL,
        1 => InstanceLod { max_influences: 1 + draw.word() % 8, ..InstanceLod::FULL },
        2 => InstanceLod { influence_fade: draw.signed().abs(), ..InstanceLod::FULL },
        3 => InstanceLod { influence_fade: (draw.word() % 2) as f32, ..InstanceLod::FULL },
        _ => InstanceLod::UNSEEN,
    };
    let levelled = |instance| {
        let level = [0, 0, 0, 0, 1, 2, 3, 15, u32::MAX][draw.word() as usize % 9];
        let instance_lod = instance_lod(instance, &mut draw);
        InstanceLod { mesh_lod: level, tier: draw.word() % tiers, ..instance_lod }
    };
    (0..instances).map(levelled).collect()
}

/// The value of an element that a kernel has not written, for any type.
pub(crate) fn poisoned<T: bytemuck::Pod>() -> T {
    bytemuck::pod_read_unaligned(&POISON.to_ne_bytes().repeat(size_of::<T>() / 4))
}

/// All ten words of each vertex.
pub(crate) fn flat(vertices: &[Vertex]) -> Vec<f32> {
    bytemuck::cast_slice(vertices).to_vec()
}

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
