//! Accessors: arrays of numbers in buffers (glTF 2.0, section 3.6.2), which may be sparse, interleaved or
//! normalized. Values are read as floats, or as integers for joints and indices.

use gltf_json::accessor::{Accessor, ComponentType, Type, sparse::Sparse};
use gltf_json::validation::Checked;
use gltf_json::{Index, buffer};

use super::document::Document;
use super::draco::Decompressed;
use crate::InputError;

/// How an accessor's elements lie in a buffer view.
#[derive(Clone, Copy)]
struct Shape {
    component: ComponentType,
    components: usize,
    count: usize,
    is_normalized: bool,
}

/// The component types that a use of an accessor permits.
#[derive(Clone, Copy, PartialEq)]
enum Kind {
    /// Floats, and normalized integers, which stand for fractions.
    Fraction,
    /// Those, and 8- or 16-bit integers as they are (`KHR_mesh_quantization`).
    Quantized,
    /// Unsigned integers.
    Whole,
}

type Decode<T> = fn(Shape, &[u8]) -> T;

/// The elements of an accessor: in a buffer view, or in a compressed primitive.
#[derive(Clone, Copy)]
pub struct Elements<'d, 'a> {
    pub document: &'d Document<'a>,
    pub accessor: Index<Accessor>,
    /// The compressed primitive, and which of its attributes the accessor describes.
    pub compressed: Option<(&'d Decompressed<'d>, &'d str)>,
}

impl Elements<'_, '_> {
    /// Reads them as vectors of `N` floats. Normalized integers become fractions.
    ///
    /// # Errors
    /// [`InputError`] with the path of the fault in the file; integers that are not normalized are a fault too.
    pub fn vectors<const N: usize>(self) -> Result<Vec<[f32; N]>, InputError> {
        self.read(Kind::Fraction, float)
    }

    /// Reads a vertex attribute: as [`Elements::vectors`], and also integers of 8 or 16 bits, as their values.
    ///
    /// # Errors
    /// [`InputError`] with the path of the fault in the file.
    pub fn attributes<const N: usize>(self) -> Result<Vec<[f32; N]>, InputError> {
        self.read(Kind::Quantized, float)
    }

    /// Reads them as vectors of `N` unsigned integers.
    ///
    /// # Errors
    /// [`InputError`] with the path of the fault in the file; floats and normalized integers are a fault too.
    pub fn integers<const N: usize>(self) -> Result<Vec<[u32; N]>, InputError> {
        self.read(Kind::Whole, |shape, bytes| whole(shape.component, bytes))
    }

    fn read<const N: usize, T: Copy + Default>(
        self,
        kind: Kind,
        decode: Decode<T>,
    ) -> Result<Vec<[T; N]>, InputError> {
        let Self { document, accessor: index, compressed } = self;
        let path = format!("accessors[{}]", index.value());
        let accessor = document.root.accessors.get(index.value());
        let accessor = accessor.ok_or_else(|| InputError::new(&path, index.value(), "must exist"))?;
        let shape = shape(&path, accessor, N, kind)?;
        let values = match compressed {
            Some((primitive, name)) => primitive.attribute(name, shape.component, N)?,
            None => None,
        };
        let values = match values {
            Some(bytes) => {
                bytes.chunks_exact(shape.component.size()).map(|bytes| decode(shape, bytes)).collect()
            }
            None => document.values(&path, accessor, shape, decode)?,
        };
        Ok(values.chunks_exact(N).map(|chunk| std::array::from_fn(|at| chunk[at])).collect())
    }
}

impl<'a> Document<'a> {
    /// An accessor's elements in its buffer view.
    pub fn elements(&self, accessor: Index<Accessor>) -> Elements<'_, 'a> {
        Elements { document: self, accessor, compressed: None }
    }

    /// The components of an accessor at `path`, from its buffer view or zeros, with those that a sparse one replaces.
    fn values<T: Copy + Default>(
        &self,
        path: &str,
        accessor: &Accessor,
        shape: Shape,
        decode: Decode<T>,
    ) -> Result<Vec<T>, InputError> {
        self.count(&format!("{path}.count"), accessor, shape)?;
        let mut values = match accessor.buffer_view {
            Some(view) => {
                let offset = accessor.byte_offset.map_or(0, |offset| offset.0);
                self.decoded(&format!("{path}.byteOffset"), view, offset, shape, decode)?
            }
            None => vec![T::default(); shape.count * shape.components],
        };
        if let Some(sparse) = &accessor.sparse {
            self.replace(&format!("{path}.sparse"), sparse, shape, &mut values, decode)?;
        }
        Ok(values)
    }

