//! Conversion between sRGB and linear light (IEC 61966-2-1).

use std::sync::LazyLock;

/// The least linear channel of each byte from 1 on.
static FIRSTS: LazyLock<[f32; 255]> = LazyLock::new(|| {
    std::array::from_fn(|byte| {
        // Bits of numbers from 0 to 1 have the numbers' order.
        let (mut low, mut high) = (0_u32, 1_f32.to_bits());
        while low < high {
            let middle = low.midpoint(high);
            let is_below = usize::from(encoded(f32::from_bits(middle))) <= byte;
            (low, high) = if is_below { (middle + 1, high) } else { (low, middle) };
        }
        f32::from_bits(low)
    })
});

/// Converts a linear channel to an sRGB byte. Values outside 0 to 1 are clamped.
pub fn byte(linear: f32) -> u8 {
    FIRSTS.partition_point(|first| *first <= linear) as u8
}

/// The byte of a linear channel from 0 to 1, by the transfer curve.
fn encoded(linear: f32) -> u8 {
    let encoded =
        if linear <= 0.003_130_8 { 12.92 * linear } else { 1.055 * libm::powf(linear, 1.0 / 2.4) - 0.055 };
    (encoded * 255.0 + 0.5) as u8
}

/// Converts an sRGB byte to a linear channel, 0 to 1.
pub fn linear(byte: u8) -> f32 {
    let encoded = f32::from(byte) / 255.0;
    if encoded <= 0.040_45 { encoded / 12.92 } else { libm::powf((encoded + 0.055) / 1.055, 2.4) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bytes_come_back() {
        assert!((0..=255).all(|value| byte(linear(value)) == value));
        // By the transfer curve of IEC 61966-2-1, half the light encodes to 188, not 128.
        assert_eq!([0.0, 0.5, 1.0, -1.0, 2.0].map(byte), [0, 188, 255, 0, 255]);
        assert!((linear(128) - 0.215_86).abs() < 1e-5);
    }

    #[test]
    fn bytes_are_those_of_the_curve() {
        let steps = FIRSTS.iter().flat_map(|first| [first.next_down(), *first, first.next_up()]);
        for channel in (0..100_000).map(|part| part as f32 / 99_999.0).chain(steps) {
            assert_eq!(byte(channel), encoded(channel), "{channel}");
        }
        assert_eq!(byte(f32::NAN), 0);
    }
}
