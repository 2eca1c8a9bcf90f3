//! Bad input is refused with an error that names the field, its value and the bound. The nearest good input and edge
//! cases are accepted.

use relievo::InputError;
use relievo::ops::terrain::config::{Border, Offset, TerrainConfig};
use relievo::ops::terrain::despike::Despike;
use relievo::ops::terrain::features::{FeatureFile, Features};
use relievo::ops::terrain::fixed::FeatureMode;
use relievo::ops::terrain::morph::Morph;
use relievo::ops::terrain::recipe::Recipe;
use relievo::ops::terrain::thermal::Thermal;

/// B's three parameters as JSON, with fields changed, added or (where the value is empty) left out.
fn json(changes: &[(&str, &str)]) -> String {
    let mut fields = vec![("patchSize", "33"), ("scaleFactor", "40.0"), ("seed", "\"any text\"")];
    for change in changes {
        fields.retain(|field| field.0 != change.0);
        fields.push(*change);
    }
    let fields: Vec<_> = (fields.iter().filter(|field| !field.1.is_empty()))
        .map(|(name, value)| format!("\"{name}\": {value}"))
        .collect();
    format!("{{{}}}", fields.join(", "))
}

#[track_caller]
fn accepted(changes: &[(&str, &str)]) -> TerrainConfig {
    let text = json(changes);
    TerrainConfig::from_json(&text).unwrap_or_else(|error| panic!("{text} was refused: {error}"))
}

#[track_caller]
fn refused(changes: &[(&str, &str)], parts: &[&str]) {
    refuses(TerrainConfig::from_json(&json(changes)), parts);
}

/// Whether the error's text has all parts: field, value and bound.
#[track_caller]
fn refuses<T>(result: Result<T, InputError>, parts: &[&str]) {
    let Err(error) = result else { panic!("accepted what should be refused with {parts:?}") };
    let text = error.to_string();
    for part in parts {
        assert!(text.contains(part), "\"{text}\" does not say \"{part}\"");
    }
}

#[test]
fn edge_cases_are_accepted() {
    assert_eq!(accepted(&[("patchSize", "3")]).levels(), 1);
    assert_eq!(accepted(&[("patchSize", "4097")]).levels(), 12);
    assert_eq!(accepted(&[("patchSize", "257.0")]).patch_size, 257);
    assert_eq!(accepted(&[("scaleFactor", "0")]).level_range(0), 0);
    assert_eq!(accepted(&[("seed", "\"\"")]).seed, "");
    assert_eq!(accepted(&[("seed", "\"Höhenzüge 山 \\ud83c\\udfd4\"")]).seed, "Höhenzüge 山 🏔");
    assert_eq!(accepted(&[("roughness", "0")]).level_range(4), 40 << 16);
    assert_eq!(accepted(&[("roughness", "1e308")]).level_range(1), 0);
    assert_eq!(accepted(&[("coarseLevels", "8")]).levels(), 13);
    assert_eq!(accepted(&[("coarseLevels", "0"), ("border", "\"wrap\"")]).border, Border::Wrap);
    assert_eq!(accepted(&[("corners", "[0, 0, 0, 0]")]).border, Border::Seamless);
    assert_eq!(accepted(&[("border", "{\"blend\": 1}"), ("corners", "-2")]).corners, [-2.0; 4]);
}

