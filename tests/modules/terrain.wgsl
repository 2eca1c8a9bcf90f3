// A shader of somebody's own behind the module: the shares of three zones at given heights, and the first corner offsets
// of a world.
@group(0) @binding(0) var<storage, read> given: array<f32>;
@group(0) @binding(1) var<storage, read_write> results: array<u32>;

override ADDITIVE: bool = false;

@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    let count = arrayLength(&given);
    if id.x >= count {
        return;
    }
    let height = given[id.x];
    var zones = array<Zone, 3>(Zone(-8.0, 0.0), Zone(0.0, 10.0), Zone(20.0, 30.0));
    var fold = zone_fold();
    for (var z = 0u; z < 3u; z++) {
        fold = zone_folded(fold, z, zones[z], height);
    }
    for (var z = 0u; z < 3u; z++) {
        results[3u * id.x + z] = bitcast<u32>(zone_fraction(fold, z, zones[z], height, ADDITIVE));
    }
    if id.x == 0u {
        let words = threefry2x32(vec2<u32>(17u, 4u), vec4<u32>(0u, 1u, 2u, 3u), vec4<u32>(5u));
        let offsets = height_offset(OFFSET_GAUSSIAN, 655360u, words);
        let mean = mean_of_four(offsets.xxxx, offsets.yyyy, offsets.zzzz, offsets.wwww);
        let normal = slope_normal(vec2<i32>(3, 0), 4.0);
        let light = lit(Light(vec3<f32>(0.0, 1.0, 0.0), 0.25), normal, vec3<f32>(0.5, 1.0, 0.0));
        for (var lane = 0u; lane < 4u; lane++) {
            results[3u * count + lane] = bitcast<u32>(offsets[lane]);
        }
        results[3u * count + 4u] = bitcast<u32>(mean.x);
        results[3u * count + 5u] = bitcast<u32>(light.y);
    }
}
