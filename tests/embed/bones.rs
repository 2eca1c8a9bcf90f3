//! Meshes on bones, and bones that the program poses itself between sampling and skinning.

use glam::{DAffine3, DQuat, Quat, Vec3};
use image::RgbaImage;
use relievo::asset::{Model, Transform};
use relievo::gpu::Gpu;
use relievo::ops::animation::Pose;
use relievo::ops::animation::local_to_model::reference::local_to_model;
use relievo::scene::{InstanceBone, InstanceId, Placement, Poses, View};
use relievo::wgpu;

use crate::frame::{Frame, device};
use crate::harness::Difference;
use crate::host;
use crate::world::{SIZE, World, model};

/// The bone that carries or is turned, and one below it.
const BONE: usize = 40;

fn offset() -> Transform {
    let rotation = Quat::from_rotation_z(0.8).to_array();
    Transform { translation: [0.1, 0.3, -0.2], rotation, scale: [0.3; 3] }
}

/// The placement of a transform without shear.
fn placement_of(transform: DAffine3) -> Placement {
    let (scale, turn, at) = transform.to_scale_rotation_translation();
    Placement { turn: turn.as_quat(), scale: scale.as_vec3(), ..Placement::at_world(at) }
}

/// A mesh on a bone is where the host sees it, in every frame, mirrored or not, and gone with its character.
#[test]
fn meshes_follow_bones() {
    let gpu = device();
    let mut world = World::new(&gpu, 3);
    let statue = world.scene.add_mesh(&model(), 2).expect("added");
    let beside = Placement::at([30.0, 90.0, 0.0]);
    let carried = world.scene.spawn(statue, beside).expect("room");
    let free = world.scene.spawn(statue, beside).expect("room");
    let carrier = world.crowd[1];
    let (mut attached, mut placed) = (world.view(0.0), world.view(0.0));
    attached.set_mask(0b01);
    placed.set_mask(0b10);
    world.scene.set_visibility_mask(carried, 0b01).expect("there");
    world.scene.set_visibility_mask(free, 0b10).expect("there");
    world.scene.attach(carried, carrier, "40", offset()).expect("a bone");
    assert_eq!(world.scene.attached_to(carried).expect("there"), Some((carrier, BONE)));
    let frame = Frame::plain(&gpu, SIZE);
    let renderer = frame.renderer(&gpu, &world.scene);
    let mut last: Option<RgbaImage> = None;
    for (step, mirror) in [(0.0, 1.0), (0.21, 1.0), (0.4, -1.0), (0.13, -1.0)] {
        world.scene.advance(step).expect("finite");
        let scale = Vec3::new(3.0 * mirror, 3.0, 3.0);
        world.scene.move_to(carrier, Placement { scale, ..world.placement(1) }).expect("there");
        let bone = host::bones(&world.scene, &model(), carrier)[BONE];
        let offset = DAffine3::from_scale_rotation_translation(
            Vec3::from(offset().scale).as_dvec3(),
            DQuat::from_array(offset().rotation.map(f64::from)).normalize(),
            Vec3::from(offset().translation).as_dvec3(),
        );
        world.scene.move_to(free, placement_of(bone * offset)).expect("there");
        let stands = world.scene.world_from_model(carried).expect("there");
        let of_pose =
            world.scene.pose(carrier).expect("a pose").world_from_bone(BONE).expect("a bone") * offset;
        // The offset is rounded to f32.
        assert!(stands.abs_diff_eq(of_pose, 1e-5), "{stands} {of_pose}");
        assert!(stands.abs_diff_eq(bone * offset, 2e-4), "{stands} {}", bone * offset);
        let stands = world.scene.world_from_model(free).expect("there");
        assert!(stands.translation.distance(world.scene.placement(free).expect("there").world()) < 1e-9);
        let boxes = [carried, free].map(|instance| world.scene.bounds(instance).expect("there"));
        let corners = boxes.map(|found| found.world()[0]);
        assert!(corners[0].distance(corners[1]) < 1e-2, "{corners:?}");
        let pictures = [&mut attached, &mut placed].map(|view| frame.shot(&mut world.scene, view, &renderer));
        let difference = Difference::of(&pictures[0], &pictures[1], 3);
        assert!(difference.outliers < 0.001 && difference.flip < 0.01, "{difference:?}");
        assert!(last.as_ref() != Some(&pictures[0]), "nothing moves");
        last = Some(pictures[0].clone());
    }
    without_its_character(&mut world, (carried, free), &mut attached, &frame);
}

