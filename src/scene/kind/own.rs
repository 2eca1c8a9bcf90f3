//! A caller-defined kind, as the scene stores it.

use std::any::Any;

use glam::DVec3;

use super::{Kind, KindFrame, KindPart, KindRay, KindUploads};
use crate::animation::Frame;
use crate::gpu::{Gpu, GpuError, Group, Staged, Uniform, Upload as _};
use crate::scene::chunk::Chunk;
use crate::scene::drawable::{Drawable, NO_OBJECT, Part};
use crate::scene::layouts::SceneLayouts;
use crate::scene::mesh::{Drawn, NOTHING};
use crate::scene::object_kind::{Made, MakeOn, Making, ObjectKind, OnDevice, Placed, UnitRay};
use crate::scene::ray::SurfaceHit;
use crate::scene::specialization::{OwnDepth, PartState, Specialization};
use crate::shared::lod::object::{OBJECT_LEVELS, SceneDraw};
use crate::shared::render::scene_instances::SceneObject;
use crate::{Error, InputError};

/// Largest number of draws of an object: parts times levels of detail.
const MAX_DRAWS: usize = 64;

/// A caller-defined kind.
#[derive(Debug)]
pub(in crate::scene) struct OwnKind {
    pub kind: Box<dyn Kind>,
    /// Whether the kind must upload all of its data again.
    pub is_fresh: bool,
}

impl OwnKind {
    /// A kind with nothing uploaded yet.
    ///
    /// # Errors
    /// [`InputError`] if the errors of levels, the parts or the bounding sphere are out of range.
    pub fn new(kind: Box<dyn Kind>) -> Result<Self, InputError> {
        check(&*kind)?;
        Ok(Self { kind, is_fresh: true })
    }

    /// The same kind on another device.
    ///
    /// # Errors
    /// [`InputError`] for a kind whose levels, parts or sphere have changed, and the errors of [`Kind::rebuild`].
    pub fn rebuilt(&self, gpu: &Gpu) -> Result<Self, Error> {
        let fresh = Self::new(self.kind.rebuild(gpu)?)?;
        let levels =
            |kind: &dyn Kind| kind.parts().iter().map(|part| part.levels.clone()).collect::<Vec<_>>();
        let (old, new) = (&*self.kind, &*fresh.kind);
        let is_same = old.errors() == new.errors()
            && levels(old) == levels(new)
            && old.bounding_sphere() == new.bounding_sphere();
        match is_same {
            true => Ok(fresh),
            false => {
                let bound = "must have the errors, the parts and the sphere that it had";
                Err(InputError::new("kind.rebuild", "another kind", bound).into())
            }
        }
    }

    /// The drawable of the kind, and one draw per part and level of detail.
    ///
    /// # Errors
    /// [`InputError`] for an index buffer or a bind group of another device; [`GpuError`].
    pub fn drawn(&self, gpu: &Gpu, layouts: &SceneLayouts) -> Result<Drawn, Error> {
        check_device(gpu, &*self.kind)?;
        let part = |part: &KindPart| {
            let KindPart { cut_out, blended, own_depth, double_sided, .. } = *part;
            let own_depth = if own_depth { OwnDepth::Always } else { OwnDepth::Never };
            let state = PartState { cut_out, blended, double_sided, own_depth };
            (Specialization::own(self.kind.program(), state), part.group.clone())
        };
        let parts = self.kind.parts().iter().map(part).collect();
        let drawable = OwnDrawable::new(gpu, layouts, self.kind.indices(), parts)?;
        let draw = |part: &KindPart, level: u32| match part.levels.get(level as usize) {
            Some(range) => SceneDraw { index_count: range.len() as u32, first_index: range.start, ..NOTHING },
            None => NOTHING,
        };
        let of_part = |part: &KindPart| (0..OBJECT_LEVELS).map(|level| draw(part, level)).collect::<Vec<_>>();
        let draws = self.kind.parts().iter().flat_map(of_part).collect();
        Ok((vec![Box::new(drawable)], draws))
    }
}

