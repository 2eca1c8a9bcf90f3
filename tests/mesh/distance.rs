//! Distances between surfaces, compared with dense samples.

use glam::DVec3;
use relievo::ops::mesh::{Cost, SimplifyOptions as Limits};
use relievo_lab::distance::{Distance, DistanceOptions, OneWay, Triangles, distance};

use crate::measure;
use crate::shapes::{Shape, bare, bumps, cube, ground, sheet, shuffled, sphere, torus};

/// Few samples: the largest distance does not depend on them.
const FEW: DistanceOptions = DistanceOptions { tolerance: 0.01, samples: 2000 };

fn triangles<'a>(shape: &'a Shape, indices: &'a [u32]) -> Triangles<'a> {
    Triangles { positions: &shape.poses[0], indices }
}

fn between(a: &Shape, b: &Shape, options: &DistanceOptions) -> Distance {
    distance(&triangles(a, &a.indices), &triangles(b, &b.indices), options).expect("valid")
}

/// The corners of triangles.
fn corners(triangles: &Triangles<'_>) -> Vec<[DVec3; 3]> {
    let place = |index: u32| glam::Vec3::from(triangles.positions[index as usize]).as_dvec3();
    triangles.indices.as_chunks::<3>().0.iter().map(|triangle| triangle.map(place)).collect()
}

/// Root mean square and largest distance of samples of `from` from `to`, found by trying every triangle: (`steps` + 1)(`steps` + 2)/2
/// of each triangle, and then 40 times as many along each axis around the furthest; and the largest distance of the corners
/// alone.
fn dense(from: &Triangles<'_>, to: &Triangles<'_>, steps: u32) -> [f64; 3] {
    let (from, to) = (corners(from), corners(to));
    let far = |p: DVec3| {
        let squares = to.iter().map(|triangle| p.distance_squared(measure::nearest(p, triangle)));
        squares.fold(f64::INFINITY, f64::min)
    };
    let (mut seen, mut most_of_corners, mut sum, mut weights) = (Vec::new(), 0.0_f64, 0.0, 0.0);
    let n = f64::from(steps);
    for [a, b, c] in &from {
        most_of_corners = [*a, *b, *c].map(far).into_iter().fold(most_of_corners, f64::max);
        // The middles of equal triangles for the mean, and their corners for the largest.
        let (right, up) = ((*b - *a) / n, (*c - *a) / n);
        let weight = right.cross(up).length();
        for row in 0..=steps {
            for column in 0..=steps - row {
                let at =
                    |shift: f64| *a + right * (f64::from(column) + shift) + up * (f64::from(row) + shift);
                seen.push((far(at(0.0)), at(0.0), [right, up], [column, row]));
                for (count, shift) in [(1, 1.0 / 3.0), (2, 2.0 / 3.0)] {
                    if column + row + count <= steps {
                        (sum, weights) = (sum + weight * far(at(shift)), weights + weight);
                    }
                }
            }
        }
    }
    let coarse = seen.iter().map(|(far, ..)| *far).fold(0.0, f64::max);
    seen.retain(|(far, ..)| *far >= 0.8 * coarse);
    seen.sort_by(|a, b| b.0.total_cmp(&a.0));
    let mut most = coarse;
    for (_, place, [right, up], [column, row]) in seen.into_iter().take(60) {
        for (x, y) in
            (-20..=20).flat_map(|x| (-20..=20).map(move |y| (f64::from(x) / 20.0, f64::from(y) / 20.0)))
        {
            let [u, v] = [f64::from(column) + x, f64::from(row) + y];
            if u >= 0.0 && v >= 0.0 && u + v <= n {
                most = most.max(far(place + right * x + up * y));
            }
        }
    }
    [(sum / weights).sqrt(), most.sqrt(), most_of_corners.sqrt()]
}

/// What is wrong with a distance, given dense samples of the same direction.
fn wrong(found: &OneWay, dense: [f64; 3]) -> Option<String> {
    let [rms, most, _] = dense;
    let is_rounding = found.max < 1e-9;
    let faults = [
        (found.max < most * (1.0 - 1e-9) - 1e-12, "below the samples'"),
        (found.max > 1.02 * most && !is_rounding, "more than 2 % above the samples'"),
        (found.reached > found.max, "reached more than the largest"),
        (found.max > 1.0101 * found.reached && !is_rounding, "far above what was reached"),
        ((found.rms - rms).abs() > 0.01 * rms && !is_rounding, "another root mean square"),
        ((found.rms - rms).abs() > found.rms_within, "a root mean square further off than it says"),
        (found.rms > found.max * (1.0 + 1e-9), "a root mean square above the largest"),
    ];
    let (_, what) = faults.into_iter().find(|(is_wrong, _)| *is_wrong)?;
    Some(format!("{what}: {found:?}, samples {dense:?}"))
}

