//! The properties that make terrain seamless, for random worlds: neighbours agree bit for bit wherever they
//! meet, in every order and at every resolution, before and after despiking and erosion.

use std::collections::{BTreeMap, HashMap};

use proptest::prelude::*;
use proptest::test_runner::RngSeed;
use relievo::ops::terrain::blend::WeightMode;
use relievo::ops::terrain::blend::reference::{steepness, zone_fractions, zone_weight};
use relievo::ops::terrain::config::{Border, HEIGHT_LIMIT, HEIGHT_ONE, Offset, Slope, TerrainConfig, Zone};
use relievo::ops::terrain::cover::{ShaderZone, zone_of};
use relievo::ops::terrain::despike::Despike;
use relievo::ops::terrain::export::cropped;
use relievo::ops::terrain::features::{FeatureFile, Features};
use relievo::ops::terrain::field::{field, generate};
use relievo::ops::terrain::fixed::FeatureMode;
use relievo::ops::terrain::fixed::mean_of_four;
use relievo::ops::terrain::morph::Morph;
use relievo::ops::terrain::morph::reference::morph;
use relievo::ops::terrain::normals::NORMAL_BOUND;
use relievo::ops::terrain::normals::reference::normals;
use relievo::ops::terrain::recipe::Recipe;
use relievo::ops::terrain::thermal::Thermal;
use relievo::ops::terrain::thermal::reference::thermal;

/// Random cases that are the same in every run.
fn settings() -> ProptestConfig {
    ProptestConfig {
        cases: 64,
        rng_seed: RngSeed::Fixed(2012),
        failure_persistence: None,
        ..ProptestConfig::default()
    }
}

/// Heights by column and row, counted in samples from the corner of one patch.
type Points = BTreeMap<[i32; 2], f64>;

/// A world, and the patch under test.
#[derive(Debug, Clone)]
struct World {
    config: TerrainConfig,
    points: Points,
    mode: FeatureMode,
    patch: [i32; 2],
}

impl World {
    fn features(&self) -> Features {
        features(&self.config, self.patch, &self.points, self.mode)
    }

    /// The patch and its neighbours to the right and below.
    fn block(&self) -> [[i32; 2]; 4] {
        let [x, y] = self.patch;
        [[x, y], [x + 1, y], [x, y + 1], [x + 1, y + 1]]
    }

    fn windows(&self, patches: &[[i32; 2]], apron: u32) -> Vec<Vec<i32>> {
        generate(&self.config, &self.features(), patches, apron)
    }

    fn window(&self, apron: u32) -> Vec<i32> {
        self.windows(&[self.patch], apron).remove(0)
    }

    fn with_point(&self, place: [i32; 2], height: f64) -> Self {
        let mut world = self.clone();
        world.points.insert(place, height);
        world
    }

    fn recipe(&self, despike: Option<f64>, thermal: Option<Thermal>) -> Recipe {
        let despike = despike.map(|threshold| Despike { threshold });
        Recipe {
            config: self.config.clone(),
            features: self.features(),
            despike,
            thermal,
            ..Recipe::new(self.config.clone())
        }
    }
}

fn edge(config: &TerrainConfig) -> i32 {
    config.patch_size as i32 - 1
}

/// Writes every point to the file of the patch that it lies in, or on whose left or upper border it lies.
fn features(config: &TerrainConfig, patch: [i32; 2], points: &Points, mode: FeatureMode) -> Features {
    let files: Vec<_> = points.iter().map(|(place, height)| file(config, patch, *place, *height)).collect();
    Features::new(config, &files, mode).expect("the points of a world are valid")
}

fn file(config: &TerrainConfig, patch: [i32; 2], place: [i32; 2], height: f64) -> FeatureFile {
    let edge = edge(config);
    let patch_coordinates = [0, 1].map(|axis| patch[axis] + place[axis].div_euclid(edge));
    let [x, y] = place.map(|index| f64::from(index.rem_euclid(edge)));
    FeatureFile { patch_coordinates, precomputed_heights: vec![x, y, height] }
}

