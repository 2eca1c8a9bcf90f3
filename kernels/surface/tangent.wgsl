// Tangent frames at the vertices of a triangle mesh (thesis B section 4.2). Each vertex gathers the tangents of its triangles in
// ascending order. No atomics are needed, and the sum is the same in every run.

// Parameters of the kernel `surface/tangent`.
struct TangentParams {
    // Number of vertices.
    vertices: u32,
}

// Parameters of the kernel.
@group(0) @binding(0) var<uniform> params: TangentParams;
// Positions, three floats per vertex.
@group(0) @binding(1) var<storage, read> positions: array<f32>;
// Normals, three words per vertex. They are read as bits, because normals may be infinite or NaN, and a shader may assume that
// floats are finite.
@group(0) @binding(2) var<storage, read> normals: array<u32>;
// Texture coordinates, two floats per vertex.
@group(0) @binding(3) var<storage, read> texture_coordinates: array<f32>;
// Indices of the triangles' vertices, three per triangle.
@group(0) @binding(4) var<storage, read> indices: array<u32>;
// Index in `corners` of each vertex's first corner. The last element is the number of corners.
@group(0) @binding(5) var<storage, read> offsets: array<u32>;
// Corners of each vertex, as positions in `indices`.
@group(0) @binding(6) var<storage, read> corners: array<u32>;
// Out: unit tangent of each vertex (xyz), and handedness w, 1 or -1.
@group(0) @binding(7) var<storage, read_write> tangents: array<vec4<f32>>;

// Length below which a vector has no direction: 2^-100.
const LEAST: f32 = 7.888609052210118e-31;
// Bits of the f32 `LEAST`.
const LEAST_BITS: u32 = 0x0d800000u;
// Bits of the f32 2^100. A normal with a larger component counts as a vector without direction.
const LARGEST_BITS: u32 = 0x71800000u;
// A triangle contributes nothing if its area, its tangent or its area in uv is no larger than this. Before the measurement, the
// triangle is scaled to a box of edge 1, and its uv coordinates to a square of edge 1, u and v separately. Rounding errors are
// at most a sixteenth of this value. They rotate a tangent of this length by less than four degrees.
const DEGENERATE: f32 = 1.0 / 16384.0;
// Threshold of two sums at a vertex, as a fraction of the sum of weights. A sum of tangents counts as 0 if its component
// orthogonal to the normal is no longer than the threshold. The handedness is -1 if the sum of handedness values is below the
// negative threshold.
const VANISHING: f32 = 1.0 / 64.0;

// Contribution of one triangle to the tangent of a vertex.
struct Contribution {
    // Unit tangent times the weight, with the sign of the area in uv.
    tangent: vec3<f32>,
    // Weight by the triangle's angle at the vertex.
    weight: f32,
    // Weight times the cosine between the normals of vertex and triangle, with the sign of the area in uv.
    handedness: f32,
}

// Position of a vertex.
fn position(vertex: u32) -> vec3<f32> {
    return vec3<f32>(positions[3u * vertex], positions[3u * vertex + 1u], positions[3u * vertex + 2u]);
}

// Texture coordinates of a vertex.
fn texture_coordinate(vertex: u32) -> vec2<f32> {
    return vec2<f32>(texture_coordinates[2u * vertex], texture_coordinates[2u * vertex + 1u]);
}

// Largest absolute component of a vector.
fn largest(vector: vec3<f32>) -> f32 {
    let size = abs(vector);
    return max(max(size.x, size.y), size.z);
}

// The vector scaled to length 1. Its length must not be 0.
fn unit(vector: vec3<f32>) -> vec3<f32> {
    return vector * inverseSqrt(dot(vector, vector));
}

// Contribution of a triangle to the vertex at one of its corners. `normal` is the vertex's unit normal.
fn contribution(corner: u32, normal: vec3<f32>) -> Contribution {
    let nothing = Contribution(vec3<f32>(0.0), 0.0, 0.0);
    let first = corner - corner % 3u;
    let vertex = indices[corner];
    let next = indices[first + (corner + 1u) % 3u];
    let last = indices[first + (corner + 2u) % 3u];
    var a = position(next) - position(vertex);
    var b = position(last) - position(vertex);
    let size = max(max(largest(a), largest(b)), largest(b - a));
    var s = texture_coordinate(next) - texture_coordinate(vertex);
    var t = texture_coordinate(last) - texture_coordinate(vertex);
    let extent = max(max(abs(s), abs(t)), abs(t - s));
    if size < LEAST || extent.x < LEAST || extent.y < LEAST {
        return nothing;
    }
    a /= size;
    b /= size;
    s /= extent;
    t /= extent;
    let area = s.x * t.y - t.x * s.y;
    let face = cross(a, b);
    let along = t.y * a - s.y * b;
    if abs(area) <= DEGENERATE
        || dot(face, face) <= DEGENERATE * DEGENERATE
        || dot(along, along) <= DEGENERATE * DEGENERATE {
        return nothing;
    }
    let weight = length(unit(b) - unit(a));
    let signed_weight = select(-weight, weight, area > 0.0);
    return Contribution(unit(along) * signed_weight, weight, signed_weight * dot(normal, unit(face)));
}

// First vector of the basis by Duff et al. 2017 for a unit normal. `negative_z` selects the sign.
fn fallback(normal: vec3<f32>, negative_z: bool) -> vec3<f32> {
    let side = select(1.0, -1.0, negative_z);
    let a = -1.0 / (side + normal.z);
    return vec3<f32>(1.0 + side * normal.x * normal.x * a, side * normal.x * normal.y * a, -side * normal.x);
}

// Unit tangent of a vertex (xyz), and handedness w, 1 or -1.
fn frame(vertex: u32) -> vec4<f32> {
    let bits = vec3<u32>(normals[3u * vertex], normals[3u * vertex + 1u], normals[3u * vertex + 2u]);
    let magnitude = bits & vec3<u32>(0x7fffffffu);
    let largest_bits = max(max(magnitude.x, magnitude.y), magnitude.z);
    if largest_bits < LEAST_BITS || largest_bits > LARGEST_BITS {
        return vec4<f32>(1.0, 0.0, 0.0, 1.0);
    }
    let normal = unit(bitcast<vec3<f32>>(bits) / bitcast<f32>(largest_bits));
    var sum = vec3<f32>(0.0);
    var weight = 0.0;
    var handedness = 0.0;
    let end = offsets[vertex + 1u];
    for (var at = offsets[vertex]; at < end; at++) {
        let added = contribution(corners[at], normal);
        sum += added.tangent;
        weight += added.weight;
        handedness += added.handedness;
    }
    let flat = sum - normal * dot(normal, sum);
    let least = weight * VANISHING;
    if dot(flat, flat) <= least * least {
        return vec4<f32>(fallback(normal, (bits.z >> 31u) == 1u), 1.0);
    }
    let tangent = unit(flat);
    // The projection is repeated, because its rounding error is large if the sum is nearly parallel to the normal.
    let orthogonal = unit(tangent - normal * dot(normal, tangent));
    return vec4<f32>(orthogonal, select(1.0, -1.0, handedness < -least));
}

@compute @workgroup_size(64)
fn main(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) lane: u32,
) {
    let vertex = (group.y * groups.x + group.x) * 64u + lane;
    if vertex >= params.vertices {
        return;
    }
    tangents[vertex] = frame(vertex);
}
