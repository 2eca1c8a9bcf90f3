//! The viewer of relievo: scenes, models, packages and terrain before one's eyes, natively and in a page, with every control of
//! level of detail and what it costs.
//!
//! [`Viewer`] is the whole program without a window: it takes input, shows a panel and the picture, and draws both into a texture
//! of its host. Tests drive it in the same way as a window does. `run` opens a window, natively; `web` has the page.
//!
//! Whatever is opened becomes a scene file ([`Document`]): a model gets a light and a camera that frames it, a configuration of
//! terrain a camera above its ground. So the scene can be saved as it is, with everything that the controls changed.
//!
//! Files come from a [`Source`]: a folder, memory, or a site, from which packages come level by level. The device does its work while a thread of its own loads, or, in a
//! page, between its frames.

mod controls;
mod document;
mod experiment;
mod eye;
mod history;
mod images;
mod load;
mod overlay;
mod panel;
mod settings;
mod shown;
mod source;
mod stage;
mod start;
mod streaming;
mod theme;
mod viewer;
#[cfg(target_arch = "wasm32")]
pub mod web;
#[cfg(not(target_arch = "wasm32"))]
mod window;
mod wires;

pub use controls::{Drag, GateBy, LevelsBy};
pub use document::{Content, Document};
pub use eye::Eye;
pub use history::{History, Sample};
pub use load::Arrival;
pub use settings::{Settings, Theme};
pub use shown::{Clock, Shown};
#[cfg(not(target_arch = "wasm32"))]
pub use source::Folder;
pub use source::{Locate, Memory, Reading, Site, Source, locate};
pub use stage::{Colors, Stage};
pub use start::{Start, point};
pub use streaming::{Asked, PackageState};
pub use viewer::{Output, Request, Viewer};
#[cfg(not(target_arch = "wasm32"))]
pub use window::{Options, draw, run};
pub use wires::Wires;