fn configs() -> impl Strategy<Value = TerrainConfig> {
    let offsets = prop_oneof![Just(Offset::Signed), Just(Offset::Positive), Just(Offset::Gaussian)];
    (1..=6_u32, 0..=4_u32, offsets, 0.5..400.0, 0.0..2.0, 0.1..10.0, any::<u64>()).prop_map(
        |(exponent, coarse_levels, offset, scale_factor, roughness, terrain_scale, seed)| {
            let config = TerrainConfig::new((1 << exponent) + 1, scale_factor, &seed.to_string());
            TerrainConfig {
                coarse_levels,
                offset,
                roughness,
                terrain_scale,
                ..config.expect("a valid configuration")
            }
        },
    )
}

fn patches() -> impl Strategy<Value = [i32; 2]> {
    prop_oneof![[-3..3, -3..3], [-500_000..500_000, -500_000..500_000]]
}

/// Points on the block of a world and up to a patch beyond it. Half of the worlds have none.
fn points(edge: i32) -> impl Strategy<Value = Points> {
    // Clearing low bits puts points on coarse lattices, where their influence reaches furthest.
    let coordinate =
        (-edge..=3 * edge, 0..=6).prop_map(move |(at, bits): (i32, i32)| (at >> bits << bits).max(-edge));
    let place = (coordinate.clone(), coordinate).prop_map(<[i32; 2]>::from);
    let some = prop::collection::btree_map(place, -100.0..100.0, 1..24);
    prop_oneof![Just(Points::new()), some]
}

fn worlds() -> impl Strategy<Value = World> {
    (configs(), any::<bool>(), patches()).prop_flat_map(|(config, additive, patch)| {
        let mode = if additive { FeatureMode::Additive } else { FeatureMode::Keep };
        points(edge(&config)).prop_map(move |points| World { config: config.clone(), points, mode, patch })
    })
}

/// Counts the samples that several fields share.
///
/// # Errors
/// The first sample on which two fields disagree.
fn shared_samples<T: Copy + PartialEq + std::fmt::Debug>(
    patches: &[[i32; 2]],
    fields: &[Vec<T>],
    edge: i32,
    margin: u32,
) -> Result<usize, String> {
    let width = edge + 1 + 2 * margin as i32;
    let mut known = HashMap::new();
    let mut shared = 0;
    for (patch, field) in patches.iter().zip(fields) {
        assert_eq!(field.len(), (width * width) as usize);
        for (sample, index) in field.iter().zip(0..) {
            let place = [index % width, index / width].map(|at| i64::from(at) - i64::from(margin));
            let place = [0, 1].map(|axis| i64::from(patch[axis]) * i64::from(edge) + place[axis]);
            match known.insert(place, *sample) {
                Some(other) if other != *sample => {
                    return Err(format!(
                        "{sample:?} in patch {patch:?} is {other:?} elsewhere, at {place:?}"
                    ));
                }
                Some(_) => shared += 1,
                None => (),
            }
        }
    }
    Ok(shared)
}

/// The samples that the fields of 2 × 2 patches share.
fn overlap(edge: i32, margin: u32) -> Result<usize, String> {
    let width = edge + 1 + 2 * margin as i32;
    Ok((4 * width * width - (width + edge) * (width + edge)) as usize)
}

