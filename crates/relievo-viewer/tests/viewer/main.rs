//! The viewer, driven without a window: every control is moved by pointer or keys, and its effect is asserted in pixels, counts or
//! state.

use peak_alloc::PeakAlloc;

mod controls;
mod driver;
#[path = "../../../relievo-delivery/tests/delivery/host.rs"]
#[allow(dead_code, reason = "other tests use the rest")]
mod host;
mod inputs;
mod life;
mod looks;
mod panel;
mod session;
mod site;

/// Counts the bytes that the program holds, those of wgpu included, but not those of drivers.
#[global_allocator]
static HEAP: PeakAlloc = PeakAlloc;
