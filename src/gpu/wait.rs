//! Submits work to the device, and waits for it: blocking, or as a future.

use futures_channel::oneshot::channel;

use super::{Gpu, GpuError};

/// Longest wait for the device before the device counts as hung.
#[cfg(not(target_arch = "wasm32"))]
const PATIENCE: std::time::Duration = std::time::Duration::from_secs(300);

impl Gpu {
    /// Records commands with `record`, and submits them.
    ///
    /// # Errors
    /// [`GpuError`] that the device reports.
    pub fn submit(
        &self,
        label: &str,
        record: impl FnOnce(&mut wgpu::CommandEncoder),
    ) -> Result<(), GpuError> {
        self.scoped(|| {
            let mut encoder = self.encoder(label);
            record(&mut encoder);
            self.queue.submit([encoder.finish()]);
        })
    }

    /// Records commands with `record`, submits them, and waits until the device has finished.
    ///
    /// # Errors
    /// [`GpuError`] that the device reports.
    #[cfg(not(target_arch = "wasm32"))]
    pub fn run(&self, label: &str, record: impl FnOnce(&mut wgpu::CommandEncoder)) -> Result<(), GpuError> {
        self.submit(label, record)?;
        self.wait()
    }

    /// Records, submits and waits like `Gpu::run`, with a `record` that may fail.
    ///
    /// # Errors
    /// [`Error::Gpu`](crate::Error::Gpu) with errors that the device reports, and the error of `record`.
    #[cfg(not(target_arch = "wasm32"))]
    pub fn try_run(
        &self,
        label: &str,
        record: impl FnOnce(&mut wgpu::CommandEncoder) -> Result<(), crate::Error>,
    ) -> Result<(), crate::Error> {
        let mut recorded = Ok(());
        self.run(label, |encoder| recorded = record(encoder))?;
        recorded
    }

    /// Records commands with `record`, submits them, and completes once the device has finished; see [`Gpu::wait_async`].
    ///
    /// # Errors
    /// [`GpuError`] that the device reports.
    pub async fn run_async(
        &self,
        label: &str,
        record: impl FnOnce(&mut wgpu::CommandEncoder),
    ) -> Result<(), GpuError> {
        self.submit(label, record)?;
        self.wait_async().await
    }

    /// Waits until the device has executed everything submitted so far.
    ///
    /// Callbacks run on the thread that polls. If several threads use one device, callbacks of earlier work, and statistics with
    /// them, may still arrive after this wait.
    ///
    /// # Errors
    /// The loss of the device, an error that was reported in the meantime, or [`GpuError::Hung`].
    #[cfg(not(target_arch = "wasm32"))]
    pub fn wait(&self) -> Result<(), GpuError> {
        let poll = wgpu::PollType::Wait { submission_index: None, timeout: Some(PATIENCE) };
        let polled = self.device.poll(poll);
        self.check()?;
        polled.map(|_| ()).map_err(|_| GpuError::Hung { seconds: PATIENCE.as_secs() })
    }

    /// Completes once the device has executed everything submitted so far, and the errors of all calls so far are known.
    ///
    /// The future never blocks. In a browser, the event loop drives it. Elsewhere, the program must poll the device, or the
    /// future never wakes. Call `gpu.device().poll(wgpu::PollType::Poll)` once per frame, or `Gpu::wait` on a separate thread.
    ///
    /// # Errors
    /// The loss of the device, or an error that was reported in the meantime.
    pub async fn wait_async(&self) -> Result<(), GpuError> {
        let (sender, receiver) = channel();
        self.queue.on_submitted_work_done(move || {
            // The receiver no longer exists if the caller has dropped the future.
            let _ = sender.send(());
        });
        let answer = receiver.await;
        self.check_async().await?;
        answer.map_err(|error| GpuError::DeviceLost { reason: error.to_string() })
    }

    /// Blocks until `work` is done. `work` may wait only for the device.
    ///
    /// # Errors
    /// The errors of `work`, and of [`Gpu::wait`].
    #[cfg(not(target_arch = "wasm32"))]
    pub fn block_on<T, E: From<GpuError>>(&self, work: impl Future<Output = Result<T, E>>) -> Result<T, E> {
        let mut work = std::pin::pin!(work);
        let mut context = std::task::Context::from_waker(std::task::Waker::noop());
        loop {
            if let std::task::Poll::Ready(done) = work.as_mut().poll(&mut context) {
                return done;
            }
            // After this wait, the callbacks have run or are running on another thread, so the work can go on.
            self.wait()?;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::gpu::{Buffer, Options};

    fn gpu() -> Gpu {
        Gpu::headless(&Options::default()).expect("the suite needs an adapter")
    }

    /// Several waits in sequence, as when terrain is generated.
    #[test]
    fn blocking_drives_work_that_waits_repeatedly() {
        let gpu = gpu();
        let [from, to] = [[7_u32, 9], [0, 0]].map(|data| Buffer::from_slice(&gpu, "data", &data));
        let (from, to) = (from.expect("uploaded"), to.expect("uploaded"));
        let work = async {
            for at in [0, 4] {
                let copy = |encoder: &mut wgpu::CommandEncoder| {
                    encoder.copy_buffer_to_buffer(from.raw(), at, to.raw(), at, 4);
                };
                gpu.run_async("copy", copy).await?;
            }
            to.read(&gpu).await
        };
        assert_eq!(gpu.block_on(work).expect("copied"), [7, 9]);
    }

    #[test]
    fn waiting_for_a_lost_device_ends() {
        let gpu = gpu();
        gpu.device().destroy();
        let error = gpu.block_on(gpu.run_async("lost", |_| ())).expect_err("it is lost").to_string();
        assert!(error.contains("lost"), "{error}");
        assert!(gpu.block_on(gpu.wait_async()).is_err());
    }
}