proptest! {
    #![proptest_config(settings())]

    #[test]
    fn neighbours_agree_in_every_order(
        world in worlds(),
        order in Just([0, 1, 2, 3]).prop_shuffle(),
        apron in 0..5_u32,
    ) {
        let block = world.block();
        let shuffled = world.windows(&order.map(|index| block[index]), apron);
        let mut fields = vec![Vec::new(); 4];
        for (index, field) in order.into_iter().zip(shuffled) {
            prop_assert!(world.windows(&[block[index]], apron)[0] == field, "alone, {index} is another");
            fields[index] = field;
        }
        let edge = edge(&world.config);
        prop_assert_eq!(shared_samples(&block, &fields, edge, apron), overlap(edge, apron));
    }

    #[test]
    fn a_planted_fault_is_seen(
        world in worlds(),
        faulty in 0..4_usize,
        at in any::<prop::sample::Index>(),
        down in any::<bool>(),
        bit in 0..32,
    ) {
        let (block, edge) = (world.block(), edge(&world.config));
        let mut fields = world.windows(&block, 0);
        let [column, row] = [faulty % 2, faulty / 2].map(|side| if side == 0 { edge } else { 0 });
        let along = at.index(edge as usize + 1) as i32;
        let (x, y) = if down { (column, along) } else { (along, row) };
        fields[faulty][(y * (edge + 1) + x) as usize] ^= 1 << bit;
        prop_assert!(shared_samples(&block, &fields, edge, 0).is_err());
    }

    #[test]
    fn a_patch_is_every_second_sample_of_the_next_larger_one(world in worlds(), apron in 0..5_u32) {
        let fine = World {
            config: TerrainConfig { patch_size: 2 * world.config.patch_size - 1, ..world.config.clone() },
            points: world.points.iter().map(|(place, height)| (place.map(|at| 2 * at), *height)).collect(),
            ..world.clone()
        };
        let width = (edge(&fine.config) as u32 + 1 + 4 * apron) as usize;
        let rows = fine.window(2 * apron);
        let every_second = rows.chunks(width).step_by(2).flat_map(|row| row.iter().copied().step_by(2));
        prop_assert!(every_second.eq(world.window(apron)));
    }

    #[test]
    fn a_larger_window_holds_the_smaller(world in worlds(), apron in 0..9_u32, more in 1..150_u32) {
        let width = world.config.patch_size + 2 * (apron + more);
        let inner = cropped(&world.window(apron + more), width as usize, more as usize);
        prop_assert!(inner == world.window(apron));
    }

    #[test]
    fn a_point_on_a_border_belongs_to_either_patch(
        world in worlds(),
        along in 0..=64_i32,
        flip in any::<bool>(),
    ) {
        let (config, edge) = (&world.config, edge(&world.config));
        let along = along.min(edge);
        let place = if flip { [edge, along] } else { [along, edge] };
        let own = FeatureFile {
            patch_coordinates: world.patch,
            precomputed_heights: vec![place[0].into(), place[1].into(), 50.0],
        };
        let neighbours = file(config, world.patch, place, 50.0);
        prop_assert_ne!(own.patch_coordinates, neighbours.patch_coordinates);
        let both = [own.clone(), neighbours.clone()];
        let [own, neighbours] = [own, neighbours].map(|file| Features::new(config, &[file], world.mode));
        prop_assert_eq!(&own, &neighbours);
        prop_assert_eq!(&own, &Features::new(config, &both, world.mode));
    }

    #[test]
    fn heights_stay_within_the_stated_bound(world in worlds()) {
        let largest = world.points.values().fold(0.0, |largest: f64, height| largest.max(height.abs()));
        let feature = (largest * HEIGHT_ONE).round() as i64;
        let added = if world.mode == FeatureMode::Additive { feature } else { 0 };
        let range = |level: u32| i64::from(world.config.level_range(level));
        let steps: i64 = (0..world.config.levels()).map(|level| 2 * (range(level) + added)).sum();
        let bound = range(0) + feature + steps;
        prop_assert!(bound <= HEIGHT_LIMIT);
        prop_assert!(world.window(3).iter().all(|height| i64::from(*height).abs() <= bound));
    }

    #[test]
    fn features_beyond_the_rings_change_nothing(
        world in worlds(),
        apron in 0..70_u32,
        beyond in 1..130_i32,
        along in -200..264_i32,
        [flip, far] in any::<[bool; 2]>(),
    ) {
        let world = World { config: TerrainConfig { coarse_levels: 0, ..world.config.clone() }, ..world };
        let edge = edge(&world.config);
        let rings = (apron as i32 + edge + edge - 1) / edge;
        let outside = if far { (1 + rings) * edge + beyond } else { -rings * edge - beyond };
        let place = if flip { [outside, along] } else { [along, outside] };
        prop_assert!(world.with_point(place, 100.0).window(apron) == world.window(apron));
    }
}

