//! The shadow of the sun: what the host's rays say, for each kind of surface, near the origin and far from it; the same
//! texels under a moving camera; and pictures without a shadow as before.

pub mod occluders;
mod panes;
mod stage;

use glam::{DMat4, Vec3};
use relievo::asset::Light;
use relievo::render::{Renderer, SunShadow};
use relievo::scene::{Camera, Placement, Quality, Scene, View};

use crate::frame::{Frame, device, devices};
use crate::harness::{Difference, Tolerance};
use crate::rays::matrix;
use crate::world::{SIZE, World, camera};
use occluders::{Occluders, Verdict};
use stage::{RANGE, SUN, Stage, models, numbers, values};

/// The crate's own shading.
const REPEATED: &str = "fn shade(surface: Surface, view: View) -> vec4<f32> {
    let direct = max(dot(surface.normal, view.light), 0.0) * surface.sunlit;
    return vec4<f32>(surface.color * view.light_color * (view.ambient + (1.0 - view.ambient) * direct), surface.alpha);
}";

/// How many pixels rays find lit, dark and at an edge, and how many of the first two are shown otherwise.
#[derive(Debug, Default, Clone, Copy)]
struct Tally {
    lit: usize,
    dark: usize,
    edge: usize,
    wrong: usize,
}

/// What `surface.sunlit` is, beside what rays say, for the pixels of an object. Surfaces that the light grazes get none of it.
fn tally(
    occluders: &Occluders,
    texel: f64,
    pixels: &[[Vec<[f32; 4]>; 2]],
    is_of: impl Fn([u32; 2]) -> Option<Option<[u32; 2]>>,
) -> Tally {
    let mut tally = Tally::default();
    for [places, normals] in pixels {
        for (place, normal) in places.iter().zip(normals) {
            let id = (normal[3] as u32 / 256, normal[3] as u32 % 256);
            let Some(own) = is_of([id.0, id.1]) else { continue };
            let sunlit = place[3];
            let [place, normal] = [place, normal].map(|found| Vec3::from_slice(found).as_dvec3());
            let cosine = normal.dot(occluders.light());
            if id.0 == 0 || cosine < 0.1 {
                continue;
            }
            // docs/shadows.md: what is looked up, and the texels that are filtered.
            let sine = (1.0 - cosine * cosine).max(0.0).sqrt();
            let offset = 8.0_f64.sqrt() * texel * (sine + 0.2).min(1.0);
            let is_right = match occluders.verdict((place, normal), [offset, 8.0_f64.sqrt() * texel], own) {
                Verdict::Edge => {
                    tally.edge += 1;
                    continue;
                }
                Verdict::Lit => {
                    tally.lit += 1;
                    sunlit > 0.99
                }
                Verdict::Dark => {
                    tally.dark += 1;
                    sunlit < 0.01
                }
            };
            tally.wrong += usize::from(!is_right);
        }
    }
    tally
}

/// Positions with the light that reaches them, and normals with numbers.
const PLACES: &str = "vec4<f32>(surface.position, surface.sunlit)";
const NORMALS: &str = "vec4<f32>(surface.geometric_normal, f32(256u * surface.object + surface.instance))";

fn texel(shadow: &SunShadow) -> f64 {
    let camera = shadow.camera().expect("fitted");
    2.0 / f64::from(camera.clip_from_view.x_axis.x) / f64::from(camera.viewport[0])
}

/// Tallies of ground, characters, boxes, tetrahedra and the wall.
fn tallies(stage: &Stage, occluders: &Occluders, pixels: &[Vec<[f32; 4]>; 2]) -> [Tally; 5] {
    let object = |at: usize| stage.solids[at].0.object().number();
    let wall = numbers(stage.wall.0);
    let all = [stage.world.land.number(), stage.world.creature.number(), object(0), object(2), wall[0]];
    all.map(|number| {
        // The light inside the relief is the relief's own business.
        let own = (number == wall[0]).then_some(wall);
        let is_of = |id: [u32; 2]| (id[0] == number).then_some(own);
        tally(occluders, texel(&stage.shadow), std::slice::from_ref(pixels), is_of)
    })
}

