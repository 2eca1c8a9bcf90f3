// Which texels a colour map shows. Places in textures are whole numbers, so that every device reads the same texels.
import package::wgsl::terrain::zones::Zone;

// A zone as the colour map uses it.
struct MapZone {
    zone: Zone,
    // The index of the first texel of its texture.
    first: u32,
    // Binary logarithm of the number of texels along an edge of its texture.
    edge_log2: u32,
}

// Number of fractional bits of a position in tiles. Its integer part has the 10 bits of TILES_PERIOD.
const TILE_BITS: u32 = 22u;

// Converts a height to 2^-22 tiles, rounded down, modulo TILES_PERIOD. `tiles_per_unit` are the 2^-22 tiles per unit of height.
fn tiles_up(height: i32, tiles_per_unit: u32) -> u32 {
    let part = u32(height) & 0xffffu;
    let low = part * (tiles_per_unit & 0xffffu);
    return u32(height >> 16u) * tiles_per_unit + part * (tiles_per_unit >> 16u) + (low >> 16u);
}

// As `triplanar_uv`, in whole numbers.
fn plane_tiles(plane: u32, tiles: vec3<u32>) -> vec2<u32> {
    let wall = vec2<u32>(select(tiles.x, tiles.z, plane == 1u), 0u - tiles.y);
    return select(wall, tiles.xz, plane == 0u);
}

// The index of the texel of a zone at a place in 2^-22 tiles.
fn texel_index(map_zone: MapZone, tiles: vec2<u32>) -> u32 {
    let edge_log2 = map_zone.edge_log2;
    let mask = vec2<u32>((1u << edge_log2) - 1u);
    let at = ((tiles * u32(map_zone.zone.repeats)) >> vec2<u32>(TILE_BITS - edge_log2)) & mask;
    return map_zone.first + (at.y << edge_log2) + at.x;
}
