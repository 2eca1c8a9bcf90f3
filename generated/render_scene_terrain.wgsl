// relievo render/scene_terrain: generated from wgsl/render/scene_terrain.wgsl

fn relievo_lambert(albedo: vec3<f32>, ambient: f32, direct: f32) -> vec3<f32> {
    return albedo * (ambient + (1.0 - ambient) * direct);
}

const relievo_ALLOWED_MARGIN: f32 = 0.9999;

const relievo_MAX_ALLOWED: f32 = 1000000000.0;

const relievo_LEAST_SCALE: f32 = 1e-9;

struct relievo_Allowed {
    displacement: f32,
    distance: f32
}

const relievo_UNSEEN_ALLOWED: f32 = -1.0;

fn relievo_camera_allows(camera: relievo_LodCamera, center: vec3<f32>, radius: f32) -> f32 {
    if camera.perspective == 0.0 {
        return relievo_ALLOWED_MARGIN * (camera.pixels / camera.focal);
    }
    let towards = center - camera.eye;
    let ahead = dot(camera.ahead, towards);
    let aside = length(towards - ahead * camera.ahead);
    let around = radius + relievo_POSITION_SLACK * (length(center) + length(camera.eye) + radius);
    let is_behind = ahead + around < 0.0;
    let relievo_depth = select(ahead, length(towards), is_behind) - around;
    let across = select(aside + around, 0.0, is_behind);
    if relievo_depth <= camera.near {
        return 0.0;
    }
    let cosine = relievo_depth / sqrt(relievo_depth * relievo_depth + across * across);
    let allowed = relievo_ALLOWED_MARGIN * (camera.pixels * cosine * relievo_depth / (camera.focal + camera.pixels * cosine));
    return select(allowed, 0.0, relievo_depth - allowed <= camera.near);
}

fn relievo_allowed_in_model(allowed: f32, scale: f32) -> f32 {
    return min(allowed / max(scale, relievo_LEAST_SCALE), relievo_MAX_ALLOWED);
}

const relievo_OBJECT_LEVELS = 8u;

const relievo_OBJECT_LISTS = 32u;

const relievo_BLOCK = 64u;

const relievo_NO_OBJECT = 4294967295u;

const relievo_MORPH_STEPS = 511u;

const relievo_FADE_STEPS = 127u;

const relievo_FADE_PROGRESS = 65535u;

const relievo_RANKS = 8u;

const relievo_NO_RANK = 8u;

const relievo_UNSEEN_METRIC = 4294967295u;

struct relievo_LodObject {
    first: u32,
    instances: u32,
    levels: u32,
    first_list: u32,
    first_draw: u32,
    parts: u32,
    metric_scale: f32,
    flags: u32,
    thresholds: array<vec4<f32>, 2>,
    finer: f32,
    coarser: f32,
    rate: f32,
    motion: f32,
    point: vec3<f32>,
    periphery: f32,
    half_size: vec3<f32>,
    rank: u32,
    fade_begin: f32,
    fade_end: f32,
    metric_floor: f32,
    unused: u32,
    triangles: array<vec4<u32>, 2>
}

fn relievo_solid_list(level: u32, mirrored: u32) -> u32 {
    return 2u * level + mirrored;
}

fn relievo_fading_list(object: relievo_LodObject, level: u32, mirrored: u32) -> u32 {
    return 2u * (object.levels + level) + mirrored;
}

struct relievo_SceneDraw {
    index_count: u32,
    instance_count: u32,
    first_index: u32,
    base_vertex: u32,
    first_instance: u32
}

fn relievo_object_flags_word(shown: u32, never_culled: u32, timed: u32, transition: u32, criterion: u32) -> u32 {
    return shown | (never_culled << 1u) | (timed << 2u) | (transition << 3u) | (criterion << 7u);
}

fn relievo_object_flags_shown(word: u32) -> u32 {
    return word & 1u;
}

fn relievo_object_flags_never_culled(word: u32) -> u32 {
    return (word >> 1u) & 1u;
}

fn relievo_object_flags_timed(word: u32) -> u32 {
    return (word >> 2u) & 1u;
}

fn relievo_object_flags_transition(word: u32) -> u32 {
    return (word >> 3u) & 15u;
}

fn relievo_object_flags_criterion(word: u32) -> u32 {
    return (word >> 7u) & 15u;
}

fn relievo_metric_word(bits: u32, mirrored: u32) -> u32 {
    return bits | (mirrored << 31u);
}

fn relievo_metric_bits(word: u32) -> u32 {
    return word & 2147483647u;
}

fn relievo_metric_mirrored(word: u32) -> u32 {
    return word >> 31u;
}

fn relievo_decision_word(seen: u32, mirrored: u32, level: u32, next: u32, steps: u32) -> u32 {
    return seen | (mirrored << 1u) | (level << 2u) | (next << 5u) | (steps << 8u);
}

fn relievo_decision_seen(word: u32) -> u32 {
    return word & 1u;
}

fn relievo_decision_mirrored(word: u32) -> u32 {
    return (word >> 1u) & 1u;
}

fn relievo_decision_level(word: u32) -> u32 {
    return (word >> 2u) & 7u;
}

fn relievo_decision_next(word: u32) -> u32 {
    return (word >> 5u) & 7u;
}

fn relievo_decision_steps(word: u32) -> u32 {
    return (word >> 8u) & 65535u;
}

fn relievo_list_entry_word(instance: u32, level: u32, steps: u32) -> u32 {
    return instance | (level << 20u) | (steps << 23u);
}

fn relievo_list_entry_instance(word: u32) -> u32 {
    return word & 1048575u;
}

fn relievo_list_entry_level(word: u32) -> u32 {
    return (word >> 20u) & 7u;
}

fn relievo_list_entry_steps(word: u32) -> u32 {
    return word >> 23u;
}

fn relievo_fade_word(weight: u32, rest: u32) -> u32 {
    return weight | (rest << 7u);
}

fn relievo_fade_weight(word: u32) -> u32 {
    return word & 127u;
}

fn relievo_fade_rest(word: u32) -> u32 {
    return (word >> 7u) & 1u;
}

const relievo_VIEW_CAMERAS = 4u;

struct relievo_LodCamera {
    eye: vec3<f32>,
    focal: f32,
    ahead: vec3<f32>,
    pixels: f32,
    near: f32,
    perspective: f32,
    pixel_count: f32,
    unused: f32
}

struct relievo_SelectView {
    planes: array<vec4<f32>, 6>,
    cameras: array<relievo_LodCamera, 4>,
    cell: vec3<i32>,
    mask: u32,
    camera_count: u32,
    is_first: u32,
    casters: u32,
    blocks: u32,
    is_next: u32,
    seconds: f32,
    unused_a: u32,
    unused_b: u32,
    clip_rows: array<vec4<f32>, 3>,
    last_clip_rows: array<vec4<f32>, 3>
}

const relievo_POSITION_SLACK: f32 = 3e-6;

