//! What a relief is drawn with: depth, plane, light, the width of its shadows.

use crate::InputError;
use crate::surface::relief::MAX_SCALE;

/// How the surface shades itself.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, serde::Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Shadow {
    /// Not at all.
    #[default]
    None,
    /// The light's ray, traced with the method of the eye's.
    Hard,
    /// Penumbras from samples on the way to the light.
    Soft,
}

impl Shadow {
    /// Its name in options and reports.
    pub fn name(self) -> &'static str {
        match self {
            Self::None => "none",
            Self::Hard => "hard",
            Self::Soft => "soft",
        }
    }
}

/// Where green of a normal map points.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, serde::Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Green {
    /// Up the image, against v: glTF and OpenGL.
    #[default]
    Up,
    /// Down the image, along v: Direct3D.
    Down,
}

/// What a relief is drawn with, beside its maps: what may change without another pipeline. Whether there are shadows
/// and silhouettes is not part of it (`render::ReliefOptions`, `reference::surface::picture::Scene`).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Material {
    /// Depth of the relief in uv units, 0 to [`MAX_SCALE`].
    pub scale: f32,
    /// Height of the polygon in the relief, 0 (bottom) to 1 (top).
    pub plane: f32,
    /// Unit vector towards the light, world space.
    pub light: [f32; 3],
    /// What is in shadow still gets, 0 to 1.
    pub ambient: f32,
    /// Heights on the way to the light that a soft shadow looks at, 1 to 1024.
    pub shadow_steps: u32,
    /// How far the surface rises above the way to the light, over its distance, where a soft shadow is full; > 0.
    pub softness: f32,
}

impl Default for Material {
    fn default() -> Self {
        Self {
            scale: 0.1,
            plane: 1.0,
            light: [-0.529_999, 0.459_619, 0.712_718],
            ambient: 0.25,
            shadow_steps: 32,
            softness: 0.15,
        }
    }
}

impl Material {
    /// Refuses values out of bounds.
    ///
    /// # Errors
    /// [`InputError`].
    pub fn validate(&self) -> Result<(), InputError> {
        let within = |field: &str, value: f32, low: f32, high: f32| match (low..=high).contains(&value) {
            true => Ok(()),
            false => Err(InputError::new(field, value, format!("must be in {low}..={high}"))),
        };
        within("scale", self.scale, 0.0, MAX_SCALE)?;
        within("plane", self.plane, 0.0, 1.0)?;
        within("ambient", self.ambient, 0.0, 1.0)?;
        within("softness", self.softness, 1e-3, 1e3)?;
        if !(1..=crate::surface::relief::MAX_STEPS).contains(&self.shadow_steps) {
            return Err(InputError::new("shadow_steps", self.shadow_steps, "must be in 1..=1024"));
        }
        let length: f32 = self.light.iter().map(|axis| axis * axis).sum();
        if !(0.99..=1.01).contains(&length) {
            let value = format!("{:?}", self.light);
            return Err(InputError::new("light", value, "must be a unit vector towards the light"));
        }
        Ok(())
    }
}
