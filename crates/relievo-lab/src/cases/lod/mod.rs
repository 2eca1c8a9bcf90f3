//! Helpers of the parity and benchmark cases of `kernels/lod/`: scenes of random instances.

pub mod assign;
pub mod attach;
pub mod budget;
pub mod decide;
pub mod list;
pub mod select;
pub mod sorted;

use glam::{IVec3, Mat4, Quat, Vec3};
use relievo::InputError;
use relievo::ops::lod::decide::reference::counts;
use relievo::ops::lod::{
    BLOCK, Depth, INSTANCE_ALIVE, INSTANCE_CASTS, LodCamera, LodObject, NO_OBJECT, OBJECT_LEVELS,
    OBJECT_LISTS, SceneInstance, SelectView, VIEW_CAMERAS, instance_flags_word, planes,
};
use relievo::shared::lod::criterion::CRITERION_MAGNIFICATION;
use relievo::shared::lod::object::{FADE_PROGRESS, NO_RANK, object_flags_word};
use relievo::shared::lod::transition::{TRANSITION_ALPHA, TRANSITION_DITHER, TRANSITION_GEOMORPH};

use crate::cases::animation::Draw;

/// The cell of random views, around which random instances lie.
pub(crate) const CELL: IVec3 = IVec3::new(5, 0, -2_000_000);

/// The eye of random views, in their cell.
pub(crate) const EYE: Vec3 = Vec3::new(120.0, 25.0, 200.0);

/// The numbers of blocks of objects in scenes.
pub(crate) const SIZES: [&[u32]; 4] = [&[1], &[1, 2], &[3, 0, 1, 5], &[17, 1, 16, 40]];

/// Objects, and the blocks of instances that they take.
pub(crate) struct Blocks {
    /// The objects.
    pub(crate) objects: Vec<LodObject>,
    /// The object of each block.
    pub(crate) block_objects: Vec<u32>,
}

impl Blocks {
    /// Objects with so many blocks each, behind each other in another order, with a block of no object before each.
    pub(crate) fn new(case: u32, sizes: &[u32]) -> Self {
        let mut draw = Draw::new(case ^ 0xb10c);
        let mut objects = vec![LodObject::NONE; sizes.len()];
        let mut block_objects = Vec::new();
        let (mut first_list, mut first_draw) = (3, 2);
        for (index, blocks) in sizes.iter().enumerate().rev() {
            block_objects.push(NO_OBJECT);
            let kind = index as u32 + case;
            let transition = kind % (TRANSITION_ALPHA + 1);
            let is_timed = u32::from(case % 2 == 1 && transition >= TRANSITION_DITHER);
            let flags = object_flags_word(
                u32::from(index != 2),
                u32::from(kind % 3 == 2),
                is_timed,
                transition,
                (kind + case) % (CRITERION_MAGNIFICATION + 1),
            );
            let threshold = |level: usize| match level {
                0 if transition != TRANSITION_GEOMORPH => 0.0,
                level => 2e-3 * (1 << level) as f32,
            };
            let object = LodObject {
                first: BLOCK * block_objects.len() as u32,
                instances: BLOCK * blocks,
                levels: 1 + draw.word() % OBJECT_LEVELS,
                first_list,
                first_draw,
                parts: draw.word() % 4,
                metric_scale: 0.5,
                flags,
                thresholds: std::array::from_fn(|four| {
                    std::array::from_fn(|lane| threshold(4 * four + lane))
                }),
                finer: 0.9,
                coarser: 1.1,
                rate: if is_timed == 1 { FADE_PROGRESS as f32 / 0.3 } else { 0.0 },
                motion: if kind % 2 == 1 { 0.3 } else { 0.0 },
                point: [0.3, -0.2, 0.1],
                periphery: if kind % 4 == 3 { 0.5 } else { 0.0 },
                half_size: [0.7, 0.2, 0.4],
                rank: kind % (NO_RANK + 1),
                fade_begin: 0.01,
                fade_end: 0.2,
                ..LodObject::NONE
            };
            block_objects.extend((0..*blocks).map(|_| index as u32));
            first_list += object.list_words() + 5;
            first_draw += OBJECT_LISTS * object.parts + 1;
            objects[index] = object;
        }
        Self { objects, block_objects }
    }

    /// The number of words of all lists.
    pub(crate) fn list_words(&self) -> usize {
        let ends = self.objects.iter().map(|object| object.first_list + object.list_words());
        ends.max().unwrap_or(0) as usize
    }

    /// The number of all draws.
    pub(crate) fn draws(&self) -> usize {
        let ends = self.objects.iter().map(|object| object.draw(object.parts, 0));
        ends.max().unwrap_or(0) as usize
    }

    /// Instance counts per block and list of these decisions; those of blocks without an object are 0.
    pub(crate) fn counts(&self, decisions: &[u32]) -> Vec<u32> {
        counts(decisions, |block| self.object_of(block * BLOCK as usize))
    }

    /// The object of an instance.
    pub(crate) fn object_of(&self, instance: usize) -> Option<&LodObject> {
        let owner = self.block_objects[instance / BLOCK as usize];
        (owner != NO_OBJECT).then(|| &self.objects[owner as usize])
    }
}

