// Loads the texels that a colour map blends (`terrain/blend`), and reduces them to one word per pixel: the exclusive or of the
// texels' words. The kernel measures the cost of the loads alone.
import package::wgsl::terrain::tiles::{MapZone, plane_tiles, texel_index, tiles_up};
import package::wgsl::terrain::windows::{inner_index, is_inner, sample_index, windows};

// Parameters of the kernel `baseline/texels`.
struct TexelsParams {
    // Number of samples along an edge of a window.
    width: u32,
    // Number of zones.
    zone_count: u32,
    // Number of planes from which textures are projected: 1 (from above) or 3 (triplanar).
    planes: u32,
    // Texture tiles per sample, in 2^-22 tiles.
    tiles_per_sample: u32,
    // Texture tiles per world unit of height, in 2^-22 tiles.
    tiles_per_unit: u32,
}

// Parameters of the kernel.
@group(0) @binding(0) var<uniform> params: TexelsParams;
// Zones of the ground and their textures.
@group(0) @binding(2) var<storage, read> zones: array<MapZone>;
// Texels of all textures, two words each.
@group(0) @binding(3) var<storage, read> texels: array<vec2<u32>>;
// Position of the first pixel of each map, in 2^-22 tiles.
@group(0) @binding(4) var<storage, read> places: array<vec2<u32>>;
// Out: one word per pixel.
@group(0) @binding(5) var<storage, read_write> words: array<u32>;

@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    if !is_inner(params.width, id) {
        return;
    }
    let height = windows[sample_index(params.width, id)];
    let place = places[id.z] + id.xy * params.tiles_per_sample;
    let tiles = vec3<u32>(place.x, tiles_up(height, params.tiles_per_unit), place.y);
    var word = 0u;
    for (var z = 0u; z < params.zone_count; z++) {
        let map_zone = zones[z];
        for (var plane = 0u; plane < params.planes; plane++) {
            let texel = texels[texel_index(map_zone, plane_tiles(plane, tiles))];
            word ^= texel.x ^ texel.y;
        }
    }
    words[inner_index(params.width, id)] = word;
}
