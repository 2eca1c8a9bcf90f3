// Clustering of vertices in the cells of a grid (Rossignac and Borrel 1993), after DeCoro and Tatarchuk, "Real-time Mesh
// Simplification Using the GPU", I3D 2007. Positions are whole numbers of quanta, and sums and divisions are those of
// integers, so that every device gives the same mesh. The cells that are used lie in a hash table. Where a cell lands there
// depends on the order of threads, but nothing else does: a cell is known by its leader, the vertex of the lowest index.

// One of the constants below.
override STAGE: u32 = 0u;

// A thread for each vertex finds its cell's entry, and the cell's leader.
const INSERT: u32 = 0u;
// A thread for each vertex adds it to its cell's sum.
const SUM: u32 = 1u;
// A thread for each vertex divides the sum of a cell that it leads, and one for each block marks what it keeps.
const MEAN: u32 = 2u;
// A thread for each vertex: the least distance of a cell's vertices to their mean.
const NEAREST: u32 = 3u;
// A thread for each vertex: the lowest vertex at that distance.
const SOURCE: u32 = 4u;
// One workgroup turns the counts of blocks into the places of what they keep.
const SCAN: u32 = 5u;
// A thread for each block of vertices writes the representatives of the cells that they lead.
const REPRESENT: u32 = 6u;
// A thread for each block of triangles writes those that keep three cells.
const CONNECT: u32 = 7u;

const LANES = 64u;
// Vertices or triangles of a block.
const BLOCK: u32 = 64u;
// Words of a block: how many it keeps, which SCAN replaces by what those before it keep; and a bit for each that it keeps.
const BLOCK_WORDS: u32 = 3u;

// Words of the record of a cell, which is that of its leader:
const RECORD: u32 = 7u;
// the number of its vertices, then the index of the representative;
const COUNT = 0u;
// the lower halves of the sums, then the mean;
const LOW = 1u;
// the upper halves of the sums,
const HIGH = 4u;
// then the least distance and the source.
const DISTANCE = 4u;
const FROM = 5u;

// The largest magnitude of a position in quanta.
const FARTHEST: u32 = 0x40000000u;

struct ClusterParams {
    // The lowest corner of the grid in quanta.
    origin: vec3<i32>,
    // The edge of a cell in quanta, at least 1.
    size: u32,
    // From the lowest corner to the highest, in quanta.
    extent: vec3<u32>,
    // A quantum is 2 to the power of minus this number.
    exponent: i32,
    vertices: u32,
    triangles: u32,
    // Entries of the table minus 1; their number is a power of two, larger than that of the vertices.
    mask: u32,
    // How far a hash is shifted to the right.
    shift: u32,
}

// The arguments of an indexed draw, and the number of representatives.
struct ClusterCounts {
    // Three for each triangle.
    index_count: u32,
    // Always 1.
    instance_count: u32,
    // Always 0.
    first_index: u32,
    // Always 0.
    base_vertex: i32,
    // Always 0.
    first_instance: u32,
    // Number of representatives.
    representatives: u32,
}

@group(0) @binding(0) var<uniform> params: ClusterParams;
// The bits of three floats for each vertex.
@group(0) @binding(1) var<storage, read> positions: array<u32>;
@group(0) @binding(2) var<storage, read> indices: array<u32>;
// Two words for each entry: 1 + the cell, or 0, and the complement of the leader. All are 0 at first.
@group(0) @binding(3) var<storage, read_write> table: array<atomic<u32>>;
// For each vertex its entry in the table, then the leader of its cell; these lie close together, since triangles look up those
// of their corners. Then `RECORD` words for each vertex, 0 at first.
@group(0) @binding(4) var<storage, read_write> records: array<atomic<u32>>;
// `BLOCK_WORDS` for each block of vertices, then for each block of triangles.
@group(0) @binding(5) var<storage, read_write> blocks: array<u32>;
// The bits of a position, and the vertex that is nearest to it.
@group(0) @binding(6) var<storage, read_write> representatives: array<vec4<u32>>;
// Three representatives for each triangle.
@group(0) @binding(7) var<storage, read_write> clustered: array<u32>;
@group(0) @binding(8) var<storage, read_write> counts: ClusterCounts;

