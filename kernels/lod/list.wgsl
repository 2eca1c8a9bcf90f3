// Lists of the instances that a view sees, per level of detail and orientation (mirrored or not), in ascending order. In the
// first stage, a workgroup per object computes prefix sums of its blocks' counts, and the instance counts of its draws. In the
// second stage, a thread per instance writes the instance's list entry.
import package::wgsl::lod::object::{BLOCK, LodObject, NO_OBJECT, OBJECT_LISTS, SceneDraw};
import package::wgsl::lod::transition::{NO_LIST, transition_entries};

// Stage of the kernel: one of the constants below.
override STAGE: u32 = 0u;

// Stage: a workgroup per object computes prefix sums of the counts of its blocks.
const SUM: u32 = 0u;
// Stage: a thread per instance writes list entries. The threads of a block synchronize at barriers.
const PLACE: u32 = 1u;

// Number of runs into which an object's blocks are divided. The runs are summed in parallel, with one thread per run and list.
const RUNS: u32 = 8u;
// Number of blocks per workgroup in the stage `PLACE`.
const PLACED_BLOCKS: u32 = 4u;

// Parameters of the kernel `lod/list`.
struct ListParams {
    // Number of objects.
    objects: u32,
    // Number of blocks of instances.
    blocks: u32,
}

// Parameters of the kernel.
@group(0) @binding(0) var<uniform> params: ListParams;
// The objects of the scene.
@group(0) @binding(1) var<storage, read> objects: array<LodObject>;
// Object index of each block of instances; `NO_OBJECT` for none.
@group(0) @binding(2) var<storage, read> block_objects: array<u32>;
// Decision word of each instance.
@group(0) @binding(3) var<storage, read> decisions: array<u32>;
// Counts per block and list. In: the number of instances. Out: the number of instances in the object's preceding blocks.
@group(0) @binding(4) var<storage, read_write> counts: array<u32>;
// Out: list entries of all objects.
@group(0) @binding(5) var<storage, read_write> lists: array<u32>;
// Arguments of draws: `OBJECT_LISTS` draws per part of each object. Out: their instance counts.
@group(0) @binding(6) var<storage, read_write> arguments: array<SceneDraw>;

// Number of instances per run and list.
var<workgroup> sums: array<u32, 256>;
// Members of each list, per block and list: one bit per instance of the block, in two words.
var<workgroup> members: array<atomic<u32>, 256>;

// Computes the prefix sums of an object's blocks, and the instance counts of the object's draws.
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

// Marks an instance of a block as a member of a list. `lane` is the thread's index in the workgroup.
fn mark(list: u32, lane: u32) {
    if list != NO_LIST {
        atomicOr(&members[2u * (OBJECT_LISTS * (lane / BLOCK) + list) + lane % BLOCK / 32u], 1u << (lane % 32u));
    }
}

// Writes an instance's entry into a list, in the order of instances.
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

// Writes the list entries of an instance.
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
