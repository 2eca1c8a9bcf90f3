//! Parsers of `--skinning` and `--mesh`.

use relievo::InputError;
use relievo_lab::measure::{MeshDetail, SkinningDetail};

/// Parses `--skinning`: the influences that vertices follow.
pub fn skinning(text: &str) -> Result<SkinningDetail, InputError> {
    if text == "fade" || text.starts_with("truncate:") {
        let bound =
            "must be full or bounded:PIXELS, as a scene skins; `relievo skin --influences` has the others";
        return Err(InputError::new("skinning", text, bound));
    }
    match pixels("skinning", text, "bounded") {
        Some(pixels) => Ok(SkinningDetail::Bounded { pixels: pixels? }),
        None if text == "full" => Ok(SkinningDetail::Full),
        None => Err(InputError::new("skinning", text, "must be full or bounded:PIXELS")),
    }
}

/// Parses `--mesh`: the triangles that meshes have.
pub fn mesh(text: &str) -> Result<MeshDetail, InputError> {
    if let Some(pixels) = pixels("mesh", text, "geomorph") {
        return Ok(MeshDetail::Geomorph { pixels: pixels? });
    }
    match pixels("mesh", text, "bounded") {
        Some(pixels) => Ok(MeshDetail::Bounded { pixels: pixels? }),
        None if text == "full" => Ok(MeshDetail::Full),
        None => Err(InputError::new("mesh", text, "must be full, bounded:PIXELS or geomorph:PIXELS")),
    }
}

/// Parses the pixels after a word and a colon; `None` if the text begins otherwise.
fn pixels(field: &str, text: &str, word: &str) -> Option<Result<f32, InputError>> {
    let pixels = text.strip_prefix(word)?.strip_prefix(':')?;
    let within = pixels.parse().ok().filter(|pixels| (0.0..=1e6).contains(pixels));
    Some(within.ok_or_else(|| InputError::new(field, text, format!("must be {word}: and 0 to 1e6 pixels"))))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_read_as_they_are_written() {
        for name in ["full", "bounded:0.25"] {
            assert_eq!(skinning(name).expect("valid").to_string(), name);
            assert_eq!(mesh(name).expect("valid").to_string(), name);
        }
        assert_eq!(mesh("geomorph:2").expect("valid").to_string(), "geomorph:2");
        for name in ["geomorph", "geomorph:", "geomorph:-1", "geomorph:1e7"] {
            assert_eq!(mesh(name).expect_err("refused").path, "mesh", "{name}");
            assert!(skinning(name).is_err(), "{name}");
        }
        for name in ["fade", "truncate:2", "truncate:x"] {
            assert!(skinning(name).expect_err("refused").bound.contains("relievo skin"), "{name}");
        }
        for name in ["", "bounded", "bounded:-1", "bounded:NaN", "bounded:x", "half", "full:1"] {
            assert_eq!(skinning(name).expect_err("refused").path, "skinning", "{name}");
            assert_eq!(mesh(name).expect_err("refused").path, "mesh", "{name}");
        }
    }
}
