//! Repeated measurement. Contenders take turns, so that disturbances on the machine affect all of them.

use std::time::{Duration, Instant};

use relievo::Error;
use relievo::gpu::{Gpu, Job};

use crate::harness::{Backend, Row, TimedBy, Timer};

/// The time after which no further round of a case begins; the first always takes place. `relievo bench` takes about as many
/// times this as there are cases.
const BUDGET: Duration = Duration::from_millis(1000);

/// Rounds of the device alone that are not counted: the first dispatches of a pipeline compile it.
const WARM_UP: usize = 2;

/// The largest number of rounds of all contenders.
const ROUNDS: usize = 5;

/// The largest number of rounds of the device's contenders, which are compared more closely and take less time.
const DEVICE_ROUNDS: usize = 101;

/// Work on the device that takes longer than this, in nanoseconds, is repeated until its turns are as long as
/// the longest of the case: on a busy machine the scheduler takes more time from long turns than from short ones.
const LONG: f64 = 1e6;

/// The largest number of repetitions per turn.
const REPEATS: f64 = 8.0;

/// A piece of work to measure.
pub struct Contender<'a> {
    backend: Backend,
    // Repetitions per turn.
    repeats: u32,
    work: Work<'a>,
}

enum Work<'a> {
    Device(Box<dyn Fn(&mut wgpu::CommandEncoder) + 'a>),
    Host(Box<dyn FnMut() + 'a>),
    Both(Box<dyn FnMut() -> Result<(), Error> + 'a>),
}

impl<'a> Contender<'a> {
    /// A prepared job.
    pub(crate) fn job(backend: Backend, job: &'a Job) -> Self {
        Self::recorded(backend, |encoder| job.record(encoder))
    }

    /// Work that is recorded in one submission.
    pub(crate) fn recorded(backend: Backend, record: impl Fn(&mut wgpu::CommandEncoder) + 'a) -> Self {
        Self { backend, repeats: 1, work: Work::Device(Box::new(record)) }
    }

    /// Work on the host.
    pub(crate) fn host(backend: Backend, work: impl FnMut() + 'a) -> Self {
        Self { backend, repeats: 1, work: Work::Host(Box::new(work)) }
    }

    /// Work on host and device together, timed by the host's clock.
    pub(crate) fn both(backend: Backend, work: impl FnMut() -> Result<(), Error> + 'a) -> Self {
        Self { backend, repeats: 1, work: Work::Both(Box::new(work)) }
    }

    fn is_host(&self) -> bool {
        matches!(self.work, Work::Host(_))
    }

    #[cfg(not(target_arch = "wasm32"))]
    fn once(&mut self, gpu: &Gpu, timer: &Timer) -> Result<(f64, TimedBy), Error> {
        match &mut self.work {
            Work::Device(record) => {
                let repeats = self.repeats;
                let measured = timer.measure(gpu, |encoder| (0..repeats).for_each(|_| record(encoder)))?;
                Ok((measured.nanoseconds / f64::from(repeats), measured.timed_by))
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
    pub(crate) fn new(
        gpu: &'a Gpu,
        name: &'static str,
        progress: &'a mut dyn FnMut(&Row),
    ) -> Result<Self, Error> {
        Ok(Self { gpu, name, timer: Timer::new(gpu)?, rows: Vec::new(), measure: true, progress })
    }

    /// Sets up the cases without measuring them: every time is 0.
    pub(crate) fn unmeasured(self) -> Self {
        Self { measure: false, ..self }
    }

    pub(crate) fn into_rows(self) -> Vec<Row> {
        self.rows
    }

    /// Measures the contenders of a case in turn. Each computes `items`; `bytes` is the number of bytes that
    /// must be moved.
    ///
    /// # Errors
    /// What the device reports.
    pub(crate) fn case(
        &mut self,
        case: impl Into<String>,
        items: usize,
        item: &'static str,
        bytes: u64,
        #[cfg_attr(target_arch = "wasm32", expect(unused_mut))] mut contenders: Vec<Contender<'_>>,
    ) -> Result<(), Error> {
        // Nothing is measured in browsers, which cannot wait.
        #[cfg(target_arch = "wasm32")]
        let measured = None;
        #[cfg(not(target_arch = "wasm32"))]
        let measured = if self.measure { Some(self.repeat(&mut contenders)?) } else { None };
        let (times, clocks) = measured
            .unwrap_or_else(|| (vec![vec![0.0]; contenders.len()], vec![TimedBy::Wall; contenders.len()]));
        let case = case.into();
        let kernel = contenders.iter().position(|contender| contender.backend == Backend::Gpu);
        for (index, (contender, timed_by)) in contenders.iter().zip(clocks).enumerate() {
            let beside = kernel.filter(|kernel| *kernel != index);
            let sorted = sorted(times[index].iter().copied());
            let row = Row {
                name: self.name,
                case: case.clone(),
                backend: contender.backend,
                nanoseconds: sorted[sorted.len() / 2],
                min: sorted[0],
                max: sorted[sorted.len() - 1],
                beside_kernel: beside.map(|kernel| median_ratio(&times[index], &times[kernel])),
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
    #[cfg(not(target_arch = "wasm32"))]
    fn repeat(&self, contenders: &mut [Contender<'_>]) -> Result<(Vec<Vec<f64>>, Vec<TimedBy>), Error> {
        let mut times = vec![Vec::new(); contenders.len()];
        let mut clocks = vec![TimedBy::Wall; contenders.len()];
        for _ in 0..WARM_UP {
            for (contender, times) in contenders.iter_mut().zip(&mut times).filter(|(own, _)| !own.is_host())
            {
                times.push(contender.once(self.gpu, &self.timer)?.0);
            }
        }
        for (contender, repeats) in contenders.iter_mut().zip(repeats(&times)) {
            contender.repeats = repeats;
        }
        times.iter_mut().for_each(Vec::clear);
        let start = Instant::now();
        for round in 0..DEVICE_ROUNDS {
            if round > 0 && start.elapsed() > BUDGET {
                break;
            }
            for index in order(round, contenders.len()) {
                if round < ROUNDS || !contenders[index].is_host() {
                    let (nanoseconds, clock) = contenders[index].once(self.gpu, &self.timer)?;
                    times[index].push(nanoseconds);
                    clocks[index] = clock;
                }
            }
        }
        Ok((times, clocks))
    }
}

/// The order of contenders in a round. Every second round runs backwards, so that neither the order nor a
/// machine that grows busier favours anyone.
fn order(round: usize, contenders: usize) -> impl Iterator<Item = usize> {
    (0..contenders).map(move |index| if round.is_multiple_of(2) { index } else { contenders - 1 - index })
}

/// Repetitions per turn, given the times of single runs; 1 for work on the host.
fn repeats(times: &[Vec<f64>]) -> Vec<u32> {
    let shortest = |times: &Vec<f64>| times.iter().copied().reduce(f64::min).unwrap_or(0.0);
    let longest = times.iter().map(shortest).fold(0.0, f64::max);
    let repeats = |own: f64| if own > LONG { (longest / own).round().clamp(1.0, REPEATS) as u32 } else { 1 };
    times.iter().map(shortest).map(repeats).collect()
}

fn sorted(times: impl Iterator<Item = f64>) -> Vec<f64> {
    let mut times: Vec<_> = times.collect();
    times.sort_by(f64::total_cmp);
    times
}

/// The median ratio over the rounds in which both took part: a disturbance in a round affects both.
fn median_ratio(times: &[f64], kernel: &[f64]) -> f64 {
    let ratios = sorted(times.iter().zip(kernel).map(|(time, kernel)| time / kernel));
    ratios[ratios.len() / 2]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_ratio_is_taken_round_by_round() {
        // The work is twice as slow in every round, on a machine whose speed changes between rounds. The ratio
        // of medians would be 1.
        let kernel = [1.0, 10.0, 1.0, 10.0, 10.0];
        let other = [2.0, 20.0, 2.0];
        assert_eq!(median_ratio(&other, &kernel), 2.0);
        assert_eq!(median_ratio(&[3.0, 5.0, 8.0], &[1.0, 1.0, 2.0]), 4.0);
        assert_eq!(
            [0, 1, 2].map(|round| order(round, 3).collect::<Vec<_>>()),
            [[0, 1, 2], [2, 1, 0], [0, 1, 2]]
        );
    }

    #[test]
    fn turns_are_as_long_as_the_longest() {
        let times = [vec![12e6, 11e6], vec![9e6, 5e6], vec![], vec![1e6], vec![1.1e6]];
        assert_eq!(repeats(&times), [1, 2, 1, 1, 8]);
    }

    #[test]
    fn references_sit_out_the_later_rounds() {
        let gpu = Gpu::headless(&relievo::gpu::Options::default()).expect("the suite needs an adapter");
        let [device, host] = [0; 2].map(std::cell::Cell::new);
        let count = |calls: &std::cell::Cell<usize>| calls.set(calls.get() + 1);
        let mut ignored = |_: &Row| ();
        let mut bench = Bench::new(&gpu, "test", &mut ignored).expect("ready");
        let contenders = vec![
            Contender::recorded(Backend::Gpu, |_| count(&device)),
            Contender::host(Backend::Reference, || count(&host)),
        ];
        bench.case("both", 1, "item", 4, contenders).expect("measured");
        assert_eq!(host.get(), ROUNDS);
        assert!(device.get() > host.get(), "{} rounds", device.get());
        bench
            .case("host", 1, "item", 4, vec![Contender::host(Backend::Reference, || count(&host))])
            .expect("measured");
        assert_eq!(host.get(), 2 * ROUNDS);
        let rows = bench.into_rows();
        assert_eq!(
            rows.iter().map(|row| row.beside_kernel.is_some()).collect::<Vec<_>>(),
            [false, true, false]
        );
    }
}
