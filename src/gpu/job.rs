//! Jobs: sequences of dispatches that are prepared once and recorded every frame.

use super::kernel::{Group, Kernel};
use super::{Gpu, GpuError, Uniform};

/// One dispatch with its pipeline and bind groups.
#[derive(Debug, Clone)]
pub struct Step {
    kernel: Kernel,
    groups: Vec<Group>,
    workgroups: Workgroups,
}

/// Number of workgroups of a dispatch.
#[derive(Debug, Clone)]
enum Workgroups {
    Of([u32; 3]),
    /// Indirect dispatch: a kernel writes the three counts into this buffer, from this byte on.
    Written(wgpu::Buffer, u64),
}

impl Step {
    fn new(kernel: &Kernel, groups: Vec<Group>, workgroups: Workgroups) -> Self {
        Self { kernel: kernel.clone(), groups, workgroups }
    }

    /// Creates a dispatch of `invocations` threads. Threads are numbered across all workgroups ([`Kernel::spread`]).
    pub fn spread(gpu: &Gpu, kernel: &Kernel, groups: Vec<Group>, invocations: u32) -> Self {
        Self::new(kernel, groups, Workgroups::Of(kernel.spread(gpu, invocations)))
    }

    /// Creates a dispatch of at least `threads` threads along x, y and z, rounded up to whole workgroups.
    pub fn covering(kernel: &Kernel, groups: Vec<Group>, threads: [u32; 3]) -> Self {
        let size = kernel.workgroup_size();
        let workgroups = std::array::from_fn(|axis| threads[axis].div_ceil(size[axis]));
        Self::new(kernel, groups, Workgroups::Of(workgroups))
    }

    /// Creates an indirect dispatch. A kernel writes the workgroup counts along x, y and z into `arguments`, from byte `offset`
    /// on.
    pub(crate) fn indirect(kernel: &Kernel, group: Group, arguments: &wgpu::Buffer, offset: u64) -> Self {
        Self::new(kernel, vec![group], Workgroups::Written(arguments.clone(), offset))
    }

    fn dispatch(&self, pass: &mut wgpu::ComputePass<'_>) {
        pass.set_pipeline(&self.kernel.pipeline);
        for (index, group) in self.groups.iter().enumerate() {
            pass.set_bind_group(index as u32, group, &[]);
        }
        match &self.workgroups {
            Workgroups::Of([x, y, z]) => pass.dispatch_workgroups(*x, *y, *z),
            Workgroups::Written(arguments, offset) => pass.dispatch_workgroups_indirect(arguments, *offset),
        }
    }

    /// Workgroup counts along x, y and z; zeros for an indirect dispatch.
    fn workgroups(&self) -> [u32; 3] {
        if let Workgroups::Of(workgroups) = self.workgroups { workgroups } else { [0; 3] }
    }

    /// Number of threads of the dispatch; 0 for an indirect dispatch.
    fn invocations(&self) -> u64 {
        let size = self.kernel.workgroup_size();
        self.workgroups().into_iter().chain(size).map(u64::from).fold(1, u64::saturating_mul)
    }
}

/// Number of threads after which [`Job::run_async`] submits. This number of threads takes some tenths of a second on a slow
/// GPU. Operating systems abort work that takes seconds.
const INVOCATIONS_A_SUBMISSION: u64 = 1 << 27;

/// A prepared sequence of dispatches. It is built once, and recorded any number of times without allocation.
#[derive(Debug, Clone)]
pub struct Job {
    label: &'static str,
    steps: Vec<Step>,
}

impl Job {
    /// Builds a job from its steps, and checks these against the device's limits.
    ///
    /// # Errors
    /// [`GpuError::Limit`] if a dispatch is too large.
    pub fn new(gpu: &Gpu, label: &'static str, steps: Vec<Step>) -> Result<Self, GpuError> {
        let available = gpu.device().limits().max_compute_workgroups_per_dimension;
        let needed = steps.iter().flat_map(Step::workgroups).max().unwrap_or(0);
        if needed > available {
            return Err(GpuError::Limit {
                pass: label,
                limit: "maxComputeWorkgroupsPerDimension",
                needed: needed.into(),
                available: available.into(),
                remedy: "split the batch",
            });
        }
        Ok(Self { label, steps })
    }

    /// Builds a job of a single dispatch with one bind group, for at least `invocations` threads ([`Step::spread`]).
    ///
    /// # Errors
    /// The errors of [`Job::new`].
    pub fn spread(
        gpu: &Gpu,
        label: &'static str,
        kernel: &Kernel,
        group: Group,
        invocations: u32,
    ) -> Result<Self, GpuError> {
        Self::new(gpu, label, vec![Step::spread(gpu, kernel, vec![group], invocations)])
    }

    /// Records all steps, in order, in a new compute pass.
    pub fn record(&self, encoder: &mut wgpu::CommandEncoder) {
        self.dispatch(&mut compute_pass(encoder, self.label));
    }

    /// Records all steps, in order, in an open compute pass.
    pub fn dispatch(&self, pass: &mut wgpu::ComputePass<'_>) {
        self.steps.iter().for_each(|step| step.dispatch(pass));
    }

