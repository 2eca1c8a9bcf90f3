//! The test of thesis A, section 13, at the press of a button: a camera moves away from a group of models, and each gate of bones
//! is timed at each distance.

use std::pin::pin;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{Receiver, TryRecvError, channel};
use std::task::Poll;

use relievo::gpu::Gpu;
use relievo_lab::measure::{DistanceSweepOptions, DistanceSweepReport, Subject, distance_sweep};
use web_time::Instant;

/// What an experiment tells.
enum News {
    /// Steps done, of all.
    Step([u64; 2]),
    Done(Box<Result<DistanceSweepReport, String>>),
}

/// An experiment that runs, and the last one's result.
#[derive(Default)]
pub struct Experiment {
    news: Option<Receiver<News>>,
    /// Set to cancel the experiment that runs.
    ends: Arc<AtomicBool>,
    began: Option<Instant>,
    /// Steps done, of all.
    pub steps: [u64; 2],
    /// The last result, or why there is none.
    pub result: Option<Result<DistanceSweepReport, String>>,
}

impl Experiment {
    /// Whether one runs now.
    pub fn is_running(&self) -> bool {
        self.news.is_some()
    }

    /// Estimated seconds until the end; `None` before the first step is done.
    pub fn seconds_left(&self) -> Option<f64> {
        let [done, of] = self.steps;
        let passed = self.began.filter(|_| done > 0)?.elapsed().as_secs_f64();
        Some(passed * of.saturating_sub(done) as f64 / done as f64)
    }

    /// Ends the one that runs, without a result.
    pub fn cancel(&mut self) {
        self.ends.store(true, Ordering::Relaxed);
        self.news = None;
    }

    /// Starts one with 100 models of 153 bones.
    pub fn start(
        &mut self,
        gpu: &Gpu,
        options: DistanceSweepOptions,
        wake: impl Fn() + Send + Sync + 'static,
    ) {
        let (to, news) = channel();
        let ends = Arc::new(AtomicBool::new(false));
        (self.news, self.steps, self.result) = (Some(news), [0, 1], None);
        (self.ends, self.began) = (ends.clone(), Some(Instant::now()));
        let gpu = gpu.clone();
        let work = async move |gpu: Gpu| {
            let told = to.clone();
            // A listener is called from the thread that measures.
            let told = std::sync::Mutex::new(told);
            let listener = |progress: relievo_lab::measure::Progress| {
                if let (Some(of), Ok(told)) = (progress.of, told.lock()) {
                    let _ = told.send(News::Step([progress.done, of]));
                    wake();
                }
            };
            let start = Instant::now();
            let clock = || start.elapsed().as_secs_f64();
            let measured = async {
                let model = relievo_samples::creature()?;
                let subject = Subject { name: "creature", model: &model, clip: 0 };
                distance_sweep(&gpu, subject, &options, &clock, &listener).await
            };
            // It waits for the device several times a step.
            let mut measured = pin!(measured);
            let result: Option<Result<_, relievo::Error>> =
                std::future::poll_fn(|context| match ends.load(Ordering::Relaxed) {
                    true => Poll::Ready(None),
                    false => measured.as_mut().poll(context).map(Some),
                })
                .await;
            let Some(result) = result else { return };
            let _ = to.send(News::Done(Box::new(result.map_err(|error| error.to_string()))));
            wake();
        };
        #[cfg(not(target_arch = "wasm32"))]
        std::thread::spawn(move || {
            let all = async {
                work(gpu.clone()).await;
                Ok::<(), relievo::Error>(())
            };
            // An end without a result tells that the device was lost.
            let _ = gpu.block_on(all);
        });
        #[cfg(target_arch = "wasm32")]
        wasm_bindgen_futures::spawn_local(async move { work(gpu).await });
    }

    /// Takes what the experiment told.
    pub fn update(&mut self) {
        let Some(news) = &self.news else { return };
        let mut all = Vec::new();
        let is_over = loop {
            match news.try_recv() {
                Ok(news) => all.push(news),
                Err(error) => break error == TryRecvError::Disconnected,
            }
        };
        if is_over && !matches!(all.last(), Some(News::Done(_))) {
            all.push(News::Done(Box::new(Err("the experiment ended before its time".to_owned()))));
        }
        for news in all {
            match news {
                News::Step(steps) => self.steps = steps,
                News::Done(result) => (self.news, self.result) = (None, Some(*result)),
            }
        }
    }
}
