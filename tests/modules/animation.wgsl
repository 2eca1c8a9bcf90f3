// A shader of somebody's own behind the module: where given times fall in a looping and in a clamped clip of two seconds,
// and a turn about z by a quarter at those shares of the way.
@group(0) @binding(0) var<storage, read> given: array<f32>;
@group(0) @binding(1) var<storage, read_write> results: array<u32>;

@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    if id.x >= arrayLength(&given) {
        return;
    }
    let time = given[id.x];
    let place = inside_clip(0u, 2.0, time);
    let quarter = vec4<f32>(0.0, 0.0, sqrt(0.5), sqrt(0.5));
    let turned = slerp(vec4<f32>(0.0, 0.0, 0.0, 1.0), quarter, 0.5 * place);
    let clip_clock = ClipClock(3u, (UPDATE_REASON_FORCED << 20u) | 32768u, 0u, 3u, 32768u);
    // A bone that had moved 1000 units at row 3 and moves 500 more until row 4, of 4000 in all.
    let now = motion_at(vec2<u32>(1000u, 500u), fraction_of(clip_clock));
    let groups = rows_of_workgroups(70001u, 65535u);
    let own = array<u32, 8>(
        bitcast<u32>(place), bitcast<u32>(inside_clip(WRAP_CLAMP, 2.0, time)), bitcast<u32>(turned.z),
        bitcast<u32>(unit_quaternion(2.0 * turned).w), update_reason_of(clip_clock), motion_between(now, 3900u, 4000u),
        groups.x, groups.y);
    var at = 8u * id.x;
    for (var word = 0u; word < 8u; word++) {
        results[at + word] = own[word];
    }
}
