//! `relievo priorities`: the priority of each key of a clip.

use std::collections::BTreeMap;
use std::path::PathBuf;

use clap::Args;
use relievo::asset::{Clip, Skeleton};
use relievo::ops::animation::priority::{KeyPriority, TERMS, USER_DEFAULT, Weights};
use relievo::ops::animation::{Wrap, priority};
use relievo::{Error, InputError};
use relievo_lab::files::write_json;
use serde::Serialize;

use crate::arguments::{ModelArgs, one_of};
use crate::output::say;
use crate::pose::WRAPS;

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
    #[command(flatten)]
    model: ModelArgs,
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

/// A number for each of [`TERMS`].
type Terms<T> = BTreeMap<&'static str, T>;

fn terms<T>(numbers: [T; 6]) -> Terms<T> {
    TERMS.into_iter().zip(numbers).collect()
}

impl Priorities {
    pub fn run(&self) -> Result<(), Error> {
        let model = self.model.open_bare()?;
        let clip = &model.clips[self.model.clip(&model, &self.clip)?];
        let weights = weights(self.weights.as_deref(), &model.skeleton, clip, self.wrap)?;
        let user = vec![USER_DEFAULT; model.skeleton.len()];
        let mut keys = priority::Priorities::new(&model.skeleton, clip, self.wrap, &weights, &user)?.keys;
        // The sort is stable: equal priorities stay in the order of bones and keys.
        keys.sort_by(|a, b| b.priority.total_cmp(&a.priority));
        let row = |own: KeyPriority| {
            let KeyPriority { bone, key, time, priority, .. } = own;
            let name = model.skeleton.bones()[bone as usize].name.as_str();
            Row { bone, name, key, time, terms: terms(own.terms), priority }
        };
        let keys: Vec<Row<'_>> = keys.into_iter().map(row).collect();
        let shown: Vec<_> = TERMS.iter().zip(weights.0).map(|(term, w)| format!("{term} {w:.4}")).collect();
        let table = table(&keys);
        if let Some(path) = &self.json {
            write_json(
                path,
                &Report {
                    clip: clip.name(),
                    loops: self.wrap == Wrap::Loop,
                    weights: terms(weights.0),
                    keys,
                },
            )?;
        }
        say(format_args!("weights: {}\n{table}", shown.join(", ")))
    }
}

/// The weights that `--weights` asks for.
pub fn weights(
    text: Option<&str>,
    skeleton: &Skeleton,
    clip: &Clip,
    wrap: Wrap,
) -> Result<Weights, InputError> {
    match text {
        None => Ok(Weights::default()),
        Some("analyze") => Weights::analyze(skeleton, clip, wrap),
        Some(text) => six(text),
    }
}

fn six(text: &str) -> Result<Weights, InputError> {
    let numbers: Option<Vec<f64>> = text.split(',').map(|word| word.trim().parse().ok()).collect();
    let numbers = numbers.and_then(|numbers| <[f64; 6]>::try_from(numbers).ok());
    let bound = "must be `analyze` or six numbers, such as 0.2,0.3,0.1,0.2,0.1,0.1";
    let weights = Weights(numbers.ok_or_else(|| InputError::new("weights", text, bound))?);
    weights.validate()?;
    Ok(weights)
}

fn table(keys: &[Row<'_>]) -> String {
    let width = keys.iter().map(|key| key.name.chars().count()).max().unwrap_or(0).max(4);
    let mut text = format!("{:>8}  {:<width$}  {:>4}  {:>8}", "priority", "bone", "key", "seconds");
    TERMS.iter().for_each(|term| text += &format!("  {term:>11}"));
    for Row { name, key, time, terms, priority, .. } in keys {
        text += &format!("\n{priority:>8.5}  {name:<width$}  {key:>4}  {time:>8.4}");
        TERMS.iter().for_each(|term| text += &format!("  {:>11.5}", terms[term]));
    }
    text
}
