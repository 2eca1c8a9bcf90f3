//! The device: every failure is an `Err` with what to do, batches are split, memory stays within its bound.

use relievo_testing as harness;

use std::pin::pin;
use std::task::{Context, Poll, Wake};

use harness::{foreign_adapter, new_gpu};
use relievo::asset::keyframe::RotationPath;
use relievo::gpu::{Buffer, Gpu, GpuError, Options, adapters};
use relievo::ops::animation::ClipSet;
use relievo::ops::animation::active::ActivePairs;
use relievo::ops::animation::crowd::{ClipBuffers, Crowd};
use relievo::ops::animation::instance::Instance;
use relievo::ops::animation::instance::Wrap;
use relievo::ops::animation::keyframe_cursor::KeyframeCursorPass;
use relievo::ops::animation::local_to_model::LocalToModelPass;
use relievo::ops::animation::sample::SamplePass;
use relievo::ops::terrain::config::TerrainConfig;
use relievo::ops::terrain::features::Features;
use relievo::ops::terrain::field::region;
use relievo::ops::terrain::fields::Fields;
use relievo::ops::terrain::regions::{HeightBatch, RegionPass};
use relievo::ops::terrain::window::{Window, Windows};
use relievo_lab::harness::{TimedBy, Timer};

/// A device as another program opens it: no optional features, WebGPU's default limits.
fn foreign() -> (wgpu::Device, wgpu::Queue) {
    let (_, device, queue) = foreign_with_instance();
    (device, queue)
}

fn foreign_with_instance() -> (wgpu::Instance, wgpu::Device, wgpu::Queue) {
    let (instance, adapter) = foreign_adapter();
    let (device, queue) =
        pollster::block_on(adapter.request_device(&wgpu::DeviceDescriptor::default())).expect("a device");
    (instance, device, queue)
}

fn heights_equal_the_reference(gpu: &Gpu) {
    let config = TerrainConfig::new(65, 20.0, "device").expect("valid");
    let pass = RegionPass::new(gpu, &config, None).expect("compiled");
    let batch = HeightBatch::new(gpu, &pass, &config, Windows { count: 2, apron: 0 }, 0).expect("allocated");
    batch.set(gpu, &[[3, 4], [-1, 0]], &Features::default()).expect("set");
    gpu.run("test", |encoder| batch.record(encoder)).expect("run");
    let actual = batch.fields()[0].heights.read_blocking(gpu).expect("read");
    let reference = |patch| region(&config, &Features::default(), Window { patch, apron: 0 }.region(&config));
    assert_eq!(actual, [reference([3, 4]), reference([-1, 0])].concat());
}

#[test]
fn an_adapter_that_does_not_exist_is_an_error_with_what_to_do() {
    let options = Options { adapter: Some("no such adapter".to_owned()) };
    let error = Gpu::headless(&options).expect_err("there is none").to_string();
    assert!(error.contains("no such adapter") && error.contains("RELIEVO_ADAPTER"), "{error}");
    assert!(error.contains(&adapters()[0].name), "{error}");
}

#[test]
fn relievo_embeds_in_a_program_with_its_own_device() {
    let (device, queue) = foreign();
    let gpu = Gpu::from_wgpu(device, queue);
    heights_equal_the_reference(&gpu);
    let timer = Timer::new(&gpu).expect("a timer");
    assert_eq!(timer.timed_by(), TimedBy::Wall, "the device has no timestamps");
    assert!(timer.measure(&gpu, |_| ()).expect("measured").nanoseconds > 0.0);
}

#[test]
fn a_validation_error_is_returned_and_the_device_goes_on() {
    let (device, queue) = foreign();
    for gpu in [new_gpu(), Gpu::from_wgpu(device, queue)] {
        let buffer = Buffer::<u32>::new(&gpu, "small", 4).expect("allocated");
        let error = buffer.write(&gpu, &[0; 5]).expect_err("too long");
        assert!(matches!(error, GpuError::Validation { .. }), "{error}");
        heights_equal_the_reference(&gpu);
    }
}

/// Counts how often it is woken.
#[derive(Default)]
struct Alarm(std::sync::atomic::AtomicUsize);

impl Wake for Alarm {
    fn wake(self: std::sync::Arc<Self>) {
        self.0.fetch_add(1, std::sync::atomic::Ordering::SeqCst);
    }
}

