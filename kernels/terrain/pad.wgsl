// Windows around the patches of a batch, gathered from the patches themselves and their neighbours. There is
// one dispatch for each buffer of patches; it writes the samples that come from that buffer. A thread copies a block of a
// window that comes from one patch.
import package::wgsl::terrain::blocks::{Blocks, Thread, span_of};
import package::wgsl::terrain::order::block_in_order;
import package::wgsl::terrain::outputs::store_four;

struct PadParams {
    blocks: Blocks,
    size: u32,
    apron: u32,
}

@group(0) @binding(0) var<uniform> params: PadParams;
@group(0) @binding(1) var<storage, read> patches: array<i32>;
// Nine indices per patch: the patches at and around it, row by row; 0xffffffff where there is none, 0xfffffffe
// for one that lies in another buffer.
@group(0) @binding(3) var<storage, read> around: array<u32>;

const NONE = 0xffffffffu;
const ELSEWHERE = 0xfffffffeu;
// Columns of a block.
const BLOCK_WIDTH: u32 = 16u;

@compute @workgroup_size(64)
fn main(thread: Thread) {
    let block = block_in_order(params.blocks, thread);
    if !block.there {
        return;
    }
    let columns = span_of(block.at.x, BLOCK_WIDTH, params.apron, params.size);
    let rows = span_of(block.at.y, params.blocks.rows, params.apron, params.size);
    let tile = vec2<u32>(columns.tile, rows.tile);
    let provider = source_of(block.window, tile);
    let patch_index = around_at(block.window, provider);
    if patch_index == ELSEWHERE {
        return;
    }
    let local = vec2<u32>(
        first_in_patch(columns.start, tile.x, provider.x), first_in_patch(rows.start, tile.y, provider.y));
    // Where a patch is missing, the samples at the edge of another are repeated.
    let step = select(vec2<u32>(0u), vec2<u32>(1u, params.size), tile == provider);
    let width = params.size + 2u * params.apron;
    var sample = (patch_index * params.size + local.y) * params.size + local.x;
    var row = (block.window * width + rows.start) * width + columns.start;
    let length = columns.end - columns.start;
    for (var y = rows.start; y < rows.end; y++) {
        let first = four_from(sample, step.x);
        let second = four_from(sample + 4u * step.x, step.x);
        let third = four_from(sample + 8u * step.x, step.x);
        let fourth = four_from(sample + 12u * step.x, step.x);
        store_four(row, 0u, length, first);
        store_four(row, 4u, length, second);
        store_four(row, 8u, length, third);
        store_four(row, 12u, length, fourth);
        sample += step.y;
        row += width;
    }
}

fn four_from(sample: u32, step: u32) -> vec4<i32> {
    return vec4<i32>(patches[sample], patches[sample + step], patches[sample + 2u * step], patches[sample + 3u * step]);
}

// The column or row, in the patch of tile `provider`, of the sample at `start` in the window, which lies in tile `tile`.
fn first_in_patch(start: u32, tile: u32, provider: u32) -> u32 {
    let last = i32(params.size) - 1;
    return u32(clamp(i32(start) - i32(params.apron) - last * (i32(provider) - 1), 0, last));
}

// The tile (column, row) whose patch provides the samples of a tile: the tile itself, or else its neighbours in x and in y, and
// last the patch itself.
fn source_of(window: u32, tile: vec2<u32>) -> vec2<u32> {
    var provider = tile;
    if around_at(window, provider) == NONE {
        provider = vec2<u32>(tile.x, 1u);
    }
    if around_at(window, provider) == NONE {
        provider = vec2<u32>(1u, tile.y);
    }
    if around_at(window, provider) == NONE {
        provider = vec2<u32>(1u, 1u);
    }
    return provider;
}

fn around_at(window: u32, tile: vec2<u32>) -> u32 {
    return around[9u * window + 3u * tile.y + tile.x];
}
