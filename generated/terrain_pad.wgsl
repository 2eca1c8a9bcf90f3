// relievo terrain/pad: generated from kernels/terrain/pad.wgsl

struct PadParams {
    size: u32,
    apron: u32
}

@group(0) @binding(0)
var<uniform> params: PadParams;

@group(0) @binding(1)
var<storage, read> patches: array<i32>;

@group(0) @binding(2)
var<storage, read_write> outputs: array<i32>;

@group(0) @binding(3)
var<storage, read> around: array<u32>;

const NONE = 4294967295u;

const ELSEWHERE = 4294967294u;

@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    let width = params.size + 2u * params.apron;
    if any(id.xy >= vec2<u32>(width)) {
        return;
    }
    let at = vec2<i32>(id.xy) - i32(params.apron);
    let last = i32(params.size) - 1;
    let tile = vec2<i32>(1) - vec2<i32>(at < vec2<i32>(0)) + vec2<i32>(at > vec2<i32>(last));
    let provider = provider_of(id.z, tile);
    let index = around_at(id.z, provider);
    if index != ELSEWHERE {
        let local = vec2<u32>(clamp(at - last * (provider - 1), vec2<i32>(0), vec2<i32>(last)));
        outputs[(id.z * width + id.y) * width + id.x] = patches[(index * params.size + local.y) * params.size + local.x];
    }
}

fn provider_of(window: u32, tile: vec2<i32>) -> vec2<i32> {
    if around_at(window, tile) != NONE {
        return tile;
    }
    if around_at(window, vec2<i32>(tile.x, 1)) != NONE {
        return vec2<i32>(tile.x, 1);
    }
    if around_at(window, vec2<i32>(1, tile.y)) != NONE {
        return vec2<i32>(1, tile.y);
    }
    return vec2<i32>(1);
}

fn around_at(window: u32, tile: vec2<i32>) -> u32 {
    return around[9u * window + u32(3 * tile.y + tile.x)];
}
