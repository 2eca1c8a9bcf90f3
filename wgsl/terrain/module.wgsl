// Terrain: zones of ground and their textures for materials (`zone_blend`, `triplanar_weights`, `color_variation`), normals,
// light, and exact integer arithmetic of heights. `build.rs` joins this file and its imports into one text, for shaders that
// are not composed with WESL. Prepend that text to your own code.
import package::wgsl::terrain::zones::{Zone, ZoneBlend, steepness, zone_blend, zone_blended, zone_color, zone_of_heights, zone_prominence, zone_weight};
import package::wgsl::terrain::texturing::{TILES_PERIOD, TRIPLANAR_PLANES, color_variation, triplanar_uv, triplanar_weight, triplanar_weights, varied};
import package::wgsl::terrain::tiles::{MapZone, TILE_BITS, plane_tiles, texel_index, tiles_up};
import package::wgsl::terrain::slope::slope_normal;
import package::wgsl::terrain::light::{Light, lit};
import package::wgsl::terrain::offset::{OFFSET_GAUSSIAN, OFFSET_POSITIVE, OFFSET_SIGNED, height_offset};
import package::wgsl::terrain::fixed::{HEIGHT_LIMIT, HEIGHT_ONE, mean_of_four};
import package::wgsl::hash::{Words, threefry2x32};
