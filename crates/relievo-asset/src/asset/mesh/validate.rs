//! Checks of a mesh: lengths, indices and ranges, for each level and each morph target.

use super::{MAX_LEVELS, MAX_VERTICES, Mesh};
use crate::InputError;
use crate::asset::indices::check_triangles;
use crate::asset::skeleton::Skin;
use crate::asset::tangents::{in_range, numbers_in_range};

impl Mesh {
    /// Checks lengths, indices and ranges of all fields, and that the mesh matches its skin.
    ///
    /// # Errors
    /// [`InputError`] that names the wrong field, with its index.
    pub fn validate(&self, skins: &[Skin]) -> Result<(), InputError> {
        InputError::check_below("mesh.skin", self.skin, skins.len())?;
        let skin = &skins[self.skin];
        self.validate_alone()?;
        for vertex in 0..self.vertices() {
            let mut bones = self.influences.of(vertex).iter().map(|influence| influence.bone);
            if let Some(bone) = bones.find(|bone| *bone as usize >= skin.bones.len()) {
                let bound = format!("must be below {}, the skin's bones", skin.bones.len());
                return Err(InputError::new(format!("mesh.influences[{vertex}].bone"), bone, bound));
            }
        }
        Ok(())
    }

    /// Checks the mesh like [`Mesh::validate`], but without its skin.
    pub(crate) fn validate_alone(&self) -> Result<(), InputError> {
        let vertices = self.vertices();
        InputError::check_most("mesh.positions.len", vertices, MAX_VERTICES)?;
        for (field, len) in [
            ("normals", self.normals.len()),
            ("tangents", self.tangents.len()),
            ("uv", self.uv.len()),
            ("influences", self.influences.vertices()),
        ] {
            InputError::check_len(&format!("mesh.{field}"), len, vertices, "a vertex")?;
        }
        for (field, len) in [("second_uv", self.second_uv.len()), ("colors", self.colors.len())] {
            if len > 0 {
                InputError::check_len(&format!("mesh.{field}"), len, vertices, "a vertex")?;
            }
        }
        in_range("mesh.positions", &self.positions)?;
        in_range("mesh.normals", &self.normals)?;
        in_range("mesh.tangents", &self.tangents)?;
        in_range("mesh.uv", &self.uv)?;
        in_range("mesh.second_uv", &self.second_uv)?;
        in_range("mesh.colors", &self.colors)?;
        check_triangles("mesh.indices", &self.indices, vertices)?;
        self.validate_levels()?;
        self.validate_partners()?;
        self.validate_targets()
    }

    fn validate_levels(&self) -> Result<(), InputError> {
        let bound = || "must be finite, and not negative".to_owned();
        InputError::check((0.0..f32::INFINITY).contains(&self.error), "mesh.error", self.error, bound)?;
        InputError::check_most("mesh.levels.len", self.levels.len(), MAX_LEVELS - 1)?;
        let mut least = 0.0;
        let mut finer = self.used(&self.indices);
        for (at, level) in self.levels.iter().enumerate() {
            let path = format!("mesh.levels[{at}]");
            if !(least..f32::INFINITY).contains(&level.error) {
                let bound = format!("must be finite, and at least {least}, which the level before has");
                return Err(InputError::new(format!("{path}.error"), level.error, bound));
            }
            check_triangles(&format!("{path}.indices"), &level.indices, self.vertices())?;
            least = level.error;
            // Only vertices that move into others must be vertices of the level before.
            if self.partners.is_empty() {
                continue;
            }
            if level.indices.is_empty() {
                let bound = "must be at least 3 in a mesh with partners";
                return Err(InputError::new(format!("{path}.indices.len"), 0, bound));
            }
            if let Some(at) = level.indices.iter().position(|vertex| !finer[*vertex as usize]) {
                let bound = "must be a vertex of the level before in a mesh with partners";
                return Err(InputError::new(format!("{path}.indices[{at}]"), level.indices[at], bound));
            }
            finer = self.used(&level.indices);
        }
        Ok(())
    }