fn plain(exponent: u32) -> World {
    let config = TerrainConfig::new((1 << exponent) + 1, 40.0, "plain").expect("a valid configuration");
    World { config, points: Points::new(), mode: FeatureMode::Keep, patch: [5, -7] }
}

#[test]
fn features_on_the_ring_may_change_a_patch() {
    for exponent in 2..=6 {
        let world = plain(exponent);
        let edge = edge(&world.config);
        for place in
            [[-edge, -edge], [2 * edge, -edge], [-edge, 2 * edge], [2 * edge, 2 * edge], [0, 2 * edge]]
        {
            assert_ne!(world.with_point(place, 1000.0).window(0), world.window(0), "{place:?} of {edge}");
        }
    }
}

#[test]
fn kept_features_stand_and_additive_ones_lift() {
    let (world, place) = (plain(4), [3, 10]);
    let index = 10 * 17 + 3;
    let before = world.window(0)[index];
    let mut kept = world.with_point(place, 12.5);
    assert_eq!(kept.window(0)[index], 819_200);
    kept.mode = FeatureMode::Additive;
    assert_eq!(kept.window(0)[index], before + 819_200);
}

#[test]
fn patches_at_the_ends_of_the_world_agree() {
    for patch in [[524_284, 524_284], [-524_287, -524_287], [524_284, -524_287]] {
        let world = World { patch, ..plain(3) };
        let recipe = world.recipe(None, None);
        let fields = field(&recipe, &world.block(), 0).expect("the last patches of the world are valid");
        assert_eq!(shared_samples(&world.block(), &fields, 8, 0), overlap(8, 0));
    }
}

fn despikes() -> impl Strategy<Value = Option<f64>> {
    prop::option::of(0.0..5.0)
}

fn thermals() -> impl Strategy<Value = Option<Thermal>> {
    prop::option::of((0..6_u32, 0.0..60.0).prop_map(|(iterations, talus)| Thermal { iterations, talus }))
}

/// The exact unit normal, in f64.
fn exact_normal(gradient: [i32; 2], terrain_scale: f64) -> [f64; 3] {
    let normal = [f64::from(-gradient[0]), 2.0 * terrain_scale * HEIGHT_ONE, f64::from(-gradient[1])];
    let length = normal.iter().map(|component| component * component).sum::<f64>().sqrt();
    normal.map(|component| component / length)
}

