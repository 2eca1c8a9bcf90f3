//! Parameters of a relief material: depth, plane, light, and softness of shadows.

use crate::InputError;
use crate::surface::relief::{MAX_SCALE, MAX_STEPS};

/// Self-shadowing of the surface.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default, serde::Serialize)]
#[serde(rename_all = "lowercase")]
pub enum ReliefShadow {
    /// No self-shadowing.
    #[default]
    None,
    /// Hard shadows: a ray from the light, traced with the same method as the eye's ray.
    Hard,
    /// Penumbras, from height samples along the way to the light.
    Soft,
}

/// Direction that the green channel of a normal map points to.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default, serde::Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Green {
    /// Up the image, against v, as in glTF and OpenGL.
    #[default]
    Up,
    /// Down the image, along v, as in Direct3D.
    Down,
}

/// Parameters of a relief, besides its maps, that may change without a new pipeline. Options such as shadows and silhouettes
/// are compiled into the pipeline (`surface::ReliefOptions`).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ReliefMaterial {
    /// Depth of the relief in uv units, 0 to [`MAX_SCALE`].
    pub scale: f32,
    /// Height of the polygon within the relief, 0 (bottom) to 1 (top).
    ///
    /// **Decided**: 1 by default, for every method. B's text has the polygon at the top (3.1.2), its table 4.4 at the bottom,
    /// and its bias of parallax in the middle (3.1.1), which is ½ here.
    pub plane: f32,
    /// Unit vector towards the light, in world space.
    pub light: [f32; 3],
    /// Light that shadowed points still receive, 0 to 1.
    pub ambient: f32,
    /// Number of height samples of a soft shadow on the way to the light, 1 to 1024.
    pub shadow_steps: u32,
    /// Ratio at which a soft shadow is full, > 0: the height of the surface above the way to the light, divided by the
    /// height that the way has gained since the shaded point.
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
    /// Refuses values out of bounds.
    ///
    /// # Errors
    /// [`InputError`].
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
