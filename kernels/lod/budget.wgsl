// Finds by how much the levels of detail of a view are coarsened so that its triangles fit a budget (A section 6.3). Each coarser
// level of an instance saves triangles from some factor of its metric on. A histogram has these savings over the logarithm of the
// factor, rank by rank. It gives the bin of the least sufficient factor. A second histogram divides this bin into parts. Views
// that share a budget add to the same histograms, stage by stage.
import package::wgsl::lod::budget_state::BudgetState;
import package::wgsl::lod::object::{BLOCK, LodObject, NO_OBJECT, NO_RANK, OBJECT_LEVELS, RANKS, UNSEEN_METRIC, decision_level, decision_next, decision_steps, metric_bits};
import package::wgsl::lod::transition::{held_level, is_faded_out, level_within, threshold_of, transition_decision};
import package::wgsl::lod::view::SelectView;

// One of the constants below.
override STAGE: u32 = 0u;

// Stage: a thread per instance adds its triangles, and its savings to the bins.
const BINS: u32 = 0u;
// Stage: one workgroup finds the bin at which the triangles fit.
const FIND_BIN: u32 = 1u;
// Stage: a thread per instance adds its savings in that bin to the parts of the bin.
const PARTS: u32 = 2u;
// Stage: one workgroup finds the part, and writes the factors.
const FIND_PART: u32 = 3u;
// Stage: a thread per instance adds the triangles of both levels of its fade.
const FADES: u32 = 4u;
// Stage: one thread ends the fades if they do not fit.
const FINISH: u32 = 5u;

// Number of bins per rank, and of parts per bin.
const RANK_BINS: u32 = 1024u;
const BIN_PARTS: u32 = 1024u;
// Number of bins.
const ALL_BINS: u32 = 8192u;
// Number of parts that a doubling of the factor takes.
const OCTAVE: f32 = 65536.0;
// Largest factor: 2 to the power of 16.
const MAX_FACTOR: f32 = 65536.0;
// Safety margin for the rounding of `log2` and `exp2`, in parts.
const ROUNDED_PARTS: u32 = 2u;
// Time constant of the pressure's exponential decay, in seconds.
const SETTLING: f32 = 0.15;

struct BudgetParams {
    // Largest number of triangles, in units.
    limit: u32,
    // Number of blocks of instances.
    blocks: u32,
}

// Sums over the instances of all views that share the budget. All are zero between frames.
struct BudgetWork {
    // `triangles`: their number without a budget. `fading`: their number with this frame's factors, both levels of each fade
    // included.
    triangles: atomic<u32>,
    fading: atomic<u32>,
    // `bin`: the bin of the least sufficient factor; 0xffffffff if the triangles fit without a budget, `ALL_BINS` if even the
    // coarsest levels do not fit. `left`: the triangles that remain before the savings of this bin.
    bin: u32,
    left: u32,
    // Savings in triangles, per bin, and per part of `bin`.
    bins: array<atomic<u32>, 8192>,
    parts: array<atomic<u32>, 1024>,
}

@group(0) @binding(0) var<uniform> params: BudgetParams;
// The view.
@group(0) @binding(1) var<uniform> view: SelectView;
// The objects.
// length: 1
@group(0) @binding(2) var<storage, read> objects: array<LodObject>;
// Object index of each block of instances; `NO_OBJECT` for none.
@group(0) @binding(3) var<storage, read> block_objects: array<u32>;
// The metric word of each instance.
// length: BLOCK * blocks
@group(0) @binding(4) var<storage, read> metrics: array<u32>;
// Per instance: the decision of the last frame, if `SelectView::is_next` is 1.
// length: BLOCK * blocks
@group(0) @binding(5) var<storage, read> decisions: array<u32>;
// In: the state of the last frame. Out: that of this frame.
// length: 1
@group(0) @binding(6) var<storage, read_write> state: array<BudgetState>;
// The sums.
// length: 1
@group(0) @binding(7) var<storage, read_write> work: array<BudgetWork>;

// Savings in triangles, per run of consecutive bins or parts.
var<workgroup> runs: array<u32, 256>;
// The result of `find_run`.
var<workgroup> found: array<u32, 2>;