/// A bone goes by its name, its index in digits, and the index that the scene gives for either.
#[test]
fn bones_have_a_name_and_an_index() {
    let gpu = device();
    let mut world = World::new(&gpu, 1);
    let (model, carrier) = (model(), world.crowd[0]);
    let statue = world.scene.add_mesh(&model, 1).expect("added");
    let carried = world.scene.spawn(statue, Placement::default()).expect("room");
    let name = model.skeleton.bones()[BONE].name.clone();
    for text in [name, BONE.to_string()] {
        assert_eq!(world.scene.bone(carrier, &text).expect("a bone"), BONE);
        world.scene.attach(carried, carrier, &text, offset()).expect("a bone");
        assert_eq!(world.scene.attached_to(carried).expect("there"), Some((carrier, BONE)));
        world.scene.detach(carried).expect("attached");
    }
}

/// A hidden character hides what it carries; what it carried stands where its placement says when the character is gone.
fn without_its_character(
    world: &mut World,
    (carried, free): (InstanceId, InstanceId),
    view: &mut View,
    frame: &Frame,
) {
    let gpu = world.scene.gpu().clone();
    let carrier = world.crowd[1];
    world.scene.set_visibility_mask(free, 0).expect("there");
    let renderer = frame.renderer(&gpu, &world.scene);
    let mut shot = |world: &mut World| frame.shot(&mut world.scene, view, &renderer);
    world.scene.set_visibility_mask(carrier, 0).expect("there");
    let both_hidden = shot(world);
    world.scene.set_visibility_mask(carried, 0).expect("there");
    assert!(shot(world) == both_hidden, "a mesh without its character");
    world.scene.set_visibility_mask(carrier, u16::MAX).expect("there");
    let alone = shot(world);
    world.scene.set_visibility_mask(carried, u16::MAX).expect("there");
    let together = shot(world);
    assert!(together != alone && alone != both_hidden, "no mesh on its bone");
    let aside = Placement { offset: Vec3::new(2.0, 9.0, 0.0), ..Placement::default() };
    world.scene.move_to(carried, aside).expect("there");
    assert!(shot(world) == together, "what is attached stays at its bone");
    let at_bone = world.scene.world_from_model(carried).expect("there").translation;
    assert!(at_bone.distance(aside.world()) > 1.0, "{at_bone}");
    world.scene.despawn(carrier).expect("there");
    assert_eq!(world.scene.attached_to(carried).expect("there"), None);
    assert_eq!(world.scene.placement(carried).expect("there"), aside);
    assert_eq!(world.scene.world_from_model(carried).expect("there").translation, aside.world());
    let freed = shot(world);
    assert!(freed != both_hidden && freed != together, "no mesh at its place");
    let refused = |result: Result<(), relievo::InputError>| result.expect_err("refused").path;
    assert_eq!(refused(world.scene.detach(carried)), "mesh");
    assert_eq!(refused(world.scene.attach(carried, carrier, "1", offset())), "character");
    let other = world.crowd[0];
    assert_eq!(refused(world.scene.attach(other, other, "1", offset())), "mesh");
    let nose = world.scene.attach(carried, other, "Nose", offset()).expect_err("refused").to_string();
    assert!(nose.starts_with("bone = Nose: must be one of \""), "{nose}");
    assert!(nose.ends_with("\" … and 133 more, or an index below 153"), "{nose}");
    let flat = Transform { scale: [0.0; 3], ..offset() };
    assert_eq!(refused(world.scene.attach(carried, other, "1", flat)), "offset.scale");
}

/// Far away, what is attached takes coarser levels of detail, like anything else.
#[test]
fn attached_meshes_have_levels() {
    let gpu = device();
    let mut world = World::new(&gpu, 1);
    // A mesh without clips keeps the levels that it was given.
    let still = Model { clips: Vec::new(), ..model() };
    let statue = world.scene.add_mesh(&still, 1).expect("added");
    let carried = world.scene.spawn(statue, Placement::default()).expect("room");
    world.scene.attach(carried, world.crowd[0], "40", offset()).expect("a bone");
    world.scene.set_statistics(true).expect("room");
    let mut view = world.view(1.0);
    let mut triangles = Vec::new();
    for distance in [15.0, 150.0] {
        let eye = relievo::scene::Camera::looking_at(
            Vec3::new(-10.0, 0.3 * distance, distance),
            Vec3::new(-10.0, 3.0, 0.0),
            0.6,
            [0.5, 900.0],
            SIZE,
        );
        view.set(eye).expect("a camera");
        record(&gpu, &mut world, &mut view, |_, _| Ok(()));
        let found = view.statistics().expect("arrived");
        let object = found.objects.iter().find(|found| found.object == statue).expect("counted");
        assert_eq!(object.instances(), 1);
        triangles.push(object.triangles());
    }
    assert!(2 * triangles[1] < triangles[0], "{triangles:?}");
}

