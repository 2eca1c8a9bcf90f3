//! `relievo priorities`: the priority of each key of a clip.

use std::path::PathBuf;
use std::process::ExitCode;

use clap::Args;
use relievo::animation::priority::{KeyPriority, TERMS, USER_DEFAULT, Weights};
use relievo::animation::{Wrap, priority};
use relievo::asset::{Clip, Model, Skeleton};
use relievo::{Error, InputError};
use relievo_lab::files::write_json;
use serde::Serialize;

use crate::arguments::one_of;
use crate::output::say;
use crate::pose::{WRAPS, find, open_bare};

/// Prints how much each key of each bone contributes to a clip, most important first. Animation level of detail skips
/// keys of high priority last.
///
/// A key has six terms from 0 to 1: how far its bone moves, turns and scales until the next key, each as a share of the
/// clip's largest; how many bones lie below it; how near it is to the root; and the user's own term, one half for all
/// bones. The priority is the weighted mean of these terms.
///
/// relievo priorities --model builtin --clip walk --weights analyze
#[derive(Args)]
pub struct Priorities {
    /// A .glb, .gltf or .obj file, or `builtin`: a creature of 153 bones with the clips walk, idle and wave.
    #[arg(long, value_name = "FILE|builtin")]
    model: PathBuf,
    /// The clip: its name, or its number, counted from 0.
    #[arg(long, value_name = "NAME|INDEX")]
    clip: String,
    /// Weights of translation, rotation, scale, children, depth and user, which sum to 1; or `analyze`, which
    /// derives them from the error that freezing bones causes. Default: one sixth each.
    #[arg(long, value_name = "W,W,W,W,W,W|analyze", allow_hyphen_values = true)]
    weights: Option<String>,
    /// What follows a bone's last key: its first key (loop), or nothing (clamp).
    #[arg(long, value_name = "MODE", default_value = "loop", value_parser = one_of(WRAPS))]
    wrap: Wrap,
    /// Also writes the table to this file, as JSON.
    #[arg(long, value_name = "FILE")]
    json: Option<PathBuf>,
}

#[derive(Serialize)]
struct Report<'a> {
    clip: &'a str,
    loops: bool,
    weights: Terms<f64>,
    keys: Vec<Row<'a>>,
}

#[derive(Serialize)]
struct Row<'a> {
    bone: u32,
    name: &'a str,
    key: u32,
    time: f32,
    terms: Terms<f32>,
    priority: f32,
}

#[derive(Serialize)]
struct Terms<T> {
    translation: T,
    rotation: T,
    scale: T,
    children: T,
    depth: T,
    user: T,
}

impl<T> From<[T; 6]> for Terms<T> {
    fn from([translation, rotation, scale, children, depth, user]: [T; 6]) -> Self {
        Self { translation, rotation, scale, children, depth, user }
    }
}

impl Priorities {
    pub fn run(&self) -> Result<ExitCode, Error> {
        let model = open_bare(&self.model)?;
        let clip = find(&model, &self.model, &self.clip)?;
        let loops = self.wrap == Wrap::Loop;
        let weights = weights(self.weights.as_deref(), &model.skeleton, clip, loops)?;
        let user = vec![USER_DEFAULT; model.skeleton.len()];
        let found = priority::Priorities::new(&model.skeleton, clip, loops, &weights, &user)?;
        let mut keys = found.keys;
        // The sort is stable: equal priorities stay in the order of bones and keys.
        keys.sort_by(|a, b| b.priority.total_cmp(&a.priority));
        if let Some(path) = &self.json {
            let rows = keys.iter().map(|key| row(&model, key)).collect();
            let report = Report { clip: clip.name(), loops, weights: weights.0.into(), keys: rows };
            write_json(path, &report)?;
        }
        let shown: Vec<_> = TERMS.iter().zip(weights.0).map(|(term, w)| format!("{term} {w:.4}")).collect();
        say(format_args!("weights: {}", shown.join(", ")))?;
        say(table(&model, &keys))?;
        Ok(ExitCode::SUCCESS)
    }
}

/// The weights that `--weights` asks for.
pub fn weights(
    text: Option<&str>,
    skeleton: &Skeleton,
    clip: &Clip,
    loops: bool,
) -> Result<Weights, InputError> {
    match text {
        None => Ok(Weights::default()),
        Some("analyze") => Weights::analyze(skeleton, clip, loops),
        Some(text) => six(text),
    }
}

fn six(text: &str) -> Result<Weights, InputError> {
    let bound = "must be `analyze` or six numbers, such as 0.2,0.3,0.1,0.2,0.1,0.1";
    let numbers = text.split(',').map(|word| word.trim().parse());
    let numbers =
        numbers.collect::<Result<Vec<f64>, _>>().map_err(|_| InputError::new("weights", text, bound))?;
    let numbers: [f64; 6] = numbers.try_into().map_err(|_| InputError::new("weights", text, bound))?;
    Weights(numbers).validate()?;
    Ok(Weights(numbers))
}

fn row<'a>(model: &'a Model, key: &KeyPriority) -> Row<'a> {
    let name = &model.skeleton.bones()[key.bone as usize].name;
    let KeyPriority { bone, key, time, terms, priority } = *key;
    Row { bone, name, key, time, terms: terms.into(), priority }
}

fn table(model: &Model, keys: &[KeyPriority]) -> String {
    let name = |key: &KeyPriority| model.skeleton.bones()[key.bone as usize].name.as_str();
    let width = keys.iter().map(|key| name(key).chars().count()).max().unwrap_or(0).max(4);
    let mut text = format!("{:>8}  {:<width$}  {:>4}  {:>8}", "priority", "bone", "key", "seconds");
    TERMS.iter().for_each(|term| text += &format!("  {term:>11}"));
    for key in keys {
        text += &format!("\n{:>8.5}  {:<width$}  {:>4}  {:>8.4}", key.priority, name(key), key.key, key.time);
        key.terms.iter().for_each(|term| text += &format!("  {term:>11.5}"));
    }
    text
}
