//! Reads accessors: arrays of numbers in buffers (glTF 2.0, section 3.6.2). They may be sparse, interleaved or normalized.
//! Values are read as floats, or as integers for joints and indices.

use gltf_json::accessor::{Accessor, ComponentType, Type, sparse::Sparse};
use gltf_json::{Index, buffer};

use super::document::Document;
use super::draco::Decompressed;
use crate::InputError;

/// Layout of an accessor's elements in a buffer view.
#[derive(Clone, Copy)]
struct Shape {
    component: ComponentType,
    components: usize,
    count: usize,
    is_normalized: bool,
}

/// The component types that are permitted where an accessor is used.
#[derive(Clone, Copy, PartialEq)]
enum Kind {
    /// Floats, and normalized integers, which encode fractions.
    Fraction,
    /// Floats, normalized integers, and 8- or 16-bit integers that stand for themselves (`KHR_mesh_quantization`).
    Quantized,
    /// Unsigned integers, for joints and indices.
    Whole,
}

/// Converts the raw number of a component to a value.
type Decode<T> = fn(Shape, f64) -> T;

/// Elements of an accessor. They lie in a buffer view, or in a compressed primitive.
pub struct Elements<'d, 'a> {
    pub document: &'d Document<'a>,
    pub accessor: Index<Accessor>,
    /// The compressed primitive that holds the elements, and the name of their attribute. `None` if the elements lie in a
    /// buffer view.
    pub compressed: Option<(&'d Decompressed<'d>, String)>,
}

impl Elements<'_, '_> {
    /// Reads the elements as vectors of `N` floats. Normalized integers become fractions.
    ///
    /// # Errors
    /// [`InputError`] with the path of the fault in the file; also for integers that are not normalized.
    pub fn vectors<const N: usize>(self) -> Result<Vec<[f32; N]>, InputError> {
        self.read(Kind::Fraction, float)
    }

    /// Reads the elements as single floats. Normalized integers become fractions.
    ///
    /// # Errors
    /// The errors of [`Elements::vectors`].
    pub fn floats(self) -> Result<Vec<f32>, InputError> {
        Ok(self.vectors::<1>()?.into_flattened())
    }

    /// Reads the elements of a vertex attribute as vectors of `N` floats. Normalized integers become fractions; other 8- or
    /// 16-bit integers keep their values.
    ///
    /// # Errors
    /// [`InputError`] with the path of the fault in the file.
    pub fn attributes<const N: usize>(self) -> Result<Vec<[f32; N]>, InputError> {
        self.read(Kind::Quantized, float)
    }

    /// Reads the elements as vectors of `N` unsigned integers.
    ///
    /// # Errors
    /// [`InputError`] with the path of the fault in the file; also for floats and normalized integers.
    pub fn integers<const N: usize>(self) -> Result<Vec<[u32; N]>, InputError> {
        self.read(Kind::Whole, |_, number| number as u32)
    }

    fn read<const N: usize, T: Copy + Default>(
        self,
        kind: Kind,
        decode: Decode<T>,
    ) -> Result<Vec<[T; N]>, InputError> {
        let Self { document, accessor, compressed } = self;
        let path = format!("accessors[{}]", accessor.value());
        let accessor = &document.root.accessors[accessor.value()];
        let shape = shape(&path, accessor, N, kind)?;
        let values = compressed.map(|(primitive, name)| primitive.attribute(&name, N)).transpose()?.flatten();
        let values = match values {
            Some(values) => values.into_iter().map(|number| decode(shape, number.into())).collect(),
            None => document.values(&path, accessor, shape, decode)?,
        };
        Ok(values.as_chunks().0.to_vec())
    }
}

impl<'a> Document<'a> {
    /// Returns a reader for the elements of an accessor in its buffer view.
    pub fn elements(&self, accessor: Index<Accessor>) -> Elements<'_, 'a> {
        Elements { document: self, accessor, compressed: None }
    }