#[test]
fn defaults_are_those_of_the_specification() {
    let config = accepted(&[]);
    assert_eq!((config.roughness, config.coarse_levels, config.terrain_scale), (1.0, 0, 1.0));
    assert_eq!((config.offset, config.border, config.corners), (Offset::Signed, Border::Seamless, [0.0; 4]));
    assert_eq!((config.zones.len(), config.texture_tile), (4, None));
    assert_eq!((config.triplanar, config.variation), (false, 0.0));
    let zone = &accepted(&[("zones", r#"[{"min": 0, "max": 1}]"#)]).zones[0];
    assert_eq!((zone.slope.min, zone.slope.max, zone.slope.fade), (0.0, 90.0, 10.0));
    assert_eq!((zone.height_blend, zone.repeats), (0.0, 1));
}

#[test]
fn how_zones_lie_on_the_ground_is_bounded() {
    let zones = |more: &str| format!(r#"[{{"min": 0, "max": 1}}, {{"min": 0, "max": 1, {more}}}]"#);
    for (more, parts) in [
        (r#""slope": {"min": -1}"#, ["zones[1].slope.min = -1: ", "0..=90"]),
        (r#""slope": {"max": 91}"#, ["zones[1].slope.max = 91: ", "0..=90"]),
        (r#""slope": {"min": 30, "max": 30}"#, ["zones[1].slope.max = 30: ", "above min = 30"]),
        (r#""slope": {"fade": 0.5}"#, ["zones[1].slope.fade = 0.5: ", "1..=45"]),
        (r#""slope": {"fade": 46}"#, ["zones[1].slope.fade = 46: ", "1..=45"]),
        (r#""slope": {"steepest": 3}"#, ["zones[1].slope", "unknown field `steepest`"]),
        (r#""slope": [10, 20, 5]"#, ["zones[1].slope", "an object"]),
        (r#""heightBlend": -0.1"#, ["zones[1].heightBlend = -0.1: ", "0..=1"]),
        (r#""heightBlend": 1.5"#, ["zones[1].heightBlend = 1.5: ", "0..=1"]),
        (r#""repeats": 0"#, ["zones[1].repeats = 0: ", "1..=16"]),
        (r#""repeats": 17"#, ["zones[1].repeats = 17: ", "1..=16"]),
        (r#""repeats": 2.5"#, ["zones[1].repeats = 2.5: ", "must be a whole number in 1..=16"]),
    ] {
        refused(&[("zones", &zones(more))], &parts);
    }
    let more = r#""slope": {"min": 0, "max": 90, "fade": 45}, "heightBlend": 1, "repeats": 16.0, "texture": "scree""#;
    assert_eq!(accepted(&[("zones", &zones(more))]).zones[1].repeats, 16);
    for (field, value, parts) in [
        ("variation", "-0.1", ["variation = -0.1: ", "0..=1"]),
        ("variation", "1.01", ["variation = 1.01: ", "0..=1"]),
        ("triplanar", "1", ["triplanar", "boolean"]),
    ] {
        refused(&[(field, value)], &parts);
    }
}

#[test]
fn patch_size_is_a_power_of_two_and_one() {
    for size in ["4", "256", "258", "4096"] {
        refused(&[("patchSize", size)], &[&format!("patchSize = {size}: "), "2^n + 1", "1..=12"]);
    }
    for size in ["2", "1", "0", "-3", "4098", "8193", "257.5", "9007199254740993"] {
        refused(&[("patchSize", size)], &[&format!("patchSize = {size}: "), "3..=4097"]);
    }
}

#[test]
fn fields_that_are_missing_doubled_or_unknown_are_named() {
    for field in ["patchSize", "scaleFactor", "seed"] {
        refused(&[(field, "")], &["missing field", &format!("`{field}`")]);
    }
    refused(&[("patchsize", "33")], &["unknown field `patchsize`", "`patchSize`"]);
    refused(&[("smoothness", "1")], &["smoothness = 1: unknown field `smoothness`", "`roughness`"]);
    let zone = r#"[{"min": 0, "max": 1, "colour": "red"}]"#;
    refused(&[("zones", zone)], &["unknown field `colour`", "`texture`"]);
    refused(&[("zones", r#"[{"min": 0}]"#)], &["missing field `max`"]);
    let doubled = r#"{"patchSize": 33, "seed": "", "scaleFactor": 1, "scaleFactor": 2}"#;
    refuses(TerrainConfig::from_json(doubled), &["duplicate field `scaleFactor`"]);
}

#[test]
fn what_is_not_one_json_object_is_refused_with_its_place() {
    refuses(TerrainConfig::from_json(""), &["config = line 1 column 0", "EOF"]);
    refuses(TerrainConfig::from_json("terrain"), &["config = line 1"]);
    refuses(TerrainConfig::from_json("null"), &["config = line 1"]);
    refuses(TerrainConfig::from_json("\"257\""), &["config = line 1"]);
    refuses(TerrainConfig::from_json(&json(&[]).replace('}', "")), &["config = line 1", "EOF"]);
    let error = TerrainConfig::from_json(r#"{"patchSize": 33, "seed": ""}"#).expect_err("no scale");
    assert_eq!(error.to_string().matches("line 1 column").count(), 1, "{error}");
    refuses(TerrainConfig::from_json(&json(&[("scaleFactor", "NaN")])), &["line 1", "expected value"]);
    for rest in ["}", " {}", "\n, 1", "x"] {
        refuses(TerrainConfig::from_json(&(json(&[]) + rest)), &["config = line", "trailing characters"]);
    }
    assert!(TerrainConfig::from_json(&(json(&[]) + " \n")).is_ok());
}

#[test]
fn values_of_another_type_are_refused_with_path_value_and_bound() {
    for (field, value, message) in [
        ("seed", "3", "seed = 3: must be a string"),
        ("patchSize", r#""x""#, "patchSize = x: must be a number"),
        ("scaleFactor", "[40]", "scaleFactor = [40]: must be a number"),
        ("interpolation", "3", "interpolation = 3: must be `linear` or `smooth`"),
        ("interpolation", r#""cubic""#, "interpolation = cubic: must be `linear` or `smooth`"),
        ("offset", "{}", "offset = {}: must be one of `signed`, `positive`, `gaussian`"),
        ("corners", r#""high""#, "corners = high: must be a height or an array of four heights"),
        ("border", "true", "border = true: must be \"seamless\", \"wrap\" or {\"blend\": samples}"),
        ("zones", "{}", "zones = {}: must be a list"),
        (
            "zones",
            r#"[{"min": 0, "max": 1, "repeats": -1}]"#,
            "zones[0].repeats = -1: must be a whole number in 1..=16",
        ),
        ("zones", r#"[{"min": 0, "max": 1, "slope": 4}]"#, "zones[0].slope = 4: must be an object"),
        ("zones", r#"[{"min": 0}]"#, "zones[0] = {\"min\":0}: missing field `max`"),
        ("thermal", "{}", "thermal = {}: missing field `iterations`"),
        ("hydraulic", r#"{"rain": "a"}"#, "hydraulic.rain = a: must be a number"),
    ] {
        let error = Recipe::from_json(&json(&[(field, value)])).expect_err(value).to_string();
        assert_eq!(error, message);
    }
    let long = format!("\"{}\"", "x".repeat(100));
    let error = TerrainConfig::from_json(&json(&[("patchSize", &long)])).expect_err("no number");
    assert_eq!(error.value, format!("{}…", "x".repeat(60)));
}

#[test]
fn numbers_below_their_bound_are_refused() {
    refused(&[("scaleFactor", "-1")], &["scaleFactor = -1: ", "≥ 0"]);
    refused(&[("scaleFactor", "-1e-300")], &["scaleFactor = -0.0", "≥ 0"]);
    refused(&[("roughness", "-0.5")], &["roughness = -0.5: ", "≥ 0"]);
    for scale in ["0", "-1", "9e-7", "1.1e6"] {
        let shown: f64 = scale.parse().expect("a number");
        refused(&[("terrainScale", scale)], &[&format!("terrainScale = {shown}: "), "0.000001..=1000000"]);
    }
    accepted(&[("terrainScale", "1e-6")]);
    accepted(&[("terrainScale", "1e6")]);
    // A patch of 33 samples is 16 units wide here, and may hold 16,384 tiles.
    for tile in ["0", "-2.5", "0.0009765624"] {
        refused(
            &[("terrainScale", "0.5"), ("textureTile", tile)],
            &[&format!("textureTile = {tile}: "), "≥ 0.0009765625"],
        );
    }
    accepted(&[("terrainScale", "0.5"), ("textureTile", "0.0009765625")]);
}

#[test]
fn texture_tiles_are_counted_in_world_units() {
    let tiles = |changes: &[(&str, &str)]| accepted(changes).tiles_per_patch();
    assert_eq!(tiles(&[]), 10.0);
    assert_eq!(tiles(&[("terrainScale", "0.25")]), 2.5);
    assert_eq!(tiles(&[("textureTile", "3.2")]), 10.0);
    assert_eq!(tiles(&[("textureTile", "64"), ("terrainScale", "0.25")]), 0.125);
    assert_eq!(tiles(&[("textureTile", "2"), ("terrainScale", "0.25")]), 4.0);
}

#[test]
fn numbers_that_are_not_finite_are_refused() {
    let refuses_all = |break_one: fn(&mut TerrainConfig, f64), field: &str| {
        for value in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
            let mut config = accepted(&[("border", "\"wrap\"")]);
            break_one(&mut config, value);
            refuses(config.validate(), &[&format!("{field} = {value}: "), "number"]);
        }
    };
    refuses_all(|config, value| config.scale_factor = value, "scale_factor");
    refuses_all(|config, value| config.roughness = value, "roughness");
    refuses_all(|config, value| config.terrain_scale = value, "terrain_scale");
    refuses_all(|config, value| config.texture_tile = Some(value), "texture_tile");
    refuses_all(|config, value| config.corners[2] = value, "corners[2]");
    refuses_all(|config, value| config.variation = value, "variation");
    refuses_all(|config, value| config.zones[2].slope.fade = value, "zones[2].slope.fade");
    refuses_all(|config, value| config.zones[2].height_blend = value, "zones[2].height_blend");
    refuses_all(|config, value| config.zones[1].min = value, "zones[1].min");
    refuses_all(|config, value| config.zones[3].max = value, "zones[3].max");
}

#[test]
fn a_number_beyond_f64_is_refused_and_its_field_is_named() {
    for field in
        ["patchSize", "scaleFactor", "roughness", "coarseLevels", "terrainScale", "textureTile", "corners"]
    {
        refused(&[(field, "1e999")], &[field, "out of range"]);
    }
    refused(&[("zones", r#"[{"min": 0, "max": 1e999}]"#)], &["zones[0].max", "out of range"]);
    refused(&[("border", r#"{"blend": 1e999}"#)], &["border", "out of range"]);
}

#[test]
fn a_value_of_the_wrong_type_is_refused_and_its_field_is_named() {
    refused(&[("patchSize", "\"257\"")], &["patchSize", "257", "number"]);
    refused(&[("scaleFactor", "\"steep\"")], &["scaleFactor", "steep"]);
    refused(&[("scaleFactor", "null")], &["scaleFactor", "null"]);
    refused(&[("seed", "5")], &["seed", "5", "string"]);
    refused(&[("coarseLevels", "true")], &["coarseLevels", "true", "number"]);
    refused(&[("corners", "[1, 2, 3]")], &["corners", "four heights"]);
    refused(&[("zones", "3")], &["zones = 3: must be a list"]);
}

#[test]
fn an_unknown_word_is_refused_with_its_field() {
    refused(&[("offset", "\"foo\"")], &["offset", "foo", "`signed`", "`positive`", "`gaussian`"]);
    refused(&[("border", "\"foo\"")], &["border", "foo", "\"seamless\"", "\"wrap\"", "\"blend\""]);
}

#[test]
fn a_list_is_no_configuration() {
    refuses(TerrainConfig::from_json(r#"[33, 40.0, "any text"]"#), &["config"]);
    refuses(FeatureFile::from_json("[[0, 0], [1, 2, 3.5]]"), &["features"]);
    refused(&[("zones", "[[0, 1]]")], &["zones"]);
    refused(&[("border", "[5]")], &["border"]);
}

#[test]
fn coarse_levels_are_bounded_and_for_seamless_only() {
    for levels in ["9", "-1", "1.5"] {
        refused(&[("coarseLevels", levels)], &[&format!("coarseLevels = {levels}: "), "0..=8"]);
    }
    for border in ["\"wrap\"", "{\"blend\": 4}"] {
        let changes = [("coarseLevels", "1"), ("border", border)];
        refused(&changes, &["coarseLevels = 1: ", "must be 0", "seamless"]);
    }
}

#[test]
fn a_configuration_made_by_hand_is_checked_as_well() {
    let config = accepted(&[]);
    refuses(TerrainConfig { patch_size: 34, ..config.clone() }.validate(), &["patch_size = 34: ", "2^n + 1"]);
    refuses(
        TerrainConfig { coarse_levels: 9, ..config.clone() }.validate(),
        &["coarse_levels = 9: ", "0..=8"],
    );
    refuses(
        TerrainConfig { border: Border::Blend(0), ..config.clone() }.validate(),
        &["border.blend = 0: ", "1..=32"],
    );
    refuses(TerrainConfig { zones: Vec::new(), ..config }.validate(), &["zones = [0 zones]: ", "1 to 32"]);
    refuses(TerrainConfig::new(256, 40.0, "any text"), &["patch_size = 256: ", "2^n + 1"]);
}

#[test]
fn corners_are_for_wrap_and_blend_only() {
    refused(&[("corners", "[0, 0, 2.5, 0]")], &["corners = [0.0, 0.0, 2.5, 0.0]", "wrap", "blend"]);
    refused(&[("corners", "7")], &["corners = [7.0, 7.0, 7.0, 7.0]", "wrap", "blend"]);
}

#[test]
fn border_is_one_of_three() {
    for border in ["\"foo\"", "\"blend\"", "{}", "{\"wrap\": 1}", "{\"blend\": 2, \"width\": 2}", "3"] {
        refused(&[("border", border)], &["border", "\"seamless\", \"wrap\" or {\"blend\": samples}"]);
    }
    for width in ["0", "-1", "1.5", "4097"] {
        let border = format!("{{\"blend\": {width}}}");
        refused(&[("border", &border)], &[&format!("border.blend = {width}: "), "1..=4096"]);
    }
    refused(&[("border", "{\"blend\": 33}")], &["border.blend = 33: ", "1..=32", "one sample more"]);
    assert_eq!(accepted(&[("border", "{\"blend\": 32}")]).border, Border::Blend(32));
}

#[test]
fn zones_are_one_to_32_ranges() {
    let zones = |count: usize| format!("[{}]", vec![r#"{"min": 0, "max": 1}"#; count].join(","));
    for count in [0, 33] {
        let parts = [&format!("zones = [{count} zones]: "), "1 to 32"];
        refused(&[("zones", &zones(count))], &parts);
    }
    for count in [1, 32] {
        assert_eq!(accepted(&[("zones", &zones(count))]).zones.len(), count);
    }
    for max in ["2.5", "2.25", "-7"] {
        let zones = format!(r#"[{{"min": 0, "max": 1}}, {{"min": 2.5, "max": {max}}}]"#);
        refused(&[("zones", &zones)], &[&format!("zones[1].max = {max}: "), "above min = 2.5"]);
    }
    refused(&[("zones", r#"[{"min": -32769, "max": 1}]"#)], &["zones[0].min = -32769: ", "-32768..=32768"]);
    refused(&[("zones", r#"[{"min": 0, "max": 32769}]"#)], &["zones[0].max = 32769: ", "-32768..=32768"]);
    accepted(&[("zones", r#"[{"min": -32768, "max": 32768}]"#)]);
}

/// A height of `fixed` 1/65536 units, as JSON writes it.
fn units(fixed: i64) -> String {
    (fixed as f64 / 65_536.0).to_string()
}

/// The largest integer n with `times` · n ≤ 2^30 − 1, and the integer after it.
fn around_limit(times: i64) -> [String; 2] {
    let largest = ((1 << 30) - 1) / times;
    [units(largest), units(largest + 1)]
}

#[test]
fn heights_that_could_overflow_are_refused() {
    let refuses = |changes: &[(&str, &str)], scale: &str| {
        refused(
            changes,
            &[&format!("scaleFactor = {scale}: "), "heights could reach", "the bound is 16383.99998"],
        );
    };
    refuses(&[("scaleFactor", "9000")], "9000");
    refuses(&[("scaleFactor", "1000"), ("roughness", "0"), ("coarseLevels", "8")], "1000");
    accepted(&[("scaleFactor", "1000"), ("roughness", "0")]);
    // In `seamless` with roughness 0, the largest height is B_L = r_0 + 2·L·r_0.
    for (size, coarse_levels, levels) in [("3", "0", 1), ("257", "0", 8), ("4097", "8", 20)] {
        let [largest, next] = around_limit(1 + 2 * levels);
        let changes = |scale| {
            [("patchSize", size), ("coarseLevels", coarse_levels), ("roughness", "0"), ("scaleFactor", scale)]
        };
        accepted(&changes(&largest));
        refuses(&changes(&next), &next);
    }
}

#[test]
fn default_zones_do_not_hide_what_the_scale_is() {
    for scale in ["20000", "1e300"] {
        refused(&[("scaleFactor", scale)], &["scaleFactor = ", "heights could reach"]);
    }
    accepted(&[("scaleFactor", "1e-50")]);
}

#[test]
fn corners_that_could_overflow_are_refused() {
    let [largest, next] = around_limit(1);
    for border in ["\"wrap\"", "{\"blend\": 2}"] {
        let changes = |corner| [("border", border), ("scaleFactor", "0"), ("corners", corner)];
        accepted(&changes(&largest));
        refused(&changes(&next), &["corners", "16384"]);
        let corners = format!("[0, 0, -{next}, 0]");
        refused(&changes(&corners), &["corners", "16384"]);
    }
    // With one level, the largest height is C + 2·r_0 for corners of height C.
    let [largest, next] = [0, 1].map(|more| units((1 << 30) - 1 - 2 * 65_536 + more));
    let one = [("patchSize", "3"), ("border", "\"wrap\""), ("scaleFactor", "1")];
    accepted(&[&one[..], &[("corners", &largest)]].concat());
    refused(
        &[&one[..], &[("corners", &next)]].concat(),
        &["heights could reach", "the bound is 16383.99998"],
    );
}

#[test]
fn a_height_beyond_all_bounds_is_named_itself() {
    for corner in ["20000", "-2e9"] {
        let corners = format!("[0, {corner}, 0, 0]");
        let value = format!("corners[1] = {}: ", corner.parse::<f64>().expect("a number"));
        refused(&[("border", "\"wrap\""), ("corners", &corners)], &[&value, "16383.99"]);
    }
    refuses(kept(&[([0, 0], "0, 0, 16384")]), &["precomputedHeights[2] = 16384: ", "below 16384"]);
}

/// Feature files of (patch, heights), read from JSON and checked.
fn features(
    config: &TerrainConfig,
    files: &[([i32; 2], &str)],
    mode: FeatureMode,
) -> Result<Features, InputError> {
    let text = |([x, y], heights): &([i32; 2], &str)| {
        format!("{{\"patchCoordinates\": [{x}, {y}], \"precomputedHeights\": [{heights}]}}")
    };
    let files: Result<Vec<_>, _> = files.iter().map(|file| FeatureFile::from_json(&text(file))).collect();
    // Whoever reads files tells the names that stand in them.
    Features::new(config, &files?, mode).map_err(InputError::in_json)
}

fn kept(files: &[([i32; 2], &str)]) -> Result<Features, InputError> {
    features(&accepted(&[]), files, FeatureMode::Keep)
}

#[test]
fn edge_cases_of_features_are_accepted() {
    assert!(kept(&[]).expect("no file").is_empty());
    assert!(kept(&[([0, 0], "")]).expect("an empty list").is_empty());
    let corners = "0, 0, -10.5, 32, 0, 1e-9, 0, 32, 0, 32.0, 32, 100";
    assert_eq!(kept(&[([-3, 7], corners)]).expect("the corners").len(), 4);
}

#[test]
fn feature_files_with_missing_or_unknown_keys_are_refused() {
    let refuses = |text: &str, parts: &[&str]| refuses(FeatureFile::from_json(text), parts);
    refuses(r#"{"precomputedHeights": []}"#, &["missing field `patchCoordinates`"]);
    refuses(r#"{"patchCoordinates": [0, 0]}"#, &["missing field `precomputedHeights`"]);
    let unknown = r#"{"patchCoordinates": [0, 0], "precomputedHeights": [], "mode": "keep"}"#;
    refuses(unknown, &["unknown field `mode`", "`patchCoordinates`"]);
    refuses("", &["features = line 1 column 0", "EOF"]);
    refuses("heights", &["features = line 1"]);
    refuses(
        r#"{"patchCoordinates": [0, 0], "precomputedHeights": []}]"#,
        &["features", "trailing characters"],
    );
}

#[test]
fn feature_values_of_the_wrong_type_are_refused_and_their_field_is_named() {
    refuses(kept(&[([0, 0], "1, 2, \"high\"")]), &["precomputedHeights[2]", "high"]);
    refuses(kept(&[([0, 0], "1, 2, null")]), &["precomputedHeights[2]", "null"]);
    refuses(kept(&[([0, 0], "1, 2, 1e999")]), &["precomputedHeights[2]", "out of range"]);
    for patch in ["[0.5, 0]", "[3000000000, 0]"] {
        let text = format!("{{\"patchCoordinates\": {patch}, \"precomputedHeights\": []}}");
        refuses(
            FeatureFile::from_json(&text),
            &["patchCoordinates[0]", &patch[1..patch.len() - 4], "must be a whole number that fits i32"],
        );
    }
    let one = r#"{"patchCoordinates": [0], "precomputedHeights": []}"#;
    refuses(FeatureFile::from_json(one), &["patchCoordinates = [0]: ", "length 2"]);
}

#[test]
fn feature_lists_are_whole_triples() {
    for (count, heights) in [(1, "1"), (2, "1, 2"), (4, "1, 2, 3, 4"), (5, "1, 2, 3, 4, 5")] {
        let value = format!("precomputedHeights = [{count} numbers]: ");
        refuses(kept(&[([0, 0], heights)]), &[&value, "multiple of 3"]);
    }
}

#[test]
fn feature_coordinates_lie_in_their_patch() {
    for value in ["-1", "33", "1.5", "0.1", "-0.5", "1e300"] {
        let shown = value.parse::<f64>().expect("a number").to_string();
        let parts =
            |index| [format!("precomputedHeights[{index}] = {shown}: "), "0..=32 (a patch has".to_owned()];
        let refuses = |heights: String, index| {
            refuses(kept(&[([0, 0], &heights)]), &parts(index).each_ref().map(String::as_str));
        };
        refuses(format!("{value}, 0, 5"), 0);
        refuses(format!("0, 0, 5, 3, {value}, 5"), 4);
    }
}

#[test]
fn feature_heights_are_bounded() {
    for height in ["20000", "-20000", "16384.5"] {
        let value = format!("precomputedHeights[5] = {height}: ");
        refuses(kept(&[([0, 0], &format!("0, 0, 1, 0, 1, {height}"))]), &[&value, "below 16384"]);
    }
    for height in [f64::NAN, f64::INFINITY] {
        let file = FeatureFile { patch_coordinates: [0, 0], precomputed_heights: vec![0.0, 0.0, height] };
        let value = format!("precomputed_heights[2] = {height}: ");
        refuses(Features::new(&accepted(&[]), &[file], FeatureMode::Keep), &[&value, "finite"]);
    }
}

#[test]
fn features_that_could_overflow_are_refused() {
    // With roughness 0 and a range of r, heights reach r + 2·L·r + F where features of height F are kept, and 2·L·F more
    // where they are added.
    for (mode, size, levels) in
        [(FeatureMode::Keep, "33", 5), (FeatureMode::Additive, "3", 1), (FeatureMode::Additive, "33", 5)]
    {
        let config = accepted(&[("patchSize", size), ("scaleFactor", "1"), ("roughness", "0")]);
        let times = if mode == FeatureMode::Additive { 1 + 2 * levels } else { 1 };
        let largest = ((1 << 30) - 1 - (1 + 2 * levels) * 65_536) / times;
        let inject = |height| features(&config, &[([0, 0], &format!("2, 2, -{}", units(height)))], mode);
        assert!(inject(largest).is_ok(), "{largest} {mode:?}");
        refuses(inject(largest + 1), &["heights could reach 16384", "features", "the bound is 16383.99998"]);
    }
}

#[test]
fn a_configuration_that_overflows_with_the_features_of_another_is_refused() {
    let quiet = accepted(&[("scaleFactor", "1")]);
    let features =
        features(&quiet, &[([0, 0], "0, 0, 1000")], FeatureMode::Additive).expect("11·1000 units fit");
    let loud = accepted(&[("scaleFactor", "2000")]);
    let recipe =
        |config: &TerrainConfig| Recipe { features: features.clone(), ..Recipe::new(config.clone()) };
    assert_eq!(recipe(&quiet).validate(&[[0, 0]], 0), Ok(()));
    refuses(recipe(&loud).validate(&[[0, 0]], 0), &["scale_factor = 2000: ", "heights could reach"]);
}

#[test]
fn a_point_has_one_height() {
    let parts = ["point (3, 4)", "already has the height 1.5", "one"];
    refuses(
        kept(&[([2, -1], "3, 4, 1.5, 3, 4, 1.75")]),
        &[&parts[..], &["precomputedHeights[5] = 1.75"]].concat(),
    );
    let files = [([2, -1], "3, 4, 1.5"), ([2, -1], "0, 0, 1, 3, 4, -2")];
    refuses(kept(&files), &[&parts[..], &["patch (2, -1)", "precomputedHeights[5] = -2"]].concat());
    let twice = kept(&[([2, -1], "3, 4, 1.5, 3, 4, 1.5"), ([2, -1], "3, 4, 1.5")]);
    assert_eq!(twice.expect("equal heights").len(), 1);
}

#[test]
fn a_point_that_patches_share_has_one_height() {
    let shared = [
        ([0, 0], "32, 5", [1, 0], "0, 5"),
        ([-1, -1], "7, 32", [-1, 0], "7, 0"),
        ([0, 0], "32, 32", [1, 1], "0, 0"),
        ([1, 0], "0, 32", [0, 1], "32, 0"),
    ];
    for (first, here, second, there) in shared {
        let inject = |low, high| {
            kept(&[(first, &format!("{here}, {low}") as &str), (second, &format!("{there}, {high}"))])
        };
        assert_eq!(inject(8, 8).expect("equal heights").len(), 1);
        let [x, y] = second;
        let point = format!("patch ({x}, {y}) point ({there})");
        refuses(inject(8, 9), &["precomputedHeights[2] = 9: ", &point, "already has the height 8"]);
    }
    let apart = kept(&[([0, 0], "32, 5, 8"), ([1, 0], "1, 5, 9")]);
    assert_eq!(apart.expect("two points").len(), 2);
}

#[test]
fn patches_stay_within_the_world() {
    // (border, coarseLevels, the first and the last patch)
    for (border, coarse_levels, ends) in [
        ("\"seamless\"", "0", [-524_287, 524_285]),
        ("\"seamless\"", "8", [-524_032, 523_775]),
        ("\"wrap\"", "0", [-524_288, 524_286]),
        ("{\"blend\": 3}", "0", [-524_288, 524_286]),
    ] {
        let recipe = Recipe::new(accepted(&[("border", border), ("coarseLevels", coarse_levels)]));
        let validate = |patch: [i32; 2]| recipe.validate(&[[0, 0], patch], 0);
        for (end, beyond) in [(ends[0], ends[0] - 1), (ends[1], ends[1] + 1)] {
            assert_eq!(validate([end, end]), Ok(()), "{border} {coarse_levels}");
            refuses(validate([beyond, end]), &[&format!("patchCoordinates[0] = {beyond}: "), "i32"]);
            refuses(validate([end, beyond]), &[&format!("patchCoordinates[1] = {beyond}: "), "i32"]);
        }
        for end in [i32::MIN, i32::MAX] {
            refuses(validate([0, end]), &[&format!("patchCoordinates[1] = {end}: "), "i32"]);
        }
    }
}

#[test]
fn windows_reach_no_further_than_the_patches_there_are() {
    for border in ["\"wrap\"", "{\"blend\": 5}"] {
        let recipe = Recipe::new(accepted(&[("border", border)]));
        assert_eq!(recipe.validate(&[[0, 0]], 32), Ok(()));
        refuses(recipe.validate(&[[0, 0]], 33), &["apron = 33: ", "below patchSize = 33", "wrap"]);
        let erosion = |iterations| Some(Thermal { iterations, ..Thermal::default() });
        let despike = Some(Despike { threshold: 1.0 });
        let recipe = |iterations| Recipe { despike, thermal: erosion(iterations), ..recipe.clone() };
        assert_eq!(recipe(30).validate(&[[0, 0]], 1), Ok(()));
        refuses(recipe(31).validate(&[[0, 0]], 1), &["apron = 33: ", "below patchSize = 33"]);
    }
    let seamless = Recipe::new(accepted(&[]));
    assert_eq!(seamless.validate(&[[0, 0]], 4096), Ok(()));
    refuses(seamless.validate(&[[0, 0]], 4097), &["apron = 4097: ", "at most 4096"]);
}

#[test]
fn what_happens_after_generation_is_bounded() {
    let despike = |threshold| Despike { threshold }.validate();
    let thermal = |iterations, talus| Thermal { iterations, talus }.validate();
    let morph = |time| Morph { time }.validate();
    for good in
        [despike(0.0), despike(16_383.0), thermal(0, 0.0), thermal(1024, 89.0), morph(0.0), morph(1.0)]
    {
        assert_eq!(good, Ok(()));
    }
    for bad in [-0.5, 16_383.5, f64::NAN, f64::INFINITY] {
        refuses(despike(bad), &[&format!("despike.threshold = {bad}: "), "0..=16383"]);
    }
    refuses(thermal(1025, 35.0), &["thermal.iterations = 1025: ", "at most 1024"]);
    for bad in [-0.5, 89.5, f64::NAN] {
        refuses(thermal(1, bad), &[&format!("thermal.talus = {bad}: "), "0..=89"]);
    }
    for bad in [-0.25, 1.25, f64::NAN] {
        refuses(morph(bad), &[&format!("time = {bad}: "), "0..=1"]);
    }
}

#[test]
fn files_are_named_with_what_is_wrong_in_them() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let path = folder.path().join("terrain.json");
    let missing = TerrainConfig::from_file(&path).map(|_| ()).expect_err("there is no such file").to_string();
    assert!(missing.contains("terrain.json"), "{missing}");
    let text = r#"{"patchSize": 256, "scaleFactor": 1, "seed": ""}"#;
    std::fs::write(&path, text).expect("a file is written");
    let wrong = TerrainConfig::from_file(&path).map(|_| ()).expect_err("256 is no patch size").to_string();
    assert!(wrong.contains("terrain.json: patchSize = 256: must be 2^n + 1"), "{wrong}");
    let wrong = FeatureFile::from_file(&path).map(|_| ()).expect_err("not features").to_string();
    assert!(wrong.contains("terrain.json: ") && wrong.contains("unknown field `patchSize`"), "{wrong}");
}
