//! Measures how long recorded work takes on the device, by timestamps, or by wall time if the adapter has none.

#[cfg(not(target_arch = "wasm32"))]
use std::time::Instant;

use relievo::gpu::{Buffer, Gpu, GpuError};

/// The clock of a measurement.
#[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Serialize)]
#[serde(rename_all = "lowercase")]
pub enum TimedBy {
    /// The device's own clock, around the recorded work only.
    Timestamp,
    /// The host's clock, around submission and wait.
    Wall,
}

/// A measured duration.
#[derive(Debug, Clone, Copy)]
pub struct Measurement {
    /// Duration in nanoseconds.
    pub nanoseconds: f64,
    /// The clock that was used.
    pub timed_by: TimedBy,
}

/// Measures recorded work.
#[derive(Debug)]
pub struct Timer {
    queries: Option<(wgpu::QuerySet, Buffer<u64>, wgpu::Buffer)>,
}

impl Timer {
    /// A timer. It uses timestamps if the device was opened with `TIMESTAMP_QUERY` and
    /// `TIMESTAMP_QUERY_INSIDE_ENCODERS`.
    ///
    /// # Errors
    /// [`GpuError::OutOfMemory`].
    pub fn new(gpu: &Gpu) -> Result<Self, GpuError> {
        let needed = wgpu::Features::TIMESTAMP_QUERY | wgpu::Features::TIMESTAMP_QUERY_INSIDE_ENCODERS;
        if !gpu.device().features().contains(needed) {
            return Ok(Self { queries: None });
        }
        let (set, resolved) = gpu.scoped(|| {
            let set = gpu.device().create_query_set(&wgpu::QuerySetDescriptor {
                label: Some("timer"),
                ty: wgpu::QueryType::Timestamp,
                count: 2,
            });
            let resolved = gpu.device().create_buffer(&wgpu::BufferDescriptor {
                label: Some("timer"),
                size: 16,
                usage: wgpu::BufferUsages::QUERY_RESOLVE | wgpu::BufferUsages::COPY_SRC,
                mapped_at_creation: false,
            });
            (set, resolved)
        })?;
        Ok(Self { queries: Some((set, Buffer::new(gpu, "timer", 2)?, resolved)) })
    }

    /// A timer for work that also draws. On software adapters it uses wall time, because lavapipe's timestamps
    /// around compute work are too short once a picture has been drawn.
    ///
    /// # Errors
    /// [`GpuError::OutOfMemory`].
    pub fn for_drawing(gpu: &Gpu) -> Result<Self, GpuError> {
        if gpu.adapter().is_software() { Ok(Self { queries: None }) } else { Self::new(gpu) }
    }

    /// The clock that [`Timer::measure`] uses.
    pub fn timed_by(&self) -> TimedBy {
        if self.queries.is_some() { TimedBy::Timestamp } else { TimedBy::Wall }
    }

    /// Records, submits, waits, and returns how long the recorded work took.
    ///
    /// # Errors
    /// Errors of the device.
    #[cfg(not(target_arch = "wasm32"))]
    pub fn measure(
        &self,
        gpu: &Gpu,
        record: impl FnOnce(&mut wgpu::CommandEncoder),
    ) -> Result<Measurement, GpuError> {
        let start = Instant::now();
        gpu.run("measured", |encoder| {
            if let Some((set, ..)) = &self.queries {
                encoder.write_timestamp(set, 0);
            }
            record(encoder);
            if let Some((set, ..)) = &self.queries {
                encoder.write_timestamp(set, 1);
            }
        })?;
        let wall = start.elapsed().as_nanos() as f64;
        let Some((set, host, resolved)) = &self.queries else {
            return Ok(Measurement { nanoseconds: wall, timed_by: TimedBy::Wall });
        };
        // The resolve has a submission of its own: some drivers resolve zeros in the same submission as the
        // timed work.
        gpu.run("resolve", |encoder| {
            encoder.resolve_query_set(set, 0..2, resolved, 0);
            encoder.copy_buffer_to_buffer(resolved, 0, host.raw(), 0, 16);
        })?;
        let ticks = host.read_blocking(gpu)?;
        let period = f64::from(gpu.queue().get_timestamp_period());
        let nanoseconds = ticks[1].saturating_sub(ticks[0]) as f64 * period;
        Ok(Measurement { nanoseconds, timed_by: TimedBy::Timestamp })
    }
}
