// relievo surface/height_pyramid: generated from kernels/surface/height_pyramid.wgsl

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

struct PyramidParams {
    size: vec2<u32>,
    cells: vec2<u32>,
    pitch: u32,
    rows: u32,
    address: u32,
    level: u32
}

@group(0) @binding(0)
var<uniform> params: PyramidParams;

@group(0) @binding(1)
var<storage, read> heights: array<f32>;

@group(0) @binding(2)
var<storage, read_write> pyramids: array<f32>;

@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    if any(id.xy >= nodes(params.level)) {
        return;
    }
    let at = vec2<i32>(id.xy);
    var four: vec4<f32>;
    if nonuniform(params.level, id.x) == 0u {
        four = vec4<f32>(corner(id.z, at), corner(id.z, at + vec2<i32>(1, 0)), corner(id.z, at + vec2<i32>(0, 1)), corner(id.z, at + vec2<i32>(1, 1)));
    }
    else {
        four = vec4<f32>(child(id.z, 2 * at), child(id.z, 2 * at + vec2<i32>(1, 0)), child(id.z, 2 * at + vec2<i32>(0, 1)), child(id.z, 2 * at + vec2<i32>(1, 1)));
    }
    pyramids[place(id.z, params.level, at)] = max(max(four.x, four.y), max(four.z, four.w));
}

fn nodes(level: u32) -> vec2<u32> {
    return (params.cells + (vec2<u32>(1u) << vec2<u32>(level)) - 1u) >> vec2<u32>(level);
}

fn place(map: u32, level: u32, at: vec2<i32>) -> u32 {
    let texel = vec2<u32>(surface_atlas_at(params.cells, level, at));
    return (map * params.rows + texel.y) * params.pitch + texel.x;
}

fn corner(map: u32, at: vec2<i32>) -> f32 {
    return heights[surface_corner_index(params.size, params.address, map, at)];
}

fn child(map: u32, at: vec2<i32>) -> f32 {
    let level = params.level - 1u;
    return pyramids[place(map, level, min(at, vec2<i32>(nodes(level)) - 1))];
}
