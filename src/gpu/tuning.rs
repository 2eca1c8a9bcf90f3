//! What is fastest on which adapter, so that no public signature has to ask.

/// How kernels are cut on a device.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Tuning {
    is_software: bool,
}

impl Tuning {
    pub(super) fn of(info: &wgpu::AdapterInfo) -> Self {
        Self { is_software: info.device_type == wgpu::DeviceType::Cpu }
    }

    /// Few long threads in few dispatches rather than many short ones: the CPU's cores run them.
    pub(crate) fn wants_long_threads(self) -> bool {
        self.is_software
    }
}

#[cfg(test)]
mod tests {
    use crate::gpu::{Gpu, Options, adapters};

    /// Today's drivers, by the names that people know them by.
    #[test]
    fn adapters_are_told_by_kind() {
        let all = adapters();
        assert!(!all.is_empty(), "the suite needs an adapter");
        for summary in all {
            let options = Options { adapter: Some(summary.name.clone()) };
            let tuning = Gpu::headless(&options).expect("a device").tuning();
            assert_eq!(tuning.wants_long_threads(), summary.is_software(), "{summary}");
        }
    }
}
