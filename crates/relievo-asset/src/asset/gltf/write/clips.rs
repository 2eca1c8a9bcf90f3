//! Writes the animations of a document: keys of bones and of morph weights.

use serde_json::{Value, json};

use super::binary::Binary;
use crate::asset::clip::{Clip, Interpolation, Keys, TransformPart};
use crate::asset::{Mesh, Model};

/// Writes the animations of a model's clips. Clips without keys are left out. `weighted` lists the nodes whose meshes have
/// weight keys, each with the index of its first mesh.
pub(super) fn clips(model: &Model, weighted: &[(usize, usize)], binary: &mut Binary) -> Vec<Value> {
    let mut written = Vec::new();
    for (index, clip) in model.clips.iter().enumerate() {
        let mut animation = Animation { samplers: Vec::new(), channels: Vec::new(), binary };
        for bone in 0..clip.bones() {
            for part in TransformPart::ALL {
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
    fn add_track(&mut self, clip: &Clip, bone: usize, part: TransformPart) {
        let track = clip.track(bone, part);
        let Keys { times, mut values, interpolation } = clip.stored_keys(track);
        if times.is_empty() {
            return;
        }
        if interpolation == Interpolation::CubicSpline {
            unstretch_tangents(&times, &mut values);
        }
        let three = || values.iter().map(|[x, y, z, _]| [*x, *y, *z]).collect::<Vec<_>>();
        let (path, output) = match part {
            TransformPart::Translation => ("translation", self.binary.floats(&three(), false)),
            TransformPart::Rotation => ("rotation", self.binary.floats(&values, false)),
            TransformPart::Scale => ("scale", self.binary.floats(&three(), false)),
        };
        self.add(&times, output, interpolation, bone, path);
    }

    fn add_weights(&mut self, clip: usize, node: usize, mesh: &Mesh) {
        let Some((_, keys)) = mesh.weight_keys.iter().find(|(of, _)| *of == clip) else { return };
        let (times, values, interpolation) = keys.parts();
        let output = self.binary.floats(values.as_chunks::<1>().0, false);
        self.add(times, output, interpolation, node, "weights");
    }

    fn add(&mut self, times: &[f32], output: usize, interpolation: Interpolation, node: usize, path: &str) {
        let input = self.binary.floats(times.as_chunks::<1>().0, true);
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

/// Divides each tangent by the duration of its segment in seconds. Clips store tangents multiplied by this duration; glTF does
/// not.
fn unstretch_tangents(times: &[f32], values: &mut [[f32; 4]]) {
    for (key, pair) in times.windows(2).enumerate() {
        let seconds = pair[1] - pair[0];
        for value in &mut values[3 * key + 2..=3 * key + 3] {
            *value = value.map(|tangent| if seconds > 0.0 { tangent / seconds } else { 0.0 });
        }
    }
}
