// A shader of somebody's own behind the module: four vertices (five pairs of floats each), each moved by a bone of a palette
// of dual quaternions (16 floats) that stands behind them.
@group(0) @binding(0) var<storage, read> given: array<f32>;
@group(0) @binding(1) var<storage, read_write> results: array<u32>;

fn pair(at: u32) -> vec2<f32> {
    return vec2<f32>(given[at], given[at + 1u]);
}

fn quad(at: u32) -> vec4<f32> {
    return vec4<f32>(pair(at), pair(at + 2u));
}

@compute @workgroup_size(4)
fn main(@builtin(local_invocation_index) vertex: u32) {
    let at = 10u * vertex;
    let bone = 40u + 16u * vertex;
    let rows = rows_of_dual(quad(bone), quad(bone + 4u), quad(bone + 8u), quad(bone + 12u));
    let position = placed_position(rows, vertex_position(pair(at), pair(at + 2u)));
    let normal = placed_normal(rows, vertex_normal(pair(at + 2u), pair(at + 4u)));
    let tangent = vertex_tangent(pair(at + 6u), pair(at + 8u));
    for (var axis = 0u; axis < 3u; axis++) {
        results[10u * vertex + axis] = bitcast<u32>(position[axis]);
        results[10u * vertex + 3u + axis] = bitcast<u32>(normal[axis]);
    }
    for (var axis = 0u; axis < 4u; axis++) {
        results[10u * vertex + 6u + axis] = bitcast<u32>(tangent[axis]);
    }
}
