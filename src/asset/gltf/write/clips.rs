//! Animations of a document: the keys of bones and of morph weights.

use serde_json::{Value, json};

use super::binary::Binary;
use crate::asset::clip::{Clip, Interpolation, Part, Track};
use crate::asset::{Mesh, Model};

/// The animations of a model's clips, without those that have no keys. `weighted` are the nodes whose meshes have keys of
/// weights, each with its first mesh.
pub(super) fn clips(model: &Model, weighted: &[(usize, usize)], binary: &mut Binary) -> Vec<Value> {
    let mut written = Vec::new();
    for (index, clip) in model.clips.iter().enumerate() {
        let mut animation = Animation { samplers: Vec::new(), channels: Vec::new(), binary };
        for bone in 0..clip.bones() {
            for part in Part::ALL {
                animation.add_track(clip, bone, part);
            }
        }
        for (node, mesh) in weighted {
            animation.add_weights(index, *node, &model.meshes[*mesh]);
        }
        let Animation { samplers, channels, .. } = animation;
        if !channels.is_empty() {
            written.push(json!({ "name": clip.name(), "samplers": samplers, "channels": channels }));
        }
    }
    written
}

struct Animation<'a> {
    samplers: Vec<Value>,
    channels: Vec<Value>,
    binary: &'a mut Binary,
}

impl Animation<'_> {
    fn add_track(&mut self, clip: &Clip, bone: usize, part: Part) {
        let track = clip.track(bone, part);
        let times = clip.times_of(track);
        if times.is_empty() {
            return;
        }
        let values = values(clip, track, times);
        let (path, output) = match part {
            Part::Rotation => ("rotation", self.binary.floats("VEC4", &values, false)),
            _ => {
                let values: Vec<_> = values.iter().map(|[x, y, z, _]| [*x, *y, *z]).collect();
                let path = if part == Part::Scale { "scale" } else { "translation" };
                (path, self.binary.floats("VEC3", &values, false))
            }
        };
        self.add(times, output, track.interpolation, bone, path);
    }

    fn add_weights(&mut self, clip: usize, node: usize, mesh: &Mesh) {
        let Some((_, keys)) = mesh.weight_keys.iter().find(|(of, _)| *of == clip) else { return };
        let (times, values, interpolation) = keys.parts();
        let output = self.binary.floats("SCALAR", values.as_chunks::<1>().0, false);
        self.add(times, output, interpolation, node, "weights");
    }

    fn add(&mut self, times: &[f32], output: usize, interpolation: Interpolation, node: usize, path: &str) {
        let input = self.binary.floats("SCALAR", times.as_chunks::<1>().0, true);
        let interpolation = match interpolation {
            Interpolation::Step => "STEP",
            Interpolation::Linear => "LINEAR",
            Interpolation::CubicSpline => "CUBICSPLINE",
        };
        let sampler = self.samplers.len();
        self.samplers.push(json!({ "input": input, "output": output, "interpolation": interpolation }));
        self.channels.push(json!({ "sampler": sampler, "target": { "node": node, "path": path } }));
    }
}

/// The values of a track. Clips hold tangents of splines multiplied by the seconds beside their keys, and glTF does not.
fn values(clip: &Clip, track: &Track, times: &[f32]) -> Vec<[f32; 4]> {
    let each = if track.interpolation == Interpolation::CubicSpline { 3 } else { 1 };
    let mut values = clip.values()[track.first_value as usize..][..each * times.len()].to_vec();
    if each == 3 {
        for (key, pair) in times.windows(2).enumerate() {
            let seconds = pair[1] - pair[0];
            for at in [3 * key + 2, 3 * key + 3] {
                values[at] = values[at].map(|tangent| if seconds > 0.0 { tangent / seconds } else { 0.0 });
            }
        }
    }
    values
}
