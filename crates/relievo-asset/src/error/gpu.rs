//! Errors of the GPU device. Each message includes advice.

/// A failure of the GPU device or its driver.
#[derive(Debug, thiserror::Error)]
pub enum GpuError {
    /// No adapter matches the request.
    #[error("no GPU adapter {wanted}; {seen}")]
    NoAdapter {
        /// How the search failed: no adapter was found, or none matches the requested name.
        wanted: String,
        /// Names of the existing adapters, with advice for the user.
        seen: String,
    },
    /// The adapter provides no device with WebGPU's default limits.
    #[error(
        "adapter `{adapter}` gives no device: {reason}; choose another with RELIEVO_ADAPTER (`relievo info` lists them)"
    )]
    NoDevice {
        /// The adapter's name.
        adapter: String,
        /// The driver's message.
        reason: String,
    },
    /// The device was lost, with everything that was created on it.
    #[error(
        "the GPU device was lost ({reason}); create a new `Gpu`, and everything on it again (scenes: `Scene::rebuild_all`)"
    )]
    DeviceLost {
        /// The driver's message.
        reason: String,
    },
    /// The device has no memory left.
    #[error("the GPU has no memory left ({reason}); use a smaller batch or drop buffers")]
    OutOfMemory {
        /// wgpu's message.
        reason: String,
    },
    /// wgpu rejected a call.
    #[error(
        "wgpu refused a call: {reason}; if it names none of your own resources, please report this with the output of `relievo info`"
    )]
    Validation {
        /// wgpu's message.
        reason: String,
    },
    /// The driver failed for an internal reason.
    #[error("the GPU driver failed: {reason}; `relievo verify` tells which kernels it runs correctly")]
    Internal {
        /// wgpu's message.
        reason: String,
    },
    /// A pass needs more than a limit of the device permits.
    #[error("{pass} needs {limit} = {needed}, and this device allows {available}; {remedy}")]
    Limit {
        /// Name of the pass.
        pass: &'static str,
        /// WebGPU's name of the limit.
        limit: &'static str,
        /// The value that the pass needs.
        needed: u64,
        /// The device's limit.
        available: u64,
        /// Advice for the user.
        remedy: &'static str,
    },
    /// The device did not finish in time.
    #[error(
        "the GPU did not finish within {seconds} s; the driver may hang: try a smaller batch or another adapter"
    )]
    Hung {
        /// The time waited, in seconds.
        seconds: u64,
    },
}

impl GpuError {
    /// Replaces the advice of a [`GpuError::Limit`] by `remedy`. Other errors stay unchanged.
    #[doc(hidden)]
    pub fn with_remedy(self, remedy: &'static str) -> Self {
        match self {
            Self::Limit { pass, limit, needed, available, .. } => {
                Self::Limit { pass, limit, needed, available, remedy }
            }
            other => other,
        }
    }
}
