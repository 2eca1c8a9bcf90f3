//! The options by which commands that show one model reduce its bones first.

use clap::Args;
use relievo::asset::Model;
use relievo::ops::skinning::collapse::{CollapseOptions, KeptBones, collapse_bones};
use relievo::{Error, InputError};

use crate::output::say;
use crate::progress::during;

/// Which bones are collapsed before the command runs.
#[derive(Args)]
pub struct CollapseArgs {
    /// Collapses bones into the bones above them until N bones, or this percentage of all bones, are left.
    /// The bones whose collapse moves vertices least in the model's clips go first. Prints the number of
    /// bones that are left and how far the vertices are off. Roots, the uppermost bones that a clip moves,
    /// and bones without children are kept. Clips may last an hour at most.
    #[arg(long, value_name = "N|N%", allow_hyphen_values = true, value_parser = kept_bones)]
    bones: Option<KeptBones>,
    /// The name of a bone to keep; may be given several times.
    #[arg(long, value_name = "NAME", requires = "bones")]
    keep_bone: Vec<String>,
    /// Allows bones without children to collapse too.
    #[arg(long, requires = "bones")]
    collapse_end_effectors: bool,
}

impl CollapseArgs {
    /// Collapses the model's bones as the arguments ask; without `--bones`, returns the model as it is.
    pub fn apply(&self, model: Model) -> Result<Model, Error> {
        let Some(bones) = self.bones else { return Ok(model) };
        let options = CollapseOptions {
            bones,
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
    let refused = |bound: &str| InputError::new("bones", text, bound);
    let odd = || refused("must be a number of bones, or a part of all such as 25%");
    let Some(percent) = text.strip_suffix('%') else {
        return text.parse().map(KeptBones::Count).map_err(|_| odd());
    };
    let percent: f32 = percent.trim().parse().map_err(|_| odd())?;
    if percent > 0.0 && percent <= 100.0 {
        return Ok(KeptBones::Fraction(percent / 100.0));
    }
    Err(refused("must be above 0% and at most 100%"))
}