/// Checks both directions between two shapes against samples at `steps` of each.
fn check(name: &str, a: &Triangles<'_>, b: &Triangles<'_>, steps: [u32; 2]) -> Distance {
    let found = distance(a, b, &DistanceOptions { samples: 60_000, ..FEW }).expect(name);
    for (found, dense) in [(&found.forward, dense(a, b, steps[0])), (&found.backward, dense(b, a, steps[1]))]
    {
        if let Some(fault) = wrong(found, dense) {
            panic!("{name}: {fault}");
        }
    }
    let back = distance(b, a, &DistanceOptions { samples: 60_000, ..FEW }).expect(name);
    assert_eq!((back.forward, back.backward), (found.backward, found.forward), "{name}");
    found
}

#[test]
fn simplified_meshes_are_as_far_as_dense_samples_say() {
    let shapes = [
        ("ground", ground(10, bumps)),
        ("sphere", sphere(14, 8)),
        ("torus", torus(16, 8)),
        ("cube", cube(4)),
    ];
    for (name, shape) in shapes {
        for (cost, share) in
            [(Cost::Quadric, 0.4), (Cost::Quadric, 0.1), (Cost::Melax { check_normals: false }, 0.25)]
        {
            let limit = (shape.triangles() as f64 * share) as usize;
            let simplified = shape.simplified(&Limits { cost, triangles: limit, ..Limits::default() });
            let coarse = simplified.triangles(&shape.indices, simplified.collapses().len());
            let name = format!("{name} {cost:?} {share}");
            check(&name, &triangles(&shape, &shape.indices), &triangles(&shape, &coarse), [20, 40]);
        }
    }
}

/// Triangles without connection, of all shapes, near and far, with thin ones among them.
#[test]
fn loose_triangles_too() {
    for seed in 0..8 {
        let noise = |count: usize, salt: u64| -> Vec<[f32; 3]> {
            let order = shuffled(3 * count, seed * 100 + salt);
            (0..count)
                .map(|at| [0, 1, 2].map(|axis| order[3 * at + axis] as f32 / (3 * count) as f32))
                .collect()
        };
        let soup = |count: usize, size: f32, salt: u64| {
            let (middles, edges) = (noise(count, salt), noise(3 * count, salt + 1));
            let flat = if salt == 1 { [1.0, 1.0, 0.02] } else { [1.0; 3] };
            let place = |at: usize| {
                let axis = |axis: usize| middles[at / 3][axis] + size * flat[axis] * (edges[at][axis] - 0.5);
                [0, 1, 2].map(axis)
            };
            bare((0..3 * count).map(place).collect(), (0..3 * count as u32).collect())
        };
        let (a, b) = (soup(9, 0.8, 1), soup(14, 0.3 + 0.1 * seed as f32, 5));
        check(&format!("seed {seed}"), &triangles(&a, &a.indices), &triangles(&b, &b.indices), [50, 50]);
    }
}

#[test]
fn equal_and_coplanar_surfaces_have_no_distance() {
    let shape = sphere(40, 20);
    let found = between(&shape, &shape, &FEW);
    assert!(found.max() < 1e-14 && found.rms() < 1e-14, "{found:?}");
    // A slanted plane, divided in two ways that have nothing in common, turned so that nothing is exact.
    let plane = |cells: usize| {
        sheet([cells, cells], |x, y| {
            let [x, y] = [x, y].map(|at| at as f64 / cells as f64);
            [x, 0.25 * x + 0.5 * y, y]
        })
    };
    let found = between(&plane(7), &plane(64), &FEW);
    // Positions are rounded to single precision.
    assert!(found.max() < 1e-7 && found.rms() < 1e-7, "{found:?}");
}

/// Distances that are known exactly.
#[test]
fn known_distances() {
    let plane = |cells: usize, height: f64| ground(cells, |_, _| height);
    let found = between(&plane(3, 0.0), &plane(50, 0.125), &FEW);
    for way in [found.forward, found.backward] {
        assert!((0.125..0.126_3).contains(&way.max) && (way.rms - 0.125).abs() < 1e-9, "{way:?}");
    }
    // A ridge over a flat square: √2/2 · ½ away at the top, linear from there. Seen from the square, the furthest points lie
    // inside of triangles, and no vertex is off at all: in the middle of the ridge, ½ · cos 45°.
    let ridge = ground(2, |x, _| if x == 0.5 { 0.5 } else { 0.0 });
    let flat = plane(1, 0.0);
    let found = between(&ridge, &flat, &DistanceOptions::default());
    assert!((0.5..0.505).contains(&found.forward.max), "{found:?}");
    assert!((found.forward.rms - 0.5 / 3.0_f64.sqrt()).abs() < 1e-6, "{found:?}");
    let sine = 0.5_f64.sqrt();
    assert!((0.5 * sine..0.505 * sine).contains(&found.backward.max), "{found:?}");
    let by_corners = dense(&triangles(&flat, &flat.indices), &triangles(&ridge, &ridge.indices), 1)[2];
    assert_eq!(by_corners, 0.0);
    // Far from the origin, and of any size.
    for scale in [1e-6_f32, 1.0, 1e6] {
        let placed = |shape: &Shape| {
            let places = shape.poses[0].iter().map(|place| place.map(|x| scale * (x + 16.0)));
            bare(places.collect(), shape.indices.clone())
        };
        let found = between(&placed(&ridge), &placed(&flat), &FEW);
        assert!((found.max() / f64::from(scale) - 0.5).abs() < 0.006, "{found:?}");
    }
}