/// Every kind of surface lies in the shadow of everything that casts, mirrored or not, inside the eye's view and outside of it,
/// and of nothing else.
#[test]
fn shadows_are_where_the_hosts_rays_say() {
    let gpu = device();
    let mut stage = Stage::new(&gpu, 2048);
    let outside = numbers(stage.solids[0].0);
    for all_cast in [true, false] {
        if !all_cast {
            for instance in stage.world.crowd.iter().chain([&stage.solids[0].0]) {
                stage.world.scene.set_casts_shadow(*instance, false).expect("there");
            }
        }
        let pixels = [PLACES, NORMALS].map(|expression| stage.values(&gpu, expression));
        let numbered = |pixel: &[f32; 4]| [pixel[3] as u32 / 256, pixel[3] as u32 % 256];
        assert!(pixels[1].iter().all(|pixel| numbered(pixel) != outside), "it is outside of the view");
        let crowd = stage.world.crowd.clone();
        let is_there = |instance| all_cast || !crowd.contains(&instance) && numbers(instance) != outside;
        let occluders = stage.occluders(is_there);
        let found = tallies(&stage, &occluders, &pixels);
        println!("{found:#?}");
        for (at, Tally { lit, dark, edge, wrong }) in found.into_iter().enumerate() {
            // Texels on the edges of triangles may belong to either.
            assert!(1000 * wrong <= 2 * (lit + dark), "{at}: {wrong} of {lit} lit and {dark} dark");
            assert!(lit >= 40 && (dark >= 20 || !all_cast), "{at}: {lit} lit, {dark} dark");
            assert!(3 * edge <= lit + dark, "{at}: {edge} at edges of {lit} and {dark}");
        }
        // The comparison sees what is wrong: another sun, and casters that are not there.
        let mut other = Occluders::new((SUN + Vec3::new(0.1, 0.0, 0.0)).as_dvec3());
        stage.add_casters(&mut other, |_| true);
        let found = tallies(&stage, &other, &pixels);
        assert!(found.iter().any(|tally| 100 * tally.wrong > tally.lit + tally.dark), "{found:?}");
        let found = tallies(&stage, &stage.occluders(|instance| !is_there(instance)), &pixels);
        assert!(found.iter().any(|tally| 100 * tally.wrong > tally.lit + tally.dark), "{found:?}");
    }
}

/// The mask of the sun leaves out what shares no bit with it.
#[test]
fn casters_are_those_of_the_mask() {
    let gpu = device();
    let mut stage = Stage::new(&gpu, 512);
    let all = stage.values(&gpu, PLACES);
    for instance in &stage.world.crowd {
        stage.world.scene.set_visibility_mask(*instance, 1).expect("there");
    }
    stage.shadow.set_mask(2);
    let masked = stage.values(&gpu, PLACES);
    stage.shadow.set_mask(u16::MAX);
    for instance in &stage.world.crowd {
        stage.world.scene.set_visibility_mask(*instance, u16::MAX).expect("there");
        stage.world.scene.set_casts_shadow(*instance, false).expect("there");
    }
    let left_out = stage.values(&gpu, PLACES);
    assert!(masked == left_out, "a mask leaves out others than the flag");
    assert!(masked != all, "nothing was left out");
}

/// A plate, boxes above it, and a camera, around the corner of a cell.
fn plate(gpu: &relievo::gpu::Gpu, cell: [i32; 3]) -> (Scene, View, Vec<(Placement, [u32; 2])>) {
    let mut scene = Scene::new(gpu).expect("compiled");
    scene.set_light(Light { direction: SUN, ..Light::default() }).expect("a light");
    let boxes = scene.add_mesh(&models().0, 4).expect("added");
    let at = |place: [f32; 3], scale: Vec3| Placement { scale, ..Placement::at(place).turned(0.3) };
    let places = [
        at([10.0, -1.0, 10.0], Vec3::new(30.0, 0.5, 30.0)),
        at([6.0, 3.0, 7.0], Vec3::splat(1.2)),
        at([12.0, 2.0, 10.0], Vec3::new(0.4, 2.4, 0.4)),
        at([2.0, 16.0, 12.0], Vec3::new(-1.5, 1.0, 2.0)),
    ];
    let spawned = places.map(|place| {
        let far = Placement { cell, ..place };
        (place, numbers(scene.spawn(boxes, far).expect("room")))
    });
    let mut view = scene.view(Quality::pixels(0.0)).expect("a view");
    let eye =
        Camera::looking_at(Vec3::new(14.0, 12.0, 26.0), Vec3::new(9.0, 0.0, 8.0), 0.9, [0.5, 400.0], SIZE);
    view.set(Camera { cell, ..eye }).expect("a camera");
    (scene, view, spawned.to_vec())
}

