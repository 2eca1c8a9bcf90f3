// The top-down colour map of patches: zone weights (B equations 3.6 and 3.7) and hill-shading, one sRGB pixel
// per sample. The kernel reads windows that extend one sample beyond the patch.
import package::wgsl::terrain::fixed::HEIGHT_ONE;
import package::wgsl::terrain::slope::slope_normal;
import package::wgsl::terrain::zones::{Zone, zone_fold, zone_folded, zone_fraction};
import package::wgsl::terrain::light::{Light, lit};

struct MapParams {
    light: Light,
    in_width: u32,
    run: f32,
    zone_count: u32,
    additive: u32,
}

// A height zone as the colour map uses it.
struct MapZone {
    // Mean linear colour of the zone's texture.
    color: array<f32, 3>,
    // Lower end of the range, in height units.
    min: f32,
    // Upper end of the range, in height units.
    max: f32,
}

@group(0) @binding(0) var<uniform> params: MapParams;
@group(0) @binding(1) var<storage, read> windows: array<i32>;
@group(0) @binding(2) var<storage, read> zones: array<MapZone>;
// RGBA, 8 bits each, red in the lowest byte.
@group(0) @binding(3) var<storage, read_write> pixels: array<u32>;

@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    let width = params.in_width - 2u;
    if id.x >= width {
        return;
    }
    let at = id.xy + vec2<u32>(1u);
    let center = (id.z * params.in_width + at.y) * params.in_width + at.x;
    let gradient = vec2<i32>(
        windows[center + 1u] - windows[center - 1u],
        windows[center + params.in_width] - windows[center - params.in_width]);
    let albedo = zone_color(f32(windows[center]) / f32(HEIGHT_ONE));
    let color = srgb(lit(params.light, slope_normal(gradient, params.run), albedo));
    pixels[(id.z * width + id.y) * width + id.x] = pack4x8unorm(vec4<f32>(color, 1.0));
}

fn range_of(z: u32) -> Zone {
    return Zone(zones[z].min, zones[z].max);
}

fn zone_color(height: f32) -> vec3<f32> {
    var fold = zone_fold();
    for (var z = 0u; z < params.zone_count; z++) {
        fold = zone_folded(fold, z, range_of(z), height);
    }
    var color = vec3<f32>(0.0);
    for (var z = 0u; z < params.zone_count; z++) {
        let fraction = zone_fraction(fold, z, range_of(z), height, params.additive != 0u);
        color += fraction * vec3<f32>(zones[z].color[0], zones[z].color[1], zones[z].color[2]);
    }
    return color;
}

fn srgb(linear: vec3<f32>) -> vec3<f32> {
    let bounded = clamp(linear, vec3<f32>(0.0), vec3<f32>(1.0));
    let low = 12.92 * bounded;
    let high = 1.055 * pow(bounded, vec3<f32>(1.0 / 2.4)) - vec3<f32>(0.055);
    return select(high, low, bounded <= vec3<f32>(0.0031308));
}
