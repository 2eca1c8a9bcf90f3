// What light makes of a surface, the same for everything that is drawn.

// What a matt surface of a linear albedo sends to the eye, linear, after Lambert: `direct`, 0..1, is the cosine at which the
// light falls on it, less where it lies in shadow; `ambient`, 0..1, is what it gets without.
fn lambert(albedo: vec3<f32>, ambient: f32, direct: f32) -> vec3<f32> {
    return albedo * (ambient + (1.0 - ambient) * direct);
}
