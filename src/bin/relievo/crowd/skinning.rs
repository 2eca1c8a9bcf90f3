//! `--skinning`, and what is drawn.

use std::fmt;

use relievo::animation::Range;
use relievo::skinning::instance_lod::InstanceLod;
use relievo::{Error, InputError};

/// What is drawn, besides what is measured.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Drawn {
    /// `--image`
    Image,
    /// `--scene`
    Scene,
}

impl Drawn {
    /// Frames that show each time at least once.
    fn least_frames(self) -> u32 {
        match self {
            Self::Image => 5,
            Self::Scene => 11,
        }
    }

    /// Refuses too few frames.
    pub fn check(self, frames: u32) -> Result<(), Error> {
        if frames >= self.least_frames() {
            return Ok(());
        }
        let bound = format!("must be at least {}, as the crowd is drawn", self.least_frames());
        Err(InputError::new("frames", frames, bound).into())
    }
}

/// Which bones a crowd's vertices follow.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Skinning {
    /// The same of every instance.
    All(InstanceLod),
    /// All of them at the first of these distances, in units, one from the second on.
    Fade(Range),
    /// As many as it takes for no vertex to be more than so many pixels off.
    Bounded(f32),
}

/// Every influence of every instance.
#[cfg(feature = "gpu")]
pub const FULL: Skinning = Skinning::All(InstanceLod::FULL);

impl Skinning {
    /// From the command line, with the distances of the fade.
    pub fn new(text: &str, range: Range) -> Result<Self, InputError> {
        let refused =
            || InputError::new("skinning", text, "must be full, truncate:K, fade or bounded:PIXELS");
        if let Some(pixels) = bounded("skinning", text) {
            return pixels.map(Self::Bounded);
        }
        match text.split_once(':') {
            None if text == "full" => Ok(Self::All(InstanceLod::FULL)),
            None if text == "fade" => Ok(Self::Fade(range)),
            Some(("truncate", most)) => {
                InstanceLod::truncate(most.parse().map_err(|_| refused())?).map(Self::All).map_err(|error| {
                    InputError::new("skinning", text, format!("{} {}", error.path, error.bound))
                })
            }
            _ => Err(refused()),
        }
    }
}

/// The pixels of `bounded:PIXELS`, if that is what it is.
pub fn bounded(field: &str, text: &str) -> Option<Result<f32, InputError>> {
    let pixels = text.strip_prefix("bounded:")?;
    let within = pixels.parse().ok().filter(|pixels| (0.0..=1e6).contains(pixels));
    Some(within.ok_or_else(|| InputError::new(field, text, "must be bounded: and 0 to 1e6 pixels")))
}

impl fmt::Display for Skinning {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::All(InstanceLod::FULL) => f.write_str("full"),
            Self::All(instance_lod) => write!(f, "truncate:{}", instance_lod.max_influences),
            Self::Fade(_) => f.write_str("fade"),
            Self::Bounded(pixels) => write!(f, "bounded:{pixels}"),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_read_as_they_are_written() {
        let range = Range { min: 1.0, max: 2.0 };
        for name in ["full", "fade", "truncate:2", "bounded:0.25"] {
            assert_eq!(Skinning::new(name, range).expect("valid").to_string(), name);
        }
        for name in [
            "",
            "truncate",
            "truncate:0",
            "truncate:x",
            "fade:1",
            "half",
            "bounded",
            "bounded:-1",
            "bounded:NaN",
            "bounded:x",
        ] {
            assert_eq!(Skinning::new(name, range).expect_err("refused").path, "skinning", "{name}");
        }
    }
}
