//! Where every bone of every character was drawn, frame by frame, as numbers for other people's programs.

use std::io::Write;

use relievo::Error;
use relievo::asset::Affine;
use relievo::scene::{Camera, Placement};
use relievo_scene_file::WorldObject;
use serde::Serialize;

use crate::measure::displacement::{matrix, placed};
use crate::measure::player::Player;

/// Describes the numbers that [`CharacterDump::add`] writes: for each frame, for each instance of each character, for each
/// bone the twelve `f32`, little-endian, row by row, of the matrix from the bone's space to the world as it was drawn.
#[derive(Debug, Clone, Default, Serialize)]
pub struct CharacterDump {
    characters: Vec<Character>,
    /// Number of instances of all characters.
    instances: usize,
    frames: Vec<Frame>,
}

#[derive(Debug, Clone, Serialize)]
struct Character {
    file: String,
    clips: Vec<String>,
    /// The names of the bones, in the order of their matrices.
    bones: Vec<String>,
    instances: usize,
}

#[derive(Debug, Clone, Serialize)]
struct Frame {
    seconds: f64,
    camera: FrameCamera,
    /// Those of all characters, one after the other.
    instances: Vec<Instance>,
}

/// Matrices are column-major.
#[derive(Debug, Clone, Serialize)]
struct FrameCamera {
    cell: [i32; 3],
    view_from_world: [f32; 16],
    clip_from_view: [f32; 16],
    viewport: [u32; 2],
}

#[derive(Debug, Clone, Serialize)]
struct Instance {
    /// Index in `characters`.
    character: usize,
    /// Whether a view drew it. If not, its matrices are those of the last frame that did, or 0.
    drawn: bool,
    cell: [i32; 3],
    at: [f32; 3],
    /// A quaternion x, y, z, w.
    turn: [f32; 4],
    scale: [f32; 3],
    clip: usize,
    clip_seconds: f32,
}

impl CharacterDump {
    /// Adds the last frame of a player, and writes its numbers. Waits for the device.
    ///
    /// # Errors
    /// [`Error::Output`] for numbers that cannot be written; [`relievo::gpu::GpuError`].
    pub fn add(&mut self, player: &Player, numbers: &mut impl Write) -> Result<(), Error> {
        let world = player.world();
        let characters = || {
            let with_model = |object| Some((object, WorldObject::character(object)?));
            world.objects.iter().filter_map(with_model)
        };
        if self.frames.is_empty() {
            for (object, model) in characters() {
                let instances = world.scene.instances(object.object)?.len();
                self.instances += instances;
                self.characters.push(Character {
                    file: object.source.clone(),
                    clips: model.clips.iter().map(|clip| clip.name().to_owned()).collect(),
                    bones: model.skeleton.bones().iter().map(|bone| bone.name.clone()).collect(),
                    instances,
                });
            }
        }
        let mut instances = Vec::with_capacity(self.instances);
        for (character, (object, _)) in characters().enumerate() {
            let mut seen = Vec::new();
            for view in player.views() {
                seen.extend(world.scene.seen(view, object.object)?);
            }
            for (instance, bones) in world.scene.drawn_bones(object.object)? {
                let (placement, time) = (world.scene.placement(instance)?, world.scene.clip_time(instance)?);
                write(numbers, &placement, &bones).map_err(|error| Error::output("characters.f32", error))?;
                let Placement { cell, offset, turn, scale } = placement;
                instances.push(Instance {
                    character,
                    drawn: seen.contains(&instance),
                    cell,
                    at: offset.into(),
                    turn: turn.into(),
                    scale: scale.into(),
                    clip: time.map_or(0, |time| time.clip),
                    clip_seconds: time.map_or(0.0, |time| time.seconds),
                });
            }
        }
        let Camera { cell, view_from_cell, clip_from_view, viewport, .. } = player.camera();
        let [view_from_world, clip_from_view] =
            [view_from_cell, clip_from_view].map(|matrix| matrix.to_cols_array());
        let camera = FrameCamera { cell, view_from_world, clip_from_view, viewport };
        self.frames.push(Frame { seconds: world.scene.time(), camera, instances });
        Ok(())
    }
}

/// Writes the matrices of an instance's bones, in the world.
fn write(numbers: &mut impl Write, placement: &Placement, bones: &[Affine]) -> std::io::Result<()> {
    let world = placed(placement, [0; 3]);
    for bone in bones {
        let matrix = world * matrix(bone);
        for row in 0..3 {
            for value in matrix.row(row).to_array() {
                numbers.write_all(&(value as f32).to_le_bytes())?;
            }
        }
    }
    Ok(())
}