    fn validate_partners(&self) -> Result<(), InputError> {
        let vertices = self.vertices();
        // Partners have no meaning without levels.
        if self.partners.is_empty() || self.levels.is_empty() {
            return Ok(());
        }
        let bound = || format!("must be {vertices}, one a vertex, or 0");
        InputError::check(self.partners.len() == vertices, "mesh.partners.len", self.partners.len(), bound)?;
        let coarsest = self.coarsest_levels();
        for (vertex, partner) in (0..).zip(&self.partners) {
            let Some(level) = coarsest.get(*partner as usize) else {
                let bound = format!("must be below {vertices}");
                return Err(InputError::new(format!("mesh.partners[{vertex}]"), partner, bound));
            };
            let own = coarsest[vertex as usize];
            // With this condition, every chain of partners ends.
            if !(partner == &vertex
                || *level > own
                || *level == own && self.partners[*partner as usize] == *partner)
            {
                let bound = format!("must be a vertex of level {}, or stay at level {own}", own + 1);
                return Err(InputError::new(format!("mesh.partners[{vertex}]"), partner, bound));
            }
        }
        Ok(())
    }

    /// For each vertex, whether a triangle of `indices` uses it.
    fn used(&self, indices: &[u32]) -> Vec<bool> {
        let mut used = vec![false; self.vertices()];
        indices.iter().for_each(|vertex| used[*vertex as usize] = true);
        used
    }

