//! Parameters of a relief material: depth, reference plane, light, and softness of shadows.

use crate::InputError;
use crate::surface::relief::{MAX_SCALE, MAX_STEPS};

/// How a relief casts shadows onto itself.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default, serde::Serialize)]
#[serde(rename_all = "lowercase")]
pub enum ReliefShadow {
    /// No self-shadowing.
    #[default]
    None,
    /// Hard shadows: a ray from the light is traced with the same method as the eye's ray.
    Hard,
    /// Soft shadows with penumbras, from height samples along the path to the light.
    Soft,
}

/// Direction in the image that the green channel of a normal map points to.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default, serde::Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Green {
    /// Up the image, opposite to v, as in glTF and OpenGL.
    #[default]
    Up,
    /// Down the image, along v, as in Direct3D.
    Down,
}

/// Parameters of a relief apart from its maps. They may change without a new pipeline. Options such as shadows and silhouettes
/// are compiled into the pipeline instead (`surface::ReliefOptions`).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ReliefMaterial {
    /// Depth of the relief in uv units (1 = one tile), 0 to [`MAX_SCALE`].
    pub scale: f32,
    /// Height of the polygon within the relief, from 0 (bottom) to 1 (top).
    ///
    /// **Decided**: 1 by default, for every method. Thesis B puts the polygon at the top in its text (3.1.2) and at the bottom in
    /// its table 4.4. The parallax bias in its section 3.1.1 puts the polygon in the middle, which is ½ here.
    pub plane: f32,
    /// Unit vector towards the light, in world space.
    pub light: [f32; 3],
    /// Fraction of the light that shadowed points still receive, 0 to 1.
    pub ambient: f32,
    /// Number of height samples between a point and the light for a soft shadow, 1 to 1024.
    pub shadow_steps: u32,
    /// Ratio at which a soft shadow becomes fully dark, > 0. Each height sample on the path to the light has a ratio: the height
    /// of the surface above the path, divided by the path's rise since the shaded point.
    pub softness: f32,
}

impl Default for ReliefMaterial {
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

impl ReliefMaterial {
    /// Checks that all values are within their bounds and that `light` is a unit vector.
    ///
    /// # Errors
    /// [`InputError`] that names the first invalid field.
    pub fn validate(&self) -> Result<(), InputError> {
        InputError::check_within("scale", self.scale, 0.0..=MAX_SCALE)?;
        InputError::check_within("plane", self.plane, 0.0..=1.0)?;
        InputError::check_within("ambient", self.ambient, 0.0..=1.0)?;
        InputError::check_within("softness", self.softness, 1e-3..=1e3)?;
        InputError::check_within("shadow_steps", self.shadow_steps, 1..=MAX_STEPS)?;
        let length: f32 = self.light.iter().map(|axis| axis * axis).sum();
        if !(0.99..=1.01).contains(&length) {
            let value = format!("{:?}", self.light);
            return Err(InputError::new("light", value, "must be a unit vector towards the light"));
        }
        Ok(())
    }
}
