// One iteration of thermal erosion: between each pair of 4-neighbours, an eighth of the difference beyond the
// stable one slides downhill. All pairs read the same old field. Each window loses its outermost ring of
// samples.

struct ThermalParams {
    in_width: u32,
    threshold: i32,
}

@group(0) @binding(0) var<uniform> params: ThermalParams;
@group(0) @binding(1) var<storage, read> windows: array<i32>;
@group(0) @binding(2) var<storage, read_write> cropped: array<i32>;

@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    let width = params.in_width - 2u;
    if id.x >= width {
        return;
    }
    let at = id.xy + vec2<u32>(1u);
    let center = (id.z * params.in_width + at.y) * params.in_width + at.x;
    let height = windows[center];
    let differences = vec4<i32>(
        windows[center - 1u], windows[center + 1u],
        windows[center - params.in_width], windows[center + params.in_width]) - vec4<i32>(height);
    let excess = max(abs(differences) - vec4<i32>(params.threshold), vec4<i32>(0)) >> vec4<u32>(3u);
    let gained = excess * sign(differences);
    cropped[(id.z * width + id.y) * width + id.x] = height + gained.x + gained.y + gained.z + gained.w;
}
