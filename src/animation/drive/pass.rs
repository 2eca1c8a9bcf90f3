//! The GPU pass of `kernels/animation/drive.wgsl`.

use super::DrivenWord;
use crate::animation::active::Active;
use crate::animation::crowd::Crowd;
use crate::animation::gate_state::GateState;
use crate::gpu::bindings::animation::drive as bindings;
use crate::gpu::{Buffer, Gpu, Job, Uniform, pass};
use crate::shared::animation::drive::DriveParams;
use crate::{Error, InputError};

pass! {
    /// Adds driven bones to the bones that a gate chose, on the GPU.
    pub struct DrivePass;
}

impl DrivePass {
    /// Prepares a job that adds driven bones to a crowd's bits. Record the job after the gate and before the compaction into
    /// lists ([`CompactPass`](crate::animation::compact::CompactPass)).
    ///
    /// # Errors
    /// [`InputError`] if the index of a word is beyond the crowd's bits; [`crate::gpu::GpuError`] for errors of the device.
    pub fn prepare(
        &self,
        gpu: &Gpu,
        driven: &[DrivenWord],
        crowd: &Crowd,
        state: &GateState,
        active: &Active,
    ) -> Result<Job, Error> {
        let all = crowd.len() * active.words as usize;
        if let Some(at) = driven.iter().position(|word| word.at as usize >= all) {
            let bound = format!("must be below {all}");
            return Err(InputError::new(format!("driven[{at}].at"), driven[at].at, bound).into());
        }
        let (count, instances) = (driven.len() as u32, crowd.len() as u32);
        let params = DriveParams { driven: count, instances, words: active.words };
        let params = Uniform::new(gpu, "drive", &params)?;
        let driven = Buffer::from_slice(gpu, "driven bones", driven)?;
        let group = bindings::Group {
            params: &params,
            driven: driven.slice(),
            lods: state.lods.slice(),
            bits: active.bits.slice(),
        };
        let group = group.bind(gpu, &self.kernel)?;
        Ok(Job::spread(gpu, "animation/drive", &self.kernel, group, count)?)
    }
}
