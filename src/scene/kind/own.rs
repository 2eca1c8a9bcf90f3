//! A kind of the caller's as the scene keeps it.

use glam::{DAffine3, DVec3};

use super::{Kind, KindFrame, KindPart, KindRay, KindUploads};
use crate::gpu::{Gpu, Staged};
use crate::scene::drawable::{Drawable, OwnDrawable};
use crate::scene::layouts::SceneLayouts;
use crate::scene::mesh::{Drawn, NOTHING};
use crate::scene::ray::SurfaceHit;
use crate::scene::specialization::{OwnDepth, PartState, Specialization};
use crate::shared::lod::object::{OBJECT_LEVELS, OBJECT_LISTS, SceneDraw};
use crate::{Error, InputError};

/// The most draws of an object.
const MAX_DRAWS: usize = 64;

/// A kind of the caller's.
#[derive(Debug)]
pub(in crate::scene) struct OwnKind {
    pub kind: Box<dyn Kind>,
    /// True if the kind must write everything again.
    pub is_fresh: bool,
}

impl OwnKind {
    /// A kind of which nothing is written yet.
    ///
    /// # Errors
    /// [`InputError`] for errors, parts or a sphere out of bounds.
    pub fn new(kind: Box<dyn Kind>) -> Result<Self, InputError> {
        check(&*kind)?;
        Ok(Self { kind, is_fresh: true })
    }

    /// The same kind on another device.
    ///
    /// # Errors
    /// [`InputError`] for a kind with other levels, parts or another sphere; those of [`Kind::rebuild`].
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

    /// How it is drawn.
    pub fn drawn(&self, gpu: &Gpu, layouts: &SceneLayouts) -> Result<Drawn, Error> {
        let part = |part: &KindPart| {
            let KindPart { cut_out, blended, own_depth, double_sided, .. } = *part;
            let own_depth = if own_depth { OwnDepth::Always } else { OwnDepth::Never };
            let state = PartState { cut_out, blended, double_sided, own_depth };
            (Specialization::own(self.kind.program(), state), part.group.clone())
        };
        let parts = self.kind.parts().iter().map(part).collect();
        let drawable = OwnDrawable::new(gpu, layouts, self.kind.indices(), parts)?;
        let draw = |part: &KindPart, list: u32| match part.levels.get(list as usize / 2) {
            Some(range) => SceneDraw { indices: range.len() as u32, first_index: range.start, ..NOTHING },
            None => NOTHING,
        };
        let of_part = |part: &KindPart| (0..OBJECT_LISTS).map(|list| draw(part, list)).collect::<Vec<_>>();
        let draws = self.kind.parts().iter().flat_map(of_part).collect();
        Ok((vec![Drawable::Own(drawable)], draws))
    }

    /// Stages what the kind writes in a frame.
    pub fn stage(&mut self, staged: &mut Staged, frame: KindFrame) -> Result<(), Error> {
        self.kind.upload(&KindFrame { is_fresh: self.is_fresh, ..frame }, &mut KindUploads(staged))?;
        self.is_fresh = false;
        Ok(())
    }

    /// The first hit of an instance by a ray with a unit direction, up to a distance. `placed` leads from the model's space into
    /// that of the ray.
    pub fn hit(&self, placed: DAffine3, [at, direction]: [DVec3; 2], limit: f64) -> Option<SurfaceHit> {
        let into = placed.inverse();
        let ray = KindRay { origin: into.transform_point3(at), direction: into.transform_vector3(direction) };
        let hit = self.kind.hit(&ray).filter(|hit| (0.0..=limit).contains(&hit.distance))?;
        Some(SurfaceHit { distance: hit.distance, normal: into.matrix3.transpose() * hit.normal })
    }
}

fn check(kind: &dyn Kind) -> Result<(), InputError> {
    let errors = kind.errors();
    if !(1..=OBJECT_LEVELS as usize).contains(&errors.len()) {
        let bound = format!("must be in 1..={OBJECT_LEVELS}");
        return Err(InputError::new("kind.errors.len", errors.len(), bound));
    }
    if errors[0] != 0.0 {
        return Err(InputError::new("kind.errors[0]", errors[0], "must be 0"));
    }
    for (at, pair) in errors.windows(2).enumerate() {
        if !(pair[0] <= pair[1] && pair[1].is_finite()) {
            let bound = format!("must be finite and at least {}, the error before", pair[0]);
            return Err(InputError::new(format!("kind.errors[{}]", at + 1), pair[1], bound));
        }
    }
    let sphere = kind.bounding_sphere();
    // The comparison is false for NaN.
    if !(sphere.radius >= 0.0 && sphere.radius.is_finite() && sphere.center.is_finite()) {
        let value = format!("{} around {}", sphere.radius, sphere.center);
        let bound = "must be finite, with a radius of at least 0";
        return Err(InputError::new("kind.bounding_sphere", value, bound));
    }
    let draws = kind.parts().len() * errors.len();
    if !(1..=MAX_DRAWS).contains(&draws) {
        let bound = format!("must be at least 1, and times the number of levels at most {MAX_DRAWS}");
        return Err(InputError::new("kind.parts.len", kind.parts().len(), bound));
    }
    let indices = kind.indices();
    if !indices.usage().contains(wgpu::BufferUsages::INDEX) {
        let value = format!("{:?}", indices.usage());
        return Err(InputError::new("kind.indices.usage", value, "must have INDEX"));
    }
    let count = indices.size() / size_of::<u32>() as u64;
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
