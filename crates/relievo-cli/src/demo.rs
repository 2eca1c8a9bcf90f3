//! `relievo demo`: every picture on one page.

use std::path::{Path, PathBuf};
use std::time::Instant;

use clap::{Args, Parser as _};
use image::RgbaImage;
use relievo::Error;
use relievo_lab::files::{Staged, write_file};
use serde::Deserialize;
use serde_json::value::RawValue;

use crate::output::say;
use crate::progress::bar;
use crate::{Arguments, Command, Context};

/// Draws every kind of picture that relievo can draw, and writes an `index.html` that shows each picture with
/// the command that draws it and its timings.
#[derive(Args)]
pub struct Demo {
    /// The folder to write to.
    #[arg(long, value_name = "DIR")]
    out: PathBuf,
    /// Width and height of each perspective view, in pixels.
    #[arg(long, value_name = "WxH", default_value = "960x600")]
    size: String,
}

/// The sections of the page: a list of [`Section`].
const PAGE: &str = include_str!("demo/page.json");

/// The files of `examples/` that commands of the page name.
const FILES: [(&str, &str); 4] = [
    ("eroded.json", include_str!("demo/eroded.json")),
    ("ruins.json", include_str!("demo/ruins.json")),
    ("terrain.json", include_str!("demo/terrain.json")),
    ("valley.json", include_str!("demo/valley.json")),
];

/// A section of the page: its anchor, its title, and what it shows.
#[derive(Deserialize)]
struct Section<'a> {
    id: &'a str,
    title: &'a str,
    words: &'a str,
    #[serde(borrow)]
    pictures: Vec<Entry<'a>>,
}

/// A picture on the page, and the command that draws it.
#[derive(Deserialize)]
struct Entry<'a> {
    name: &'a str,
    title: &'a str,
    /// Without `relievo` and `--out`; SIZE stands for the size of the views.
    command: &'a str,
    /// The contents of `name`.json, if the command names it.
    #[serde(borrow)]
    config: Option<&'a RawValue>,
}

/// What a command shows on the page.
pub struct Shown {
    /// The picture. Terrain has none without an adapter.
    pub picture: Option<RgbaImage>,
    /// The same from above.
    pub map: Option<RgbaImage>,
    /// What it cost.
    pub note: String,
}

impl Shown {
    /// A picture alone.
    pub fn new(picture: RgbaImage, note: impl Into<String>) -> Self {
        Self { picture: Some(picture), map: None, note: note.into() }
    }
}

impl Demo {
    pub fn run(&self, context: &Context) -> Result<(), Error> {
        let output = |error| Error::output("temporary folder", error);
        let inputs = tempfile::tempdir().map_err(output)?;
        let sections: Vec<Section<'_>> =
            serde_json::from_str(PAGE).map_err(|error| Error::file("page.json", error))?;
        let entries = || sections.iter().flat_map(|section| &section.pictures);
        let own = entries().filter_map(|entry| Some((format!("{}.json", entry.name), entry.config?.get())));
        let files: Vec<_> =
            FILES.map(|(name, text)| (name.to_owned(), text)).into_iter().chain(own).collect();
        let mut staged = Staged::new(&self.out)?;
        for (name, text) in &files {
            write_file(&inputs.path().join(name), text.as_bytes())?;
            staged.write(name, text.as_bytes())?;
        }
        let progress = bar(entries().count() as u64, "drawing");
        let (mut contents, mut figures, mut count) = (String::new(), String::new(), 0);
        for Section { id, title, words, pictures } in &sections {
            contents += &format!("<li><a href=\"#{id}\">{title}</a></li>\n");
            figures += &format!("<h2 id=\"{id}\">{title}</h2>\n<p>{words}</p>\n");
            for entry in pictures {
                progress.set_message(entry.name.to_owned());
                let command = entry.command.replace("SIZE", &self.size);
                let shown = shown(&command, inputs.path(), context)?;
                for (end, picture) in [(".png", &shown.picture), ("_map.png", &shown.map)] {
                    if let Some(picture) = picture {
                        staged.write_png(format!("{}{end}", entry.name), picture)?;
                        count += 1;
                    }
                }
                figures += &figure(entry, &command, &shown, &files);
                progress.inc(1);
            }
        }
        progress.finish_and_clear();
        let adapter = context.gpu()?.adapter().to_string();
        staged.write("index.html", html(&adapter, &contents, &figures).as_bytes())?;
        staged.publish()?;
        say(format_args!("{count} pictures, and {}", self.out.join("index.html").display()))
    }
}

