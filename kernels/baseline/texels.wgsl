// Loads the texels that a colour map blends (`terrain/blend`), and makes nothing of them but one word a pixel: the exclusive or
// of their words. This is the cost of the loads alone. As there, a thread makes a column of pixels, four wide.
import package::wgsl::terrain::blocks::{Blocks, Thread};
import package::wgsl::terrain::columns::{centers, column_of, row_at};
import package::wgsl::terrain::tiles::{MAX_MAP_ZONES, MapZone, PackedZone, plane_tiles, texel_index, tiles_up, unpacked};

// As in the colour map.
override PLANES: u32 = 3u;

struct TexelsParams {
    blocks: Blocks,
    in_width: u32,
    zone_count: u32,
    // As in the colour map.
    tiles_per_sample: u32,
    tiles_per_unit: u32,
}

@group(0) @binding(0) var<uniform> params: TexelsParams;
@group(0) @binding(2) var<uniform> zones: array<PackedZone, MAX_MAP_ZONES>;
@group(0) @binding(3) var<storage, read> texels: array<vec2<u32>>;
// The position in tiles of the first pixel of each map, in 2^-22 tiles.
@group(0) @binding(4) var<storage, read> places: array<vec2<u32>>;
@group(0) @binding(5) var<storage, read_write> words: array<u32>;

@compute @workgroup_size(64)
fn main(thread: Thread) {
    let column = column_of(params.in_width, params.blocks, thread);
    var source = column.source + params.in_width;
    var row = column.target_index;
    var place = places[column.window] + column.at * params.tiles_per_sample;
    for (var y = 0u; y < column.rows; y++) {
        let here = row_at(source);
        store_four(row, column.width, loaded(centers(here.a, here.b), place));
        source += params.in_width;
        row += params.in_width - 2u;
        place.y += params.tiles_per_sample;
    }
}

// The words of four pixels, given their heights and the place of the first.
fn loaded(heights: vec4<i32>, place: vec2<u32>) -> vec4<u32> {
    let step = params.tiles_per_sample;
    let a = vec3<u32>(place.x, tiles_up(heights.x, params.tiles_per_unit), place.y);
    let b = vec3<u32>(place.x + step, tiles_up(heights.y, params.tiles_per_unit), place.y);
    let c = vec3<u32>(place.x + 2u * step, tiles_up(heights.z, params.tiles_per_unit), place.y);
    let d = vec3<u32>(place.x + 3u * step, tiles_up(heights.w, params.tiles_per_unit), place.y);
    var result = vec4<u32>(0u);
    for (var z = 0u; z < params.zone_count; z++) {
        let here = unpacked(zones[z]);
        for (var plane = 0u; plane < PLANES; plane++) {
            result ^= vec4<u32>(
                texel_of(here, plane, a), texel_of(here, plane, b), texel_of(here, plane, c), texel_of(here, plane, d));
        }
    }
    return result;
}

fn texel_of(map_zone: MapZone, plane: u32, tiles: vec3<u32>) -> u32 {
    let texel = texels[texel_index(map_zone, plane_tiles(plane, tiles))];
    return texel.x ^ texel.y;
}

fn store_four(row: u32, width: u32, made: vec4<u32>) {
    words[row] = made.x;
    if 1u < width {
        words[row + 1u] = made.y;
    }
    if 2u < width {
        words[row + 2u] = made.z;
    }
    if 3u < width {
        words[row + 3u] = made.w;
    }
}
