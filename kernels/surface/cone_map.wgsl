// Cone maps of a batch of height maps, computed from their max-mip pyramids. A thread computes the cone of one bilinear cell.
// The cone stands upright on the cell's highest corner. It is made as wide as possible under one condition: a ray inside the
// cone crosses the surface at most once.
//
// A ray that crosses the surface twice leaves the surface between the two crossings, at a place where the surface falls faster
// than the ray. The cone must therefore stay above every cell where a ray from this cell can leave the surface. The cone may
// cut through cells in which the surface rises along every such ray (`rises`). The bounds hold for all points of this cell and
// of the other cell, because they use the smallest distances and the largest heights. Nodes are searched nearest first and
// skipped when they cannot narrow the cone. Nodes that look small from the cell are treated as a whole, so that the search
// takes O(log N) per cell.
import package::wgsl::dispatch::nonuniform;
import package::wgsl::surface::ray::SURFACE_WRAP;
import package::wgsl::surface::atlas::{surface_atlas_at, surface_corner_index, surface_levels};

// Ratio of distance to size at and above which a node of the pyramid is treated as a whole. Larger values give wider cones and
// a slower computation. With 4, a march saves one load in 25, and the computation of the map takes 1.5 times as long.
const OPENING: f32 = 2.0;

// Parameters of the kernel `surface/cone_map`.
struct ConeParams {
    // Number of texels of a map along x and y.
    size: vec2<u32>,
    // Number of cells of a map along x and y.
    cells: vec2<u32>,
    // Number of nodes per row of one map's pyramid.
    pitch: u32,
    // Number of rows of one map's pyramid.
    rows: u32,
    // Number of cones per row of the output.
    cone_pitch: u32,
    // Address mode: SURFACE_WRAP or SURFACE_CLAMP.
    address: u32,
}

// Parameters of the kernel.
@group(0) @binding(0) var<uniform> params: ConeParams;
// Heights of all maps, row by row, 0 to 1.
@group(0) @binding(1) var<storage, read> heights: array<f32>;
// Max-mip pyramids of all maps.
@group(0) @binding(2) var<storage, read> pyramids: array<f32>;
// Out, per cell: height of the highest corner (x), and radius of the cone in cells at height 1 above the corner (y).
@group(0) @binding(3) var<storage, read_write> cones: array<vec2<f32>>;

// Smallest rise by which a distance is divided.
const LEAST_RISE: f32 = 1e-9;
// Radius of a cone that nothing narrows, in cells at height 1 above its corner.
const WIDEST: f32 = 1e9;
// Safety factor of radii, below 1. It reduces a radius by more than rounding can increase it.
const NARROWING: f32 = 0.999999;
// Largest number of nodes that a search visits; no search reaches it.
const MAX_VISITS: u32 = 65536u;

// Largest height in a node of a map's pyramid.
fn highest(map: u32, level: u32, node: vec2<i32>) -> f32 {
    let at = vec2<u32>(surface_atlas_at(params.cells, level, node));
    return pyramids[(map * params.rows + at.y) * params.pitch + at.x];
}

// Height at the first corner of a cell.
fn texel(map: u32, at: vec2<i32>) -> f32 {
    return heights[surface_corner_index(params.size, params.address, map, at)];
}

// Largest radius for which the cone stays above the corners of a leaf that is `offset` cells away. `own` is the height of the
// cone's tip. The corners suffice, because over a cell, the difference of the bilinear patch and a plane is largest at a
// corner. A corner's distance is bounded from below by its distance along the line to the leaf's center.
fn leaf_radius(corners: vec4<f32>, offset: vec2<i32>, own: f32) -> f32 {
    let away = vec2<f32>(abs(offset));
    let center = max(away - 0.5, vec2<f32>(0.0));
    let direction = center / max(length(center), 0.5);
    // Distances from the nearest edge of the own cell to the near edge and to the far edge of the leaf.
    let near = max(away - 1.0, vec2<f32>(0.0)) * direction;
    let far = away * direction;
    // The sign of the offset decides which side of the leaf is near.
    let x = select(vec2<f32>(near.x, far.x), vec2<f32>(far.x, near.x), offset.x < 0);
    let y = select(vec2<f32>(near.y, far.y), vec2<f32>(far.y, near.y), offset.y < 0);
    let distances = vec4<f32>(x.x + y.x, x.y + y.x, x.x + y.y, x.y + y.y);
    let rises = corners - own;
    let radii = distances / max(rises, vec4<f32>(LEAST_RISE));
    let allowed = select(vec4<f32>(WIDEST), radii, rises > vec4<f32>(0.0));
    return min(min(allowed.x, allowed.y), min(allowed.z, allowed.w));
}