/// Instances around the cell of random views: of every size, turned, half of them mirrored; some do not exist, and some
/// cast no shadows.
pub(crate) fn random_instances(case: u32, count: usize) -> Vec<SceneInstance> {
    let mut draw = Draw::new(case ^ 0x1257);
    let random = |draw: &mut Draw| {
        let factor = |draw: &mut Draw| {
            let sign = if draw.word().is_multiple_of(4) { -1.0 } else { 1.0 };
            sign * libm::exp2f(2.0 * draw.signed())
        };
        let sphere = [0.0; 3].map(|_: f32| draw.signed());
        let [x, y, z] = sphere;
        let seldom = |draw: &mut Draw, flag| if draw.word().is_multiple_of(8) { 0 } else { flag };
        let flags = seldom(draw, INSTANCE_ALIVE) | seldom(draw, INSTANCE_CASTS);
        let near = IVec3::new((draw.word() % 3) as i32 - 1, 0, (draw.word() % 3) as i32 - 1);
        SceneInstance {
            cell: (CELL + near).to_array(),
            flags: instance_flags_word(flags, draw.word() & 0xffff),
            offset: [256.0, 40.0, 256.0].map(|size| size * draw.signed().abs()),
            rotation: Quat::from_array(draw.rotation()).normalize().to_array(),
            scale: [0; 3].map(|_| factor(draw)),
            ..SceneInstance::new([x, y, z, 0.1 + draw.signed().abs()])
        }
    };
    (0..count).map(|_| random(&mut draw)).collect()
}

/// A perspective to depth 0 to 1, infinite with reversed depth or finite with forward depth, off its axis by `off`.
pub fn perspective(half_field: f32, aspect: f32, near: f32, reversed: bool, off: f32) -> Mat4 {
    let focal = 1.0 / libm::tanf(half_field);
    let far = 400.0;
    let [a, b] = if reversed { [0.0, near] } else { [far / (near - far), near * far / (near - far)] };
    Mat4::from_cols_array_2d(&[
        [focal / aspect, 0.0, 0.0, 0.0],
        [0.0, focal, 0.0, 0.0],
        [off, -off, a, -1.0],
        [0.0, 0.0, b, 0.0],
    ])
}

/// A parallel projection of a box that reaches `across` to each side and `far` ahead.
pub fn parallel(across: f32, far: f32) -> Mat4 {
    Mat4::from_scale(Vec3::new(1.0 / across, 1.0 / across, -1.0 / far))
}

/// The matrix from the cell of random views into a camera's space.
pub fn look(eye: Vec3, towards: Vec3) -> Mat4 {
    glam::camera::rh::view::look_at_mat4(eye, eye + towards, Vec3::Y)
}

/// A view with a camera of its own and `others`.
///
/// # Errors
/// None in practice: the matrices are checked like any other.
pub(crate) fn view(
    look: Mat4,
    projection: Mat4,
    reversed: bool,
    others: &[LodCamera],
) -> Result<SelectView, InputError> {
    let depth = if reversed { Depth::Reversed } else { Depth::Forward };
    let own = LodCamera::new(look, projection, [1000, 700], depth, 1.0)?;
    let mut cameras = [own; VIEW_CAMERAS as usize];
    cameras[1..=others.len()].copy_from_slice(others);
    let clip = projection * look;
    let clip_rows = [clip.row(0) * (1000.0 / 700.0), clip.row(1), clip.row(3)];
    Ok(SelectView {
        planes: planes(clip),
        cameras,
        cell: CELL,
        mask: 0xffff,
        camera_count: 1 + others.len() as u32,
        is_first: 0,
        casters: 0,
        blocks: u32::MAX,
        is_next: 0,
        seconds: 0.02,
        unused_a: 0,
        unused_b: 0,
        clip_rows,
        last_clip_rows: clip_rows,
    })
}

/// The views of a frame, in order: a perspective, one off its axis with infinite reversed depth, a parallel one for shadows
/// with the cameras of both others, and a parallel one with its own.
///
/// # Errors
/// None in practice: the matrices are checked like any other.
pub(crate) fn frame() -> Result<[(&'static str, SelectView); 4], InputError> {
    let ahead =
        view(look(EYE, Vec3::new(0.3, -0.1, -1.0)), perspective(0.5, 1.4, 0.1, false, 0.0), false, &[])?;
    let aside = view(look(EYE, Vec3::X), perspective(0.3, 1.4, 0.3, true, 0.2), true, &[])?;
    let down = look(Vec3::new(128.0, 90.0, 128.0), Vec3::new(0.2, -1.0, 0.1));
    let shadow = view(down, parallel(150.0, 120.0), false, &[ahead.cameras[0], aside.cameras[0]])?;
    Ok([
        ("a perspective", SelectView { is_first: 1, ..ahead }),
        ("another, reversed", SelectView { mask: 0x00f0, ..aside }),
        ("a shadow", SelectView { casters: 1, cameras: shifted(shadow.cameras), camera_count: 2, ..shadow }),
        ("a map", view(down, parallel(100.0, 120.0), false, &[])?),
    ])
}

/// The cameras without the first one.
fn shifted(mut cameras: [LodCamera; 4]) -> [LodCamera; 4] {
    cameras.rotate_left(1);
    cameras
}