struct relievo_ColorTargets {
    @location(0)
    color: vec4<f32>
}

struct relievo_TransparentTargets {
    @location(0)
    color: vec4<f32>
}

fn relievo_lit(given: Surface) -> vec4<f32> {
    var relievo_surface = given;
    if relievo_SHADOWED {
        relievo_surface.sunlit *= relievo_scene_sunlit(relievo_surface.light_position, relievo_surface.geometric_normal);
    }
    return mix(shade(relievo_surface, relievo_scene_seen_by()), vec4<f32>(relievo_surface.unlit.rgb, 1.0), relievo_surface.unlit.w);
}

fn relievo_color_write(given: Surface) -> relievo_ColorTargets {
    var relievo_surface = given;
    relievo_surface.alpha = relievo_surface.fade;
    return relievo_ColorTargets(relievo_lit(relievo_surface));
}

fn relievo_transparent_write(given: Surface) -> relievo_TransparentTargets {
    var relievo_surface = given;
    relievo_surface.alpha *= relievo_surface.fade;
    return relievo_TransparentTargets(relievo_lit(relievo_surface));
}

struct relievo_LevelsTargets {
    @location(0)
    color: vec4<f32>
}

const relievo_LEVEL_COLORS: array<vec3<f32>, 8> = array<vec3<f32>, 8>(vec3<f32>(0.76, 0.05, 0.05), vec3<f32>(0.85, 0.27, 0.02), vec3<f32>(0.8, 0.62, 0.03), vec3<f32>(0.22, 0.58, 0.06), vec3<f32>(0.03, 0.48, 0.4), vec3<f32>(0.04, 0.27, 0.7), vec3<f32>(0.17, 0.09, 0.62), vec3<f32>(0.5, 0.08, 0.55));

fn relievo_levels_write(relievo_surface: Surface) -> relievo_LevelsTargets {
    let facing = 0.35 + 0.65 * max(dot(relievo_surface.normal, relievo_view.light.xyz), 0.0);
    return relievo_LevelsTargets(vec4<f32>(facing * relievo_LEVEL_COLORS[relievo_surface.level], 1.0));
}

struct relievo_MeasureTargets {
    @location(0)
    position: vec4<f32>,
    @location(1)
    id: vec2<u32>
}

fn relievo_measure_write(relievo_surface: Surface) -> relievo_MeasureTargets {
    return relievo_MeasureTargets(vec4<f32>(relievo_surface.position, 1.0), vec2<u32>(relievo_surface.object, relievo_surface.instance));
}

struct relievo_SurfaceTargets {
    @location(0)
    normal: vec4<f32>,
    @location(1)
    albedo: vec4<f32>,
    @location(2)
    id: vec2<u32>
}

fn relievo_surface_write(relievo_surface: Surface) -> relievo_SurfaceTargets {
    return relievo_SurfaceTargets(vec4<f32>(relievo_surface.normal, 1.0), vec4<f32>(relievo_surface.color, 1.0), vec2<u32>(relievo_surface.object, relievo_surface.instance));
}

struct relievo_VelocityTargets {
    @location(0)
    velocity: vec4<f32>
}

fn relievo_velocity_write(relievo_surface: Surface) -> relievo_VelocityTargets {
    let now = relievo_view.clip_from_world * vec4<f32>(relievo_surface.position, 1.0);
    let last = relievo_view.last_clip_from_world * vec4<f32>(relievo_surface.last_position, 1.0);
    if last.w <= 0.0 {
        return relievo_VelocityTargets(vec4<f32>(0.0, 0.0, 0.0, 1.0));
    }
    let moved = now.xy / now.w - last.xy / last.w;
    return relievo_VelocityTargets(vec4<f32>(0.5 * moved.x, -0.5 * moved.y, 0.0, 1.0));
}

override relievo_FADE: u32 = 0u;

const relievo_FADE_NONE = 0u;

const relievo_FADE_DITHER = 1u;

const relievo_FADE_BLEND = 2u;

const relievo_FADE_HEAVIER = 3u;

const relievo_FADE_PUSHED = 4u;

fn relievo_scene_clip(entry: u32, position: vec3<f32>) -> vec4<f32> {
    let clip = relievo_view.clip_from_world * vec4<f32>(position, 1.0);
    if relievo_FADE == relievo_FADE_HEAVIER && 2u * relievo_fade_weight(relievo_list_entry_steps(entry)) <= relievo_FADE_STEPS {
        return vec4<f32>(2.0, 2.0, 2.0, 1.0);
    }
    return clip;
}

fn relievo_entry_word(entry: u32, is_counter_clockwise: bool) -> u32 {
    let fade = select(0u, relievo_list_entry_steps(entry) & 255u, relievo_FADE == relievo_FADE_DITHER || relievo_FADE == relievo_FADE_BLEND);
    return relievo_scene_word_word(relievo_list_entry_instance(entry), fade, relievo_list_entry_level(entry), u32(is_counter_clockwise));
}

fn relievo_faded_alpha(word: u32) -> f32 {
    return select(1.0, f32(relievo_fade_weight(relievo_scene_word_fade(word))) / f32(relievo_FADE_STEPS), relievo_FADE == relievo_FADE_BLEND);
}

fn relievo_is_left_out(word: u32, pixel: vec2<f32>) -> bool {
    let fade = relievo_scene_word_fade(word);
    let is_covered = 2u * relievo_pattern_rank(vec2<u32>(pixel) + relievo_view.dither_offset) < relievo_fade_weight(fade);
    return relievo_FADE == relievo_FADE_DITHER && is_covered == (relievo_fade_rest(fade) != 0u);
}

fn relievo_pattern_rank(pixel: vec2<u32>) -> u32 {
    let x = pixel.x ^ pixel.y;
    var rank = 0u;
    for (var bit = 0u; bit < 3u; bit++) {
        rank = (rank << 2u) | (((x >> bit) & 1u) << 1u) | ((pixel.y >> bit) & 1u);
    }
    return rank;
}

fn relievo_scene_word_word(instance: u32, fade: u32, level: u32, counter_clockwise: u32) -> u32 {
    return instance | (fade << 20u) | (level << 28u) | (counter_clockwise << 31u);
}

fn relievo_scene_word_instance(word: u32) -> u32 {
    return word & 1048575u;
}

fn relievo_scene_word_fade(word: u32) -> u32 {
    return (word >> 20u) & 255u;
}

fn relievo_scene_word_level(word: u32) -> u32 {
    return (word >> 28u) & 7u;
}

fn relievo_scene_word_counter_clockwise(word: u32) -> u32 {
    return word >> 31u;
}

struct relievo_SceneVertex {
    position: vec3<f32>,
    normal: vec3<f32>,
    tangent: vec4<f32>,
    uv: vec4<f32>,
    values: vec4<f32>,
    words: vec3<u32>,
    side: f32
}