    /// Runs all steps and waits until the device has finished. A long job is split into several submissions, so that none takes
    /// seconds on a slow GPU: operating systems abort such work.
    ///
    /// # Errors
    /// Errors that the device reports.
    #[cfg(not(target_arch = "wasm32"))]
    pub fn run(&self, gpu: &Gpu) -> Result<(), GpuError> {
        gpu.block_on(self.run_async(gpu))
    }

    /// Runs all steps, and completes once the device has finished; see [`Gpu::wait_async`]. Long jobs are split into several
    /// submissions, as in `Job::run`.
    ///
    /// # Errors
    /// Errors that the device reports.
    pub async fn run_async(&self, gpu: &Gpu) -> Result<(), GpuError> {
        self.run_split(gpu, INVOCATIONS_A_SUBMISSION).await
    }

    /// Runs all steps in submissions of at most `most` threads each. A step with more threads gets a submission of its own.
    async fn run_split(&self, gpu: &Gpu, most: u64) -> Result<(), GpuError> {
        for steps in self.submissions(most) {
            let record = |encoder: &mut wgpu::CommandEncoder| {
                let mut pass = compute_pass(encoder, self.label);
                steps.iter().for_each(|step| step.dispatch(&mut pass));
            };
            gpu.run_async(self.label, record).await?;
        }
        Ok(())
    }

    /// Groups the steps into submissions of at most `most` threads each. A step with more threads is a submission by itself.
    fn submissions(&self, most: u64) -> Vec<&[Step]> {
        let mut submissions = Vec::new();
        let (mut start, mut work) = (0, 0_u64);
        for (index, step) in self.steps.iter().enumerate() {
            let more = step.invocations();
            if index > start && work.saturating_add(more) > most {
                submissions.push(&self.steps[start..index]);
                (start, work) = (index, 0);
            }
            work = work.saturating_add(more);
        }
        submissions.push(&self.steps[start..]);
        submissions
    }
}

/// A job, with kernel parameters that may change between submissions.
#[derive(Debug, Clone)]
pub struct ParamsJob<T> {
    pub(crate) params: T,
    pub(crate) uniform: Uniform<T>,
    pub(crate) job: Job,
}

impl<T> ParamsJob<T> {
    /// Records all steps, in order, in a new compute pass.
    pub fn record(&self, encoder: &mut wgpu::CommandEncoder) {
        self.job.record(encoder);
    }

    /// Records all steps, in order, in an open compute pass.
    pub fn dispatch(&self, pass: &mut wgpu::ComputePass<'_>) {
        self.job.dispatch(pass);
    }
}

/// Begins a compute pass. One pass for many jobs is cheaper than one pass per job.
pub fn compute_pass<'a>(encoder: &'a mut wgpu::CommandEncoder, label: &'static str) -> wgpu::ComputePass<'a> {
    encoder.begin_compute_pass(&wgpu::ComputePassDescriptor { label: Some(label), timestamp_writes: None })
}

#[cfg(test)]
mod tests {
    use super::{INVOCATIONS_A_SUBMISSION, Step};
    use crate::gpu::{Gpu, Options};
    use crate::terrain::fields::Fields;
    use crate::terrain::thermal::{Thermal, ThermalBuffers, ThermalPass};

    #[test]
    fn long_jobs_go_to_the_device_in_pieces() {
        let gpu = Gpu::headless(&Options::default()).expect("the suite needs an adapter");
        let pass = ThermalPass::new(&gpu).expect("compiled");
        let (width, iterations) = (67, 20);
        let heights: Vec<i32> =
            (0..width * width).map(|index: u32| (index.wrapping_mul(0x9e37_79b9) >> 8) as i32).collect();
        let run = |most| {
            let [windows, other] = [0, 1].map(|_| Fields::new(&gpu, "windows", width, 1).expect("allocated"));
            windows.heights.write(&gpu, &heights).expect("written");
            let params = Thermal { iterations, ..Thermal::default() };
            let buffers = ThermalBuffers { windows: &windows, other: &other };
            let job = pass.prepare(&gpu, params, 1.0, buffers).expect("prepared");
            let pieces = job.submissions(most);
            assert_eq!(pieces.iter().map(|steps| steps.len()).sum::<usize>(), iterations as usize);
            let invocations = |steps: &[Step]| {
                steps.iter().map(|step| 64 * step.workgroups().iter().product::<u32>()).sum::<u32>()
            };
            assert!(pieces.iter().all(|steps| steps.len() == 1 || u64::from(invocations(steps)) <= most));
            gpu.block_on(job.run_split(&gpu, most)).expect("run");
            (pieces.len(), windows.cropped(iterations).heights.read_blocking(&gpu).expect("read"))
        };
        let whole = run(INVOCATIONS_A_SUBMISSION);
        let (some, one) = (run(20_000), run(1));
        assert_eq!((whole.0, one.0), (1, 20));
        assert!((2..20).contains(&some.0), "{} submissions", some.0);
        assert!(whole.1 == some.1 && whole.1 == one.1);
    }
}
