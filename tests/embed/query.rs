//! Queries of the host: rays and boxes, against these tests' own rays and what is drawn.

use glam::{DVec3, Quat, Vec3};
use relievo::scene::{Camera, Hit, InstanceId, Placement, Ray, Scene};

use crate::frame::{Frame, device};
use crate::host;
use crate::world::{SIZE, World, camera, model};

/// The nearest hit of any instance of the crowd or of the ground, by a search through all triangles and a march along the ray.
fn expected(
    world: &World,
    ray: &Ray,
    triangles: &[(InstanceId, Vec<[DVec3; 3]>)],
) -> Option<(f64, Option<InstanceId>)> {
    let direction = ray.direction.normalize();
    let hits = triangles.iter().filter_map(|(instance, triangles)| {
        let (distance, _) = host::nearest(triangles, ray.world(), direction)?;
        Some((distance, Some(*instance)))
    });
    let crowd = hits.reduce(|one, other| if other.0 < one.0 { other } else { one });
    let above = |distance: f64| {
        let at = ray.world() + distance * direction;
        let ground = world.scene.ground(world.land, at.x, at.z).expect("terrain")?;
        Some(at.y - ground.height)
    };
    let step = 0.01;
    let mut last = None;
    for at in 0..20_000 {
        let distance = step * f64::from(at);
        if crowd.is_some_and(|(nearest, _)| nearest < distance) {
            return crowd;
        }
        let here = above(distance);
        if let (Some(before), Some(now)) = (last, here)
            && before > 0.0
            && now <= 0.0
        {
            return Some((distance - step * now / (now - before), None));
        }
        last = here;
    }
    crowd
}

/// Rays through the pixels of a picture hit what they must, and what is drawn there.
#[test]
fn rays_hit_what_is_drawn() {
    let gpu = device();
    let mut world = World::new(&gpu, 10);
    let mirrored = Placement { scale: Vec3::new(-4.0, 3.0, 3.0), ..world.placement(3) };
    world.scene.move_to(world.crowd[3], mirrored).expect("there");
    let mut triangles: Vec<_> = (world.crowd.iter())
        .map(|instance| (*instance, host::triangles(&world.scene, &model(), *instance)))
        .collect();
    // A mirrored surface has its other side outside.
    triangles[3].1.iter_mut().for_each(|corners| corners.swap(0, 1));
    let frame = Frame::plain(&gpu, SIZE);
    let mut view = world.view(0.0);
    let renderer = frame.renderer(&gpu, &world.scene);
    let picture = frame.shot(&mut world.scene, &mut view, &renderer);
    let sky = *picture.get_pixel(0, 0);
    let (mut rays, mut of_crowd, mut otherwise) = (0, 0, 0);
    for (x, y) in (0..SIZE[1]).step_by(5).flat_map(|y| (0..SIZE[0]).step_by(5).map(move |x| (x, y))) {
        let ray = Ray::through(&camera(SIZE), [x as f32 + 0.5, y as f32 + 0.5]).expect("a pixel");
        let hit = world.scene.pick(&ray).expect("a ray");
        rays += 1;
        otherwise += u32::from(hit.is_none() != (*picture.get_pixel(x, y) == sky));
        let right = expected(&world, &ray, &triangles);
        match (hit, right) {
            (Some(hit), Some((distance, instance))) if (hit.distance - distance).abs() < 2e-3 => {
                of_crowd += u32::from(instance.is_some());
                let object = if instance.is_some() { world.creature } else { world.land };
                assert_eq!(
                    (hit.object, instance.unwrap_or(hit.instance)),
                    (object, hit.instance),
                    "{x}, {y}"
                );
                check(&hit, &ray);
            }
            (None, None) => {}
            // An edge, where rounding decides; there may be few.
            _ => otherwise += 1,
        }
    }
    assert!(rays > 900 && of_crowd > 40 && otherwise <= 6, "{otherwise} of {rays}, {of_crowd} of the crowd");
}

fn check(hit: &Hit, ray: &Ray) {
    let along = ray.direction.normalize();
    assert!(hit.world().distance(ray.world() + hit.distance * along) < 1e-9);
    assert!((hit.normal.length() - 1.0).abs() < 1e-9 && hit.normal.dot(along) < 0.0);
}

