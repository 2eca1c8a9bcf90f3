// relievo render/scene_relief: generated from wgsl/render/scene_relief.wgsl

fn relievo_lambert(relievo_albedo: vec3<f32>, ambient: f32, direct: f32) -> vec3<f32> {
    return relievo_albedo * (ambient + (1.0 - ambient) * direct);
}

const relievo_CELL_SIZE: f32 = 256.0;

const relievo_INSTANCE_ALIVE = 1u;

const relievo_INSTANCE_CASTS = 2u;

const relievo_INSTANCE_CARRIES = 4u;

const relievo_INSTANCE_FOLLOWS = 8u;

const relievo_INSTANCE_WHOLE = 16u;

struct relievo_SceneInstance {
    cell: vec3<i32>,
    flags: u32,
    offset: vec3<f32>,
    user_data: u32,
    rotation: vec4<f32>,
    scale: vec3<f32>,
    tint: u32,
    bounding_sphere: vec4<f32>
}

struct relievo_Axes {
    x: vec3<f32>,
    y: vec3<f32>,
    z: vec3<f32>
}

fn relievo_instance_axes(instance: relievo_SceneInstance) -> relievo_Axes {
    let q = instance.rotation;
    let s = instance.scale;
    let x = vec3<f32>(1.0 - 2.0 * (q.y * q.y + q.z * q.z), 2.0 * (q.x * q.y + q.w * q.z), 2.0 * (q.x * q.z - q.w * q.y));
    let y = vec3<f32>(2.0 * (q.x * q.y - q.w * q.z), 1.0 - 2.0 * (q.x * q.x + q.z * q.z), 2.0 * (q.y * q.z + q.w * q.x));
    let z = vec3<f32>(2.0 * (q.x * q.z + q.w * q.y), 2.0 * (q.y * q.z - q.w * q.x), 1.0 - 2.0 * (q.x * q.x + q.y * q.y));
    return relievo_Axes(s.x * x, s.y * y, s.z * z);
}

fn relievo_instance_position(instance: relievo_SceneInstance, cell: vec3<i32>) -> vec3<f32> {
    return vec3<f32>(instance.cell - cell) * relievo_CELL_SIZE + instance.offset;
}

fn relievo_instance_flags_word(bits: u32, mask: u32) -> u32 {
    return bits | (mask << 16u);
}

fn relievo_instance_flags_bits(word: u32) -> u32 {
    return word & 65535u;
}

