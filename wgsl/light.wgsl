// Lighting of surfaces, shared by everything that is drawn.

// Linear light that a Lambertian (matte) surface of a linear albedo reflects. `direct`, 0..1, is the cosine of the light's
// incidence, reduced in shadow. `ambient`, 0..1, is the light that the surface receives without it.
fn lambert(albedo: vec3<f32>, ambient: f32, direct: f32) -> vec3<f32> {
    return albedo * (ambient + (1.0 - ambient) * direct);
}