var<workgroup> sums: array<u32, LANES>;

// A float as a whole number of quanta, halves away from zero. What is larger than the grid can be is cut off.
fn quantized(bits: u32) -> i32 {
    let biased = i32((bits >> 23u) & 0xffu);
    let fraction = bits & 0x7fffffu;
    let mantissa = select(fraction | 0x800000u, fraction, biased == 0);
    let shift = max(biased, 1) - 150 + params.exponent;
    let left = mantissa << u32(clamp(shift, 0, 6));
    let right = u32(clamp(-shift, 1, 25));
    let rounded = (mantissa + (1u << (right - 1u))) >> right;
    let magnitude = select(select(left, FARTHEST, shift > 6), rounded, shift < 0);
    return select(i32(magnitude), -i32(magnitude), (bits >> 31u) == 1u);
}

// A vertex's offset from the lowest corner of the grid in quanta, cut off at the grid's sides.
fn offset_of(vertex: u32) -> vec3<u32> {
    let place = vec3<i32>(
        quantized(positions[3u * vertex]),
        quantized(positions[3u * vertex + 1u]),
        quantized(positions[3u * vertex + 2u]),
    );
    let from_origin = bitcast<vec3<u32>>(max(place, params.origin)) - bitcast<vec3<u32>>(params.origin);
    return min(from_origin, params.extent);
}

// The cell of an offset. A quotient of floats is at most 1024, so that rounding makes it wrong by one at most: integers say
// whether it is.
fn cell_of(offset: vec3<u32>) -> vec3<u32> {
    let size = vec3<u32>(params.size);
    let near = vec3<u32>(vec3<f32>(offset) / vec3<f32>(size));
    let product = near * size;
    let more = select(near, near + 1u, offset - product >= size);
    return select(more, near - 1u, product > offset);
}

// Where the record of a cell begins, by its leader.
fn record_of(leader: u32) -> u32 {
    return params.vertices + RECORD * leader;
}

fn insert(vertex: u32) {
    let cell = cell_of(offset_of(vertex));
    let key = 1u + (cell.x | (cell.y << 10u) | (cell.z << 20u));
    var entry = (key * 0x9e3779b9u) >> params.shift;
    var is_found = false;
    while !is_found {
        let old = atomicLoad(&table[2u * entry]);
        if old == key {
            is_found = true;
        } else if old == 0u {
            // If another thread has taken the entry, or the exchange fails for no reason, the next turn looks again.
            is_found = atomicCompareExchangeWeak(&table[2u * entry], 0u, key).exchanged;
        } else {
            entry = (entry + 1u) & params.mask;
        }
    }
    atomicMax(&table[2u * entry + 1u], ~vertex);
    atomicStore(&records[vertex], entry);
}

// The carries of the lower halves are counted in the upper ones, whatever the order of additions is.
fn add(vertex: u32) {
    let entry = atomicLoad(&records[vertex]);
    let leader = ~atomicLoad(&table[2u * entry + 1u]);
    atomicStore(&records[vertex], leader);
    let offset = offset_of(vertex);
    let inside = offset - cell_of(offset) * params.size;
    atomicAdd(&records[record_of(leader) + COUNT], 1u);
    for (var axis = 0u; axis < 3u; axis++) {
        let old = atomicAdd(&records[record_of(leader) + LOW + axis], inside[axis]);
        if old + inside[axis] < old {
            atomicAdd(&records[record_of(leader) + HIGH + axis], 1u);
        }
    }
}

// A sum of 64 bits divided by a count, halves upwards. The quotient has 32 bits: the upper half is below the count.
fn divided(low: u32, high: u32, count: u32) -> u32 {
    let sum = low + (count >> 1u);
    var rest = high + u32(sum < low);
    if rest == 0u {
        return sum / count;
    }
    var quotient = 0u;
    for (var bit = 0u; bit < 32u; bit++) {
        let top = rest >> 31u;
        rest = (rest << 1u) | ((sum >> (31u - bit)) & 1u);
        let fits = top == 1u || rest >= count;
        rest -= select(0u, count, fits);
        quotient = (quotient << 1u) | u32(fits);
    }
    return quotient;
}

