//! Device errors. Error scopes catch the errors of a call; handlers receive all other errors later.
//!
//! Natively, a scope's error is known once the scope is popped. A browser reports the error only after the calling task has
//! returned. In a browser, a call that allocates or compiles always succeeds, and the next call returns the error.

use std::sync::{Arc, Mutex, MutexGuard};
#[cfg(any(test, target_arch = "wasm32"))]
use std::task::{Context, Poll, Waker};

use super::{Gpu, GpuError};

/// The error of relievo for an error of wgpu.
fn from_wgpu(error: wgpu::Error) -> GpuError {
    match error {
        wgpu::Error::OutOfMemory { source } => GpuError::OutOfMemory { reason: source.to_string() },
        wgpu::Error::Validation { description, .. } => GpuError::Validation { reason: description },
        wgpu::Error::Internal { description, .. } => GpuError::Internal { reason: description },
    }
}

/// Errors that the device reported outside of the calls that caused them.
#[derive(Debug, Clone, Default)]
pub(super) struct Errors(Arc<Mutex<Heard>>);

#[derive(Debug, Default)]
struct Heard {
    lost: Option<String>,
    error: Option<GpuError>,
    /// Number of scopes that were popped, and number of scopes whose error is known. Answers arrive in the order of the scopes.
    #[cfg(any(test, target_arch = "wasm32"))]
    answers: [u64; 2],
    #[cfg(any(test, target_arch = "wasm32"))]
    waiting: Vec<Waker>,
}

impl Errors {
    fn lock(&self) -> MutexGuard<'_, Heard> {
        self.0.lock().unwrap_or_else(|poisoned| poisoned.into_inner())
    }

    /// Registers a handler for errors outside of error scopes. The handler replaces earlier handlers.
    pub fn listen(&self, device: &wgpu::Device) {
        let errors = self.clone();
        device.on_uncaptured_error(Arc::new(move |error: wgpu::Error| errors.hear(from_wgpu(error))));
        self.listen_for_loss(device);
    }

    /// Registers a handler for the loss of the device. In a browser, other handlers stay registered.
    pub fn listen_for_loss(&self, device: &wgpu::Device) {
        let errors = self.clone();
        device.set_device_lost_callback(move |reason, message| {
            errors.lose(&format!("{reason:?}: {message}"));
        });
    }

    /// Remembers that the device is lost. The first reason is kept.
    fn lose(&self, reason: &str) {
        self.lock().lost.get_or_insert_with(|| reason.to_owned());
    }

    /// Remembers an error. If an earlier error has not been returned yet, that error is kept instead.
    fn hear(&self, error: GpuError) {
        self.lock().error.get_or_insert(error);
    }

    /// Returns a remembered error once. After the loss of the device, every call returns an error.
    fn check(&self) -> Result<(), GpuError> {
        self.check_loss()?;
        self.lock().error.take().map_or(Ok(()), Err)
    }

    fn check_loss(&self) -> Result<(), GpuError> {
        let lost = self.lock().lost.clone();
        lost.map_or(Ok(()), |reason| Err(GpuError::DeviceLost { reason }))
    }

    /// Counts a popped scope whose error is not known yet.
    #[cfg(any(test, target_arch = "wasm32"))]
    fn ask(&self) {
        self.lock().answers[0] += 1;
    }

    /// Receives the error, if any, of the oldest scope whose error was not known.
    #[cfg(any(test, target_arch = "wasm32"))]
    fn answer(&self, error: Option<GpuError>) {
        if let Some(error) = error {
            self.hear(error);
        }
        let mut heard = self.lock();
        heard.answers[1] += 1;
        let waiting = std::mem::take(&mut heard.waiting);
        // The lock is released first, because a woken task may poll immediately.
        drop(heard);
        waiting.into_iter().for_each(Waker::wake);
    }

    /// Completes once the errors of all scopes that were popped before the call are known.
    #[cfg(any(test, target_arch = "wasm32"))]
    async fn answered(&self) {
        let asked = self.lock().answers[0];
        let poll = |context: &mut Context<'_>| {
            let mut heard = self.lock();
            if heard.answers[1] >= asked {
                return Poll::Ready(());
            }
            heard.waiting.push(context.waker().clone());
            Poll::Pending
        };
        std::future::poll_fn(poll).await;
    }
}

impl Gpu {
    /// Checks for errors that the device reported outside of the calls that caused them.
    ///
    /// The loss of the device is always reported. In a browser, errors of calls that allocate or compile are also reported
    /// here, because the browser reports them late ([`Gpu::check_async`]). If an embedding program opened the device
    /// ([`Gpu::from_wgpu`]), errors of the program's own calls go only to the program's handlers.
    ///
    /// # Errors
    /// The first of these errors. [`GpuError::DeviceLost`] is returned by every call once the device is lost. Any other error
    /// is returned once.
    pub fn check(&self) -> Result<(), GpuError> {
        self.errors.check()?;
        self.check_loss()
    }

    /// Checks whether the device is lost. No callback is set, so the embedding program's callback stays in place.
    ///
    /// # Errors
    /// [`GpuError::DeviceLost`].
    pub(crate) fn check_loss(&self) -> Result<(), GpuError> {
        #[cfg(not(target_arch = "wasm32"))]
        if super::identity::is_lost(&self.device) {
            self.errors.lose("it refuses all work");
        }
        self.errors.check_loss()
    }

