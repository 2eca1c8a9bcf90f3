// Animation: what the kernels' buffers hold (`AnimationInstance`, `ClipEntry`, `Lod`, `ClipClock`), where in its clip a time
// falls, rotations between keys, and how far bones have moved. `build.rs` joins this file and what it imports, for
// shaders that are not composed with WESL: put it before your own code.
import package::wgsl::animation::instance::AnimationInstance;
import package::wgsl::animation::clip::ClipEntry;
import package::wgsl::animation::clock::{WRAP_CLAMP, inside_clip};
import package::wgsl::animation::rotation::{slerp, unit_quaternion};
import package::wgsl::animation::gate_state::{LOD_HIDDEN, LOD_REFRESH, Lod, OMEGA_ONE, ClipClock, fraction_of, is_ahead, update_reason_of};
import package::wgsl::animation::motion::{motion_at, motion_between, scale_by_fraction};
import package::wgsl::dispatch::rows_of_workgroups;