proptest! {
    #![proptest_config(settings())]

    #[test]
    fn neighbours_agree_after_despiking_and_erosion(
        world in worlds(),
        despike in despikes(),
        thermal in thermals(),
        margin in 0..3_u32,
    ) {
        let (block, edge) = (world.block(), edge(&world.config));
        let fields = field(&world.recipe(despike, thermal), &block, margin).expect("a valid recipe");
        prop_assert_eq!(shared_samples(&block, &fields, edge, margin), overlap(edge, margin));
    }

    #[test]
    fn neighbours_agree_in_slope(world in worlds(), despike in despikes(), thermal in thermals()) {
        let (block, edge) = (world.block(), edge(&world.config));
        let scale = world.config.terrain_scale;
        let windows = field(&world.recipe(despike, thermal), &block, 1).expect("a valid recipe");
        let (gradients, normals): (Vec<_>, Vec<_>) =
            windows.iter().map(|window| normals(window, edge as usize + 3, scale)).unzip();
        prop_assert_eq!(shared_samples(&block, &gradients, edge, 0), overlap(edge, 0));
        prop_assert_eq!(shared_samples(&block, &normals, edge, 0), overlap(edge, 0));
        for (gradient, normal) in gradients.iter().flatten().zip(normals.iter().flatten()) {
            for (component, exact) in normal.iter().zip(exact_normal(*gradient, scale)) {
                prop_assert!((f64::from(*component) - exact).abs() <= f64::from(NORMAL_BOUND));
            }
        }
    }

    #[test]
    fn despiking_leaves_features_alone_and_replaces_all_else(world in worlds()) {
        let (edge, before) = (edge(&world.config), world.window(1));
        let width = edge + 3;
        let after = field(&world.recipe(Some(0.0), None), &[world.patch], 0).expect("a valid recipe");
        for (&height, index) in after[0].iter().zip(0..) {
            let [x, y] = [index % (edge + 1), index / (edge + 1)];
            let at = |x: i32, y: i32| before[((y + 1) * width + x + 1) as usize];
            let mean = exact_mean([at(x - 1, y), at(x + 1, y), at(x, y - 1), at(x, y + 1)]);
            let injected = world.points.contains_key(&[x, y]);
            prop_assert_eq!(height, if injected { at(x, y) } else { mean }, "at ({}, {})", x, y);
        }
    }

    #[test]
    fn a_threshold_above_every_spike_changes_nothing(world in worlds()) {
        let after = field(&world.recipe(Some(16_383.0), None), &[world.patch], 0).expect("a valid recipe");
        prop_assert!(after[0] == world.window(0));
    }

    // The field lies in the middle of a plain so wide that the rim is still flat after the last iteration, so that no
    // height has left the window.
    #[test]
    fn erosion_moves_mass_but_keeps_it(
        side in 1..12_usize,
        iterations in 1..8_usize,
        flat in -1000..1000,
        threshold in 0..100_000,
        heights in prop::collection::vec(heights(), 144),
    ) {
        let border = 2 * iterations + 1;
        let mut width = side + 2 * border;
        let mut window = vec![flat; width * width];
        for (index, height) in heights.into_iter().take(side * side).enumerate() {
            window[(border + index / side) * width + border + index % side] = height;
        }
        let above = |window: &[i32]| window.iter().map(|height| i64::from(height - flat)).sum::<i64>();
        let mass = above(&window);
        for _ in 0..iterations {
            window = thermal(&window, width, threshold);
            width -= 2;
        }
        prop_assert_eq!(above(&window), mass);
        let last = width - 1;
        let rim = (0..width).flat_map(|at| [at, last * width + at, at * width, at * width + last]);
        prop_assert!(rim.map(|index| window[index]).all(|height| height == flat));
    }

    #[test]
    fn erosion_keeps_the_mass_of_a_patch_that_wraps(
        config in configs(),
        patch in patches(),
        iterations in 1..8_u32,
        talus in 0.0..30.0,
    ) {
        let config = TerrainConfig { coarse_levels: 0, border: Border::Wrap, ..config };
        let iterations = iterations.min(config.patch_size - 1);
        let edge = edge(&config) as usize;
        let mass = |field: &[i32]| {
            let rows = field.chunks(edge + 1).take(edge);
            rows.flat_map(|row| &row[..edge]).map(|height| i64::from(*height)).sum::<i64>()
        };
        let before = Recipe::new(config);
        let after = Recipe { thermal: Some(Thermal { iterations, talus }), ..before.clone() };
        let made = |recipe: Recipe| field(&recipe, &[patch], 0).expect("a valid recipe").remove(0);
        let [before, after] = [before, after].map(made);
        prop_assert_eq!(mass(&after), mass(&before));
        prop_assert!(tiles(&after, edge + 1));
    }
}

#[test]
fn slopes_are_central_differences() {
    let window: Vec<i32> =
        (0..9).map(|index| [index % 3, index / 3]).map(|[x, y]| 7 * x * x - y * y).collect();
    assert_eq!(normals(&window, 3, 1.0).0, [[28, -4]]);
}

/// Random heights, and often the largest and the smallest height.
fn heights() -> impl Strategy<Value = i32> {
    let limit = HEIGHT_LIMIT as i32;
    prop_oneof![4 => -limit..=limit, 1 => Just(limit), 1 => Just(-limit), 1 => -4..=4]
}

#[test]
fn a_spike_slides_an_eighth_of_its_excess_each_way() {
    let mut window = [0; 25];
    window[12] = 900;
    assert_eq!(thermal(&window, 5, 100), [0, 100, 0, 100, 500, 100, 0, 100, 0]);
    window[12] = 100;
    assert_eq!(thermal(&window, 5, 100), [0, 0, 0, 0, 100, 0, 0, 0, 0]);
}

