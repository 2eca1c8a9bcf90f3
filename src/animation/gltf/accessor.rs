//! Accessors: numbers in buffers (glTF 2.0, section 3.6.2), sparse, interleaved or normalized.

use gltf_json::accessor::{Accessor, ComponentType, Type, sparse::Sparse};
use gltf_json::validation::Checked;
use gltf_json::{Index, buffer};

use super::document::Document;
use crate::InputError;

/// The most components of an accessor: without a buffer view, nothing else bounds what a file of some bytes asks for.
const MOST_COMPONENTS: u64 = 1 << 28;

/// How an accessor's elements lie in a buffer view.
#[derive(Clone, Copy)]
struct Shape {
    component: ComponentType,
    components: usize,
    count: usize,
}

impl Document<'_> {
    /// An accessor as vectors of `N` floats. Normalized integers become fractions.
    ///
    /// # Errors
    /// [`InputError`] with the path of what is wrong, for integers that are not normalized too.
    pub fn vectors<const N: usize>(&self, index: Index<Accessor>) -> Result<Vec<[f32; N]>, InputError> {
        let flat = self.floats(index, N)?;
        Ok(flat.chunks_exact(N).map(|chunk| std::array::from_fn(|at| chunk[at])).collect())
    }

    fn floats(&self, index: Index<Accessor>, components: usize) -> Result<Vec<f32>, InputError> {
        let path = format!("accessors[{}]", index.value());
        let accessor = self.root.accessors.get(index.value());
        let accessor = accessor.ok_or_else(|| InputError::new(&path, index.value(), "must exist"))?;
        let shape = shape(&path, accessor, components)?;
        let mut values = match accessor.buffer_view {
            Some(view) => {
                let offset = accessor.byte_offset.map_or(0, |offset| offset.0);
                self.elements(&format!("{path}.byteOffset"), view, offset, shape)?
            }
            None => vec![0.0; shape.count * components],
        };
        if let Some(sparse) = &accessor.sparse {
            self.replace(&format!("{path}.sparse"), sparse, shape, &mut values)?;
        }
        Ok(values)
    }

    /// Replaces the elements that a sparse accessor names.
    fn replace(
        &self,
        path: &str,
        sparse: &Sparse,
        shape: Shape,
        values: &mut [f32],
    ) -> Result<(), InputError> {
        let count =
            usize::try_from(sparse.count.0).ok().filter(|count| *count <= shape.count).ok_or_else(|| {
                let bound = format!("must be at most {}, the accessor's count", shape.count);
                InputError::new(format!("{path}.count"), sparse.count.0, bound)
            })?;
        let Checked::Valid(component) = sparse.indices.component_type else {
            return Err(InputError::new(
                format!("{path}.indices.componentType"),
                "invalid",
                "must be unsigned",
            ));
        };
        let of_indices = Shape { component: component.0, components: 1, count };
        let offset = sparse.indices.byte_offset.0;
        let at = format!("{path}.indices.byteOffset");
        let bytes = self.packed(&at, sparse.indices.buffer_view, offset, of_indices)?;
        let indices = bytes.chunks_exact(component.0.size()).map(|bytes| whole(component.0, bytes));
        let offset = sparse.values.byte_offset.0;
        let at = format!("{path}.values.byteOffset");
        let new = self.elements(&at, sparse.values.buffer_view, offset, Shape { count, ..shape })?;
        for (at, (index, new)) in indices.zip(new.chunks_exact(shape.components)).enumerate() {
            let index = index as usize;
            if index >= shape.count {
                let bound = format!("must be below {}, the accessor's count", shape.count);
                return Err(InputError::new(format!("{path}.indices[{at}]"), index, bound));
            }
            values[index * shape.components..][..shape.components].copy_from_slice(new);
        }
        Ok(())
    }

    fn elements(
        &self,
        path: &str,
        view: Index<buffer::View>,
        offset: u64,
        shape: Shape,
    ) -> Result<Vec<f32>, InputError> {
        let bytes = self.packed(path, view, offset, shape)?;
        Ok(bytes.chunks_exact(shape.component.size()).map(|bytes| float(shape.component, bytes)).collect())
    }

    /// The bytes of the elements, without what lies between them.
    fn packed(
        &self,
        path: &str,
        view: Index<buffer::View>,
        offset: u64,
        shape: Shape,
    ) -> Result<Vec<u8>, InputError> {
        let (bytes, stride) = self.view(view)?;
        let size = shape.components * shape.component.size();
        let stride = stride.unwrap_or(size);
        if stride < size {
            let bound = format!(
                "must be at least {size}, the size of an element of {}",
                path.split('.').next().unwrap_or_default()
            );
            return Err(InputError::new(format!("bufferViews[{}].byteStride", view.value()), stride, bound));
        }
        if shape.count == 0 {
            return Ok(Vec::new());
        }
        let needed = (shape.count - 1).checked_mul(stride).and_then(|bytes| bytes.checked_add(size));
        let slice = usize::try_from(offset).ok().and_then(|offset| bytes.get(offset..)?.get(..needed?));
        let slice = slice.ok_or_else(|| {
            let view = view.value();
            let bound =
                format!("{} elements must lie in bufferViews[{view}], {} bytes", shape.count, bytes.len());
            InputError::new(path, offset, bound)
        })?;
        Ok(slice.chunks(stride).flat_map(|element| &element[..size]).copied().collect())
    }
}