struct relievo_SceneFragment {
    position: vec3<f32>,
    normal: vec3<f32>,
    tangent: vec4<f32>,
    uv: vec4<f32>,
    values: vec4<f32>,
    words: vec3<u32>,
    instance: u32,
    last_position: vec3<f32>,
    clip: vec4<f32>,
    is_outside: bool,
    level: u32,
    fade: f32
}

fn relievo_scene_words(placed: relievo_SceneVertex, entry: u32) -> vec4<u32> {
    return vec4<u32>(placed.words, relievo_entry_word(entry, relievo_view.side * placed.side > 0.0));
}

fn relievo_words_instance(words: vec4<u32>) -> u32 {
    return relievo_scene_word_instance(words.w);
}

fn relievo_words_level(words: vec4<u32>) -> u32 {
    return relievo_scene_word_level(words.w);
}

fn relievo_words_fade(words: vec4<u32>) -> f32 {
    return relievo_faded_alpha(words.w);
}

fn relievo_words_outside(words: vec4<u32>, is_front: bool) -> bool {
    return is_front == (relievo_scene_word_counter_clockwise(words.w) != 0u);
}

fn relievo_triangle_surface(in: relievo_SceneFragment) -> Surface {
    var relievo_surface: Surface;
    relievo_surface.position = in.position;
    relievo_surface.normal = normalize(in.normal);
    relievo_surface.geometric_normal = relievo_surface.normal;
    relievo_surface.uv = in.uv.xy;
    relievo_surface.color = vec3<f32>(1.0);
    relievo_surface.alpha = 1.0;
    relievo_surface.sunlit = 1.0;
    relievo_surface.tint = vec4<f32>(1.0);
    relievo_surface.pixel = in.clip.xy;
    relievo_surface.light_position = in.position;
    relievo_surface.last_position = in.last_position;
    relievo_surface.depth = in.clip.z;
    relievo_surface.level = in.level;
    relievo_surface.fade = in.fade;
    return relievo_surface;
}

struct Surface {
    position: vec3<f32>,
    normal: vec3<f32>,
    geometric_normal: vec3<f32>,
    uv: vec2<f32>,
    color: vec3<f32>,
    alpha: f32,
    sunlit: f32,
    tint: vec4<f32>,
    user_data: u32,
    object: u32,
    instance: u32,
    pixel: vec2<f32>,
    unlit: vec4<f32>,
    light_position: vec3<f32>,
    last_position: vec3<f32>,
    cutoff: f32,
    depth: f32,
    level: u32,
    fade: f32
}

struct View {
    clip_from_world: mat4x4<f32>,
    eye: vec4<f32>,
    cell: vec3<i32>,
    ambient: f32,
    light: vec3<f32>,
    light_color: vec3<f32>
}

override relievo_SHADOWED: bool = false;

@group(0) @binding(4)
var relievo_shadow_map: texture_depth_2d;

@group(0) @binding(5)
var relievo_shadow_sampler: sampler_comparison;

const relievo_SHADOW_REACH: f32 = 2.828427;

const relievo_SHADOW_LEAN: f32 = 0.2;

const relievo_SHADOW_ROUNDING: f32 = 2e-6;

const relievo_SHADOW_FADE: f32 = 0.05;

fn relievo_scene_sunlit(position: vec3<f32>, normal: vec3<f32>) -> f32 {
    let cosine = clamp(dot(normal, relievo_view.light.xyz), -1.0, 1.0);
    let sine = sqrt(1.0 - cosine * cosine);
    let offset = relievo_SHADOW_REACH * min(sine + relievo_SHADOW_LEAN, 1.0) * relievo_view.shadow_texel;
    let place = vec4<f32>(position + offset * normal, 1.0);
    let uv = vec2<f32>(dot(relievo_view.shadow_rows[0], place), dot(relievo_view.shadow_rows[1], place));
    let relievo_depth = dot(relievo_view.shadow_rows[2], place) - relievo_SHADOW_ROUNDING;
    let edge = max(abs(2.0 * uv.x - 1.0), abs(2.0 * uv.y - 1.0));
    let fade = clamp((1.0 - edge) / relievo_SHADOW_FADE, 0.0, 1.0);
    return 1.0 - fade * (1.0 - relievo_shadow_filtered(uv, clamp(relievo_depth, 0.0, 1.0)));
}

fn relievo_shadow_filtered(uv: vec2<f32>, relievo_depth: f32) -> f32 {
    let size = vec2<f32>(textureDimensions(relievo_shadow_map));
    let place = uv * size;
    let base = floor(place + 0.5);
    let s = place + 0.5 - base;
    let low = 3.0 - 2.0 * s;
    let high = 1.0 + 2.0 * s;
    let a = (base - 0.5 + (2.0 - s) / low - 1.0) / size;
    let b = (base - 0.5 + s / high + 1.0) / size;
    let near = low.x * textureSampleCompareLevel(relievo_shadow_map, relievo_shadow_sampler, a, relievo_depth) + high.x * textureSampleCompareLevel(relievo_shadow_map, relievo_shadow_sampler, vec2<f32>(b.x, a.y), relievo_depth);
    let far = low.x * textureSampleCompareLevel(relievo_shadow_map, relievo_shadow_sampler, vec2<f32>(a.x, b.y), relievo_depth) + high.x * textureSampleCompareLevel(relievo_shadow_map, relievo_shadow_sampler, b, relievo_depth);
    return (low.y * near + high.y * far) / 16.0;
}

override relievo_WIREFRAME: bool = false;

const relievo_LINE_COLOR: vec3<f32> = vec3<f32>(0.35, 0.75, 0.5);

const relievo_DARK_COLOR: vec3<f32> = vec3<f32>(0.01, 0.014, 0.02);

struct relievo_TerrainFrame {
    cameras: array<relievo_LodCamera, 4>,
    camera_count: u32,
    fraction: f32
}

struct relievo_TerrainView {
    base: vec2<i32>,
    rest: vec3<f32>,
    object: u32,
    frames: array<relievo_TerrainFrame, 2>
}

const relievo_THIS_FRAME = 0u;

const relievo_LAST_FRAME = 1u;

struct relievo_TerrainNode {
    borders: vec4<f32>,
    inner: f32,
    plain: u32,
    unused_b: f32,
    unused_c: f32
}

const relievo_STITCHED: f32 = -1.0;

const relievo_MORPH_START: f32 = 0.6;

struct relievo_TerrainParams {
    in_width: u32,
    size: u32,
    spacing: f32,
    run: f32,
    tiling: f32,
    tiles_per_unit: f32,
    zone_count: u32,
    additive: u32,
    planes: u32,
    variation: f32,
    first_patch: u32,
    normals_width: u32,
    relief_depth: f32,
    relief_distance: f32,
    erosion_depth: f32,
    unused: f32
}

struct relievo_TerrainPatch {
    origin: vec2<i32>,
    uv: vec2<f32>,
    window: u32,
    level: u32,
    holes: u32,
    eroded: u32
}

@group(1) @binding(0)
var<uniform> relievo_ground: relievo_TerrainView;

