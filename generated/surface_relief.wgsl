// relievo surface/relief: generated from kernels/surface/relief.wgsl

fn surface_levels(cells: vec2<u32>) -> u32 {
    let longest = max(cells.x, cells.y);
    return select(firstLeadingBit(longest - 1u) + 2u, 1u, longest <= 1u);
}

fn surface_atlas_at(cells: vec2<u32>, level: u32, index: vec2<i32>) -> vec2<i32> {
    if level == 0u {
        return index;
    }
    let above = cells.y - (cells.y >> (level - 1u)) + level - 1u;
    return index + vec2<i32>(vec2<u32>((cells.x + 3u) & ~3u, above));
}

fn surface_corner_index(size: vec2<u32>, address: u32, map: u32, cell: vec2<i32>) -> u32 {
    let texels = vec2<i32>(size);
    let wrapped = select(cell, vec2<i32>(0), cell >= texels);
    let clamped = clamp(cell - 1, vec2<i32>(0), texels - 1);
    let at = vec2<u32>(select(clamped, wrapped, address == SURFACE_WRAP));
    return (map * size.y + at.y) * size.x + at.x;
}

fn surface_cone(heights: texture_2d<f32>, cones: texture_2d<f32>, ray: SurfaceRay, march: SurfaceMarch) -> SurfaceHit {
    if !(ray.cosine > 0.0) {
        return surface_missed(ray);
    }
    let grid = surface_grid(textureDimensions(heights), ray, march.address);
    let distance = length(grid.travel);
    let bound = surface_bound(grid, 0u);
    var cell = vec2<i32>(0);
    var parameter = 0.0;
    var above = 0.0;
    var samples = 0u;
    var step = 0u;
    while (step < bound) {
        var node: SurfaceNode;
        var exits: vec2<f32>;
        var leave: f32;
        var is_near = false;
        while (step < bound) {
            step += 1u;
            node = surface_node(grid, cell, 0u);
            exits = surface_exits(grid, node);
            leave = clamp(min(exits.x, exits.y), parameter, 1.0);
            let cone = textureLoad(cones, node.index, 0).rg;
            samples += 1u;
            if 1.0 - leave <= cone.r {
                is_near = true;
                break;
            }
            above = parameter;
            let reach = parameter + cone.g * (1.0 - parameter - cone.r) / (distance + cone.g);
            if reach > leave {
                parameter = min(reach, 1.0);
                cell = vec2<i32>(floor(grid.start + parameter * grid.travel));
            }
            else {
                cell = surface_beyond(grid, node, exits, leave);
                parameter = leave;
            }
        }
        if !is_near {
            break;
        }
        let corners = surface_corners(heights, grid, node.index);
        samples += 4u;
        let found = surface_patch(grid, corners, surface_corner(node), parameter, leave);
        if found > parameter || (found == parameter && above == parameter) {
            return surface_point(ray, found, samples, SURFACE_HIT);
        }
        if found >= 0.0 {
            var level = march;
            level.mip = 0u;
            return surface_narrowed(heights, ray, level, above, parameter, samples);
        }
        above = parameter;
        if leave >= 1.0 {
            parameter = 1.0;
            break;
        }
        cell = surface_beyond(grid, node, exits, leave);
        parameter = leave;
    }
    let outcome = select(SURFACE_EXHAUSTED, SURFACE_HIT, parameter >= 1.0);
    return surface_point(ray, parameter, samples, outcome);
}

fn surface_plain(ray: SurfaceRay) -> SurfaceHit {
    if !(ray.cosine > 0.0) {
        return surface_missed(ray);
    }
    return surface_point(ray, ray.polygon, 0u, SURFACE_HIT);
}

fn surface_shifted(heights: texture_2d<f32>, ray: SurfaceRay, march: SurfaceMarch, limit: f32) -> SurfaceHit {
    if !(ray.cosine > 0.0) {
        return surface_missed(ray);
    }
    let height = surface_height(heights, surface_at(ray, ray.polygon), march.mip, march.address);
    let parameter = ray.polygon - (height - (1.0 - ray.polygon)) * limit;
    var hit = surface_point(ray, parameter, SURFACE_BILINEAR, SURFACE_HIT);
    hit.height = height;
    return hit;
}

