// relievo animation/bounds: generated from kernels/animation/bounds.wgsl

struct BoundsParams {
    instances: u32,
    bones: u32
}

@group(0) @binding(0)
var<uniform> params: BoundsParams;

@group(0) @binding(1)
var<storage, read> model_matrices: array<vec4<f32>>;

@group(0) @binding(2)
var<storage, read> bone_radii: array<f32>;

@group(0) @binding(3)
var<storage, read_write> bounds: array<vec4<f32>>;

const THREADS = 64u;

const GROWTH: f32 = 1.0 + 1.0 / 524288.0;

const OF_CENTER: f32 = 1.0 / 2097152.0;

const LEAST: f32 = 2.16840434e-19;

const LARGEST = 3.4028234663852886e38;

var<workgroup> lows: array<vec3<f32>, THREADS>;

var<workgroup> highs: array<vec3<f32>, THREADS>;

@compute @workgroup_size(THREADS)
fn main(@builtin(workgroup_id) group: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    let instance = group.y * groups.x + group.x;
    var low = vec3<f32>(LARGEST);
    var high = vec3<f32>(-LARGEST);
    for (var bone = lane; bone < params.bones; bone += THREADS) {
        let at = 3u * (instance * params.bones + bone);
        let x = model_matrices[at];
        let y = model_matrices[at + 1u];
        let z = model_matrices[at + 2u];
        let center = vec3<f32>(x.w, y.w, z.w);
        let squares = vec3<f32>(dot(x.xyz, x.xyz), dot(y.xyz, y.xyz), dot(z.xyz, z.xyz));
        let half = bone_radii[bone] * (sqrt(squares) + LEAST) * GROWTH + abs(center) * OF_CENTER;
        low = min(low, center - half);
        high = max(high, center + half);
    }
    lows[lane] = low;
    highs[lane] = high;
    for (var half = THREADS / 2u; half > 0u; half /= 2u) {
        workgroupBarrier();
        if lane < half {
            lows[lane] = min(lows[lane], lows[lane + half]);
            highs[lane] = max(highs[lane], highs[lane + half]);
        }
    }
    if lane == 0u && instance < params.instances {
        bounds[2u * instance] = vec4<f32>(lows[0], 0.0);
        bounds[2u * instance + 1u] = vec4<f32>(highs[0], 0.0);
    }
}
