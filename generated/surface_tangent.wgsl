// relievo surface/tangent: generated from kernels/surface/tangent.wgsl

struct TangentParams {
    vertices: u32
}

@group(0) @binding(0)
var<uniform> params: TangentParams;

@group(0) @binding(1)
var<storage, read> positions: array<f32>;

@group(0) @binding(2)
var<storage, read> normals: array<u32>;

@group(0) @binding(3)
var<storage, read> texture_coordinates: array<f32>;

@group(0) @binding(4)
var<storage, read> indices: array<u32>;

@group(0) @binding(5)
var<storage, read> offsets: array<u32>;

@group(0) @binding(6)
var<storage, read> corners: array<u32>;

@group(0) @binding(7)
var<storage, read_write> tangents: array<vec4<f32>>;

const LEAST: f32 = 7.888609052210118e-31;

const LEAST_BITS: u32 = 226492416u;

const LARGEST_BITS: u32 = 1904214016u;

const DEGENERATE: f32 = 1.0 / 16384.0;

const VANISHING: f32 = 1.0 / 64.0;

struct Contribution {
    tangent: vec3<f32>,
    weight: f32,
    handedness: f32
}

fn position(vertex: u32) -> vec3<f32> {
    return vec3<f32>(positions[3u * vertex], positions[3u * vertex + 1u], positions[3u * vertex + 2u]);
}

fn texture_coordinate(vertex: u32) -> vec2<f32> {
    return vec2<f32>(texture_coordinates[2u * vertex], texture_coordinates[2u * vertex + 1u]);
}

fn largest(vector: vec3<f32>) -> f32 {
    let size = abs(vector);
    return max(max(size.x, size.y), size.z);
}

fn unit(vector: vec3<f32>) -> vec3<f32> {
    return vector * inverseSqrt(dot(vector, vector));
}

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
    if abs(area) <= DEGENERATE || dot(face, face) <= DEGENERATE * DEGENERATE || dot(along, along) <= DEGENERATE * DEGENERATE {
        return nothing;
    }
    let weight = length(unit(b) - unit(a));
    let signed_weight = select(-weight, weight, area > 0.0);
    return Contribution(unit(along) * signed_weight, weight, signed_weight * dot(normal, unit(face)));
}

fn fallback(normal: vec3<f32>, negative_z: bool) -> vec3<f32> {
    let side = select(1.0, -1.0, negative_z);
    let a = -1.0 / (side + normal.z);
    return vec3<f32>(1.0 + side * normal.x * normal.x * a, side * normal.x * normal.y * a, -side * normal.x);
}

fn frame(vertex: u32) -> vec4<f32> {
    let bits = vec3<u32>(normals[3u * vertex], normals[3u * vertex + 1u], normals[3u * vertex + 2u]);
    let magnitude = bits & vec3<u32>(2147483647u);
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
    let orthogonal = unit(tangent - normal * dot(normal, tangent));
    return vec4<f32>(orthogonal, select(1.0, -1.0, handedness < -least));
}

@compute @workgroup_size(64)
fn main(@builtin(workgroup_id) group: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    let vertex = (group.y * groups.x + group.x) * 64u + lane;
    if vertex >= params.vertices {
        return;
    }
    tangents[vertex] = frame(vertex);
}
