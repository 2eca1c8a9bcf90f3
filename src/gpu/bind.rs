//! Typed resources that the generated bindings use; see `gpu::bindings`.

use std::marker::PhantomData;

use super::Buffer;

/// The names that the generated bindings import.
pub(crate) mod prelude {
    pub(crate) use super::Slice;
    pub(crate) use crate::gpu::{
        Buffer, Gpu, GpuError, Group as BindGroup, Kernel, Layouts, Uniform, shaders,
    };
}

/// A storage buffer to bind in a bind group, with its element type.
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
    /// Returns the whole buffer as a resource to bind.
    pub fn resource(&self) -> wgpu::BindingResource<'a> {
        self.raw.as_entire_binding()
    }

    /// Returns the same bytes as elements of type `U`, the type that a shader declares. The size of one type must be a multiple
    /// of the other's.
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

/// A type whose bytes a shader may read as elements of `U`, for example a matrix as its rows.
pub trait SeenAs<U> {}

// A shader may read a matrix as its rows.
impl<const N: usize> SeenAs<[f32; 4]> for [[f32; 4]; N] {}
// A shader may read a vector as its components.
impl<const N: usize> SeenAs<f32> for [f32; N] {}
// A shader may read consecutive scalars as vectors.
impl SeenAs<[u32; 4]> for u32 {}
impl SeenAs<[f32; 4]> for f32 {}
impl SeenAs<[i32; 4]> for i32 {}
impl SeenAs<[i32; 4]> for [i32; 2] {}
// A shader may read floats as their bit patterns.
impl SeenAs<[u32; 4]> for [f32; 4] {}
impl<const N: usize> SeenAs<[u32; 4]> for [[f32; 4]; N] {}
impl SeenAs<u32> for f32 {}
impl SeenAs<i32> for u32 {}
impl<const N: usize> SeenAs<u32> for [f32; N] {}

impl<T> Buffer<T> {
    /// Returns the buffer as a resource to bind.
    pub fn slice(&self) -> Slice<'_, T> {
        Slice { raw: &self.raw, element: PhantomData }
    }
}

impl<T: bytemuck::Pod> Buffer<T> {
    /// Returns a handle to the same buffer with elements of another type; see [`Slice::cast`].
    pub fn cast<U>(&self) -> Buffer<U>
    where
        T: SeenAs<U>,
    {
        self.slice().cast::<U>();
        self.of_elements()
    }
}
