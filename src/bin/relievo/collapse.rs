//! Fewer bones, for commands that show one model.

use clap::Args;
use relievo::asset::Model;
use relievo::skinning::collapse::{CollapseOptions, KeptBones, collapse_bones};
use relievo::{Error, InputError};

use crate::output::say;
use crate::progress::during;

/// Which bones are left.
#[derive(Args)]
pub struct CollapseArgs {
    /// Collapses bones into those above them until N, or this part of all, are left, those first that are seen least in
    /// the model's clips; says how many are left, and how far vertices are off. Roots, the uppermost bones that clips
    /// move, and bones without children stay. Clips last an hour at most.
    #[arg(long, value_name = "N|N%", allow_hyphen_values = true)]
    bones: Option<String>,
    /// A bone that stays, by name. May be given more than once.
    #[arg(long, value_name = "NAME", requires = "bones")]
    keep_bone: Vec<String>,
    /// Bones without children may collapse too.
    #[arg(long, requires = "bones")]
    collapse_end_effectors: bool,
}

impl CollapseArgs {
    /// The model with the bones that are asked for.
    pub fn apply(&self, model: Model) -> Result<Model, Error> {
        let Some(bones) = &self.bones else { return Ok(model) };
        let options = CollapseOptions {
            bones: kept_bones(bones)?,
            keep: self.keep_bone.clone(),
            keep_end_effectors: !self.collapse_end_effectors,
        };
        let collapsed = during("collapsing", || collapse_bones(&model, &options))?;
        let [left, all] = [&collapsed.model, &model].map(|model| model.skeleton.len());
        let error = collapsed.error;
        say(format_args!(
            "{left} of {all} bones; vertices are {} off at most, {} rms, in the model's units",
            error.largest, error.rms
        ))?;
        Ok(collapsed.model)
    }
}

fn kept_bones(text: &str) -> Result<KeptBones, InputError> {
    let refused =
        || InputError::new("bones", text, "must be a number of bones, or a part of all such as 25%");
    match text.strip_suffix('%') {
        Some(percent) => {
            let percent: f32 = percent.trim().parse().map_err(|_| refused())?;
            Ok(KeptBones::Fraction(percent / 100.0))
        }
        None => Ok(KeptBones::Count(text.parse().map_err(|_| refused())?)),
    }
}