// Number of triangles of a level.
fn triangles_of(object: LodObject, level: u32) -> u32 {
    return object.triangles[level >> 2u][level & 3u];
}

// Index of a part of a rank. From this part on, `factor_at` is at least `factor`.
fn part_of(factor: f32) -> u32 {
    return u32(ceil(max(log2(factor), 0.0) * OCTAVE)) + ROUNDED_PARTS;
}

// The factor at a part of a rank.
fn factor_at(part: u32) -> f32 {
    return min(exp2(f32(part) / OCTAVE), MAX_FACTOR);
}

// A visible instance, as its levels are chosen.
struct Chosen {
    object: LodObject,
    // Its metric without a budget.
    metric: f32,
    // The view's decision in the last frame, and the level that hysteresis holds.
    last: u32,
    held: u32,
    // Its level without a budget.
    level: u32,
    // Whether it counts.
    is_seen: bool,
}

fn chosen(index: u32) -> Chosen {
    var result: Chosen;
    if index / BLOCK >= params.blocks || block_objects[index / BLOCK] == NO_OBJECT {
        return result;
    }
    let word = metrics[index];
    result.object = objects[block_objects[index / BLOCK]];
    result.metric = bitcast<f32>(metric_bits(word));
    result.last = select(0u, decisions[index], view.is_next != 0u);
    result.held = held_level(result.object, result.last);
    result.level = level_within(result.object, result.metric, result.held);
    result.is_seen = word != UNSEEN_METRIC && !is_faded_out(result.object, result.metric);
    return result;
}

// Adds the savings of an instance, level by level, to the bin or part of the factor at which it reaches the level.
fn add_savings(chosen: Chosen, stage: u32) {
    if !chosen.is_seen {
        return;
    }
    var before = triangles_of(chosen.object, chosen.level);
    if stage == BINS {
        atomicAdd(&work[0].triangles, before);
    }
    if chosen.object.rank >= RANKS {
        return;
    }
    for (var level = chosen.level + 1u; level < min(chosen.object.levels, OBJECT_LEVELS); level++) {
        let floor = chosen.object.metric_floor;
        let factor = (threshold_of(chosen.object, level, chosen.held) + floor) / (chosen.metric + floor);
        let saved = before - min(triangles_of(chosen.object, level), before);
        if factor >= 0.5 * MAX_FACTOR || saved == 0u {
            continue;
        }
        before -= saved;
        let part = part_of(factor);
        let bin = RANK_BINS * chosen.object.rank + part / BIN_PARTS;
        if stage == BINS {
            atomicAdd(&work[0].bins[bin], saved);
        } else if bin == work[0].bin {
            atomicAdd(&work[0].parts[part % BIN_PARTS], saved);
        }
    }
}

// Adds the triangles that an instance draws with this frame's factors, both levels of its fade included.
fn add_fades(chosen: Chosen, index: u32) {
    if !chosen.is_seen {
        return;
    }
    let object = chosen.object;
    let factor = state[0].factors[object.rank >> 2u][object.rank & 3u];
    let decision = transition_decision(object, chosen.metric, factor, 0u, chosen.last, view.seconds, false);
    var drawn = triangles_of(object, decision_level(decision));
    if decision_steps(decision) > 0u && decision_next(decision) != decision_level(decision) {
        drawn += triangles_of(object, decision_next(decision));
    }
    atomicAdd(&work[0].fading, drawn);
}

// Finds the first run whose savings, with those of all runs before it, bring `triangles` within the limit. Returns the index of
// the run, 256 if there is none, and the triangles that remain before the savings of this run.
fn find_run(lane: u32, triangles: u32) -> vec2<u32> {
    workgroupBarrier();
    if lane == 0u {
        var left = triangles;
        var run = 0u;
        while run < 256u && left > params.limit && left - min(runs[run], left) > params.limit {
            left -= min(runs[run], left);
            run++;
        }
        found = array<u32, 2>(run, left);
    }
    workgroupBarrier();
    return vec2<u32>(found[0], found[1]);
}