/// Turns the bone of an instance by half a radian about its own x axis, wherever it is.
struct Turn {
    pipeline: wgpu::ComputePipeline,
    instance: u32,
}

impl Turn {
    fn new(gpu: &Gpu, instance: u32) -> Self {
        let bones = model().skeleton.len();
        let source = format!(
            "@group(0) @binding(0) var<storage, read_write> locals: array<vec4<f32>>;
            @compute @workgroup_size(1) fn main() {{
                let at = 3u * ({instance}u * {bones}u + {BONE}u) + 1u;
                let q = locals[at];
                let turn = vec2<f32>({:?}, {:?});
                locals[at] = vec4<f32>(q.w * turn.x + q.x * turn.y, q.y * turn.y + q.z * turn.x,
                    q.z * turn.y - q.y * turn.x, q.w * turn.y - q.x * turn.x);
            }}",
            0.25_f32.sin(),
            0.25_f32.cos()
        );
        let module = gpu.device().create_shader_module(wgpu::ShaderModuleDescriptor {
            label: Some("the program's kinematics"),
            source: wgpu::ShaderSource::Wgsl(source.into()),
        });
        let pipeline = gpu.device().create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
            label: Some("the program's kinematics"),
            layout: None,
            module: &module,
            entry_point: None,
            compilation_options: Default::default(),
            cache: None,
        });
        Self { pipeline, instance }
    }

    fn record(
        &self,
        gpu: &Gpu,
        encoder: &mut wgpu::CommandEncoder,
        poses: &Poses<'_>,
        instance: InstanceId,
    ) -> Result<(), relievo::InputError> {
        let buffers = poses.of(instance)?;
        assert!(self.instance == buffers.index && buffers.index < buffers.instances);
        assert_eq!(buffers.bones as usize, model().skeleton.len());
        let group = gpu.device().create_bind_group(&wgpu::BindGroupDescriptor {
            label: None,
            layout: &self.pipeline.get_bind_group_layout(0),
            entries: &[wgpu::BindGroupEntry {
                binding: 0,
                resource: buffers.locals.raw().as_entire_binding(),
            }],
        });
        let mut pass = encoder.begin_compute_pass(&Default::default());
        pass.set_pipeline(&self.pipeline);
        pass.set_bind_group(0, &group, &[]);
        pass.dispatch_workgroups(1, 1, 1);
        Ok(())
    }
}

