// Blades of grass that sway. An instance is a tuft; a blade has five vertices: two at the root, two halfway up, and the tip.
struct GrassBlade {
    root: vec2<f32>,
    height: f32,
    // In radians: the direction across the blade, and when it sways.
    phase: f32,
}

// In seconds: of this frame and of the last one.
struct GrassTime {
    now: f32,
    last: f32,
}

@group(2) @binding(0) var<storage, read> grass_blades: array<GrassBlade>;
@group(2) @binding(1) var<uniform> grass_time: GrassTime;

const GRASS_WIDTH = 0.02;
const GRASS_SWAY = 0.12;

// Where a vertex is in the tuft.
fn grass_bent(vertex: u32, seconds: f32) -> vec3<f32> {
    let blade = grass_blades[vertex / 5u];
    let corner = vertex % 5u;
    let up = 0.5 * f32(corner / 2u);
    let side = GRASS_WIDTH * (1.0 - up) * (2.0 * f32(corner % 2u) - 1.0);
    let across = side * vec2<f32>(cos(blade.phase), sin(blade.phase));
    let sway = GRASS_SWAY * up * up * sin(2.0 * seconds + blade.phase);
    let at = blade.root + across + vec2<f32>(sway, 0.4 * sway);
    return vec3<f32>(at.x, blade.height * up, at.y);
}

fn grass_place(entry: u32, vertex: u32) -> relievo_SceneVertex {
    let blade = grass_blades[vertex / 5u];
    let across = vec4<f32>(cos(blade.phase), 0.0, sin(blade.phase), 1.0);
    // Tilted upwards, so that the tuft is lit like the ground.
    let normal = vec3<f32>(-across.z, 1.0, across.x);
    let up = 0.5 * f32(vertex % 5u / 2u);
    return relievo_scene_placed(entry, grass_bent(vertex, grass_time.now), normal, across, vec4<f32>(0.0, up, 0.0, 0.0));
}

fn grass_last_position(entry: u32, vertex: u32) -> vec3<f32> {
    return relievo_scene_last_placed(entry, grass_bent(vertex, grass_time.last));
}

fn grass_surface(in: relievo_SceneFragment) -> Surface {
    var surface = relievo_scene_surface(in);
    // Both sides of a blade are lit like the ground.
    surface.normal = normalize(in.normal);
    surface.geometric_normal = surface.normal;
    surface.color = mix(vec3<f32>(0.05, 0.12, 0.02), vec3<f32>(0.35, 0.55, 0.12), in.uv.y) * surface.tint.rgb;
    return surface;
}
