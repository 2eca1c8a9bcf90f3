//! The pictures of the layers of a scene.

use image::{ImageBuffer, Luma, Rgb, Rgba, RgbaImage};
use relievo::Error;
use relievo::render::Layer;
use relievo_lab::files::Staged;
use relievo_lab::measure::Player;
use serde::Serialize;

/// What the ends of the range of a picture mean.
#[derive(Debug, Default, Serialize)]
pub struct Extremes {
    /// Of depth, the distances of white and nearly black.
    #[serde(skip_serializing_if = "Option::is_none")]
    nearest: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    farthest: Option<f64>,
    /// Of velocity, the pixels of the ends.
    #[serde(skip_serializing_if = "Option::is_none")]
    fastest: Option<f32>,
}

/// Writes the pictures of the last frame, whose names begin with `name`.
pub fn write(player: &Player, name: &str, staged: &mut Staged) -> Result<Extremes, Error> {
    match player.rendering().layer {
        Layer::Depth => depth(player, name, staged),
        Layer::Velocity => velocity(player, name, staged),
        Layer::Surface => surface(player, name, staged),
        _ => {
            staged.write_png(format!("{name}.png"), &player.picture()?)?;
            Ok(Extremes::default())
        }
    }
}

/// Distances as brightness.
fn depth(player: &Player, name: &str, staged: &mut Staged) -> Result<Extremes, Error> {
    let distances = player.distances()?;
    let there = || distances.iter().copied().flatten();
    let [nearest, farthest] = [there().reduce(f64::min), there().reduce(f64::max)];
    let brightness = |distance: Option<f64>| {
        let (Some(distance), Some(near), Some(far)) = (distance, nearest, farthest) else { return 0 };
        let part = (distance - near) / (far - near).max(f64::MIN_POSITIVE);
        // Nothing is black, the farthest nearly.
        (65_535.0 - 64_000.0 * part).round() as u16
    };
    let [width, height] = player.rendering().size;
    let image = ImageBuffer::<Luma<u16>, _>::from_fn(width, height, |x, y| {
        Luma([brightness(distances[(y * width + x) as usize])])
    });
    staged.write_png(format!("{name}.png"), &image)?;
    Ok(Extremes { nearest, farthest, ..Extremes::default() })
}

/// Motion to the right as red and downwards as green.
fn velocity(player: &Player, name: &str, staged: &mut Staged) -> Result<Extremes, Error> {
    let velocities = player.velocities()?;
    let fastest = velocities.iter().flatten().flatten().fold(0.0_f32, |most, axis| most.max(axis.abs()));
    let channel =
        |pixels: f32| (32_768.0 + 32_767.0 * pixels / fastest.max(f32::MIN_POSITIVE)).round() as u16;
    let [width, height] = player.rendering().size;
    let image = ImageBuffer::<Rgb<u16>, _>::from_fn(width, height, |x, y| {
        let velocity = velocities[(y * width + x) as usize];
        Rgb(velocity.map_or([0; 3], |[right, down]| [channel(right), channel(down), 32_768]))
    });
    staged.write_png(format!("{name}.png"), &image)?;
    Ok(Extremes { fastest: Some(fastest), ..Extremes::default() })
}

/// Normals, colours before light, and numbers.
fn surface(player: &Player, name: &str, staged: &mut Staged) -> Result<Extremes, Error> {
    let surfaces = player.surfaces()?;
    let [width, height] = player.rendering().size;
    let at = |x: u32, y: u32| surfaces[(y * width + x) as usize].as_ref();
    let normals = RgbaImage::from_fn(width, height, |x, y| {
        let byte = |axis: f32| (127.5 + 127.5 * axis).round() as u8;
        let [r, g, b] = at(x, y).map_or([0; 3], |surface| surface.normal.map(byte));
        Rgba([r, g, b, 255])
    });
    let albedo = RgbaImage::from_fn(width, height, |x, y| {
        let [r, g, b] = at(x, y).map_or([0; 3], |surface| surface.albedo);
        Rgba([r, g, b, 255])
    });
    let numbers = ImageBuffer::<Rgb<u16>, _>::from_fn(width, height, |x, y| {
        let [object, instance] = at(x, y).map_or([0; 2], |surface| surface.numbers);
        // The lower 16 bits.
        Rgb([object as u16, instance as u16, 0])
    });
    staged.write_png(format!("{name}.png"), &normals)?;
    staged.write_png(format!("{name}_albedo.png"), &albedo)?;
    staged.write_png(format!("{name}_id.png"), &numbers)?;
    Ok(Extremes::default())
}
