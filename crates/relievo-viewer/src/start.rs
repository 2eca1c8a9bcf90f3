//! What to open and how, from the command line or from the address of a page.

use glam::DVec3;
use percent_encoding::{NON_ALPHANUMERIC, percent_decode_str, utf8_percent_encode};
use relievo::InputError;

use crate::controls::QualityControls;
use crate::eye::Eye;
use crate::shown::Shown;
use crate::stage::Colors;

/// What to open at the start, and how.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Start {
    /// The name of the file; `None` for the scene that the viewer brings along.
    pub scene: Option<String>,
    /// Pixels by which anything may be off.
    pub pixels: Option<f32>,
    /// Largest number of triangles.
    pub triangles: Option<u32>,
    /// The position of the camera and the point that it looks at.
    pub camera: Option<[DVec3; 2]>,
    /// The direction towards the light.
    pub light: Option<DVec3>,
    /// The time of the scene in seconds, which then stands still.
    pub time: Option<f64>,
    /// What surfaces are drawn in.
    pub colors: Option<Colors>,
}

impl Start {
    /// Reads the query of a page's address, such as `?scene=fox.glb&pixels=2&at=0,1,4&look=0,0,0`. Names that it does not know are
    /// ignored.
    ///
    /// # Errors
    /// [`InputError`] that names the part and its bound.
    pub fn from_query(query: &str) -> Result<Self, InputError> {
        let mut start = Self::default();
        let mut ends = [None, None];
        for part in query.trim_start_matches('?').split('&') {
            let (name, value) = part.split_once('=').unwrap_or((part, ""));
            let value = percent_decode_str(value).decode_utf8_lossy().into_owned();
            match name {
                "scene" => start.scene = Some(value),
                "pixels" => start.pixels = Some(number(name, &value)?),
                "triangles" => start.triangles = Some(number(name, &value)?),
                "time" => start.time = Some(number(name, &value)?),
                "at" => ends[0] = Some(point(name, &value)?),
                "look" => ends[1] = Some(point(name, &value)?),
                "light" => start.light = Some(point(name, &value)?),
                "levels" => start.colors = Some(Colors::Levels),
                _ => {}
            }
        }
        start.camera = match ends {
            [Some(at), Some(look)] => Some([at, look]),
            [None, None] => None,
            _ => return Err(InputError::new("at", "one of at and look", "must be given with the other")),
        };
        Ok(start)
    }

    /// What opens a scene as it is shown now.
    pub(crate) fn of(scene: String, shown: &Shown, colors: Colors) -> Self {
        let [at, look] = match shown.clock.follows {
            true => {
                let camera = shown.camera([960, 600]);
                let eye = Eye::of(&camera, shown.eye.distance);
                [eye.position(), eye.focus()]
            }
            false => [shown.eye.position(), shown.eye.focus()],
        };
        Self {
            scene: Some(scene),
            pixels: Some(shown.quality.pixels),
            triangles: shown.quality.has_triangles.then_some(shown.quality.triangles),
            camera: Some([at, look]),
            light: Some(shown.light.direction.as_dvec3()),
            time: Some(shown.time()),
            colors: (colors == Colors::Levels).then_some(colors),
        }
    }

    /// The parts of the query and of the command, with their values.
    fn parts(&self) -> Vec<(&'static str, String)> {
        let list = |point: DVec3| point.to_array().map(|axis| format!("{axis:.4}")).join(",");
        let mut parts = Vec::new();
        parts.extend(self.pixels.map(|pixels| ("pixels", pixels.to_string())));
        parts.extend(self.triangles.map(|triangles| ("triangles", triangles.to_string())));
        parts.extend(self.camera.iter().flat_map(|[at, look]| [("at", list(*at)), ("look", list(*look))]));
        parts.extend(self.light.map(|light| ("light", list(light))));
        parts.extend(self.time.map(|time| ("time", format!("{time:.4}"))));
        parts
    }

