//! Every comparator of these cases fails on planted faults.

use relievo::ops::lod::select::reference::merged;

use crate::cases::lod::select::*;

/// What the reference writes.
fn right(scene: &Scene, view: &SelectView, allowed: &[f32]) -> Found {
    let count = scene.instances.len();
    let poison = f32::from_bits(POISON);
    let mut found = Found {
        allowed: allowed.to_vec(),
        decisions: before(count),
        placements: vec![[[poison; 4]; 3]; count],
        counts: vec![POISON; count / 4],
        last_decisions: vec![POISON; count],
    };
    for (index, before) in allowed.iter().enumerate() {
        let Some(object) = scene.object_of(view, index) else { continue };
        let selected = select(view, object, &scene.instances[index]);
        let before = (view.is_first == 0).then_some(*before);
        found.allowed[index] = merged(before, selected.as_ref());
        found.last_decisions[index] = found.decisions[index] * view.is_next;
        found.decisions[index] = selected.map_or(0, |selected| selected.decision);
        if let Some(selected) = selected {
            found.placements[index] = selected.placement;
        }
    }
    for block in 0..count / 64 {
        if scene.object_of(view, 64 * block).is_some() {
            found.counts[16 * block..][..16].copy_from_slice(&counts(&found.decisions[64 * block..][..64]));
        }
    }
    found
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
    let right = right(&scene, &view, &vec![f32::from_bits(POISON); count]);
    assert_eq!(faults(&scene, &view, &right), Vec::<&str>::new());
    let own = |index: &usize| scene.object_of(&view, *index).is_some();
    let first = |is: &dyn Fn(u32) -> bool| {
        (0..count).filter(own).find(|index| is(right.decisions[*index])).expect("some")
    };
    let seen = first(&|decision| (1..=16).contains(&(decision & 0xff)));
    let moved = first(&|decision| decision >> 11 > 1);
    let unseen = first(&|decision| decision == 0);
    let foreign = (0..count).find(|index| !own(index)).expect("some");
    let with = |change: &dyn Fn(&mut Found)| {
        let mut found = right.clone();
        change(&mut found);
        faults(&scene, &view, &found)
    };
    assert_eq!(with(&|found| found.decisions[seen] ^= 3)[0], "decisions");
    assert_eq!(with(&|found| found.decisions[unseen] = 1)[0], "decisions");
    assert_eq!(with(&|found| found.decisions[foreign] ^= 1), ["decisions"]);
    assert_eq!(with(&|found| found.decisions[moved] ^= 1 << 8), ["decisions"]);
    assert_eq!(with(&|found| found.decisions[moved] &= 0xff), ["decisions"]);
    assert_eq!(with(&|found| found.decisions[moved] ^= 1 << 13), ["decisions"]);
    assert_eq!(with(&|found| found.counts[seen / 4] += 1), ["counts"]);
    assert_eq!(with(&|found| found.counts[foreign / 64 * 16] = 0), ["counts"]);
    assert_eq!(with(&|found| found.placements[seen][1][3] += 1e-3), ["placements"]);
    assert_eq!(with(&|found| found.placements[seen][0][0] = f32::NAN), ["placements"]);
    assert_eq!(with(&|found| found.placements[unseen][0][0] = 0.0), ["placements"]);
    assert_eq!(with(&|found| found.last_decisions[seen] += 1), ["last decisions"]);
    assert_eq!(with(&|found| found.allowed[seen] *= 1.02), ["allowed"]);
    assert_eq!(with(&|found| found.allowed[unseen] = 0.0), ["allowed"]);
    assert_eq!(with(&|found| found.allowed[foreign] = -1.0), ["allowed"]);
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
    let poison = vec![f32::from_bits(POISON); count];
    let before = right(&scene, &first, &poison);
    let compared = |found: &Found| {
        let mut state = vec![State::Untouched; count];
        before.compared(&scene, &first, &mut state);
        found.compared(&scene, &second, &mut state).map(|(_, comparison)| comparison.holds)
    };
    assert_eq!(compared(&right(&scene, &second, &before.allowed)), [true; 5]);
    let forgetful = right(&scene, &SelectView { is_first: 1, ..second }, &before.allowed);
    assert_eq!(compared(&forgetful), [true, true, true, true, false]);
}

/// The decisions of the last frame, and nothing where that frame had no such view.
#[test]
fn a_decision_of_another_frame_is_seen() {
    let (scene, view) = scene_and_view();
    let count = scene.instances.len();
    let view = SelectView { is_next: 1, ..view };
    let found = right(&scene, &view, &vec![f32::from_bits(POISON); count]);
    assert_eq!(faults(&scene, &view, &found), Vec::<&str>::new());
    let other = SelectView { is_next: 0, ..view };
    assert_eq!(faults(&scene, &other, &found), ["last decisions"]);
}

/// An instance whose sphere touches a plane may be seen or not; only few may.
#[test]
fn one_at_an_edge_may_go_either_way_and_few_may_be() {
    let (mut scene, view) = scene_and_view();
    let own: Vec<usize> =
        (0..scene.instances.len()).filter(|index| scene.object_of(&view, *index).is_some()).collect();
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
    let poison = vec![f32::from_bits(POISON); scene.instances.len()];
    let one = right(&scene, &view, &poison);
    let touching = one.compared_decisions(&scene, &view).spread.expect("given").touching;
    assert_eq!(touching, 1);
    let mut other = one.clone();
    other.decisions[own[0]] = if one.decisions[own[0]] == 0 { 1 } else { 0 };
    assert!(other.compared_decisions(&scene, &view).holds);
    own[..9].iter().for_each(|index| edge(&mut scene.instances[*index]));
    let nine = right(&scene, &view, &poison).compared_decisions(&scene, &view);
    assert!(!nine.holds && nine.fault.expect("a fault").contains("9 of 448 touch"));
}
