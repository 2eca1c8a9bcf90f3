// Lighting of surfaces, shared by everything that is drawn.

// Linear RGB light that a Lambertian (matte) surface reflects. `albedo` is linear RGB. `direct`, 0 to 1, is the cosine of the
// light's angle of incidence, reduced in shadow. `ambient`, 0 to 1, is the fraction of the light that the surface receives
// where `direct` is 0.
fn lambert(albedo: vec3<f32>, ambient: f32, direct: f32) -> vec3<f32> {
    return albedo * (ambient + (1.0 - ambient) * direct);
}