    /// Charges the elements to the budget before they are read.
    fn count(&self, path: &str, accessor: &Accessor, shape: Shape) -> Result<(), InputError> {
        match accessor.buffer_view {
            // The bytes of the view's buffer add to the budget.
            Some(view) => drop(self.view(view)?),
            None => self.budget.check_zeros(path, shape.count as u64)?,
        }
        // A matrix counts as four vectors.
        self.budget.spend(path, shape.count.saturating_mul(shape.components.div_ceil(4)))
    }

    /// Replaces the elements that a sparse accessor lists.
    fn replace<T: Copy>(
        &self,
        path: &str,
        sparse: &Sparse,
        shape: Shape,
        values: &mut [T],
        decode: Decode<T>,
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
        let of_indices = Shape { component: component.0, components: 1, count, is_normalized: false };
        let offset = sparse.indices.byte_offset.0;
        let at = format!("{path}.indices.byteOffset");
        let bytes = self.packed(&at, sparse.indices.buffer_view, offset, of_indices)?;
        let indices = bytes.chunks_exact(component.0.size()).map(|bytes| whole(component.0, bytes));
        let offset = sparse.values.byte_offset.0;
        let at = format!("{path}.values.byteOffset");
        let new = self.decoded(&at, sparse.values.buffer_view, offset, Shape { count, ..shape }, decode)?;
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

    fn decoded<T>(
        &self,
        path: &str,
        view: Index<buffer::View>,
        offset: u64,
        shape: Shape,
        decode: Decode<T>,
    ) -> Result<Vec<T>, InputError> {
        let bytes = self.packed(path, view, offset, shape)?;
        Ok(bytes.chunks_exact(shape.component.size()).map(|bytes| decode(shape, bytes)).collect())
    }

    /// The bytes of the elements, without the bytes between them.
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

fn shape(path: &str, accessor: &Accessor, components: usize, kind: Kind) -> Result<Shape, InputError> {
    let wanted = match components {
        1 => Type::Scalar,
        2 => Type::Vec2,
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
    let is_small = component.size() < 4 && components < 16;
    let is_unsigned = matches!(component, ComponentType::U8 | ComponentType::U16 | ComponentType::U32);
    let (fits, bound) = match kind {
        Kind::Fraction => (
            component == ComponentType::F32 || accessor.normalized && is_small,
            "must be 5126 (float) here, or normalized integers of 8 or 16 bits in vectors",
        ),
        Kind::Quantized => (
            component == ComponentType::F32 || is_small,
            "must be 5126 (float) here, or integers of 8 or 16 bits",
        ),
        Kind::Whole => (is_unsigned && !accessor.normalized, "must be unsigned here, and not normalized"),
    };
    if !fits {
        return Err(InputError::new(format!("{path}.componentType"), component.as_gl_enum(), bound));
    }
    let count = usize::try_from(accessor.count.0).unwrap_or(usize::MAX);
    Ok(Shape { component, components, count, is_normalized: accessor.normalized })
}

/// The value of a component: the number itself or, for normalized integers, a fraction (glTF 2.0, section
/// 3.6.2.2).
fn float(shape: Shape, bytes: &[u8]) -> f32 {
    let (value, one) = match (shape.component, bytes) {
        (ComponentType::I8, [byte, ..]) => (f32::from(*byte as i8), 127.0),
        (ComponentType::U8, [byte, ..]) => (f32::from(*byte), 255.0),
        (ComponentType::I16, [low, high, ..]) => (f32::from(i16::from_le_bytes([*low, *high])), 32_767.0),
        (ComponentType::U16, [low, high, ..]) => (f32::from(u16::from_le_bytes([*low, *high])), 65_535.0),
        (ComponentType::F32, [a, b, c, d, ..]) => return f32::from_le_bytes([*a, *b, *c, *d]),
        // Not reached: `shape` accepts only the types above.
        _ => return f32::NAN,
    };
    if shape.is_normalized { (value / one).max(-1.0) } else { value }
}

/// The value of an index component.
fn whole(component: ComponentType, bytes: &[u8]) -> u32 {
    match (component, bytes) {
        (ComponentType::U8, [byte, ..]) => u32::from(*byte),
        (ComponentType::U16, [low, high, ..]) => u32::from(u16::from_le_bytes([*low, *high])),
        (ComponentType::U32, [a, b, c, d, ..]) => u32::from_le_bytes([*a, *b, *c, *d]),
        // Not reached: gltf-json knows no other type of index. The value exceeds every count.
        _ => u32::MAX,
    }
}
