//! Levels of detail of a character with several meshes. An instance has one level number for all meshes. At that level,
//! each mesh uses the coarsest of its own levels whose error does not exceed the error of the character's level.

use std::collections::BTreeMap;

use crate::asset::mesh::{MAX_LEVELS, Mesh};

/// The errors of a character's levels 1, 2 … in the model's units: at most 15, ascending.
///
/// The errors are collected from the levels of all meshes. If there are more than 15, errors are left out one by one,
/// always the one that costs least. The cost of leaving out an error is the number of triangles that it adds at each
/// viewing distance, integrated over the logarithm of the distance. A character with one mesh keeps the mesh's own
/// errors.
pub fn level_errors(meshes: &[Mesh]) -> Vec<f32> {
    level_errors_within(meshes, MAX_LEVELS)
}

/// Like [`level_errors`], but limited to `most` levels. Level 0 counts as a level, so there are at most `most` − 1
/// errors. If `most` is at least 2, the largest error is always kept.
pub fn level_errors_within(meshes: &[Mesh], most: usize) -> Vec<f32> {
    if most < 2 {
        return Vec::new();
    }
    // For each error: the number of triangle indices that meshes lose when the allowed error reaches it. Of joined models,
    // one mesh loses indices where another gains some. The key is the error's bits, which sort like the errors because
    // errors are not negative.
    let mut lost: BTreeMap<u32, i64> = BTreeMap::new();
    for mesh in meshes {
        let mut left = mesh.indices.len() as i64;
        for level in &mesh.levels {
            let own = level.indices.len() as i64;
            *lost.entry((level.error + 0.0).to_bits()).or_default() += left - own;
            left = own;
        }
    }
    let mut steps: Vec<Step> =
        lost.into_iter().map(|(error, lost)| Step::new(f32::from_bits(error), lost)).collect();
    while steps.len() >= most {
        // If a step is removed, its triangles remain until the next step.
        let costs = steps.windows(2).map(|pair| pair[0].cost(&pair[1]));
        let cheapest = costs.enumerate().min_by(|a, b| a.1.total_cmp(&b.1)).map_or(0, |(at, _)| at);
        let Step { lost, .. } = steps.remove(cheapest);
        steps[cheapest].lost += lost;
    }
    steps.iter().map(|step| step.error).collect()
}

/// The level that a mesh uses at each level of its character, level 0 first. `errors` are the character's
/// [`level_errors`]. The result is the mesh's coarsest level whose error is at most the character's error; 0 is the
/// full mesh.
pub fn own_levels(mesh: &Mesh, errors: &[f32]) -> Vec<u32> {
    let coarsest = |error: &f32| mesh.levels.partition_point(|level| level.error <= *error) as u32;
    std::iter::once(0).chain(errors.iter().map(coarsest)).collect()
}

/// A step from one level of a character to the next coarser level.
struct Step {
    error: f32,
    /// Natural logarithm of the error.
    logarithm: f64,
    /// Number of triangle indices that the step removes; negative if it adds some.
    lost: i64,
}

impl Step {
    fn new(error: f32, lost: i64) -> Self {
        Self { error, logarithm: libm::log(f64::from(error)), lost }
    }

    /// Cost of leaving out the step: the additional triangles drawn at each viewing distance, integrated over the
    /// logarithm of the distance. The cost is infinite for an error of 0, which is always allowed.
    fn cost(&self, next: &Self) -> f64 {
        if self.lost == 0 { 0.0 } else { self.lost as f64 * (next.logarithm - self.logarithm) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::asset::mesh::MeshLevel;

    /// A mesh with `triangles` triangles, and levels given as pairs of triangle count and error. The other data do not
    /// matter.
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
        // If several levels have the same error, the coarsest is used.
        let twice = mesh(9, &[(6, 1.0), (3, 1.0)]);
        assert_eq!(own_levels(&twice, &level_errors(std::slice::from_ref(&twice))), [0, 2]);
        assert_eq!((level_errors(&[]), own_levels(&meshes[2], &[])), (vec![], vec![0]));
    }

    /// A character has no more levels than an instance can have. The omitted levels save the fewest triangles. No mesh
    /// uses a level whose error exceeds the allowed error.
    #[test]
    fn levels_that_save_least_are_left_out() {
        // Fifteen levels that halve the triangles as the error doubles, and twelve levels between them that save almost
        // nothing.
        let doubling = |at: i32| libm::exp2f(at as f32);
        let levels: Vec<_> = (0..15).map(|at| (1 << (15 - at), doubling(at))).collect();
        let wanted: Vec<f32> = levels.iter().map(|level| level.1).collect();
        let steep = mesh(1 << 16, &levels);
        assert_eq!(level_errors(std::slice::from_ref(&steep)), wanted);
        let idle: Vec<_> = (0..12).map(|at| (90 - at as usize, 1.5 * doubling(at))).collect();
        let meshes = [steep, mesh(91, &idle)];
        assert_eq!(level_errors(&meshes), wanted);
        // A mesh uses an omitted level from the character's next error on.
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