/// Records a frame with a pass of the program, and waits for it.
fn record(
    gpu: &Gpu,
    world: &mut World,
    view: &mut View,
    pose: impl FnOnce(&mut wgpu::CommandEncoder, &mut Poses<'_>) -> Result<(), relievo::InputError>,
) {
    let mut encoder = gpu.encoder("frame");
    world.scene.record_with(&mut encoder, &mut [view], pose).expect("recorded");
    gpu.queue().submit([encoder.finish()]);
    gpu.wait().expect("done");
}

/// The model matrices that the host computes with the turned bone.
fn turned(world: &World, instance: InstanceId, turn: f64) -> Vec<DAffine3> {
    let model = model();
    let time = world.scene.clip_time(instance).expect("there").expect("a character");
    let mut locals = Pose::on_host(&model.skeleton, &model.clips[time.clip], time.seconds).locals;
    let rotation = DQuat::from_array(locals[BONE].rotation.map(f64::from)) * DQuat::from_rotation_x(turn);
    locals[BONE].rotation = rotation.to_array().map(|part| part as f32);
    let matrices = local_to_model(&model.skeleton, &locals);
    let placed = host::placed(&world.scene.placement(instance).expect("there"));
    matrices.iter().map(|matrix| placed * host::affine(matrix)).collect()
}

/// The program turns a bone in each frame, between sampling and model matrices. It and the bones below it are where the host
/// puts them, also where time stands still; nothing else moves; and afterwards everything is as if nothing had been.
#[test]
fn programs_pose_bones() {
    let gpu = device();
    let mut world = World::new(&gpu, 3);
    let model = model();
    let instance = world.crowd[1];
    let below = model.skeleton.bones().iter().rposition(|bone| {
        let mut above = bone.parent;
        while let Some(parent) = above.filter(|parent| *parent as usize != BONE) {
            above = model.skeleton.bones()[parent as usize].parent;
        }
        above.is_some()
    });
    let watched = [BONE, below.expect("a bone below"), 0, 152];
    let names = watched.map(|bone| bone.to_string());
    let pairs: Vec<_> = names.iter().map(|bone| InstanceBone { instance, bone }).collect();
    world.scene.watch_bones(&pairs).expect("bones");
    let turn = Turn::new(&gpu, 1);
    let mut view = world.view(0.0);
    let frame = Frame::plain(&gpu, SIZE);
    let renderer = frame.renderer(&gpu, &world.scene);
    let plain = frame.shot(&mut world.scene, &mut view, &renderer);
    world.scene.drive(instance, &[names[0].as_str()]).expect("a bone");
    for step in [0.0, 0.0, 0.07, 0.31, 0.0] {
        world.scene.advance(step).expect("finite");
        record(&gpu, &mut world, &mut view, |encoder, poses| turn.record(&gpu, encoder, poses, instance));
        let right = turned(&world, instance, 0.5);
        let still = turned(&world, instance, 0.0);
        let found = world.scene.watched_bones().expect("arrived");
        for (bone, watched) in found.bones.iter().zip(watched) {
            let matrix = bone.world_from_bone();
            let error = |right: &DAffine3| {
                let off = (right.matrix3 - matrix.matrix3).to_cols_array();
                let moved = (right.translation - matrix.translation).length();
                off.iter().fold(moved, |most, entry| most.max(entry.abs()))
            };
            assert!(error(&right[watched]) < 1e-3, "bone {watched}: {}", error(&right[watched]));
            assert_eq!(error(&still[watched]) > 0.1, [BONE, below.expect("one")].contains(&watched));
        }
    }
    world.scene.advance(-0.38).expect("finite");
    let posed = shot_with(&gpu, &mut world, &mut view, &frame, &turn);
    assert!(posed != plain, "skinning does not follow");
    // A scene that does so for the first time shows the same.
    let mut fresh = World::new(&gpu, 3);
    fresh.scene.drive(fresh.crowd[1], &["40"]).expect("a bone");
    let mut other = fresh.view(0.0);
    fresh.scene.advance(world.scene.time() as f32 - fresh.scene.time() as f32).expect("finite");
    let again = shot_with(&gpu, &mut fresh, &mut other, &frame, &turn);
    let difference = Difference::of(&posed, &again, 1);
    assert!(difference.outliers < 0.001, "{difference:?}");
    // Without the program the bone is where the clip has it, at once.
    world.scene.drive(instance, &[]).expect("there");
    fresh.scene.drive(fresh.crowd[1], &[]).expect("there");
    fresh.scene.refresh().expect("afresh");
    let released = frame.shot(&mut world.scene, &mut view, &renderer);
    let never = frame.shot(&mut fresh.scene, &mut other, &renderer);
    let difference = Difference::of(&released, &never, 1);
    assert!(difference.outliers < 0.001, "{difference:?}");
    assert_eq!(world.scene.drive(instance, &["nose"]).expect_err("refused").path, "bone");
}

fn shot_with(gpu: &Gpu, world: &mut World, view: &mut View, frame: &Frame, turn: &Turn) -> RgbaImage {
    let instance = world.crowd[1];
    let renderer = frame.renderer(gpu, &world.scene);
    let mut encoder = gpu.encoder("frame");
    let pose = |encoder: &mut wgpu::CommandEncoder, poses: &mut Poses<'_>| {
        turn.record(gpu, encoder, poses, instance)
    };
    world.scene.record_with(&mut encoder, &mut [view], pose).expect("recorded");
    frame.pass(&mut encoder, |pass| {
        renderer.draw(pass, &world.scene, view, relievo::render::Layer::Color).expect("drawn");
    });
    gpu.queue().submit([encoder.finish()]);
    frame.read(gpu)
}
