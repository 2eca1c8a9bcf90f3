// Windows around the patches of a batch, gathered from the patches themselves and their neighbours. There is
// one dispatch for each buffer of patches; it writes the samples that come from that buffer.

struct PadParams {
    size: u32,
    apron: u32,
}

@group(0) @binding(0) var<uniform> params: PadParams;
@group(0) @binding(1) var<storage, read> patches: array<i32>;
// Nine indices per patch: the patches at and around it, row by row; 0xffffffff where there is none, 0xfffffffe
// for one that lies in another buffer.
@group(0) @binding(2) var<storage, read> around: array<u32>;
@group(0) @binding(3) var<storage, read_write> windows: array<i32>;

const NONE = 0xffffffffu;
const ELSEWHERE = 0xfffffffeu;

@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    let width = params.size + 2u * params.apron;
    if id.x >= width {
        return;
    }
    let at = vec2<i32>(id.xy) - vec2<i32>(i32(params.apron));
    let source = source_of(id.z, at);
    let patch_index = around_at(id.z, source);
    if patch_index == ELSEWHERE {
        return;
    }
    let last = i32(params.size) - 1;
    let local = vec2<u32>(clamp(at - last * (source - vec2<i32>(1)), vec2<i32>(0), vec2<i32>(last)));
    windows[(id.z * width + id.y) * width + id.x] =
        patches[patch_index * params.size * params.size + local.y * params.size + local.x];
}

// The tile (column, row) whose patch provides the sample.
fn source_of(window: u32, at: vec2<i32>) -> vec2<i32> {
    let last = i32(params.size) - 1;
    let tile = vec2<i32>(1) + select(vec2<i32>(0), vec2<i32>(1), at > vec2<i32>(last))
        - select(vec2<i32>(0), vec2<i32>(1), at < vec2<i32>(0));
    // Try the tile itself, then its neighbours in x and in y, and last the patch itself; a missing tile is
    // replaced by clamping.
    var source = vec2<i32>(tile.x, tile.y);
    if around_at(window, source) == NONE {
        source = vec2<i32>(tile.x, 1);
    }
    if around_at(window, source) == NONE {
        source = vec2<i32>(1, tile.y);
    }
    if around_at(window, source) == NONE {
        source = vec2<i32>(1, 1);
    }
    return source;
}

fn around_at(window: u32, tile: vec2<i32>) -> u32 {
    return around[9u * window + u32(3 * tile.y + tile.x)];
}
