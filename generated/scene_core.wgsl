fn lambert(albedo: vec3<f32>, ambient: f32, direct: f32) -> vec3<f32> {
    return albedo * (ambient + (1.0 - ambient) * direct);
}

const CELL_SIZE: f32 = 256.0;

const INSTANCE_ALIVE = 1u;

const INSTANCE_CASTS = 2u;

const INSTANCE_CARRIES = 4u;

const INSTANCE_FOLLOWS = 8u;

const INSTANCE_WHOLE = 16u;

struct SceneInstance {
    cell: vec3<i32>,
    flags: u32,
    offset: vec3<f32>,
    user_data: u32,
    rotation: vec4<f32>,
    scale: vec3<f32>,
    tint: u32,
    bounding_sphere: vec4<f32>
}

struct Axes {
    x: vec3<f32>,
    y: vec3<f32>,
    z: vec3<f32>
}

fn instance_axes(instance: SceneInstance) -> Axes {
    let q = instance.rotation;
    let s = instance.scale;
    let x = vec3<f32>(1.0 - 2.0 * (q.y * q.y + q.z * q.z), 2.0 * (q.x * q.y + q.w * q.z), 2.0 * (q.x * q.z - q.w * q.y));
    let y = vec3<f32>(2.0 * (q.x * q.y - q.w * q.z), 1.0 - 2.0 * (q.x * q.x + q.z * q.z), 2.0 * (q.y * q.z + q.w * q.x));
    let z = vec3<f32>(2.0 * (q.x * q.z + q.w * q.y), 2.0 * (q.y * q.z - q.w * q.x), 1.0 - 2.0 * (q.x * q.x + q.y * q.y));
    return Axes(s.x * x, s.y * y, s.z * z);
}

fn instance_position(instance: SceneInstance, cell: vec3<i32>) -> vec3<f32> {
    return vec3<f32>(instance.cell - cell) * CELL_SIZE + instance.offset;
}

fn instance_flags_word(bits: u32, mask: u32) -> u32 {
    return bits | (mask << 16u);
}

fn instance_flags_bits(word: u32) -> u32 {
    return word & 65535u;
}

fn instance_flags_mask(word: u32) -> u32 {
    return word >> 16u;
}

const OBJECT_LEVELS = 8u;

const OBJECT_LISTS = 32u;

const BLOCK = 64u;

const NO_OBJECT = 4294967295u;

const MORPH_STEPS = 511u;

const FADE_STEPS = 127u;

const FADE_PROGRESS = 65535u;

const RANKS = 8u;

const NO_RANK = 8u;

const UNSEEN_METRIC = 4294967295u;