@group(1) @binding(1)
var<storage, read> relievo_nodes: array<relievo_TerrainNode>;

@group(2) @binding(0)
var<uniform> relievo_terrain: relievo_TerrainParams;

@group(2) @binding(1)
var<storage, read> relievo_heights: array<i32>;

@group(2) @binding(2)
var<storage, read> relievo_patches: array<relievo_TerrainPatch>;

@group(2) @binding(3)
var<storage, read> relievo_zones: array<relievo_Zone>;

@group(2) @binding(4)
var relievo_textures: texture_2d_array<f32>;

@group(2) @binding(5)
var relievo_texture_sampler: sampler;

@group(2) @binding(6)
var<storage, read> relievo_holes: array<u32>;

@group(2) @binding(7)
var<storage, read> relievo_normals: array<u32>;

fn relievo_gradient_of(center: u32, reach: u32) -> vec2<f32> {
    let difference = vec2<f32>(vec2<i32>(relievo_heights[center + reach] - relievo_heights[center - reach], relievo_heights[center + reach * relievo_terrain.in_width] - relievo_heights[center - reach * relievo_terrain.in_width]));
    return difference / f32(reach);
}

struct relievo_Erosion {
    offset: u32,
    weight: f32
}

fn relievo_height_at(at: u32, erosion: relievo_Erosion) -> f32 {
    let height = f32(relievo_heights[at]) / 65536.0;
    if erosion.weight > 0.0 {
        return mix(height, f32(relievo_heights[at + erosion.offset]) / 65536.0, erosion.weight);
    }
    return height;
}

fn relievo_gradient_at(center: u32, reach: u32, erosion: relievo_Erosion) -> vec2<f32> {
    let gradient = relievo_gradient_of(center, reach);
    if erosion.weight > 0.0 {
        return mix(gradient, relievo_gradient_of(center + erosion.offset, reach), erosion.weight);
    }
    return gradient;
}

fn relievo_coarser_half(at: vec2<u32>) -> vec2<i32> {
    let odd = vec2<i32>(at & vec2<u32>(1u));
    return vec2<i32>(odd.x, select(odd.y, -odd.y, odd.x != 0));
}

fn relievo_limit_of(node: relievo_TerrainNode, at: vec2<u32>) -> f32 {
    let last = relievo_terrain.size - 1u;
    var limit = node.inner;
    limit = select(limit, node.borders.w, at.y == last);
    limit = select(limit, node.borders.z, at.y == 0u);
    limit = select(limit, node.borders.y, at.x == last);
    return select(limit, node.borders.x, at.x == 0u);
}

fn relievo_stitched(node: relievo_TerrainNode, at: vec2<u32>) -> vec2<u32> {
    let last = relievo_terrain.size - 1u;
    let odd = at & vec2<u32>(1u);
    let is_before = (at == vec2<u32>(0u)) & (node.borders.xz == vec2<f32>(relievo_STITCHED));
    let is_after = (at == vec2<u32>(last)) & (node.borders.yw == vec2<f32>(relievo_STITCHED));
    let back = vec2<u32>(select(0u, odd.x, is_before.y), select(0u, odd.y, is_before.x));
    let on = vec2<u32>(select(0u, odd.x, is_after.y), select(0u, odd.y, is_after.x));
    return at - back + on;
}

fn relievo_allowed_at(position: vec3<f32>, frame: u32) -> f32 {
    var allowed = relievo_MAX_ALLOWED;
    for (var index = 0u; index < min(relievo_ground.frames[frame].camera_count, 4u); index++) {
        allowed = min(allowed, relievo_camera_allows(relievo_ground.frames[frame].cameras[index], position, relievo_terrain.erosion_depth));
    }
    return relievo_ground.frames[frame].fraction * allowed;
}

fn relievo_erosion_weight(node: relievo_TerrainNode, at: vec2<u32>, allowed: f32) -> f32 {
    let first = at == vec2<u32>(0u);
    let last = at == vec2<u32>(relievo_terrain.size - 1u);
    let sides = vec4<bool>(first.x, last.x, first.y, last.y);
    let corners = vec4<bool>(first.x && first.y, last.x && first.y, first.x && last.y, last.x && last.y);
    let bits = vec4<u32>(1u, 2u, 4u, 8u);
    let touched = select(vec4<u32>(0u), bits, sides) | select(vec4<u32>(0u), bits << vec4<u32>(4u), corners);
    let meets = (touched.x | touched.y | touched.z | touched.w) & node.plain;
    let weight = clamp(2.0 - allowed / relievo_terrain.erosion_depth, 0.0, 1.0);
    return select(weight, 0.0, meets != 0u);
}

fn relievo_morphed(limit: f32, allowed: f32) -> f32 {
    if limit == relievo_STITCHED {
        return 1.0;
    }
    return clamp((allowed / max(limit, 1e-30) - relievo_MORPH_START) / (1.0 - relievo_MORPH_START), 0.0, 1.0);
}

fn relievo_hole_at(patch_of: relievo_TerrainPatch, at: vec2<u32>) -> f32 {
    let bit = at.y * relievo_terrain.size + at.x;
    let word = relievo_holes[select(0u, patch_of.holes - 1u + bit / 32u, patch_of.holes != 0u)];
    return select(0.0, f32((word >> (bit % 32u)) & 1u), patch_of.holes != 0u);
}

struct relievo_GroundVertex {
    at: vec2<u32>,
    coarse: f32,
    position: vec3<f32>,
    height: f32,
    gradient: vec2<f32>
}

fn relievo_ground_vertex(instance: u32, relievo_vertex: u32, frame: u32) -> relievo_GroundVertex {
    let patch_of = relievo_patches[instance];
    let is_node = relievo_ground.frames[frame].camera_count != 0u;
    let node = relievo_nodes[select(0u, instance, is_node)];
    let corner = vec2<u32>(relievo_vertex % relievo_terrain.size, relievo_vertex / relievo_terrain.size);
    let at = select(corner, relievo_stitched(node, corner), is_node);
    let margin = (relievo_terrain.in_width - relievo_terrain.size) / 2u;
    let row = patch_of.window * relievo_terrain.in_width + at.y + margin;
    let center = row * relievo_terrain.in_width + at.x + margin;
    let sample_index = vec2<f32>(patch_of.origin + (vec2<i32>(at) << vec2<u32>(patch_of.level)) - relievo_ground.base);
    let sample = relievo_ground.rest + vec3<f32>(sample_index.x * relievo_terrain.spacing, 0.0, sample_index.y * relievo_terrain.spacing);
    var height = f32(relievo_heights[center]) / 65536.0;
    var gradient = relievo_gradient_of(center, 1u);
    var coarse = 0.0;
    if is_node {
        let allowed = relievo_allowed_at(sample + vec3<f32>(0.0, height, 0.0), frame);
        var erosion = relievo_Erosion(0u, 0.0);
        if patch_of.eroded != patch_of.window {
            let windows = patch_of.eroded - patch_of.window;
            erosion = relievo_Erosion(windows * relievo_terrain.in_width * relievo_terrain.in_width, relievo_erosion_weight(node, at, allowed));
            height = relievo_height_at(center, erosion);
            gradient = relievo_gradient_at(center, 1u, erosion);
        }
        let factor = relievo_morphed(relievo_limit_of(node, at), allowed);
        coarse = select(factor, max(factor, 1.0 - erosion.weight), patch_of.eroded != patch_of.window);
        let half = relievo_coarser_half(at);
        let one = u32(i32(center) + half.y * i32(relievo_terrain.in_width) + half.x);
        let other = u32(i32(center) - half.y * i32(relievo_terrain.in_width) - half.x);
        let coarser = 0.5 * (relievo_height_at(one, erosion) + relievo_height_at(other, erosion));
        height = mix(height, coarser, factor);
        if relievo_terrain.normals_width == 0u {
            gradient = mix(gradient, 0.5 * (relievo_gradient_at(one, 2u, erosion) + relievo_gradient_at(other, 2u, erosion)), factor);
        }
    }
    return relievo_GroundVertex(at, coarse, sample + vec3<f32>(0.0, height, 0.0), height, gradient);
}