fn tiles(field: &[i32], size: usize) -> bool {
    let mut rows = field.chunks(size);
    rows.clone().all(|row| row[0] == row[size - 1]) && rows.next() == rows.next_back()
}

fn wraps() -> impl Strategy<Value = TerrainConfig> {
    let corners = [-100.0..100.0, -100.0..100.0, -100.0..100.0, -100.0..100.0_f64];
    (configs(), corners).prop_map(|(config, corners)| TerrainConfig {
        coarse_levels: 0,
        border: Border::Wrap,
        corners,
        ..config
    })
}

fn blends() -> impl Strategy<Value = (TerrainConfig, u32)> {
    (wraps(), any::<prop::sample::Index>()).prop_map(|(config, at)| {
        let width = 1 + at.index(config.patch_size as usize - 1) as u32;
        (TerrainConfig { border: Border::Blend(width), ..config }, width)
    })
}

/// The patches after their transitions, and each patch as `wrap` makes it.
fn with_and_without_blend(config: &TerrainConfig, patches: &[[i32; 2]]) -> [Vec<Vec<i32>>; 2] {
    let wrap = TerrainConfig { border: Border::Wrap, ..config.clone() };
    [config, &wrap].map(|config| {
        config.validate().expect("a valid configuration");
        generate(config, &Features::default(), patches, 0)
    })
}

/// `own` moved towards the earlier patch that lies in `direction`. The blend is computed as one exact fraction,
/// where the code uses quotients and remainders.
fn moved(own: &[i32], earlier: &[i32], size: usize, width: u32, direction: [i32; 2]) -> Vec<i32> {
    let mirrored = |at: usize, step: i32| if step == 0 { at } else { size - 1 - at };
    let distance = |at: usize, step: i32| if step < 0 { at } else { size - 1 - at };
    let mut result = Vec::with_capacity(own.len());
    for (index, height) in own.iter().enumerate() {
        let place = [index % size, index / size];
        let axis = usize::from(direction[0] == 0);
        let distance = distance(place[axis], direction[axis]) as i64;
        let theirs =
            i64::from(earlier[mirrored(place[1], direction[1]) * size + mirrored(place[0], direction[0])]);
        let (difference, width) = (i64::from(*height) - theirs, i64::from(width));
        let blended = theirs + (difference * distance + width / 2).div_euclid(width);
        result.push(if distance < width { blended as i32 } else { *height });
    }
    result
}

