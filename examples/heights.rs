//! The same heights from the CPU and from the GPU: `cargo run --example heights`.

use relievo::gpu::{Gpu, Options};
use relievo::ops::terrain::config::TerrainConfig;
use relievo::ops::terrain::export::sha256;
use relievo::ops::terrain::field::field;
use relievo::ops::terrain::generator::Generator;
use relievo::ops::terrain::recipe::Recipe;

fn main() -> Result<(), relievo::Error> {
    let recipe = Recipe::new(TerrainConfig::from_json(
        r#"{"patchSize": 257, "scaleFactor": 40.0, "seed": "any text"}"#,
    )?);
    let on_cpu = field(&recipe, &[[0, 0]], 0)?;
    println!("CPU {}", sha256(&on_cpu[0]));

    let gpu = Gpu::headless(&Options::default())?;
    let on_gpu = Generator::new(&gpu, recipe)?.generate(&gpu, &[[0, 0]], 0, &mut |_| ())?;
    println!("GPU {} on {}", sha256(&on_gpu[0].heights.read_blocking(&gpu)?), gpu.adapter());
    Ok(())
}
