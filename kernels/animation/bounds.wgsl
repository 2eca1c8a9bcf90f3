// Axis-aligned bounds of instances in the model's space, around spheres at their bones: each has the bone's
// radius and is transformed by the bone's matrix. With WHOLE, a thread handles all bones of one instance,
// otherwise a workgroup does.

override WHOLE: bool = false;

struct BoundsParams {
    instances: u32,
    bones: u32,
}

@group(0) @binding(0) var<uniform> params: BoundsParams;
// Three rows per bone.
@group(0) @binding(1) var<storage, read> model_matrices: array<vec4<f32>>;
// The radius of each bone, in its own space.
@group(0) @binding(2) var<storage, read> bone_radii: array<f32>;
// Lower and upper corner per instance.
@group(0) @binding(3) var<storage, read_write> bounds: array<vec4<f32>>;

const THREADS = 64u;
// The factor by which extents are enlarged.
const GROWTH: f32 = 1.0 + 1.0 / 524288.0;
// The fraction of the center's distance that is added to extents.
const OF_CENTER: f32 = 1.0 / 2097152.0;
// The length that is added to a row, 2⁻⁶², for squares that are flushed to 0.
const LEAST: f32 = 2.16840434e-19;
// The largest f32, with exactly these digits: some compilers refuse larger literals.
const LARGEST = 3.4028234663852886e38;

struct Box {
    low: vec3<f32>,
    high: vec3<f32>,
}

var<workgroup> lows: array<vec3<f32>, THREADS>;
var<workgroup> highs: array<vec3<f32>, THREADS>;

// The box around every `stride`-th bone.
fn around(instance: u32, first: u32, stride: u32) -> Box {
    var low = vec3<f32>(LARGEST);
    var high = vec3<f32>(-LARGEST);
    for (var bone = first; bone < params.bones; bone += stride) {
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
    return Box(low, high);
}

@compute @workgroup_size(THREADS)
fn main(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) lane: u32,
) {
    let workgroup = group.y * groups.x + group.x;
    if WHOLE {
        let instance = workgroup * THREADS + lane;
        if instance < params.instances {
            let found = around(instance, 0u, 1u);
            bounds[2u * instance] = vec4<f32>(found.low, 0.0);
            bounds[2u * instance + 1u] = vec4<f32>(found.high, 0.0);
        }
    } else {
        // Workgroups beyond the last instance write nothing.
        let own = around(workgroup, lane, THREADS);
        lows[lane] = own.low;
        highs[lane] = own.high;
        for (var half = THREADS / 2u; half > 0u; half /= 2u) {
            workgroupBarrier();
            if lane < half {
                lows[lane] = min(lows[lane], lows[lane + half]);
                highs[lane] = max(highs[lane], highs[lane + half]);
            }
        }
        if lane == 0u && workgroup < params.instances {
            bounds[2u * workgroup] = vec4<f32>(lows[0], 0.0);
            bounds[2u * workgroup + 1u] = vec4<f32>(highs[0], 0.0);
        }
    }
}
