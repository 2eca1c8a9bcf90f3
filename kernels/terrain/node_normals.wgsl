// Normals of nodes of endless terrain at twice the nodes' resolution, from regions of finer heights. One thread handles one normal.
import package::wgsl::terrain::slope::slope_normal;

// Parameters of the kernel `terrain/node_normals`.
struct NodeNormalsParams {
    // Number of samples along an edge of a region.
    width: u32,
    // Number of normals along an edge of a node.
    size: u32,
    // Column and row of the first normal in a region.
    first: u32,
    // Number of samples of the region from one normal to the next.
    step: u32,
    // Twice the distance between normals, in 1/65536 world units.
    run: f32,
}

// Parameters of the kernel.
@group(0) @binding(0) var<uniform> params: NodeNormalsParams;
// Heights of the regions, one after the other, row by row, in 1/65536 world units.
@group(0) @binding(1) var<storage, read> heights: array<i32>;
// Index of each region's node; nodes beyond the end of `normals` are not written.
@group(0) @binding(2) var<storage, read> slots: array<u32>;
// Out: the normals of the nodes, one after the other, row by row: x in the low half of a word and z in the high half, in 1/32767.
@group(0) @binding(3) var<storage, read_write> normals: array<u32>;

// Height of a sample of a region.
fn height_at(region: u32, x: u32, y: u32) -> i32 {
    return heights[(region * params.width + y) * params.width + x];
}

@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    let slot = slots[id.z];
    let points = params.size * params.size;
    if max(id.x, id.y) >= params.size || slot >= arrayLength(&normals) / points {
        return;
    }
    let at = params.first + params.step * id.xy;
    let gradient = vec2<i32>(
        height_at(id.z, at.x + params.step, at.y) - height_at(id.z, at.x - params.step, at.y),
        height_at(id.z, at.x, at.y + params.step) - height_at(id.z, at.x, at.y - params.step));
    normals[slot * points + id.y * params.size + id.x] = pack2x16snorm(slope_normal(gradient, params.run).xz);
}