fn relievo_instance_flags_mask(word: u32) -> u32 {
    return word >> 16u;
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

override relievo_OWN_DEPTH: bool = false;

override relievo_REVERSED: bool = false;

fn relievo_depth_behind(relievo_depth: f32, polygon: f32, slope: f32) -> f32 {
    if relievo_REVERSED {
        let deepest = select(min(relievo_depth, polygon - slope), relievo_depth, relievo_OWN_DEPTH);
        return max(deepest * 0.9999990463256836, 0.0);
    }
    let deepest = select(max(relievo_depth, polygon + slope), relievo_depth, relievo_OWN_DEPTH);
    return min(deepest * 1.0000009536743164, 1.0);
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

@group(0) @binding(1)
var<storage, read> relievo_placements: array<array<vec4<f32>, 3>>;

@group(0) @binding(2)
var<storage, read> relievo_instances: array<relievo_SceneInstance>;

@group(0) @binding(3)
var<storage, read> relievo_last_instances: array<relievo_SceneInstance>;

struct relievo_SceneObject {
    first_instance: u32,
    number: u32,
    first_slot: u32,
    push: array<vec4<f32>, 2>
}

@group(1) @binding(0)
var<uniform> relievo_scene_object: relievo_SceneObject;

const relievo_LEAST_DETERMINANT: f32 = 1e-30;

fn relievo_entry_instance(entry: u32) -> u32 {
    return relievo_list_entry_instance(entry);
}

fn relievo_instance_index(entry: u32) -> u32 {
    return relievo_scene_object.first_instance + relievo_entry_instance(entry);
}

fn relievo_instance_placement(index: u32) -> relievo_Rows {
    return relievo_Rows(relievo_placements[index][0], relievo_placements[index][1], relievo_placements[index][2]);
}

fn relievo_last_placement(index: u32) -> relievo_Rows {
    let instance = relievo_last_instances[index];
    if (instance.flags & relievo_INSTANCE_FOLLOWS) != 0u {
        let follows = (relievo_instances[index].flags & relievo_INSTANCE_FOLLOWS) != 0u;
        return relievo_instance_placement(index + select(0u, arrayLength(&relievo_last_instances), follows));
    }
    let axes = relievo_instance_axes(instance);
    let at = relievo_instance_position(instance, relievo_view.cell);
    return relievo_Rows(vec4<f32>(axes.x.x, axes.y.x, axes.z.x, at.x), vec4<f32>(axes.x.y, axes.y.y, axes.z.y, at.y), vec4<f32>(axes.x.z, axes.y.z, axes.z.z, at.z));
}

fn relievo_rows_to_last(index: u32) -> relievo_Rows {
    let now = relievo_instance_placement(index);
    let last = relievo_last_placement(index);
    let a = cross(now.y.xyz, now.z.xyz);
    let b = cross(now.z.xyz, now.x.xyz);
    let c = cross(now.x.xyz, now.y.xyz);
    let determinant = dot(now.x.xyz, a);
    let moved = vec3<f32>(last.x.w, last.y.w, last.z.w);
    let at = vec3<f32>(now.x.w, now.y.w, now.z.w);
    var x = vec3<f32>(1.0, 0.0, 0.0);
    var y = vec3<f32>(0.0, 1.0, 0.0);
    var z = vec3<f32>(0.0, 0.0, 1.0);
    if abs(determinant) > relievo_LEAST_DETERMINANT {
        x = vec3<f32>(dot(last.x.xyz, a), dot(last.x.xyz, b), dot(last.x.xyz, c)) / determinant;
        y = vec3<f32>(dot(last.y.xyz, a), dot(last.y.xyz, b), dot(last.y.xyz, c)) / determinant;
        z = vec3<f32>(dot(last.z.xyz, a), dot(last.z.xyz, b), dot(last.z.xyz, c)) / determinant;
    }
    return relievo_Rows(vec4<f32>(x, moved.x - dot(x, at)), vec4<f32>(y, moved.y - dot(y, at)), vec4<f32>(z, moved.z - dot(z, at)));
}

fn relievo_scene_last_placed(entry: u32, position: vec3<f32>) -> vec3<f32> {
    return relievo_placed_position(relievo_last_placement(relievo_instance_index(entry)), position);
}

fn relievo_scene_last_rigid(entry: u32, position: vec3<f32>) -> vec3<f32> {
    return relievo_placed_position(relievo_rows_to_last(relievo_instance_index(entry)), position);
}

fn relievo_pushed_position(entry: u32, placement: relievo_Rows, position: vec3<f32>) -> vec3<f32> {
    if relievo_FADE != relievo_FADE_PUSHED {
        return position;
    }
    let level = relievo_list_entry_level(entry);
    let scale = sqrt(max(max(dot(placement.x.xyz, placement.x.xyz), dot(placement.y.xyz, placement.y.xyz)), dot(placement.z.xyz, placement.z.xyz)));
    let away = normalize(position * relievo_view.eye.w - relievo_view.eye.xyz);
    return position + relievo_scene_object.push[level >> 2u][level & 3u] * scale * away;
}

fn relievo_scene_placed(entry: u32, position: vec3<f32>, normal: vec3<f32>, tangent: vec4<f32>, uv: vec4<f32>) -> relievo_SceneVertex {
    let placement = relievo_instance_placement(relievo_instance_index(entry));
    let along = vec3<f32>(dot(placement.x.xyz, tangent.xyz), dot(placement.y.xyz, tangent.xyz), dot(placement.z.xyz, tangent.xyz));
    let determinant = dot(placement.x.xyz, cross(placement.y.xyz, placement.z.xyz));
    let side = select(1.0, -1.0, determinant < 0.0);
    return relievo_SceneVertex(relievo_pushed_position(entry, placement, relievo_placed_position(placement, position)), side * relievo_placed_normal(placement, normal), vec4<f32>(along, side * tangent.w), uv, vec4<f32>(0.0), vec3<u32>(0u), side);
}

fn relievo_scene_surface(in: relievo_SceneFragment) -> Surface {
    var relievo_surface = relievo_triangle_surface(in);
    let side = select(-1.0, 1.0, in.is_outside);
    relievo_surface.normal *= side;
    relievo_surface.geometric_normal *= side;
    let index = relievo_scene_object.first_instance + in.instance;
    relievo_surface.tint = unpack4x8unorm(relievo_instances[index].tint);
    relievo_surface.user_data = relievo_instances[index].user_data;
    relievo_surface.object = relievo_scene_object.number;
    relievo_surface.instance = relievo_scene_object.first_slot + in.instance;
    return relievo_surface;
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

@group(0) @binding(6)
var<storage, read> relievo_last_decisions: array<u32>;

fn relievo_last_local(instance: u32, relievo_vertex: u32) -> vec3<f32> {
    let at = relievo_vertex_index_of(instance, relievo_vertex);
    let first = select(5u * at, relievo_mesh.last + 2u * at, relievo_mesh.last != 0u);
    return relievo_vertex_position(relievo_vertices[first], relievo_vertices[first + 1u]);
}

struct relievo_LastMorph {
    standing: u32,
    to: relievo_VertexMorph
}

fn relievo_last_morph(entry: u32, relievo_vertex: u32) -> relievo_LastMorph {
    let decision = relievo_last_decisions[relievo_instance_index(entry)];
    if decision == 0u || relievo_mesh.partners == 0u {
        return relievo_LastMorph(relievo_vertex, relievo_vertex_morph(entry, relievo_vertex));
    }
    let level = relievo_decision_level(decision);
    var standing = relievo_vertex;
    var word = relievo_material_of[relievo_mesh.partners + standing];
    for (var step = 0u; step < relievo_OBJECT_LEVELS && relievo_partner_level(word) < level; step++) {
        standing = relievo_partner_index(word);
        word = relievo_material_of[relievo_mesh.partners + standing];
    }
    if relievo_partner_level(word) != level {
        return relievo_LastMorph(standing, relievo_VertexMorph(standing, 0.0));
    }
    return relievo_LastMorph(standing, relievo_VertexMorph(relievo_partner_index(word), relievo_way_of(relievo_decision_steps(decision))));
}

fn relievo_last_position(entry: u32, relievo_vertex: u32) -> vec3<f32> {
    let instance = relievo_entry_instance(entry);
    var position = vec3<f32>(0.0);
    if relievo_MORPHED {
        let last = relievo_last_morph(entry, relievo_vertex);
        position = relievo_morphed(relievo_last_local(instance, last.standing), relievo_last_local(instance, last.to.partner), last.to.way);
    }
    else {
        position = relievo_last_local(instance, relievo_vertex);
    }
    return relievo_scene_last_placed(entry, position);
}

override relievo_METHOD: u32 = 3u;

override relievo_SHADOW: u32 = 0u;

override relievo_NORMAL_MAP: bool = false;

override relievo_GREEN_UP: bool = true;

override relievo_SILHOUETTE: bool = false;

override relievo_CHOOSE_MIP: bool = false;

const relievo_LEAST_COSINE: f32 = 0.05;

struct relievo_ReliefParams {
    range: vec4<f32>,
    color: vec4<f32>,
    scale: f32,
    plane: f32,
    world: f32,
    shadow_steps: u32,
    softness: f32
}

@group(2) @binding(0)
var<uniform> relievo_relief: relievo_ReliefParams;

@group(2) @binding(1)
var<uniform> relievo_march: relievo_SurfaceMarch;

@group(2) @binding(2)
var relievo_heights: texture_2d<f32>;

@group(2) @binding(3)
var relievo_acceleration: texture_2d<f32>;

@group(2) @binding(4)
var relievo_albedo: texture_2d<f32>;

@group(2) @binding(5)
var relievo_normals: texture_2d<f32>;

@group(2) @binding(6)
var relievo_filtering: sampler;

@group(2) @binding(7)
var relievo_normal_filtering: sampler;

fn relievo_relief_place(entry: u32, relievo_vertex: u32) -> relievo_SceneVertex {
    var placed = relievo_placed_vertex(entry, relievo_vertex);
    placed.values.x = relievo_relief.world * length(placed.tangent.xyz);
    return placed;
}

fn relievo_relief_last_position(entry: u32, relievo_vertex: u32) -> vec3<f32> {
    return relievo_last_position(entry, relievo_vertex);
}

struct relievo_Frame {
    tangent: vec3<f32>,
    bitangent: vec3<f32>,
    normal: vec3<f32>
}

struct relievo_Traced {
    hit: relievo_SurfaceHit,
    frame: relievo_Frame,
    settings: relievo_SurfaceMarch,
    position: vec3<f32>,
    depth: f32,
    is_outside: bool
}

fn relievo_traced(in: relievo_SceneFragment, uv_dx: vec2<f32>, uv_dy: vec2<f32>) -> relievo_Traced {
    let normal = normalize(in.normal);
    let tangent = normalize(in.tangent.xyz - normal * dot(normal, in.tangent.xyz));
    let frame = relievo_Frame(tangent, in.tangent.w * cross(normal, tangent), normal);
    let towards = relievo_surface_towards(relievo_view.eye, in.position);
    var settings = relievo_march;
    if relievo_CHOOSE_MIP {
        settings.mip = relievo_surface_mip(relievo_heights, uv_dx, uv_dy);
    }
    let ray = relievo_surface_ray(in.uv.xy, relievo_in_frame(frame, towards), relievo_relief.scale, relievo_relief.plane);
    let hit = relievo_surface_trace(relievo_METHOD, relievo_heights, relievo_acceleration, ray, settings);
    let distance = relievo_surface_distance(ray, hit, relievo_relief.scale) * in.values.x;
    let relievo_depth = relievo_surface_depth(relievo_view.clip_from_world, in.position, towards, distance);
    let is_outside = relievo_SILHOUETTE && !relievo_surface_inside(hit.uv, relievo_relief.range.xy, relievo_relief.range.zw);
    return relievo_Traced(hit, frame, settings, in.position - towards * distance, relievo_depth, is_outside);
}

fn relievo_in_frame(frame: relievo_Frame, direction: vec3<f32>) -> vec3<f32> {
    return vec3<f32>(dot(frame.tangent, direction), dot(frame.bitangent, direction), dot(frame.normal, direction));
}

fn relievo_in_world(frame: relievo_Frame, direction: vec3<f32>) -> vec3<f32> {
    return direction.x * frame.tangent + direction.y * frame.bitangent + direction.z * frame.normal;
}

fn relievo_above(in: relievo_SceneFragment, found: relievo_Traced) -> vec3<f32> {
    let cosine = dot(found.frame.normal, relievo_view.light.xyz);
    let deep = (1.0 - found.hit.height) * relievo_relief.scale * in.values.x;
    return found.position + relievo_view.light.xyz * select(0.0, deep / max(cosine, relievo_LEAST_COSINE), cosine > 0.0);
}

fn relievo_relief_surface(in: relievo_SceneFragment) -> Surface {
    let uv_dx = dpdx(in.uv.xy);
    let uv_dy = dpdy(in.uv.xy);
    let found = relievo_traced(in, uv_dx, uv_dy);
    let hit = found.hit;
    var facing = relievo_surface_normal(relievo_heights, hit.uv, relievo_relief.scale, found.settings);
    if relievo_NORMAL_MAP {
        facing = relievo_surface_mapped_normal(textureSampleGrad(relievo_normals, relievo_normal_filtering, hit.uv, uv_dx, uv_dy), relievo_GREEN_UP);
    }
    var relievo_surface = relievo_scene_surface(in);
    relievo_surface.position = found.position;
    relievo_surface.normal = relievo_in_world(found.frame, facing);
    relievo_surface.geometric_normal = found.frame.normal;
    relievo_surface.uv = hit.uv;
    relievo_surface.color = textureSampleGrad(relievo_albedo, relievo_filtering, hit.uv, uv_dx, uv_dy).rgb * relievo_relief.color.rgb * relievo_surface.tint.rgb;
    relievo_surface.alpha = select(1.0, 0.0, found.is_outside);
    relievo_surface.cutoff = 0.5;
    relievo_surface.sunlit = relievo_surface_sunlit(relievo_METHOD, relievo_SHADOW, relievo_heights, relievo_acceleration, hit, relievo_in_frame(found.frame, relievo_view.light.xyz), relievo_SurfaceShadow(relievo_relief.scale, relievo_relief.shadow_steps, relievo_relief.softness), found.settings);
    relievo_surface.light_position = relievo_above(in, found);
    relievo_surface.last_position = relievo_scene_last_rigid(in.instance, found.position);
    relievo_surface.depth = found.depth;
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

override relievo_MORPHED: bool = false;

struct relievo_MeshParams {
    clusters: u32,
    last: u32,
    partners: u32
}

@group(1) @binding(5)
var<uniform> relievo_mesh: relievo_MeshParams;

@group(1) @binding(1)
var<storage, read> relievo_vertices: array<vec2<f32>>;

@group(1) @binding(4)
var<storage, read> relievo_page_table: array<u32>;

@group(1) @binding(3)
var<storage, read> relievo_material_of: array<u32>;

@group(1) @binding(2)
var<storage, read> relievo_texture_coordinates: array<vec2<f32>>;

fn relievo_vertex_index_of(instance: u32, relievo_vertex: u32) -> u32 {
    if relievo_mesh.clusters == 0u {
        return relievo_vertex;
    }
    return relievo_CLUSTER * relievo_page_table[instance * relievo_mesh.clusters + relievo_vertex / relievo_CLUSTER] + relievo_vertex % relievo_CLUSTER;
}

struct relievo_VertexMorph {
    partner: u32,
    way: f32
}

fn relievo_vertex_morph(entry: u32, relievo_vertex: u32) -> relievo_VertexMorph {
    let word = relievo_material_of[relievo_mesh.partners + relievo_vertex];
    let steps = relievo_list_entry_steps(entry);
    if steps == 0u || relievo_mesh.partners == 0u || relievo_partner_level(word) != relievo_list_entry_level(entry) {
        return relievo_VertexMorph(relievo_vertex, 0.0);
    }
    return relievo_VertexMorph(relievo_partner_index(word), relievo_way_of(steps));
}

fn relievo_way_of(steps: u32) -> f32 {
    return select(f32(steps) / f32(relievo_MORPH_STEPS), 1.0, steps == relievo_MORPH_STEPS);
}

fn relievo_morphed(a: vec3<f32>, b: vec3<f32>, way: f32) -> vec3<f32> {
    return a * (1.0 - way) + b * way;
}

fn relievo_placed_vertex(entry: u32, relievo_vertex: u32) -> relievo_SceneVertex {
    let instance = relievo_entry_instance(entry);
    let at = 5u * relievo_vertex_index_of(instance, relievo_vertex);
    let middle = relievo_vertices[at + 1u];
    var position = relievo_vertex_position(relievo_vertices[at], middle);
    var normal = relievo_vertex_normal(middle, relievo_vertices[at + 2u]);
    var tangent = relievo_vertex_tangent(relievo_vertices[at + 3u], relievo_vertices[at + 4u]);
    var uv = relievo_texture_coordinates[relievo_vertex];
    if relievo_MORPHED {
        let to = relievo_vertex_morph(entry, relievo_vertex);
        let other = 5u * relievo_vertex_index_of(instance, to.partner);
        let other_middle = relievo_vertices[other + 1u];
        let other_tangent = relievo_vertex_tangent(relievo_vertices[other + 3u], relievo_vertices[other + 4u]);
        position = relievo_morphed(position, relievo_vertex_position(relievo_vertices[other], other_middle), to.way);
        normal = relievo_morphed(normal, relievo_vertex_normal(other_middle, relievo_vertices[other + 2u]), to.way);
        tangent = vec4<f32>(relievo_morphed(tangent.xyz, other_tangent.xyz, to.way), select(tangent.w, other_tangent.w, to.way >= 0.5));
        uv = uv * (1.0 - to.way) + relievo_texture_coordinates[to.partner] * to.way;
    }
    return relievo_scene_placed(entry, position, normal, tangent, vec4<f32>(uv, 0.0, 0.0));
}

fn relievo_partner_word(index: u32, level: u32) -> u32 {
    return index | (level << 24u);
}

fn relievo_partner_index(word: u32) -> u32 {
    return word & 16777215u;
}

fn relievo_partner_level(word: u32) -> u32 {
    return word >> 24u;
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

const relievo_CLUSTER: u32 = 64u;

const relievo_CLUSTER_STILL: u32 = 0u;

const relievo_CLUSTER_MOVED: u32 = 1u;

const relievo_CLUSTER_FRESH: u32 = 2u;

struct relievo_Rows {
    x: vec4<f32>,
    y: vec4<f32>,
    z: vec4<f32>
}

const relievo_LEAST_LENGTH: f32 = 1e-30;

fn relievo_unit_or(vector: vec3<f32>, other: vec3<f32>) -> vec3<f32> {
    let size = max(max(abs(vector.x), abs(vector.y)), abs(vector.z));
    let scaled = vector / max(size, relievo_LEAST_LENGTH);
    return select(scaled * inverseSqrt(max(dot(scaled, scaled), 0.5)), other, size < relievo_LEAST_LENGTH);
}

fn relievo_rows_of_dual(real: vec4<f32>, dual: vec4<f32>, diagonal: vec4<f32>, relievo_above: vec4<f32>) -> relievo_Rows {
    let twice = 2.0 * (1.0 / dot(real, real));
    let t = twice * (real.w * dual.xyz - dual.w * real.xyz + cross(real.xyz, dual.xyz));
    let q = real;
    let u = diagonal;
    let x = vec3<f32>(1.0 - twice * (q.y * q.y + q.z * q.z), twice * (q.x * q.y - q.w * q.z), twice * (q.x * q.z + q.w * q.y));
    let y = vec3<f32>(twice * (q.x * q.y + q.w * q.z), 1.0 - twice * (q.x * q.x + q.z * q.z), twice * (q.y * q.z - q.w * q.x));
    let z = vec3<f32>(twice * (q.x * q.z - q.w * q.y), twice * (q.y * q.z + q.w * q.x), 1.0 - twice * (q.x * q.x + q.y * q.y));
    return relievo_Rows(vec4<f32>(x.x * u.x, x.x * relievo_above.x + x.y * u.y, x.x * relievo_above.y + x.y * relievo_above.z + x.z * u.z, t.x), vec4<f32>(y.x * u.x, y.x * relievo_above.x + y.y * u.y, y.x * relievo_above.y + y.y * relievo_above.z + y.z * u.z, t.y), vec4<f32>(z.x * u.x, z.x * relievo_above.x + z.y * u.y, z.x * relievo_above.y + z.y * relievo_above.z + z.z * u.z, t.z));
}

fn relievo_placed_position(rows: relievo_Rows, position: vec3<f32>) -> vec3<f32> {
    let point = vec4<f32>(position, 1.0);
    return vec3<f32>(dot(rows.x, point), dot(rows.y, point), dot(rows.z, point));
}

fn relievo_placed_normal(rows: relievo_Rows, normal: vec3<f32>) -> vec3<f32> {
    let x = rows.x.xyz;
    let y = rows.y.xyz;
    let z = rows.z.xyz;
    return vec3<f32>(dot(cross(y, z), normal), dot(cross(z, x), normal), dot(cross(x, y), normal));
}

fn relievo_vertex_position(first: vec2<f32>, second: vec2<f32>) -> vec3<f32> {
    return vec3<f32>(first, second.x);
}

fn relievo_vertex_normal(second: vec2<f32>, third: vec2<f32>) -> vec3<f32> {
    return vec3<f32>(second.y, third);
}

fn relievo_vertex_tangent(fourth: vec2<f32>, fifth: vec2<f32>) -> vec4<f32> {
    return vec4<f32>(fourth, fifth);
}

fn relievo_surface_levels(cells: vec2<u32>) -> u32 {
    let longest = max(cells.x, cells.y);
    return select(firstLeadingBit(longest - 1u) + 2u, 1u, longest <= 1u);
}

fn relievo_surface_atlas_at(cells: vec2<u32>, level: u32, index: vec2<i32>) -> vec2<i32> {
    if level == 0u {
        return index;
    }
    let relievo_above = cells.y - (cells.y >> (level - 1u)) + level - 1u;
    return index + vec2<i32>(vec2<u32>((cells.x + 3u) & ~3u, relievo_above));
}

fn relievo_surface_corner_index(size: vec2<u32>, address: u32, map: u32, cell: vec2<i32>) -> u32 {
    let texels = vec2<i32>(size);
    let wrapped = select(cell, vec2<i32>(0), cell >= texels);
    let clamped = clamp(cell - 1, vec2<i32>(0), texels - 1);
    let at = vec2<u32>(select(clamped, wrapped, address == relievo_SURFACE_WRAP));
    return (map * size.y + at.y) * size.x + at.x;
}

fn relievo_surface_cone(relievo_heights: texture_2d<f32>, cones: texture_2d<f32>, ray: relievo_SurfaceRay, relievo_march: relievo_SurfaceMarch) -> relievo_SurfaceHit {
    if !(ray.cosine > 0.0) {
        return relievo_surface_missed(ray);
    }
    let grid = relievo_surface_grid(textureDimensions(relievo_heights), ray, relievo_march.address);
    let distance = length(grid.travel);
    let bound = relievo_surface_bound(grid, 0u);
    var cell = vec2<i32>(0);
    var parameter = 0.0;
    var relievo_above = 0.0;
    var samples = 0u;
    var step = 0u;
    while (step < bound) {
        var node: relievo_SurfaceNode;
        var exits: vec2<f32>;
        var leave: f32;
        var is_near = false;
        while (step < bound) {
            step += 1u;
            node = relievo_surface_node(grid, cell, 0u);
            exits = relievo_surface_exits(grid, node);
            leave = clamp(min(exits.x, exits.y), parameter, 1.0);
            let cone = textureLoad(cones, node.index, 0).rg;
            samples += 1u;
            if 1.0 - leave <= cone.r {
                is_near = true;
                break;
            }
            relievo_above = parameter;
            let reach = parameter + cone.g * (1.0 - parameter - cone.r) / (distance + cone.g);
            if reach > leave {
                parameter = min(reach, 1.0);
                cell = vec2<i32>(floor(grid.start + parameter * grid.travel));
            }
            else {
                cell = relievo_surface_beyond(grid, node, exits, leave);
                parameter = leave;
            }
        }
        if !is_near {
            break;
        }
        let corners = relievo_surface_corners(relievo_heights, grid, node.index);
        samples += 4u;
        let found = relievo_surface_patch(grid, corners, relievo_surface_corner(node), parameter, leave);
        if found > parameter || (found == parameter && relievo_above == parameter) {
            return relievo_surface_point(ray, found, samples, relievo_SURFACE_HIT);
        }
        if found >= 0.0 {
            var level = relievo_march;
            level.mip = 0u;
            return relievo_surface_narrowed(relievo_heights, ray, level, relievo_above, parameter, samples);
        }
        relievo_above = parameter;
        if leave >= 1.0 {
            parameter = 1.0;
            break;
        }
        cell = relievo_surface_beyond(grid, node, exits, leave);
        parameter = leave;
    }
    let outcome = select(relievo_SURFACE_EXHAUSTED, relievo_SURFACE_HIT, parameter >= 1.0);
    return relievo_surface_point(ray, parameter, samples, outcome);
}

fn relievo_surface_plain(ray: relievo_SurfaceRay) -> relievo_SurfaceHit {
    if !(ray.cosine > 0.0) {
        return relievo_surface_missed(ray);
    }
    return relievo_surface_point(ray, ray.polygon, 0u, relievo_SURFACE_HIT);
}

fn relievo_surface_shifted(relievo_heights: texture_2d<f32>, ray: relievo_SurfaceRay, relievo_march: relievo_SurfaceMarch, limit: f32) -> relievo_SurfaceHit {
    if !(ray.cosine > 0.0) {
        return relievo_surface_missed(ray);
    }
    let height = relievo_surface_height(relievo_heights, relievo_surface_at(ray, ray.polygon), relievo_march.mip, relievo_march.address);
    let parameter = ray.polygon - (height - (1.0 - ray.polygon)) * limit;
    var hit = relievo_surface_point(ray, parameter, relievo_SURFACE_BILINEAR, relievo_SURFACE_HIT);
    hit.height = height;
    return hit;
}

fn relievo_surface_parallax(relievo_heights: texture_2d<f32>, ray: relievo_SurfaceRay, relievo_march: relievo_SurfaceMarch) -> relievo_SurfaceHit {
    return relievo_surface_shifted(relievo_heights, ray, relievo_march, 1.0);
}

fn relievo_surface_parallax_limited(relievo_heights: texture_2d<f32>, ray: relievo_SurfaceRay, relievo_march: relievo_SurfaceMarch) -> relievo_SurfaceHit {
    return relievo_surface_shifted(relievo_heights, ray, relievo_march, ray.cosine);
}

const relievo_SURFACE_FAR: i32 = 1073741824;

const relievo_SURFACE_LEAST_TRAVEL: f32 = 1e-6;

const relievo_SURFACE_NEVER: f32 = 2.0;

struct relievo_SurfaceGrid {
    size: vec2<i32>,
    cells: vec2<i32>,
    base: vec2<i32>,
    start: vec2<f32>,
    tiles: vec2<f32>,
    travel: vec2<f32>,
    inverse: vec2<f32>,
    address: u32
}

struct relievo_SurfaceNode {
    index: vec2<i32>,
    low: vec2<i32>,
    high: vec2<i32>
}

fn relievo_surface_grid(size: vec2<u32>, ray: relievo_SurfaceRay, address: u32) -> relievo_SurfaceGrid {
    let scale = vec2<f32>(size);
    let texel = ray.origin * scale - 0.5;
    let base = floor(texel);
    let travel = ray.slope * scale;
    let is_slow = abs(travel) < vec2<f32>(relievo_SURFACE_LEAST_TRAVEL);
    let inverse = select(1.0 / select(travel, vec2<f32>(1.0), is_slow), vec2<f32>(0.0), is_slow);
    let texels = vec2<i32>(size);
    var first = vec2<i32>(base);
    var cells = texels + 1;
    if address == relievo_SURFACE_WRAP {
        first = first % texels;
        first = select(first, first + texels, first < vec2<i32>(0));
        cells = texels;
    }
    return relievo_SurfaceGrid(texels, cells, first, texel - base, 1.0 / scale, travel, inverse, address);
}

const relievo_SURFACE_MAX_CROSSED: f32 = 16384.0;

fn relievo_surface_bound(grid: relievo_SurfaceGrid, relievo_levels: u32) -> u32 {
    let crossed = min(abs(grid.travel.x) + abs(grid.travel.y), relievo_SURFACE_MAX_CROSSED);
    return 2u * (u32(crossed) + 3u) + relievo_levels;
}

fn relievo_surface_node(grid: relievo_SurfaceGrid, cell: vec2<i32>, level: u32) -> relievo_SurfaceNode {
    let shift = vec2<u32>(level);
    let absolute = grid.base + cell;
    var inside: vec2<i32>;
    var tile: vec2<i32>;
    if grid.address == relievo_SURFACE_WRAP {
        let whole = vec2<i32>(floor((vec2<f32>(absolute) + 0.5) * grid.tiles)) * grid.size;
        inside = absolute - whole;
        tile = whole - grid.base;
    }
    else {
        inside = clamp(absolute + 1, vec2<i32>(0), grid.size);
        tile = -1 - grid.base;
    }
    let index = inside >> shift;
    let first = index << shift;
    let last = min(first + (vec2<i32>(1) << shift), grid.cells);
    var low = tile + first;
    var high = tile + last;
    if grid.address != relievo_SURFACE_WRAP {
        low = select(low, vec2<i32>(-relievo_SURFACE_FAR), first == vec2<i32>(0));
        high = select(high, vec2<i32>(relievo_SURFACE_FAR), last == grid.cells);
    }
    return relievo_SurfaceNode(index, low, high);
}

fn relievo_surface_exits(grid: relievo_SurfaceGrid, node: relievo_SurfaceNode) -> vec2<f32> {
    let edge = select(node.low, node.high, grid.travel >= vec2<f32>(0.0));
    let exits = (vec2<f32>(edge) - grid.start) * grid.inverse;
    return select(exits, vec2<f32>(relievo_SURFACE_NEVER), grid.inverse == vec2<f32>(0.0));
}

fn relievo_surface_cell(grid: relievo_SurfaceGrid, node: relievo_SurfaceNode, parameter: f32) -> vec2<i32> {
    let at = vec2<i32>(floor(grid.start + parameter * grid.travel));
    return clamp(at, node.low, node.high - 1);
}

fn relievo_surface_beyond(grid: relievo_SurfaceGrid, node: relievo_SurfaceNode, exits: vec2<f32>, parameter: f32) -> vec2<i32> {
    var next = relievo_surface_cell(grid, node, parameter);
    if exits.x <= exits.y {
        next.x = select(node.low.x - 1, node.high.x, grid.travel.x >= 0.0);
    }
    else {
        next.y = select(node.low.y - 1, node.high.y, grid.travel.y >= 0.0);
    }
    return next;
}

fn relievo_surface_corners(relievo_heights: texture_2d<f32>, grid: relievo_SurfaceGrid, index: vec2<i32>) -> vec4<f32> {
    var low = index;
    var high = index + 1;
    if grid.address == relievo_SURFACE_WRAP {
        high = select(high, vec2<i32>(0), high >= grid.size);
    }
    else {
        low = max(index - 1, vec2<i32>(0));
        high = min(index, grid.size - 1);
    }
    return vec4<f32>(textureLoad(relievo_heights, low, 0).r, textureLoad(relievo_heights, vec2<i32>(high.x, low.y), 0).r, textureLoad(relievo_heights, vec2<i32>(low.x, high.y), 0).r, textureLoad(relievo_heights, high, 0).r);
}

fn relievo_surface_patch(grid: relievo_SurfaceGrid, corners: vec4<f32>, low: vec2<i32>, enter: f32, leave: f32) -> f32 {
    let at = (grid.start - vec2<f32>(low)) + enter * grid.travel;
    let slope = vec2<f32>(corners.y - corners.x, corners.z - corners.x);
    let twist = (corners.w - corners.z) - slope.x;
    let length = leave - enter;
    let ahead = grid.travel * length;
    let height = corners.x + slope.x * at.x + (slope.y + twist * at.x) * at.y;
    let c = 1.0 - enter - height;
    if c <= 0.0 {
        return enter;
    }
    let b = -0.5 * (length + slope.x * ahead.x + slope.y * ahead.y + twist * (at.x * ahead.y + at.y * ahead.x));
    let a = -twist * ahead.x * ahead.y;
    let discriminant = b * b - a * c;
    let root = sqrt(max(discriminant, 0.0));
    let over = select(c, b + root, b > 0.0);
    let under = select(root - b, -a, b > 0.0);
    if discriminant >= 0.0 && under >= over {
        return enter + length * (over / under);
    }
    return select(-1.0, leave, a + 2.0 * b + c <= 0.0);
}

fn relievo_surface_corner(leaf: relievo_SurfaceNode) -> vec2<i32> {
    return select(leaf.low, leaf.high - 1, leaf.low == vec2<i32>(-relievo_SURFACE_FAR));
}

const relievo_SURFACE_BILINEAR: u32 = 4u;

fn relievo_surface_height(relievo_heights: texture_2d<f32>, uv: vec2<f32>, mip: u32, address: u32) -> f32 {
    let size = vec2<f32>(textureDimensions(relievo_heights, mip));
    let last = vec2<i32>(size) - 1;
    var low: vec2<i32>;
    var high: vec2<i32>;
    var weight: vec2<f32>;
    if address == relievo_SURFACE_WRAP {
        let at = (uv - floor(uv)) * size - 0.5;
        let corner = floor(at);
        weight = at - corner;
        low = vec2<i32>(corner);
        high = select(low + 1, vec2<i32>(0), low >= last);
        low = select(low, last, low < vec2<i32>(0));
    }
    else {
        let at = clamp(uv * size - 0.5, vec2<f32>(0.0), size - 1.0);
        let corner = floor(at);
        weight = at - corner;
        low = vec2<i32>(corner);
        high = min(low + 1, last);
    }
    let near = vec2<f32>(textureLoad(relievo_heights, low, mip).r, textureLoad(relievo_heights, vec2<i32>(high.x, low.y), mip).r);
    let far = vec2<f32>(textureLoad(relievo_heights, vec2<i32>(low.x, high.y), mip).r, textureLoad(relievo_heights, high, mip).r);
    let rows = near + weight.y * (far - near);
    return rows.x + weight.x * (rows.y - rows.x);
}

fn relievo_surface_mip(relievo_heights: texture_2d<f32>, uv_dx: vec2<f32>, uv_dy: vec2<f32>) -> u32 {
    let size = vec2<f32>(textureDimensions(relievo_heights));
    let texels = max(dot(uv_dx * size, uv_dx * size), dot(uv_dy * size, uv_dy * size));
    let level = 0.5 * log2(max(texels, 1.0));
    return min(u32(level + 0.5), textureNumLevels(relievo_heights) - 1u);
}

const relievo_SURFACE_MAX_STEPS: u32 = 1024u;

const relievo_SURFACE_MAX_BINARY: u32 = 24u;

const relievo_SURFACE_LEAST_SPAN: f32 = 1e-12;

struct relievo_SurfaceBracket {
    above: f32,
    under: f32,
    height_above: f32,
    height_under: f32,
    samples: u32
}

fn relievo_surface_steps(relievo_march: relievo_SurfaceMarch, cosine: f32) -> u32 {
    let low = f32(relievo_march.min_steps);
    let steps = ceil(low + (f32(relievo_march.max_steps) - low) * (1.0 - min(cosine, 1.0)));
    return clamp(u32(steps), 1u, relievo_SURFACE_MAX_STEPS);
}

fn relievo_surface_search(relievo_heights: texture_2d<f32>, ray: relievo_SurfaceRay, relievo_march: relievo_SurfaceMarch) -> relievo_SurfaceBracket {
    let steps = relievo_surface_steps(relievo_march, ray.cosine);
    let width = 1.0 / f32(steps);
    var bracket = relievo_SurfaceBracket(0.0, 1.0, 0.0, 0.0, 0u);
    for (var step = 1u; step <= relievo_SURFACE_MAX_STEPS; step++) {
        let parameter = select(f32(step) * width, 1.0, step >= steps);
        let height = relievo_surface_height(relievo_heights, relievo_surface_at(ray, parameter), relievo_march.mip, relievo_march.address);
        bracket.samples += relievo_SURFACE_BILINEAR;
        if 1.0 - parameter <= height || step >= steps {
            bracket.under = parameter;
            bracket.height_under = height;
            break;
        }
        bracket.above = parameter;
        bracket.height_above = height;
    }
    return bracket;
}

fn relievo_surface_relief(relievo_heights: texture_2d<f32>, ray: relievo_SurfaceRay, relievo_march: relievo_SurfaceMarch) -> relievo_SurfaceHit {
    if !(ray.cosine > 0.0) {
        return relievo_surface_missed(ray);
    }
    let bracket = relievo_surface_search(relievo_heights, ray, relievo_march);
    return relievo_surface_narrowed(relievo_heights, ray, relievo_march, bracket.above, bracket.under, bracket.samples);
}

fn relievo_surface_narrowed(relievo_heights: texture_2d<f32>, ray: relievo_SurfaceRay, relievo_march: relievo_SurfaceMarch, relievo_above: f32, under: f32, samples: u32) -> relievo_SurfaceHit {
    var low = relievo_above;
    var high = under;
    var loads = samples;
    for (var step = 0u; step < min(relievo_march.binary_steps, relievo_SURFACE_MAX_BINARY); step++) {
        let middle = 0.5 * (low + high);
        let height = relievo_surface_height(relievo_heights, relievo_surface_at(ray, middle), relievo_march.mip, relievo_march.address);
        loads += relievo_SURFACE_BILINEAR;
        if 1.0 - middle <= height {
            high = middle;
        }
        else {
            low = middle;
        }
    }
    return relievo_surface_point(ray, 0.5 * (low + high), loads, relievo_SURFACE_HIT);
}

fn relievo_surface_occlusion(relievo_heights: texture_2d<f32>, ray: relievo_SurfaceRay, relievo_march: relievo_SurfaceMarch) -> relievo_SurfaceHit {
    if !(ray.cosine > 0.0) {
        return relievo_surface_missed(ray);
    }
    var bracket = relievo_surface_search(relievo_heights, ray, relievo_march);
    if bracket.above == 0.0 {
        bracket.height_above = relievo_surface_height(relievo_heights, ray.origin, relievo_march.mip, relievo_march.address);
        bracket.samples += relievo_SURFACE_BILINEAR;
    }
    let over = max(1.0 - bracket.above - bracket.height_above, 0.0);
    let below = max(bracket.height_under - (1.0 - bracket.under), 0.0);
    let fraction = select(1.0, over / max(over + below, relievo_SURFACE_LEAST_SPAN), over + below > relievo_SURFACE_LEAST_SPAN);
    let parameter = bracket.above + fraction * (bracket.under - bracket.above);
    return relievo_surface_point(ray, parameter, bracket.samples, relievo_SURFACE_HIT);
}

fn relievo_surface_quadtree(relievo_heights: texture_2d<f32>, pyramid: texture_2d<f32>, ray: relievo_SurfaceRay, relievo_march: relievo_SurfaceMarch) -> relievo_SurfaceHit {
    if !(ray.cosine > 0.0) {
        return relievo_surface_missed(ray);
    }
    let grid = relievo_surface_grid(textureDimensions(relievo_heights), ray, relievo_march.address);
    let top = relievo_surface_levels(vec2<u32>(grid.cells)) - 1u;
    let bound = relievo_surface_bound(grid, top);
    let longest = u32(max(abs(grid.travel.x), abs(grid.travel.y)));
    var level = min(firstLeadingBit(max(longest / 2u, 1u)), top);
    var cell = vec2<i32>(0);
    var parameter = 0.0;
    var samples = 0u;
    var step = 0u;
    while (step < bound) {
        var node: relievo_SurfaceNode;
        var exits: vec2<f32>;
        var leave: f32;
        var is_leaf = false;
        while (step < bound) {
            step += 1u;
            node = relievo_surface_node(grid, cell, level);
            exits = relievo_surface_exits(grid, node);
            leave = clamp(min(exits.x, exits.y), parameter, 1.0);
            let at = relievo_surface_atlas_at(vec2<u32>(grid.cells), level, node.index);
            let highest = textureLoad(pyramid, at, 0).r;
            samples += 1u;
            if 1.0 - leave > highest {
                cell = relievo_surface_beyond(grid, node, exits, leave);
                parameter = leave;
                level = min(level + select(0u, 1u, relievo_surface_leaves_parent(grid, node, exits, level)), top);
                continue;
            }
            parameter = max(parameter, 1.0 - highest);
            if level == 0u {
                is_leaf = true;
                break;
            }
            level -= 1u;
            cell = relievo_surface_cell(grid, node, parameter);
        }
        if !is_leaf {
            break;
        }
        let corners = relievo_surface_corners(relievo_heights, grid, node.index);
        samples += 4u;
        let found = relievo_surface_patch(grid, corners, relievo_surface_corner(node), parameter, leave);
        if found >= 0.0 {
            return relievo_surface_point(ray, found, samples, relievo_SURFACE_HIT);
        }
        if leave >= 1.0 {
            parameter = 1.0;
            break;
        }
        cell = relievo_surface_beyond(grid, node, exits, leave);
        parameter = leave;
        level = min(select(0u, 1u, relievo_surface_leaves_parent(grid, node, exits, 0u)), top);
    }
    let outcome = select(relievo_SURFACE_EXHAUSTED, relievo_SURFACE_HIT, parameter >= 1.0);
    return relievo_surface_point(ray, parameter, samples, outcome);
}

fn relievo_surface_leaves_parent(grid: relievo_SurfaceGrid, node: relievo_SurfaceNode, exits: vec2<f32>, level: u32) -> bool {
    let along_x = exits.x <= exits.y;
    let index = select(node.index.y, node.index.x, along_x);
    let cells = select(grid.cells.y, grid.cells.x, along_x);
    let forward = select(grid.travel.y, grid.travel.x, along_x) >= 0.0;
    let is_odd = (index & 1) == 1;
    let is_last = ((index + 1) << level) >= cells;
    return select(!is_odd, is_odd || is_last, forward);
}

const relievo_SURFACE_WRAP: u32 = 0u;

const relievo_SURFACE_CLAMP: u32 = 1u;

const relievo_SURFACE_MISS: u32 = 0u;

const relievo_SURFACE_HIT: u32 = 1u;

const relievo_SURFACE_EXHAUSTED: u32 = 2u;

const relievo_SURFACE_LEAST_COSINE: f32 = 0.0078125;

struct relievo_SurfaceRay {
    origin: vec2<f32>,
    slope: vec2<f32>,
    cosine: f32,
    polygon: f32
}

struct relievo_SurfaceMarch {
    address: u32,
    min_steps: u32,
    max_steps: u32,
    binary_steps: u32,
    mip: u32
}

struct relievo_SurfaceHit {
    uv: vec2<f32>,
    height: f32,
    parameter: f32,
    samples: u32,
    outcome_code: u32
}

fn relievo_surface_ray(uv: vec2<f32>, relievo_view: vec3<f32>, scale: f32, plane: f32) -> relievo_SurfaceRay {
    let slope = relievo_view.xy * (-scale / max(relievo_view.z, relievo_SURFACE_LEAST_COSINE));
    let polygon = 1.0 - plane;
    return relievo_SurfaceRay(uv - polygon * slope, slope, relievo_view.z, polygon);
}

fn relievo_surface_at(ray: relievo_SurfaceRay, parameter: f32) -> vec2<f32> {
    return ray.origin + parameter * ray.slope;
}

fn relievo_surface_point(ray: relievo_SurfaceRay, parameter: f32, samples: u32, outcome: u32) -> relievo_SurfaceHit {
    return relievo_SurfaceHit(relievo_surface_at(ray, parameter), 1.0 - parameter, parameter, samples, outcome);
}

fn relievo_surface_missed(ray: relievo_SurfaceRay) -> relievo_SurfaceHit {
    return relievo_surface_point(ray, ray.polygon, 0u, relievo_SURFACE_MISS);
}

fn relievo_surface_inside(uv: vec2<f32>, low: vec2<f32>, high: vec2<f32>) -> bool {
    return all(uv >= low) && all(uv <= high);
}

fn relievo_surface_normal(relievo_heights: texture_2d<f32>, uv: vec2<f32>, scale: f32, relievo_march: relievo_SurfaceMarch) -> vec3<f32> {
    let size = vec2<f32>(textureDimensions(relievo_heights, relievo_march.mip));
    let x = vec2<f32>(1.0 / size.x, 0.0);
    let y = vec2<f32>(0.0, 1.0 / size.y);
    let rise = vec2<f32>(relievo_surface_height(relievo_heights, uv + x, relievo_march.mip, relievo_march.address) - relievo_surface_height(relievo_heights, uv - x, relievo_march.mip, relievo_march.address), relievo_surface_height(relievo_heights, uv + y, relievo_march.mip, relievo_march.address) - relievo_surface_height(relievo_heights, uv - y, relievo_march.mip, relievo_march.address));
    return normalize(vec3<f32>(-0.5 * scale * size * rise, 1.0));
}

fn relievo_surface_distance(ray: relievo_SurfaceRay, hit: relievo_SurfaceHit, scale: f32) -> f32 {
    return (hit.parameter - ray.polygon) * scale / max(ray.cosine, relievo_SURFACE_LEAST_COSINE);
}

fn relievo_surface_towards(eye: vec4<f32>, position: vec3<f32>) -> vec3<f32> {
    return normalize(eye.xyz - eye.w * position);
}

fn relievo_surface_depth(clip_from_world: mat4x4<f32>, position: vec3<f32>, towards: vec3<f32>, distance: f32) -> f32 {
    let clip = clip_from_world * vec4<f32>(position - towards * distance, 1.0);
    return clamp(clip.z / clip.w, 0.0, 1.0);
}

const relievo_SURFACE_SHADOW_BIAS: f32 = 0.005;

const relievo_SURFACE_LEAST_OCCLUSION: f32 = 0.001;

fn relievo_surface_light_ray(hit: relievo_SurfaceHit, light: vec3<f32>, scale: f32) -> relievo_SurfaceRay {
    let slope = light.xy * (-scale / max(light.z, relievo_SURFACE_LEAST_COSINE));
    return relievo_SurfaceRay(hit.uv - (1.0 - hit.height) * slope, slope, light.z, 0.0);
}

fn relievo_surface_shaded(first: relievo_SurfaceHit, hit: relievo_SurfaceHit) -> bool {
    return first.parameter < 1.0 - hit.height - relievo_SURFACE_SHADOW_BIAS;
}

fn relievo_surface_soft_shadow(relievo_heights: texture_2d<f32>, hit: relievo_SurfaceHit, light: vec3<f32>, scale: f32, relievo_march: relievo_SurfaceMarch, steps: u32, softness: f32) -> f32 {
    if !(light.z > 0.0) {
        return 0.0;
    }
    let own = relievo_surface_height(relievo_heights, hit.uv, relievo_march.mip, relievo_march.address);
    var start = hit;
    start.height = max(hit.height, own);
    let ray = relievo_surface_light_ray(start, light, scale);
    let rise = 1.0 - start.height;
    let count = clamp(steps, 1u, relievo_SURFACE_MAX_STEPS);
    var shade = 0.0;
    for (var step = 1u; (step <= count) & (shade < 1.0); step++) {
        let fraction = f32(step) / f32(count + 1u);
        let travelled = fraction * fraction;
        let parameter = rise * (1.0 - travelled);
        let height = relievo_surface_height(relievo_heights, ray.origin + parameter * ray.slope, relievo_march.mip, relievo_march.address);
        let excess = height - (1.0 - parameter) - relievo_SURFACE_SHADOW_BIAS;
        shade = max(shade, excess / (softness * (travelled * rise + relievo_SURFACE_LEAST_OCCLUSION)));
    }
    return 1.0 - min(shade, 1.0);
}

const relievo_SURFACE_SHADOW_NONE: u32 = 0u;

const relievo_SURFACE_SHADOW_HARD: u32 = 1u;

const relievo_SURFACE_SHADOW_SOFT: u32 = 2u;

struct relievo_SurfaceShadow {
    scale: f32,
    steps: u32,
    softness: f32
}

fn relievo_surface_sunlit(method: u32, shadow: u32, relievo_heights: texture_2d<f32>, relievo_acceleration: texture_2d<f32>, hit: relievo_SurfaceHit, light: vec3<f32>, relievo_relief: relievo_SurfaceShadow, relievo_march: relievo_SurfaceMarch) -> f32 {
    if shadow == relievo_SURFACE_SHADOW_NONE || !(light.z > 0.0) {
        return 1.0;
    }
    if shadow == relievo_SURFACE_SHADOW_SOFT {
        return relievo_surface_soft_shadow(relievo_heights, hit, light, relievo_relief.scale, relievo_march, relievo_relief.steps, relievo_relief.softness);
    }
    let ray = relievo_surface_light_ray(hit, light, relievo_relief.scale);
    let first = relievo_surface_trace(method, relievo_heights, relievo_acceleration, ray, relievo_march);
    return select(1.0, 0.0, relievo_surface_shaded(first, hit));
}

fn relievo_surface_mapped_normal(texel: vec4<f32>, green_up: bool) -> vec3<f32> {
    let slope = texel.xy * 2.0 - 1.0;
    return vec3<f32>(slope.x, select(slope.y, -slope.y, green_up), sqrt(max(1.0 - dot(slope, slope), 0.0)));
}

const relievo_SURFACE_PLAIN: u32 = 0u;

const relievo_SURFACE_PARALLAX: u32 = 1u;

const relievo_SURFACE_PARALLAX_LIMITED: u32 = 2u;

const relievo_SURFACE_RELIEF: u32 = 3u;

const relievo_SURFACE_OCCLUSION: u32 = 4u;

const relievo_SURFACE_CONE: u32 = 5u;

const relievo_SURFACE_QUADTREE: u32 = 6u;

fn relievo_surface_trace(method: u32, relievo_heights: texture_2d<f32>, relievo_acceleration: texture_2d<f32>, ray: relievo_SurfaceRay, relievo_march: relievo_SurfaceMarch) -> relievo_SurfaceHit {
    switch method {
        case relievo_SURFACE_PARALLAX {
            return relievo_surface_parallax(relievo_heights, ray, relievo_march);
        }
        case relievo_SURFACE_PARALLAX_LIMITED {
            return relievo_surface_parallax_limited(relievo_heights, ray, relievo_march);
        }
        case relievo_SURFACE_RELIEF {
            return relievo_surface_relief(relievo_heights, ray, relievo_march);
        }
        case relievo_SURFACE_OCCLUSION {
            return relievo_surface_occlusion(relievo_heights, ray, relievo_march);
        }
        case relievo_SURFACE_CONE {
            return relievo_surface_cone(relievo_heights, relievo_acceleration, ray, relievo_march);
        }
        case relievo_SURFACE_QUADTREE {
            return relievo_surface_quadtree(relievo_heights, relievo_acceleration, ray, relievo_march);
        }
        case default {
            return relievo_surface_plain(ray);
        }
    }
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
    let placed = relievo_relief_place(entry, relievo_vertex);
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
    let placed = relievo_relief_place(entry, relievo_vertex);
    return relievo_MovingVaryings(relievo_scene_clip(entry, placed.position), placed.position, placed.normal, placed.tangent, placed.uv, placed.values, relievo_scene_words(placed, entry), relievo_relief_last_position(entry, relievo_vertex));
}

struct relievo_Position {
    @invariant @builtin(position)
    clip: vec4<f32>
}

@vertex
fn relievo_vertex_depth(@builtin(vertex_index) relievo_vertex: u32, @location(0) entry: u32) -> relievo_Position {
    return relievo_Position(relievo_scene_clip(entry, relievo_relief_place(entry, relievo_vertex).position));
}

@fragment
fn relievo_depth() {

}

@fragment
fn relievo_depth_cut(in: relievo_Varyings, @builtin(front_facing) is_front: bool) {
    let relievo_surface = relievo_relief_surface(relievo_SceneFragment(in.position, in.normal, in.tangent, in.uv, in.values, in.words.xyz, relievo_words_instance(in.words), in.position, in.clip, relievo_words_outside(in.words, is_front), relievo_words_level(in.words), relievo_words_fade(in.words)));
    if relievo_surface.alpha < relievo_surface.cutoff || relievo_is_left_out(in.words.w, in.clip.xy) {
        discard;
    }
}

@fragment
fn relievo_depth_deep(in: relievo_Varyings, @builtin(front_facing) is_front: bool) -> @builtin(frag_depth) f32 {
    let slope = fwidth(in.clip.z);
    let relievo_surface = relievo_relief_surface(relievo_SceneFragment(in.position, in.normal, in.tangent, in.uv, in.values, in.words.xyz, relievo_words_instance(in.words), in.position, in.clip, relievo_words_outside(in.words, is_front), relievo_words_level(in.words), relievo_words_fade(in.words)));
    return relievo_depth_behind(relievo_surface.depth, in.clip.z, slope);
}

@fragment
fn relievo_depth_cut_deep(in: relievo_Varyings, @builtin(front_facing) is_front: bool) -> @builtin(frag_depth) f32 {
    let slope = fwidth(in.clip.z);
    let relievo_surface = relievo_relief_surface(relievo_SceneFragment(in.position, in.normal, in.tangent, in.uv, in.values, in.words.xyz, relievo_words_instance(in.words), in.position, in.clip, relievo_words_outside(in.words, is_front), relievo_words_level(in.words), relievo_words_fade(in.words)));
    if relievo_surface.alpha < relievo_surface.cutoff || relievo_is_left_out(in.words.w, in.clip.xy) {
        discard;
    }
    return relievo_depth_behind(relievo_surface.depth, in.clip.z, slope);
}

@fragment
fn relievo_color(in: relievo_Varyings, @builtin(front_facing) is_front: bool) -> relievo_ColorTargets {
    let relievo_surface = relievo_relief_surface(relievo_SceneFragment(in.position, in.normal, in.tangent, in.uv, in.values, in.words.xyz, relievo_words_instance(in.words), in.position, in.clip, relievo_words_outside(in.words, is_front), relievo_words_level(in.words), relievo_words_fade(in.words)));
    let targets = relievo_color_write(relievo_surface);
    return targets;
}

@fragment
fn relievo_color_cut(in: relievo_Varyings, @builtin(front_facing) is_front: bool) -> relievo_ColorTargets {
    let relievo_surface = relievo_relief_surface(relievo_SceneFragment(in.position, in.normal, in.tangent, in.uv, in.values, in.words.xyz, relievo_words_instance(in.words), in.position, in.clip, relievo_words_outside(in.words, is_front), relievo_words_level(in.words), relievo_words_fade(in.words)));
    let targets = relievo_color_write(relievo_surface);
    if relievo_surface.alpha < relievo_surface.cutoff || relievo_is_left_out(in.words.w, in.clip.xy) {
        discard;
    }
    return targets;
}

struct relievo_color_deep_targets {
    @location(0)
    color: vec4<f32>,
    @builtin(frag_depth)
    depth: f32
}

@fragment
fn relievo_color_deep(in: relievo_Varyings, @builtin(front_facing) is_front: bool) -> relievo_color_deep_targets {
    let relievo_surface = relievo_relief_surface(relievo_SceneFragment(in.position, in.normal, in.tangent, in.uv, in.values, in.words.xyz, relievo_words_instance(in.words), in.position, in.clip, relievo_words_outside(in.words, is_front), relievo_words_level(in.words), relievo_words_fade(in.words)));
    let targets = relievo_color_write(relievo_surface);
    return relievo_color_deep_targets(targets.color, relievo_surface.depth);
}

struct relievo_color_cut_deep_targets {
    @location(0)
    color: vec4<f32>,
    @builtin(frag_depth)
    depth: f32
}

@fragment
fn relievo_color_cut_deep(in: relievo_Varyings, @builtin(front_facing) is_front: bool) -> relievo_color_cut_deep_targets {
    let relievo_surface = relievo_relief_surface(relievo_SceneFragment(in.position, in.normal, in.tangent, in.uv, in.values, in.words.xyz, relievo_words_instance(in.words), in.position, in.clip, relievo_words_outside(in.words, is_front), relievo_words_level(in.words), relievo_words_fade(in.words)));
    let targets = relievo_color_write(relievo_surface);
    if relievo_surface.alpha < relievo_surface.cutoff || relievo_is_left_out(in.words.w, in.clip.xy) {
        discard;
    }
    return relievo_color_cut_deep_targets(targets.color, relievo_surface.depth);
}

@fragment
fn relievo_levels(in: relievo_Varyings, @builtin(front_facing) is_front: bool) -> relievo_LevelsTargets {
    let relievo_surface = relievo_relief_surface(relievo_SceneFragment(in.position, in.normal, in.tangent, in.uv, in.values, in.words.xyz, relievo_words_instance(in.words), in.position, in.clip, relievo_words_outside(in.words, is_front), relievo_words_level(in.words), relievo_words_fade(in.words)));
    let targets = relievo_levels_write(relievo_surface);
    return targets;
}

@fragment
fn relievo_levels_cut(in: relievo_Varyings, @builtin(front_facing) is_front: bool) -> relievo_LevelsTargets {
    let relievo_surface = relievo_relief_surface(relievo_SceneFragment(in.position, in.normal, in.tangent, in.uv, in.values, in.words.xyz, relievo_words_instance(in.words), in.position, in.clip, relievo_words_outside(in.words, is_front), relievo_words_level(in.words), relievo_words_fade(in.words)));
    let targets = relievo_levels_write(relievo_surface);
    if relievo_surface.alpha < relievo_surface.cutoff || relievo_is_left_out(in.words.w, in.clip.xy) {
        discard;
    }
    return targets;
}

struct relievo_levels_deep_targets {
    @location(0)
    color: vec4<f32>,
    @builtin(frag_depth)
    depth: f32
}

@fragment
fn relievo_levels_deep(in: relievo_Varyings, @builtin(front_facing) is_front: bool) -> relievo_levels_deep_targets {
    let relievo_surface = relievo_relief_surface(relievo_SceneFragment(in.position, in.normal, in.tangent, in.uv, in.values, in.words.xyz, relievo_words_instance(in.words), in.position, in.clip, relievo_words_outside(in.words, is_front), relievo_words_level(in.words), relievo_words_fade(in.words)));
    let targets = relievo_levels_write(relievo_surface);
    return relievo_levels_deep_targets(targets.color, relievo_surface.depth);
}

struct relievo_levels_cut_deep_targets {
    @location(0)
    color: vec4<f32>,
    @builtin(frag_depth)
    depth: f32
}

@fragment
fn relievo_levels_cut_deep(in: relievo_Varyings, @builtin(front_facing) is_front: bool) -> relievo_levels_cut_deep_targets {
    let relievo_surface = relievo_relief_surface(relievo_SceneFragment(in.position, in.normal, in.tangent, in.uv, in.values, in.words.xyz, relievo_words_instance(in.words), in.position, in.clip, relievo_words_outside(in.words, is_front), relievo_words_level(in.words), relievo_words_fade(in.words)));
    let targets = relievo_levels_write(relievo_surface);
    if relievo_surface.alpha < relievo_surface.cutoff || relievo_is_left_out(in.words.w, in.clip.xy) {
        discard;
    }
    return relievo_levels_cut_deep_targets(targets.color, relievo_surface.depth);
}

@fragment
fn relievo_measure(in: relievo_Varyings, @builtin(front_facing) is_front: bool) -> relievo_MeasureTargets {
    let relievo_surface = relievo_relief_surface(relievo_SceneFragment(in.position, in.normal, in.tangent, in.uv, in.values, in.words.xyz, relievo_words_instance(in.words), in.position, in.clip, relievo_words_outside(in.words, is_front), relievo_words_level(in.words), relievo_words_fade(in.words)));
    let targets = relievo_measure_write(relievo_surface);
    return targets;
}

@fragment
fn relievo_measure_cut(in: relievo_Varyings, @builtin(front_facing) is_front: bool) -> relievo_MeasureTargets {
    let relievo_surface = relievo_relief_surface(relievo_SceneFragment(in.position, in.normal, in.tangent, in.uv, in.values, in.words.xyz, relievo_words_instance(in.words), in.position, in.clip, relievo_words_outside(in.words, is_front), relievo_words_level(in.words), relievo_words_fade(in.words)));
    let targets = relievo_measure_write(relievo_surface);
    if relievo_surface.alpha < relievo_surface.cutoff || relievo_is_left_out(in.words.w, in.clip.xy) {
        discard;
    }
    return targets;
}

struct relievo_measure_deep_targets {
    @location(0)
    position: vec4<f32>,
    @location(1)
    id: vec2<u32>,
    @builtin(frag_depth)
    depth: f32
}

@fragment
fn relievo_measure_deep(in: relievo_Varyings, @builtin(front_facing) is_front: bool) -> relievo_measure_deep_targets {
    let relievo_surface = relievo_relief_surface(relievo_SceneFragment(in.position, in.normal, in.tangent, in.uv, in.values, in.words.xyz, relievo_words_instance(in.words), in.position, in.clip, relievo_words_outside(in.words, is_front), relievo_words_level(in.words), relievo_words_fade(in.words)));
    let targets = relievo_measure_write(relievo_surface);
    return relievo_measure_deep_targets(targets.position, targets.id, relievo_surface.depth);
}

struct relievo_measure_cut_deep_targets {
    @location(0)
    position: vec4<f32>,
    @location(1)
    id: vec2<u32>,
    @builtin(frag_depth)
    depth: f32
}

@fragment
fn relievo_measure_cut_deep(in: relievo_Varyings, @builtin(front_facing) is_front: bool) -> relievo_measure_cut_deep_targets {
    let relievo_surface = relievo_relief_surface(relievo_SceneFragment(in.position, in.normal, in.tangent, in.uv, in.values, in.words.xyz, relievo_words_instance(in.words), in.position, in.clip, relievo_words_outside(in.words, is_front), relievo_words_level(in.words), relievo_words_fade(in.words)));
    let targets = relievo_measure_write(relievo_surface);
    if relievo_surface.alpha < relievo_surface.cutoff || relievo_is_left_out(in.words.w, in.clip.xy) {
        discard;
    }
    return relievo_measure_cut_deep_targets(targets.position, targets.id, relievo_surface.depth);
}

@fragment
fn relievo_surface(in: relievo_Varyings, @builtin(front_facing) is_front: bool) -> relievo_SurfaceTargets {
    let relievo_surface = relievo_relief_surface(relievo_SceneFragment(in.position, in.normal, in.tangent, in.uv, in.values, in.words.xyz, relievo_words_instance(in.words), in.position, in.clip, relievo_words_outside(in.words, is_front), relievo_words_level(in.words), relievo_words_fade(in.words)));
    let targets = relievo_surface_write(relievo_surface);
    return targets;
}

@fragment
fn relievo_surface_cut(in: relievo_Varyings, @builtin(front_facing) is_front: bool) -> relievo_SurfaceTargets {
    let relievo_surface = relievo_relief_surface(relievo_SceneFragment(in.position, in.normal, in.tangent, in.uv, in.values, in.words.xyz, relievo_words_instance(in.words), in.position, in.clip, relievo_words_outside(in.words, is_front), relievo_words_level(in.words), relievo_words_fade(in.words)));
    let targets = relievo_surface_write(relievo_surface);
    if relievo_surface.alpha < relievo_surface.cutoff || relievo_is_left_out(in.words.w, in.clip.xy) {
        discard;
    }
    return targets;
}

struct relievo_surface_deep_targets {
    @location(0)
    normal: vec4<f32>,
    @location(1)
    albedo: vec4<f32>,
    @location(2)
    id: vec2<u32>,
    @builtin(frag_depth)
    depth: f32
}

@fragment
fn relievo_surface_deep(in: relievo_Varyings, @builtin(front_facing) is_front: bool) -> relievo_surface_deep_targets {
    let relievo_surface = relievo_relief_surface(relievo_SceneFragment(in.position, in.normal, in.tangent, in.uv, in.values, in.words.xyz, relievo_words_instance(in.words), in.position, in.clip, relievo_words_outside(in.words, is_front), relievo_words_level(in.words), relievo_words_fade(in.words)));
    let targets = relievo_surface_write(relievo_surface);
    return relievo_surface_deep_targets(targets.normal, targets.albedo, targets.id, relievo_surface.depth);
}

struct relievo_surface_cut_deep_targets {
    @location(0)
    normal: vec4<f32>,
    @location(1)
    albedo: vec4<f32>,
    @location(2)
    id: vec2<u32>,
    @builtin(frag_depth)
    depth: f32
}

@fragment
fn relievo_surface_cut_deep(in: relievo_Varyings, @builtin(front_facing) is_front: bool) -> relievo_surface_cut_deep_targets {
    let relievo_surface = relievo_relief_surface(relievo_SceneFragment(in.position, in.normal, in.tangent, in.uv, in.values, in.words.xyz, relievo_words_instance(in.words), in.position, in.clip, relievo_words_outside(in.words, is_front), relievo_words_level(in.words), relievo_words_fade(in.words)));
    let targets = relievo_surface_write(relievo_surface);
    if relievo_surface.alpha < relievo_surface.cutoff || relievo_is_left_out(in.words.w, in.clip.xy) {
        discard;
    }
    return relievo_surface_cut_deep_targets(targets.normal, targets.albedo, targets.id, relievo_surface.depth);
}

@fragment
fn relievo_velocity(in: relievo_MovingVaryings, @builtin(front_facing) is_front: bool) -> relievo_VelocityTargets {
    let relievo_surface = relievo_relief_surface(relievo_SceneFragment(in.position, in.normal, in.tangent, in.uv, in.values, in.words.xyz, relievo_words_instance(in.words), in.last, in.clip, relievo_words_outside(in.words, is_front), relievo_words_level(in.words), relievo_words_fade(in.words)));
    let targets = relievo_velocity_write(relievo_surface);
    return targets;
}

@fragment
fn relievo_velocity_cut(in: relievo_MovingVaryings, @builtin(front_facing) is_front: bool) -> relievo_VelocityTargets {
    let relievo_surface = relievo_relief_surface(relievo_SceneFragment(in.position, in.normal, in.tangent, in.uv, in.values, in.words.xyz, relievo_words_instance(in.words), in.last, in.clip, relievo_words_outside(in.words, is_front), relievo_words_level(in.words), relievo_words_fade(in.words)));
    let targets = relievo_velocity_write(relievo_surface);
    if relievo_surface.alpha < relievo_surface.cutoff || relievo_is_left_out(in.words.w, in.clip.xy) {
        discard;
    }
    return targets;
}

struct relievo_velocity_deep_targets {
    @location(0)
    velocity: vec4<f32>,
    @builtin(frag_depth)
    depth: f32
}

@fragment
fn relievo_velocity_deep(in: relievo_MovingVaryings, @builtin(front_facing) is_front: bool) -> relievo_velocity_deep_targets {
    let relievo_surface = relievo_relief_surface(relievo_SceneFragment(in.position, in.normal, in.tangent, in.uv, in.values, in.words.xyz, relievo_words_instance(in.words), in.last, in.clip, relievo_words_outside(in.words, is_front), relievo_words_level(in.words), relievo_words_fade(in.words)));
    let targets = relievo_velocity_write(relievo_surface);
    return relievo_velocity_deep_targets(targets.velocity, relievo_surface.depth);
}

struct relievo_velocity_cut_deep_targets {
    @location(0)
    velocity: vec4<f32>,
    @builtin(frag_depth)
    depth: f32
}

@fragment
fn relievo_velocity_cut_deep(in: relievo_MovingVaryings, @builtin(front_facing) is_front: bool) -> relievo_velocity_cut_deep_targets {
    let relievo_surface = relievo_relief_surface(relievo_SceneFragment(in.position, in.normal, in.tangent, in.uv, in.values, in.words.xyz, relievo_words_instance(in.words), in.last, in.clip, relievo_words_outside(in.words, is_front), relievo_words_level(in.words), relievo_words_fade(in.words)));
    let targets = relievo_velocity_write(relievo_surface);
    if relievo_surface.alpha < relievo_surface.cutoff || relievo_is_left_out(in.words.w, in.clip.xy) {
        discard;
    }
    return relievo_velocity_cut_deep_targets(targets.velocity, relievo_surface.depth);
}


fn shade(relievo_surface: Surface, relievo_view: View) -> vec4<f32> {
    let direct = max(dot(relievo_surface.normal, relievo_view.light), 0.0) * relievo_surface.sunlit;
    return vec4<f32>(relievo_lambert(relievo_surface.color * relievo_view.light_color, relievo_view.ambient, direct), relievo_surface.alpha);
}