/// A million units from the origin, shadows are as near to it.
#[test]
fn shadows_far_from_the_origin_are_where_rays_say() {
    let gpu = device();
    for cell in [[0; 3], [3906, 2, -3906]] {
        let (mut scene, mut view, places) = plate(&gpu, cell);
        let mut shadow = SunShadow::new(&mut scene, 1024).expect("a shadow");
        let mut of = |expression| values(&gpu, (&mut scene, &mut view, &mut shadow), expression);
        let pixels = [of(PLACES), of(NORMALS)];
        let mut occluders = Occluders::new(SUN.as_dvec3());
        for (place, number) in &places {
            let into: DMat4 = matrix(place);
            occluders.add_model(&models().0, into, *number);
        }
        let found = tally(&occluders, texel(&shadow), &[pixels], |_| Some(None));
        println!("{cell:?}: {found:?}");
        let Tally { lit, dark, edge, wrong } = found;
        assert!(lit > 3000 && dark > 300 && 3 * edge < lit + dark, "{found:?}");
        assert!(1000 * wrong <= 2 * (lit + dark), "{found:?}");
    }
}

/// While a camera that the map is fitted to moves and turns, what another one shows stays what it is.
#[test]
fn shadows_stay_where_they_are_while_the_camera_moves() {
    let gpu = device();
    let mut stage = Stage::new(&gpu, 1024);
    let frame = Frame::plain(&gpu, SIZE);
    let mut renderer = Renderer::new(&gpu, &frame.format).expect("a format");
    renderer.prepare(&stage.world.scene).expect("compiled");
    let mut moving = stage.world.view(0.0);
    let mut shot = |stage: &mut Stage, camera: Camera| {
        moving.set(camera).expect("a camera");
        stage.shadow.fit(&stage.world.scene, &mut [&mut stage.view, &mut moving], RANGE).expect("fitted");
        stage.draw(&gpu, &frame, &renderer);
        (frame.read(&gpu), *stage.shadow.camera().expect("fitted"))
    };
    let still =
        Camera::looking_at(Vec3::new(3.0, 12.0, 16.0), Vec3::new(0.0, 2.0, -6.0), 0.9, [0.5, 400.0], SIZE);
    let (first, sun) = shot(&mut stage, still);
    let (mut compared, mut moved) = (0, 0);
    for at in 1..9 {
        let t = 0.13 * at as f32;
        let eye = Vec3::new(3.0 + t, 12.0 + 0.3 * t, 16.0 - 0.7 * t);
        let to = Vec3::new(0.9 * t, 2.0, -6.0);
        let (picture, other) = shot(&mut stage, Camera::looking_at(eye, to, 0.9, [0.5, 400.0], SIZE));
        // In larger steps, texels have another size.
        if other.clip_from_view == sun.clip_from_view {
            compared += 1;
            moved += usize::from(other.view_from_cell != sun.view_from_cell);
            let off = |(a, b): (&image::Rgba<u8>, &image::Rgba<u8>)| {
                a.0.iter().zip(b.0).any(|(a, b)| a.abs_diff(b) > 2)
            };
            let wrong = first.pixels().zip(picture.pixels()).filter(|pair| off(*pair)).count();
            println!("{at}: {wrong} pixels");
            // A texel whose middle lies on an edge may change hands.
            assert!(wrong <= 12, "{wrong} pixels after {at} steps");
        }
    }
    assert!(compared >= 4 && moved >= 4, "{compared}, {moved}");
    // Half a texel beside its grid, shadows would crawl; so does a light that turns.
    stage
        .world
        .scene
        .set_light(Light { direction: SUN + Vec3::X * 0.003, ..Light::default() })
        .expect("a light");
    let (turned, _) = shot(&mut stage, still);
    let found = Difference::of(&turned, &first, 2);
    assert!(found.outliers > 50.0 / f64::from(SIZE[0] * SIZE[1]), "{found:?}");
}