/// Runs a command with the files in `inputs`, without writing what it makes.
fn shown(command: &str, inputs: &Path, context: &Context) -> Result<Shown, Error> {
    let words = command.split(' ').map(|word| match word.ends_with(".json") {
        true => inputs.join(word).into_os_string(),
        false => word.into(),
    });
    let words = ["relievo".into()].into_iter().chain(words).chain(["--out".into(), ".".into()]);
    let start = Instant::now();
    match Arguments::try_parse_from(words).map_err(|error| Error::file("page.json", error))?.command {
        Command::Scene(scene) => scene.shown(context, start),
        Command::Terrain(terrain) => terrain.shown(context),
        Command::Relief(relief) => relief.shown(context, start),
        Command::Skin(skin) => skin.shown(context, start),
        Command::Crowd(crowd) => crowd.shown(context, start),
        _ => Err(Error::file("page.json", format!("`{command}` has no picture"))),
    }
}

fn figure(entry: &Entry<'_>, command: &str, shown: &Shown, files: &[(String, &str)]) -> String {
    let Entry { name, title, .. } = entry;
    let images = match shown.map {
        None => format!("<a class=\"wide\" href=\"{name}.png\"><img src=\"{name}.png\" alt=\"{title}\"></a>"),
        Some(_) => format!(
            "<a href=\"{name}.png\"><img src=\"{name}.png\" alt=\"{title}\"></a>\n\
             <a href=\"{name}_map.png\"><img class=\"map\" src=\"{name}_map.png\" alt=\"the same from above\"></a>"
        ),
    };
    let file = |word: &&str| files.iter().find(|(name, _)| name == word);
    let words: Vec<String> = (command.split(' '))
        .map(|word| file(&word).map_or(word.to_owned(), |_| format!("<a href=\"{word}\">{word}</a>")))
        .collect();
    let config = command.split(' ').skip_while(|word| *word != "--config").nth(1);
    let config = config
        .as_ref()
        .and_then(file)
        .map_or(String::new(), |(_, text)| format!("<code>{}</code><br>", text.replace('"', "&quot;")));
    format!(
        "<figure>\n{images}\n<figcaption>{title}.<br>{config}<code>relievo {} --out {name}</code><br>{}</figcaption>\n</figure>\n",
        words.join(" "),
        shown.note
    )
}

fn html(adapter: &str, contents: &str, figures: &str) -> String {
    format!(
        "<!doctype html>\n<html lang=\"en\">\n<meta charset=\"utf-8\">\n\
         <meta name=\"viewport\" content=\"width=device-width\">\n<title>relievo</title>\n<style>\n\
         body {{ font: 16px/1.5 system-ui, sans-serif; max-width: 76rem; margin: 2rem auto; padding: 0 1rem; \
         color: #1c2733; background: #f6f8fa }}\n\
         figure {{ display: grid; grid-template-columns: 3fr 2fr; gap: .75rem; margin: 0 0 2.5rem }}\n\
         figcaption {{ grid-column: 1 / -1 }}\n\
         img {{ width: 100%; display: block; border-radius: 4px }}\n\
         img.map {{ aspect-ratio: 1; image-rendering: auto }}\n\
         a.wide {{ grid-column: 1 / -1; max-width: 60rem }}\n\
         nav ul {{ display: flex; flex-wrap: wrap; gap: .25rem 1.5rem; padding: 0; list-style: none }}\n\
         h2 {{ margin: 3rem 0 .5rem }}\n\
         code {{ font-size: .85em; background: #e7ecf0; padding: .1em .3em; border-radius: 3px }}\n\
         </style>\n<h1>relievo {version}</h1>\n\
         <p>Made on {adapter}. The heights are the same bits on every device: the same commands with \
         <code>--backend cpu</code> give the same heights, bit for bit.</p>\n\
         <p>The scenes move in the viewer, with every control of level of detail: <code>relievo view ruins.json</code>, or \
         <code>make serve</code> and then <a href=\"http://localhost:8080/?scene=scenes/ruins.json\">this page</a>.</p>\n<nav><ul>\n{contents}</ul></nav>\n{figures}</html>\n",
        version = env!("CARGO_PKG_VERSION"),
    )
}
