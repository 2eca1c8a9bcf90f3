//! Whether a grid of patches fits the memory that this process may use.

use relievo::InputError;
use sysinfo::{CGroupLimits, Pid, ProcessesToUpdate, System};

/// What a run keeps in memory.
#[derive(Clone, Copy, Debug)]
pub struct Load {
    /// Columns and rows of patches.
    pub grid: [u32; 2],
    /// Samples along an edge of a patch's window.
    pub width: u64,
    /// Injected points.
    pub features: u64,
}

impl Load {
    /// Refuses what exceeds the memory that is available, of the machine and of the process's control group.
    ///
    /// # Errors
    /// [`InputError`] that names `patches`, given as `text`.
    pub fn check(&self, text: &str) -> Result<(), InputError> {
        self.check_within(text, available())
    }

    fn check_within(&self, text: &str, available: u64) -> Result<(), InputError> {
        let needed = self.bytes();
        if needed <= u128::from(available) {
            return Ok(());
        }
        let gibibytes = |bytes: f64| bytes / f64::from(1 << 30);
        let bound = format!(
            "needs about {:.1} GiB of memory, and {:.1} GiB are available",
            gibibytes(needed as f64),
            gibibytes(available as f64)
        );
        Err(InputError::new("patches", text, bound))
    }

    fn bytes(&self) -> u128 {
        // Two windows while it is made; heights, map and files' bytes while it is written. The index of features
        // has eight bytes for every 32 points of every level, on the host and on the device.
        let bytes_a_point = if self.features == 0 { 24 } else { 25 };
        // The list that is read, the tree that it is sorted into, and its values in a few windows and levels.
        self.points().saturating_mul(bytes_a_point).saturating_add(u128::from(self.features) * 128)
    }

    /// Samples of all windows.
    fn points(&self) -> u128 {
        let edges = self.grid.map(u64::from).into_iter().chain([self.width; 2]);
        edges.map(u128::from).fold(1, u128::saturating_mul)
    }

    /// The same with every `every`-th of `samples` injected along both axes, as far as the grid goes.
    pub fn with_samples(self, samples: usize, every: u32) -> Self {
        let samples = self.points().min(samples as u128) / u128::from(every.max(1)).pow(2);
        Self { features: samples as u64, ..self }
    }
}

/// Bytes that this process may still use. Where the system does not say, allocation decides.
fn available() -> u64 {
    let Ok(mut system) = System::new() else { return u64::MAX };
    system.refresh_memory();
    let own = sysinfo::get_current_pid().ok().and_then(|pid| group_of(&mut system, pid));
    within([system.cgroup_limits(), own], system.available_memory())
}

fn group_of(system: &mut System, pid: Pid) -> Option<CGroupLimits> {
    system.refresh_processes(ProcessesToUpdate::Some(&[pid]), false);
    system.process(pid)?.cgroup_limits()
}

/// The smallest of what the machine has available and what the groups have left. A group's page cache counts
/// as available, as the machine's does.
fn within(groups: [Option<CGroupLimits>; 2], machine: u64) -> u64 {
    let left = |group: CGroupLimits| group.total_memory.saturating_sub(group.rss);
    groups.into_iter().flatten().map(left).fold(machine, u64::min)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_control_group_bounds_what_is_available() {
        let group =
            |total_memory, rss| Some(CGroupLimits { total_memory, free_memory: 0, free_swap: 0, rss });
        assert_eq!(within([None, None], 1000), 1000);
        assert_eq!(within([group(5000, 10), None], 1000), 1000);
        assert_eq!(within([group(5000, 10), group(600, 100)], 1000), 500);
        assert_eq!(within([group(10, 100), None], 1000), 0);
    }

    #[test]
    fn features_need_room() {
        let load = Load { grid: [2, 3], width: 35, features: 0 };
        let needed = 6 * 35 * 35 * 24;
        assert!(load.check_within("2x3", needed).is_ok());
        let error = load.check_within("2x3", needed - 1).expect_err("a byte too many").to_string();
        assert!(error.starts_with("patches = 2x3: needs about "), "{error}");
        assert!(Load { features: 1, ..load }.check_within("2x3", needed).is_err());
        assert!(Load { features: 1 << 30, ..load }.bytes() > 1 << 37);
        assert_eq!(load.with_samples(900, 3).features, 100);
        assert_eq!(load.with_samples(1 << 40, 1).features, 6 * 35 * 35);
        assert!(
            Load { grid: [u32::MAX; 2], width: u64::from(u32::MAX), features: u64::MAX }
                .check_within("", u64::MAX)
                .is_err()
        );
    }
}
