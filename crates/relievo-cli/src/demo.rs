//! `relievo demo`: every picture on one page.

mod crowd;
mod relief;
mod scene;
mod skin;
mod terrain;

use std::ffi::OsStr;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use clap::{Args, FromArgMatches};
use image::RgbaImage;
use indicatif::ProgressBar;
use relievo::Error;
use relievo_lab::files::Staged;

use crate::Context;
use crate::output::say;
use crate::progress::bar;

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

/// A section of the page: its anchor, its title, and what it shows.
struct Section(&'static str, &'static str, &'static str);

const SCENE: Section = Section(
    "scene",
    "A scene",
    "Everything below in one picture, with one number of pixels for the whole of it.",
);
const TERRAIN: Section = Section(
    "terrain",
    "Terrain",
    "Heights that are the same bits on every device, computed patch by patch from a few parameters. On the right the same \
     ground from above.",
);
const SURFACE: Section = Section(
    "surface",
    "Surface mapping",
    "A flat square that shows a height map: each pixel's ray is followed to where it meets the heights, by one of several \
     methods, and the error of each is measured.",
);
const SKINNING: Section = Section(
    "skinning",
    "Skinning",
    "Vertices that follow bones, with fewer influences and triangles where that does not show.",
);
const ANIMATION: Section = Section(
    "animation",
    "Animation level of detail",
    "Crowds in which a bone is only interpolated where its motion would show.",
);

/// The page that is being written.
struct Page<'a> {
    context: &'a Context,
    staged: Staged,
    /// The folder for the files that the commands write themselves.
    inputs: &'a Path,
    progress: ProgressBar,
    /// The list of contents, and what follows it.
    contents: String,
    figures: String,
    /// Number of pictures so far.
    count: usize,
}

impl Demo {
    pub fn run(&self, context: &Context) -> Result<ExitCode, Error> {
        let inputs = tempfile::tempdir().map_err(|error| Error::output("temporary folder", error))?;
        let mut page = Page {
            context,
            staged: Staged::new(&self.out)?,
            inputs: inputs.path(),
            progress: bar(
                (scene::COUNT + terrain::COUNT + relief::COUNT + skin::COUNT + crowd::COUNT) as u64,
                "drawing",
            ),
            contents: String::new(),
            figures: String::new(),
            count: 0,
        };
        let size = &self.size;
        for (section, draw) in [
            (SCENE, &scene::draw as &dyn Fn(&mut Page<'_>, &str) -> Result<(), Error>),
            (TERRAIN, &terrain::draw),
            (SURFACE, &relief::draw),
            (SKINNING, &|page, _| skin::draw(page)),
            (ANIMATION, &|page, _| crowd::draw(page)),
        ] {
            page.begin(&section);
            draw(&mut page, size)?;
        }
        page.progress.finish_and_clear();
        let adapter = context.gpu()?.adapter().to_string();
        page.staged.write("index.html", html(&adapter, &page.contents, &page.figures).as_bytes())?;
        page.staged.publish()?;
        say(format_args!("{} pictures, and {}", page.count, self.out.join("index.html").display()))?;
        Ok(ExitCode::SUCCESS)
    }
}

/// A picture on the page, and the command that draws it.
struct Entry {
    name: &'static str,
    title: &'static str,
    /// The arguments, separated by spaces.
    arguments: &'static str,
}

const fn entry(name: &'static str, title: &'static str, arguments: &'static str) -> Entry {
    Entry { name, title, arguments }
}

impl Entry {
    /// Parses the command that draws the picture, with the arguments in `more`.
    fn command<T: Args + FromArgMatches>(&self, name: &'static str, more: &[&OsStr]) -> Result<T, Error> {
        let words = ["--out", "."].iter().copied().chain(self.arguments.split_whitespace()).map(OsStr::new);
        let refused = |error: clap::Error| Error::file(self.name, error);
        let command = T::augment_args(clap::Command::new(name).no_binary_name(true));
        let matches = command.try_get_matches_from(words.chain(more.iter().copied()));
        T::from_arg_matches(&matches.map_err(refused)?).map_err(refused)
    }
}

impl Page<'_> {
    /// Begins a section.
    fn begin(&mut self, Section(id, title, words): &Section) {
        self.contents += &format!("<li><a href=\"#{id}\">{title}</a></li>\n");
        self.figures += &format!("<h2 id=\"{id}\">{title}</h2>\n<p>{words}</p>\n");
    }

    /// Draws the pictures of a command; `draw` returns each picture with a note.
    fn draw<T: Args + FromArgMatches>(
        &mut self,
        command: &'static str,
        entries: &[Entry],
        more: &[&OsStr],
        draw: impl Fn(&T, &Context) -> Result<(RgbaImage, String), Error>,
    ) -> Result<(), Error> {
        for entry in entries {
            let Entry { name, title, arguments } = entry;
            self.progress.set_message(*name);
            let (picture, note) = draw(&entry.command(command, more)?, self.context)?;
            let shown: String = more.iter().map(|word| format!(" {}", word.to_string_lossy())).collect();
            self.staged.write_png(format!("{name}.png"), &picture)?;
            self.figures += &format!(
                "<figure>\n<a class=\"wide\" href=\"{name}.png\"><img src=\"{name}.png\" alt=\"{title}\"></a>\n\
                 <figcaption>{title}.<br><code>relievo {command} {arguments}{shown} --out {name}</code><br>{note}</figcaption>\n\
                 </figure>\n"
            );
            self.count += 1;
            self.progress.inc(1);
        }
        Ok(())
    }
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
         <code>--backend cpu</code> give the same heights, bit for bit.</p>\n<nav><ul>\n{contents}</ul></nav>\n{figures}</html>\n",
        version = env!("CARGO_PKG_VERSION"),
    )
}