fn mean(vertex: u32) {
    let record = record_of(vertex);
    if atomicLoad(&records[vertex]) != vertex {
        return;
    }
    let corner = cell_of(offset_of(vertex)) * params.size;
    let count = atomicLoad(&records[record + COUNT]);
    for (var axis = 0u; axis < 3u; axis++) {
        let low = atomicLoad(&records[record + LOW + axis]);
        let quotient = divided(low, atomicLoad(&records[record + HIGH + axis]), count);
        atomicStore(&records[record + LOW + axis], corner[axis] + quotient);
    }
    atomicStore(&records[record + DISTANCE], 0xffffffffu);
    atomicStore(&records[record + FROM], 0xffffffffu);
}

// The leaders of a triangle's corners, and whether they differ.
fn corners_of(triangle: u32) -> vec4<u32> {
    let a = atomicLoad(&records[indices[3u * triangle]]);
    let b = atomicLoad(&records[indices[3u * triangle + 1u]]);
    let c = atomicLoad(&records[indices[3u * triangle + 2u]]);
    return vec4<u32>(a, b, c, u32(a != b && b != c && c != a));
}

fn blocks_of(count: u32) -> u32 {
    return count / BLOCK + u32(count % BLOCK > 0u);
}

// Marks what a block keeps.
fn mark(block: u32) {
    let vertex_blocks = blocks_of(params.vertices);
    if block >= vertex_blocks + blocks_of(params.triangles) {
        return;
    }
    var kept = vec2<u32>(0u);
    if block < vertex_blocks {
        let first = BLOCK * block;
        let count = min(BLOCK, params.vertices - first);
        for (var at = 0u; at < count; at++) {
            let bit = u32(atomicLoad(&records[first + at]) == first + at) << (at % 32u);
            kept |= select(vec2<u32>(bit, 0u), vec2<u32>(0u, bit), at >= 32u);
        }
    } else {
        let first = BLOCK * (block - vertex_blocks);
        let count = min(BLOCK, params.triangles - first);
        for (var at = 0u; at < count; at++) {
            let bit = corners_of(first + at).w << (at % 32u);
            kept |= select(vec2<u32>(bit, 0u), vec2<u32>(0u, bit), at >= 32u);
        }
    }
    blocks[BLOCK_WORDS * block] = countOneBits(kept.x) + countOneBits(kept.y);
    blocks[BLOCK_WORDS * block + 1u] = kept.x;
    blocks[BLOCK_WORDS * block + 2u] = kept.y;
}

// The largest distance along an axis between a vertex and the mean of its cell.
fn distance_of(vertex: u32, leader: u32) -> u32 {
    let record = record_of(leader) + LOW;
    let center = vec3<u32>(
        atomicLoad(&records[record]),
        atomicLoad(&records[record + 1u]),
        atomicLoad(&records[record + 2u]),
    );
    let offset = offset_of(vertex);
    let apart = max(offset, center) - min(offset, center);
    return max(max(apart.x, apart.y), apart.z);
}

fn measure(vertex: u32) {
    let leader = atomicLoad(&records[vertex]);
    atomicMin(&records[record_of(leader) + DISTANCE], distance_of(vertex, leader));
}

fn choose(vertex: u32) {
    let leader = atomicLoad(&records[vertex]);
    if distance_of(vertex, leader) == atomicLoad(&records[record_of(leader) + DISTANCE]) {
        atomicMin(&records[record_of(leader) + FROM], vertex);
    }
}

// Replaces the counts of `length` blocks by the sums of those before each, and returns the sum of all.
fn scan(first: u32, length: u32, lane: u32) -> u32 {
    let run = length / LANES + 1u;
    let begin = first + min(lane * run, length);
    let end = first + min(lane * run + run, length);
    var own = 0u;
    for (var block = begin; block < end; block++) {
        own += blocks[BLOCK_WORDS * block];
    }
    workgroupBarrier();
    sums[lane] = own;
    workgroupBarrier();
    var before = 0u;
    var all = 0u;
    for (var other = 0u; other < LANES; other++) {
        before += select(0u, sums[other], other < lane);
        all += sums[other];
    }
    for (var block = begin; block < end; block++) {
        let kept = blocks[BLOCK_WORDS * block];
        blocks[BLOCK_WORDS * block] = before;
        before += kept;
    }
    return all;
}

