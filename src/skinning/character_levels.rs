//! Levels of detail of a character with several meshes. An instance has one level number; at that level, each
//! mesh uses the coarsest of its own levels whose error the character's error permits.

use std::collections::BTreeMap;

use crate::asset::mesh::{MAX_LEVELS, Mesh};

/// The errors of a character's levels 1, 2 …, in the model's units: ascending, at most 15.
///
/// They are the errors of all levels of its meshes. If there are more than 15, the omitted ones are those whose
/// omission adds the fewest triangles, counted over the logarithm of the distance. For a character with one mesh whose
/// levels have different errors, they are those errors.
pub fn level_errors(meshes: &[Mesh]) -> Vec<f32> {
    level_errors_within(meshes, MAX_LEVELS)
}

/// As [`level_errors`], for a character with at most `most` levels, level 0 included: at most `most` − 1 errors. With
/// at least two levels, the coarsest level of all is kept.
pub fn level_errors_within(meshes: &[Mesh], most: usize) -> Vec<f32> {
    if most < 2 {
        return Vec::new();
    }
    // The number of triangles that a mesh loses when the error reaches that of its next level. The key is the error's
    // bits; their order is right because errors are not negative.
    let mut lost: BTreeMap<u32, usize> = BTreeMap::new();
    for mesh in meshes {
        let mut left = mesh.indices.len();
        for level in &mesh.levels {
            *lost.entry((level.error + 0.0).to_bits()).or_default() +=
                left.saturating_sub(level.indices.len());
            left = level.indices.len();
        }
    }
    let mut steps: Vec<Step> =
        lost.into_iter().map(|(error, lost)| Step::new(f32::from_bits(error), lost)).collect();
    while steps.len() >= most {
        // If a step is removed, its triangles stay until the next step.
        let costs = steps.windows(2).map(|pair| pair[0].cost(&pair[1]));
        let cheapest = costs.enumerate().min_by(|a, b| a.1.total_cmp(&b.1)).map_or(0, |(at, _)| at);
        let Step { lost, .. } = steps.remove(cheapest);
        steps[cheapest].lost += lost;
    }
    steps.iter().map(|step| step.error).collect()
}

/// The level of a mesh at each level of its character, level 0 included. `errors` are the character's [`level_errors`].
/// The result is the mesh's coarsest level whose error is at most the character's; 0 is the mesh itself.
pub fn own_levels(mesh: &Mesh, errors: &[f32]) -> Vec<u32> {
    let coarsest = |error: &f32| mesh.levels.partition_point(|level| level.error <= *error) as u32;
    std::iter::once(0).chain(errors.iter().map(coarsest)).collect()
}

/// The transition from one level of a character to the next.
struct Step {
    error: f32,
    /// Logarithm of the error.
    logarithm: f64,
    /// Number of indices lost.
    lost: usize,
}

impl Step {
    fn new(error: f32, lost: usize) -> Self {
        Self { error, logarithm: libm::log(f64::from(error)), lost }
    }

    /// The additional triangles drawn if the step is left out; infinite for an error of 0, which is always allowed.
    fn cost(&self, next: &Self) -> f64 {
        if self.lost == 0 { 0.0 } else { self.lost as f64 * (next.logarithm - self.logarithm) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::asset::mesh::MeshLevel;

    /// A mesh with `triangles` triangles, and levels with the given numbers of triangles and errors. Only these
    /// numbers matter.
    fn mesh(triangles: usize, levels: &[(usize, f32)]) -> Mesh {
        let indices = |triangles: usize| vec![0; 3 * triangles];
        let level =
            |(triangles, error): &(usize, f32)| MeshLevel { indices: indices(*triangles), error: *error };
        let creature = crate::samples::creature().expect("valid").meshes.remove(0);
        Mesh { indices: indices(triangles), levels: levels.iter().map(level).collect(), ..creature }
    }

    #[test]
    fn each_mesh_has_its_own_coarsest_level() {
        let fine = mesh(90, &[(60, 1.0), (40, 2.0), (20, 4.0)]);
        let coarse = mesh(9, &[(6, 4.0), (3, 9.0)]);
        let meshes = [fine, coarse, mesh(5, &[]), mesh(8, &[(4, 0.0), (2, 4.0)])];
        let errors = level_errors(&meshes);
        assert_eq!(errors, [0.0, 1.0, 2.0, 4.0, 9.0]);
        let own = meshes.each_ref().map(|mesh| own_levels(mesh, &errors));
        assert_eq!(own[0], [0, 0, 1, 2, 3, 3]);
        assert_eq!(own[1], [0, 0, 0, 0, 1, 2]);
        assert_eq!(own[2], [0; 6]);
        assert_eq!(own[3], [0, 1, 1, 1, 2, 2]);
        // Of several levels with the same error, the coarsest is used.
        let twice = mesh(9, &[(6, 1.0), (3, 1.0)]);
        assert_eq!(own_levels(&twice, &level_errors(std::slice::from_ref(&twice))), [0, 2]);
        assert_eq!((level_errors(&[]), own_levels(&meshes[2], &[])), (vec![], vec![0]));
    }

    /// There are no more levels than an instance can have. The omitted ones are those that save the least. No level
    /// exceeds the allowed error.
    #[test]
    fn levels_that_save_least_are_left_out() {
        // Fifteen levels that halve the triangles as the error doubles, and some between them that save next to
        // nothing.
        let doubling = |at: i32| libm::exp2f(at as f32);
        let levels: Vec<_> = (0..15).map(|at| (1 << (15 - at), doubling(at))).collect();
        let wanted: Vec<f32> = levels.iter().map(|level| level.1).collect();
        let steep = mesh(1 << 16, &levels);
        assert_eq!(level_errors(std::slice::from_ref(&steep)), wanted);
        let idle: Vec<_> = (0..12).map(|at| (90 - at as usize, 1.5 * doubling(at))).collect();
        let meshes = [steep, mesh(91, &idle)];
        assert_eq!(level_errors(&meshes), wanted);
        // The other levels wait for the next step of the character.
        assert_eq!(own_levels(&meshes[1], &wanted)[..4], [0, 0, 1, 2]);
        // The coarsest level is always kept.
        let meshes = [meshes[0].clone(), mesh(90, &[(89, 1e9)])];
        let errors = level_errors(&meshes);
        assert_eq!((errors.len(), errors[14]), (15, 1e9));
        for mesh in &meshes {
            let own = own_levels(mesh, &errors);
            for (own, error) in own[1..].iter().zip(&errors) {
                assert!(*own == 0 || mesh.levels[*own as usize - 1].error <= *error);
            }
        }
    }
}
