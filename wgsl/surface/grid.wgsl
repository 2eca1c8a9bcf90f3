// Grid of bilinear cells under a ray. A cell lies between four texel centers. With wrap addressing, a tile has the same number
// of cells and texels. With clamp addressing, a tile has one more cell per axis, and the outermost cells extend to infinity
// with constant heights. In both modes the cells cover the whole plane, so a ray never leaves the grid.
import package::wgsl::surface::ray::{SURFACE_WRAP, SurfaceRay};

// A distance in cells that is longer than any ray's path.
const SURFACE_FAR: i32 = 1073741824;

// If a ray travels fewer cells than this along an axis, it never leaves a cell along that axis.
const SURFACE_LEAST_TRAVEL: f32 = 1e-6;

// A ray parameter that no ray reaches.
const SURFACE_NEVER: f32 = 2.0;

// Grid of cells under a ray, relative to the cell in which the ray enters.
struct SurfaceGrid {
    // Number of texels of a tile along each axis.
    size: vec2<i32>,
    // Number of cells of a tile along each axis.
    cells: vec2<i32>,
    // Cell in which the ray enters, reduced to the tile if addresses wrap. Other cells are counted from this cell, which keeps
    // f32 exact.
    base: vec2<i32>,
    // Position in the base cell at which the ray enters, 0 to 1.
    start: vec2<f32>,
    // Reciprocals of the tile's edges in texels.
    tiles: vec2<f32>,
    // Distance in cells that the ray travels along each axis, with sign.
    travel: vec2<f32>,
    // Reciprocal of `travel`; 0 along an axis where the ray hardly travels.
    inverse: vec2<f32>,
    // Address mode: SURFACE_WRAP or SURFACE_CLAMP.
    address: u32,
}

// A square of cells: a node of the pyramid.
struct SurfaceNode {
    // Index of the node at its level.
    index: vec2<i32>,
    // Lower edges in cells, counted from the base cell.
    low: vec2<i32>,
    // Upper edges in cells, counted from the base cell; exclusive.
    high: vec2<i32>,
}

// Grid of cells under a ray, for a map of `size` texels.
fn surface_grid(size: vec2<u32>, ray: SurfaceRay, address: u32) -> SurfaceGrid {
    let scale = vec2<f32>(size);
    let texel = ray.origin * scale - 0.5;
    let base = floor(texel);
    let travel = ray.slope * scale;
    let is_slow = abs(travel) < vec2<f32>(SURFACE_LEAST_TRAVEL);
    let inverse = select(1.0 / select(travel, vec2<f32>(1.0), is_slow), vec2<f32>(0.0), is_slow);
    let texels = vec2<i32>(size);
    var first = vec2<i32>(base);
    var cells = texels + 1;
    if address == SURFACE_WRAP {
        first = first % texels;
        first = select(first, first + texels, first < vec2<i32>(0));
        cells = texels;
    }
    return SurfaceGrid(texels, cells, first, texel - base, 1.0 / scale, travel, inverse, address);
}

// Largest number of cells that a ray is assumed to cross.
const SURFACE_MAX_CROSSED: f32 = 16384.0;

// Upper bound of the number of steps of a ray. In these steps, the ray can visit each node that it touches once.
fn surface_bound(grid: SurfaceGrid, levels: u32) -> u32 {
    let crossed = min(abs(grid.travel.x) + abs(grid.travel.y), SURFACE_MAX_CROSSED);
    return 2u * (u32(crossed) + 3u) + levels;
}

// Node of 2^level × 2^level cells that contains a cell. Nodes end at the tile's edge.
fn surface_node(grid: SurfaceGrid, cell: vec2<i32>, level: u32) -> SurfaceNode {
    let shift = vec2<u32>(level);
    let absolute = grid.base + cell;
    var inside: vec2<i32>;
    var tile: vec2<i32>;
    if grid.address == SURFACE_WRAP {
        // Rays cross some hundred tiles at most, so the quotient for a cell's center is exact enough for floor.
        let whole = vec2<i32>(floor((vec2<f32>(absolute) + 0.5) * grid.tiles)) * grid.size;
        inside = absolute - whole;
        tile = whole - grid.base;
    } else {
        inside = clamp(absolute + 1, vec2<i32>(0), grid.size);
        tile = -1 - grid.base;
    }
    let index = inside >> shift;
    let first = index << shift;
    let last = min(first + (vec2<i32>(1) << shift), grid.cells);
    var low = tile + first;
    var high = tile + last;
    if grid.address != SURFACE_WRAP {
        low = select(low, vec2<i32>(-SURFACE_FAR), first == vec2<i32>(0));
        high = select(high, vec2<i32>(SURFACE_FAR), last == grid.cells);
    }
    return SurfaceNode(index, low, high);
}