fn surface_parallax(heights: texture_2d<f32>, ray: SurfaceRay, march: SurfaceMarch) -> SurfaceHit {
    return surface_shifted(heights, ray, march, 1.0);
}

fn surface_parallax_limited(heights: texture_2d<f32>, ray: SurfaceRay, march: SurfaceMarch) -> SurfaceHit {
    return surface_shifted(heights, ray, march, ray.cosine);
}

const SURFACE_FAR: i32 = 1073741824;

const SURFACE_LEAST_TRAVEL: f32 = 1e-6;

const SURFACE_NEVER: f32 = 2.0;

struct SurfaceGrid {
    size: vec2<i32>,
    cells: vec2<i32>,
    base: vec2<i32>,
    start: vec2<f32>,
    tiles: vec2<f32>,
    travel: vec2<f32>,
    inverse: vec2<f32>,
    address: u32
}

struct SurfaceNode {
    index: vec2<i32>,
    low: vec2<i32>,
    high: vec2<i32>
}

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

const SURFACE_MAX_CROSSED: f32 = 16384.0;

fn surface_bound(grid: SurfaceGrid, levels: u32) -> u32 {
    let crossed = min(abs(grid.travel.x) + abs(grid.travel.y), SURFACE_MAX_CROSSED);
    return 2u * (u32(crossed) + 3u) + levels;
}

