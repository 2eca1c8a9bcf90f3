//! Processor time, and programs that take turns.

use std::fmt::Write as _;

/// Rounds that are counted, in each of which every program has a turn.
const ROUNDS: usize = 20;

/// Rounds that are not: pipelines are compiled, and pages dealt out.
const WARM_UP: usize = 3;

/// Frames of a turn.
const FRAMES: usize = 3;

/// The processor time of this process in milliseconds, over all of its threads. Software adapters compute in them.
fn processor_time() -> f64 {
    let time = rustix::time::clock_gettime(rustix::time::ClockId::ProcessCPUTime);
    1e3 * time.tv_sec as f64 + 1e-6 * time.tv_nsec as f64
}

/// A program that plays frames.
pub struct Program<'a> {
    name: String,
    frame: Box<dyn FnMut() + 'a>,
    /// Milliseconds of a frame, one for each round.
    times: Vec<f64>,
}

impl<'a> Program<'a> {
    pub fn new(name: impl Into<String>, frame: impl FnMut() + 'a) -> Self {
        Self { name: name.into(), frame: Box::new(frame), times: Vec::new() }
    }

    fn turn(&mut self) {
        let start = processor_time();
        (0..FRAMES).for_each(|_| (self.frame)());
        self.times.push((processor_time() - start) / FRAMES as f64);
    }

    /// Lower quartile, median and upper quartile of the ratios of its times to those of another, round by round.
    pub fn against(&self, other: &Self) -> [f64; 3] {
        quartiles(self.times.iter().zip(&other.times).map(|(own, other)| own / other))
    }
}

/// Lets programs take turns, every second round in the opposite order. If `RELIEVO_ONLY` names one of them, that plays alone
/// and ends the process: a profiler then sees nothing else.
pub fn take_turns(programs: &mut [Program<'_>]) {
    let only = std::env::var("RELIEVO_ONLY").ok();
    if let Some(program) = programs.iter_mut().find(|program| only.as_ref() == Some(&program.name)) {
        (0..WARM_UP + 3 * ROUNDS).for_each(|_| program.turn());
        println!("{}: {:.2} ms a frame", program.name, quartiles(program.times.iter().copied())[1]);
        std::process::exit(0);
    }
    for round in 0..WARM_UP + ROUNDS {
        if round == WARM_UP {
            programs.iter_mut().for_each(|program| program.times.clear());
        }
        match round % 2 {
            0 => programs.iter_mut().for_each(Program::turn),
            _ => programs.iter_mut().rev().for_each(Program::turn),
        }
    }
}

/// A table of programs: their times, and ratios to the first.
pub fn table(title: &str, programs: &[Program<'_>]) -> String {
    let mut text = format!("\n{title}; {ROUNDS} turns of {FRAMES} frames each, in processor time\n\n");
    text += "| | ms a frame | of the first | quartiles |\n|---|---:|---:|---:|\n";
    for program in programs {
        let [low, middle, high] = program.against(&programs[0]);
        let time = quartiles(program.times.iter().copied())[1];
        writeln!(text, "| {} | {time:.2} | {middle:.3} | {low:.3}–{high:.3} |", program.name)
            .expect("a string");
    }
    text
}

/// Lower quartile, median and upper quartile.
fn quartiles(values: impl Iterator<Item = f64>) -> [f64; 3] {
    let mut values: Vec<f64> = values.collect();
    values.sort_by(f64::total_cmp);
    [1, 2, 3].map(|quarter| values[quarter * (values.len() - 1) / 4])
}

#[test]
fn ratios_are_taken_round_by_round() {
    let program = |times: [f64; 5]| Program { times: times.to_vec(), ..Program::new("", || ()) };
    // The machine's speed changes between rounds: the ratio of medians would be 1.
    let (own, other) = (program([2.0, 20.0, 2.0, 30.0, 8.0]), program([1.0, 10.0, 1.0, 10.0, 8.0]));
    assert_eq!(own.against(&other), [2.0, 2.0, 2.0]);
    assert_eq!(quartiles([5.0, 1.0, 4.0, 2.0, 3.0].into_iter()), [2.0, 3.0, 4.0]);
}

/// Four times the work takes four times as long. Other tests in the process would take processor time too.
#[test]
#[ignore = "measures"]
fn programs_are_timed() {
    let spins = |count: u64| {
        Program::new("", move || {
            std::hint::black_box((0..count).fold(0, |sum: u64, at| std::hint::black_box(sum ^ at)));
        })
    };
    let mut both = [spins(400_000), spins(1_600_000)];
    take_turns(&mut both);
    let [_, ratio, _] = both[1].against(&both[0]);
    assert!((3.0..5.0).contains(&ratio), "{ratio}");
}