proptest! {
    #![proptest_config(settings())]

    #[test]
    fn wrap_with_equal_corners_tiles(config in wraps(), corner in -100.0..100.0, patch in patches()) {
        let config = TerrainConfig { corners: [corner; 4], ..config };
        let fields = generate(&config, &Features::default(), &[patch], 0);
        prop_assert!(tiles(&fields[0], config.patch_size as usize));
    }

    #[test]
    fn two_patches_blend_at_their_border(
        (config, width) in blends(),
        patch in patches(),
        direction in prop::sample::select(&[[-1, 0], [1, 0], [0, -1], [0, 1]]),
    ) {
        let earlier = [patch[0] + direction[0], patch[1] + direction[1]];
        let [blend, wrap] = with_and_without_blend(&config, &[earlier, patch]);
        prop_assert!(blend[0] == wrap[0], "the earlier patch moved");
        let size = config.patch_size as usize;
        prop_assert!(blend[1] == moved(&wrap[1], &wrap[0], size, width, direction));
        let borders = shared_samples(&[earlier, patch], &blend, edge(&config), 0);
        prop_assert_eq!(borders, Ok(size), "the border is not the earlier patch's");
    }

    #[test]
    fn four_patches_blend_in_row_major_order((config, width) in blends(), [x, y] in patches()) {
        let block = [[x, y], [x + 1, y], [x, y + 1], [x + 1, y + 1]];
        let [blend, wrap] = with_and_without_blend(&config, &block);
        let size = config.patch_size as usize;
        prop_assert!(blend[0] == wrap[0]);
        prop_assert!(blend[1] == moved(&wrap[1], &blend[0], size, width, [-1, 0]));
        prop_assert!(blend[2] == moved(&wrap[2], &blend[0], size, width, [0, -1]));
        let left_first = moved(&wrap[3], &blend[2], size, width, [-1, 0]);
        prop_assert!(blend[3] == moved(&left_first, &blend[1], size, width, [0, -1]));
        prop_assert_eq!(&blend[3][..size], &blend[1][size * (size - 1)..]);
        for index in (0..size * size).filter(|index| (index % size).min(index / size) >= width as usize) {
            prop_assert_eq!(blend[3][index], wrap[3][index], "far from both borders");
        }
    }

    #[test]
    fn morphing_is_exact_at_its_ends_and_monotone_between(
        ends in prop::collection::vec((heights(), heights()), 1..64),
        times in [0.0..=1.0, 0.0..=1.0],
    ) {
        let (from, to): (Vec<_>, Vec<_>) = ends.iter().copied().unzip();
        let at = |time: f64| morph(&from, &to, Morph { time }.fixed_time());
        prop_assert_eq!(&at(0.0), &from);
        prop_assert_eq!(&at(1.0), &to);
        let [early, late] = [f64::min, f64::max].map(|pick| at(pick(times[0], times[1])));
        for (((from, to), early), late) in ends.into_iter().zip(early).zip(late) {
            let path = [from, early, late, to];
            prop_assert!(path.is_sorted() || path.iter().rev().is_sorted(), "{:?}", path);
        }
    }

    #[test]
    fn the_mean_is_exact(corners in [heights(), heights(), heights(), heights()]) {
        let [a, b, c, d] = corners;
        prop_assert_eq!(mean_of_four(a, b, c, d), exact_mean(corners));
    }

    #[test]
    fn additive_shares_are_equation_3_6(zones in zones(), height in -300.0..300.0_f32) {
        let fractions = zone_fractions(&zones, height, 0.3, &LEVEL[..zones.len()], WeightMode::Additive);
        prop_assert_eq!(fractions.len(), zones.len());
        for (fraction, zone) in fractions.into_iter().zip(&zones) {
            let [min, max, height] = [zone.min, zone.max, height].map(f64::from);
            let weight = (((max - min) - (height - max).abs()) / (max - min)).max(0.0);
            prop_assert!((f64::from(fraction) - weight).abs() < 1e-6, "{} is not {}", fraction, weight);
        }
    }

    #[test]
    fn normalized_shares_sum_to_one_everywhere(zones in zones(), height in -300.0..300.0_f32) {
        let fractions = zone_fractions(&zones, height, 0.3, &LEVEL[..zones.len()], WeightMode::Normalized);
        let weights = zone_fractions(&zones, height, 0.3, &LEVEL[..zones.len()], WeightMode::Additive);
        prop_assert!(fractions.iter().all(|fraction| (0.0..=1.0).contains(fraction)));
        prop_assert!((fractions.iter().copied().map(f64::from).sum::<f64>() - 1.0).abs() < 1e-6);
        if weights.iter().any(|weight| *weight > 0.0) {
            prop_assert!(fractions.iter().zip(weights).all(|(fraction, weight)| (*fraction > 0.0) == (weight > 0.0)));
        }
    }

    #[test]
    fn outside_all_zones_the_nearest_has_all(
        zones in zones(),
        beyond in 0.5..1000.0_f32,
        above in any::<bool>(),
    ) {
        let ends = |zone: &ShaderZone| if above { 2.0 * zone.max - zone.min } else { -zone.min };
        let outermost = zones.iter().map(ends).fold(f32::MIN, f32::max);
        let height = if above { outermost + beyond } else { -outermost - beyond };
        let fractions = zone_fractions(&zones, height, 0.3, &LEVEL[..zones.len()], WeightMode::Normalized);
        let nearest = fractions.iter().position(|fraction| *fraction == 1.0);
        prop_assert_eq!(fractions.iter().filter(|fraction| **fraction != 0.0).count(), 1);
        prop_assert!(nearest.is_some_and(|index| outermost - ends(&zones[index]) < 1e-3), "{:?}", fractions);
    }
}

