//! What the page `scene.html` calls: a small scene, drawn in the browser.

#[path = "../../../../../../tests/mesh/alike.rs"]
mod alike;
mod delivery;
mod picture;

use std::time::Duration;

use picture::World;
use relievo::gpu::{Buffer, Gpu, Options};
use relievo_delivery::client::BrowserTransport;
use wasm_bindgen::prelude::{JsValue, wasm_bindgen};
use wasm_bindgen_futures::JsFuture;

#[wasm_bindgen]
unsafe extern "C" {
    /// Tells the page why the program ends.
    fn panicked(message: &str);
    /// Resolves soon, after other work of the page.
    fn pause() -> js_sys::Promise;
}

/// Lets the page know why a call fails that Rust aborts.
#[wasm_bindgen(start)]
pub fn start() {
    std::panic::set_hook(Box::new(|panic| panicked(&panic.to_string())));
}

/// Draws the scene on a device of its own, under the light of the day or, for a picture that must be refused, of the
/// evening. Pixels are RGBA in sRGB, row by row.
#[wasm_bindgen]
pub async fn draw(evening: bool) -> Result<Vec<u8>, JsValue> {
    let drawn = async {
        let gpu = Gpu::headless_async(&Options::default()).await?;
        drawn(&gpu, World::new(&gpu, evening).await?).await
    };
    drawn.await.map_err(|error| JsValue::from_str(&error.to_string()))
}

/// Draws the scene of a file on a device of its own; pixels as above.
#[wasm_bindgen]
pub async fn draw_file() -> Result<Vec<u8>, JsValue> {
    let drawn = async {
        let gpu = Gpu::headless_async(&Options::default()).await?;
        drawn(&gpu, World::of_file(&gpu).await?).await
    };
    drawn.await.map_err(|error| JsValue::from_str(&error.to_string()))
}

/// Draws terrain without end on a device of its own; pixels as above.
#[wasm_bindgen]
pub async fn draw_endless() -> Result<Vec<u8>, JsValue> {
    let drawn = async {
        let gpu = Gpu::headless_async(&Options::default()).await?;
        drawn(&gpu, World::endless(&gpu).await?).await
    };
    drawn.await.map_err(|error| JsValue::from_str(&error.to_string()))
}

/// Draws grass, a kind of object that the library does not know, on a device of its own; pixels as above.
#[wasm_bindgen]
pub async fn draw_kind() -> Result<Vec<u8>, JsValue> {
    let drawn = async {
        let gpu = Gpu::headless_async(&Options::default()).await?;
        drawn(&gpu, World::meadow(&gpu).await?).await
    };
    drawn.await.map_err(|error| JsValue::from_str(&error.to_string()))
}

/// Velocities of the grass, two 16-bit floats a pixel.
#[wasm_bindgen]
pub async fn kind_velocities() -> Result<Vec<u8>, JsValue> {
    let drawn = async {
        let gpu = Gpu::headless_async(&Options::default()).await?;
        let mut world = World::meadow(&gpu).await?;
        world.draw(&gpu).await?;
        world.velocities(&gpu).await
    };
    drawn.await.map_err(|error| JsValue::from_str(&error.to_string()))
}

/// What rays hit of the grass, and what is said of mistakes in its text.
#[wasm_bindgen]
pub async fn kind_said() -> Result<Vec<String>, JsValue> {
    let said = async {
        let gpu = Gpu::headless_async(&Options::default()).await?;
        let mut world = World::meadow(&gpu).await?;
        world.draw(&gpu).await?;
        Ok::<_, relievo::Error>([world.picked()?, picture::mistakes()].concat())
    };
    said.await.map_err(|error| JsValue::from_str(&error.to_string()))
}

async fn drawn(gpu: &Gpu, mut world: World) -> Result<Vec<u8>, relievo::Error> {
    let pixels = world.draw(gpu).await?;
    gpu.check_async().await?;
    Ok(pixels)
}

/// Hashes of simplified meshes, and of those that other reducers leave.
#[wasm_bindgen]
pub fn collapses() -> Vec<String> {
    alike::hashes().into_iter().chain(alike::reduced()).collect()
}

/// What the library says of a write between two words: at once, and once the browser has told the errors so far.
#[wasm_bindgen]
pub async fn mistake() -> Result<Vec<String>, JsValue> {
    made().await.map_err(|error| JsValue::from_str(&error.to_string()))
}

async fn made() -> Result<Vec<String>, relievo::Error> {
    let gpu = Gpu::headless_async(&Options::default()).await?;
    let buffer = Buffer::from_slice(&gpu, "short", &[1_u32, 2])?;
    let said = |result: Result<(), relievo::gpu::GpuError>| match result {
        Ok(()) => "nothing".to_owned(),
        Err(error) => error.to_string(),
    };
    let bytes = Buffer::from_slice(&gpu, "bytes", &[0_u8; 8])?;
    let at_once = said(bytes.write_at(&gpu, 1, &[9_u8; 4]));
    let later = said(gpu.check_async().await);
    // The buffer and the device are of use afterwards.
    buffer.write_at(&gpu, 1, &[7_u32])?;
    let kept = format!("{:?}", buffer.read(&gpu).await?);
    Ok(vec![at_once, later, kept])
}

/// Runs the parity cases of the kernels whose names contain `only`: the number of cases, and then those that fail.
#[wasm_bindgen]
pub async fn parity(only: String) -> Result<Vec<String>, JsValue> {
    let run = async {
        let gpu = Gpu::headless_async(&Options::default()).await?;
        relievo_lab::verify::run_async(&gpu, Some(&only), &mut |_| ()).await
    };
    let report = run.await.map_err(|error| JsValue::from_str(&error.to_string()))?;
    let wrong = report.cases.iter().filter(|case| !case.comparison.holds).map(|case| format!("{case:?}"));
    Ok(std::iter::once(report.cases.len().to_string()).chain(wrong).collect())
}

/// Fetches all that a server has; see `delivery.rs`.
#[wasm_bindgen]
pub async fn fetched(base: &str) -> Result<Vec<String>, JsValue> {
    let wait = async || {
        // A promise of a timer is never refused.
        let _ = JsFuture::from(pause()).await;
        Duration::from_secs_f64(js_sys::Date::now() / 1000.0)
    };
    let lines = delivery::fetched(base, BrowserTransport::new(), wait).await;
    lines.map_err(|error| JsValue::from_str(&error.to_string()))
}