// Ray parameters at which the ray would leave a node through its x edge (x) and through its y edge (y).
fn surface_exits(grid: SurfaceGrid, node: SurfaceNode) -> vec2<f32> {
    let edge = select(node.low, node.high, grid.travel >= vec2<f32>(0.0));
    let exits = (vec2<f32>(edge) - grid.start) * grid.inverse;
    return select(exits, vec2<f32>(SURFACE_NEVER), grid.inverse == vec2<f32>(0.0));
}

// Cell that contains the ray's point at `parameter`, clamped to the cells of a node.
fn surface_cell(grid: SurfaceGrid, node: SurfaceNode, parameter: f32) -> vec2<i32> {
    let at = vec2<i32>(floor(grid.start + parameter * grid.travel));
    return clamp(at, node.low, node.high - 1);
}

// Cell beyond the edge through which the ray leaves a node.
fn surface_beyond(grid: SurfaceGrid, node: SurfaceNode, exits: vec2<f32>, parameter: f32) -> vec2<i32> {
    var next = surface_cell(grid, node, parameter);
    if exits.x <= exits.y {
        next.x = select(node.low.x - 1, node.high.x, grid.travel.x >= 0.0);
    } else {
        next.y = select(node.low.y - 1, node.high.y, grid.travel.y >= 0.0);
    }
    return next;
}

// Heights at the four corners of a cell: (0,0), (1,0), (0,1), (1,1).
fn surface_corners(heights: texture_2d<f32>, grid: SurfaceGrid, index: vec2<i32>) -> vec4<f32> {
    var low = index;
    var high = index + 1;
    if grid.address == SURFACE_WRAP {
        high = select(high, vec2<i32>(0), high >= grid.size);
    } else {
        low = max(index - 1, vec2<i32>(0));
        high = min(index, grid.size - 1);
    }
    return vec4<f32>(
        textureLoad(heights, low, 0).r,
        textureLoad(heights, vec2<i32>(high.x, low.y), 0).r,
        textureLoad(heights, vec2<i32>(low.x, high.y), 0).r,
        textureLoad(heights, high, 0).r);
}

// First ray parameter in enter..=leave at which the ray is on or below the bilinear patch of a cell; -1 if there is none. `low`
// is the corner to which the patch is relative (`surface_corner`). The ray's height above a patch is a quadratic function of
// the parameter.
fn surface_patch(grid: SurfaceGrid, corners: vec4<f32>, low: vec2<i32>, enter: f32, leave: f32) -> f32 {
    let at = (grid.start - vec2<f32>(low)) + enter * grid.travel;
    let slope = vec2<f32>(corners.y - corners.x, corners.z - corners.x);
    let twist = (corners.w - corners.z) - slope.x;
    let length = leave - enter;
    let ahead = grid.travel * length;
    let height = corners.x + slope.x * at.x + (slope.y + twist * at.x) * at.y;
    // The quadratic is a·x² + 2·b·x + c over x in 0..=1; `b` is half of the linear coefficient.
    let c = 1.0 - enter - height;
    if c <= 0.0 {
        return enter;
    }
    let b = -0.5 * (length + slope.x * ahead.x + slope.y * ahead.y + twist * (at.x * ahead.y + at.y * ahead.x));
    let a = -twist * ahead.x * ahead.y;
    let discriminant = b * b - a * c;
    let root = sqrt(max(discriminant, 0.0));
    // The smaller positive root, in a form without a difference of nearly equal numbers. The root is in 0..=1 only if the
    // denominator is at least as large as the numerator. A ray that moves away from the surface (b > 0) meets it again only if
    // the surface rises towards the ray (a < 0).
    let over = select(c, b + root, b > 0.0);
    let under = select(root - b, -a, b > 0.0);
    if discriminant >= 0.0 && under >= over {
        return enter + length * (over / under);
    }
    return select(-1.0, leave, a + 2.0 * b + c <= 0.0);
}

// Corner to which a leaf's patch is relative. Along an axis where the leaf extends to infinity, heights are constant, and any
// corner will do.
fn surface_corner(leaf: SurfaceNode) -> vec2<i32> {
    return select(leaf.low, leaf.high - 1, leaf.low == vec2<i32>(-SURFACE_FAR));
}
