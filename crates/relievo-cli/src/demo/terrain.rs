//! The pictures of terrain.

use relievo::Error;
use relievo_lab::files::write_file;

use super::{Entry, Page, entry};
use crate::terrain::{Pictures, Terrain};

/// A picture, the configuration of its terrain, and whether a valley is injected.
struct Configured {
    entry: Entry,
    config: &'static str,
    has_valley: bool,
}

/// A configuration whose zones lie by height and slope.
const LOOK: &str = include_str!("../../../../examples/terrain.json");

/// Mountains with hydraulic erosion.
const ERODED: &str = include_str!("../../../../examples/eroded.json");

const VALLEY: &str = include_str!("../../../../examples/valley.json");

const fn plain(
    name: &'static str,
    title: &'static str,
    arguments: &'static str,
    config: &'static str,
) -> Configured {
    Configured { entry: entry(name, title, arguments), config, has_valley: false }
}

const fn valley(name: &'static str, title: &'static str, config: &'static str) -> Configured {
    Configured { has_valley: true, ..plain(name, title, "", config) }
}

const ENTRIES: &[Configured] = &[
    plain(
        "textured",
        "A patch from size, height and a seed; six zones of ground by height and slope, blended where their textures are deep",
        "",
        LOOK,
    ),
    plain(
        "grid",
        "Nine patches, made independently: no seam in height, slope or texture",
        "--patches 3x3",
        r#"{"patchSize": 129, "scaleFactor": 40.0, "seed": "seamless", "interpolation": "smooth", "variation": 0.5}"#,
    ),
    plain(
        "mountains",
        "coarseLevels 2: mountains larger than a patch",
        "--patches 4x4",
        r#"{"patchSize": 129, "scaleFactor": 130.0, "seed": "alps", "coarseLevels": 2, "interpolation": "smooth", "triplanar": true}"#,
    ),
    plain(
        "wireframe",
        "The mesh that is drawn, straight from the heights",
        "--wireframe",
        r#"{"patchSize": 65, "scaleFactor": 12.0, "seed": "wire", "interpolation": "smooth"}"#,
    ),
    plain(
        "step_1",
        "After one subdivision",
        "--wireframe",
        r#"{"patchSize": 3, "scaleFactor": 12.0, "seed": "wire", "interpolation": "smooth", "terrainScale": 32}"#,
    ),
    plain(
        "step_2",
        "After two subdivisions: every second sample is one of the first",
        "--wireframe",
        r#"{"patchSize": 5, "scaleFactor": 12.0, "seed": "wire", "interpolation": "smooth", "terrainScale": 16}"#,
    ),
    plain(
        "step_5",
        "After five subdivisions",
        "--wireframe",
        r#"{"patchSize": 33, "scaleFactor": 12.0, "seed": "wire", "interpolation": "smooth", "terrainScale": 2}"#,
    ),
    valley(
        "valley_1",
        "A valley injected by a sixteenth of its heights, seed one",
        r#"{"patchSize": 129, "scaleFactor": 24.0, "seed": "one", "interpolation": "smooth"}"#,
    ),
    valley(
        "valley_2",
        "The same valley, seed two",
        r#"{"patchSize": 129, "scaleFactor": 24.0, "seed": "two", "interpolation": "smooth"}"#,
    ),
    valley(
        "valley_3",
        "The same valley, seed three",
        r#"{"patchSize": 129, "scaleFactor": 24.0, "seed": "three", "interpolation": "smooth"}"#,
    ),
    plain(
        "additive",
        "Zone weights that are added and not normalized: brighter where zones overlap",
        "--weights additive",
        r#"{"patchSize": 257, "scaleFactor": 40.0, "seed": "any text", "interpolation": "smooth"}"#,
    ),
    plain(
        "thermal",
        "The first patch after despiking and 120 iterations of thermal erosion",
        "--despike 0.6 --thermal 120",
        LOOK,
    ),
    plain("uneroded", "Mountains before rain falls on them", "--hydraulic 0", ERODED),
    plain(
        "eroded",
        "The same after 300 cycles of hydraulic erosion: ravines that join into valleys, and fans before the mountains",
        "",
        ERODED,
    ),
    plain(
        "blend",
        "The other way to join patches, for comparison: each by itself, with 32 samples of transition",
        "--patches 2x2",
        r#"{"patchSize": 129, "scaleFactor": 40.0, "seed": "blend", "border": {"blend": 32}}"#,
    ),
];

/// Number of entries.
pub const COUNT: usize = ENTRIES.len();

/// Draws every entry onto the page.
pub fn draw(page: &mut Page<'_>, size: &str) -> Result<(), Error> {
    let [config, features] = ["config.json", "features.json"].map(|name| page.inputs.join(name));
    write_file(&features, VALLEY.as_bytes())?;
    for Configured { entry, config: text, has_valley } in ENTRIES {
        page.progress.set_message(entry.name);
        write_file(&config, text.as_bytes())?;
        let given = ["--config".as_ref(), config.as_os_str(), "--size".as_ref(), size.as_ref()];
        let injected = ["--features".as_ref(), features.as_os_str()];
        let more = if *has_valley { [&given[..], &injected[..]].concat() } else { given.to_vec() };
        let pictures = entry.command::<Terrain>("terrain", &more)?.pictures(page.context)?;
        page.staged.write(format!("{}.json", entry.name), text.as_bytes())?;
        if let Some(view) = &pictures.view {
            page.staged.write_png(format!("{}.png", entry.name), view)?;
        }
        page.staged.write_png(format!("{}_map.png", entry.name), &pictures.map)?;
        page.figures += &figure(entry, text, (*has_valley, size), &pictures);
        page.count += 2;
        page.progress.inc(1);
    }
    page.staged.write("valley.json", VALLEY.as_bytes())
}

fn figure(entry: &Entry, config: &str, (has_valley, size): (bool, &str), pictures: &Pictures) -> String {
    let Entry { name, title, arguments } = entry;
    let features = if has_valley { " --features valley.json" } else { "" };
    let space = if arguments.is_empty() { "" } else { " " };
    let [generate, render] = pictures.seconds;
    format!(
        "<figure>\n<a href=\"{name}.png\"><img src=\"{name}.png\" alt=\"{title}\"></a>\n\
         <a href=\"{name}_map.png\"><img class=\"map\" src=\"{name}_map.png\" alt=\"the same from above\"></a>\n\
         <figcaption>{title}.<br><code>{config}</code><br>\
         <code>relievo terrain --config {name}.json{features}{space}{arguments} --size {size} --out {name}</code><br>\
         heights {generate:.3} s, pictures {render:.3} s (first use compiles the kernels)</figcaption>\n</figure>\n",
        config = config.replace('"', "&quot;"),
    )
}