// Whether the surface of a leaf rises on every path from the own cell, so that no ray leaves the surface there.
fn rises(corners: vec4<f32>, offset: vec2<i32>) -> bool {
    let along_x = vec2<f32>(corners.y - corners.x, corners.w - corners.z);
    let along_y = vec2<f32>(corners.z - corners.x, corners.w - corners.y);
    // Each component of a path's direction is within 1 of the offset. A bilinear form has its minimum at a corner.
    let low = vec2<f32>(offset - 1);
    let high = vec2<f32>(offset + 1);
    let x = min(min(along_x.x * low.x, along_x.x * high.x), min(along_x.y * low.x, along_x.y * high.x));
    let y = min(min(along_y.x * low.y, along_y.x * high.y), min(along_y.y * low.y, along_y.y * high.y));
    return x + y >= 0.0;
}

// Radius of a cell's cone, reduced from `radius` where nodes of one periodic image of the tile require it. `cell` is counted
// from that image, and `own` is the height of the cell's highest corner.
fn narrowed(map: u32, cell: vec2<i32>, own: f32, radius: f32) -> f32 {
    let cells = vec2<i32>(params.cells);
    let top = surface_levels(params.cells) - 1u;
    // The outermost cells of a clamped map extend to infinity, and paths from there have any direction.
    let is_rim = params.address != SURFACE_WRAP && (any(cell <= vec2<i32>(0)) || any(cell >= cells - 1));
    var narrowest = radius;
    var level = top;
    var node = vec2<i32>(0);
    // Position of the current node in the search order of its parent's four children; two bits per level.
    var orders = 0u;
    for (var visit = 0u; visit < MAX_VISITS; visit++) {
        let low = node << vec2<u32>(level);
        var open = false;
        if all(low < cells) {
            let high = min(low + (vec2<i32>(1) << vec2<u32>(level)), cells);
            let gap = vec2<f32>(max(max(low - cell - 1, cell - high), vec2<i32>(0)));
            let rise = highest(map, level, node) - own;
            // Squared distances, since most nodes need no square root.
            let distance = dot(gap, gap);
            let reach = narrowest * rise;
            if rise > 0.0 && distance < reach * reach {
                // With this radius, the cone stays above the node, so no condition below needs a narrower one. At this radius the
                // comparison above changes its outcome: a rounding there does not change the result.
                let suffices = sqrt(distance) / rise;
                if level == 0u {
                    let corners = vec4<f32>(
                        texel(map, node), texel(map, node + vec2<i32>(1, 0)),
                        texel(map, node + vec2<i32>(0, 1)), texel(map, node + vec2<i32>(1, 1)));
                    let offset = node - cell;
                    if is_rim || !rises(corners, offset) {
                        narrowest = min(narrowest, max(leaf_radius(corners, offset, own), suffices));
                    }
                } else if distance >= OPENING * OPENING * f32(1u << (2u * level)) {
                    narrowest = suffices;
                } else {
                    open = true;
                }
            }
        }
        if open {
            level -= 1u;
            orders = orders & ~(3u << (2u * level));
            node = nearest_child(node, cell, level);
            continue;
        }
        // The next node is the next child of the parent. After the last child, it is the next child of the parent's parent, and
        // so on.
        let last_children = countTrailingZeros(~(orders >> (2u * level))) >> 1u;
        node = node >> vec2<u32>(last_children);
        level += last_children;
        if level >= top {
            break;
        }
        let order = ((orders >> (2u * level)) & 3u) + 1u;
        orders = (orders & ~(3u << (2u * level))) | (order << (2u * level));
        let first = nearest_child(node >> vec2<u32>(1u), cell, level);
        node = first ^ vec2<i32>(vec2<u32>(order & 1u, order >> 1u));
    }
    return narrowest;
}

// Child of `parent` that is nearest to a cell. `level` is the child's level.
fn nearest_child(parent: vec2<i32>, cell: vec2<i32>, level: u32) -> vec2<i32> {
    let middle = (2 * parent + 1) << vec2<u32>(level);
    return 2 * parent + select(vec2<i32>(0), vec2<i32>(1), cell >= middle);
}

@compute @workgroup_size(8, 8)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    if any(id.xy >= params.cells) {
        return;
    }
    let cell = vec2<i32>(id.xy);
    let own = highest(id.z, 0u, cell);
    // A larger radius would reach images of the tile that are not searched.
    var radius = f32(min(params.cells.x, params.cells.y));
    let images = nonuniform(select(1u, 9u, params.address == SURFACE_WRAP), id.x);
    for (var image = 0u; image < images; image++) {
        // The tile itself comes first.
        let number = vec2<i32>(i32((image + 4u) % 9u));
        let offset = vec2<i32>(number.x % 3 - 1, number.y / 3 - 1) * vec2<i32>(params.cells);
        radius = narrowed(id.z, cell - offset, own, radius);
    }
    let cone = vec2<f32>(own, radius * NARROWING);
    cones[(id.z * params.cells.y + id.y) * params.cone_pitch + id.x] = cone;
}