#[test]
fn reading_waits_without_blocking_and_is_woken_by_the_device() {
    let gpu = new_gpu();
    let buffer = Buffer::from_slice(&gpu, "data", &[1_u32, 2, 3, 4]).expect("uploaded");
    let alarm = std::sync::Arc::new(Alarm::default());
    let waker = alarm.clone().into();
    let mut context = Context::from_waker(&waker);
    let mut read = pin!(buffer.read(&gpu));
    for _ in 0..3 {
        assert!(read.as_mut().poll(&mut context).is_pending(), "nobody listens to the device yet");
    }
    assert_eq!(alarm.0.load(std::sync::atomic::Ordering::SeqCst), 0);
    gpu.wait().expect("the device answers");
    assert_eq!(alarm.0.load(std::sync::atomic::Ordering::SeqCst), 1);
    let Poll::Ready(Ok(data)) = read.as_mut().poll(&mut context) else { panic!("not ready") };
    assert_eq!(data, [1, 2, 3, 4]);
    let empty = Buffer::<u32>::new(&gpu, "empty", 0).expect("allocated");
    assert_eq!(pollster::block_on(empty.read(&gpu)).expect("nothing to wait for"), [0_u32; 0]);
}

#[test]
fn a_lost_device_is_an_error() {
    let gpu = new_gpu();
    let buffer = Buffer::from_slice(&gpu, "data", &[1_u32, 2, 3, 4]).expect("uploaded");
    gpu.device().destroy();
    let error = buffer.read_blocking(&gpu).expect_err("the device is gone").to_string();
    assert!(error.contains("lost"), "{error}");
    assert!(gpu.run("test", |_| ()).is_err() && Buffer::<u32>::new(&gpu, "more", 1).is_err());
}

#[test]
fn a_buffer_beyond_the_limit_names_it() {
    let gpu = new_gpu();
    let words = gpu.max_binding() as usize / 4;
    let error = Buffer::<u32>::new(&gpu, "huge", words + 1).expect_err("too large").to_string();
    assert!(error.contains("maxStorageBufferBindingSize") && error.ends_with("; split the batch"), "{error}");
    // The caller knows what the buffer is for, and so can say what helps.
    let width = (words as f64).sqrt() as u32 + 1;
    let error = Fields::new(&gpu, "huge", width, 1).expect_err("too large").to_string();
    for part in ["maxStorageBufferBindingSize", "split the batch", "smaller patches", "on the CPU"] {
        assert!(error.contains(part), "{error}");
    }
    assert!(Buffer::<u32>::new(&gpu, "just", words.min(1 << 25)).is_ok());
}

/// A window cannot be split: it takes what the adapter offers beyond WebGPU's default.
#[test]
fn a_window_beyond_128_mib_is_made_where_the_adapter_can_and_says_what_helps_elsewhere() {
    let (device, queue) = foreign();
    for gpu in [new_gpu(), Gpu::from_wgpu(device, queue)] {
        let config = TerrainConfig::new(4097, 20.0, "large").expect("valid");
        let pass = RegionPass::new(&gpu, &config, None).expect("compiled");
        let apron = 850;
        match HeightBatch::new(&gpu, &pass, &config, Windows { count: 1, apron }, 0) {
            Ok(batch) => {
                assert!(gpu.max_binding() > 128 << 20);
                batch.set(&gpu, &[[0, 0]], &Features::default()).expect("set");
                gpu.run("test", |encoder| batch.record(encoder)).expect("run");
                let actual = batch.fields()[0].heights.read_blocking(&gpu).expect("read");
                assert!(
                    actual
                        == region(
                            &config,
                            &Features::default(),
                            Window { patch: [0, 0], apron }.region(&config)
                        )
                );
            }
            Err(error) => {
                assert!(gpu.max_binding() == 128 << 20, "{error}");
                assert!(error.to_string().contains("smaller patches or a smaller apron"), "{error}");
            }
        }
    }
}

