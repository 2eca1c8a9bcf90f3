// A directional light over terrain, in linear light.
import package::wgsl::light::lambert;

// The sun: a light with one direction for all of the terrain.
struct Light {
    // Unit vector towards the light.
    direction: vec3<f32>,
    // Fraction of the light that a surface facing away still receives, 0 to 1.
    ambient: f32,
}

// Linear light that a surface reflects: Lambert's cosine and the ambient part. `albedo` is linear, and `normal` is a unit
// vector.
fn lit(light: Light, normal: vec3<f32>, albedo: vec3<f32>) -> vec3<f32> {
    return lambert(albedo, light.ambient, max(0.0, dot(normal, light.direction)));
}
