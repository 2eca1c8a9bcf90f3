//! `relievo view`: the viewer in a window, or one picture of it.

use std::path::PathBuf;

use clap::Args;
use glam::DVec3;
use relievo::asset::encode_png;
use relievo::{Error, InputError};
use relievo_lab::files::write_file;
use relievo_viewer::{Colors, Options, Start, draw, point};

use crate::Context;
use crate::arguments::size;
use crate::output::say;
use crate::progress::during;

/// Opens the viewer: a scene, a model, a package or terrain in a window, with every control of level of detail.
///
/// A FILE is a scene file (docs/scene-files.md), a model (.glb, .gltf, .obj), a package that `relievo cook` wrote (.rlv), or a
/// configuration of terrain (docs/terrain.md). Without one, the viewer shows mountains without end. Files that are dropped onto
/// the window open, too.
///
/// Drag to turn, scroll to come nearer, press ? for all keys. The panel has:
///
///   Detail     the largest error in pixels, limits of triangles and time, how levels are chosen and change; full detail
///              beside it; colours by level, bounding boxes
///   Bones      the gate that chooses which bones are sampled; the bones of a character as the device has them
///   Time       pause, steps, slow motion, the scene's camera, bookmarks
///   Light      sun, ambient light, exposure
///   Plots      milliseconds, triangles, bones and pixels of the last frames
///   Experiment frame time against distance (Chakra 2008, section 13)
///
/// "Save scene" writes the scene file as it now is, and "Copy command" gives a command that draws the same picture:
///
/// relievo view examples/scenes/ruins.json
/// relievo view fox.glb --pixels 4
/// relievo view fox.glb --at 0,1,4 --look 0,0.5,0 --size 960x600 --picture fox.png
#[derive(Args)]
#[command(verbatim_doc_comment)]
pub struct View {
    /// What to open.
    #[arg(value_name = "FILE|URL")]
    scene: Option<String>,
    /// By how many pixels anything may be off; 0 is full detail. Default: the scene's own.
    #[arg(long, value_name = "E", allow_hyphen_values = true)]
    pixels: Option<f32>,
    /// The largest number of triangles to draw. Default: the scene's own.
    #[arg(long, value_name = "N")]
    triangles: Option<u32>,
    /// The position of the camera. Default: the scene's own, or one that shows all of it.
    #[arg(long, value_name = "X,Y,Z", requires = "look", allow_hyphen_values = true, value_parser = |text: &str| point("at", text))]
    at: Option<DVec3>,
    /// The point that the camera looks at.
    #[arg(long, value_name = "X,Y,Z", requires = "at", allow_hyphen_values = true, value_parser = |text: &str| point("look", text))]
    look: Option<DVec3>,
    /// The direction towards the light. Default: the scene's own.
    #[arg(long, value_name = "X,Y,Z", allow_hyphen_values = true, value_parser = |text: &str| point("light", text))]
    light: Option<DVec3>,
    /// The time of the scene in seconds, which then stands still.
    #[arg(long, value_name = "S", allow_hyphen_values = true)]
    time: Option<f64>,
    /// Colours everything by its level of detail.
    #[arg(long)]
    levels: bool,
    /// Width and height of the window in points, or of the picture in pixels.
    #[arg(long, value_name = "WxH", default_value = "1280x800", value_parser = size(8192))]
    size: [u32; 2],
    /// Draws one picture into a PNG file, without a window.
    #[arg(long, value_name = "FILE")]
    picture: Option<PathBuf>,
}

impl View {
    pub fn run(&self, context: &Context) -> Result<(), Error> {
        let start = self.start()?;
        let Some(path) = &self.picture else {
            return relievo_viewer::run(Options {
                start,
                adapter: context.options.adapter.clone(),
                size: Some(self.size),
                settings: Options::users_settings(),
            });
        };
        let gpu = context.gpu()?;
        let picture = during("drawing", || draw(&gpu, &start, self.size))?;
        let encoded = encode_png(self.size, &picture, image::ExtendedColorType::Rgba8);
        write_file(path, &encoded.map_err(|error| Error::output(path, error))?)?;
        say(path.display())
    }

    fn start(&self) -> Result<Start, InputError> {
        let Self { scene, pixels, triangles, time, .. } = self;
        if let Some(pixels) = pixels.filter(|pixels| !(0.0..=64.0).contains(pixels)) {
            return Err(InputError::new("pixels", pixels, "must be in 0..=64"));
        }
        if let Some(0) = triangles {
            return Err(InputError::new("triangles", 0, "must be at least 1"));
        }
        if let Some(time) = time.filter(|time| !time.is_finite()) {
            return Err(InputError::new("time", time, "must be finite"));
        }
        Ok(Start {
            scene: scene.clone(),
            pixels: *pixels,
            triangles: *triangles,
            camera: self.at.zip(self.look).map(|(at, look)| [at, look]),
            light: self.light,
            time: *time,
            colors: self.levels.then_some(Colors::Levels),
        })
    }
}
