//! A model at rest: bone transforms, vertex positions, and the distances of vertices from their bones.

use glam::{DAffine3, DVec3};

use crate::asset::Model;

/// A vertex, as seen from a bone that it follows.
pub(super) struct Follower {
    /// Index of the vertex, counted over the vertices of all meshes.
    pub vertex: usize,
    /// Position of the vertex in the bone's space.
    pub local: DVec3,
    pub weight: f64,
}

/// A model in its rest pose.
pub(super) struct Rest {
    /// For each bone, its transform in its parent's space.
    pub locals: Vec<DAffine3>,
    /// For each bone, its transform in the model's space.
    pub models: Vec<DAffine3>,
    /// For each bone, the vertices that follow it.
    pub followers: Vec<Vec<Follower>>,
    /// For each bone, a radius in the model's units: the largest distance of certain points from the bone's origin.
    /// These points are the origins of the bones below, and the vertices that follow the bone or a bone below.
    pub radii: Vec<f64>,
    /// Half the diagonal of a box around all vertices. Without vertices, the box is around the origins of all bones.
    pub size: f64,
}

/// Converts an inverse bind matrix to an f64 transform.
pub(super) fn bind(matrix: &[f32; 16]) -> DAffine3 {
    DAffine3::from_mat4(glam::DMat4::from_cols_array(&matrix.map(f64::from)))
}

impl Rest {
    pub(super) fn new(model: &Model) -> Self {
        let bones = model.skeleton.bones();
        let locals: Vec<DAffine3> = bones.iter().map(|bone| bone.rest.wide()).collect();
        let mut models: Vec<DAffine3> = Vec::with_capacity(bones.len());
        for (bone, local) in bones.iter().zip(&locals) {
            models.push(bone.parent.map_or(*local, |parent| models[parent as usize] * *local));
        }
        let followers = followers(model);
        let (mut radii, mut low, mut high) = (vec![0.0_f64; bones.len()], DVec3::MAX, DVec3::MIN);
        let has_vertices = followers.iter().any(|followers| !followers.is_empty());
        for bone in 0..bones.len() {
            let origin = models[bone].translation;
            let positions =
                followers[bone].iter().map(|follower| models[bone].transform_point3(follower.local));
            for (at, position) in [origin].into_iter().chain(positions).enumerate() {
                if at > 0 || !has_vertices {
                    (low, high) = (low.min(position), high.max(position));
                }
                let parent = |bone: usize| bones[bone].parent.map(|parent| parent as usize);
                for above in std::iter::successors(Some(bone), |bone| parent(*bone)) {
                    radii[above] = radii[above].max(position.distance(models[above].translation));
                }
            }
        }
        Self { locals, models, followers, radii, size: low.distance(high) / 2.0 }
    }

    /// The rest transform from the space of the chain's last bone to the space of the bone above the chain.
    pub(super) fn offset(&self, chain: &[usize]) -> DAffine3 {
        chain.iter().fold(DAffine3::IDENTITY, |offset, bone| offset * self.locals[*bone])
    }

    /// The largest factor by which a bone's space is scaled at rest, along any axis.
    pub(super) fn scale(&self, bone: usize) -> f64 {
        let matrix = self.models[bone].matrix3;
        [matrix.x_axis, matrix.y_axis, matrix.z_axis].iter().map(|axis| axis.length()).fold(0.0, f64::max)
    }
}

fn followers(model: &Model) -> Vec<Vec<Follower>> {
    let mut followers: Vec<Vec<Follower>> = model.skeleton.bones().iter().map(|_| Vec::new()).collect();
    let mut first = 0;
    for mesh in &model.meshes {
        let skin = &model.skins[mesh.skin];
        let binds: Vec<DAffine3> = skin.inverse_binds.iter().map(bind).collect();
        for (vertex, position) in mesh.positions.iter().enumerate() {
            let position = DVec3::from(position.map(f64::from));
            for influence in mesh.influences.of(vertex) {
                let joint = influence.bone as usize;
                followers[skin.bones[joint] as usize].push(Follower {
                    vertex: first + vertex,
                    local: binds[joint].transform_point3(position),
                    weight: influence.weight.into(),
                });
            }
        }
        first += mesh.vertices();
    }
    followers
}