impl ObjectKind for OwnKind {
    fn name(&self) -> &'static str {
        "of a kind of the caller's"
    }

    fn renew(&mut self, target: MakeOn<'_>, chunks: &mut Vec<Chunk>) -> Result<(), Error> {
        self.is_fresh = true;
        chunks.iter_mut().for_each(|chunk| chunk.slots = 0..target.capacity);
        Ok(())
    }

    fn made_on<'a>(&'a self, target: MakeOn<'a>) -> Making<'a> {
        let MakeOn { gpu, layouts, capacity, .. } = target;
        Box::pin(async move {
            let own = self.rebuilt(gpu)?;
            let chunks = vec![Chunk::new(0..capacity, own.drawn(gpu, layouts)?.0)];
            Ok(OnDevice { chunks, other: Box::new(own) })
        })
    }

    fn adopt(&mut self, other: Box<dyn Made>) {
        let other: Box<dyn Any> = other;
        if let Ok(own) = other.downcast() {
            *self = *own;
        }
    }

    fn stage(&mut self, staged: &mut Staged, frame: &Frame, now: f64) -> Result<(), Error> {
        let last_seconds = now - f64::from(frame.ahead);
        let frame = KindFrame { seconds: now, last_seconds, is_fresh: self.is_fresh };
        self.kind.upload(&frame, &mut KindUploads(staged))?;
        self.is_fresh = false;
        Ok(())
    }

    fn hit(&self, instance: &Placed, ray: &UnitRay) -> Result<Option<SurfaceHit>, InputError> {
        let into = instance.place.inverse();
        let origin = into.transform_point3(ray.origin);
        let hit = self.kind.hit(&KindRay { origin, direction: into.transform_vector3(ray.direction) });
        let hit = hit.filter(|hit| (0.0..=ray.limit).contains(&hit.distance));
        let normal = |normal: DVec3| into.matrix3.transpose() * normal;
        Ok(hit.map(|hit| SurfaceHit { distance: hit.distance, normal: normal(hit.normal) }))
    }

    fn tight_box(&self, instance: &Placed) -> Result<[DVec3; 2], InputError> {
        Ok(instance.sphere_box)
    }

    fn wide_box(&self, instance: &Placed) -> Result<Option<[DVec3; 2]>, InputError> {
        Ok(Some(instance.sphere_box))
    }
}

/// A drawable of a caller-defined kind.
#[derive(Debug, Clone)]
struct OwnDrawable {
    object: Uniform<SceneObject>,
    /// Bind group 1.
    group: Group,
    indices: wgpu::Buffer,
    /// Each part's pipeline specialization and bind group 2.
    parts: Vec<(Specialization, Group)>,
}

impl OwnDrawable {
    /// Creates a drawable with the object's uniform, which is bound in group 1.
    fn new(
        gpu: &Gpu,
        layouts: &SceneLayouts,
        indices: &wgpu::Buffer,
        parts: Vec<(Specialization, Group)>,
    ) -> Result<Self, GpuError> {
        let object = Uniform::new(gpu, "object", &NO_OBJECT)?;
        let group = layouts.own_object(gpu, &object)?;
        Ok(Self { object, group, indices: indices.clone(), parts })
    }
}

impl Drawable for OwnDrawable {
    fn part_count(&self) -> usize {
        self.parts.len()
    }

    fn part(&self, at: usize) -> Option<Part<'_>> {
        self.parts.get(at).map(|(specialization, group)| Part { specialization, group })
    }

    fn group(&self) -> Option<&Group> {
        Some(&self.group)
    }

    fn indices(&self) -> &wgpu::Buffer {
        &self.indices
    }

    fn stage(&self, staged: &mut Staged, object: &SceneObject) -> Result<(), Error> {
        Ok(staged.uniform(&self.object, object)?)
    }
}

