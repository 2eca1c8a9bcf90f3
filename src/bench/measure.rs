//! Repetition: contenders take turns, so that whatever else the machine does hits all of them.

use std::time::{Duration, Instant};

use super::{Backend, Row};
use crate::Error;
use crate::gpu::{Gpu, Job, TimedBy, Timer};

/// Repetitions that do not count: the first dispatches of a pipeline compile it.
const WARM_UP: usize = 2;

/// Repetitions that count, at the least and at the most.
const REPETITIONS: std::ops::RangeInclusive<usize> = 5..=31;

/// A case ends after this long once it has the least repetitions.
const ENOUGH: Duration = Duration::from_millis(1500);

/// Something to measure.
pub struct Contender<'a> {
    backend: Backend,
    work: Work<'a>,
}

enum Work<'a> {
    Device(Box<dyn Fn(&mut wgpu::CommandEncoder) + 'a>),
    Host(Box<dyn FnMut() + 'a>),
    Both(Box<dyn FnMut() -> Result<(), Error> + 'a>),
}

impl<'a> Contender<'a> {
    /// A prepared job.
    pub fn job(backend: Backend, job: &'a Job) -> Self {
        Self::recorded(backend, |encoder| job.record(encoder))
    }

    /// Whatever is recorded, in one submission.
    pub fn recorded(backend: Backend, record: impl Fn(&mut wgpu::CommandEncoder) + 'a) -> Self {
        Self { backend, work: Work::Device(Box::new(record)) }
    }

    /// Work on the host.
    pub fn host(backend: Backend, work: impl FnMut() + 'a) -> Self {
        Self { backend, work: Work::Host(Box::new(work)) }
    }

    /// Work on host and device, by the host's clock.
    pub fn both(backend: Backend, work: impl FnMut() -> Result<(), Error> + 'a) -> Self {
        Self { backend, work: Work::Both(Box::new(work)) }
    }

    fn once(&mut self, gpu: &Gpu, timer: &Timer) -> Result<(f64, TimedBy), Error> {
        match &mut self.work {
            Work::Device(record) => {
                let measured = timer.measure(gpu, |encoder| record(encoder))?;
                Ok((measured.nanoseconds, measured.timed_by))
            }
            Work::Host(work) => {
                let start = Instant::now();
                work();
                Ok((start.elapsed().as_nanos() as f64, TimedBy::Wall))
            }
            Work::Both(work) => {
                let start = Instant::now();
                work()?;
                Ok((start.elapsed().as_nanos() as f64, TimedBy::Wall))
            }
        }
    }
}

/// Collects the rows of one kernel.
pub struct Bench<'a> {
    /// The device that is being measured.
    pub gpu: &'a Gpu,
    name: &'static str,
    timer: Timer,
    rows: Vec<Row>,
    measure: bool,
    progress: &'a mut dyn FnMut(&Row),
}

impl<'a> Bench<'a> {
    pub(super) fn new(
        gpu: &'a Gpu,
        name: &'static str,
        progress: &'a mut dyn FnMut(&Row),
    ) -> Result<Self, Error> {
        Ok(Self { gpu, name, timer: Timer::new(gpu)?, rows: Vec::new(), measure: true, progress })
    }

    /// Sets cases up without measuring them: every time is 0.
    pub(super) fn unmeasured(self) -> Self {
        Self { measure: false, ..self }
    }

    pub(super) fn into_rows(self) -> Vec<Row> {
        self.rows
    }

    /// Measures the contenders of a case in turn. All compute `items`; `bytes` is what must be moved.
    ///
    /// # Errors
    /// What the device reports.
    pub fn case(
        &mut self,
        case: impl Into<String>,
        (items, item): (usize, &'static str),
        bytes: u64,
        mut contenders: Vec<Contender<'_>>,
    ) -> Result<(), Error> {
        let (mut times, clocks) = match self.measure {
            true => self.repeat(&mut contenders)?,
            false => (vec![vec![0.0]; contenders.len()], vec![TimedBy::Wall; contenders.len()]),
        };
        let case = case.into();
        for ((contender, times), timed_by) in contenders.iter().zip(&mut times).zip(clocks) {
            times.sort_by(f64::total_cmp);
            let row = Row {
                name: self.name,
                case: case.clone(),
                backend: contender.backend,
                nanoseconds: times[times.len() / 2],
                min: times[0],
                max: times[times.len() - 1],
                items: items as u64,
                item,
                bytes,
                timed_by,
            };
            (self.progress)(&row);
            self.rows.push(row);
        }
        Ok(())
    }

    /// The contenders' times, and the clocks that took them.
    fn repeat(&self, contenders: &mut [Contender<'_>]) -> Result<(Vec<Vec<f64>>, Vec<TimedBy>), Error> {
        let mut times = vec![Vec::new(); contenders.len()];
        let mut clocks = vec![TimedBy::Wall; contenders.len()];
        let mut start = Instant::now();
        for repetition in 0..WARM_UP + REPETITIONS.end() {
            if repetition == WARM_UP {
                times.iter_mut().for_each(Vec::clear);
                start = Instant::now();
            }
            if repetition >= WARM_UP + REPETITIONS.start() && start.elapsed() > ENOUGH {
                break;
            }
            for (index, contender) in contenders.iter_mut().enumerate() {
                let (nanoseconds, clock) = contender.once(self.gpu, &self.timer)?;
                times[index].push(nanoseconds);
                clocks[index] = clock;
            }
        }
        Ok((times, clocks))
    }
}
