// Lists of the instances that a view sees, for each level of detail and either orientation, in ascending order. First a
// workgroup for each object turns the counts of its blocks into the places at which their instances begin, and writes the
// numbers of instances of its draws; then a thread for each instance writes its index into its list.
import package::wgsl::lod::object::{BLOCK, LodObject, NO_OBJECT, OBJECT_LISTS, SceneDraw, decision_list, decision_morph, list_entry_word};

// One of the constants below.
override STAGE: u32 = 0u;

// A workgroup for each object sums.
const SUM: u32 = 0u;
// A thread for each instance, with barriers between those of a block.
const PLACE: u32 = 1u;

// Runs of an object's blocks that are summed side by side, each by a thread for each list.
const RUNS: u32 = 16u;
// The blocks of a workgroup that places instances.
const PLACED_BLOCKS: u32 = 4u;

struct ListParams {
    // Number of objects.
    objects: u32,
    // Number of blocks of instances.
    blocks: u32,
}

@group(0) @binding(0) var<uniform> params: ListParams;
@group(0) @binding(1) var<storage, read> objects: array<LodObject>;
// The index of the object that each block of instances belongs to, `NO_OBJECT` for none.
@group(0) @binding(2) var<storage, read> block_objects: array<u32>;
// The decision word of each instance of the blocks.
@group(0) @binding(3) var<storage, read> decisions: array<u32>;
// For each block and list the number of instances, which becomes the number of instances in the blocks before it.
@group(0) @binding(4) var<storage, read_write> counts: array<u32>;
// The lists of all objects, of list entries.
@group(0) @binding(5) var<storage, read_write> lists: array<u32>;
// For each part of each object `OBJECT_LISTS` draws.
@group(0) @binding(6) var<storage, read_write> arguments: array<SceneDraw>;

// The sum of each run, list by list.
var<workgroup> sums: array<u32, 256>;
// The instances of each block in each list, one bit each, in two words.
var<workgroup> members: array<atomic<u32>, 128>;

// The sums before each block of an object, and the object's draws.
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

// What a list has for an instance.
fn entry_of(index: u32, decision: u32) -> u32 {
    return list_entry_word(index, decision_morph(decision));
}

// Writes the index of an instance into its list.
fn place(block: u32, lane: u32) {
    if lane < 2u * OBJECT_LISTS * PLACED_BLOCKS {
        atomicStore(&members[lane], 0u);
    }
    workgroupBarrier();
    let index = BLOCK * block + lane % BLOCK;
    var owner = NO_OBJECT;
    if block < params.blocks {
        owner = block_objects[block];
    }
    var decision = 0u;
    if owner != NO_OBJECT {
        decision = decisions[index];
    }
    let bit = lane % 32u;
    let word = lane % BLOCK / 32u;
    let list = max(decision_list(decision), 1u) - 1u;
    let own = 2u * (OBJECT_LISTS * (lane / BLOCK) + list);
    if decision > 0u {
        atomicOr(&members[own + word], 1u << bit);
    }
    workgroupBarrier();
    if decision > 0u {
        let object = objects[owner];
        var rank = countOneBits(atomicLoad(&members[own + word]) & ((1u << bit) - 1u));
        if word > 0u {
            rank += countOneBits(atomicLoad(&members[own]));
        }
        let to = object.first_list + list * object.instances + counts[OBJECT_LISTS * block + list] + rank;
        lists[to] = entry_of(index - object.first, decision);
    }
}

@compute @workgroup_size(256)
fn main(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) lane: u32,
) {
    let item = group.y * groups.x + group.x;
    if STAGE == PLACE {
        place(PLACED_BLOCKS * item + lane / BLOCK, lane);
    } else if item < params.objects {
        sum(objects[item], lane);
    }
}