/// ⌊(a + b + c + d + 2) / 4⌋ in arithmetic that does not overflow.
pub fn exact_mean(heights: [i32; 4]) -> i32 {
    let sum: i64 = heights.into_iter().map(i64::from).sum();
    (sum + 2).div_euclid(4) as i32
}

#[test]
fn the_mean_is_exact_at_the_limits() {
    let limit = HEIGHT_LIMIT as i32;
    let values = [-limit, 1 - limit, -3, -2, -1, 0, 1, 2, 3, limit - 1, limit];
    for index in 0..values.len().pow(4) {
        let corners = [0, 1, 2, 3].map(|digit| values[index / values.len().pow(digit) % values.len()]);
        let [a, b, c, d] = corners;
        assert_eq!(mean_of_four(a, b, c, d), exact_mean(corners), "{corners:?}");
    }
}

/// The weight by slope, of angles: 0 before a transition, a half where the zone begins or ends, 1 inside.
#[test]
fn zones_lie_on_their_slopes() {
    let weight = |slope: Slope, degrees: f64| {
        let zone = zone_of(&Zone { slope, ..Zone::new(0.0, 1.0, None) });
        let (sine, cosine) = degrees.to_radians().sin_cos();
        zone_weight(&zone, 1.0, steepness([0.6 * sine, cosine, 0.8 * sine].map(|part| part as f32)))
    };
    for (min, max, fade) in [(30.0, 90.0, 10.0), (0.0, 25.0, 1.0), (20.0, 60.0, 30.0), (0.0, 90.0, 45.0)] {
        let slope = Slope { min, max, fade };
        for degrees in (0..=90).map(f64::from) {
            let inside = |from: f64| (0.5 + from / fade).clamp(0.0, 1.0);
            let rise = if min > 0.0 { inside(degrees - min) } else { 1.0 };
            let fall = if max < 90.0 { inside(max - degrees) } else { 1.0 };
            // Lines in the tangent of half the angle are nearly lines in the angle.
            let found = f64::from(weight(slope, degrees));
            assert!((found - rise * fall).abs() < 0.04, "{slope:?} at {degrees}: {found}");
            assert!(
                found == rise * fall || rise * fall > 0.0 && rise * fall < 1.0,
                "{slope:?} at {degrees}: {found}"
            );
        }
    }
}

/// Of two zones with equal weights, the one that stands higher in its texture has more, if it is blended by heights.
#[test]
fn what_stands_high_in_its_texture_shows_first() {
    let zone = |height_blend| zone_of(&Zone { height_blend, ..Zone::new(0.0, 10.0, None) });
    let fraction = |height_blend, texels: [f32; 2]| {
        let zones = [zone(height_blend); 2];
        zone_fractions(&zones, 5.0, 0.0, &texels, WeightMode::Normalized)[0]
    };
    assert_eq!(fraction(0.0, [1.0, 0.0]), 0.5);
    assert!(fraction(1.0, [1.0, 0.5]) > 0.9 && fraction(1.0, [0.5, 1.0]) < 0.1);
    assert!(fraction(0.3, [1.0, 0.5]) > 0.6 && fraction(0.3, [1.0, 0.5]) < 0.9);
    let additive = zone_fractions(&[zone(1.0); 2], 5.0, 0.0, &[1.0, 0.2], WeightMode::Additive);
    assert!((additive[0] + additive[1] - 1.0).abs() < 1e-6, "the weights are halves: {additive:?}");
}

/// Heights of the zones' textures.
const LEVEL: [f32; 8] = [0.5; 8];

fn zones() -> impl Strategy<Value = Vec<ShaderZone>> {
    let zone = (-150.0..100.0_f64, 0.5..50.0_f64)
        .prop_map(|(min, range)| zone_of(&Zone::new(min, min + range, None)));
    prop::collection::vec(zone, 1..9)
}
