// Where instances stand in their clips: for each instance and timeline of its clip the key before, and the way to the
// next. A thread finds one of them.
import package::wgsl::animation::clip::ClipEntry;
import package::wgsl::animation::clock::clock;
import package::wgsl::animation::instance::AnimationInstance;

struct PlaceParams {
    instances: u32,
    // Room of an instance for its places.
    timelines: u32,
    // Seconds since the instances' starts.
    elapsed: f32,
}

@group(0) @binding(0) var<uniform> params: PlaceParams;
@group(0) @binding(1) var<storage, read> instances: array<AnimationInstance>;
@group(0) @binding(2) var<storage, read> clips: array<ClipEntry>;
// First time and number of keys.
@group(0) @binding(3) var<storage, read> timelines: array<vec2<u32>>;
@group(0) @binding(4) var<storage, read> times: array<f32>;
// Key and, as bits, fraction.
@group(0) @binding(5) var<storage, read_write> places: array<vec2<u32>>;

fn place(first: u32, keys: u32, time: f32) -> vec2<u32> {
    let last = keys - 1u;
    let start = times[first];
    if time < start {
        return vec2<u32>(0u);
    }
    let end_time = times[first + last];
    if time >= end_time {
        return vec2<u32>(last, 0u);
    }
    // Most clips are sampled evenly: a guess hits.
    let evenly = (time - start) / (end_time - start) * f32(last);
    var key = min(u32(evenly), last - 1u);
    var before = times[first + key];
    var after = times[first + key + 1u];
    if before > time || after <= time {
        var end = last;
        key = 0u;
        while end - key > 1u {
            let middle = (key + end) / 2u;
            if times[first + middle] <= time {
                key = middle;
            } else {
                end = middle;
            }
        }
        before = times[first + key];
        after = times[first + key + 1u];
    }
    return vec2<u32>(key, bitcast<u32>((time - before) / (after - before)));
}

@compute @workgroup_size(64)
fn main(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) lane: u32,
) {
    let index = (group.y * groups.x + group.x) * 64u + lane;
    let instance_index = index / params.timelines;
    if instance_index >= params.instances {
        return;
    }
    let instance = instances[instance_index];
    let clip = clips[instance.clip];
    let timeline_index = index - instance_index * params.timelines;
    if timeline_index >= clip.timelines {
        return;
    }
    let timeline = timelines[clip.first_timeline + timeline_index];
    let now = clock(instance.wrap, clip.duration, instance.start + instance.rate * params.elapsed);
    places[index] = place(timeline.x, timeline.y, now.inside);
}
