//! Tufts of grass that sway with the time of the scene: a kind of object that the library does not know.

use glam::{DVec3, Vec3};
use relievo::gpu::Gpu;
use relievo::scene::BoundingSphere;
use relievo::scene::kind::{Kind, KindFrame, KindHit, KindPart, KindProgram, KindRay, KindUploads};
use relievo::{Error, wgpu};
use wgpu::util::{BufferInitDescriptor, DeviceExt as _};

const WIDTH: f64 = 0.02;
const SWAY: f64 = 0.12;
/// The time after which all blades are where they were, in seconds.
const PERIOD: f64 = std::f64::consts::PI;

/// Root (x, z), height and phase of a blade.
type Blade = [f32; 4];

/// The grass of one object, whose instances are tufts with a radius of 0.5.
#[derive(Debug)]
pub struct Grass {
    program: KindProgram,
    blades: Vec<Blade>,
    time: wgpu::Buffer,
    indices: wgpu::Buffer,
    parts: [KindPart; 1],
    seconds: f64,
}

impl Grass {
    /// Tufts of so many blades.
    pub fn new(gpu: &Gpu, blades: u32) -> Result<Self, Error> {
        let blade = |at: u32| {
            // Spread evenly over a disc by the golden angle.
            let (at, all) = (at as f32, blades as f32);
            let (radius, angle) = (0.45 * (at / all).sqrt(), 2.4 * at);
            [radius * angle.cos(), radius * angle.sin(), 0.3 + 0.2 * (7.0 * at).sin(), 1.7 * at]
        };
        Self::of(
            gpu,
            KindProgram::new("grass", include_str!("grass.wgsl"))?,
            (0..blades).map(blade).collect(),
        )
    }

    fn of(gpu: &Gpu, program: KindProgram, blades: Vec<Blade>) -> Result<Self, Error> {
        let buffer = |label, contents: &[u8], usage| {
            gpu.device().create_buffer_init(&BufferInitDescriptor { label: Some(label), contents, usage })
        };
        // All three triangles of each blade, then one, then one of every second blade.
        let whole = |first: u32| [0, 1, 2, 2, 1, 3, 2, 3, 4].map(|corner| first + corner);
        let plain = |first: u32| [0, 1, 4].map(|corner| first + corner);
        let firsts = || (0..blades.len() as u32).map(|blade| 5 * blade);
        let mut indices: Vec<u32> = firsts().flat_map(whole).collect();
        let first = indices.len() as u32;
        indices.extend(firsts().flat_map(plain));
        let second = indices.len() as u32;
        indices.extend(firsts().step_by(2).flat_map(plain));
        let levels = vec![0..first, first..second, second..indices.len() as u32];
        let storage = buffer("blades", bytemuck::cast_slice(&blades), wgpu::BufferUsages::STORAGE);
        let usage = wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST;
        let time = buffer("time", &[0; 8], usage);
        let entries = [
            wgpu::BindGroupEntry { binding: 0, resource: storage.as_entire_binding() },
            wgpu::BindGroupEntry { binding: 1, resource: time.as_entire_binding() },
        ];
        let part = KindPart { double_sided: true, ..KindPart::new(program.bind(gpu, &entries)?, levels) };
        let indices = buffer("triangles", bytemuck::cast_slice(&indices), wgpu::BufferUsages::INDEX);
        Ok(Self { program, blades, time, indices, parts: [part], seconds: 0.0 })
    }

    /// Where a vertex is in the tuft, as `grass_bent` of `grass.wgsl` says.
    fn bent(&self, vertex: usize) -> DVec3 {
        let [x, z, height, phase] = self.blades[vertex / 5].map(f64::from);
        let corner = vertex % 5;
        let up = 0.5 * (corner / 2) as f64;
        let side = WIDTH * (1.0 - up) * (2.0 * (corner % 2) as f64 - 1.0);
        let sway = SWAY * up * up * (2.0 * self.seconds + phase).sin();
        DVec3::new(x + side * phase.cos() + sway, height * up, z + side * phase.sin() + 0.4 * sway)
    }
}

impl Kind for Grass {
    fn program(&self) -> &KindProgram {
        &self.program
    }

    fn indices(&self) -> &wgpu::Buffer {
        &self.indices
    }

    fn parts(&self) -> &[KindPart] {
        &self.parts
    }

    fn errors(&self) -> &[f32] {
        // A straight blade is off by a quarter of its sway halfway up; every second blade leaves gaps of some widths.
        &[0.0, 0.03, 0.1]
    }

    fn bounding_sphere(&self) -> BoundingSphere {
        BoundingSphere { center: Vec3::new(0.0, 0.25, 0.0), radius: 0.7 }
    }

    fn upload(&mut self, frame: &KindFrame, uploads: &mut KindUploads<'_>) -> Result<(), Error> {
        self.seconds = frame.seconds;
        let times = [frame.seconds, frame.last_seconds].map(|seconds| seconds.rem_euclid(PERIOD) as f32);
        uploads.write(&self.time, 0, bytemuck::cast_slice(&times))
    }

    fn rebuild(&self, gpu: &Gpu) -> Result<Box<dyn Kind>, Error> {
        Ok(Box::new(Self::of(gpu, self.program.clone(), self.blades.clone())?))
    }

    fn hit(&self, ray: &KindRay) -> Option<KindHit> {
        let first = (0..5 * self.blades.len()).step_by(5);
        let triangles =
            first.flat_map(|first| [[0, 1, 2], [2, 1, 3], [2, 3, 4]].map(|at| at.map(|at| first + at)));
        let hits = triangles.filter_map(|triangle| ray.triangle(triangle.map(|vertex| self.bent(vertex))));
        hits.reduce(|a, b| if b.distance < a.distance { b } else { a })
    }
}