    /// Reads all components of the accessor at `path`. Without a buffer view, they are zeros. Replacements of a sparse accessor
    /// are applied.
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
                self.decoded(path, view, offset, shape, decode)?
            }
            None => vec![T::default(); shape.count * shape.components],
        };
        if let Some(sparse) = &accessor.sparse {
            self.replace(&format!("{path}.sparse"), sparse, shape, &mut values, decode)?;
        }
        Ok(values)
    }

    /// Charges the accessor's elements to the budget before they are read.
    fn count(&self, path: &str, accessor: &Accessor, shape: Shape) -> Result<(), InputError> {
        match accessor.buffer_view {
            // Reading the view adds its buffer's bytes to the budget.
            Some(view) => drop(self.view(view)?),
            None => self.budget.check_zeros(path, shape.count as u64)?,
        }
        // A matrix counts as four vectors.
        self.budget.spend(path, shape.count.saturating_mul(shape.components.div_ceil(4)))
    }

    /// Overwrites the elements that a sparse accessor replaces.
    fn replace<T: Copy>(
        &self,
        path: &str,
        Sparse { count, indices, values: new, .. }: &Sparse,
        shape: Shape,
        values: &mut [T],
        decode: Decode<T>,
    ) -> Result<(), InputError> {
        let count = usize::try_from(count.0).ok().filter(|count| *count <= shape.count).ok_or_else(|| {
            let bound = format!("must be at most {}, the accessor's count", shape.count);
            InputError::new(format!("{path}.count"), count.0, bound)
        })?;
        let component = indices.component_type.unwrap().0;
        let path_of = |field: &str| format!("{path}.{field}");
        let (view, offset) = (indices.buffer_view, indices.byte_offset.0);
        let of_indices = Shape { component, components: 1, count, is_normalized: false };
        let indices =
            self.decoded(&path_of("indices"), view, offset, of_indices, |_, number| number as usize)?;
        let (view, offset) = (new.buffer_view, new.byte_offset.0);
        let new = self.decoded(&path_of("values"), view, offset, Shape { count, ..shape }, decode)?;
        for (at, (index, new)) in indices.into_iter().zip(new.chunks_exact(shape.components)).enumerate() {
            if index >= shape.count {
                let bound = format!("must be below {}, the accessor's count", shape.count);
                return Err(InputError::new(format!("{path}.indices[{at}]"), index, bound));
            }
            values[index * shape.components..][..shape.components].copy_from_slice(new);
        }
        Ok(())
    }

    /// Reads the components of elements that begin at an offset in a buffer view. `path` names the object that states the
    /// offset.
    fn decoded<T>(
        &self,
        path: &str,
        view: Index<buffer::View>,
        offset: u64,
        shape: Shape,
        decode: Decode<T>,
    ) -> Result<Vec<T>, InputError> {
        let (bytes, stride) = self.view(view)?;
        let size = shape.components * shape.component.size();
        let stride = stride.unwrap_or(size);
        if stride < size {
            let accessor = path.split('.').next().unwrap_or_default();
            let bound = format!("must be at least {size}, the size of an element of {accessor}");
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
            InputError::new(format!("{path}.byteOffset"), offset, bound)
        })?;
        let mut values = Vec::with_capacity(shape.count * shape.components);
        for element in slice.chunks(stride) {
            let components = element[..size].chunks_exact(shape.component.size());
            values.extend(components.map(|bytes| decode(shape, number(shape.component, bytes))));
        }
        Ok(values)
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
    let (found, component) = (accessor.type_.unwrap(), accessor.component_type.unwrap().0);
    if found != wanted {
        let bound = format!("must be {wanted:?} here");
        return Err(InputError::new(format!("{path}.type"), format!("{found:?}"), bound));
    }
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

/// Returns the number that the bytes of a component encode.
fn number(component: ComponentType, bytes: &[u8]) -> f64 {
    match (component, bytes) {
        (ComponentType::I8, [a]) => (*a as i8).into(),
        (ComponentType::U8, [a]) => (*a).into(),
        (ComponentType::I16, [a, b]) => i16::from_le_bytes([*a, *b]).into(),
        (ComponentType::U16, [a, b]) => u16::from_le_bytes([*a, *b]).into(),
        (ComponentType::U32, [a, b, c, d]) => u32::from_le_bytes([*a, *b, *c, *d]).into(),
        (ComponentType::F32, [a, b, c, d]) => f32::from_le_bytes([*a, *b, *c, *d]).into(),
        // Unreachable: the slice is as long as the component type.
        _ => f64::NAN,
    }
}

/// Value of a component: the number itself or, for normalized integers, a fraction (glTF 2.0, section 3.6.2.2).
fn float(shape: Shape, number: f64) -> f32 {
    let one = match shape.component {
        ComponentType::I8 => 127.0,
        ComponentType::U8 => 255.0,
        ComponentType::I16 => 32_767.0,
        ComponentType::U16 => 65_535.0,
        ComponentType::U32 | ComponentType::F32 => return number as f32,
    };
    if shape.is_normalized { (number as f32 / one).max(-1.0) } else { number as f32 }
}
