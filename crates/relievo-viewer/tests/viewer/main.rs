//! The viewer, driven without a window: every control is moved by pointer or keys, and its effect is asserted in pixels, counts or
//! state.

mod controls;
mod driver;
mod inputs;
mod life;
mod looks;
mod panel;
mod session;
mod site;