fn surface_node(grid: SurfaceGrid, cell: vec2<i32>, level: u32) -> SurfaceNode {
    let shift = vec2<u32>(level);
    let absolute = grid.base + cell;
    var inside: vec2<i32>;
    var tile: vec2<i32>;
    if grid.address == SURFACE_WRAP {
        let whole = vec2<i32>(floor((vec2<f32>(absolute) + 0.5) * grid.tiles)) * grid.size;
        inside = absolute - whole;
        tile = whole - grid.base;
    }
    else {
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

fn surface_exits(grid: SurfaceGrid, node: SurfaceNode) -> vec2<f32> {
    let edge = select(node.low, node.high, grid.travel >= vec2<f32>(0.0));
    let exits = (vec2<f32>(edge) - grid.start) * grid.inverse;
    return select(exits, vec2<f32>(SURFACE_NEVER), grid.inverse == vec2<f32>(0.0));
}

fn surface_cell(grid: SurfaceGrid, node: SurfaceNode, parameter: f32) -> vec2<i32> {
    let at = vec2<i32>(floor(grid.start + parameter * grid.travel));
    return clamp(at, node.low, node.high - 1);
}

fn surface_beyond(grid: SurfaceGrid, node: SurfaceNode, exits: vec2<f32>, parameter: f32) -> vec2<i32> {
    var next = surface_cell(grid, node, parameter);
    if exits.x <= exits.y {
        next.x = select(node.low.x - 1, node.high.x, grid.travel.x >= 0.0);
    }
    else {
        next.y = select(node.low.y - 1, node.high.y, grid.travel.y >= 0.0);
    }
    return next;
}

fn surface_corners(heights: texture_2d<f32>, grid: SurfaceGrid, index: vec2<i32>) -> vec4<f32> {
    var low = index;
    var high = index + 1;
    if grid.address == SURFACE_WRAP {
        high = select(high, vec2<i32>(0), high >= grid.size);
    }
    else {
        low = max(index - 1, vec2<i32>(0));
        high = min(index, grid.size - 1);
    }
    return vec4<f32>(textureLoad(heights, low, 0).r, textureLoad(heights, vec2<i32>(high.x, low.y), 0).r, textureLoad(heights, vec2<i32>(low.x, high.y), 0).r, textureLoad(heights, high, 0).r);
}

fn surface_patch(grid: SurfaceGrid, corners: vec4<f32>, low: vec2<i32>, enter: f32, leave: f32) -> f32 {
    let at = (grid.start - vec2<f32>(low)) + enter * grid.travel;
    let slope = vec2<f32>(corners.y - corners.x, corners.z - corners.x);
    let twist = (corners.w - corners.z) - slope.x;
    let length = leave - enter;
    let ahead = grid.travel * length;
    let height = corners.x + slope.x * at.x + (slope.y + twist * at.x) * at.y;
    let c = 1.0 - enter - height;
    if c <= 0.0 {
        return enter;
    }
    let b = -0.5 * (length + slope.x * ahead.x + slope.y * ahead.y + twist * (at.x * ahead.y + at.y * ahead.x));
    let a = -twist * ahead.x * ahead.y;
    let discriminant = b * b - a * c;
    let root = sqrt(max(discriminant, 0.0));
    let over = select(c, b + root, b > 0.0);
    let under = select(root - b, -a, b > 0.0);
    if discriminant >= 0.0 && under >= over {
        return enter + length * (over / under);
    }
    return select(-1.0, leave, a + 2.0 * b + c <= 0.0);
}

fn surface_corner(leaf: SurfaceNode) -> vec2<i32> {
    return select(leaf.low, leaf.high - 1, leaf.low == vec2<i32>(-SURFACE_FAR));
}

const SURFACE_BILINEAR: u32 = 4u;

fn surface_height(heights: texture_2d<f32>, uv: vec2<f32>, mip: u32, address: u32) -> f32 {
    let size = vec2<f32>(textureDimensions(heights, mip));
    let last = vec2<i32>(size) - 1;
    var low: vec2<i32>;
    var high: vec2<i32>;
    var weight: vec2<f32>;
    if address == SURFACE_WRAP {
        let at = (uv - floor(uv)) * size - 0.5;
        let corner = floor(at);
        weight = at - corner;
        low = vec2<i32>(corner);
        high = select(low + 1, vec2<i32>(0), low >= last);
        low = select(low, last, low < vec2<i32>(0));
    }
    else {
        let at = clamp(uv * size - 0.5, vec2<f32>(0.0), size - 1.0);
        let corner = floor(at);
        weight = at - corner;
        low = vec2<i32>(corner);
        high = min(low + 1, last);
    }
    let near = vec2<f32>(textureLoad(heights, low, mip).r, textureLoad(heights, vec2<i32>(high.x, low.y), mip).r);
    let far = vec2<f32>(textureLoad(heights, vec2<i32>(low.x, high.y), mip).r, textureLoad(heights, high, mip).r);
    let rows = near + weight.y * (far - near);
    return rows.x + weight.x * (rows.y - rows.x);
}

fn surface_mip(heights: texture_2d<f32>, uv_dx: vec2<f32>, uv_dy: vec2<f32>) -> u32 {
    let size = vec2<f32>(textureDimensions(heights));
    let texels = max(dot(uv_dx * size, uv_dx * size), dot(uv_dy * size, uv_dy * size));
    let level = 0.5 * log2(max(texels, 1.0));
    return min(u32(level + 0.5), textureNumLevels(heights) - 1u);
}

const SURFACE_MAX_STEPS: u32 = 1024u;

const SURFACE_MAX_BINARY: u32 = 24u;

const SURFACE_LEAST_SPAN: f32 = 1e-12;

struct SurfaceBracket {
    above: f32,
    under: f32,
    height_above: f32,
    height_under: f32,
    samples: u32
}

fn surface_steps(march: SurfaceMarch, cosine: f32) -> u32 {
    let low = f32(march.min_steps);
    let steps = ceil(low + (f32(march.max_steps) - low) * (1.0 - min(cosine, 1.0)));
    return clamp(u32(steps), 1u, SURFACE_MAX_STEPS);
}

fn surface_search(heights: texture_2d<f32>, ray: SurfaceRay, march: SurfaceMarch) -> SurfaceBracket {
    let steps = surface_steps(march, ray.cosine);
    let width = 1.0 / f32(steps);
    var bracket = SurfaceBracket(0.0, 1.0, 0.0, 0.0, 0u);
    for (var step = 1u; step <= SURFACE_MAX_STEPS; step++) {
        let parameter = select(f32(step) * width, 1.0, step >= steps);
        let height = surface_height(heights, surface_at(ray, parameter), march.mip, march.address);
        bracket.samples += SURFACE_BILINEAR;
        if 1.0 - parameter <= height || step >= steps {
            bracket.under = parameter;
            bracket.height_under = height;
            break;
        }
        bracket.above = parameter;
        bracket.height_above = height;
    }
    return bracket;
}

fn surface_relief(heights: texture_2d<f32>, ray: SurfaceRay, march: SurfaceMarch) -> SurfaceHit {
    if !(ray.cosine > 0.0) {
        return surface_missed(ray);
    }
    let bracket = surface_search(heights, ray, march);
    return surface_narrowed(heights, ray, march, bracket.above, bracket.under, bracket.samples);
}

fn surface_narrowed(heights: texture_2d<f32>, ray: SurfaceRay, march: SurfaceMarch, above: f32, under: f32, samples: u32) -> SurfaceHit {
    var low = above;
    var high = under;
    var loads = samples;
    for (var step = 0u; step < min(march.binary_steps, SURFACE_MAX_BINARY); step++) {
        let middle = 0.5 * (low + high);
        let height = surface_height(heights, surface_at(ray, middle), march.mip, march.address);
        loads += SURFACE_BILINEAR;
        if 1.0 - middle <= height {
            high = middle;
        }
        else {
            low = middle;
        }
    }
    return surface_point(ray, 0.5 * (low + high), loads, SURFACE_HIT);
}

fn surface_occlusion(heights: texture_2d<f32>, ray: SurfaceRay, march: SurfaceMarch) -> SurfaceHit {
    if !(ray.cosine > 0.0) {
        return surface_missed(ray);
    }
    var bracket = surface_search(heights, ray, march);
    if bracket.above == 0.0 {
        bracket.height_above = surface_height(heights, ray.origin, march.mip, march.address);
        bracket.samples += SURFACE_BILINEAR;
    }
    let over = max(1.0 - bracket.above - bracket.height_above, 0.0);
    let below = max(bracket.height_under - (1.0 - bracket.under), 0.0);
    let fraction = select(1.0, over / max(over + below, SURFACE_LEAST_SPAN), over + below > SURFACE_LEAST_SPAN);
    let parameter = bracket.above + fraction * (bracket.under - bracket.above);
    return surface_point(ray, parameter, bracket.samples, SURFACE_HIT);
}

fn surface_quadtree(heights: texture_2d<f32>, pyramid: texture_2d<f32>, ray: SurfaceRay, march: SurfaceMarch) -> SurfaceHit {
    if !(ray.cosine > 0.0) {
        return surface_missed(ray);
    }
    let grid = surface_grid(textureDimensions(heights), ray, march.address);
    let top = surface_levels(vec2<u32>(grid.cells)) - 1u;
    let bound = surface_bound(grid, top);
    let longest = u32(max(abs(grid.travel.x), abs(grid.travel.y)));
    var level = min(firstLeadingBit(max(longest / 2u, 1u)), top);
    var cell = vec2<i32>(0);
    var parameter = 0.0;
    var samples = 0u;
    var step = 0u;
    while (step < bound) {
        var node: SurfaceNode;
        var exits: vec2<f32>;
        var leave: f32;
        var is_leaf = false;
        while (step < bound) {
            step += 1u;
            node = surface_node(grid, cell, level);
            exits = surface_exits(grid, node);
            leave = clamp(min(exits.x, exits.y), parameter, 1.0);
            let at = surface_atlas_at(vec2<u32>(grid.cells), level, node.index);
            let highest = textureLoad(pyramid, at, 0).r;
            samples += 1u;
            if 1.0 - leave > highest {
                cell = surface_beyond(grid, node, exits, leave);
                parameter = leave;
                level = min(level + select(0u, 1u, surface_leaves_parent(grid, node, exits, level)), top);
                continue;
            }
            parameter = max(parameter, 1.0 - highest);
            if level == 0u {
                is_leaf = true;
                break;
            }
            level -= 1u;
            cell = surface_cell(grid, node, parameter);
        }
        if !is_leaf {
            break;
        }
        let corners = surface_corners(heights, grid, node.index);
        samples += 4u;
        let found = surface_patch(grid, corners, surface_corner(node), parameter, leave);
        if found >= 0.0 {
            return surface_point(ray, found, samples, SURFACE_HIT);
        }
        if leave >= 1.0 {
            parameter = 1.0;
            break;
        }
        cell = surface_beyond(grid, node, exits, leave);
        parameter = leave;
        level = min(select(0u, 1u, surface_leaves_parent(grid, node, exits, 0u)), top);
    }
    let outcome = select(SURFACE_EXHAUSTED, SURFACE_HIT, parameter >= 1.0);
    return surface_point(ray, parameter, samples, outcome);
}

fn surface_leaves_parent(grid: SurfaceGrid, node: SurfaceNode, exits: vec2<f32>, level: u32) -> bool {
    let along_x = exits.x <= exits.y;
    let index = select(node.index.y, node.index.x, along_x);
    let cells = select(grid.cells.y, grid.cells.x, along_x);
    let forward = select(grid.travel.y, grid.travel.x, along_x) >= 0.0;
    let is_odd = (index & 1) == 1;
    let is_last = ((index + 1) << level) >= cells;
    return select(!is_odd, is_odd || is_last, forward);
}

const SURFACE_WRAP: u32 = 0u;

const SURFACE_CLAMP: u32 = 1u;

const SURFACE_MISS: u32 = 0u;

const SURFACE_HIT: u32 = 1u;

const SURFACE_EXHAUSTED: u32 = 2u;

const SURFACE_LEAST_COSINE: f32 = 0.0078125;

struct SurfaceRay {
    origin: vec2<f32>,
    slope: vec2<f32>,
    cosine: f32,
    polygon: f32
}

struct SurfaceMarch {
    address: u32,
    min_steps: u32,
    max_steps: u32,
    binary_steps: u32,
    mip: u32
}

struct SurfaceHit {
    uv: vec2<f32>,
    height: f32,
    parameter: f32,
    samples: u32,
    outcome_code: u32
}

fn surface_ray(uv: vec2<f32>, view: vec3<f32>, scale: f32, plane: f32) -> SurfaceRay {
    let slope = view.xy * (-scale / max(view.z, SURFACE_LEAST_COSINE));
    let polygon = 1.0 - plane;
    return SurfaceRay(uv - polygon * slope, slope, view.z, polygon);
}

fn surface_at(ray: SurfaceRay, parameter: f32) -> vec2<f32> {
    return ray.origin + parameter * ray.slope;
}

fn surface_point(ray: SurfaceRay, parameter: f32, samples: u32, outcome: u32) -> SurfaceHit {
    return SurfaceHit(surface_at(ray, parameter), 1.0 - parameter, parameter, samples, outcome);
}

fn surface_missed(ray: SurfaceRay) -> SurfaceHit {
    return surface_point(ray, ray.polygon, 0u, SURFACE_MISS);
}

fn surface_inside(uv: vec2<f32>, low: vec2<f32>, high: vec2<f32>) -> bool {
    return all(uv >= low) && all(uv <= high);
}

const SURFACE_PLAIN: u32 = 0u;

const SURFACE_PARALLAX: u32 = 1u;

const SURFACE_PARALLAX_LIMITED: u32 = 2u;

const SURFACE_RELIEF: u32 = 3u;

const SURFACE_OCCLUSION: u32 = 4u;

const SURFACE_CONE: u32 = 5u;

const SURFACE_QUADTREE: u32 = 6u;

fn surface_trace(method: u32, heights: texture_2d<f32>, acceleration: texture_2d<f32>, ray: SurfaceRay, march: SurfaceMarch) -> SurfaceHit {
    switch method {
        case SURFACE_PARALLAX {
            return surface_parallax(heights, ray, march);
        }
        case SURFACE_PARALLAX_LIMITED {
            return surface_parallax_limited(heights, ray, march);
        }
        case SURFACE_RELIEF {
            return surface_relief(heights, ray, march);
        }
        case SURFACE_OCCLUSION {
            return surface_occlusion(heights, ray, march);
        }
        case SURFACE_CONE {
            return surface_cone(heights, acceleration, ray, march);
        }
        case SURFACE_QUADTREE {
            return surface_quadtree(heights, acceleration, ray, march);
        }
        case default {
            return surface_plain(ray);
        }
    }
}

override METHOD: u32 = 0u;

@group(0) @binding(0)
var<uniform> march: SurfaceMarch;

@group(0) @binding(1)
var heights: texture_2d<f32>;

@group(0) @binding(2)
var acceleration: texture_2d<f32>;

@group(0) @binding(3)
var<storage, read> rays: array<SurfaceRay>;

@group(0) @binding(4)
var<storage, read_write> hits: array<SurfaceHit>;

@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>) {
    let index = id.y * groups.x * 64u + id.x;
    if index >= arrayLength(&rays) {
        return;
    }
    hits[index] = surface_trace(METHOD, heights, acceleration, rays[index], march);
}
