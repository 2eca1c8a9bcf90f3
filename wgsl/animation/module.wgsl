// Animation: the types in the kernels' buffers (`AnimationInstance`, `ClipEntry`, `SetTrack`, `KeyframeCursor`, `Slot`, `Lod`,
// `ClipClock`), times inside clips, rotations between keys, and the motion of bones. `build.rs` joins this file and its imports
// into one text, for shaders that are not composed with WESL. Prepend that text to your own code.
import package::wgsl::animation::instance::AnimationInstance;
import package::wgsl::animation::clip::{CONSTANT, ClipEntry, KeyframeCursor, SetTrack, Timeline, cursor_of_words, first_value_of, interpolation_of, timeline_of};
import package::wgsl::animation::clock::{WRAP_CLAMP, inside_clip};
import package::wgsl::animation::interpolation::{INTERPOLATION_LINEAR, INTERPOLATION_SPLINE, INTERPOLATION_STEP};
import package::wgsl::animation::order::{CONTINUES, Chain, NO_PARENT, Slot};
import package::wgsl::animation::rotation::{slerp, unit_quaternion};
import package::wgsl::animation::gate_state::{FRACTION_ONE, FULL_WEIGHT, LOD_FORCED, LOD_HIDDEN, Lod, OMEGA_ONE, ClipClock, fraction_of, is_ahead, update_reason_of};
import package::wgsl::animation::motion::{motion_at, motion_between, scale_by_fraction};
import package::wgsl::dispatch::rows_of_workgroups;