    /// The query of a page's address.
    pub fn query(&self) -> String {
        let encoded = |text: &str| utf8_percent_encode(text, NON_ALPHANUMERIC).to_string();
        let scene = self.scene.iter().map(|scene| format!("scene={}", encoded(scene)));
        let parts = self.parts().into_iter().map(|(name, value)| format!("{name}={value}"));
        let levels = self.colors.filter(|colors| *colors == Colors::Levels).map(|_| "levels".to_owned());
        scene.chain(parts).chain(levels).collect::<Vec<_>>().join("&")
    }

    /// The command that draws the picture, with this size in pixels, into a file.
    pub fn command(&self, [width, height]: [u32; 2]) -> String {
        let scene = self.scene.iter().map(|scene| format!("'{}'", scene.replace('\'', r"'\''")));
        let parts = self.parts().into_iter().map(|(name, value)| format!("--{name}={value}"));
        let levels = self.colors.filter(|colors| *colors == Colors::Levels).map(|_| "--levels".to_owned());
        let rest = scene.chain(parts).chain(levels).collect::<Vec<_>>().join(" ");
        format!("relievo view {rest} --size {width}x{height} --picture picture.png")
    }

    /// Gives a scene that was opened what the start asks for.
    pub(crate) fn apply(&self, shown: &mut Shown) {
        let Self { pixels, triangles, camera, light, time, .. } = self;
        let own = shown.quality;
        shown.quality = QualityControls {
            pixels: pixels.unwrap_or(own.pixels),
            has_triangles: triangles.is_some() || own.has_triangles,
            triangles: triangles.unwrap_or(own.triangles),
            ..own
        };
        if let Some([at, look]) = camera {
            shown.take_camera();
            shown.eye = Eye::between(*at, *look);
        }
        if let Some(light) = light.filter(|light| *light != DVec3::ZERO) {
            shown.light.direction = light.normalize().as_vec3();
        }
        if let Some(time) = time {
            // A time that is no number was refused before.
            let _ = shown.advance((time - shown.time()) as f32);
            shown.clock.plays = false;
        }
    }
}

fn number<T: std::str::FromStr>(name: &str, value: &str) -> Result<T, InputError> {
    value.parse().map_err(|_| InputError::new(name, value, "must be a number"))
}

/// A point of three numbers with commas between them.
///
/// # Errors
/// [`InputError`] for anything else.
pub fn point(name: &str, value: &str) -> Result<DVec3, InputError> {
    let parts: Result<Vec<f64>, _> = value.split(',').map(|part| part.trim().parse()).collect();
    match parts.as_deref() {
        Ok(&[x, y, z]) if [x, y, z].iter().all(|axis| axis.is_finite()) => Ok(DVec3::new(x, y, z)),
        _ => Err(InputError::new(
            name,
            value,
            "must be three numbers with commas between them, such as 0,1.5,4",
        )),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn addresses_say_what_to_open() {
        let start = Start::from_query(
            "?scene=a%20b.glb&pixels=2.5&triangles=9&at=1,2,3&look=0,0,-1e3&light=0,2,-1&utm=x&levels",
        );
        let camera = Some([DVec3::new(1.0, 2.0, 3.0), DVec3::new(0.0, 0.0, -1000.0)]);
        let expected = Start {
            scene: Some("a b.glb".to_owned()),
            pixels: Some(2.5),
            triangles: Some(9),
            camera,
            light: Some(DVec3::new(0.0, 2.0, -1.0)),
            time: None,
            colors: Some(Colors::Levels),
        };
        assert_eq!(start, Ok(expected));
        assert_eq!(Start::from_query(&start.clone().expect("read").query()), start);
        let command = start.expect("read").command([640, 400]);
        let expected = "relievo view 'a b.glb' --pixels=2.5 --triangles=9 --at=1.0000,2.0000,3.0000 \
            --look=0.0000,0.0000,-1000.0000 --light=0.0000,2.0000,-1.0000 --levels --size 640x400 --picture picture.png";
        assert_eq!(command, expected);
        assert_eq!(Start::from_query(""), Ok(Start::default()));
        for (query, path) in
            [("pixels=a", "pixels"), ("at=1,2", "at"), ("look=0,0,NaN", "look"), ("at=0,0,0", "at")]
        {
            assert_eq!(Start::from_query(query).expect_err("refused").path, path, "{query}");
        }
    }
}