struct LodObject {
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

fn solid_list(level: u32, mirrored: u32) -> u32 {
    return 2u * level + mirrored;
}

fn fading_list(object: LodObject, level: u32, mirrored: u32) -> u32 {
    return 2u * (object.levels + level) + mirrored;
}

struct SceneDraw {
    index_count: u32,
    instance_count: u32,
    first_index: u32,
    base_vertex: u32,
    first_instance: u32
}

fn object_flags_word(shown: u32, never_culled: u32, timed: u32, transition: u32, criterion: u32) -> u32 {
    return shown | (never_culled << 1u) | (timed << 2u) | (transition << 3u) | (criterion << 7u);
}

fn object_flags_shown(word: u32) -> u32 {
    return word & 1u;
}

fn object_flags_never_culled(word: u32) -> u32 {
    return (word >> 1u) & 1u;
}

fn object_flags_timed(word: u32) -> u32 {
    return (word >> 2u) & 1u;
}

fn object_flags_transition(word: u32) -> u32 {
    return (word >> 3u) & 15u;
}

fn object_flags_criterion(word: u32) -> u32 {
    return (word >> 7u) & 15u;
}

fn metric_word(bits: u32, mirrored: u32) -> u32 {
    return bits | (mirrored << 31u);
}

fn metric_bits(word: u32) -> u32 {
    return word & 2147483647u;
}

fn metric_mirrored(word: u32) -> u32 {
    return word >> 31u;
}

fn decision_word(seen: u32, mirrored: u32, level: u32, next: u32, steps: u32) -> u32 {
    return seen | (mirrored << 1u) | (level << 2u) | (next << 5u) | (steps << 8u);
}

fn decision_seen(word: u32) -> u32 {
    return word & 1u;
}

fn decision_mirrored(word: u32) -> u32 {
    return (word >> 1u) & 1u;
}

fn decision_level(word: u32) -> u32 {
    return (word >> 2u) & 7u;
}

fn decision_next(word: u32) -> u32 {
    return (word >> 5u) & 7u;
}

fn decision_steps(word: u32) -> u32 {
    return (word >> 8u) & 65535u;
}

fn list_entry_word(instance: u32, level: u32, steps: u32) -> u32 {
    return instance | (level << 20u) | (steps << 23u);
}

fn list_entry_instance(word: u32) -> u32 {
    return word & 1048575u;
}

fn list_entry_level(word: u32) -> u32 {
    return (word >> 20u) & 7u;
}

fn list_entry_steps(word: u32) -> u32 {
    return word >> 23u;
}

fn fade_word(weight: u32, rest: u32) -> u32 {
    return weight | (rest << 7u);
}

fn fade_weight(word: u32) -> u32 {
    return word & 127u;
}

fn fade_rest(word: u32) -> u32 {
    return (word >> 7u) & 1u;
}

struct ColorTargets {
    @location(0)
    color: vec4<f32>
}

struct TransparentTargets {
    @location(0)
    color: vec4<f32>
}

fn lit(given: Surface) -> vec4<f32> {
    var surface = given;
    if SHADOWED {
        surface.sunlit *= scene_sunlit(surface.light_position, surface.geometric_normal);
    }
    return mix(shade(surface, scene_seen_by()), vec4<f32>(surface.unlit.rgb, 1.0), surface.unlit.w);
}

fn color_write(given: Surface) -> ColorTargets {
    var surface = given;
    surface.alpha = surface.fade;
    return ColorTargets(lit(surface));
}

fn transparent_write(given: Surface) -> TransparentTargets {
    var surface = given;
    surface.alpha *= surface.fade;
    return TransparentTargets(lit(surface));
}

override OWN_DEPTH: bool = false;

override REVERSED: bool = false;

fn depth_behind(depth: f32, polygon: f32, slope: f32) -> f32 {
    if REVERSED {
        let deepest = select(min(depth, polygon - slope), depth, OWN_DEPTH);
        return max(deepest * 0.9999990463256836, 0.0);
    }
    let deepest = select(max(depth, polygon + slope), depth, OWN_DEPTH);
    return min(deepest * 1.0000009536743164, 1.0);
}

struct LevelsTargets {
    @location(0)
    color: vec4<f32>
}

const LEVEL_COLORS: array<vec3<f32>, 8> = array<vec3<f32>, 8>(vec3<f32>(0.76, 0.05, 0.05), vec3<f32>(0.85, 0.27, 0.02), vec3<f32>(0.8, 0.62, 0.03), vec3<f32>(0.22, 0.58, 0.06), vec3<f32>(0.03, 0.48, 0.4), vec3<f32>(0.04, 0.27, 0.7), vec3<f32>(0.17, 0.09, 0.62), vec3<f32>(0.5, 0.08, 0.55));

fn levels_write(surface: Surface) -> LevelsTargets {
    let facing = 0.35 + 0.65 * max(dot(surface.normal, view.light.xyz), 0.0);
    return LevelsTargets(vec4<f32>(facing * LEVEL_COLORS[surface.level], 1.0));
}

struct MeasureTargets {
    @location(0)
    position: vec4<f32>,
    @location(1)
    id: vec2<u32>
}

fn measure_write(surface: Surface) -> MeasureTargets {
    return MeasureTargets(vec4<f32>(surface.position, 1.0), vec2<u32>(surface.object, surface.instance));
}

struct SurfaceTargets {
    @location(0)
    normal: vec4<f32>,
    @location(1)
    albedo: vec4<f32>,
    @location(2)
    id: vec2<u32>
}

fn surface_write(surface: Surface) -> SurfaceTargets {
    return SurfaceTargets(vec4<f32>(surface.normal, 1.0), vec4<f32>(surface.color, 1.0), vec2<u32>(surface.object, surface.instance));
}

struct VelocityTargets {
    @location(0)
    velocity: vec4<f32>
}

fn velocity_write(surface: Surface) -> VelocityTargets {
    let now = view.clip_from_world * vec4<f32>(surface.position, 1.0);
    let last = view.last_clip_from_world * vec4<f32>(surface.last_position, 1.0);
    if last.w <= 0.0 {
        return VelocityTargets(vec4<f32>(0.0, 0.0, 0.0, 1.0));
    }
    let moved = now.xy / now.w - last.xy / last.w;
    return VelocityTargets(vec4<f32>(0.5 * moved.x, -0.5 * moved.y, 0.0, 1.0));
}

override FADE: u32 = 0u;

const FADE_NONE = 0u;

const FADE_DITHER = 1u;

const FADE_BLEND = 2u;

const FADE_HEAVIER = 3u;

const FADE_PUSHED = 4u;

fn scene_clip(entry: u32, position: vec3<f32>) -> vec4<f32> {
    let clip = view.clip_from_world * vec4<f32>(position, 1.0);
    if FADE == FADE_HEAVIER && 2u * fade_weight(list_entry_steps(entry)) <= FADE_STEPS {
        return vec4<f32>(2.0, 2.0, 2.0, 1.0);
    }
    return clip;
}

fn entry_word(entry: u32, is_counter_clockwise: bool) -> u32 {
    let fade = select(0u, list_entry_steps(entry) & 255u, FADE == FADE_DITHER || FADE == FADE_BLEND);
    return scene_word_word(list_entry_instance(entry), fade, list_entry_level(entry), u32(is_counter_clockwise));
}

fn faded_alpha(word: u32) -> f32 {
    return select(1.0, f32(fade_weight(scene_word_fade(word))) / f32(FADE_STEPS), FADE == FADE_BLEND);
}

fn is_left_out(word: u32, pixel: vec2<f32>) -> bool {
    let fade = scene_word_fade(word);
    let is_covered = 2u * pattern_rank(vec2<u32>(pixel) + view.dither_offset) < fade_weight(fade);
    return FADE == FADE_DITHER && is_covered == (fade_rest(fade) != 0u);
}

fn pattern_rank(pixel: vec2<u32>) -> u32 {
    let x = pixel.x ^ pixel.y;
    var rank = 0u;
    for (var bit = 0u; bit < 3u; bit++) {
        rank = (rank << 2u) | (((x >> bit) & 1u) << 1u) | ((pixel.y >> bit) & 1u);
    }
    return rank;
}

fn scene_word_word(instance: u32, fade: u32, level: u32, counter_clockwise: u32) -> u32 {
    return instance | (fade << 20u) | (level << 28u) | (counter_clockwise << 31u);
}

fn scene_word_instance(word: u32) -> u32 {
    return word & 1048575u;
}

fn scene_word_fade(word: u32) -> u32 {
    return (word >> 20u) & 255u;
}

fn scene_word_level(word: u32) -> u32 {
    return (word >> 28u) & 7u;
}

fn scene_word_counter_clockwise(word: u32) -> u32 {
    return word >> 31u;
}

@group(0) @binding(1)
var<storage, read> placements: array<array<vec4<f32>, 3>>;

@group(0) @binding(2)
var<storage, read> instances: array<SceneInstance>;

@group(0) @binding(3)
var<storage, read> last_instances: array<SceneInstance>;

struct SceneObject {
    first_instance: u32,
    number: u32,
    first_slot: u32,
    push: array<vec4<f32>, 2>
}

@group(1) @binding(0)
var<uniform> scene_object: SceneObject;

const LEAST_DETERMINANT: f32 = 1e-30;

fn entry_instance(entry: u32) -> u32 {
    return list_entry_instance(entry);
}

fn instance_index(entry: u32) -> u32 {
    return scene_object.first_instance + entry_instance(entry);
}

fn instance_placement(index: u32) -> Rows {
    return Rows(placements[index][0], placements[index][1], placements[index][2]);
}

fn last_placement(index: u32) -> Rows {
    let instance = last_instances[index];
    if (instance.flags & INSTANCE_FOLLOWS) != 0u {
        let follows = (instances[index].flags & INSTANCE_FOLLOWS) != 0u;
        return instance_placement(index + select(0u, arrayLength(&last_instances), follows));
    }
    let axes = instance_axes(instance);
    let at = instance_position(instance, view.cell);
    return Rows(vec4<f32>(axes.x.x, axes.y.x, axes.z.x, at.x), vec4<f32>(axes.x.y, axes.y.y, axes.z.y, at.y), vec4<f32>(axes.x.z, axes.y.z, axes.z.z, at.z));
}

fn rows_to_last(index: u32) -> Rows {
    let now = instance_placement(index);
    let last = last_placement(index);
    let a = cross(now.y.xyz, now.z.xyz);
    let b = cross(now.z.xyz, now.x.xyz);
    let c = cross(now.x.xyz, now.y.xyz);
    let determinant = dot(now.x.xyz, a);
    let moved = vec3<f32>(last.x.w, last.y.w, last.z.w);
    let at = vec3<f32>(now.x.w, now.y.w, now.z.w);
    var x = vec3<f32>(1.0, 0.0, 0.0);
    var y = vec3<f32>(0.0, 1.0, 0.0);
    var z = vec3<f32>(0.0, 0.0, 1.0);
    if abs(determinant) > LEAST_DETERMINANT {
        x = vec3<f32>(dot(last.x.xyz, a), dot(last.x.xyz, b), dot(last.x.xyz, c)) / determinant;
        y = vec3<f32>(dot(last.y.xyz, a), dot(last.y.xyz, b), dot(last.y.xyz, c)) / determinant;
        z = vec3<f32>(dot(last.z.xyz, a), dot(last.z.xyz, b), dot(last.z.xyz, c)) / determinant;
    }
    return Rows(vec4<f32>(x, moved.x - dot(x, at)), vec4<f32>(y, moved.y - dot(y, at)), vec4<f32>(z, moved.z - dot(z, at)));
}

fn scene_last_placed(entry: u32, position: vec3<f32>) -> vec3<f32> {
    return placed_position(last_placement(instance_index(entry)), position);
}

fn scene_last_rigid(entry: u32, position: vec3<f32>) -> vec3<f32> {
    return placed_position(rows_to_last(instance_index(entry)), position);
}

fn pushed_position(entry: u32, placement: Rows, position: vec3<f32>) -> vec3<f32> {
    if FADE != FADE_PUSHED {
        return position;
    }
    let level = list_entry_level(entry);
    let scale = sqrt(max(max(dot(placement.x.xyz, placement.x.xyz), dot(placement.y.xyz, placement.y.xyz)), dot(placement.z.xyz, placement.z.xyz)));
    let away = normalize(position * view.eye.w - view.eye.xyz);
    return position + scene_object.push[level >> 2u][level & 3u] * scale * away;
}

fn scene_placed(entry: u32, position: vec3<f32>, normal: vec3<f32>, tangent: vec4<f32>, uv: vec4<f32>) -> SceneVertex {
    let placement = instance_placement(instance_index(entry));
    let along = vec3<f32>(dot(placement.x.xyz, tangent.xyz), dot(placement.y.xyz, tangent.xyz), dot(placement.z.xyz, tangent.xyz));
    let determinant = dot(placement.x.xyz, cross(placement.y.xyz, placement.z.xyz));
    let side = select(1.0, -1.0, determinant < 0.0);
    return SceneVertex(pushed_position(entry, placement, placed_position(placement, position)), side * placed_normal(placement, normal), vec4<f32>(along, side * tangent.w), uv, vec4<f32>(0.0), vec3<u32>(0u), side);
}

fn scene_surface(in: SceneFragment) -> Surface {
    var surface = triangle_surface(in);
    let side = select(-1.0, 1.0, in.is_outside);
    surface.normal *= side;
    surface.geometric_normal *= side;
    let index = scene_object.first_instance + in.instance;
    surface.tint = unpack4x8unorm(instances[index].tint);
    surface.user_data = instances[index].user_data;
    surface.object = scene_object.number;
    surface.instance = scene_object.first_slot + in.instance;
    return surface;
}

struct SceneVertex {
    position: vec3<f32>,
    normal: vec3<f32>,
    tangent: vec4<f32>,
    uv: vec4<f32>,
    values: vec4<f32>,
    words: vec3<u32>,
    side: f32
}

struct SceneFragment {
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

fn scene_words(placed: SceneVertex, entry: u32) -> vec4<u32> {
    return vec4<u32>(placed.words, entry_word(entry, view.side * placed.side > 0.0));
}

fn words_instance(words: vec4<u32>) -> u32 {
    return scene_word_instance(words.w);
}

fn words_level(words: vec4<u32>) -> u32 {
    return scene_word_level(words.w);
}

fn words_fade(words: vec4<u32>) -> f32 {
    return faded_alpha(words.w);
}

fn words_outside(words: vec4<u32>, is_front: bool) -> bool {
    return is_front == (scene_word_counter_clockwise(words.w) != 0u);
}

fn triangle_surface(in: SceneFragment) -> Surface {
    var surface: Surface;
    surface.position = in.position;
    surface.normal = normalize(in.normal);
    surface.geometric_normal = surface.normal;
    surface.uv = in.uv.xy;
    surface.color = vec3<f32>(1.0);
    surface.alpha = 1.0;
    surface.sunlit = 1.0;
    surface.tint = vec4<f32>(1.0);
    surface.pixel = in.clip.xy;
    surface.light_position = in.position;
    surface.last_position = in.last_position;
    surface.depth = in.clip.z;
    surface.level = in.level;
    surface.fade = in.fade;
    return surface;
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

fn shade(surface: Surface, view: View) -> vec4<f32> {
    let direct = max(dot(surface.normal, view.light), 0.0) * surface.sunlit;
    return vec4<f32>(lambert(surface.color * view.light_color, view.ambient, direct), surface.alpha);
}

override SHADOWED: bool = false;

@group(0) @binding(4)
var shadow_map: texture_depth_2d;

@group(0) @binding(5)
var shadow_sampler: sampler_comparison;

const SHADOW_REACH: f32 = 2.828427;

const SHADOW_LEAN: f32 = 0.2;

const SHADOW_ROUNDING: f32 = 2e-6;

const SHADOW_FADE: f32 = 0.05;

fn scene_sunlit(position: vec3<f32>, normal: vec3<f32>) -> f32 {
    let cosine = clamp(dot(normal, view.light.xyz), -1.0, 1.0);
    let sine = sqrt(1.0 - cosine * cosine);
    let offset = SHADOW_REACH * min(sine + SHADOW_LEAN, 1.0) * view.shadow_texel;
    let place = vec4<f32>(position + offset * normal, 1.0);
    let uv = vec2<f32>(dot(view.shadow_rows[0], place), dot(view.shadow_rows[1], place));
    let depth = dot(view.shadow_rows[2], place) - SHADOW_ROUNDING;
    let edge = max(abs(2.0 * uv.x - 1.0), abs(2.0 * uv.y - 1.0));
    let fade = clamp((1.0 - edge) / SHADOW_FADE, 0.0, 1.0);
    return 1.0 - fade * (1.0 - shadow_filtered(uv, clamp(depth, 0.0, 1.0)));
}

fn shadow_filtered(uv: vec2<f32>, depth: f32) -> f32 {
    let size = vec2<f32>(textureDimensions(shadow_map));
    let place = uv * size;
    let base = floor(place + 0.5);
    let s = place + 0.5 - base;
    let low = 3.0 - 2.0 * s;
    let high = 1.0 + 2.0 * s;
    let a = (base - 0.5 + (2.0 - s) / low - 1.0) / size;
    let b = (base - 0.5 + s / high + 1.0) / size;
    let near = low.x * textureSampleCompareLevel(shadow_map, shadow_sampler, a, depth) + high.x * textureSampleCompareLevel(shadow_map, shadow_sampler, vec2<f32>(b.x, a.y), depth);
    let far = low.x * textureSampleCompareLevel(shadow_map, shadow_sampler, vec2<f32>(a.x, b.y), depth) + high.x * textureSampleCompareLevel(shadow_map, shadow_sampler, b, depth);
    return (low.y * near + high.y * far) / 16.0;
}

struct SceneView {
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
var<uniform> view: SceneView;

fn scene_seen_by() -> View {
    return View(view.clip_from_world, view.eye, view.cell, view.light.w, view.light.xyz, view.light_color);
}

struct Rows {
    x: vec4<f32>,
    y: vec4<f32>,
    z: vec4<f32>
}

const LEAST_LENGTH: f32 = 1e-30;

fn unit_or(vector: vec3<f32>, other: vec3<f32>) -> vec3<f32> {
    let size = max(max(abs(vector.x), abs(vector.y)), abs(vector.z));
    let scaled = vector / max(size, LEAST_LENGTH);
    return select(scaled * inverseSqrt(max(dot(scaled, scaled), 0.5)), other, size < LEAST_LENGTH);
}

fn rows_of_dual(real: vec4<f32>, dual: vec4<f32>, diagonal: vec4<f32>, above: vec4<f32>) -> Rows {
    let twice = 2.0 * (1.0 / dot(real, real));
    let t = twice * (real.w * dual.xyz - dual.w * real.xyz + cross(real.xyz, dual.xyz));
    let q = real;
    let u = diagonal;
    let x = vec3<f32>(1.0 - twice * (q.y * q.y + q.z * q.z), twice * (q.x * q.y - q.w * q.z), twice * (q.x * q.z + q.w * q.y));
    let y = vec3<f32>(twice * (q.x * q.y + q.w * q.z), 1.0 - twice * (q.x * q.x + q.z * q.z), twice * (q.y * q.z - q.w * q.x));
    let z = vec3<f32>(twice * (q.x * q.z - q.w * q.y), twice * (q.y * q.z + q.w * q.x), 1.0 - twice * (q.x * q.x + q.y * q.y));
    return Rows(vec4<f32>(x.x * u.x, x.x * above.x + x.y * u.y, x.x * above.y + x.y * above.z + x.z * u.z, t.x), vec4<f32>(y.x * u.x, y.x * above.x + y.y * u.y, y.x * above.y + y.y * above.z + y.z * u.z, t.y), vec4<f32>(z.x * u.x, z.x * above.x + z.y * u.y, z.x * above.y + z.y * above.z + z.z * u.z, t.z));
}

fn placed_position(rows: Rows, position: vec3<f32>) -> vec3<f32> {
    let point = vec4<f32>(position, 1.0);
    return vec3<f32>(dot(rows.x, point), dot(rows.y, point), dot(rows.z, point));
}

fn placed_normal(rows: Rows, normal: vec3<f32>) -> vec3<f32> {
    let x = rows.x.xyz;
    let y = rows.y.xyz;
    let z = rows.z.xyz;
    return vec3<f32>(dot(cross(y, z), normal), dot(cross(z, x), normal), dot(cross(x, y), normal));
}
