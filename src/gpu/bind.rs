//! The parts from which generated bindings are built; see `gpu::bindings`.

use std::marker::PhantomData;

use super::Buffer;

/// The names that generated code uses.
pub(crate) mod prelude {
    pub(crate) use super::Slice;
    pub(crate) use crate::gpu::{
        Buffer, Gpu, GpuError, Group as BindGroup, Kernel, Layouts, Uniform, shaders,
    };
}

/// A storage buffer to bind, by the type of its elements.
#[derive(Debug)]
pub struct Slice<'a, T> {
    raw: &'a wgpu::Buffer,
    element: PhantomData<T>,
}

impl<T> Clone for Slice<'_, T> {
    fn clone(&self) -> Self {
        *self
    }
}

impl<T> Copy for Slice<'_, T> {}

impl<'a, T> Slice<'a, T> {
    /// The whole buffer.
    pub fn resource(&self) -> wgpu::BindingResource<'a> {
        self.raw.as_entire_binding()
    }

    /// The same bytes as elements of the type that a shader sees. The size of one type must be a multiple of the
    /// other's.
    pub fn cast<U>(self) -> Slice<'a, U>
    where
        T: SeenAs<U>,
    {
        const {
            let (from, to) = (size_of::<T>(), size_of::<U>());
            assert!(from.is_multiple_of(to) || to.is_multiple_of(from), "elements do not fit each other");
        }
        Slice { raw: self.raw, element: PhantomData }
    }
}

/// What a shader may see as elements of `U`, which have the same bytes: rows of a matrix, say.
pub trait SeenAs<U> {}

// Rows.
impl<const N: usize> SeenAs<[f32; 4]> for [[f32; 4]; N] {}
// Components.
impl<const N: usize> SeenAs<f32> for [f32; N] {}
// Vectors of what lies one after another.
impl SeenAs<[u32; 4]> for u32 {}
impl SeenAs<[f32; 4]> for f32 {}
impl SeenAs<[i32; 4]> for i32 {}
impl SeenAs<[i32; 4]> for [i32; 2] {}
// Bits.
impl SeenAs<[u32; 4]> for [f32; 4] {}
impl<const N: usize> SeenAs<[u32; 4]> for [[f32; 4]; N] {}
impl SeenAs<u32> for f32 {}
impl SeenAs<i32> for u32 {}
impl<const N: usize> SeenAs<u32> for [f32; N] {}

impl<T> Buffer<T> {
    /// The buffer as a resource to bind.
    pub fn slice(&self) -> Slice<'_, T> {
        Slice { raw: &self.raw, element: PhantomData }
    }
}

impl<T: bytemuck::Pod> Buffer<T> {
    /// The same buffer with elements of the type that a shader sees, as [`Slice::cast`].
    pub fn cast<U>(&self) -> Buffer<U>
    where
        T: SeenAs<U>,
    {
        self.slice().cast::<U>();
        self.of_elements()
    }
}