/// The crate's shading is one that multiplies the direct light by `surface.sunlit`; and a view without a shadow shows what a
/// scene without one does.
#[test]
fn own_shading_is_in_the_same_shadow_and_views_may_be_without() {
    let gpu = device();
    let mut stage = Stage::new(&gpu, 1024);
    let own = stage.shot(&gpu, None);
    let repeated = stage.shot(&gpu, Some(REPEATED));
    let same = Tolerance { levels: 1, outliers: 0.0, flip: 0.0005 };
    let found = Difference::of(&own, &repeated, same.levels);
    assert!(found.within(same), "{found:?}");
    let lit = stage.shot(&gpu, Some(&REPEATED.replace(" * surface.sunlit", "")));
    assert!(!Difference::of(&own, &lit, same.levels).within(same), "no shadow");
    // Without the shadow: the same scene, and another that never had one.
    let frame = Frame::plain(&gpu, SIZE);
    let renderer = frame.renderer(&gpu, &stage.world.scene);
    stage.view.clear_shadow();
    stage.draw(&gpu, &frame, &renderer);
    let cleared = frame.read(&gpu);
    let found = Difference::of(&cleared, &lit, same.levels);
    assert!(found.within(same), "{found:?}");
    let [mut world, mut never] = [true, false].map(|has_shadow| {
        let mut world = World::new(&gpu, 6);
        if has_shadow {
            drop(SunShadow::new(&mut world.scene, 64).expect("a shadow"));
        }
        world
    });
    let shots = [&mut world, &mut never].map(|world| {
        let (renderer, mut view) = (frame.renderer(&gpu, &world.scene), world.view(1.0));
        frame.shot(&mut world.scene, &mut view, &renderer)
    });
    let found = Difference::of(&shots[0], &shots[1], same.levels);
    assert!(found.within(same), "{found:?}");
}

/// On another device everything is as it was.
#[test]
fn shadows_outlive_a_device() {
    let [gpu, other] = devices();
    let mut stage = Stage::new(&gpu, 512);
    let before = stage.shot(&gpu, None);
    stage.world.scene.rebuild(&other).expect("rebuilt");
    stage.view.rebuild(&stage.world.scene).expect("rebuilt");
    let refused = stage.shadow.fit(&stage.world.scene, &mut [&mut stage.view], RANGE);
    let refused = refused.expect_err("of the lost device").to_string();
    assert!(refused.starts_with("shadow = ") && refused.contains("SunShadow::rebuild"), "{refused}");
    stage.shadow.rebuild(&stage.world.scene).expect("rebuilt");
    assert!(stage.shot(&other, None) == before, "another picture");
}

#[test]
fn what_is_wrong_about_a_shadow_is_refused_by_name() {
    let gpu = device();
    let mut world = World::new(&gpu, 1);
    let other = World::new(&gpu, 1);
    for size in [0, 15, 1 << 20] {
        let refused = SunShadow::new(&mut world.scene, size).expect_err("refused").to_string();
        assert!(refused.starts_with(&format!("size = {size}")), "{refused}");
    }
    let frame = Frame::plain(&gpu, SIZE);
    let early = frame.renderer(&gpu, &world.scene);
    let mut shadow = SunShadow::new(&mut world.scene, 64).expect("a shadow");
    let mut view = world.view(1.0);
    let mut refused = |views: &mut [&mut View], range: f32| {
        shadow.fit(&world.scene, views, range).expect_err("refused").to_string()
    };
    for range in [0.0, -1.0, f32::NAN, f32::INFINITY, 0.05, 0.4] {
        let error = refused(&mut [&mut view], range);
        assert!(error.starts_with(&format!("range = {range}: ")), "{error}");
    }
    assert!(refused(&mut [], 9.0).starts_with("views = none"));
    assert!(refused(&mut [&mut other.view(1.0)], 9.0).starts_with("views[0]"));
    let mut blind = world.scene.view(Quality::default()).expect("a view");
    assert!(refused(&mut [&mut view, &mut blind], 9.0).starts_with("views[1].camera"));
    let mut five: Vec<View> = (0..5).map(|_| world.view(1.0)).collect();
    assert!(refused(&mut five.iter_mut().collect::<Vec<_>>(), 9.0).starts_with("cameras.len = 5"));
    // A renderer that was prepared before the shadow was there.
    view.set(camera(SIZE)).expect("a camera");
    let mut encoder = gpu.encoder("frame");
    world.scene.record(&mut encoder, &mut [&mut view]).expect("recorded");
    frame.pass(&mut encoder, |pass| {
        let error = early.draw(pass, &world.scene, &view, relievo::render::Layer::Color);
        let error = error.expect_err("refused").to_string();
        assert!(error.contains("Renderer::prepare") && error.contains("SunShadow"), "{error}");
    });
}
