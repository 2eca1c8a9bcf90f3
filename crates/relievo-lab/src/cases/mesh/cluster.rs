//! Parity and benchmark cases of `kernels/mesh/cluster.wgsl`.

use crate::reduce::cluster::reference::{Clustered, cluster};
use crate::reduce::cluster::{ClusterBuffers, ClusterCounts, ClusterPass, Grid, Representative};
use relievo::Error;
use relievo::gpu::Buffer;

use crate::cases::surface::tangent::torus;
use crate::cases::terrain::{copy_of, random_words};
use crate::harness::compare::exact;
use crate::harness::poison::{POISON, Poisoned};
use crate::harness::{Backend, Bench, Cases, Contender};

/// A mesh and its grid.
struct Case {
    name: String,
    positions: Vec<[f32; 3]>,
    indices: Vec<u32>,
    grid: Grid,
}

/// The cases cover literal clusters; numbers of vertices and triangles around the sizes of blocks, workgroups and the table;
/// one cell and many, with sums beyond 32 bits; the largest and the smallest floats; meshes far from the origin, on one place
/// and outside of the grid; and numbers that are none. Everything is compared to the bit. What no cluster needs must stay
/// untouched.
///
/// # Errors
/// What the device reports.
pub(crate) async fn parity(cases: &mut Cases<'_>) -> Result<(), Error> {
    let pass = ClusterPass::new(cases.gpu)?;
    let (literal, expected) = literal();
    check(cases, &pass, &literal, &expected).await?;
    for case in counts().into_iter().chain(sizes()).chain(strange()) {
        let expected = cluster(&case.positions, &case.indices, &case.grid)?;
        check(cases, &pass, &case, &expected).await?;
    }
    another_grid(cases, &pass).await
}

fn representative(position: [f32; 3], source: u32) -> Representative {
    Representative { position, source }
}

/// Two cells with two vertices each and one with one; one triangle of three stays.
fn literal() -> (Case, Clustered) {
    let positions =
        vec![[0.0, 0.0, 0.0], [4.0, 0.0, 0.0], [0.5, 0.0, 0.0], [0.0, 4.0, -0.0], [3.5, 0.5, 0.0]];
    let indices = vec![0, 1, 2, 1, 3, 0, 4, 1, 3];
    let grid = Grid { low: [0.0; 3], high: [4.0, 4.0, 0.0], cells: 3 };
    let expected = Clustered {
        representatives: vec![
            representative([0.25, 0.0, 0.0], 0),
            representative([3.75, 0.25, 0.0], 1),
            representative([0.0, 4.0, 0.0], 3),
        ],
        indices: vec![1, 2, 0],
        remap: vec![0, 1, 0, 2, 1],
        triangles: vec![1],
    };
    (Case { name: "literal".to_owned(), positions, indices, grid }, expected)
}

/// Random positions with coordinates from −1 to 1, and triangles between them.
fn soup(seed: u32, vertices: u32, triangles: u32) -> (Vec<[f32; 3]>, Vec<u32>) {
    let words = random_words(seed, 3 * (vertices + triangles) as usize);
    let (places, corners) = words.split_at(3 * vertices as usize);
    let unit = |word: u32| (word >> 8) as f32 / 8_388_608.0 - 1.0;
    let positions = places.chunks_exact(3).map(|xyz| [xyz[0], xyz[1], xyz[2]].map(unit)).collect();
    (positions, corners.iter().map(|word| word % vertices.max(1)).collect())
}

/// Numbers of vertices and triangles.
fn counts() -> Vec<Case> {
    let counts = [1, 2, 31, 32, 33, 63, 64, 65, 127, 128, 129, 4095, 4096, 4097, 5000];
    let mut cases = Vec::new();
    for (seed, vertices) in (0_u32..).zip(counts) {
        let triangles = counts[(seed as usize * 4 + 3) % counts.len()];
        let (positions, indices) = soup(seed, vertices, triangles);
        let grid = Grid::around(&positions, 3 + seed);
        let name = format!("{vertices} vertices, {triangles} triangles");
        cases.push(Case { name, positions, indices, grid });
    }
    let (positions, _) = soup(90, 70, 0);
    let grid = Grid::around(&positions, 4);
    cases.push(Case { name: "no triangle".to_owned(), positions, indices: Vec::new(), grid });
    let grid = Grid { low: [0.0; 3], high: [1.0; 3], cells: 4 };
    cases.push(Case { name: "nothing".to_owned(), positions: Vec::new(), indices: Vec::new(), grid });
    cases
}

