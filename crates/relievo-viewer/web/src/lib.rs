//! What the page calls. Elsewhere than in a browser, there is nothing.

#![cfg(target_arch = "wasm32")]

use wasm_bindgen::prelude::wasm_bindgen;

/// Opens the viewer in the canvas of the page.
#[wasm_bindgen(start)]
pub fn start() {
    relievo_viewer::web::start();
}

/// What the viewer shows, as JSON.
#[wasm_bindgen]
pub fn state() -> String {
    relievo_viewer::web::state()
}

/// Asks what all controls say. The answer is in the state once its field `answer` is the number that this returns.
#[wasm_bindgen]
pub fn ask() -> u32 {
    relievo_viewer::web::ask()
}
