//! Pictures of terrain.

use std::fmt::Write as _;
use std::path::Path;

use clap::{Args, FromArgMatches};
use relievo::Error;
use relievo::terrain::export::write_bytes;

use super::Page;
use crate::Context;
use crate::terrain::{Pictures, Terrain, save};

/// One picture: its configuration, what it injects, and the rest of its command.
struct Entry {
    name: &'static str,
    title: &'static str,
    config: &'static str,
    features: Option<&'static str>,
    arguments: &'static [&'static str],
}

const VALLEY: Option<&str> = Some(include_str!("../../../../examples/valley.json"));

const fn entry(name: &'static str, title: &'static str, config: &'static str) -> Entry {
    Entry { name, title, config, features: None, arguments: &[] }
}

const ENTRIES: &[Entry] = &[
    entry(
        "textured",
        "A patch from B's own three parameters: four zones, blended by height (B figure 3.17)",
        r#"{"patchSize": 257, "scaleFactor": 40.0, "seed": "any text"}"#,
    ),
    Entry {
        arguments: &["--patches", "3x3"],
        ..entry(
            "grid",
            "Nine patches, made independently: no seam in height, slope or texture",
            r#"{"patchSize": 129, "scaleFactor": 40.0, "seed": "seamless"}"#,
        )
    },
    Entry {
        arguments: &["--patches", "4x4"],
        ..entry(
            "mountains",
            "coarseLevels 2: mountains larger than a patch",
            r#"{"patchSize": 129, "scaleFactor": 130.0, "seed": "alps", "coarseLevels": 2}"#,
        )
    },
    Entry {
        arguments: &["--wireframe"],
        ..entry(
            "wireframe",
            "The mesh that is drawn, straight from the heights (B figure 3.15)",
            r#"{"patchSize": 65, "scaleFactor": 12.0, "seed": "wire"}"#,
        )
    },
    Entry {
        arguments: &["--wireframe"],
        ..entry(
            "step_1",
            "One subdivision (B figure 3.14)",
            r#"{"patchSize": 3, "scaleFactor": 12.0, "seed": "wire", "terrainScale": 32}"#,
        )
    },
    Entry {
        arguments: &["--wireframe"],
        ..entry(
            "step_2",
            "Two: every second sample is one of the first",
            r#"{"patchSize": 5, "scaleFactor": 12.0, "seed": "wire", "terrainScale": 16}"#,
        )
    },
    Entry {
        arguments: &["--wireframe"],
        ..entry(
            "step_5",
            "Five",
            r#"{"patchSize": 33, "scaleFactor": 12.0, "seed": "wire", "terrainScale": 2}"#,
        )
    },
    Entry {
        features: VALLEY,
        ..entry(
            "valley_1",
            "A valley injected by a sixteenth of its heights, seed one (B figure 3.18)",
            r#"{"patchSize": 129, "scaleFactor": 24.0, "seed": "one"}"#,
        )
    },
    Entry {
        features: VALLEY,
        ..entry(
            "valley_2",
            "The same valley, seed two",
            r#"{"patchSize": 129, "scaleFactor": 24.0, "seed": "two"}"#,
        )
    },
    Entry {
        features: VALLEY,
        ..entry(
            "valley_3",
            "The same valley, seed three",
            r#"{"patchSize": 129, "scaleFactor": 24.0, "seed": "three"}"#,
        )
    },
    Entry {
        arguments: &["--weights", "additive"],
        ..entry(
            "additive",
            "B's additive zone weights, as they are: overlaps glow, gaps go dark",
            r#"{"patchSize": 257, "scaleFactor": 40.0, "seed": "any text"}"#,
        )
    },
    Entry {
        arguments: &["--despike", "0.6", "--thermal", "120"],
        ..entry(
            "thermal",
            "The first patch after despiking and 120 iterations of thermal erosion",
            r#"{"patchSize": 257, "scaleFactor": 40.0, "seed": "any text"}"#,
        )
    },
    Entry {
        arguments: &["--patches", "2x2"],
        ..entry(
            "blend",
            "B's border mode for comparison: patches by themselves, 32 samples of transition",
            r#"{"patchSize": 129, "scaleFactor": 40.0, "seed": "blend", "border": {"blend": 32}}"#,
        )
    },
];

/// How many entries there are.
pub const COUNT: usize = ENTRIES.len();

/// Draws every entry onto the page.
pub fn draw(page: &mut Page<'_>, size: &str) -> Result<(), Error> {
    for entry in ENTRIES {
        page.progress.set_message(entry.name);
        let pictures = pictures(entry, page.inputs, size, page.context)?;
        write_bytes(&page.staged.path(format!("{}.json", entry.name)), entry.config.as_bytes())?;
        if let Some(view) = &pictures.view {
            save(&page.staged.path(format!("{}.png", entry.name)), view)?;
        }
        save(&page.staged.path(format!("{}_map.png", entry.name)), &pictures.map)?;
        page.figures += &figure(entry, &pictures);
        page.count += 2;
        page.progress.inc(1);
    }
    write_bytes(&page.staged.path("valley.json"), VALLEY.unwrap_or_default().as_bytes())
}

/// Runs the entry's command on files of its own.
fn pictures(entry: &Entry, inputs: &Path, size: &str, context: &Context) -> Result<Pictures, Error> {
    let (config, features) = (inputs.join("config.json"), inputs.join("features.json"));
    write_bytes(&config, entry.config.as_bytes())?;
    let mut words: Vec<_> = vec!["terrain".into(), "--config".into(), config.into_os_string()];
    if let Some(text) = entry.features {
        write_bytes(&features, text.as_bytes())?;
        words.extend(["--features".into(), features.into_os_string()]);
    }
    words.extend(entry.arguments.iter().map(Into::into));
    words.extend(["--size".into(), size.into(), "--out".into(), inputs.as_os_str().to_owned()]);
    let refused = |error: clap::Error| Error::file(entry.name, error);
    let matches = Terrain::augment_args(clap::Command::new("terrain")).try_get_matches_from(words);
    Terrain::from_arg_matches(&matches.map_err(refused)?).map_err(refused)?.pictures(context)
}

fn figure(entry: &Entry, pictures: &Pictures) -> String {
    let mut command = format!("relievo terrain --config {}.json", entry.name);
    if entry.features.is_some() {
        command += " --features valley.json";
    }
    for word in entry.arguments {
        write!(command, " {word}").expect("a string");
    }
    let [generate, render] = pictures.seconds;
    format!(
        "<figure>\n<a href=\"{name}.png\"><img src=\"{name}.png\" alt=\"{title}\"></a>\n\
         <a href=\"{name}_map.png\"><img class=\"map\" src=\"{name}_map.png\" alt=\"the same from above\"></a>\n\
         <figcaption>{title}.<br><code>{config}</code><br><code>{command} --out {name}</code><br>\
         heights {generate:.3} s, pictures {render:.3} s (first use compiles the kernels)</figcaption>\n</figure>\n",
        name = entry.name,
        title = entry.title,
        config = entry.config.replace('"', "&quot;"),
    )
}