/// Numbers of cells, and sizes of meshes.
fn sizes() -> Vec<Case> {
    let mut cases = Vec::new();
    for (seed, cells) in (100..).zip([1, 2, 7, 64, 1023, 1024]) {
        let (positions, indices) = soup(seed, 3000, 6000);
        let grid = Grid::around(&positions, cells);
        cases.push(Case { name: format!("{cells} cells"), positions, indices, grid });
    }
    let scales = [1e-45, 1e-42, 3e-39, 1.1e-38, 1e-20, 1e20, f32::MAX];
    for (seed, scale) in (200..).zip(scales) {
        let (mut positions, indices) = soup(seed, 300, 600);
        positions.as_flattened_mut().iter_mut().for_each(|x| *x *= scale);
        let grid = Grid::around(&positions, 9);
        cases.push(Case { name: format!("of size {scale:e}"), positions, indices, grid });
    }
    for (seed, far) in (300..).zip([10.0, -1e6, 3e7]) {
        let (mut positions, indices) = soup(seed, 300, 600);
        positions.iter_mut().for_each(|place| place[1] = place[1] * 20.0 + far);
        let grid = Grid::around(&positions, 12);
        cases.push(Case { name: format!("{far} from the origin"), positions, indices, grid });
    }
    cases
}

/// Meshes on one place, outside of their grid, with coordinates of very different sizes, and what is not finite.
fn strange() -> Vec<Case> {
    let case = |name: &str, (positions, indices): (Vec<[f32; 3]>, Vec<u32>), grid| {
        let name = name.to_owned();
        Case { name, positions, indices, grid }
    };
    let one_place = (vec![[0.3, -7.0, 1e-9]; 130], soup(400, 130, 100).1);
    let grid = Grid::around(&one_place.0, 16);
    let mut cases = vec![case("one place", one_place, grid)];
    let half = Grid { low: [-0.5, -1.0, 0.0], high: [0.25, 1.0, 0.5], cells: 10 };
    cases.push(case("outside of the grid", soup(401, 500, 900), half));
    let point = Grid { low: [0.25; 3], high: [0.25; 3], cells: 1024 };
    cases.push(case("a grid without extent", soup(402, 100, 100), point));
    let (mut positions, indices) = soup(403, 1000, 2000);
    for (at, place) in positions.iter_mut().enumerate() {
        place[at % 3] *= [1.0, 1e-6, 1e-9, 2e-10, 1e-30, 1e-44][at / 3 % 6];
    }
    let grid = Grid::around(&positions, 40);
    cases.push(case("of all sizes", (positions, indices), grid));
    let (mut positions, indices) = soup(404, 300, 600);
    let none = [f32::NAN, -f32::NAN, f32::INFINITY, f32::NEG_INFINITY, f32::MAX, -0.0, f32::MIN_POSITIVE];
    for (at, place) in positions.iter_mut().enumerate().step_by(5) {
        place[at % 3] = none[at / 5 % none.len()];
    }
    let grid = Grid { low: [-1.0; 3], high: [1.0; 3], cells: 5 };
    cases.push(case("numbers that are none", (positions, indices), grid));
    cases
}

/// A job whose grid changes.
async fn another_grid(cases: &mut Cases<'_>, pass: &ClusterPass) -> Result<(), Error> {
    let gpu = cases.gpu;
    let (positions, indices) = soup(500, 200, 400);
    let device = Device::new(cases, &positions, &indices)?;
    let first = Grid::around(&positions, 30);
    let job = pass.prepare(gpu, &first, [200, 400], device.buffers())?;
    for cells in [30, 3, 8] {
        let grid = Grid { cells, ..first };
        job.set(gpu, &grid)?;
        device.poison(cases)?;
        gpu.submit("verify", |encoder| job.record(encoder))?;
        let expected = cluster(&positions, &indices, &grid)?;
        device.compare(cases, &format!("the grid becomes {cells} cells"), &expected).await?;
    }
    Ok(())
}

async fn check(
    cases: &mut Cases<'_>,
    pass: &ClusterPass,
    case: &Case,
    expected: &Clustered,
) -> Result<(), Error> {
    let gpu = cases.gpu;
    let device = Device::new(cases, &case.positions, &case.indices)?;
    let size = [case.positions.len() as u32, (case.indices.len() / 3) as u32];
    let job = pass.prepare(gpu, &case.grid, size, device.buffers())?;
    gpu.submit("verify", |encoder| job.record(encoder))?;
    device.compare(cases, &case.name, expected).await
}

/// A mesh on the device, with poisoned outputs.
struct Device {
    positions: Buffer<[f32; 3]>,
    indices: Buffer<u32>,
    representatives: Poisoned<Representative>,
    clustered: Poisoned<u32>,
    counts: Poisoned<ClusterCounts>,
    room: [usize; 2],
}