    fn validate_targets(&self) -> Result<(), InputError> {
        let targets = self.targets.len();
        InputError::check_len("mesh.weights", self.weights.len(), targets, "a target")?;
        numbers_in_range(|| "mesh.weights".to_owned(), &self.weights)?;
        for (at, target) in self.targets.iter().enumerate() {
            let path = format!("mesh.targets[{at}]");
            let (vertices, deltas) = (&target.vertices, &target.deltas);
            InputError::check_len(&format!("{path}.deltas"), deltas.len(), vertices.len(), "a vertex")?;
            let is_wrong = |at: &usize| {
                vertices[*at] as usize >= self.vertices() || (*at > 0 && vertices[at - 1] >= vertices[*at])
            };
            if let Some(at) = (0..vertices.len()).find(is_wrong) {
                let bound = format!("must ascend below {}", self.vertices());
                return Err(InputError::new(format!("{path}.vertices[{at}]"), vertices[at], bound));
            }
            for (at, delta) in deltas.iter().enumerate() {
                for (field, vector) in
                    [("position", delta.position), ("normal", delta.normal), ("tangent", delta.tangent)]
                {
                    numbers_in_range(|| format!("{path}.deltas[{at}].{field}"), &vector)?;
                }
            }
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use crate::InputError;
    use crate::asset::influences::{Influence, Influences};
    use crate::asset::mesh::tests::triangle;
    use crate::asset::mesh::{Mesh, MeshLevel};

    #[test]
    fn meshes_are_checked_field_by_field() {
        let refused = |change: &dyn Fn(&mut Mesh)| {
            let (mut mesh, skins) = triangle();
            change(&mut mesh);
            mesh.validate(&skins).expect_err("refused").path
        };
        assert_eq!(refused(&|mesh| mesh.skin = 1), "mesh.skin");
        assert_eq!(refused(&|mesh| mesh.uv.clear()), "mesh.uv.len");
        assert_eq!(refused(&|mesh| mesh.positions[1][2] = f32::NAN), "mesh.positions[1][2]");
        assert_eq!(refused(&|mesh| mesh.tangents[0][3] = 2e18), "mesh.tangents[0][3]");
        assert_eq!(refused(&|mesh| mesh.indices.truncate(2)), "mesh.indices.len");
        assert_eq!(refused(&|mesh| mesh.indices[1] = 3), "mesh.indices[1]");
        assert_eq!(refused(&|mesh| mesh.weights.clear()), "mesh.weights.len");
    }

    #[test]
    fn targets_and_influences_are_refused_with_their_place() {
        let refused = |change: &dyn Fn(&mut Mesh)| {
            let (mut mesh, skins) = triangle();
            change(&mut mesh);
            mesh.validate(&skins).expect_err("refused")
        };
        let far = |mesh: &mut Mesh| {
            let near = vec![Influence { bone: 0, weight: 1.0 }];
            let far = vec![Influence { bone: 2, weight: 1.0 }];
            mesh.influences = Influences::new("w", 3, vec![near.clone(), far, near]).expect("valid");
        };
        let doubled = |mesh: &mut Mesh| {
            let delta = mesh.targets[0].deltas[0];
            (mesh.targets[0].vertices, mesh.targets[0].deltas) = (vec![1, 1], vec![delta; 2]);
        };
        let range = "must be finite and within ±1e18";
        type Case<'a> = (&'a dyn Fn(&mut Mesh), &'a str, &'a str, &'a str);
        let cases: [Case<'_>; 6] = [
            (&far, "mesh.influences[1].bone", "2", "must be below 2, the skin's bones"),
            (&|mesh| mesh.weights[0] = f32::NAN, "mesh.weights[0]", "NaN", range),
            (
                &|mesh| mesh.targets[0].deltas.clear(),
                "mesh.targets[0].deltas.len",
                "0",
                "must be 1, one a vertex",
            ),
            (
                &|mesh| mesh.targets[0].vertices[0] = 3,
                "mesh.targets[0].vertices[0]",
                "3",
                "must ascend below 3",
            ),
            (&doubled, "mesh.targets[0].vertices[1]", "1", "must ascend below 3"),
            (
                &|mesh| mesh.targets[0].deltas[0].normal[1] = f32::NAN,
                "mesh.targets[0].deltas[0].normal[1]",
                "NaN",
                range,
            ),
        ];
        for (change, path, value, bound) in cases {
            assert_eq!(refused(change), InputError::new(path, value, bound));
        }
    }

    /// Without partners, a level may be empty, and use vertices that the level before does not use.
    #[test]
    fn levels_are_nested_and_coarser_and_coarser() {
        // Level 0 has two triangles; the other levels have the given triangles and errors.
        let with_partners = |partners: &[u32], levels: &[(&[u32], f32)]| {
            let (mut mesh, skins) = triangle();
            mesh.partners = partners.to_vec();
            mesh.indices = vec![0, 1, 2, 2, 1, 0];
            let level =
                |(indices, error): &(&[u32], f32)| MeshLevel { indices: indices.to_vec(), error: *error };
            mesh.levels = levels.iter().map(level).collect();
            mesh.validate(&skins).map_err(|error| error.path)
        };
        let levelled = |levels: &[(&[u32], f32)]| with_partners(&[], levels);
        let (one, none): (&[u32], &[u32]) = (&[0, 1, 2], &[]);
        assert_eq!(levelled(&[(one, 0.0), (one, 0.5), (&[1, 1, 1], 0.5)]), Ok(()));
        assert_eq!(levelled(&vec![(one, 1.0); 15]), Ok(()));
        let refused =
            |levels: &[(&[u32], f32)], field: &str| assert_eq!(levelled(levels), Err(field.to_owned()));
        refused(&vec![(one, 1.0); 16], "mesh.levels.len");
        refused(&[(one, -1.0)], "mesh.levels[0].error");
        refused(&[(one, f32::NAN)], "mesh.levels[0].error");
        refused(&[(one, f32::INFINITY)], "mesh.levels[0].error");
        refused(&[(one, 1.0), (one, 0.5)], "mesh.levels[1].error");
        refused(&[(&[0, 1], 1.0)], "mesh.levels[0].indices.len");
        refused(&[(&[0, 1, 3], 1.0)], "mesh.levels[0].indices[2]");
        for (levels, field) in [
            ([(one, 1.0), (none, 1.0)], "mesh.levels[1].indices.len"),
            ([(&[0, 1, 1][..], 1.0), (one, 1.0)], "mesh.levels[1].indices[2]"),
        ] {
            assert_eq!(levelled(&levels), Ok(()));
            assert_eq!(with_partners(&[0, 1, 2], &levels), Err(field.to_owned()));
        }
    }
}