// Finds the bin whose savings bring the triangles within the limit, and clears the bins.
fn find_bin(lane: u32) {
    let length = ALL_BINS / 256u;
    var saved = 0u;
    for (var bin = lane * length; bin < (lane + 1u) * length; bin++) {
        saved += atomicLoad(&work[0].bins[bin]);
    }
    runs[lane] = saved;
    let run = find_run(lane, atomicLoad(&work[0].triangles));
    if lane == 0u {
        var left = run.y;
        var bin = run.x * length;
        while bin < ALL_BINS && left > params.limit && left - min(atomicLoad(&work[0].bins[bin]), left) > params.limit {
            left -= min(atomicLoad(&work[0].bins[bin]), left);
            bin++;
        }
        // Nothing is to be saved: no bin.
        work[0].bin = select(bin, 0xffffffffu, left <= params.limit && bin == 0u);
        work[0].left = left;
    }
    workgroupBarrier();
    for (var bin = lane * length; bin < (lane + 1u) * length; bin++) {
        atomicStore(&work[0].bins[bin], 0u);
    }
}

// Finds the part of the bin, writes the state, and clears the parts.
fn find_part(lane: u32) {
    let length = BIN_PARTS / 256u;
    var saved = 0u;
    for (var part = lane * length; part < (lane + 1u) * length; part++) {
        saved += atomicLoad(&work[0].parts[part]);
    }
    runs[lane] = saved;
    let run = find_run(lane, work[0].left);
    if lane == 0u {
        var left = run.y;
        var part = run.x * length;
        while part < BIN_PARTS && left > params.limit {
            left -= min(atomicLoad(&work[0].parts[part]), left);
            part++;
        }
        let is_needed = work[0].bin != 0xffffffffu;
        let is_missed = is_needed && work[0].bin >= ALL_BINS;
        // The savings of a part begin with it.
        let needed = select(0u, BIN_PARTS * min(work[0].bin, ALL_BINS - 1u) + max(part, 1u) - 1u, is_needed);
        write_state(select(needed, BIN_PARTS * ALL_BINS - 1u, is_missed), is_missed);
    }
    workgroupBarrier();
    for (var part = lane * length; part < (lane + 1u) * length; part++) {
        atomicStore(&work[0].parts[part], 0u);
    }
}

// Writes the factors. The pressure rises to `needed` at once, and falls to it with the time constant `SETTLING`.
fn write_state(needed: u32, is_missed: bool) {
    let last = select(needed, state[0].pressure, view.is_next != 0u);
    let ahead = f32(last - min(needed, last)) * exp(-view.seconds / SETTLING);
    let pressure = min(needed + u32(ahead), BIN_PARTS * ALL_BINS - 1u);
    let size = RANK_BINS * BIN_PARTS;
    for (var rank = 0u; rank < 12u; rank++) {
        // Ranks below that of the pressure are as coarse as they can be, and those above it are spared.
        let begin = min(rank, RANKS) * size;
        let part = min(pressure - min(begin, pressure), size - 1u);
        state[0].factors[rank >> 2u][rank & 3u] = select(factor_at(part), 1.0, rank >= NO_RANK);
    }
    state[0].pressure = pressure;
    state[0].is_missed = u32(is_missed);
}

// Ends all fades of the frame if the triangles with both levels of each fade exceed the limit.
fn finish() {
    let drawn = atomicLoad(&work[0].fading);
    state[0].ends_fades = u32(drawn > params.limit);
    state[0].triangles = drawn;
    atomicStore(&work[0].fading, 0u);
    atomicStore(&work[0].triangles, 0u);
}

@compute @workgroup_size(256)
fn main(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) lane: u32,
) {
    let index = 256u * (group.y * groups.x + group.x) + lane;
    switch STAGE {
        case FIND_BIN: {
            find_bin(lane);
        }
        case FIND_PART: {
            find_part(lane);
        }
        case FINISH: {
            if lane == 0u {
                finish();
            }
        }
        case FADES: {
            add_fades(chosen(index), index);
        }
        default: {
            add_savings(chosen(index), STAGE);
        }
    }
}
