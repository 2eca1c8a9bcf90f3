//! Counts of the characters' work, copied from dispatch arguments that kernels write anyway.

use std::sync::Arc;

use super::{CharacterStatistics, FRAMES, SceneStatistics};
use crate::gpu::{Gpu, GpuError, ReadbackRing};
use crate::scene::character::Character;
use crate::scene::handles::{ObjectId, Slots};
use crate::scene::object::Object;

/// Byte offset of the number of bones or clusters in dispatch arguments of the form `[workgroups x, y, z, number]`.
const NUMBER: u64 = 12;

/// Facts about a frame in flight: its number, and each character's number of meshes and number of chunks.
type About = (u64, Arc<[(ObjectId, [usize; 2])]>);

/// Readback of the counts of a scene's characters.
#[derive(Debug)]
pub(in crate::scene) struct SceneCounts {
    /// Version of the layout for which the buffers were allocated.
    pub version: u64,
    characters: Arc<[(ObjectId, [usize; 2])]>,
    ring: ReadbackRing<About>,
    last: Option<SceneStatistics>,
}

impl SceneCounts {
    /// Allocates buffers for the counts of these objects.
    pub fn new(gpu: &Gpu, version: u64, objects: &Slots<Object>) -> Result<Self, GpuError> {
        let character = |(object, entry): (ObjectId, &Object)| Some((object, entry.character()?.counted()));
        let characters: Arc<[_]> = objects.each().filter_map(character).collect();
        let words: usize = characters.iter().map(|(_, [meshes, chunks])| chunks * (1 + meshes)).sum();
        let ring = ReadbackRing::new(gpu, "statistics of characters", FRAMES, 4 * words as u64)?;
        Ok(Self { version, characters, ring, last: None })
    }

    /// Records commands that copy a frame's counts to a readback buffer, if one is free.
    pub fn record(&mut self, encoder: &mut wgpu::CommandEncoder, frame: u64, objects: &Slots<Object>) {
        self.arrive();
        self.ring.record(encoder, (frame, self.characters.clone()), |encoder, to| {
            let characters = objects.iter().filter_map(|object| object.character());
            let counters = characters.flat_map(Character::counters);
            for (at, counter) in (0..).zip(counters) {
                encoder.copy_buffer_to_buffer(counter.raw(), NUMBER, to, 4 * at, 4);
            }
        });
    }

    /// The statistics of the last frame whose counts have arrived.
    pub fn last(&mut self) -> Option<&SceneStatistics> {
        self.arrive();
        self.last.as_ref()
    }

    /// Discards the readbacks of frames whose encoders were dropped.
    pub fn invalidate(&mut self, gpu: &Gpu) -> Result<(), GpuError> {
        self.ring.invalidate(gpu)
    }

    fn arrive(&mut self) {
        let Some(((frame, characters), bytes)) = self.ring.take() else { return };
        let mut words = bytemuck::pod_collect_to_vec::<u8, u32>(&bytes).into_iter();
        let characters = characters.iter().map(|(object, [meshes, chunks])| {
            let mut found = CharacterStatistics { object: *object, bones: 0, clusters: 0 };
            for _ in 0..*chunks {
                found.bones += words.next().unwrap_or(0);
                found.clusters += words.by_ref().take(*meshes).sum::<u32>();
            }
            found
        });
        self.last = Some(SceneStatistics { frame, characters: characters.collect() });
    }
}
