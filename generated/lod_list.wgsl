// relievo lod/list: generated from kernels/lod/list.wgsl

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

const TRANSITION_HARD = 0u;

const TRANSITION_GEOMORPH = 1u;

const TRANSITION_DITHER = 2u;

const TRANSITION_CROSS_FADE = 3u;

const TRANSITION_FADE_IN = 4u;

const TRANSITION_TWO_PHASE = 5u;

const TRANSITION_ALPHA = 6u;

const NO_LEVEL = 4294967295u;

const NO_LIST = 4294967295u;

fn threshold_of(object: LodObject, level: u32, last: u32) -> f32 {
    let threshold = object.thresholds[level >> 2u][level & 3u];
    if last == NO_LEVEL {
        return threshold;
    }
    return threshold * select(object.coarser, object.finer, level <= last);
}

fn level_within(object: LodObject, metric: f32, last: u32) -> u32 {
    var level = 0u;
    for (var coarser = 1u; coarser < min(object.levels, OBJECT_LEVELS); coarser++) {
        if threshold_of(object, coarser, last) <= metric {
            level = coarser;
        }
    }
    return level;
}

fn steps_between(metric: f32, begin: f32, end: f32, most: u32) -> u32 {
    return u32(f32(most) * clamp((metric - begin) / (end - begin), 0.0, 1.0) + 0.5);
}

fn last_level(object: LodObject, last: u32) -> u32 {
    if decision_seen(last) == 0u {
        return NO_LEVEL;
    }
    return select(decision_level(last), decision_next(last), decision_steps(last) > 0u && object_flags_timed(object.flags) != 0u);
}

fn settled(level: u32, mirrored: u32) -> u32 {
    return decision_word(1u, mirrored, level, level, 0u);
}

fn morphing(object: LodObject, metric: f32, mirrored: u32) -> u32 {
    let level = level_within(object, metric, NO_LEVEL);
    if level + 1u >= min(object.levels, OBJECT_LEVELS) {
        return settled(level, mirrored);
    }
    let begin = threshold_of(object, level, NO_LEVEL);
    let steps = steps_between(metric, begin, threshold_of(object, level + 1u, NO_LEVEL), MORPH_STEPS);
    return decision_word(1u, mirrored, level, level, steps);
}

fn fading_in_band(object: LodObject, metric: f32, mirrored: u32) -> u32 {
    let level = level_within(object, metric, 0u);
    if level + 1u >= min(object.levels, OBJECT_LEVELS) {
        return settled(level, mirrored);
    }
    let next = level + 1u;
    let begin = threshold_of(object, next, next);
    let steps = steps_between(metric, begin, threshold_of(object, next, 0u), FADE_PROGRESS);
    if steps == FADE_PROGRESS {
        return settled(next, mirrored);
    }
    return decision_word(1u, mirrored, level, select(level, next, steps > 0u), steps);
}

fn fading_in_time(object: LodObject, level: u32, mirrored: u32, last: u32, seconds: f32) -> u32 {
    if decision_seen(last) == 0u {
        return settled(level, mirrored);
    }
    var left = decision_level(last);
    var to = decision_next(last);
    var done = decision_steps(last);
    if done == 0u {
        to = level;
    }
    else if level == left {
        to = left;
        left = decision_next(last);
        done = FADE_PROGRESS - done;
    }
    if left == to {
        return settled(left, mirrored);
    }
    let steps = done + max(u32(min(object.rate * seconds, f32(FADE_PROGRESS)) + 0.5), 1u);
    if steps >= FADE_PROGRESS {
        return settled(to, mirrored);
    }
    return decision_word(1u, mirrored, left, to, steps);
}

fn coarsened(object: LodObject, metric: f32, factor: f32) -> f32 {
    return factor * metric + (factor - 1.0) * object.metric_floor;
}

fn held_level(object: LodObject, last: u32) -> u32 {
    let transition = object_flags_transition(object.flags);
    let is_fading = transition >= TRANSITION_DITHER && transition <= TRANSITION_TWO_PHASE;
    let is_momentary = transition == TRANSITION_GEOMORPH || (is_fading && object_flags_timed(object.flags) == 0u);
    return select(last_level(object, last), NO_LEVEL, is_momentary);
}

