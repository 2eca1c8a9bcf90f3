// Finds how much the levels of detail of a view must be coarsened so that its triangles fit a budget (thesis A section 6.3). Each
// coarser level of an instance saves triangles once the factor of the instance's metric is large enough. A histogram sums these
// savings over the logarithm of the factor, rank by rank. The histogram gives the bin of the smallest sufficient factor. A
// second histogram divides this bin into parts. All views that share a budget add to these two histograms, stage by stage.
import package::wgsl::lod::budget_state::BudgetState;
import package::wgsl::lod::object::{BLOCK, LodObject, NO_OBJECT, NO_RANK, OBJECT_LEVELS, RANKS, UNSEEN_METRIC, decision_level, decision_next, decision_steps, metric_bits};
import package::wgsl::lod::transition::{held_level, is_faded_out, level_within, threshold_of, transition_decision};
import package::wgsl::lod::view::SelectView;

// Stage of the kernel: one of the constants below.
override STAGE: u32 = 0u;

// Stage: a thread per instance adds the instance's triangles to the sum of triangles, and the instance's savings to the bins.
const BINS: u32 = 0u;
// Stage: one workgroup finds the bin whose savings bring the triangles within the budget.
const FIND_BIN: u32 = 1u;
// Stage: a thread per instance adds the instance's savings in the found bin to the parts of this bin.
const PARTS: u32 = 2u;
// Stage: one workgroup finds the part whose savings bring the triangles within the budget, and writes the factors.
const FIND_PART: u32 = 3u;
// Stage: a thread per instance adds the triangles that the instance draws. An instance that fades counts with both levels.
const FADES: u32 = 4u;
// Stage: one thread ends all fades of the frame if the triangles with both levels of each fade exceed the budget.
const FINISH: u32 = 5u;

// Number of bins per rank.
const RANK_BINS: u32 = 1024u;
// Number of parts per bin.
const BIN_PARTS: u32 = 1024u;
// Number of bins of all ranks.
const ALL_BINS: u32 = 8192u;
// Number of parts for a doubling of the factor.
const OCTAVE: f32 = 65536.0;
// Largest factor of the metric: 2 to the power of 16.
const MAX_FACTOR: f32 = 65536.0;
// Safety margin for the rounding of `log2` and `exp2`, in parts of a bin.
const ROUNDED_PARTS: u32 = 2u;
// Time constant of the pressure's exponential fall, in seconds.
const SETTLING: f32 = 0.15;

// Parameters of the kernel `lod/budget`.
struct BudgetParams {
    // Largest number of triangles, in units of the budget.
    limit: u32,
    // Number of blocks of instances.
    blocks: u32,
}

// Sums over the instances of all views that share the budget. The atomic sums are zero between frames.
struct BudgetWork {
    // Number of triangles without a budget, in units of the budget.
    triangles: atomic<u32>,
    // Number of triangles with this frame's factors, both levels of each fade included, in units of the budget.
    fading: atomic<u32>,
    // Bin of the smallest sufficient factor. 0xffffffff if the triangles fit without a budget; `ALL_BINS` if even the coarsest
    // levels do not fit.
    bin: u32,
    // Number of triangles that remain before the savings of `bin` are subtracted.
    left: u32,
    // Savings in triangles per bin.
    bins: array<atomic<u32>, 8192>,
    // Savings in triangles per part of `bin`.
    parts: array<atomic<u32>, 1024>,
}

// Parameters of the kernel.
@group(0) @binding(0) var<uniform> params: BudgetParams;
// The view that shares the budget.
@group(0) @binding(1) var<uniform> view: SelectView;
// The objects of the scene.
// length: 1
@group(0) @binding(2) var<storage, read> objects: array<LodObject>;
// Object index of each block of instances; `NO_OBJECT` for none.
@group(0) @binding(3) var<storage, read> block_objects: array<u32>;
// Metric word of each instance in the view.
// length: BLOCK * blocks
@group(0) @binding(4) var<storage, read> metrics: array<u32>;
// Decision word of each instance in the last frame; valid if `SelectView::is_next` is 1.
// length: BLOCK * blocks
@group(0) @binding(5) var<storage, read> decisions: array<u32>;
// State of the budget. In: the state of the last frame. Out: the state of this frame.
// length: 1
@group(0) @binding(6) var<storage, read_write> state: array<BudgetState>;
// Sums and histograms of the budget.
// length: 1
@group(0) @binding(7) var<storage, read_write> work: array<BudgetWork>;

