// relievo surface/cone_map: generated from kernels/surface/cone_map.wgsl

fn nonuniform(value: u32, thread: u32) -> u32 {
    return select(0u, value, thread != 4294967295u);
}

fn rows_of_workgroups(groups: u32, most: u32) -> vec3<u32> {
    let x = clamp(groups, 1u, most);
    return vec3<u32>(x, (groups + x - 1u) / x, 1u);
}

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

const OPENING: f32 = 2.0;

struct ConeParams {
    size: vec2<u32>,
    cells: vec2<u32>,
    pitch: u32,
    rows: u32,
    cone_pitch: u32,
    address: u32
}

@group(0) @binding(0)
var<uniform> params: ConeParams;

@group(0) @binding(1)
var<storage, read> heights: array<f32>;

@group(0) @binding(2)
var<storage, read> pyramids: array<f32>;

@group(0) @binding(3)
var<storage, read_write> cones: array<vec2<f32>>;

const LEAST_RISE: f32 = 1e-9;

const WIDEST: f32 = 1000000000.0;

const NARROWING: f32 = 0.999999;

const MAX_VISITS: u32 = 65536u;

fn highest(map: u32, level: u32, node: vec2<i32>) -> f32 {
    let at = vec2<u32>(surface_atlas_at(params.cells, level, node));
    return pyramids[(map * params.rows + at.y) * params.pitch + at.x];
}

fn texel(map: u32, at: vec2<i32>) -> f32 {
    return heights[surface_corner_index(params.size, params.address, map, at)];
}

fn leaf_radius(corners: vec4<f32>, offset: vec2<i32>, own: f32) -> f32 {
    let away = vec2<f32>(abs(offset));
    let center = max(away - 0.5, vec2<f32>(0.0));
    let direction = center / max(length(center), 0.5);
    let near = max(away - 1.0, vec2<f32>(0.0)) * direction;
    let far = away * direction;
    let x = select(vec2<f32>(near.x, far.x), vec2<f32>(far.x, near.x), offset.x < 0);
    let y = select(vec2<f32>(near.y, far.y), vec2<f32>(far.y, near.y), offset.y < 0);
    let distances = vec4<f32>(x.x + y.x, x.y + y.x, x.x + y.y, x.y + y.y);
    let rises = corners - own;
    let radii = distances / max(rises, vec4<f32>(LEAST_RISE));
    let allowed = select(vec4<f32>(WIDEST), radii, rises > vec4<f32>(0.0));
    return min(min(allowed.x, allowed.y), min(allowed.z, allowed.w));
}

fn rises(corners: vec4<f32>, offset: vec2<i32>) -> bool {
    let along_x = vec2<f32>(corners.y - corners.x, corners.w - corners.z);
    let along_y = vec2<f32>(corners.z - corners.x, corners.w - corners.y);
    let low = vec2<f32>(offset - 1);
    let high = vec2<f32>(offset + 1);
    let x = min(min(along_x.x * low.x, along_x.x * high.x), min(along_x.y * low.x, along_x.y * high.x));
    let y = min(min(along_y.x * low.y, along_y.x * high.y), min(along_y.y * low.y, along_y.y * high.y));
    return x + y >= 0.0;
}

fn narrowed(map: u32, cell: vec2<i32>, own: f32, radius: f32) -> f32 {
    let cells = vec2<i32>(params.cells);
    let top = surface_levels(params.cells) - 1u;
    let is_rim = params.address != SURFACE_WRAP && (any(cell <= vec2<i32>(0)) || any(cell >= cells - 1));
    var narrowest = radius;
    var level = top;
    var node = vec2<i32>(0);
    var orders = 0u;
    for (var visit = 0u; visit < MAX_VISITS; visit++) {
        let low = node << vec2<u32>(level);
        var open = false;
        if all(low < cells) {
            let high = min(low + (vec2<i32>(1) << vec2<u32>(level)), cells);
            let gap = vec2<f32>(max(max(low - cell - 1, cell - high), vec2<i32>(0)));
            let rise = highest(map, level, node) - own;
            let distance = dot(gap, gap);
            let reach = narrowest * rise;
            if rise > 0.0 && distance < reach * reach {
                let suffices = sqrt(distance) / rise;
                if level == 0u {
                    let corners = vec4<f32>(texel(map, node), texel(map, node + vec2<i32>(1, 0)), texel(map, node + vec2<i32>(0, 1)), texel(map, node + vec2<i32>(1, 1)));
                    let offset = node - cell;
                    if is_rim || !rises(corners, offset) {
                        narrowest = min(narrowest, max(leaf_radius(corners, offset, own), suffices));
                    }
                }
                else if distance >= OPENING * OPENING * f32(1u << (2u * level)) {
                    narrowest = suffices;
                }
                else {
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
    var radius = f32(min(params.cells.x, params.cells.y));
    let images = nonuniform(select(1u, 9u, params.address == SURFACE_WRAP), id.x);
    for (var image = 0u; image < images; image++) {
        let number = vec2<i32>(i32((image + 4u) % 9u));
        let offset = vec2<i32>(number.x % 3 - 1, number.y / 3 - 1) * vec2<i32>(params.cells);
        radius = narrowed(id.z, cell - offset, own, radius);
    }
    let cone = vec2<f32>(own, radius * NARROWING);
    cones[(id.z * params.cells.y + id.y) * params.cone_pitch + id.x] = cone;
}
