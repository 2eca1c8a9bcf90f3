//! Compares the methods on a map that the caller supplies, without a device.

use std::cell::Cell;

use relievo::ops::surface::{Green, HeightMap, March, Mips, ReliefMaterial, ReliefMethod, ReliefShadow};
use relievo_lab::measure::relief::{Comparison, ReliefSquare, SquareView};

/// Ridges along v, one texel wide, between furrows a quarter as high.
fn square(size: [u32; 2]) -> ReliefSquare {
    let heights = (0..256).map(|texel| if texel % 2 == 0 { 1.0 } else { 0.25 }).collect();
    let stone = image::RgbaImage::from_pixel(1, 1, image::Rgba([168, 160, 150, 255]));
    ReliefSquare {
        map: HeightMap::new(16, 16, heights).expect("a map"),
        albedo: Mips::of_color(stone),
        normals: None,
        green: Green::Up,
        shadow: ReliefShadow::None,
        silhouette: false,
        march: March::default(),
        material: ReliefMaterial::default(),
        view: SquareView { angle: 60.0, azimuth: 90.0, tiles: 1.0, size },
    }
}

#[test]
fn every_method_is_measured_at_every_angle() {
    let heard = Cell::new(0);
    let progress = |_, all| heard.set(heard.get() + usize::from(all > 0));
    let comparison = square([24, 20]).compare(None, &progress).expect("measured");
    let Comparison { entries, backend, map, .. } = &comparison;
    assert_eq!((*backend, *map, heard.get()), ("cpu", [16, 16], entries.len()));
    for angle in Comparison::ANGLES {
        for method in ReliefMethod::ALL {
            let here: Vec<_> =
                entries.iter().filter(|entry| entry.angle == angle && entry.method == method).collect();
            assert_eq!(here.len(), if method.is_stepped() { 8 } else { 1 }, "{method:?}");
            assert!(
                here.iter()
                    .all(|entry| entry.measured.rays > 0 && entry.steps.is_some() == method.is_stepped())
            );
        }
    }
    let error = |method: ReliefMethod, angle: f64| {
        let found = entries.iter().find(|entry| entry.method == method && entry.angle == angle);
        found.expect("measured").measured.mean_error_texels
    };
    // Seen from straight above, all methods are right. At an angle, texture coordinates without relief are far off, and
    // those of the exact patches are not.
    assert!(error(ReliefMethod::Plain, 0.0) < 1e-3 && error(ReliefMethod::Quadtree, 60.0) < 1e-2);
    assert!(error(ReliefMethod::Plain, 60.0) > 0.5, "{}", error(ReliefMethod::Plain, 60.0));
    let table = comparison.table();
    assert_eq!(table.lines().filter(|line| line.contains("° | ")).count(), entries.len() + 4);
}

#[test]
fn a_view_of_nothing_is_refused() {
    let steps = Cell::new(0);
    let count = |_: &str| steps.set(steps.get() + 1);
    let drawn = square([24, 20]).draw(ReliefMethod::Quadtree, None, [0.0; 3], 2, &count).expect("drawn");
    assert_eq!((drawn.picture.dimensions(), drawn.rays.len(), drawn.hits.len()), ((24, 20), 480, 480));
    assert_eq!(steps.get(), 4);
    let mut flat = square([1, 1]);
    (flat.view.angle, flat.view.azimuth) = (89.99, 45.0);
    // The ray through the center of the only pixel meets the middle of the square at every angle.
    assert!(flat.draw(ReliefMethod::Plain, None, [0.0; 3], 1, &count).is_ok());
    flat.view.size = [2, 2];
    let refused = flat.draw(ReliefMethod::Plain, None, [0.0; 3], 1, &count).expect_err("nothing is seen");
    assert!(refused.to_string().starts_with("angle = 89.99"), "{refused}");
}
