//! Parity and benchmark cases, a file for each operation.

pub mod animation;
pub mod baseline;
pub mod lod;
pub mod skinning;
pub mod surface;
pub mod terrain;

use std::pin::Pin;

use relievo::{Error, InputError};

use crate::cases::terrain::copy_of;
use crate::harness::{Backend, Bench, Cases, Contender};

/// The cases of a kernel.
#[derive(Clone, Copy)]
pub struct Operation {
    /// The kernel's path below `kernels/`, without extension.
    pub name: &'static str,
    /// Runs its parity cases.
    pub parity: for<'a> fn(&'a mut Cases<'_>) -> Running<'a>,
    /// Runs its benchmark cases.
    pub benchmark: fn(&mut Bench<'_>) -> Result<(), Error>,
}

/// Cases that are running.
pub type Running<'a> = Pin<Box<dyn Future<Output = Result<(), Error>> + 'a>>;

macro_rules! operations {
    ($($domain:ident / $operation:ident,)*) => {
        &[$(Operation {
            name: concat!(stringify!($domain), "/", stringify!($operation)),
            parity: |cases| Box::pin($domain::$operation::parity(cases)),
            benchmark: $domain::$operation::benchmark,
        },)*]
    };
}

/// The cases of every kernel.
pub static OPERATIONS: &[Operation] = operations![
    baseline / copy,
    baseline / gather,
    baseline / loads,
    baseline / texels,
    baseline / words,
    terrain / height,
    terrain / smooth,
    terrain / wrap,
    terrain / noise,
    terrain / replace,
    terrain / border,
    terrain / pad,
    terrain / despike,
    terrain / thermal,
    terrain / hydraulic,
    terrain / limit,
    terrain / node,
    terrain / node_normals,
    terrain / normals,
    terrain / morph,
    terrain / blend,
    surface / height_pyramid,
    surface / cone_map,
    surface / shade,
    surface / tangent,
    animation / keyframe_cursor,
    animation / clip_clock,
    animation / gate,
    animation / budget,
    animation / drive,
    animation / compact,
    animation / sample,
    animation / local_to_model,
    animation / bounds,
    skinning / palette,
    skinning / morph_weights,
    skinning / morph,
    skinning / pages,
    skinning / select,
    skinning / skin,
    lod / select,
    lod / budget,
    lod / decide,
    lod / list,
    lod / sorted,
    lod / assign,
    lod / attach,
    // Its benchmark draws pictures, and comes last: lavapipe's timestamps are too short afterwards (see its cases).
    surface / relief,
];

/// The operations whose names contain `only`, or all.
///
/// # Errors
/// [`InputError`] when there is none, with all names.
pub(crate) fn selected(only: Option<&str>) -> Result<Vec<&'static Operation>, InputError> {
    let is_selected = |operation: &&Operation| only.is_none_or(|only| operation.name.contains(only));
    let found: Vec<_> = OPERATIONS.iter().filter(is_selected).collect();
    if found.is_empty() {
        let names = OPERATIONS.iter().map(|operation| operation.name).collect::<Vec<_>>().join(", ");
        let bound = format!("must be (part of) one of {names}");
        return Err(InputError::new("only", only.unwrap_or(""), bound));
    }
    Ok(found)
}

/// Measures a kernel that reads and writes `words` words for `count` of a unit, its reference, and a copy of as many words.
pub(crate) fn measure<R>(
    bench: &mut Bench<'_>,
    name: impl Into<String>,
    count: usize,
    unit: &'static str,
    words: usize,
    record: &dyn Fn(&mut wgpu::CommandEncoder),
    mut reference: impl FnMut() -> R,
) -> Result<(), Error> {
    // A copy reads half of the words that it moves, and writes the other half.
    let copied = copy_of(bench.gpu, words / 2)?;
    let contenders = vec![
        Contender::recorded(Backend::Gpu, record),
        Contender::job(Backend::Copy, &copied),
        Contender::host(Backend::Reference, || drop(std::hint::black_box(reference()))),
    ];
    bench.case(name, count, unit, 4 * words as u64, contenders)
}