fn relievo_terrain_place(instance: u32, relievo_vertex: u32) -> relievo_SceneVertex {
    let patch_of = relievo_patches[instance];
    let placed = relievo_ground_vertex(instance, relievo_vertex, relievo_THIS_FRAME);
    var values = vec4<f32>(vec2<f32>(placed.at), placed.coarse, placed.height);
    if relievo_WIREFRAME {
        values = vec4<f32>(0.0, 0.0, 0.0, placed.height);
        values[(relievo_vertex % relievo_terrain.size + 2u * (relievo_vertex / relievo_terrain.size)) % 3u] = 1.0;
    }
    let steps = f32(1u << patch_of.level);
    return relievo_SceneVertex(placed.position, relievo_gradient_normal(placed.gradient, steps * relievo_terrain.run), vec4<f32>(1.0, 0.0, 0.0, 1.0), vec4<f32>(patch_of.uv + steps * vec2<f32>(placed.at) * relievo_terrain.tiling, relievo_hole_at(patch_of, placed.at), 0.0), values, vec3<u32>(patch_of.window, patch_of.level, 0u), 1.0);
}

fn relievo_terrain_last_position(instance: u32, relievo_vertex: u32) -> vec3<f32> {
    return relievo_ground_vertex(instance, relievo_vertex, relievo_LAST_FRAME).position;
}

fn relievo_node_normal(window: u32, at: vec2<f32>) -> vec3<f32> {
    let width = relievo_terrain.normals_width;
    let place = clamp(2.0 * at, vec2<f32>(0.0), vec2<f32>(f32(width - 1u)));
    let cell = min(vec2<u32>(place), vec2<u32>(width - 2u));
    let part = place - vec2<f32>(cell);
    let first = (window * width + cell.y) * width + cell.x;
    let north = mix(unpack2x16snorm(relievo_normals[first]), unpack2x16snorm(relievo_normals[first + 1u]), part.x);
    let south = mix(unpack2x16snorm(relievo_normals[first + width]), unpack2x16snorm(relievo_normals[first + width + 1u]), part.x);
    let along = mix(north, south, part.y);
    return vec3<f32>(along.x, sqrt(max(1.0 - dot(along, along), 0.0)), along.y);
}

const relievo_RELIEF_STEPS: f32 = 16.0;

const relievo_RELIEF_MORE_STEPS: f32 = 48.0;

const relievo_RELIEF_BISECTIONS: u32 = 4u;

const relievo_RELIEF_COSINE: f32 = 0.15;

struct relievo_Relief {
    zone: u32,
    plane: u32,
    depth: f32,
    level: f32
}

fn relievo_ground_relief(height: f32, steep: f32, weights: vec3<f32>, distance: f32, tiles_dx: vec3<f32>, tiles_dy: vec3<f32>) -> relievo_Relief {
    var relief = relievo_Relief(0u, 0u, 0.0, 0.0);
    var most = 0.0;
    var sum = 0.0;
    for (var z = 0u; z < relievo_terrain.zone_count; z++) {
        let weight = relievo_zone_weight(relievo_zones[z], height, steep);
        relief.zone = select(relief.zone, z, weight > most);
        most = max(most, weight);
        sum += weight;
    }
    relief.plane = select(select(2u, 1u, weights.y > weights.z), 0u, weights.x >= max(weights.y, weights.z));
    let facing = relievo_triplanar_weight(weights, relief.plane);
    let prevails = max(2.0 * most / max(sum, 1e-6) - 1.0, 0.0) * max(2.0 * facing - 1.0, 0.0);
    let near = 1.0 - smoothstep(0.5 * relievo_terrain.relief_distance, relievo_terrain.relief_distance, distance);
    relief.depth = relievo_terrain.relief_depth * prevails * near;
    let footprint = max(length(relievo_triplanar_uv(relief.plane, tiles_dx)), length(relievo_triplanar_uv(relief.plane, tiles_dy)));
    relief.level = log2(max(footprint * relievo_zones[relief.zone].repeats * f32(textureDimensions(relievo_textures).x), 1.0));
    return relief;
}

fn relievo_relief_height(relief: relievo_Relief, tiles: vec3<f32>) -> f32 {
    let at = relievo_zones[relief.zone].repeats * relievo_triplanar_uv(relief.plane, tiles);
    return textureSampleLevel(relievo_textures, relievo_texture_sampler, at, relief.zone, relief.level).w;
}

fn relievo_relief_hit(relief: relievo_Relief, tiles: vec3<f32>, way: vec3<f32>, cosine: f32) -> vec3<f32> {
    let step = 1.0 / (relievo_RELIEF_STEPS + floor((1.0 - cosine) * relievo_RELIEF_MORE_STEPS));
    var outside = 0.0;
    var inside = 0.0;
    var above = 1.0 - relievo_relief_height(relief, tiles);
    while (above > 0.0 && inside < 1.0) {
        outside = inside;
        inside = min(inside + step, 1.0);
        above = 1.0 - inside - relievo_relief_height(relief, tiles + inside * way);
    }
    for (var i = 0u; i < relievo_RELIEF_BISECTIONS; i++) {
        let middle = 0.5 * (outside + inside);
        let is_inside = 1.0 - middle <= relievo_relief_height(relief, tiles + middle * way);
        outside = select(middle, outside, is_inside);
        inside = select(inside, middle, is_inside);
    }
    return way * inside;
}

