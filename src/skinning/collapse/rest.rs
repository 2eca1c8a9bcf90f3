//! A model at rest: bone transforms, vertex positions, and distances of vertices from their bones.

use glam::{DAffine3, DVec3};

use crate::asset::Model;

/// A vertex that follows a bone.
pub(super) struct Follower {
    /// Index of the vertex, counted over all meshes.
    pub vertex: usize,
    /// Position of the vertex in the bone's space.
    pub local: DVec3,
    pub weight: f64,
}

/// A model at rest.
pub(super) struct Rest {
    /// The transform of each bone in its parent's space.
    pub locals: Vec<DAffine3>,
    /// The transform of each bone in the model's space.
    pub models: Vec<DAffine3>,
    /// The vertices that follow each bone.
    pub followers: Vec<Vec<Follower>>,
    /// The radius of each bone in the model's units: the largest distance from its origin of the vertices that follow
    /// it or a bone below it, and of the origins of bones below it.
    pub radii: Vec<f64>,
    /// Half the diagonal of a box around all vertices, or around the origins of all bones if there are none.
    pub size: f64,
}

/// Converts a skin's inverse bind matrix to f64.
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

    /// The transform from the last bone's space to the space of the bone above the first.
    pub(super) fn offset(&self, chain: &[usize]) -> DAffine3 {
        chain.iter().fold(DAffine3::IDENTITY, |offset, bone| offset * self.locals[*bone])
    }

    /// The largest factor by which a bone's space is scaled at rest.
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
