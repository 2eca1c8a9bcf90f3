//! What is fastest on which adapter, so that no public signature has to ask.

/// The vendor of Mesa's software drivers, of which lavapipe is one (Vulkan's registry, `VK_VENDOR_ID_MESA`).
const MESA: u32 = 0x1_0005;
/// The PCI vendor that SwiftShader gives.
const GOOGLE: u32 = 0x1ae0;

/// What runs the shaders of a device.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Processor {
    Hardware,
    /// Mesa's driver on the CPU, which compiles with LLVM.
    Lavapipe,
    SwiftShader,
    OtherSoftware,
}

/// How kernels are cut on a device.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Tuning {
    processor: Processor,
}

impl Tuning {
    pub(super) fn of(info: &wgpu::AdapterInfo) -> Self {
        let processor = match (info.device_type, info.vendor) {
            (wgpu::DeviceType::Cpu, MESA) => Processor::Lavapipe,
            (wgpu::DeviceType::Cpu, GOOGLE) => Processor::SwiftShader,
            (wgpu::DeviceType::Cpu, _) => Processor::OtherSoftware,
            _ => Processor::Hardware,
        };
        Self { processor }
    }

    /// Few long threads in few dispatches rather than many short ones: the CPU's cores run them.
    pub(crate) fn wants_long_threads(self) -> bool {
        self.processor != Processor::Hardware
    }

    /// A longer shader that saves memory operations: they cost lavapipe most.
    pub(crate) fn wants_long_shaders(self) -> bool {
        self.processor == Processor::Lavapipe
    }

    /// Whether the driver compiles long shaders at all: SwiftShader's compiler takes gigabytes for them.
    pub fn compiles_long_shaders(self) -> bool {
        self.processor != Processor::SwiftShader
    }
}

#[cfg(test)]
mod tests {
    use crate::gpu::{Gpu, Options, adapters};

    /// Today's drivers, by the names that people know them by.
    #[test]
    fn adapters_are_told_by_vendor_and_kind() {
        let all = adapters();
        assert!(!all.is_empty(), "the suite needs an adapter");
        for summary in all {
            let options = Options { adapter: Some(summary.name.clone()) };
            let tuning = Gpu::headless(&options).expect("a device").tuning();
            assert_eq!(tuning.wants_long_threads(), summary.is_software(), "{summary}");
            assert_eq!(tuning.wants_long_shaders(), summary.name.contains("llvmpipe"), "{summary}");
            assert_eq!(tuning.compiles_long_shaders(), !summary.name.contains("SwiftShader"), "{summary}");
        }
    }
}
