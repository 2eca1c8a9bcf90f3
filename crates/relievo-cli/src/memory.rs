//! Checks that the data of a run fit into the memory that this process may use.

use relievo::InputError;
use sysinfo::{CGroupLimits, Pid, ProcessesToUpdate, System};

/// Refuses `patches`, given as `text`, if they need more bytes than the machine and the process's control
/// group have available.
pub fn check(text: &str, needed: u128) -> Result<(), InputError> {
    check_within(text, needed, available())
}

fn check_within(text: &str, needed: u128, available: u64) -> Result<(), InputError> {
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

/// Number of bytes that this process may still allocate. If the system does not say, the check passes and
/// allocation itself decides.
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

/// The smallest of the memory that the machine has available and the memory that each control group has left.
/// A group's page cache counts as available, as the machine's does.
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
    fn a_byte_too_many_is_refused() {
        assert!(check_within("2x3", 1000, 1000).is_ok());
        let error = check_within("2x3", 1001, 1000).expect_err("a byte too many").to_string();
        assert!(error.starts_with("patches = 2x3: needs about "), "{error}");
    }
}
