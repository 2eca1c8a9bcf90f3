// A shader of somebody's own behind the module: the fractions of three zones at given heights and on slopes, how textures
// lie on these, the variation of colour, and the first corner offsets of a world.
@group(0) @binding(0) var<storage, read> given: array<f32>;
@group(0) @binding(1) var<storage, read_write> results: array<u32>;

override ADDITIVE: bool = false;

@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    let count = arrayLength(&given);
    if id.x >= count {
        return;
    }
    // Slopes are those of a sphere, heights in textures fall from zone to zone.
    let height = given[id.x];
    let tilt = f32(id.x) / f32(count);
    let normal = normalize(vec3<f32>(0.6 * tilt, 1.0 - tilt, 0.8 * tilt));
    let steep = steepness(normal);
    var zones = array<Zone, 3>(zone_of_heights(-8.0, 0.0), zone_of_heights(0.0, 10.0), zone_of_heights(20.0, 30.0));
    zones[1].rise = vec2<f32>(4.0, -0.5);
    zones[0].fall = vec2<f32>(-4.0, 2.5);
    zones[0].height_blend = 1.0;
    zones[2].height_blend = 0.5;
    // Colours of one channel each show the fractions.
    var blend = zone_blend();
    for (var z = 0u; z < 3u; z++) {
        let color = select(vec3<f32>(0.0), vec3<f32>(1.0), vec3<u32>(0u, 1u, 2u) == vec3<u32>(z));
        blend = zone_blended(blend, zones[z], height, steep, vec4<f32>(color, 1.0 - 0.25 * f32(z)));
    }
    let fractions = zone_color(blend, ADDITIVE);
    let weights = triplanar_weights(normal);
    let noise = color_variation(vec2<f32>(height * height, 1023.5 * tilt));
    let tinted = varied(vec3<f32>(0.5, 0.25, 1.0), noise, 0.5);
    for (var z = 0u; z < 3u; z++) {
        results[9u * id.x + z] = bitcast<u32>(fractions[z]);
        results[9u * id.x + 3u + z] = bitcast<u32>(weights[z]);
        results[9u * id.x + 6u + z] = bitcast<u32>(tinted[z]);
    }
    if id.x == 0u {
        let words = threefry2x32(vec2<u32>(17u, 4u), vec4<u32>(0u, 1u, 2u, 3u), vec4<u32>(5u));
        let offsets = height_offset(OFFSET_GAUSSIAN, 655360u, words);
        let mean = mean_of_four(offsets.xxxx, offsets.yyyy, offsets.zzzz, offsets.wwww);
        let normal = slope_normal(vec2<i32>(3, 0), 4.0);
        let light = lit(Light(vec3<f32>(0.0, 1.0, 0.0), 0.25), normal, vec3<f32>(0.5, 1.0, 0.0));
        for (var lane = 0u; lane < 4u; lane++) {
            results[9u * count + lane] = bitcast<u32>(offsets[lane]);
        }
        results[9u * count + 4u] = bitcast<u32>(mean.x);
        results[9u * count + 5u] = bitcast<u32>(light.y);
    }
}
