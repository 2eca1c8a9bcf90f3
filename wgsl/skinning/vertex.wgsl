// Layout of skinned and unskinned vertices in the kernels' buffers: five pairs of floats, one after the other.

// Position in metres, in model space, from the first and second pair of a vertex.
fn vertex_position(first: vec2<f32>, second: vec2<f32>) -> vec3<f32> {
    return vec3<f32>(first, second.x);
}

// Unit normal, from the second and third pair of a vertex.
fn vertex_normal(second: vec2<f32>, third: vec2<f32>) -> vec3<f32> {
    return vec3<f32>(second.y, third);
}

// Unit tangent (xyz), from the fourth and fifth pair of a vertex. w is 1 or -1; the bitangent is w · normal × tangent.
fn vertex_tangent(fourth: vec2<f32>, fifth: vec2<f32>) -> vec4<f32> {
    return vec4<f32>(fourth, fifth);
}