/// A comparison by vertices only, and results that are off by a few percent, are found.
#[test]
fn planted_faults_are_found() {
    let shape = ground(10, bumps);
    let simplified = shape.simplified(&Limits { triangles: 20, ..Limits::default() });
    let coarse = simplified.triangles(&shape.indices, simplified.collapses().len());
    let (fine, coarse) = (triangles(&shape, &shape.indices), triangles(&shape, &coarse));
    let samples = dense(&coarse, &fine, 40);
    let right =
        distance(&fine, &coarse, &DistanceOptions { samples: 60_000, ..FEW }).expect("valid").backward;
    assert_eq!(wrong(&right, samples), None);
    // The corners of the coarse mesh lie on the fine one.
    assert_eq!(samples[2], 0.0);
    let planted: [(&str, OneWay); 5] = [
        ("below the samples'", OneWay { max: samples[2], ..right }),
        ("below the samples'", OneWay { max: 0.99 * right.reached, ..right }),
        ("more than 2 %", OneWay { max: 1.04 * right.max, ..right }),
        ("another root", OneWay { rms: 1.02 * right.rms, ..right }),
        ("further off than it says", OneWay { rms_within: 0.0, ..right }),
    ];
    for (words, planted) in planted {
        let fault = wrong(&planted, samples).unwrap_or_default();
        assert!(fault.contains(words), "{words}: {fault:?}");
    }
}

#[test]
fn threads_change_nothing() {
    let shape = sphere(60, 30);
    let simplified = shape.simplified(&Limits { triangles: 150, ..Limits::default() });
    let coarse = simplified.triangles(&shape.indices, simplified.collapses().len());
    let of = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("a pool");
        let found =
            pool.install(|| distance(&triangles(&shape, &shape.indices), &triangles(&shape, &coarse), &FEW));
        found.expect("valid")
    };
    assert_eq!(of(1), of(5));
}

/// Surfaces without area are points and lines.
#[test]
fn surfaces_without_area_have_distances() {
    let line = bare(vec![[0.0; 3], [1.0, 0.0, 0.0], [2.0, 0.0, 0.0]], vec![0, 1, 2]);
    let point = bare(vec![[0.0, 3.0, 0.0]], vec![0, 0, 0]);
    let found = between(&line, &point, &FEW);
    let most = 13.0_f64.sqrt();
    assert!((most..1.0101 * most).contains(&found.forward.max), "{found:?}");
    assert!(
        (3.0..3.0301).contains(&found.backward.max) && (found.backward.rms - 3.0).abs() < 1e-12,
        "{found:?}"
    );
}

#[test]
fn what_cannot_be_measured_is_refused() {
    let positions = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
    let good = Triangles { positions: &positions, indices: &[0, 1, 2] };
    let refused = |from: &Triangles<'_>, to: &Triangles<'_>, options: &DistanceOptions| {
        let error = distance(from, to, options).expect_err("refused");
        (error.path, error.value)
    };
    let text = |path: &str, value: &str| (path.to_owned(), value.to_owned());
    let all = DistanceOptions::default();
    assert_eq!(refused(&Triangles { indices: &[], ..good }, &good, &all), text("from.indices.len", "0"));
    assert_eq!(refused(&good, &Triangles { indices: &[0, 1], ..good }, &all), text("to.indices.len", "2"));
    assert_eq!(refused(&good, &Triangles { indices: &[0, 1, 3], ..good }, &all), text("to.indices[2]", "3"));
    let mut wrong = positions;
    wrong[1][2] = f32::NAN;
    assert_eq!(
        refused(&Triangles { positions: &wrong, ..good }, &good, &all),
        text("from.positions[1][2]", "NaN")
    );
    for tolerance in [0.0, 1.5, f64::NAN] {
        let path = refused(&good, &good, &DistanceOptions { tolerance, ..all }).0;
        assert_eq!(path, "options.tolerance");
    }
    assert_eq!(refused(&good, &good, &DistanceOptions { samples: 0, ..all }), text("options.samples", "0"));
}
