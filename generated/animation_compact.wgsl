// relievo animation/compact: generated from kernels/animation/compact.wgsl

struct Lod {
    omega: u32,
    allowed: u32,
    weight: u32,
    flags: u32
}

const LOD_HIDDEN: u32 = 1u;

const LOD_FORCED: u32 = 2u;

const OMEGA_ONE: u32 = 65536u;

const FULL_WEIGHT: u32 = 65535u;

struct ClipClock {
    row: u32,
    fraction_and_reason: u32,
    clip: u32,
    ahead_row: u32,
    ahead_fraction: u32
}

const FRACTION_ONE: u32 = 65536u;

const UPDATE_REASON_FREE: u32 = 0u;

const UPDATE_REASON_HIDDEN: u32 = 1u;

const UPDATE_REASON_FORCED: u32 = 2u;

const UPDATE_REASON_BLENDED: u32 = 3u;

fn update_reason_of(clip_clock: ClipClock) -> u32 {
    return progress_reason(clip_clock.fraction_and_reason);
}

fn is_ahead(clip_clock: ClipClock) -> bool {
    return clip_clock.ahead_row != clip_clock.row || clip_clock.ahead_fraction != fraction_of(clip_clock);
}

fn fraction_of(clip_clock: ClipClock) -> u32 {
    return progress_fraction(clip_clock.fraction_and_reason);
}

const PAIR_AHEAD: u32 = 2147483648u;

fn progress_word(fraction: u32, reason: u32) -> u32 {
    return fraction | (reason << 20u);
}

fn progress_fraction(word: u32) -> u32 {
    return word & 1048575u;
}

fn progress_reason(word: u32) -> u32 {
    return word >> 20u;
}

fn lod_flags_word(bits: u32, tier: u32) -> u32 {
    return bits | (tier << 8u);
}

fn lod_flags_bits(word: u32) -> u32 {
    return word & 255u;
}

fn lod_flags_tier(word: u32) -> u32 {
    return (word >> 8u) & 255u;
}

struct Slot {
    bone: u32,
    parent: u32,
    subtree: u32
}

struct Chain {
    first: u32,
    count: u32
}

const NO_PARENT: u32 = 4294967295u;

const CONTINUES: u32 = 4294967294u;

fn nonuniform(value: u32, thread: u32) -> u32 {
    return select(0u, value, thread != 4294967295u);
}

fn rows_of_workgroups(groups: u32, most: u32) -> vec3<u32> {
    let x = clamp(groups, 1u, most);
    return vec3<u32>(x, (groups + x - 1u) / x, 1u);
}

override STAGE: u32 = 0;

const SPREAD = 0u;

const SCAN = 1u;

const SCATTER = 2u;

const WIDTH = 64u;

struct CompactParams {
    instances: u32,
    bones: u32,
    words: u32,
    served: u32,
    most_groups: u32
}

@group(0) @binding(0)
var<uniform> params: CompactParams;

@group(0) @binding(1)
var<storage, read_write> bits: array<u32>;

@group(0) @binding(2)
var<storage, read> slots: array<Slot>;

@group(0) @binding(3)
var<storage, read_write> updated_bones: array<u32>;

@group(0) @binding(4)
var<storage, read_write> counts: array<u32>;

@group(0) @binding(5)
var<storage, read_write> pairs: array<u32>;

@group(0) @binding(6)
var<storage, read_write> pair_dispatch: array<vec4<u32>, 1>;

@group(0) @binding(7)
var<storage, read_write> updated_instances: array<u32>;

@group(0) @binding(8)
var<storage, read_write> instance_dispatches: array<vec4<u32>>;

var<workgroup> sums: array<vec2<u32>, WIDTH>;

fn run(start: u32, end: u32) -> u32 {
    let below = select(4294967295u, (1u << (end & 31u)) - 1u, end < 32u);
    return below & (4294967295u << start);
}

fn spread(instance: u32) {
    let first_word = instance * params.words;
    let all_words = params.instances * params.words;
    var count = 0u;
    var end = 0u;
    let words = nonuniform(params.words, instance);
    for (var word = 0u; word < words; word++) {
        let chosen = bits[first_word + word];
        let first = 32u * word;
        var below = 0u;
        if end > first {
            below = run(0u, min(end - first, 32u));
        }
        var rest = chosen & ~below;
        while (rest != 0u) {
            let bit = firstTrailingBit(rest);
            end = first + bit + slots[first + bit].subtree;
            below |= run(bit, min(end - first, 32u));
            rest &= ~below;
        }
        bits[2u * all_words + first_word + word] = below;
        if below != 0u {
            updated_bones[first_word + word] |= below;
        }
        count += countOneBits(chosen);
    }
    counts[instance] = count;
}

fn dispatch_of(threads: u32) -> vec3<u32> {
    return rows_of_workgroups(threads / WIDTH + u32(threads % WIDTH > 0u), params.most_groups);
}

fn scan(lane: u32) {
    let chunk = (params.instances + WIDTH - 1u) / WIDTH;
    let first = min(lane * chunk, params.instances);
    let end = min(first + chunk, params.instances);
    var sum = vec2<u32>(0u);
    for (var instance = first; instance < end; instance++) {
        let count = counts[instance];
        sum += vec2<u32>(count, u32(count > 0u));
    }
    sums[lane] = sum;
    workgroupBarrier();
    var before = vec2<u32>(0u);
    for (var other = 0u; other < lane; other++) {
        before += sums[other];
    }
    for (var instance = first; instance < end; instance++) {
        let count = counts[instance];
        counts[instance] = before.x;
        if count > 0u {
            updated_instances[before.y] = instance;
        }
        before += vec2<u32>(count, u32(count > 0u));
    }
    if lane == WIDTH - 1u {
        pair_dispatch[0] = vec4<u32>(dispatch_of(before.x), before.x);
        instance_dispatches[0] = vec4<u32>(dispatch_of(before.y), before.y);
        let served = nonuniform(params.served, lane);
        for (var at = 1u; at <= served; at++) {
            let each = instance_dispatches[at].w;
            instance_dispatches[at] = vec4<u32>(dispatch_of(before.y * each), each);
        }
    }
}

fn scatter(index: u32) {
    let instance = index / params.words;
    if instance >= params.instances {
        return;
    }
    let first_word = instance * params.words;
    var at = counts[instance];
    for (var word = first_word; word < index; word++) {
        at += countOneBits(bits[word]);
    }
    let first_slot = 32u * (index - first_word);
    let ahead = bits[params.instances * params.words + index];
    var rest = bits[index];
    while (rest != 0u) {
        let bit = firstTrailingBit(rest);
        let pair = instance * params.bones + slots[first_slot + bit].bone;
        pairs[at] = select(pair, pair | PAIR_AHEAD, (ahead & (1u << bit)) != 0u);
        rest &= rest - 1u;
        at++;
    }
}

@compute @workgroup_size(WIDTH)
fn main(@builtin(global_invocation_id) id: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>) {
    let index = id.y * groups.x * WIDTH + id.x;
    if STAGE == SCAN {
        scan(index);
    }
    else if STAGE == SCATTER {
        scatter(index);
    }
    else if index < params.instances {
        spread(index);
    }
}
