//! Plain data, independent of any device: models with skeletons, skins, clips, meshes and materials, and the import of files.

mod beside;
pub mod clip;
pub(crate) mod fingerprint;
pub mod gltf;
pub(crate) mod image_file;
pub(crate) mod images;
mod import;
#[doc(hidden)]
pub mod indices;
pub mod influences;
pub mod keyframe;
pub mod light;
pub mod material;
pub mod mesh;
pub mod model;
pub mod morph;
pub(crate) mod motion_bounds;
pub mod obj;
pub mod package;
pub mod skeleton;
#[doc(hidden)]
pub mod tangents;
pub mod transform;

pub use clip::{BoneKeys, Clip, Interpolation, Keys, Track};
pub use image_file::{Image, decode_image, encode_png, open_image};
pub use import::ENDINGS;
pub use import::ModelFile;
pub use influences::{Influence, Influences};
pub use keyframe::KeyframeCursor;
pub use light::Light;
pub use material::Material;
pub use mesh::{Mesh, MeshLevel, bone_radii};
pub use model::Model;
pub use morph::{MorphTarget, WeightKeys};
pub use motion_bounds::MotionBounds;
pub use skeleton::{Bone, Skeleton, Skin};
pub use transform::{Affine, Transform};