fn shape(path: &str, accessor: &Accessor, components: usize) -> Result<Shape, InputError> {
    let wanted = match components {
        1 => Type::Scalar,
        3 => Type::Vec3,
        4 => Type::Vec4,
        _ => Type::Mat4,
    };
    if accessor.type_ != Checked::Valid(wanted) {
        let found = match accessor.type_ {
            Checked::Valid(found) => format!("{found:?}"),
            Checked::Invalid => "unknown".to_owned(),
        };
        return Err(InputError::new(format!("{path}.type"), found, format!("must be {wanted:?} here")));
    }
    let Checked::Valid(component) = accessor.component_type else {
        return Err(InputError::new(format!("{path}.componentType"), "unknown", "must be one of glTF's"));
    };
    let component = component.0;
    let is_fraction = accessor.normalized && component.size() < 4 && components < 16;
    if component != ComponentType::F32 && !is_fraction {
        let bound = "must be 5126 (float) here, or normalized integers of 8 or 16 bits in vectors";
        return Err(InputError::new(format!("{path}.componentType"), component.as_gl_enum(), bound));
    }
    let count = accessor.count.0;
    if count.saturating_mul(components as u64) > MOST_COMPONENTS {
        let bound = format!("must be at most {}", MOST_COMPONENTS / components as u64);
        return Err(InputError::new(format!("{path}.count"), count, bound));
    }
    Ok(Shape { component, components, count: count as usize })
}

/// A component that stands for a number or, in integers, for a fraction (glTF 2.0, section 3.6.2.2).
fn float(component: ComponentType, bytes: &[u8]) -> f32 {
    match (component, bytes) {
        (ComponentType::I8, [byte, ..]) => (f32::from(*byte as i8) / 127.0).max(-1.0),
        (ComponentType::U8, [byte, ..]) => f32::from(*byte) / 255.0,
        (ComponentType::I16, [low, high, ..]) => {
            (f32::from(i16::from_le_bytes([*low, *high])) / 32_767.0).max(-1.0)
        }
        (ComponentType::U16, [low, high, ..]) => f32::from(u16::from_le_bytes([*low, *high])) / 65_535.0,
        (ComponentType::F32, [a, b, c, d, ..]) => f32::from_le_bytes([*a, *b, *c, *d]),
        // Never asked for: `shape` lets only the above pass.
        _ => f32::NAN,
    }
}

/// An index.
fn whole(component: ComponentType, bytes: &[u8]) -> u32 {
    match (component, bytes) {
        (ComponentType::U8, [byte, ..]) => u32::from(*byte),
        (ComponentType::U16, [low, high, ..]) => u32::from(u16::from_le_bytes([*low, *high])),
        (ComponentType::U32, [a, b, c, d, ..]) => u32::from_le_bytes([*a, *b, *c, *d]),
        // gltf-json knows no other type of indices; beyond every count.
        _ => u32::MAX,
    }
}
