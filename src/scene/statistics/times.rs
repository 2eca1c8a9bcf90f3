//! Measures the stages of a frame by timestamps around the stages' compute passes.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use super::{FRAMES, StageTimes};
use crate::gpu::{Gpu, GpuError, ReadbackRing};
use crate::scene::stage::STAGES;

/// Number of timestamps per frame: one before and one after each stage.
const STAMPS: u32 = 2 * STAGES as u32;

/// Timer of a frame's stages.
#[derive(Debug)]
pub(in crate::scene) struct StageTimer {
    sets: Vec<Queries>,
    /// Index in `sets` of the timestamps that the current frame writes; `None` if no set is free.
    current: Option<usize>,
    ring: ReadbackRing<u64>,
    /// Milliseconds per tick of the device's clock.
    period: f64,
    last: Option<StageTimes>,
}

/// The timestamps of a frame. A later frame resolves them, after the device has executed the frame that wrote them.
/// Some drivers resolve zeros within the same submission, and no driver resolves queries that were never written.
#[derive(Debug)]
struct Queries {
    set: wgpu::QuerySet,
    resolved: wgpu::Buffer,
    /// Number of the frame that wrote the set; `None` once the set is resolved.
    frame: Option<u64>,
    is_done: Arc<AtomicBool>,
}

impl StageTimer {
    /// Creates a timer; `None` if the device has no timestamps.
    pub fn new(gpu: &Gpu) -> Result<Option<Self>, GpuError> {
        if !gpu.device().features().contains(wgpu::Features::TIMESTAMP_QUERY) {
            return Ok(None);
        }
        let sets = (0..FRAMES).map(|_| Queries::new(gpu)).collect::<Result<_, _>>()?;
        let ring = ReadbackRing::new(gpu, "times of stages", FRAMES, 8 * u64::from(STAMPS))?;
        let period = f64::from(gpu.queue().get_timestamp_period()) * 1e-6;
        Ok(Some(Self { sets, current: None, ring, period, last: None }))
    }

    /// Begins a frame. Resolves the timestamps of frames that the device has executed.
    pub fn begin(&mut self, encoder: &mut wgpu::CommandEncoder, frame: u64) {
        self.arrive();
        let ring = &mut self.ring;
        for queries in &mut self.sets {
            let Some(written) = queries.frame.filter(|_| queries.is_done.load(Ordering::Acquire)) else {
                continue;
            };
            ring.record(encoder, written, |encoder, to| {
                let (set, resolved) = (&queries.set, &queries.resolved);
                encoder.resolve_query_set(set, 0..STAMPS, resolved, 0);
                encoder.copy_buffer_to_buffer(resolved, 0, to, 0, resolved.size());
            });
            queries.frame = None;
        }
        self.current = self.sets.iter().position(|queries| queries.frame.is_none());
        if let Some(queries) = self.current.map(|at| &mut self.sets[at]) {
            queries.frame = Some(frame);
            queries.is_done.store(false, Ordering::Release);
            let is_done = queries.is_done.clone();
            encoder.on_submitted_work_done(move || is_done.store(true, Ordering::Release));
        }
    }

    /// The timestamp writes for the compute pass of a stage in the current frame; `None` if the frame is not timed.
    pub fn stage(&self, stage: usize) -> Option<wgpu::ComputePassTimestampWrites<'_>> {
        let first = 2 * stage as u32;
        Some(wgpu::ComputePassTimestampWrites {
            query_set: &self.sets[self.current?].set,
            beginning_of_pass_write_index: Some(first),
            end_of_pass_write_index: Some(first + 1),
        })
    }

    /// The times of the last frame whose timestamps have arrived.
    pub fn last(&mut self) -> Option<&StageTimes> {
        self.arrive();
        self.last.as_ref()
    }

    /// Discards the timestamps of frames whose encoders were dropped.
    pub fn invalidate(&mut self, gpu: &Gpu) -> Result<(), GpuError> {
        for queries in self.sets.iter_mut().filter(|queries| queries.frame.is_some()) {
            *queries = Queries::new(gpu)?;
        }
        self.ring.invalidate(gpu)
    }

    fn arrive(&mut self) {
        let Some((frame, bytes)) = self.ring.take() else { return };
        let stamps = bytemuck::pod_collect_to_vec::<u8, u64>(&bytes);
        let time = |stage: usize| {
            let ticks = stamps[2 * stage + 1].saturating_sub(stamps[2 * stage]);
            ticks as f64 * self.period
        };
        let [select, gate, sample, local_to_model, skin] = [0, 1, 2, 3, 4].map(time);
        self.last = Some(StageTimes { frame, select, gate, sample, local_to_model, skin });
    }
}

impl Queries {
    fn new(gpu: &Gpu) -> Result<Self, GpuError> {
        let (set, resolved) = gpu.scoped(|| {
            let set = gpu.device().create_query_set(&wgpu::QuerySetDescriptor {
                label: Some("times of stages"),
                ty: wgpu::QueryType::Timestamp,
                count: STAMPS,
            });
            let resolved = gpu.device().create_buffer(&wgpu::BufferDescriptor {
                label: Some("times of stages"),
                size: 8 * u64::from(STAMPS),
                usage: wgpu::BufferUsages::QUERY_RESOLVE | wgpu::BufferUsages::COPY_SRC,
                mapped_at_creation: false,
            });
            (set, resolved)
        })?;
        Ok(Self { set, resolved, frame: None, is_done: Arc::default() })
    }
}
