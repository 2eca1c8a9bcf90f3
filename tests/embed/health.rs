//! What the device reports late, natively: `Scene::health`.

use std::sync::{Arc, Mutex};

use relievo::gpu::{Gpu, GpuError};
use relievo::wgpu;

use crate::frame::{Frame, new_device};
use crate::world::{SIZE, World};

/// A buffer of the program of 16 bytes.
fn buffer(gpu: &Gpu) -> wgpu::Buffer {
    gpu.device().create_buffer(&wgpu::BufferDescriptor {
        label: Some("the program's buffer"),
        size: 16,
        usage: wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::COPY_SRC,
        mapped_at_creation: false,
    })
}

/// Writes beyond the end of a buffer.
fn writes_beyond(gpu: &Gpu) {
    gpu.queue().write_buffer(&buffer(gpu), 16, &[0; 4]);
}

/// Submits a copy from a buffer that was destroyed.
fn copies_the_destroyed(gpu: &Gpu) {
    let (from, to) = (buffer(gpu), buffer(gpu));
    let mut encoder = gpu.encoder("mistake");
    encoder.copy_buffer_to_buffer(&from, 0, &to, 0, 16);
    from.destroy();
    gpu.queue().submit([encoder.finish()]);
}

/// A program's mistakes on a device that the crate opened are told once by the scene's health, and do not harm the frames
/// that follow.
#[test]
fn a_mistake_is_told_once_and_the_next_frame_works() {
    let gpu = crate::harness::new_gpu();
    let mut world = World::new(&gpu, 5);
    let mut view = world.view(1.0);
    let frame = Frame::plain(&gpu, SIZE);
    let renderer = frame.renderer(&gpu, &world.scene);
    let expected = frame.shot(&mut world.scene, &mut view, &renderer);
    assert!(world.scene.health().is_ok());
    for (mistake, words) in [(writes_beyond as fn(&Gpu), "overrun"), (copies_the_destroyed, "destroyed")] {
        mistake(&gpu);
        let told = world.scene.health();
        let is_told = matches!(&told, Err(GpuError::Validation { reason }) if reason.contains(words));
        assert!(is_told, "{words}: {told:?}");
        assert!(world.scene.health().is_ok(), "{words}: told twice");
        let found = frame.shot(&mut world.scene, &mut view, &renderer);
        assert!(found == expected, "{words}: another picture");
        assert!(world.scene.health().is_ok(), "{words}: told after a frame");
    }
    // Of several mistakes the first is told.
    copies_the_destroyed(&gpu);
    writes_beyond(&gpu);
    let told = world.scene.health().expect_err("told").to_string();
    assert!(told.contains("destroyed"), "{told}");
    assert!(world.scene.health().is_ok());
}

/// On a program's own device its mistakes are told to its own handler, and the scene is well.
#[test]
fn a_program_hears_its_own_mistakes() {
    let gpu = new_device();
    let heard = Arc::new(Mutex::new(Vec::new()));
    let to = heard.clone();
    gpu.device().on_uncaptured_error(Arc::new(move |error: wgpu::Error| {
        to.lock().expect("unharmed").push(error.to_string());
    }));
    let world = World::new(&gpu, 1);
    writes_beyond(&gpu);
    assert!(world.scene.health().is_ok());
    let heard = heard.lock().expect("unharmed");
    assert!(heard.len() == 1 && heard[0].contains("overrun"), "{heard:?}");
}
