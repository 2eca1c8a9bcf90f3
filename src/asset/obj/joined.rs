//! Joins corners into vertices: those that name the same position, texture coordinates and normal become one.

use std::collections::HashMap;

use super::parsed::Corner;

/// Vertices, each a corner that occurs, and three of them for each triangle.
pub(super) struct Joined {
    /// In ascending order of their numbers: positions in the file's order.
    pub vertices: Vec<Corner>,
    pub indices: Vec<u32>,
}

impl Joined {
    /// The vertices of triangles, three corners each.
    pub fn new(corners: &[Corner]) -> Self {
        let mut places: HashMap<Corner, u32> = HashMap::new();
        let mut vertices = Vec::new();
        let mut indices: Vec<u32> = (corners.iter())
            .map(|corner| {
                *places.entry(*corner).or_insert_with(|| {
                    vertices.push(*corner);
                    (vertices.len() - 1) as u32
                })
            })
            .collect();
        let mut order: Vec<u32> = (0..vertices.len() as u32).collect();
        order.sort_unstable_by_key(|place| vertices[*place as usize]);
        let mut rank = vec![0; vertices.len()];
        order.iter().zip(0..).for_each(|(place, at)| rank[*place as usize] = at);
        indices.iter_mut().for_each(|index| *index = rank[*index as usize]);
        let vertices = order.into_iter().map(|place| vertices[place as usize]).collect();
        Self { vertices, indices }
    }
}

#[cfg(test)]
mod tests {
    use super::super::parsed::NONE;
    use super::*;

    #[test]
    fn equal_corners_are_one_vertex() {
        let corners = [[3, 0, NONE], [1, 0, NONE], [2, 0, NONE], [2, 0, NONE], [1, 1, NONE], [3, 0, NONE]];
        let Joined { vertices, indices } = Joined::new(&corners);
        assert_eq!(vertices, [[1, 0, NONE], [1, 1, NONE], [2, 0, NONE], [3, 0, NONE]]);
        assert_eq!(indices, [3, 0, 2, 2, 1, 3]);
    }
}
