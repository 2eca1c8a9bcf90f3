//! Selection of a GPU adapter by name or kind.

use super::GpuError;

/// The environment variable that selects an adapter if [`Options::adapter`] is `None`.
pub(crate) const ADAPTER_VARIABLE: &str = "RELIEVO_ADAPTER";

/// Selection of an adapter.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Options {
    /// A kind (`discrete`, `integrated`, `virtual`, `cpu`), or a part of the adapter's name or driver (`llvmpipe`,
    /// `swiftshader`, `H200`). Upper and lower case are equal. If this field is `None`, the environment variable
    /// `RELIEVO_ADAPTER` selects the adapter. If the variable is not set either, the fastest available kind is used.
    pub adapter: Option<String>,
}

/// Name, kind, driver and backend of an adapter, as reports and stored reference results quote them.
#[derive(Debug, Clone, PartialEq, Eq, serde::Serialize)]
pub struct AdapterSummary {
    /// Name of the adapter, as the driver states it.
    pub name: String,
    /// Kind of the adapter: `discrete`, `integrated`, `virtual`, `cpu` or `other`.
    pub kind: &'static str,
    /// Name and version of the driver.
    pub driver: String,
    /// Graphics API: `Vulkan`, `Metal`, `Dx12`, `Gl` or `BrowserWebGpu`.
    pub backend: String,
}

impl AdapterSummary {
    pub(super) fn of(info: &wgpu::AdapterInfo) -> Self {
        let kind = match info.device_type {
            wgpu::DeviceType::DiscreteGpu => "discrete",
            wgpu::DeviceType::IntegratedGpu => "integrated",
            wgpu::DeviceType::VirtualGpu => "virtual",
            wgpu::DeviceType::Cpu => "cpu",
            wgpu::DeviceType::Other => "other",
        };
        let driver = format!("{} {}", info.driver, info.driver_info).trim().to_owned();
        Self { name: info.name.clone(), kind, driver, backend: format!("{:?}", info.backend) }
    }

    /// Whether the adapter renders on the CPU, like lavapipe or SwiftShader.
    pub fn is_software(&self) -> bool {
        self.kind == "cpu"
    }

    fn matches(&self, wanted: &str) -> bool {
        let wanted = wanted.to_lowercase();
        self.kind == wanted
            || self.name.to_lowercase().contains(&wanted)
            || self.driver.to_lowercase().contains(&wanted)
    }

    // Position of the adapter's kind in a ranking by speed; 0 is the fastest.
    fn rank(&self) -> usize {
        let kinds = ["discrete", "integrated", "virtual", "cpu", "other"];
        kinds.iter().position(|kind| *kind == self.kind).unwrap_or(kinds.len())
    }
}

impl std::fmt::Display for AdapterSummary {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{} ({}, {}, driver {})", self.name, self.kind, self.backend, self.driver)
    }
}

/// Lists all adapters of this machine, the fastest kind first. The first adapter is the default.
#[cfg(not(target_arch = "wasm32"))]
pub fn adapters() -> Vec<AdapterSummary> {
    let mut all: Vec<_> = (pollster::block_on(enumerate()).iter())
        .map(|adapter| AdapterSummary::of(&adapter.get_info()))
        .collect();
    all.sort_by_key(AdapterSummary::rank);
    all
}

async fn enumerate() -> Vec<wgpu::Adapter> {
    // GL is the last resort. Its drivers have poor compute support, and they look for a window system.
    let native = enumerate_on(wgpu::Backends::all() - wgpu::Backends::GL).await;
    if native.is_empty() { enumerate_on(wgpu::Backends::GL).await } else { native }
}

async fn enumerate_on(backends: wgpu::Backends) -> Vec<wgpu::Adapter> {
    // Validation layers are off. GPU-assisted validation is off, too: it corrupts shaders on lavapipe.
    let descriptor = wgpu::InstanceDescriptor {
        backends,
        flags: wgpu::InstanceFlags::empty(),
        ..wgpu::InstanceDescriptor::new_without_display_handle()
    };
    wgpu::Instance::new(descriptor).enumerate_adapters(backends).await
}

pub(super) async fn choose(options: &Options) -> Result<wgpu::Adapter, GpuError> {
    let wanted = (options.adapter.clone())
        .or_else(|| std::env::var(ADAPTER_VARIABLE).ok())
        .filter(|wanted| !wanted.trim().is_empty());
    let mut all: Vec<_> = (enumerate().await.into_iter())
        .map(|adapter| (AdapterSummary::of(&adapter.get_info()), adapter))
        .collect();
    all.sort_by_key(|(summary, _)| summary.rank());
    let names = all.iter().map(|(summary, _)| format!("`{}`", summary.name)).collect::<Vec<_>>();
    let found = match &wanted {
        Some(wanted) => all.into_iter().find(|(summary, _)| summary.matches(wanted)),
        None => all.into_iter().next(),
    };
    found.map(|(_, adapter)| adapter).ok_or_else(|| GpuError::NoAdapter {
        wanted: wanted.map_or("was found".to_owned(), |wanted| format!("matches `{wanted}`")),
        seen: if names.is_empty() {
            "install a Vulkan driver (on Debian: apt-get install mesa-vulkan-drivers)".to_owned()
        } else {
            format!("there are {}: name one in RELIEVO_ADAPTER or --adapter", names.join(", "))
        },
    })
}
