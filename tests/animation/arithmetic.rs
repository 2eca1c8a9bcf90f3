//! The shaders' integer arithmetic on the adapter, against wider integers.

use relievo::gpu::shaders::{ANIMATION_BUDGET, ANIMATION_GATE};
use relievo::ops::animation::budget::reference::rank_of;
use relievo::ops::animation::gate_table::sums::{motion_at, motion_between, scale_by_fraction};
use relievo_lab::cases::animation::Draw;

use crate::harness::gpu;
use crate::shader::called;

const EDGES: [u32; 9] = [0, 1, 2, 0xffff, 0x1_0000, 0x1_0001, 0x7fff_ffff, 0x8000_0000, 0xffff_ffff];

/// Combinations of extreme values, and random words of every length; `last` maps the last word of each
/// element into the range that the test needs.
fn given(case: u32, last: impl Fn(u32) -> u32) -> Vec<[u32; 4]> {
    let mut draw = Draw::new(case);
    let mut given = Vec::new();
    for (a, b) in EDGES.into_iter().flat_map(|a| EDGES.map(|b| (a, b))) {
        given.extend(EDGES.map(|c| [a, b, c, last(c)]));
    }
    for _ in 0..20_000 {
        let [a, b, c, d] = [0; 4].map(|_| draw.word() >> (draw.word() % 32));
        given.push([a, b, c, last(d)]);
    }
    given
}

/// value · fraction / 65536 without overflow: its integer part, and the same for sums that wrap.
#[test]
fn motion_of_the_shaders_is_exact() {
    // Fractions from 0 to 65536.
    let given = given(1, |word| if word > 65536 { word % 65537 } else { word });
    let body = "
        let all = given[at];
        found[at] = vec4<u32>(
            scale_by_fraction(all.x, all.w), motion_at(all.xy, all.w), motion_between(all.x, all.y, all.z), 0u);";
    for (given, found) in given.iter().zip(called(&gpu(), &ANIMATION_GATE, body, &given)) {
        let [x, y, z, fraction] = *given;
        let floor = |value: u32| (u128::from(value) * u128::from(fraction) / 65536) as u32;
        let direct = (i64::from(x) - i64::from(y)).abs();
        let expected = [
            floor(x),
            (u64::from(x) + u64::from(floor(y))) as u32,
            direct.min((i64::from(z) - direct).max(0)) as u32,
            0,
        ];
        assert_eq!(found, expected, "the shader of {given:?}");
        let reference =
            [scale_by_fraction(x, fraction), motion_at([x, y], fraction), motion_between(x, y, z), 0];
        assert_eq!(reference, expected, "the reference of {given:?}");
    }
}

/// Sixteen ranks per octave of a 48-bit product, computed in 32-bit words: they equal the reference's, which
/// are close to the logarithm.
#[test]
fn ranks_of_the_shader_are_the_references() {
    let given = given(2, |word| word & 0xffff);
    let body = "found[at] = vec4<u32>(rank_of(given[at].x, given[at].w), 0u, 0u, 0u);";
    for (given, found) in given.iter().zip(called(&gpu(), &ANIMATION_BUDGET, body, &given)) {
        assert_eq!(found[0], rank_of(given[0], given[3]), "{given:?}");
    }
}