fn relievo_relief_normal(relief: relievo_Relief, tiles: vec3<f32>, normal: vec3<f32>) -> vec3<f32> {
    let reach = exp2(relief.level) / (relievo_zones[relief.zone].repeats * f32(textureDimensions(relievo_textures).x));
    let east = select(vec3<f32>(1.0, 0.0, 0.0), vec3<f32>(0.0, 0.0, 1.0), relief.plane == 1u);
    let south = select(vec3<f32>(0.0, 1.0, 0.0), vec3<f32>(0.0, 0.0, 1.0), relief.plane == 0u);
    let rise = vec2<f32>(relievo_relief_height(relief, tiles + reach * east) - relievo_relief_height(relief, tiles - reach * east), relievo_relief_height(relief, tiles + reach * south) - relievo_relief_height(relief, tiles - reach * south));
    let gradient = (rise.x * east + rise.y * south) * (relief.depth * relievo_terrain.tiles_per_unit / (2.0 * reach));
    return normalize(normal - (gradient - dot(gradient, normal) * normal));
}

struct relievo_Ground {
    color: vec3<f32>,
    normal: vec3<f32>
}

fn relievo_ground_at(uv: vec2<f32>, height: f32, normal: vec3<f32>, ray: vec3<f32>) -> relievo_Ground {
    let relievo_surface = vec3<f32>(uv.x, height * relievo_terrain.tiles_per_unit, uv.y);
    let tiles_dx = dpdx(relievo_surface);
    let tiles_dy = dpdy(relievo_surface);
    let weights = select(vec3<f32>(1.0, 0.0, 0.0), relievo_triplanar_weights(normal), relievo_terrain.planes == relievo_TRIPLANAR_PLANES);
    let steep = relievo_steepness(normal);
    var tiles = relievo_surface;
    var relieved = normal;
    let distance = length(ray);
    if relievo_terrain.relief_depth > 0.0 && distance > 0.0 {
        let relief = relievo_ground_relief(height, steep, weights, distance, tiles_dx, tiles_dy);
        if relief.depth > 0.0 {
            let direction = ray / distance;
            let cosine = max(-dot(direction, normal), relievo_RELIEF_COSINE);
            let way = direction * (relief.depth * relievo_terrain.tiles_per_unit / cosine);
            tiles += relievo_relief_hit(relief, relievo_surface, way, cosine);
            relieved = relievo_relief_normal(relief, tiles, normal);
        }
    }
    var blend = relievo_zone_blend();
    for (var z = 0u; z < relievo_terrain.zone_count; z++) {
        let zone = relievo_zones[z];
        var texel = vec4<f32>(0.0);
        for (var plane = 0u; plane < relievo_terrain.planes; plane++) {
            let at = zone.repeats * relievo_triplanar_uv(plane, tiles);
            let dx = zone.repeats * relievo_triplanar_uv(plane, tiles_dx);
            let dy = zone.repeats * relievo_triplanar_uv(plane, tiles_dy);
            texel += relievo_triplanar_weight(weights, plane) * textureSampleGrad(relievo_textures, relievo_texture_sampler, at, z, dx, dy);
        }
        blend = relievo_zone_blended(blend, zone, height, steep, texel);
    }
    var relievo_color = relievo_zone_color(blend, relievo_terrain.additive != 0u);
    if relievo_terrain.variation != 0.0 {
        relievo_color = relievo_varied(relievo_color, relievo_color_variation(uv), relievo_terrain.variation);
    }
    return relievo_Ground(relievo_color, relieved);
}

fn relievo_terrain_surface(in: relievo_SceneFragment) -> Surface {
    var relievo_surface = relievo_triangle_surface(in);
    if relievo_WIREFRAME {
        let edge = in.values.xyz / max(fwidth(in.values.xyz), vec3<f32>(1e-6));
        let near = clamp(1.2 - min(edge.x, min(edge.y, edge.z)), 0.0, 1.0);
        relievo_surface.color = relievo_LINE_COLOR;
        relievo_surface.unlit = vec4<f32>(relievo_DARK_COLOR, 1.0 - near);
    }
    else {
        if relievo_terrain.normals_width != 0u && in.words.y != 0u {
            relievo_surface.normal = normalize(mix(relievo_node_normal(in.words.x, in.values.xy), relievo_surface.normal, in.values.z));
        }
        let ray = select(vec3<f32>(0.0), relievo_surface.position - relievo_view.eye.xyz, relievo_view.eye.w == 1.0);
        let ground_here = relievo_ground_at(in.uv.xy, in.values.w, relievo_surface.normal, ray);
        relievo_surface.color = ground_here.color;
        relievo_surface.normal = ground_here.normal;
    }
    relievo_surface.alpha = select(1.0, 0.0, in.uv.z > 0.0001);
    relievo_surface.cutoff = 0.5;
    relievo_surface.object = relievo_ground.object;
    relievo_surface.level = min(in.words.y, 7u);
    relievo_surface.instance = relievo_terrain.first_patch + in.instance;
    return relievo_surface;
}

struct relievo_SceneView {
    clip_from_world: mat4x4<f32>,
    last_clip_from_world: mat4x4<f32>,
    eye: vec4<f32>,
    light: vec4<f32>,
    light_color: vec3<f32>,
    side: f32,
    cell: vec3<i32>,
    shadow_texel: f32,
    shadow_rows: array<vec4<f32>, 3>,
    dither_offset: vec2<u32>
}

@group(0) @binding(0)
var<uniform> relievo_view: relievo_SceneView;

fn relievo_scene_seen_by() -> View {
    return View(relievo_view.clip_from_world, relievo_view.eye, relievo_view.cell, relievo_view.light.w, relievo_view.light.xyz, relievo_view.light_color);
}

fn relievo_slope_normal(gradient: vec2<i32>, run: f32) -> vec3<f32> {
    return relievo_gradient_normal(vec2<f32>(gradient), run);
}

fn relievo_gradient_normal(gradient: vec2<f32>, run: f32) -> vec3<f32> {
    let along = vec3<f32>(-gradient.x, run, -gradient.y);
    return along * inverseSqrt(dot(along, along));
}

const relievo_TILES_PERIOD: u32 = 1024u;

const relievo_TRIPLANAR_PLANES: u32 = 3u;

fn relievo_triplanar_weights(normal: vec3<f32>) -> vec3<f32> {
    let facing = max(abs(normal.yxz) - 0.3, vec3<f32>(0.0));
    let squared = facing * facing;
    return squared / (squared.x + squared.y + squared.z);
}

fn relievo_triplanar_uv(plane: u32, tiles: vec3<f32>) -> vec2<f32> {
    let wall = vec2<f32>(select(tiles.x, tiles.z, plane == 1u), -tiles.y);
    return select(wall, tiles.xz, plane == 0u);
}

fn relievo_triplanar_weight(weights: vec3<f32>, plane: u32) -> f32 {
    return select(select(weights.z, weights.y, plane == 1u), weights.x, plane == 0u);
}

fn relievo_cell_words(x: vec4<u32>, y: vec4<u32>) -> vec4<u32> {
    var words = x * 2654435761u + y * 2246822519u;
    words = (words ^ (words >> vec4<u32>(16u))) * 2146121005u;
    words = (words ^ (words >> vec4<u32>(15u))) * 2221713035u;
    return words ^ (words >> vec4<u32>(16u));
}

