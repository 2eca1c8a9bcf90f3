//! A controller that limits the triangles of a view, so that frames stay within a time limit.

/// Time constant of the moving average of frame times, in frames.
const FRAMES: f32 = 6.0;

/// Dead band, as a fraction of the time limit. The triangle limit does not change while frames are shorter than the
/// time limit by at most this fraction.
const DEAD_BAND: f32 = 0.05;

/// Bounds of the factor by which the triangle limit changes in one frame: the smallest factor (`FALL`), and the largest
/// factor (`RISE`).
const FALL: f32 = 0.85;
const RISE: f32 = 1.04;

/// The initial triangle limit, which is also the largest one.
const MOST: f32 = 64e6;

/// The smallest triangle limit.
const LEAST: f32 = 1e3;

/// Adjusts a triangle limit so that frames take a given time.
///
/// Frame times are averaged over some frames. The triangle limit changes if the average exceeds the time limit, or is
/// shorter by more than a twentieth. The limit is then multiplied by √(time limit / average). The bounds of this factor
/// make the triangle limit fall faster than it rises. It therefore settles from one side, and does not oscillate around
/// a level of detail that takes too long.
#[derive(Debug, Clone, Default)]
pub(super) struct Pacer {
    limit: Option<f32>,
    average: Option<f32>,
    /// The last triangle limit at which frames took too long, and the number of frames since then.
    too_many: Option<(f32, u32)>,
}

/// Number of frames after which a triangle limit that took too long may be tried again.
const PATIENCE: u32 = 240;

impl Pacer {
    /// Adjusts the triangle limit after a frame. `time` is the time that the frame took, and `target` is the time limit
    /// in the same unit.
    pub fn took(&mut self, time: f32, target: f32) {
        let average = self.average.map_or(time, |average| average + (time - average) / FRAMES);
        self.average = Some(average);
        let limit = self.limit.unwrap_or(MOST);
        if let Some((_, frames)) = &mut self.too_many {
            *frames += 1;
        }
        self.too_many = self.too_many.filter(|(_, frames)| *frames < PATIENCE);
        let ratio = (target / average.max(1e-6)).sqrt();
        let next = if average > target && time > target {
            self.too_many = Some((limit, 0));
            limit * ratio.max(FALL)
        } else if average < (1.0 - DEAD_BAND) * target {
            let most = self.too_many.map_or(MOST, |(limit, _)| 0.98 * limit);
            (limit * ratio.min(RISE)).min(most).max(limit.min(most))
        } else {
            limit
        };
        self.limit = Some(next.clamp(LEAST, MOST));
    }

    /// The triangle limit; `None` before the first frame.
    pub fn limit(&self) -> Option<u32> {
        self.limit.map(|limit| limit as u32)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A simulated frame time in milliseconds: 2 ms, plus 1 ms per 100,000 triangles. The levels of detail are coarse,
    /// so the number of triangles changes in steps of a tenth.
    fn time(limit: u32, scene: f32) -> f32 {
        let wanted = (limit as f32).min(scene);
        let steps = (wanted.log2() / 1.1_f32.log2()).floor();
        2.0 + 1e-5 * 1.1_f32.powf(steps)
    }

    #[test]
    fn the_limit_settles_and_does_not_oscillate_beyond_a_level() {
        for scene in [3e5, 2e6, 5e7] {
            let mut pacer = Pacer::default();
            let mut times = Vec::new();
            for _ in 0..600 {
                let took = time(pacer.limit().unwrap_or(u32::MAX), scene);
                times.push(took);
                pacer.took(took, 8.0);
            }
            let settled = &times[300..];
            let [least, most] = [f32::min, f32::max].map(|of| settled.iter().copied().fold(settled[0], of));
            assert!(most <= 1.1 * 8.0 && most - least <= 0.12 * most, "{scene}: {least} to {most}");
            if scene > 1e6 {
                assert!(least > 0.75 * 8.0, "{scene}: {least} of 8 ms are used");
            } else {
                assert!(most < 8.0, "all of a small scene is drawn");
            }
        }
    }

    #[test]
    fn a_step_of_load_is_followed_within_a_second() {
        let mut pacer = Pacer::default();
        for _ in 0..300 {
            pacer.took(time(pacer.limit().unwrap_or(u32::MAX), 5e7), 8.0);
        }
        // From now on, triangles cost twice as much.
        let slow = |limit: u32| 2.0 * time(limit, 5e7) - 2.0;
        let mut late = 0;
        for _ in 0..60 {
            let took = slow(pacer.limit().expect("some"));
            late += u32::from(took > 1.05 * 8.0);
            pacer.took(took, 8.0);
        }
        assert!(late < 30, "{late} of 60 frames were late");
        assert!(slow(pacer.limit().expect("some")) <= 1.05 * 8.0);
    }
}
