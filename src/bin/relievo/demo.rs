//! `relievo demo`

use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use clap::{Args, FromArgMatches};
use relievo::Error;
use relievo::terrain::export::write_bytes;

use crate::Context;
use crate::output::{Staged, say};
use crate::progress::bar;
use crate::terrain::{Pictures, Terrain, save};

/// Makes every picture that relievo can make so far, and an `index.html` that shows them with the commands that
/// made them and their timings.
#[derive(Args)]
pub struct Demo {
    /// The folder.
    #[arg(long, value_name = "DIR")]
    out: PathBuf,
    /// Pixels of each perspective view.
    #[arg(long, value_name = "WxH", default_value = "960x600")]
    size: String,
}

/// One picture: its configuration, what it injects, and the rest of its command.
struct Entry {
    name: &'static str,
    title: &'static str,
    config: &'static str,
    features: Option<&'static str>,
    arguments: &'static [&'static str],
}

const VALLEY: Option<&str> = Some(include_str!("../../../examples/valley.json"));

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

impl Demo {
    pub fn run(&self, context: &Context) -> Result<ExitCode, Error> {
        let mut staged = Staged::new(&self.out)?;
        let inputs = tempfile::tempdir().map_err(|error| Error::output("temporary folder", error))?;
        let progress = bar(ENTRIES.len() as u64, "drawing");
        let mut figures = String::new();
        for entry in ENTRIES {
            progress.set_message(entry.name);
            let pictures = self.pictures(entry, inputs.path(), context)?;
            write_bytes(&staged.path(format!("{}.json", entry.name)), entry.config.as_bytes())?;
            if let Some(view) = &pictures.view {
                save(&staged.path(format!("{}.png", entry.name)), view)?;
            }
            save(&staged.path(format!("{}_map.png", entry.name)), &pictures.map)?;
            figures += &figure(entry, &pictures);
            progress.inc(1);
        }
        progress.finish_and_clear();
        write_bytes(&staged.path("valley.json"), VALLEY.unwrap_or_default().as_bytes())?;
        let adapter = context.gpu()?.adapter().to_string();
        write_bytes(&staged.path("index.html"), page(&adapter, &figures).as_bytes())?;
        staged.publish()?;
        say(format_args!("{} pictures, and {}", 2 * ENTRIES.len(), self.out.join("index.html").display()))?;
        Ok(ExitCode::SUCCESS)
    }

    /// Runs the entry's command on files of its own.
    fn pictures(&self, entry: &Entry, inputs: &Path, context: &Context) -> Result<Pictures, Error> {
        let (config, features) = (inputs.join("config.json"), inputs.join("features.json"));
        write_bytes(&config, entry.config.as_bytes())?;
        let mut words: Vec<_> = vec!["terrain".into(), "--config".into(), config.into_os_string()];
        if let Some(text) = entry.features {
            write_bytes(&features, text.as_bytes())?;
            words.extend(["--features".into(), features.into_os_string()]);
        }
        words.extend(entry.arguments.iter().map(Into::into));
        words.extend([
            "--size".into(),
            self.size.as_str().into(),
            "--out".into(),
            inputs.as_os_str().to_owned(),
        ]);
        let refused = |error: clap::Error| Error::file(entry.name, error);
        let matches = Terrain::augment_args(clap::Command::new("terrain")).try_get_matches_from(words);
        Terrain::from_arg_matches(&matches.map_err(refused)?).map_err(refused)?.pictures(context)
    }
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

fn page(adapter: &str, figures: &str) -> String {
    format!(
        "<!doctype html>\n<html lang=\"en\">\n<meta charset=\"utf-8\">\n\
         <meta name=\"viewport\" content=\"width=device-width\">\n<title>relievo</title>\n<style>\n\
         body {{ font: 16px/1.5 system-ui, sans-serif; max-width: 76rem; margin: 2rem auto; padding: 0 1rem; \
         color: #1c2733; background: #f6f8fa }}\n\
         figure {{ display: grid; grid-template-columns: 3fr 2fr; gap: .75rem; margin: 0 0 2.5rem }}\n\
         figcaption {{ grid-column: 1 / -1 }}\n\
         img {{ width: 100%; display: block; border-radius: 4px }}\n\
         img.map {{ aspect-ratio: 1; image-rendering: auto }}\n\
         code {{ font-size: .85em; background: #e7ecf0; padding: .1em .3em; border-radius: 3px }}\n\
         </style>\n<h1>relievo {version}</h1>\n\
         <p>Made on {adapter}. The heights are the same bits on every device: the same commands with \
         <code>--backend cpu</code> give the same hashes.</p>\n{figures}</html>\n",
        version = env!("CARGO_PKG_VERSION"),
    )
}