fn relievo_cell_mean(corners: vec4<f32>, at: vec2<f32>) -> f32 {
    let rows = corners.xy + (corners.zw - corners.xy) * at.y;
    return rows.x + (rows.y - rows.x) * at.x;
}

fn relievo_color_variation(tiles: vec2<f32>) -> vec2<f32> {
    var sum = vec2<f32>(0.0);
    var scale = 0.5;
    for (var octave = 0u; octave < 3u; octave++) {
        let cells = tiles * scale;
        let cell = floor(cells);
        let inside = cells - cell;
        let at = inside * inside * (3.0 - 2.0 * inside);
        let mask = ((relievo_TILES_PERIOD / 2u) >> (2u * octave)) - 1u;
        let corner = vec2<u32>(vec2<i32>(cell));
        let x = vec4<u32>(corner.x, corner.x + 1u, corner.x, corner.x + 1u) & vec4<u32>(mask);
        let y = vec4<u32>(corner.y, corner.y, corner.y + 1u, corner.y + 1u) & vec4<u32>(mask);
        let words = relievo_cell_words(x + vec4<u32>(octave * 4096u), y);
        let brightness = relievo_cell_mean(vec4<f32>(words >> vec4<u32>(16u)), at);
        let warmth = relievo_cell_mean(vec4<f32>(words & vec4<u32>(65535u)), at);
        sum += vec2<f32>(brightness, warmth);
        scale *= 0.25;
    }
    return sum * (2.0 / 196605.0) - 1.0;
}

fn relievo_varied(relievo_color: vec3<f32>, variation: vec2<f32>, strength: f32) -> vec3<f32> {
    let tint = vec3<f32>(0.2, 0.05, -0.25) * variation.y;
    return relievo_color * (vec3<f32>(1.0) + strength * (vec3<f32>(0.5 * variation.x) + tint));
}

struct relievo_Zone {
    min: f32,
    max: f32,
    rise: vec2<f32>,
    fall: vec2<f32>,
    height_blend: f32,
    repeats: f32
}

struct relievo_ZoneBlend {
    color: vec3<f32>,
    total: f32,
    weight: f32,
    nearest: vec3<f32>,
    distance: f32
}

fn relievo_zone_of_heights(min: f32, max: f32) -> relievo_Zone {
    return relievo_Zone(min, max, vec2<f32>(0.0, 1.0), vec2<f32>(0.0, 1.0), 0.0, 1.0);
}

fn relievo_steepness(normal: vec3<f32>) -> f32 {
    return sqrt(normal.x * normal.x + normal.z * normal.z) / (1.0 + normal.y);
}

fn relievo_zone_weight(zone: relievo_Zone, height: f32, steep: f32) -> f32 {
    let range = zone.max - zone.min;
    let rise = clamp(zone.rise.x * steep + zone.rise.y, 0.0, 1.0);
    let fall = clamp(zone.fall.x * steep + zone.fall.y, 0.0, 1.0);
    return max(0.0, (range - abs(height - zone.max)) * (1.0 / range)) * (rise * fall);
}

fn relievo_zone_prominence(zone: relievo_Zone, texel_height: f32) -> f32 {
    let relievo_depth = 0.9375 * zone.height_blend;
    let reduced = (1.0 - relievo_depth) + relievo_depth * texel_height;
    let squared = reduced * reduced;
    return squared * squared;
}

fn relievo_zone_blend() -> relievo_ZoneBlend {
    return relievo_ZoneBlend(vec3<f32>(0.0), 0.0, 0.0, vec3<f32>(0.0), 3e38);
}

fn relievo_zone_blended(blend: relievo_ZoneBlend, zone: relievo_Zone, height: f32, steep: f32, texel: vec4<f32>) -> relievo_ZoneBlend {
    let distance = abs(height - zone.max) - (zone.max - zone.min);
    let nearer = distance < blend.distance;
    let weight = relievo_zone_weight(zone, height, steep);
    let factor = weight * relievo_zone_prominence(zone, texel.w);
    return relievo_ZoneBlend(blend.color + factor * texel.rgb, blend.total + factor, blend.weight + weight, select(blend.nearest, texel.rgb, nearer), select(blend.distance, distance, nearer));
}

fn relievo_zone_color(blend: relievo_ZoneBlend, additive: bool) -> vec3<f32> {
    let mean = blend.color / max(blend.total, 1.17549435e-38);
    if additive {
        return blend.weight * mean;
    }
    return select(blend.nearest, mean, blend.total > 0.0);
}

struct relievo_Varyings {
    @invariant @builtin(position)
    clip: vec4<f32>,
    @location(0)
    position: vec3<f32>,
    @location(1)
    normal: vec3<f32>,
    @location(2)
    tangent: vec4<f32>,
    @location(3)
    uv: vec4<f32>,
    @location(4)
    values: vec4<f32>,
    @location(5) @interpolate(flat)
    words: vec4<u32>
}

@vertex
fn relievo_vertex(@builtin(vertex_index) relievo_vertex: u32, @location(0) entry: u32) -> relievo_Varyings {
    let placed = relievo_terrain_place(entry, relievo_vertex);
    return relievo_Varyings(relievo_scene_clip(entry, placed.position), placed.position, placed.normal, placed.tangent, placed.uv, placed.values, relievo_scene_words(placed, entry));
}

struct relievo_MovingVaryings {
    @invariant @builtin(position)
    clip: vec4<f32>,
    @location(0)
    position: vec3<f32>,
    @location(1)
    normal: vec3<f32>,
    @location(2)
    tangent: vec4<f32>,
    @location(3)
    uv: vec4<f32>,
    @location(4)
    values: vec4<f32>,
    @location(5) @interpolate(flat)
    words: vec4<u32>,
    @location(6)
    last: vec3<f32>
}

@vertex
fn relievo_vertex_moving(@builtin(vertex_index) relievo_vertex: u32, @location(0) entry: u32) -> relievo_MovingVaryings {
    let placed = relievo_terrain_place(entry, relievo_vertex);
    return relievo_MovingVaryings(relievo_scene_clip(entry, placed.position), placed.position, placed.normal, placed.tangent, placed.uv, placed.values, relievo_scene_words(placed, entry), relievo_terrain_last_position(entry, relievo_vertex));
}

struct relievo_Position {
    @invariant @builtin(position)
    clip: vec4<f32>
}

@vertex
fn relievo_vertex_depth(@builtin(vertex_index) relievo_vertex: u32, @location(0) entry: u32) -> relievo_Position {
    return relievo_Position(relievo_scene_clip(entry, relievo_terrain_place(entry, relievo_vertex).position));
}

@fragment
fn relievo_depth() {

}