// Savings in triangles of each of 256 runs. A run is a range of consecutive bins or parts.
var<workgroup> runs: array<u32, 256>;
// Result of `find_run`: the index of the run, and the number of remaining triangles.
var<workgroup> found: array<u32, 2>;

// Number of triangles of a level, in units of the budget.
fn triangles_of(object: LodObject, level: u32) -> u32 {
    return object.triangles[level >> 2u][level & 3u];
}

// Index of a part of a rank. For this part and all later parts, `factor_at` is at least `factor`.
fn part_of(factor: f32) -> u32 {
    return u32(ceil(max(log2(factor), 0.0) * OCTAVE)) + ROUNDED_PARTS;
}

// Factor of the metric at a part of a rank, 1 to `MAX_FACTOR`.
fn factor_at(part: u32) -> f32 {
    return min(exp2(f32(part) / OCTAVE), MAX_FACTOR);
}

// State of a visible instance for the choice of its level.
struct Chosen {
    // Object of the instance.
    object: LodObject,
    // Metric of the instance without a budget.
    metric: f32,
    // Decision word of the view in the last frame; 0 if there is none.
    last: u32,
    // Level that hysteresis holds, or `NO_LEVEL`.
    held: u32,
    // Level of the instance without a budget.
    level: u32,
    // Whether the instance counts: the view sees it, and it has not faded out.
    is_seen: bool,
}

// State of the instance at `index` for the choice of its level. The instance does not count if its block belongs to no object.
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

// Adds the savings of an instance's coarser levels. The savings of a level go to the bin or part of the factor at which the
// instance reaches the level.
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

// Adds the triangles that an instance draws with this frame's factors. An instance that fades counts with both levels.
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

// Finds the first run that brings `triangles` within the limit: the sum of the savings up to and including this run suffices.
// Returns the run's index, 256 if there is none, and the triangles that remain before the run's savings are subtracted.
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
        // No bin is needed if the triangles fit without savings.
        work[0].bin = select(bin, 0xffffffffu, left <= params.limit && bin == 0u);
        work[0].left = left;
    }
    workgroupBarrier();
    for (var bin = lane * length; bin < (lane + 1u) * length; bin++) {
        atomicStore(&work[0].bins[bin], 0u);
    }
}

// Finds the part, within the found bin, whose savings bring the triangles within the limit. Writes the state and clears the
// parts.
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
        // The factor at the start of a part already gives all savings of the part.
        let needed = select(0u, BIN_PARTS * min(work[0].bin, ALL_BINS - 1u) + max(part, 1u) - 1u, is_needed);
        write_state(select(needed, BIN_PARTS * ALL_BINS - 1u, is_missed), is_missed);
    }
    workgroupBarrier();
    for (var part = lane * length; part < (lane + 1u) * length; part++) {
        atomicStore(&work[0].parts[part], 0u);
    }
}

// Writes the factors of all ranks. The pressure rises to `needed` at once. If it is above `needed`, it falls towards `needed`
// with the time constant `SETTLING`.
fn write_state(needed: u32, is_missed: bool) {
    let last = select(needed, state[0].pressure, view.is_next != 0u);
    let ahead = f32(last - min(needed, last)) * exp(-view.seconds / SETTLING);
    let pressure = min(needed + u32(ahead), BIN_PARTS * ALL_BINS - 1u);
    let size = RANK_BINS * BIN_PARTS;
    for (var rank = 0u; rank < 12u; rank++) {
        // Ranks below the pressure's rank are at their coarsest. Ranks above it are not coarsened.
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