impl Device {
    fn new(cases: &Cases<'_>, positions: &[[f32; 3]], indices: &[u32]) -> Result<Self, Error> {
        let gpu = cases.gpu;
        Ok(Self {
            positions: Buffer::from_slice(gpu, "positions", positions)?,
            indices: Buffer::from_slice(gpu, "indices", indices)?,
            representatives: Poisoned::new(gpu, positions.len())?,
            clustered: Poisoned::new(gpu, indices.len())?,
            counts: Poisoned::new(gpu, 1)?,
            room: [positions.len(), indices.len()],
        })
    }

    fn buffers(&self) -> ClusterBuffers<'_> {
        ClusterBuffers {
            positions: &self.positions,
            indices: &self.indices,
            representatives: &self.representatives.buffer,
            clustered: &self.clustered.buffer,
            counts: &self.counts.buffer,
        }
    }

    fn poison(&self, cases: &Cases<'_>) -> Result<(), Error> {
        self.representatives.poison(cases.gpu)?;
        self.clustered.poison(cases.gpu)?;
        Ok(self.counts.poison(cases.gpu)?)
    }

    async fn compare(&self, cases: &mut Cases<'_>, name: &str, expected: &Clustered) -> Result<(), Error> {
        let gpu = cases.gpu;
        let padded = |mut words: Vec<u32>, room: usize| {
            words.resize(room, POISON);
            words
        };
        let bits = |all: &[Representative]| -> Vec<u32> {
            let words = |one: &Representative| {
                let [x, y, z] = one.position.map(f32::to_bits);
                [x, y, z, one.source]
            };
            all.iter().flat_map(words).collect()
        };
        // Where there is no room, there is nothing to compare.
        if self.room[0] > 0 {
            let represented = padded(bits(&expected.representatives), 4 * self.room[0]);
            let found = self.representatives.check(gpu, |found| exact(&bits(found), &represented)).await?;
            cases.add(format!("{name}: representatives"), found);
        }
        if self.room[1] > 0 {
            let indices = padded(expected.indices.clone(), self.room[1]);
            let found = self.clustered.check(gpu, |found| exact(found, &indices)).await?;
            cases.add(format!("{name}: triangles"), found);
        }
        let counts = ClusterCounts {
            index_count: expected.indices.len() as u32,
            instance_count: 1,
            first_index: 0,
            base_vertex: 0,
            first_instance: 0,
            representatives: expected.representatives.len() as u32,
        };
        let found = self.counts.check(gpu, |found| exact(found, &[counts])).await?;
        cases.add(format!("{name}: counts"), found);
        Ok(())
    }
}

/// Measures a torus of half a million triangles. The kernel must read positions and indices (12 bytes a vertex and 12 a
/// triangle), and write what stays (16 bytes a representative, 12 a triangle).
///
/// # Errors
/// What the device reports.
pub(crate) fn benchmark(bench: &mut Bench<'_>) -> Result<(), Error> {
    let gpu = bench.gpu;
    let torus = torus(512, 512);
    let (vertices, triangles) = (torus.positions.len(), torus.indices.len() / 3);
    let pass = ClusterPass::new(gpu)?;
    let positions = Buffer::from_slice(gpu, "positions", &torus.positions)?;
    let indices = Buffer::from_slice(gpu, "indices", &torus.indices)?;
    let representatives = Buffer::<Representative>::new(gpu, "representatives", vertices)?;
    let clustered = Buffer::new(gpu, "clustered", torus.indices.len())?;
    let counts = Buffer::<ClusterCounts>::new(gpu, "counts", 1)?;
    for cells in [32, 256] {
        let grid = Grid::around(&torus.positions, cells);
        let buffers = ClusterBuffers {
            positions: &positions,
            indices: &indices,
            representatives: &representatives,
            clustered: &clustered,
            counts: &counts,
        };
        let job = pass.prepare(gpu, &grid, [vertices as u32, triangles as u32], buffers)?;
        let expected = cluster(&torus.positions, &torus.indices, &grid)?;
        let bytes =
            12 * (vertices + triangles) + 16 * expected.representatives.len() + 4 * expected.indices.len();
        let copied = copy_of(gpu, bytes / 8)?;
        let contenders = vec![
            Contender::recorded(Backend::Gpu, |encoder| job.record(encoder)),
            Contender::job(Backend::Copy, &copied),
            Contender::host(Backend::Reference, || {
                drop(std::hint::black_box(cluster(&torus.positions, &torus.indices, &grid)));
            }),
        ];
        let case = format!("512x512 torus, {cells} cells");
        bench.case(case, (triangles, "triangle"), bytes as u64, contenders)?;
    }
    Ok(())
}