/// Returns an error for an index buffer or a bind group of another device.
fn check_device(gpu: &Gpu, kind: &dyn Kind) -> Result<(), Error> {
    let (indices, format) = (kind.indices(), wgpu::IndexFormat::Uint32);
    check_taken(gpu, "kind.indices", |encoder| encoder.set_index_buffer(indices.slice(..), format))?;
    (kind.parts().iter().enumerate()).try_for_each(|(at, part)| {
        let path = format!("kind.parts[{at}].group");
        check_taken(gpu, &path, |encoder| encoder.set_bind_group(2, &part.group, &[]))
    })
}

/// Returns an error for a resource of another device. wgpu reports the mismatch when a render bundle uses the resource.
fn check_taken<'a>(
    gpu: &'a Gpu,
    path: &str,
    record: impl FnOnce(&mut wgpu::RenderBundleEncoder<'a>),
) -> Result<(), Error> {
    let descriptor = wgpu::RenderBundleEncoderDescriptor {
        label: Some("what a kind binds"),
        color_formats: &[Some(wgpu::TextureFormat::Rgba8Unorm)],
        sample_count: 1,
        ..Default::default()
    };
    let bundled = gpu.scoped_with(|| {
        let mut encoder = gpu.device().create_render_bundle_encoder(&descriptor);
        record(&mut encoder);
        encoder.finish(&wgpu::RenderBundleDescriptor::default());
    });
    let refused = |bound: String| Err(InputError::new(path, "not usable", bound).into());
    match bundled {
        Ok(Some(())) => Ok(()),
        Ok(None) => refused("must be of the scene's device".to_owned()),
        Err(GpuError::Validation { reason }) => refused(format!("must be of the scene's device: {reason}")),
        Err(error) => Err(error.into()),
    }
}

fn check(kind: &dyn Kind) -> Result<(), InputError> {
    let errors = kind.errors();
    if !(1..=OBJECT_LEVELS as usize).contains(&errors.len()) {
        let bound = format!("must be in 1..={OBJECT_LEVELS}");
        return Err(InputError::new("kind.errors.len", errors.len(), bound));
    }
    InputError::check(errors[0] == 0.0, "kind.errors[0]", errors[0], || "must be 0")?;
    for (at, pair) in errors.windows(2).enumerate() {
        if !(pair[0] <= pair[1] && pair[1].is_finite()) {
            let bound = format!("must be finite and at least {}, the error before", pair[0]);
            return Err(InputError::new(format!("kind.errors[{}]", at + 1), pair[1], bound));
        }
    }
    let sphere = kind.bounding_sphere();
    // A NaN radius fails this comparison.
    if !(sphere.radius >= 0.0 && sphere.radius.is_finite() && sphere.center.is_finite()) {
        let value = format!("{} around {}", sphere.radius, sphere.center);
        let bound = "must be finite, with a radius of at least 0";
        return Err(InputError::new("kind.bounding_sphere", value, bound));
    }
    let draws = kind.parts().len() * errors.len();
    let bound = || format!("must be at least 1, and times the number of levels at most {MAX_DRAWS}");
    InputError::check((1..=MAX_DRAWS).contains(&draws), "kind.parts.len", kind.parts().len(), bound)?;
    let indices = kind.indices();
    if !indices.usage().contains(wgpu::BufferUsages::INDEX) {
        let value = format!("{:?}", indices.usage());
        return Err(InputError::new("kind.indices.usage", value, "must have INDEX"));
    }
    let count = indices.size() / size_of::<u32>() as u64;
    InputError::check(count != 0, "kind.indices.len", 0, || "must be at least 3 indices")?;
    for (at, part) in kind.parts().iter().enumerate() {
        if part.levels.len() != errors.len() {
            let bound = format!("must be {}, as many as errors", errors.len());
            return Err(InputError::new(format!("kind.parts[{at}].levels.len"), part.levels.len(), bound));
        }
        for (level, range) in part.levels.iter().enumerate() {
            let is_inside = range.start <= range.end && u64::from(range.end) <= count;
            if !is_inside || range.len() % 3 != 0 {
                let bound = format!("must be triangles inside the {count} indices of the buffer");
                let path = format!("kind.parts[{at}].levels[{level}]");
                return Err(InputError::new(path, format!("{range:?}"), bound));
            }
        }
    }
    Ok(())
}
