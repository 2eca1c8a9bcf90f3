//! Every comparator of these cases fails on planted faults.

use relievo::ops::lod::select::reference::{merged, word};

use crate::cases::lod::select::*;

/// What the reference writes.
fn right(scene: &Scene, view: &SelectView, allowed: &[Allowed]) -> Found {
    let count = scene.instances.len();
    let placements = last_placements(&scene.instances);
    let decisions = last_decisions(count);
    let mut found =
        Found { allowed: allowed.to_vec(), metrics: vec![POISON; count], placements: placements.clone() };
    for (index, before) in allowed.iter().enumerate() {
        let Some(object) = scene.object_of(view, index) else { continue };
        let instance = &scene.instances[index];
        let last = (decisions[index] != 0).then_some(&placements[index]);
        let selected = select(view, object, instance, last);
        let before = (view.is_first == 0).then_some(*before);
        found.allowed[index] = merged(before, selected.as_ref());
        found.metrics[index] = word(selected.as_ref(), instance);
        if let Some(selected) = selected {
            found.placements[index] = selected.placement;
        }
    }
    found
}

fn untouched() -> Allowed {
    Allowed { displacement: f32::from_bits(POISON), distance: f32::from_bits(POISON) }
}

fn scene_and_view() -> (Scene, SelectView) {
    let [(_, view), ..] = frame().expect("valid");
    (Scene::new(7, &[3, 2]), SelectView { blocks: 7, ..view })
}

/// Which comparisons fail.
fn faults(scene: &Scene, view: &SelectView, found: &Found) -> Vec<&'static str> {
    let mut state = vec![State::Untouched; scene.instances.len()];
    let compared = found.compared(scene, view, &mut state);
    compared.into_iter().filter(|(_, comparison)| !comparison.holds).map(|(what, _)| what).collect()
}

#[test]
fn what_is_wrong_of_one_instance_is_seen() {
    let (scene, view) = scene_and_view();
    let count = scene.instances.len();
    let right = right(&scene, &view, &vec![untouched(); count]);
    assert_eq!(faults(&scene, &view, &right), Vec::<&str>::new());
    let own = |index: &usize| scene.object_of(&view, *index).is_some();
    let first = |is: &dyn Fn(u32) -> bool| {
        (0..count).filter(own).find(|index| is(right.metrics[*index])).expect("some")
    };
    let seen = first(&|word| word != UNSEEN_METRIC);
    let unseen = first(&|word| word == UNSEEN_METRIC);
    let foreign = (0..count).find(|index| !own(index)).expect("some");
    let with = |change: &dyn Fn(&mut Found)| {
        let mut found = right.clone();
        change(&mut found);
        faults(&scene, &view, &found)
    };
    assert_eq!(with(&|found| found.metrics[seen] ^= 1 << 31), ["metrics"]);
    assert_eq!(with(&|found| found.metrics[seen] += 1 << 20), ["metrics"]);
    assert_eq!(with(&|found| found.metrics[unseen] = 1)[0], "metrics");
    assert_eq!(with(&|found| found.metrics[foreign] ^= 1), ["metrics"]);
    assert_eq!(with(&|found| found.placements[seen][1][3] += 1e-3), ["placements"]);
    assert_eq!(with(&|found| found.placements[seen][0][0] = f32::NAN), ["placements"]);
    assert_eq!(with(&|found| found.placements[unseen][0][0] += 1.0), ["placements"]);
    assert_eq!(with(&|found| found.allowed[seen].displacement *= 1.02), ["allowed"]);
    assert_eq!(with(&|found| found.allowed[seen].distance += 0.1), ["allowed"]);
    assert_eq!(with(&|found| found.allowed[unseen].displacement = 0.0), ["allowed"]);
    assert_eq!(with(&|found| found.allowed[foreign].displacement = -1.0), ["allowed"]);
}

/// A second view must keep what the first one allows where that is less, and where it does not see the instance.
#[test]
fn a_view_that_forgets_the_one_before_is_seen() {
    let (scene, first) = scene_and_view();
    let mut second = SelectView { is_first: 0, ..first };
    // It allows more, and its planes let fewer through.
    second.cameras[0].pixels *= 3.0;
    second.planes[1].w -= 40.0;
    let count = scene.instances.len();
    let poison = vec![untouched(); count];
    let before = right(&scene, &first, &poison);
    let compared = |found: &Found| {
        let mut state = vec![State::Untouched; count];
        before.compared(&scene, &first, &mut state);
        found.compared(&scene, &second, &mut state).map(|(_, comparison)| comparison.holds)
    };
    assert_eq!(compared(&right(&scene, &second, &before.allowed)), [true; 3]);
    let forgetful = right(&scene, &SelectView { is_first: 1, ..second }, &before.allowed);
    assert_eq!(compared(&forgetful), [true, true, false]);
}

/// An instance whose sphere touches a plane may be seen or not; only few may.
#[test]
fn one_at_an_edge_may_go_either_way_and_few_may_be() {
    let (mut scene, view) = scene_and_view();
    let is_culled = |object: &LodObject| object_flags_never_culled(object.flags) == 0;
    let own: Vec<usize> = (0..scene.instances.len())
        .filter(|index| scene.object_of(&view, *index).is_some_and(is_culled))
        .collect();
    let side = view.planes[0];
    let edge = |instance: &mut SceneInstance| {
        let at = glam::Vec3::new(120.0, 25.0, 120.0);
        // As far outside as its radius, up to rounding.
        let at = at - side.truncate() * (side.truncate().dot(at) + side.w + 1.0);
        let rounding = POSITION_SLACK * (2.0 * at.length() + side.w.abs() + 1.0);
        let at = at - side.truncate() * rounding;
        *instance = SceneInstance {
            cell: view.cell.to_array(),
            offset: at.to_array(),
            ..SceneInstance::new([0.0, 0.0, 0.0, 1.0])
        };
    };
    edge(&mut scene.instances[own[0]]);
    let poison = vec![untouched(); scene.instances.len()];
    let one = right(&scene, &view, &poison);
    let touching = one.compared_metrics(&scene, &view).spread.expect("given").touching;
    assert_eq!(touching, 1);
    let mut other = one.clone();
    let seen = |metrics: &[u32]| metrics.iter().copied().find(|word| *word < 1 << 31).expect("one");
    other.metrics[own[0]] =
        if one.metrics[own[0]] == UNSEEN_METRIC { seen(&one.metrics) } else { UNSEEN_METRIC };
    assert!(other.compared_metrics(&scene, &view).holds);
    own[..23].iter().for_each(|index| edge(&mut scene.instances[*index]));
    let many = right(&scene, &view, &poison).compared_metrics(&scene, &view);
    assert!(!many.holds && many.fault.expect("a fault").contains("23 of 448 touch"));
}