/// Rays end at their limit, see through hidden objects and masked instances, and work far from the origin.
#[test]
fn rays_have_limits_and_masks() {
    let gpu = device();
    let mut scene = Scene::new(&gpu).expect("compiled");
    let creature = scene.add_character(&model(), 1).expect("added");
    let statue = scene.add_mesh(&model(), 1).expect("added");
    let cell = [3_906_250, 0, -3_906_250];
    let at = |z: f32| Placement { cell, offset: Vec3::new(128.0, 0.0, z), ..Placement::default() };
    let front = scene.spawn(creature, at(100.0)).expect("room");
    let back = scene.spawn(statue, at(40.0)).expect("room");
    let ray = Ray { cell, ..Ray::new([128.0, 1.0, 200.0], [0.0, 0.0, -2.0]) };
    let first = |scene: &Scene, ray: &Ray| scene.pick(ray).expect("a ray");
    let hit = first(&scene, &ray).expect("the creature");
    assert_eq!((hit.instance, hit.object), (front, creature));
    assert!((99.0..101.0).contains(&(200.0 - hit.distance)), "{}", hit.distance);
    let bounds = scene.bounds(front).expect("there");
    let [low, high] = bounds.world();
    assert!(bounds.cell == cell && (low.cmple(hit.world()) & hit.world().cmple(high)).all());
    let neighbour = Ray { cell: [cell[0] - 1, 0, cell[2]], offset: ray.offset + DVec3::X * 256.0, ..ray };
    let same = first(&scene, &neighbour).expect("the creature");
    assert!((same.distance - hit.distance).abs() < 1e-9);
    assert_eq!(first(&scene, &Ray { limit: hit.distance - 0.01, ..ray }), None);
    assert_eq!(first(&scene, &Ray { offset: ray.offset + DVec3::Y * 90.0, ..ray }), None);
    scene.set_visibility_mask(front, 0b10).expect("there");
    assert_eq!(first(&scene, &Ray { mask: 0b01, ..ray }).map(|hit| hit.instance), Some(back));
    assert_eq!(first(&scene, &Ray { mask: 0b11, ..ray }).map(|hit| hit.instance), Some(front));
    scene.set_visible(creature, false).expect("there");
    assert_eq!(first(&scene, &ray).map(|hit| hit.instance), Some(back));
    scene.despawn(back).expect("there");
    assert_eq!(first(&scene, &ray), None);
    assert_eq!(scene.bounds(back).expect_err("refused").path, "instance");
    assert_eq!(scene.pick(&Ray { offset: DVec3::NAN, ..ray }).expect_err("refused").path, "ray.offset");
    // Towards the statue from a camera that looks at it.
    let looking =
        Camera::looking_at(Vec3::new(0.0, 1.0, 9.0), Vec3::new(0.0, 1.0, 0.0), 0.5, [0.1, 90.0], SIZE);
    let back = scene.spawn(statue, Placement::default()).expect("room");
    let middle = Ray::through(&looking, SIZE.map(|size| size as f32 / 2.0)).expect("a pixel");
    assert_eq!(first(&scene, &middle).map(|hit| hit.instance), Some(back));
}

/// Boxes hold every vertex of the posed surface; that of a mesh at rest is the smallest.
#[test]
fn boxes_hold_what_is_posed() {
    let gpu = device();
    let mut world = World::new(&gpu, 5);
    let turned = Placement {
        turn: Quat::from_rotation_x(0.4) * Quat::from_rotation_y(2.0),
        scale: Vec3::new(-2.0, 5.0, 1.0),
        ..world.placement(0)
    };
    world.scene.move_to(world.crowd[0], turned).expect("there");
    let mut low_of = Vec::new();
    for seconds in [0.0, 0.31, 0.29] {
        world.scene.advance(seconds).expect("finite");
        for instance in &world.crowd {
            let bounds = world.scene.bounds(*instance).expect("there");
            let [lower, higher] = bounds.world();
            let corners = host::triangles(&world.scene, &model(), *instance);
            let corners = || corners.iter().flatten().copied();
            let [low, high] =
                [corners().reduce(DVec3::min), corners().reduce(DVec3::max)].map(|of| of.expect("some"));
            assert!(lower.cmple(low).all() && high.cmple(higher).all(), "{bounds:?} {low} {high}");
            let size = (higher - lower).length() / (high - low).length();
            assert!(size < 1.7, "{size} times as large as necessary");
            assert!(size > 1.02, "the other box is tight");
            let tight = world.scene.tight_bounds(*instance).expect("there").world();
            // A part in a hundred thousand for rounding, of a box that is smaller than 40 units.
            let off = [tight[0] - low, tight[1] - high].map(|off| off.abs().max_element());
            assert!(off[0].max(off[1]) < 1e-3 && tight[0].cmple(low + 1e-4).all(), "{tight:?} {low} {high}");
            low_of.push(lower);
        }
    }
    assert!(low_of[2] != low_of[7], "it moves");
    let statue = world.scene.add_mesh(&model(), 1).expect("added");
    let instance = world.scene.spawn(statue, turned).expect("room");
    let bounds = world.scene.bounds(instance).expect("there");
    let corners = model().meshes.iter().map(|mesh| mesh.positions.len()).sum::<usize>();
    let [low, high] = bounds.world();
    let size = high - low;
    assert!(corners > 0 && size.min_element() > 1.0 && size.max_element() < 40.0, "{size}");
    let patch = world.scene.instances(world.land).expect("terrain")[4];
    let around = world.scene.bounds(patch).expect("there").world();
    let [low, high] = world.scene.tight_bounds(patch).expect("there").world();
    assert!(around[0].cmplt(low).all() && high.cmplt(around[1]).all(), "{around:?} {low} {high}");
    let points = (0..=32).flat_map(|row| (0..=32).map(move |column| [column, row].map(f64::from)));
    let heights =
        points.map(|[x, z]| world.scene.ground(world.land, x, z).expect("terrain").expect("there").height);
    let [lowest, highest] = heights.fold([f64::MAX, f64::MIN], |[low, high], at| [low.min(at), high.max(at)]);
    let off = [low - DVec3::new(0.0, lowest, 0.0), high - DVec3::new(32.0, highest, 32.0)];
    assert!(off.iter().all(|off| off.abs().max_element() < 1e-3), "{off:?}");
}
