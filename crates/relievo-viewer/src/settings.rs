//! What the viewer remembers from one start to the next.

use serde::{Deserialize, Serialize};

use crate::controls::Drag;
use crate::stage::Colors;

/// Light or dark.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Theme {
    /// As the system is.
    #[default]
    System,
    /// Light.
    Light,
    /// Dark.
    Dark,
}

impl Theme {
    pub(crate) const ALL: [(Self, &'static str); 3] =
        [(Self::System, "system"), (Self::Light, "light"), (Self::Dark, "dark")];

    pub(crate) fn preference(self) -> egui::ThemePreference {
        match self {
            Self::System => egui::ThemePreference::System,
            Self::Light => egui::ThemePreference::Light,
            Self::Dark => egui::ThemePreference::Dark,
        }
    }
}

/// What the viewer remembers.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct Settings {
    /// Light or dark.
    pub theme: Theme,
    /// Whether the panel is open.
    pub panel: bool,
    /// What surfaces are drawn in.
    pub colors: Colors,
    /// What a drag moves.
    pub drag: Drag,
    /// Whether bounding boxes are painted.
    pub bounds: bool,
    /// Whether the edges of triangles are painted.
    pub wires: bool,
    /// Whether the bones of the chosen character are painted.
    pub bones: bool,
    /// Bits a second at which files arrive; `None` for no limit.
    pub throttle: Option<f64>,
    /// Names of files that were opened, the newest first.
    pub recent: Vec<String>,
}

impl Default for Settings {
    fn default() -> Self {
        Self {
            theme: Theme::System,
            panel: true,
            colors: Colors::Shaded,
            drag: Drag::Orbit,
            bounds: false,
            wires: false,
            bones: false,
            throttle: None,
            recent: Vec::new(),
        }
    }
}

/// Number of names of files that are remembered.
const RECENT: usize = 6;

impl Settings {
    /// Settings from their text; the default ones where it is of another version, or damaged.
    pub fn from_json(text: &str) -> Self {
        serde_json::from_str(text).unwrap_or_default()
    }

    /// The settings as text.
    pub fn to_json(&self) -> String {
        serde_json::to_string_pretty(self).unwrap_or_default()
    }

    /// Remembers the name of a file that was opened.
    pub(crate) fn opened(&mut self, name: &str) {
        self.recent.retain(|other| other != name);
        self.recent.insert(0, name.to_owned());
        self.recent.truncate(RECENT);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn settings_survive_and_damaged_ones_are_default() {
        let mut settings = Settings { theme: Theme::Light, throttle: Some(2e6), ..Settings::default() };
        for at in 0..9 {
            settings.opened(&format!("{}.glb", at % 8));
        }
        assert_eq!(settings.recent, ["0.glb", "7.glb", "6.glb", "5.glb", "4.glb", "3.glb"]);
        assert_eq!(Settings::from_json(&settings.to_json()), settings);
        assert_eq!(Settings::from_json("{\"panel\": 7}"), Settings::default());
        assert!(!Settings::from_json("{\"panel\": false, \"of a later version\": 1}").panel);
    }
}