#[test]
fn large_batches_are_split_and_memory_stays_below_two_words_a_point() {
    let gpu = new_gpu();
    let config = TerrainConfig::new(1025, 20.0, "split").expect("valid");
    let pass = RegionPass::new(&gpu, &config, None).expect("compiled");
    let count = 33_u32;
    let before = gpu.memory().now();
    let batch = HeightBatch::new(&gpu, &pass, &config, Windows { count, apron: 0 }, 0).expect("allocated");
    assert!(batch.fields().len() == 2, "33 patches of 4.2 MB exceed one binding of 128 MiB");
    let patches: Vec<_> = (0..count as i32).map(|i| [i, -i]).collect();
    batch.set(&gpu, &patches, &Features::default()).expect("set");
    gpu.run("test", |encoder| batch.record(encoder)).expect("run");
    let points = 1025_usize * 1025;
    let bytes = gpu.memory().now() - before;
    assert!(bytes <= 8 * points as u64 * u64::from(count), "{bytes} bytes");
    let last = batch.fields()[1].heights.read_blocking(&gpu).expect("read");
    let expected =
        region(&config, &Features::default(), Window { patch: [32, -32], apron: 0 }.region(&config));
    assert!(last[last.len() - points..] == expected);
    assert!(batch.set(&gpu, &[[0, 0]; 34], &Features::default()).is_err(), "34 patches do not fit");
    let mistaken = TerrainConfig { patch_size: 0, ..config };
    let error =
        HeightBatch::new(&gpu, &pass, &mistaken, Windows { count, apron: 0 }, 0).expect_err("refused");
    assert!(error.to_string().contains("patch_size = 0"), "{error}");
}

/// Buffers, bind groups and pipelines that somebody holds; live pieces of device memory, which recorded work holds too.
fn census(instance: &wgpu::Instance, gpu: &Gpu) -> ([usize; 3], Option<usize>) {
    let hub = instance.generate_report().expect("not a browser").hub;
    let held = [hub.buffers, hub.bind_groups, hub.compute_pipelines].map(|report| report.num_kept_from_user);
    (held, gpu.device().generate_allocator_report().map(|report| report.allocations.len()))
}

#[test]
fn a_frame_of_a_crowd_allocates_nothing() {
    let (instance, device, queue) = foreign_with_instance();
    let gpu = Gpu::from_wgpu(device, queue);
    let model = relievo_samples::creature().expect("valid");
    let set = ClipSet::new(&model.clips.iter().collect::<Vec<_>>()).expect("one skeleton");
    let instances: Vec<_> = (0..100).map(|i| Instance::new(i % 3, Wrap::Loop, i as f32, 1.0)).collect();
    let clips = ClipBuffers::new(&gpu, &set).expect("allocated");
    let crowd = Crowd::new(&gpu, &set, &instances).expect("allocated");
    let active = ActivePairs::new(&gpu, &crowd).expect("allocated");
    let sampling = SamplePass::new(&gpu, RotationPath::Slerp).expect("compiled");
    let place =
        KeyframeCursorPass::new(&gpu).expect("compiled").prepare(&gpu, &clips, &crowd).expect("prepared");
    let sample = sampling.prepare(&gpu, &clips, &crowd).expect("prepared");
    let some = sampling.prepare_active(&gpu, &clips, &crowd, &active).expect("prepared");
    let local_to_model = LocalToModelPass::new(&gpu).expect("compiled");
    let local_to_model = local_to_model.prepare(&gpu, &model.skeleton, &crowd).expect("prepared");
    for frame in 0..4 {
        let (known, _) = census(&instance, &gpu);
        place.set(&gpu, frame as f32 / 60.0).expect("set");
        // wgpu stages the write in memory of its own, which relievo cannot avoid.
        let (_, memory) = census(&instance, &gpu);
        let mut encoder = gpu.encoder("frame");
        place.record(&mut encoder);
        sample.record(&mut encoder);
        some.record(&mut encoder);
        local_to_model.record(&mut encoder);
        assert_eq!(census(&instance, &gpu), (known, memory), "frame {frame}");
        gpu.queue().submit([encoder.finish()]);
    }
    // The census counts a buffer even if only recorded work holds it.
    let (known, memory) = census(&instance, &gpu);
    let buffer = Buffer::<u32>::new(&gpu, "seen", 1024).expect("allocated");
    assert_eq!(census(&instance, &gpu).0[0], known[0] + 1);
    let mut encoder = gpu.encoder("holds");
    encoder.clear_buffer(buffer.raw(), 0, None);
    drop(buffer);
    assert!(memory.is_none() || census(&instance, &gpu).1 > memory);
    gpu.queue().submit([encoder.finish()]);
    gpu.wait().expect("done");
}
