//! Conversion between sRGB and linear light (IEC 61966-2-1).

/// Converts a linear channel to an sRGB byte. Values outside 0 to 1 are clamped.
pub fn byte(linear: f32) -> u8 {
    let linear = linear.clamp(0.0, 1.0);
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
}