fn is_faded_out(object: LodObject, metric: f32) -> bool {
    return object_flags_transition(object.flags) == TRANSITION_ALPHA && steps_between(metric, object.fade_begin, object.fade_end, FADE_PROGRESS) == FADE_PROGRESS;
}

fn transition_decision(object: LodObject, metric: f32, factor: f32, mirrored: u32, last: u32, seconds: f32, ends: bool) -> u32 {
    let transition = object_flags_transition(object.flags);
    let within = coarsened(object, metric, factor);
    if transition == TRANSITION_GEOMORPH {
        return morphing(object, within, mirrored);
    }
    let is_fading = transition >= TRANSITION_DITHER && transition <= TRANSITION_TWO_PHASE && !ends;
    let is_timed = object_flags_timed(object.flags) != 0u;
    if is_fading && !is_timed {
        return fading_in_band(object, within, mirrored);
    }
    let level = level_within(object, within, held_level(object, last));
    if is_fading {
        return fading_in_time(object, level, mirrored, last, seconds);
    }
    if transition != TRANSITION_ALPHA {
        return settled(level, mirrored);
    }
    let steps = steps_between(metric, object.fade_begin, object.fade_end, FADE_PROGRESS);
    return select(decision_word(1u, mirrored, level, level, steps), 0u, steps == FADE_PROGRESS);
}

fn decision_finest(decision: u32) -> u32 {
    return min(decision_level(decision), decision_next(decision));
}

struct Entries {
    first: u32,
    first_entry: u32,
    second: u32,
    second_entry: u32
}

fn transition_entries(object: LodObject, decision: u32, index: u32) -> Entries {
    if decision_seen(decision) == 0u {
        return Entries(NO_LIST, 0u, NO_LIST, 0u);
    }
    let level = decision_level(decision);
    let next = decision_next(decision);
    let mirrored = decision_mirrored(decision);
    let steps = decision_steps(decision);
    let transition = object_flags_transition(object.flags);
    let solid = solid_list(level, mirrored);
    if steps == 0u {
        return Entries(solid, list_entry_word(index, level, 0u), NO_LIST, 0u);
    }
    let left = left_of(steps);
    let gained = FADE_STEPS - left;
    let fading = fading_list(object, level, mirrored);
    let next_fading = fading_list(object, next, mirrored);
    switch transition {
        case TRANSITION_DITHER {
            return Entries(fading, list_entry_word(index, level, fade_word(left, 0u)), next_fading, list_entry_word(index, next, fade_word(left, 1u)));
        }
        case TRANSITION_CROSS_FADE {
            return Entries(fading, list_entry_word(index, level, fade_word(left, 0u)), next_fading, list_entry_word(index, next, fade_word(gained, 0u)));
        }
        case TRANSITION_FADE_IN {
            return Entries(solid, list_entry_word(index, level, 0u), next_fading, list_entry_word(index, next, fade_word(gained, 0u)));
        }
        case TRANSITION_TWO_PHASE {
            if left > gained {
                return Entries(solid, list_entry_word(index, level, 0u), next_fading, list_entry_word(index, next, fade_word(2u * gained, 0u)));
            }
            return Entries(solid_list(next, mirrored), list_entry_word(index, next, 0u), fading, list_entry_word(index, level, fade_word(2u * left, 0u)));
        }
        case TRANSITION_ALPHA {
            return Entries(fading, list_entry_word(index, level, fade_word(left, 0u)), NO_LIST, 0u);
        }
        case default {
            return Entries(solid, list_entry_word(index, level, steps), NO_LIST, 0u);
        }
    }
}

struct SortedEntry {
    list: u32,
    word: u32
}

fn sorted_entry(object: LodObject, decision: u32, index: u32) -> SortedEntry {
    let steps = decision_steps(decision);
    let transition = object_flags_transition(object.flags);
    var level = decision_level(decision);
    var word = 0u;
    if transition == TRANSITION_GEOMORPH {
        word = steps;
    }
    else if transition == TRANSITION_ALPHA {
        word = fade_word(left_of(steps), 0u);
    }
    else if 2u * steps > FADE_PROGRESS {
        level = decision_next(decision);
    }
    return SortedEntry(solid_list(level, decision_mirrored(decision)), list_entry_word(index, level, word));
}