    /// Waits until the errors of all earlier calls are known, then checks for errors like [`Gpu::check`]. In a browser, the
    /// wait takes a few tasks of the event loop; elsewhere it takes no time.
    ///
    /// # Errors
    /// The errors of [`Gpu::check`].
    pub async fn check_async(&self) -> Result<(), GpuError> {
        #[cfg(target_arch = "wasm32")]
        self.errors.answered().await;
        self.check()
    }

    /// Runs `work` and returns the errors that wgpu reports for it. A browser reports these errors later, to [`Gpu::check`].
    ///
    /// # Errors
    /// Out-of-memory, validation and internal errors that `work` causes, and the errors of [`Gpu::check`].
    pub fn scoped<T>(&self, work: impl FnOnce() -> T) -> Result<T, GpuError> {
        let scopes = self.push()?;
        let done = work();
        self.pop(scopes)?;
        Ok(done)
    }

    /// Pushes nested error scopes.
    ///
    /// # Errors
    /// Errors that were reported before.
    fn push(&self) -> Result<[wgpu::ErrorScopeGuard; 3], GpuError> {
        self.errors.check()?;
        let filters =
            [wgpu::ErrorFilter::Internal, wgpu::ErrorFilter::OutOfMemory, wgpu::ErrorFilter::Validation];
        Ok(filters.map(|filter| self.device.push_error_scope(filter)))
    }

    /// Pops nested error scopes.
    ///
    /// # Errors
    /// The first error that a scope caught, from the innermost scope outwards.
    #[cfg(not(target_arch = "wasm32"))]
    fn pop(&self, scopes: [wgpu::ErrorScopeGuard; 3]) -> Result<(), GpuError> {
        let mut first = None;
        for scope in scopes.into_iter().rev() {
            let error = pollster::block_on(scope.pop());
            first = first.or(error);
        }
        // Loss is checked first: a lost device ignores calls, and may report dependent objects as invalid.
        self.check_loss()?;
        first.map_or(Ok(()), |error| Err(from_wgpu(error)))
    }

    /// Pops nested error scopes. The browser reports their errors later.
    #[cfg(target_arch = "wasm32")]
    fn pop(&self, scopes: [wgpu::ErrorScopeGuard; 3]) -> Result<(), GpuError> {
        // The scopes are popped immediately; the browser reports their errors later.
        let answers: Vec<_> = scopes.into_iter().rev().map(wgpu::ErrorScopeGuard::pop).collect();
        let errors = self.errors.clone();
        errors.ask();
        wasm_bindgen_futures::spawn_local(async move {
            let mut first = None;
            for answer in answers {
                let error = answer.await;
                first = first.or(error);
            }
            errors.answer(first.map(from_wgpu));
        });
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::pin::pin;

    fn internal(reason: &str) -> GpuError {
        GpuError::Internal { reason: reason.to_owned() }
    }

    #[test]
    fn out_of_memory_is_an_error_with_what_to_do() {
        let error = from_wgpu(wgpu::Error::OutOfMemory { source: "test".into() });
        assert!(error.to_string().contains("smaller batch"), "{error}");
    }

    /// Answers arrive after the calls, in the order of the scopes, as in a browser.
    #[test]
    fn late_answers_complete_those_who_asked_before() {
        let errors = Errors::default();
        let mut context = Context::from_waker(Waker::noop());
        assert!(pin!(errors.answered()).poll(&mut context).is_ready(), "there is nothing to wait for");
        errors.ask();
        errors.ask();
        let mut first = pin!(errors.answered());
        assert!(first.as_mut().poll(&mut context).is_pending());
        errors.ask();
        let mut second = pin!(errors.answered());
        errors.answer(None);
        assert!(first.as_mut().poll(&mut context).is_pending(), "one of two is known");
        errors.answer(Some(internal("of the second")));
        assert!(first.as_mut().poll(&mut context).is_ready());
        assert!(second.as_mut().poll(&mut context).is_pending(), "its own scope is not known");
        errors.answer(Some(internal("of the third")));
        assert!(second.as_mut().poll(&mut context).is_ready());
        let error = errors.check().expect_err("two scopes failed").to_string();
        assert!(error.contains("of the second"), "{error}");
        assert!(errors.check().is_ok(), "an error is told once");
    }

    #[test]
    fn an_answer_wakes_all_who_wait() {
        #[derive(Default)]
        struct Bell(std::sync::atomic::AtomicUsize);
        impl std::task::Wake for Bell {
            fn wake(self: Arc<Self>) {
                self.0.fetch_add(1, std::sync::atomic::Ordering::SeqCst);
            }
        }
        let (errors, bell) = (Errors::default(), Arc::new(Bell::default()));
        errors.ask();
        let waker = Waker::from(bell.clone());
        let mut waiting = [Box::pin(errors.answered()), Box::pin(errors.answered())];
        for future in &mut waiting {
            assert!(future.as_mut().poll(&mut Context::from_waker(&waker)).is_pending());
        }
        errors.answer(None);
        assert_eq!(bell.0.load(std::sync::atomic::Ordering::SeqCst), 2);
    }
}
