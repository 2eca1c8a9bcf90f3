// Texels that a colour map reads. Positions in textures are whole numbers, so that every device reads the same texels.
import package::wgsl::terrain::zones::Zone;

// A zone of the ground and its texture, for colour maps.
struct MapZone {
    // The zone.
    zone: Zone,
    // Index of the first texel of the zone's texture.
    first: u32,
    // Binary logarithm of the number of texels along an edge of the zone's texture.
    edge_log2: u32,
}

// Number of fractional bits of a position in tiles. The integer part has 10 bits, enough for TILES_PERIOD.
const TILE_BITS: u32 = 22u;

// Converts a height, in 1/65536 units, to a position in 2^-22 tiles, rounded down, modulo TILES_PERIOD. `tiles_per_unit` is the
// number of 2^-22 tiles per world unit of height.
fn tiles_up(height: i32, tiles_per_unit: u32) -> u32 {
    let part = u32(height) & 0xffffu;
    let low = part * (tiles_per_unit & 0xffffu);
    return u32(height >> 16u) * tiles_per_unit + part * (tiles_per_unit >> 16u) + (low >> 16u);
}

// Position on a projection plane, as computed by `triplanar_uv`, but in whole numbers of 2^-22 tiles.
fn plane_tiles(plane: u32, tiles: vec3<u32>) -> vec2<u32> {
    let wall = vec2<u32>(select(tiles.x, tiles.z, plane == 1u), 0u - tiles.y);
    return select(wall, tiles.xz, plane == 0u);
}

// Index of a zone's texel at a position in 2^-22 tiles.
fn texel_index(map_zone: MapZone, tiles: vec2<u32>) -> u32 {
    let edge_log2 = map_zone.edge_log2;
    let mask = vec2<u32>((1u << edge_log2) - 1u);
    let at = ((tiles * u32(map_zone.zone.repeats)) >> vec2<u32>(TILE_BITS - edge_log2)) & mask;
    return map_zone.first + (at.y << edge_log2) + at.x;
}
