// Unit normal of a height field, y up. `gradient` has the central differences along x and z: the next sample minus the previous
// one, in 1/65536 units. `run` is twice the distance between samples, in the same units.
fn slope_normal(gradient: vec2<i32>, run: f32) -> vec3<f32> {
    return gradient_normal(vec2<f32>(gradient), run);
}

// The same for a gradient that is no integer.
fn gradient_normal(gradient: vec2<f32>, run: f32) -> vec3<f32> {
    let along = vec3<f32>(-gradient.x, run, -gradient.y);
    return along * inverseSqrt(dot(along, along));
}
