//! Content encodings: gzip, brotli and zstd.

use std::io::Write as _;

use axum::body::Bytes;
use axum::http::HeaderMap;
use axum::http::header::ACCEPT_ENCODING;

/// A content encoding.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Encoding {
    Brotli,
    Zstd,
    Gzip,
}

/// Quality 9 of 11 and a window of 2²²: a tenth of the time of the best, for 2 to 4 % more bytes.
const BROTLI: [u32; 2] = [9, 22];
const BROTLI_BUFFER: usize = 4096;
/// Level 19 of 22, the highest that needs no more memory from a decoder.
const ZSTD: i32 = 19;

impl Encoding {
    const ALL: [Self; 3] = [Self::Brotli, Self::Zstd, Self::Gzip];

    /// The name in HTTP.
    pub fn name(self) -> &'static str {
        match self {
            Self::Brotli => "br",
            Self::Zstd => "zstd",
            Self::Gzip => "gzip",
        }
    }

    /// The ending of files beside the plain file.
    pub fn ending(self) -> &'static str {
        match self {
            Self::Brotli => "br",
            Self::Zstd => "zst",
            Self::Gzip => "gz",
        }
    }

    /// Compresses bytes; `None` if the encoder fails.
    fn encoded(self, bytes: &[u8]) -> Option<Vec<u8>> {
        match self {
            Self::Brotli => {
                let [quality, window] = BROTLI;
                let mut writer = brotli::CompressorWriter::new(Vec::new(), BROTLI_BUFFER, quality, window);
                writer.write_all(bytes).and_then(|()| writer.flush()).ok()?;
                Some(writer.into_inner())
            }
            Self::Zstd => zstd::bulk::compress(bytes, ZSTD).ok(),
            Self::Gzip => {
                let mut writer = flate2::write::GzEncoder::new(Vec::new(), flate2::Compression::best());
                writer.write_all(bytes).ok()?;
                writer.finish().ok()
            }
        }
    }
}

/// The encodings in which bytes become smaller, the smallest first.
pub(super) fn compressed(bytes: &[u8]) -> Vec<(Encoding, Bytes)> {
    let encoded = |encoding: Encoding| Some((encoding, Bytes::from(encoding.encoded(bytes)?)));
    let mut all: Vec<_> = Encoding::ALL.into_iter().filter_map(encoded).collect();
    all.retain(|(_, encoded)| encoded.len() < bytes.len());
    all.sort_by_key(|(_, encoded)| encoded.len());
    all
}

/// Whether a request accepts an encoding: it is named, or `*` is, with a weight above 0.
pub(super) fn accepts(headers: &HeaderMap, encoding: Encoding) -> bool {
    let values = headers.get_all(ACCEPT_ENCODING).iter().filter_map(|value| value.to_str().ok());
    let items: Vec<&str> = values.flat_map(|value| value.split(',')).collect();
    let weight = |name: &str| {
        items.iter().find_map(|item| {
            let (own, parameters) = item.split_once(';').unwrap_or((item, ""));
            let weight = parameters.trim().strip_prefix("q=").map_or(Some(1.0), |q| q.trim().parse().ok());
            own.trim().eq_ignore_ascii_case(name).then_some(weight.unwrap_or(0.0_f32))
        })
    };
    weight(encoding.name()).or_else(|| weight("*")).is_some_and(|weight| weight > 0.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_becomes_larger_is_not_compressed() {
        assert!(compressed(br#"{"patchSize":129,"scaleFactor":14,"seed":"1f"}"#).len() < 3);
        let mut state = 1_u64;
        let noise: [u8; 500] = std::array::from_fn(|_| {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (state >> 56) as u8
        });
        assert!(compressed(&noise).is_empty());
        let text = "vertex ".repeat(500);
        let all = compressed(text.as_bytes());
        assert_eq!(all.len(), 3);
        assert!(all.windows(2).all(|pair| pair[0].1.len() <= pair[1].1.len()));
    }

    #[test]
    fn encodings_are_negotiated_by_name_and_weight() {
        let accepted = |value: &str| {
            let headers = HeaderMap::from_iter([(ACCEPT_ENCODING, value.parse().expect("a header"))]);
            Encoding::ALL.map(|encoding| accepts(&headers, encoding))
        };
        assert_eq!(accepted("gzip, deflate, br;q=0.5"), [true, false, true]);
        assert_eq!(accepted("gzip;q=0, *"), [true, true, false]);
        assert_eq!(accepted("identity"), [false; 3]);
        assert_eq!(accepted("br;q=nonsense"), [false; 3]);
    }
}
