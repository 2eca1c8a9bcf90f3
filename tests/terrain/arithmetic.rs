//! Compares the exact arithmetic of the shaders, run on the adapter, with arithmetic that cannot overflow.

use relievo::gpu::shaders::{TERRAIN_HEIGHT, TERRAIN_WRAP};
use relievo::ops::terrain::config::HEIGHT_LIMIT;
use relievo_lab::cases::terrain::{random_heights, random_words};

use crate::harness::gpu;
use crate::properties::exact_mean;
use crate::shader::called;

const LIMIT: i32 = HEIGHT_LIMIT as i32;

/// Groups of four heights: at the limits and around 0, random up to the limits, and small.
fn corners() -> Vec<[i32; 4]> {
    let values = [-LIMIT, 1 - LIMIT, -3, -2, -1, 0, 1, 2, 3, LIMIT - 1, LIMIT];
    let digits =
        |index: usize| [0, 1, 2, 3].map(|digit| values[index / values.len().pow(digit) % values.len()]);
    let random = [random_heights(1, 40_000, LIMIT), random_heights(2, 40_000, 9)].concat();
    let random = random.chunks_exact(4).map(|four| [four[0], four[1], four[2], four[3]]);
    (0..values.len().pow(4)).map(digits).chain(random).collect()
}

/// Means of four heights are rounded half up in every lane.
#[test]
fn means_of_the_shaders_are_exact() {
    let (gpu, corners) = (gpu(), corners());
    let given: Vec<_> = corners.iter().map(|corners| corners.map(|height| height as u32)).collect();
    // Each lane has the corners in another order, on which the mean does not depend.
    let lanes = "
        let a = bitcast<vec4<i32>>(given[at]);
        let b = a.yzwx;
        let c = a.zwxy;
        let d = a.wxyz;";
    for (shader, mean) in
        [(&TERRAIN_WRAP, "mean_of_four(a, b, c, d)"), (&TERRAIN_HEIGHT, "mean_of_four(a, b, c, d)")]
    {
        let found = called(&gpu, shader, &format!("{lanes} found[at] = bitcast<vec4<u32>>({mean});"), &given);
        for (corners, found) in corners.iter().zip(found) {
            assert_eq!(found.map(|word| word as i32), [exact_mean(*corners); 4], "{mean} of {corners:?}");
        }
    }
}

/// Computes the high word of the product of two words in every lane.
#[test]
fn high_words_of_the_shaders_are_exact() {
    let edges = [0, 1, 0xffff, 0x1_0000, 0x1_0001, 0x7fff_ffff, 0x8000_0000, 0xffff_0000, 0xffff_ffff];
    let pairs = edges.into_iter().flat_map(|a| edges.map(|b| [a, b]));
    let random = random_words(3, 40_000);
    let pairs = pairs.chain(random.chunks_exact(2).map(|pair| [pair[0], pair[1]]));
    let given: Vec<_> = pairs.map(|[a, b]| [a, !a, a >> 7, b]).collect();
    let body = "found[at] = multiply_high(vec4<u32>(given[at].xyz, 5u), given[at].w);";
    for (given, found) in given.iter().zip(called(&gpu(), &TERRAIN_HEIGHT, body, &given)) {
        let [x, y, z, b] = *given;
        let high = |a: u32| ((u64::from(a) * u64::from(b)) >> 32) as u32;
        assert_eq!(found, [x, y, z, 5].map(high), "{given:?}");
    }
}
