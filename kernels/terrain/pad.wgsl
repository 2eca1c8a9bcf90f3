// Windows around the patches of a batch, gathered from the patches and their neighbours. There is one dispatch per buffer of
// patches; it writes the samples that come from that buffer. A thread copies a sample. The thread's `id` has the sample's
// column, its row, and the window.

// Parameters of the kernel `terrain/pad`.
struct PadParams {
    // Number of samples along an edge of a patch.
    size: u32,
    // Number of samples by which a window extends beyond its patch on every side.
    apron: u32,
}

// Parameters of the kernel.
@group(0) @binding(0) var<uniform> params: PadParams;
// Heights of the patches in the buffer of this dispatch, in 1/65536 units.
@group(0) @binding(1) var<storage, read> patches: array<i32>;
// Out: heights of the windows, row by row.
@group(0) @binding(2) var<storage, read_write> outputs: array<i32>;
// Nine indices per patch, row by row: the patch itself and the patches around it. 0xffffffff stands for a missing patch,
// 0xfffffffe for a patch in another buffer.
@group(0) @binding(3) var<storage, read> around: array<u32>;

// Index of a patch that does not exist.
const NONE = 0xffffffffu;
// Index of a patch that lies in another buffer.
const ELSEWHERE = 0xfffffffeu;

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
        // Where a patch is missing, the edge samples of another patch are repeated.
        let local = vec2<u32>(clamp(at - last * (provider - 1), vec2<i32>(0), vec2<i32>(last)));
        outputs[(id.z * width + id.y) * width + id.x] = patches[(index * params.size + local.y) * params.size + local.x];
    }
}

// Tile (column, row) whose patch provides the samples of `tile`. Both tiles are among the nine tiles of a window. In order of
// preference: the tile itself, its neighbour in x, its neighbour in y, the patch in the middle.
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

// Index of the patch in a tile of a window, `NONE` or `ELSEWHERE`.
fn around_at(window: u32, tile: vec2<i32>) -> u32 {
    return around[9u * window + u32(3 * tile.y + tile.x)];
}