fn scan_all(lane: u32) {
    let vertex_blocks = blocks_of(params.vertices);
    let kept_vertices = scan(0u, vertex_blocks, lane);
    let kept_triangles = scan(vertex_blocks, blocks_of(params.triangles), lane);
    if lane == 0u {
        counts = ClusterCounts(3u * kept_triangles, 1u, 0u, 0, 0u, kept_vertices);
    }
}

// The bits of the float that is nearest to a whole number of quanta, of two the even one.
fn float_of(quanta: i32) -> u32 {
    let magnitude = u32(abs(quanta));
    let top = i32(firstLeadingBit(magnitude));
    let dropped = max(top - 23, params.exponent - 149);
    let left = magnitude << u32(clamp(-dropped, 0, 31));
    let right = u32(clamp(dropped, 1, 7));
    let whole = magnitude >> right;
    let part = magnitude - (whole << right);
    let half = 1u << (right - 1u);
    let rounded = whole + u32(part > half || (part == half && (whole & 1u) == 1u));
    let mantissa = select(left, rounded, dropped > 0);
    let bits = (u32(dropped - params.exponent + 149) << 23u) + mantissa;
    return select(bits | select(0u, 0x80000000u, quanta < 0), 0u, mantissa == 0u);
}

// Writes the representative of a cell, which a vertex leads.
fn represent(vertex: u32, slot: u32) {
    let record = record_of(vertex);
    let x = bitcast<i32>(atomicLoad(&records[record + LOW])) + params.origin.x;
    let y = bitcast<i32>(atomicLoad(&records[record + LOW + 1u])) + params.origin.y;
    let z = bitcast<i32>(atomicLoad(&records[record + LOW + 2u])) + params.origin.z;
    let source = atomicLoad(&records[record + FROM]);
    representatives[slot] = vec4<u32>(float_of(x), float_of(y), float_of(z), source);
    atomicStore(&records[record + COUNT], slot);
}

// Writes a triangle that stays.
fn connect(triangle: u32, slot: u32) {
    for (var corner = 0u; corner < 3u; corner++) {
        let leader = atomicLoad(&records[indices[3u * triangle + corner]]);
        clustered[3u * slot + corner] = atomicLoad(&records[record_of(leader) + COUNT]);
    }
}

// Writes what a block keeps, of `length` blocks from `first` on, in order.
fn write(block: u32, first: u32, length: u32) {
    if block >= length {
        return;
    }
    let words = BLOCK_WORDS * (first + block);
    var slot = blocks[words];
    for (var half = 0u; half < 2u; half++) {
        var kept = blocks[words + 1u + half];
        while kept != 0u {
            let item = BLOCK * block + 32u * half + firstTrailingBit(kept);
            kept &= kept - 1u;
            if STAGE == REPRESENT {
                represent(item, slot);
            } else {
                connect(item, slot);
            }
            slot++;
        }
    }
}

@compute @workgroup_size(64)
fn main(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) lane: u32,
) {
    let item = (group.y * groups.x + group.x) * LANES + lane;
    if STAGE == MEAN {
        if item < params.vertices {
            mean(item);
        }
        mark(item);
    } else if STAGE == SCAN {
        scan_all(lane);
    } else if STAGE == REPRESENT {
        write(item, 0u, blocks_of(params.vertices));
    } else if STAGE == CONNECT {
        write(item, blocks_of(params.vertices), blocks_of(params.triangles));
    } else if item < params.vertices {
        if STAGE == INSERT {
            insert(item);
        } else if STAGE == SUM {
            add(item);
        } else if STAGE == NEAREST {
            measure(item);
        } else if STAGE == SOURCE {
            choose(item);
        }
    }
}
