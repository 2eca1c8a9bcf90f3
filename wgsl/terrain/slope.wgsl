// The unit normal of a height field, y up: from central differences along x and z (the sample after minus the sample
// before, in 1/65536 units) and twice the distance between samples in the same units.
fn slope_normal(gradient: vec2<i32>, run: f32) -> vec3<f32> {
    let along = vec3<f32>(-f32(gradient.x), run, -f32(gradient.y));
    return along * inverseSqrt(dot(along, along));
}
