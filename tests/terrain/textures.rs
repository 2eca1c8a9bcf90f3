//! The textures that relievo generates repeat without a seam, use their height maps, and differ from each other.

use relievo::ops::terrain::config::BuiltIn;
use relievo::ops::terrain::texture::{TEXTURE_SIZE, TerrainTexture};

const EDGE: usize = TEXTURE_SIZE as usize;

/// The mean difference of a channel between texels of two columns, or of two rows.
fn step(texels: &[u8], [from, to]: [usize; 2], of_rows: bool) -> f64 {
    let at = |line: usize, place: usize, channel: usize| {
        let texel = if of_rows { line * EDGE + place } else { place * EDGE + line };
        f64::from(texels[4 * texel + channel])
    };
    let pairs = (0..EDGE).flat_map(|place| (0..4).map(move |channel| (place, channel)));
    pairs.map(|(place, channel)| (at(from, place, channel) - at(to, place, channel)).abs()).sum::<f64>()
        / (4 * EDGE) as f64
}

#[test]
fn textures_repeat_without_a_seam() {
    for kind in BuiltIn::ALL {
        let texture = TerrainTexture::built_in(kind);
        let texels = &texture.mips[0];
        for of_rows in [false, true] {
            let inside: Vec<f64> = (1..EDGE).map(|line| step(texels, [line - 1, line], of_rows)).collect();
            let worst = inside.iter().copied().fold(0.0, f64::max);
            let mean = inside.iter().sum::<f64>() / inside.len() as f64;
            let seam = step(texels, [EDGE - 1, 0], of_rows);
            assert!(
                seam <= worst.min(2.5 * mean),
                "{kind:?}: {seam} at the seam, {mean} and at most {worst} inside"
            );
            // A tile of another size would show.
            let elsewhere = step(texels, [EDGE / 2 + 37, 0], of_rows);
            assert!(elsewhere > 1.2 * mean, "{kind:?}: {elsewhere} between lines far apart, {mean} inside");
        }
    }
}

#[test]
fn textures_have_heights_and_no_dark_or_bright_sides() {
    let textures = BuiltIn::ALL.map(TerrainTexture::built_in);
    for (texture, kind) in textures.iter().zip(BuiltIn::ALL) {
        let heights: Vec<u8> = texture.mips[0].chunks_exact(4).map(|texel| texel[3]).collect();
        let mean = heights.iter().map(|height| f64::from(*height)).sum::<f64>() / heights.len() as f64;
        let variance = heights.iter().map(|height| (f64::from(*height) - mean).powi(2)).sum::<f64>()
            / heights.len() as f64;
        assert!(variance.sqrt() > 15.0, "{kind:?}: heights differ by {} only", variance.sqrt());
        // Of the 8 × 8 parts of a tile, none is far from the mean: otherwise the tile would be seen to repeat.
        let parts = &texture.mips[TEXTURE_SIZE.ilog2() as usize - 3];
        let whole = texture.mips.last().expect("one texel");
        for part in parts.chunks_exact(4) {
            let off = (0..3).map(|channel| part[channel].abs_diff(whole[channel])).max();
            assert!(off <= Some(14), "{kind:?}: a part is {off:?} levels off the mean");
        }
    }
    for (at, texture) in textures.iter().enumerate() {
        assert!(textures[..at].iter().all(|other| other != texture));
    }
}