@fragment
fn relievo_depth_cut(in: relievo_Varyings, @builtin(front_facing) is_front: bool) {
    let relievo_surface = relievo_terrain_surface(relievo_SceneFragment(in.position, in.normal, in.tangent, in.uv, in.values, in.words.xyz, relievo_words_instance(in.words), in.position, in.clip, relievo_words_outside(in.words, is_front), relievo_words_level(in.words), relievo_words_fade(in.words)));
    if relievo_surface.alpha < relievo_surface.cutoff || relievo_is_left_out(in.words.w, in.clip.xy) {
        discard;
    }
}

@fragment
fn relievo_color(in: relievo_Varyings, @builtin(front_facing) is_front: bool) -> relievo_ColorTargets {
    let relievo_surface = relievo_terrain_surface(relievo_SceneFragment(in.position, in.normal, in.tangent, in.uv, in.values, in.words.xyz, relievo_words_instance(in.words), in.position, in.clip, relievo_words_outside(in.words, is_front), relievo_words_level(in.words), relievo_words_fade(in.words)));
    let targets = relievo_color_write(relievo_surface);
    return targets;
}

@fragment
fn relievo_color_cut(in: relievo_Varyings, @builtin(front_facing) is_front: bool) -> relievo_ColorTargets {
    let relievo_surface = relievo_terrain_surface(relievo_SceneFragment(in.position, in.normal, in.tangent, in.uv, in.values, in.words.xyz, relievo_words_instance(in.words), in.position, in.clip, relievo_words_outside(in.words, is_front), relievo_words_level(in.words), relievo_words_fade(in.words)));
    let targets = relievo_color_write(relievo_surface);
    if relievo_surface.alpha < relievo_surface.cutoff || relievo_is_left_out(in.words.w, in.clip.xy) {
        discard;
    }
    return targets;
}

@fragment
fn relievo_levels(in: relievo_Varyings, @builtin(front_facing) is_front: bool) -> relievo_LevelsTargets {
    let relievo_surface = relievo_terrain_surface(relievo_SceneFragment(in.position, in.normal, in.tangent, in.uv, in.values, in.words.xyz, relievo_words_instance(in.words), in.position, in.clip, relievo_words_outside(in.words, is_front), relievo_words_level(in.words), relievo_words_fade(in.words)));
    let targets = relievo_levels_write(relievo_surface);
    return targets;
}

@fragment
fn relievo_levels_cut(in: relievo_Varyings, @builtin(front_facing) is_front: bool) -> relievo_LevelsTargets {
    let relievo_surface = relievo_terrain_surface(relievo_SceneFragment(in.position, in.normal, in.tangent, in.uv, in.values, in.words.xyz, relievo_words_instance(in.words), in.position, in.clip, relievo_words_outside(in.words, is_front), relievo_words_level(in.words), relievo_words_fade(in.words)));
    let targets = relievo_levels_write(relievo_surface);
    if relievo_surface.alpha < relievo_surface.cutoff || relievo_is_left_out(in.words.w, in.clip.xy) {
        discard;
    }
    return targets;
}

@fragment
fn relievo_measure(in: relievo_Varyings, @builtin(front_facing) is_front: bool) -> relievo_MeasureTargets {
    let relievo_surface = relievo_terrain_surface(relievo_SceneFragment(in.position, in.normal, in.tangent, in.uv, in.values, in.words.xyz, relievo_words_instance(in.words), in.position, in.clip, relievo_words_outside(in.words, is_front), relievo_words_level(in.words), relievo_words_fade(in.words)));
    let targets = relievo_measure_write(relievo_surface);
    return targets;
}

@fragment
fn relievo_measure_cut(in: relievo_Varyings, @builtin(front_facing) is_front: bool) -> relievo_MeasureTargets {
    let relievo_surface = relievo_terrain_surface(relievo_SceneFragment(in.position, in.normal, in.tangent, in.uv, in.values, in.words.xyz, relievo_words_instance(in.words), in.position, in.clip, relievo_words_outside(in.words, is_front), relievo_words_level(in.words), relievo_words_fade(in.words)));
    let targets = relievo_measure_write(relievo_surface);
    if relievo_surface.alpha < relievo_surface.cutoff || relievo_is_left_out(in.words.w, in.clip.xy) {
        discard;
    }
    return targets;
}

@fragment
fn relievo_surface(in: relievo_Varyings, @builtin(front_facing) is_front: bool) -> relievo_SurfaceTargets {
    let relievo_surface = relievo_terrain_surface(relievo_SceneFragment(in.position, in.normal, in.tangent, in.uv, in.values, in.words.xyz, relievo_words_instance(in.words), in.position, in.clip, relievo_words_outside(in.words, is_front), relievo_words_level(in.words), relievo_words_fade(in.words)));
    let targets = relievo_surface_write(relievo_surface);
    return targets;
}

@fragment
fn relievo_surface_cut(in: relievo_Varyings, @builtin(front_facing) is_front: bool) -> relievo_SurfaceTargets {
    let relievo_surface = relievo_terrain_surface(relievo_SceneFragment(in.position, in.normal, in.tangent, in.uv, in.values, in.words.xyz, relievo_words_instance(in.words), in.position, in.clip, relievo_words_outside(in.words, is_front), relievo_words_level(in.words), relievo_words_fade(in.words)));
    let targets = relievo_surface_write(relievo_surface);
    if relievo_surface.alpha < relievo_surface.cutoff || relievo_is_left_out(in.words.w, in.clip.xy) {
        discard;
    }
    return targets;
}

@fragment
fn relievo_velocity(in: relievo_MovingVaryings, @builtin(front_facing) is_front: bool) -> relievo_VelocityTargets {
    let relievo_surface = relievo_terrain_surface(relievo_SceneFragment(in.position, in.normal, in.tangent, in.uv, in.values, in.words.xyz, relievo_words_instance(in.words), in.last, in.clip, relievo_words_outside(in.words, is_front), relievo_words_level(in.words), relievo_words_fade(in.words)));
    let targets = relievo_velocity_write(relievo_surface);
    return targets;
}

@fragment
fn relievo_velocity_cut(in: relievo_MovingVaryings, @builtin(front_facing) is_front: bool) -> relievo_VelocityTargets {
    let relievo_surface = relievo_terrain_surface(relievo_SceneFragment(in.position, in.normal, in.tangent, in.uv, in.values, in.words.xyz, relievo_words_instance(in.words), in.last, in.clip, relievo_words_outside(in.words, is_front), relievo_words_level(in.words), relievo_words_fade(in.words)));
    let targets = relievo_velocity_write(relievo_surface);
    if relievo_surface.alpha < relievo_surface.cutoff || relievo_is_left_out(in.words.w, in.clip.xy) {
        discard;
    }
    return targets;
}


fn shade(relievo_surface: Surface, relievo_view: View) -> vec4<f32> {
    let direct = max(dot(relievo_surface.normal, relievo_view.light), 0.0) * relievo_surface.sunlit;
    return vec4<f32>(relievo_lambert(relievo_surface.color * relievo_view.light_color, relievo_view.ambient, direct), relievo_surface.alpha);
}
