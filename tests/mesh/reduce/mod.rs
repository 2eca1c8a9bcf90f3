//! All reducers behind one interface.

mod clusters;
mod damaged;
mod interface;
mod joins;
mod quality;
mod topology;
mod turned;

use relievo::ops::mesh::{Cost, Seams, Surface};
use relievo_lab::reduce::{Limits, Reduced, Reducer};

use crate::shapes::Shape;

/// The reducers that keep the topology.
const KEEPING: [Reducer; 4] = [
    Reducer::HalfEdge { cost: Cost::Quadric, seams: Seams::Held },
    Reducer::HalfEdge { cost: Cost::Melax { check_normals: true }, seams: Seams::Held },
    Reducer::FullEdge,
    Reducer::VertexRemoval,
];

/// The reducers that may change it.
const CHANGING: [Reducer; 3] = [
    Reducer::VertexPair { distance: 0.02 },
    Reducer::UniformClustering { cells: 1024 },
    Reducer::ImportanceClustering,
];

fn to(triangles: usize) -> Limits {
    Limits { triangles, ..Limits::default() }
}

/// The mesh at some percentages of its triangles, and as far as possible.
fn levels(reducer: &Reducer, surface: &Surface<'_>) -> Vec<Reduced> {
    let triangles = surface.indices.len() / 3;
    let limits = [100, 80, 50, 30, 20, 10, 5, 2, 0].map(|percent| to(triangles * percent / 100));
    reducer.reduce_each(surface, &limits).expect("valid")
}

/// The result as a shape, with its attributes as texture coordinates if there are two.
fn shape_of(reduced: &Reduced) -> Shape {
    let uv = match reduced.stride {
        2 => reduced.attributes.as_chunks::<2>().0.to_vec(),
        _ => vec![[0.0; 2]; reduced.poses[0].len()],
    };
    Shape { poses: reduced.poses.clone(), uv, indices: reduced.indices.clone() }
}
