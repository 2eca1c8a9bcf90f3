// relievo render/scene_mesh: generated from wgsl/render/scene_mesh.wgsl

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

struct relievo_LevelsTargets {
    @location(0)
    color: vec4<f32>
}

const relievo_LEVEL_COLORS: array<vec3<f32>, 8> = array<vec3<f32>, 8>(vec3<f32>(0.76, 0.05, 0.05), vec3<f32>(0.85, 0.27, 0.02), vec3<f32>(0.8, 0.62, 0.03), vec3<f32>(0.22, 0.58, 0.06), vec3<f32>(0.03, 0.48, 0.4), vec3<f32>(0.04, 0.27, 0.7), vec3<f32>(0.17, 0.09, 0.62), vec3<f32>(0.5, 0.08, 0.55));

fn relievo_levels_write(relievo_surface: Surface) -> relievo_LevelsTargets {
    let relievo_facing = 0.35 + 0.65 * max(dot(relievo_surface.normal, relievo_view.light.xyz), 0.0);
    return relievo_LevelsTargets(vec4<f32>(relievo_facing * relievo_LEVEL_COLORS[relievo_surface.level], 1.0));
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

override relievo_DOUBLE_SIDED: bool = false;

override relievo_TEXTURED: bool = false;

override relievo_NORMAL_MAPPED: bool = false;

const relievo_CUTOFF_OPAQUE: f32 = -1.0;

const relievo_CUTOFF_DITHERED: f32 = -2.0;

const relievo_NO_LAYER: u32 = 4294967295u;

struct relievo_SceneMaterial {
    color: vec4<f32>,
    cutoff: f32,
    layer: u32,
    normal_layer: u32,
    normal_scale: f32
}

@group(2) @binding(0)
var<storage, read> relievo_materials: array<relievo_SceneMaterial>;

@group(2) @binding(1)
var relievo_albedo: texture_2d_array<f32>;

@group(2) @binding(2)
var relievo_normals: texture_2d_array<f32>;

@group(2) @binding(3)
var relievo_filtering: sampler;

@group(2) @binding(4)
var relievo_normal_filtering: sampler;

fn relievo_mesh_place(entry: u32, relievo_vertex: u32) -> relievo_SceneVertex {
    var placed = relievo_placed_vertex(entry, relievo_vertex);
    placed.words.x = relievo_material_of[relievo_vertex];
    return placed;
}

fn relievo_mesh_last_position(entry: u32, relievo_vertex: u32) -> vec3<f32> {
    return relievo_last_position(entry, relievo_vertex);
}

fn relievo_facing(outwards: vec3<f32>, in: relievo_SceneFragment) -> vec3<f32> {
    if relievo_DOUBLE_SIDED {
        return select(-outwards, outwards, in.is_outside);
    }
    return outwards;
}

fn relievo_bumpy_normal(in: relievo_SceneFragment, material: relievo_SceneMaterial, normal: vec3<f32>) -> vec3<f32> {
    let is_plain = material.normal_layer == relievo_NO_LAYER;
    let texel = textureSample(relievo_normals, relievo_normal_filtering, in.uv.xy, select(material.normal_layer, 0u, is_plain));
    let bump = (2.0 * texel.xyz - 1.0) * vec3<f32>(material.normal_scale, -material.normal_scale, 1.0);
    let tangent = normalize(in.tangent.xyz - normal * dot(normal, in.tangent.xyz));
    let bitangent = in.tangent.w * cross(normal, tangent);
    let bumpy = normalize(bump.x * tangent + bump.y * bitangent + bump.z * normal);
    return select(bumpy, normal, is_plain);
}

fn relievo_mesh_surface(in: relievo_SceneFragment) -> Surface {
    let material = relievo_materials[in.words.x];
    var relievo_surface = relievo_scene_surface(in);
    var relievo_color = material.color * relievo_surface.tint;
    if relievo_TEXTURED {
        let has_none = material.layer == relievo_NO_LAYER;
        let texel = textureSample(relievo_albedo, relievo_filtering, in.uv.xy, select(material.layer, 0u, has_none));
        relievo_color *= select(texel, vec4<f32>(1.0), has_none);
    }
    var outwards = normalize(in.normal);
    if relievo_NORMAL_MAPPED {
        outwards = relievo_bumpy_normal(in, material, outwards);
    }
    relievo_surface.normal = relievo_facing(outwards, in);
    relievo_surface.color = relievo_color.rgb;
    relievo_surface.alpha = relievo_color.a;
    let is_dithered = material.cutoff == relievo_CUTOFF_DITHERED;
    relievo_surface.cutoff = select(material.cutoff, relievo_surface_dither_threshold(vec2<u32>(in.clip.xy)), is_dithered);
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

fn relievo_rows_of_dual(real: vec4<f32>, dual: vec4<f32>, diagonal: vec4<f32>, above: vec4<f32>) -> relievo_Rows {
    let twice = 2.0 * (1.0 / dot(real, real));
    let t = twice * (real.w * dual.xyz - dual.w * real.xyz + cross(real.xyz, dual.xyz));
    let q = real;
    let u = diagonal;
    let x = vec3<f32>(1.0 - twice * (q.y * q.y + q.z * q.z), twice * (q.x * q.y - q.w * q.z), twice * (q.x * q.z + q.w * q.y));
    let y = vec3<f32>(twice * (q.x * q.y + q.w * q.z), 1.0 - twice * (q.x * q.x + q.z * q.z), twice * (q.y * q.z - q.w * q.x));
    let z = vec3<f32>(twice * (q.x * q.z - q.w * q.y), twice * (q.y * q.z + q.w * q.x), 1.0 - twice * (q.x * q.x + q.y * q.y));
    return relievo_Rows(vec4<f32>(x.x * u.x, x.x * above.x + x.y * u.y, x.x * above.y + x.y * above.z + x.z * u.z, t.x), vec4<f32>(y.x * u.x, y.x * above.x + y.y * u.y, y.x * above.y + y.y * above.z + y.z * u.z, t.y), vec4<f32>(z.x * u.x, z.x * above.x + z.y * u.y, z.x * above.y + z.y * above.z + z.z * u.z, t.z));
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

fn relievo_surface_dither_threshold(place: vec2<u32>) -> f32 {
    let fine = place & vec2<u32>(1u);
    let coarse = (place >> vec2<u32>(1u)) & vec2<u32>(1u);
    let rank = 8u * (fine.x ^ fine.y) + 4u * fine.y + 2u * (coarse.x ^ coarse.y) + coarse.y;
    return (f32(rank) + 0.5) / 16.0;
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
    let placed = relievo_mesh_place(entry, relievo_vertex);
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
    let placed = relievo_mesh_place(entry, relievo_vertex);
    return relievo_MovingVaryings(relievo_scene_clip(entry, placed.position), placed.position, placed.normal, placed.tangent, placed.uv, placed.values, relievo_scene_words(placed, entry), relievo_mesh_last_position(entry, relievo_vertex));
}

struct relievo_Position {
    @invariant @builtin(position)
    clip: vec4<f32>
}

@vertex
fn relievo_vertex_depth(@builtin(vertex_index) relievo_vertex: u32, @location(0) entry: u32) -> relievo_Position {
    return relievo_Position(relievo_scene_clip(entry, relievo_mesh_place(entry, relievo_vertex).position));
}

@fragment
fn relievo_depth() {

}

@fragment
fn relievo_depth_cut(in: relievo_Varyings, @builtin(front_facing) is_front: bool) {
    let relievo_surface = relievo_mesh_surface(relievo_SceneFragment(in.position, in.normal, in.tangent, in.uv, in.values, in.words.xyz, relievo_words_instance(in.words), in.position, in.clip, relievo_words_outside(in.words, is_front), relievo_words_level(in.words), relievo_words_fade(in.words)));
    if relievo_surface.alpha < relievo_surface.cutoff || relievo_is_left_out(in.words.w, in.clip.xy) {
        discard;
    }
}

@fragment
fn relievo_color(in: relievo_Varyings, @builtin(front_facing) is_front: bool) -> relievo_ColorTargets {
    let relievo_surface = relievo_mesh_surface(relievo_SceneFragment(in.position, in.normal, in.tangent, in.uv, in.values, in.words.xyz, relievo_words_instance(in.words), in.position, in.clip, relievo_words_outside(in.words, is_front), relievo_words_level(in.words), relievo_words_fade(in.words)));
    let targets = relievo_color_write(relievo_surface);
    return targets;
}

@fragment
fn relievo_color_cut(in: relievo_Varyings, @builtin(front_facing) is_front: bool) -> relievo_ColorTargets {
    let relievo_surface = relievo_mesh_surface(relievo_SceneFragment(in.position, in.normal, in.tangent, in.uv, in.values, in.words.xyz, relievo_words_instance(in.words), in.position, in.clip, relievo_words_outside(in.words, is_front), relievo_words_level(in.words), relievo_words_fade(in.words)));
    let targets = relievo_color_write(relievo_surface);
    if relievo_surface.alpha < relievo_surface.cutoff || relievo_is_left_out(in.words.w, in.clip.xy) {
        discard;
    }
    return targets;
}

@fragment
fn relievo_transparent(in: relievo_Varyings, @builtin(front_facing) is_front: bool) -> relievo_TransparentTargets {
    let relievo_surface = relievo_mesh_surface(relievo_SceneFragment(in.position, in.normal, in.tangent, in.uv, in.values, in.words.xyz, relievo_words_instance(in.words), in.position, in.clip, relievo_words_outside(in.words, is_front), relievo_words_level(in.words), relievo_words_fade(in.words)));
    let targets = relievo_transparent_write(relievo_surface);
    return targets;
}

@fragment
fn relievo_transparent_cut(in: relievo_Varyings, @builtin(front_facing) is_front: bool) -> relievo_TransparentTargets {
    let relievo_surface = relievo_mesh_surface(relievo_SceneFragment(in.position, in.normal, in.tangent, in.uv, in.values, in.words.xyz, relievo_words_instance(in.words), in.position, in.clip, relievo_words_outside(in.words, is_front), relievo_words_level(in.words), relievo_words_fade(in.words)));
    let targets = relievo_transparent_write(relievo_surface);
    if relievo_surface.alpha < relievo_surface.cutoff || relievo_is_left_out(in.words.w, in.clip.xy) {
        discard;
    }
    return targets;
}

@fragment
fn relievo_levels(in: relievo_Varyings, @builtin(front_facing) is_front: bool) -> relievo_LevelsTargets {
    let relievo_surface = relievo_mesh_surface(relievo_SceneFragment(in.position, in.normal, in.tangent, in.uv, in.values, in.words.xyz, relievo_words_instance(in.words), in.position, in.clip, relievo_words_outside(in.words, is_front), relievo_words_level(in.words), relievo_words_fade(in.words)));
    let targets = relievo_levels_write(relievo_surface);
    return targets;
}

@fragment
fn relievo_levels_cut(in: relievo_Varyings, @builtin(front_facing) is_front: bool) -> relievo_LevelsTargets {
    let relievo_surface = relievo_mesh_surface(relievo_SceneFragment(in.position, in.normal, in.tangent, in.uv, in.values, in.words.xyz, relievo_words_instance(in.words), in.position, in.clip, relievo_words_outside(in.words, is_front), relievo_words_level(in.words), relievo_words_fade(in.words)));
    let targets = relievo_levels_write(relievo_surface);
    if relievo_surface.alpha < relievo_surface.cutoff || relievo_is_left_out(in.words.w, in.clip.xy) {
        discard;
    }
    return targets;
}

@fragment
fn relievo_measure(in: relievo_Varyings, @builtin(front_facing) is_front: bool) -> relievo_MeasureTargets {
    let relievo_surface = relievo_mesh_surface(relievo_SceneFragment(in.position, in.normal, in.tangent, in.uv, in.values, in.words.xyz, relievo_words_instance(in.words), in.position, in.clip, relievo_words_outside(in.words, is_front), relievo_words_level(in.words), relievo_words_fade(in.words)));
    let targets = relievo_measure_write(relievo_surface);
    return targets;
}

@fragment
fn relievo_measure_cut(in: relievo_Varyings, @builtin(front_facing) is_front: bool) -> relievo_MeasureTargets {
    let relievo_surface = relievo_mesh_surface(relievo_SceneFragment(in.position, in.normal, in.tangent, in.uv, in.values, in.words.xyz, relievo_words_instance(in.words), in.position, in.clip, relievo_words_outside(in.words, is_front), relievo_words_level(in.words), relievo_words_fade(in.words)));
    let targets = relievo_measure_write(relievo_surface);
    if relievo_surface.alpha < relievo_surface.cutoff || relievo_is_left_out(in.words.w, in.clip.xy) {
        discard;
    }
    return targets;
}

@fragment
fn relievo_surface(in: relievo_Varyings, @builtin(front_facing) is_front: bool) -> relievo_SurfaceTargets {
    let relievo_surface = relievo_mesh_surface(relievo_SceneFragment(in.position, in.normal, in.tangent, in.uv, in.values, in.words.xyz, relievo_words_instance(in.words), in.position, in.clip, relievo_words_outside(in.words, is_front), relievo_words_level(in.words), relievo_words_fade(in.words)));
    let targets = relievo_surface_write(relievo_surface);
    return targets;
}

@fragment
fn relievo_surface_cut(in: relievo_Varyings, @builtin(front_facing) is_front: bool) -> relievo_SurfaceTargets {
    let relievo_surface = relievo_mesh_surface(relievo_SceneFragment(in.position, in.normal, in.tangent, in.uv, in.values, in.words.xyz, relievo_words_instance(in.words), in.position, in.clip, relievo_words_outside(in.words, is_front), relievo_words_level(in.words), relievo_words_fade(in.words)));
    let targets = relievo_surface_write(relievo_surface);
    if relievo_surface.alpha < relievo_surface.cutoff || relievo_is_left_out(in.words.w, in.clip.xy) {
        discard;
    }
    return targets;
}

@fragment
fn relievo_velocity(in: relievo_MovingVaryings, @builtin(front_facing) is_front: bool) -> relievo_VelocityTargets {
    let relievo_surface = relievo_mesh_surface(relievo_SceneFragment(in.position, in.normal, in.tangent, in.uv, in.values, in.words.xyz, relievo_words_instance(in.words), in.last, in.clip, relievo_words_outside(in.words, is_front), relievo_words_level(in.words), relievo_words_fade(in.words)));
    let targets = relievo_velocity_write(relievo_surface);
    return targets;
}

@fragment
fn relievo_velocity_cut(in: relievo_MovingVaryings, @builtin(front_facing) is_front: bool) -> relievo_VelocityTargets {
    let relievo_surface = relievo_mesh_surface(relievo_SceneFragment(in.position, in.normal, in.tangent, in.uv, in.values, in.words.xyz, relievo_words_instance(in.words), in.last, in.clip, relievo_words_outside(in.words, is_front), relievo_words_level(in.words), relievo_words_fade(in.words)));
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
