// A directional light over terrain, in linear light.

// The sun: one direction for all of the terrain.
struct Light {
    // Unit vector towards the light.
    direction: vec3<f32>,
    // Light that a surface facing away from the light still receives, 0 to 1.
    ambient: f32,
}

// The light that a surface with a linear albedo and a unit normal reflects, linear: Lambert's cosine and the
// ambient part.
fn lit(light: Light, normal: vec3<f32>, albedo: vec3<f32>) -> vec3<f32> {
    let facing = max(0.0, dot(normal, light.direction));
    return albedo * (light.ambient + (1.0 - light.ambient) * facing);
}