fn left_of(steps: u32) -> u32 {
    return FADE_STEPS - (steps * FADE_STEPS + FADE_PROGRESS / 2u) / FADE_PROGRESS;
}

override STAGE: u32 = 0u;

const SUM: u32 = 0u;

const PLACE: u32 = 1u;

const RUNS: u32 = 8u;

const PLACED_BLOCKS: u32 = 4u;

struct ListParams {
    objects: u32,
    blocks: u32
}

@group(0) @binding(0)
var<uniform> params: ListParams;

@group(0) @binding(1)
var<storage, read> objects: array<LodObject>;

@group(0) @binding(2)
var<storage, read> block_objects: array<u32>;

@group(0) @binding(3)
var<storage, read> decisions: array<u32>;

@group(0) @binding(4)
var<storage, read_write> counts: array<u32>;

@group(0) @binding(5)
var<storage, read_write> lists: array<u32>;

@group(0) @binding(6)
var<storage, read_write> arguments: array<SceneDraw>;

var<workgroup> sums: array<u32, 256>;

var<workgroup> members: array<atomic<u32>, 256>;

fn sum(object: LodObject, lane: u32) {
    let list = lane % OBJECT_LISTS;
    let run = lane / OBJECT_LISTS;
    let blocks = object.instances / BLOCK;
    let length = (blocks + RUNS - 1u) / RUNS;
    let first = object.first / BLOCK;
    let begin = first + min(run * length, blocks);
    let end = first + min((run + 1u) * length, blocks);
    var total = 0u;
    for (var block = begin; block < end; block++) {
        total += counts[OBJECT_LISTS * block + list];
    }
    sums[lane] = total;
    workgroupBarrier();
    var before = 0u;
    var all = 0u;
    for (var other = 0u; other < RUNS; other++) {
        let others = sums[OBJECT_LISTS * other + list];
        before += select(0u, others, other < run);
        all += others;
    }
    for (var block = begin; block < end; block++) {
        let count = counts[OBJECT_LISTS * block + list];
        counts[OBJECT_LISTS * block + list] = before;
        before += count;
    }
    for (var part = run; part < object.parts; part += RUNS) {
        arguments[object.first_draw + OBJECT_LISTS * part + list].instance_count = all;
    }
}

fn mark(list: u32, lane: u32) {
    if list != NO_LIST {
        atomicOr(&members[2u * (OBJECT_LISTS * (lane / BLOCK) + list) + lane % BLOCK / 32u], 1u << (lane % 32u));
    }
}

fn write_entry(object: LodObject, block: u32, lane: u32, list: u32, entry: u32) {
    if list == NO_LIST {
        return;
    }
    let own = 2u * (OBJECT_LISTS * (lane / BLOCK) + list);
    let word = lane % BLOCK / 32u;
    var rank = countOneBits(atomicLoad(&members[own + word]) & ((1u << (lane % 32u)) - 1u));
    if word > 0u {
        rank += countOneBits(atomicLoad(&members[own]));
    }
    lists[object.first_list + list * object.instances + counts[OBJECT_LISTS * block + list] + rank] = entry;
}

fn place(block: u32, lane: u32) {
    atomicStore(&members[lane], 0u);
    workgroupBarrier();
    let index = BLOCK * block + lane % BLOCK;
    var owner = NO_OBJECT;
    if block < params.blocks {
        owner = block_objects[block];
    }
    let object = objects[select(owner, 0u, owner == NO_OBJECT)];
    var decision = 0u;
    if owner != NO_OBJECT {
        decision = decisions[index];
    }
    let entries = transition_entries(object, decision, index - object.first);
    mark(entries.first, lane);
    mark(entries.second, lane);
    workgroupBarrier();
    write_entry(object, block, lane, entries.first, entries.first_entry);
    write_entry(object, block, lane, entries.second, entries.second_entry);
}

@compute @workgroup_size(256)
fn main(@builtin(workgroup_id) group: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    let item = group.y * groups.x + group.x;
    if STAGE == PLACE {
        place(PLACED_BLOCKS * item + lane / BLOCK, lane);
    }
    else if item < params.objects {
        sum(objects[item], lane);
    }
}
