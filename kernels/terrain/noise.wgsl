// Heights of a batch of regions of the plane from octaves of noise. A thread computes one sample; a batch is one dispatch.
import package::wgsl::dispatch::nonuniform;
import package::wgsl::terrain::noise::{
    GENERATOR, NOISE_ONE, NOISE_RIDGED, NOISE_SIMPLEX, noise_times, octave_key, square_noise, triangle_noise,
};

// Parameters of the kernel `terrain/noise`.
struct NoiseParams {
    // Key of the random words.
    key: vec2<u32>,
    // Number of samples along an edge of a region.
    width: u32,
    // Difference of world coordinates between neighbouring samples.
    spacing: u32,
    // Binary logarithm of the base lattice's spacing in world coordinates, 12 to 20.
    base_log2: u32,
    // Number of octaves, at most 20.
    octaves: u32,
    // Ranges of the octaves, in 1/65536 units.
    @align(16) ranges: array<vec4<u32>, 5>,
}

// Parameters of the kernel.
@group(0) @binding(0) var<uniform> params: NoiseParams;
// World coordinates of the first sample of each region, in multiples of the spacing.
@group(0) @binding(1) var<storage, read> origins: array<vec2<i32>>;
// Out: heights of all regions, row by row, in 1/65536 units.
@group(0) @binding(2) var<storage, read_write> heights: array<i32>;

@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    if any(id.xy >= vec2<u32>(params.width)) {
        return;
    }
    let at = (vec2<u32>(origins[id.z]) + id.xy) * params.spacing;
    var height = 0;
    // Weight of ridges: 1, and from octave 1 on what octave 0 gives.
    var weight = NOISE_ONE;
    let octaves = nonuniform(params.octaves, id.x);
    for (var octave = 0u; octave < octaves; octave++) {
        let log2 = params.base_log2 - octave;
        let key = octave_key(params.key, octave);
        var noise = 0;
        if GENERATOR == NOISE_SIMPLEX {
            noise = triangle_noise(key, octave, log2, at);
        } else {
            noise = square_noise(key, log2, at, GENERATOR == NOISE_RIDGED || octave == 0u);
        }
        if GENERATOR == NOISE_RIDGED {
            let size = abs(noise);
            noise = noise_times(NOISE_ONE - size, u32(weight));
            if octave == 0u {
                weight = NOISE_ONE - (size >> 1u);
            }
        }
        height += noise_times(noise, params.ranges[octave / 4u][octave % 4u]);
    }
    heights[(id.z * params.width + id.y) * params.width + id.x] = height;
}
