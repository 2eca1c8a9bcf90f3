// Vertices as kernels store them, skinned or not: five pairs of floats, one after the other.

// Position in metres, in the model's space.
fn vertex_position(first: vec2<f32>, second: vec2<f32>) -> vec3<f32> {
    return vec3<f32>(first, second.x);
}

// Unit normal.
fn vertex_normal(second: vec2<f32>, third: vec2<f32>) -> vec3<f32> {
    return vec3<f32>(second.y, third);
}

// Unit tangent; w is 1 or -1, and the bitangent is w · normal × tangent.
fn vertex_tangent(fourth: vec2<f32>, fifth: vec2<f32>) -> vec4<f32> {
    return vec4<f32>(fourth, fifth);
}
