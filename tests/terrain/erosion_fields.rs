//! Every field of erosion and of blends over time is refused out of its bounds, with its path, its value and the bound.

use relievo::InputError;
use relievo::ops::terrain::morph::Morph;
use relievo::ops::terrain::recipe::Recipe;

/// Objects of a configuration, their fields, values out of bounds, and the bound.
const BOUNDS: &[(&str, &str, &[&str], &str)] = &[
    ("hydraulic", "iterations", &["-1", "2049", "1.5"], "0..=2048"),
    ("hydraulic", "rain", &["-0.001", "1.001"], "0..=1"),
    ("hydraulic", "evaporation", &["-0.001", "1.001"], "0..=1"),
    ("hydraulic", "capacity", &["-1", "1024.5"], "0..=1024"),
    ("hydraulic", "threshold", &["-1", "65536.5"], "0..=65536"),
    ("hydraulic", "erosion", &["-0.001", "1.001"], "0..=1"),
    ("hydraulic", "deposition", &["-0.001", "1.001"], "0..=1"),
    ("hydraulic", "talus", &["-1", "89.5"], "0..=89"),
    ("hydraulic", "creep", &["-0.001", "0.063"], "0..=0.0625"),
    ("thermal", "iterations", &["-1", "1025", "1.5"], "0..=1024"),
    ("thermal", "talus", &["-1", "90"], "0..=89"),
    ("thermalAfter", "iterations", &["-1", "1025", "1.5"], "0..=1024"),
    ("thermalAfter", "talus", &["-1", "90"], "0..=89"),
];

/// Reads a configuration with an object that has a field.
fn read(object: &str, field: &str, value: &str) -> Result<Recipe, InputError> {
    let iterations = if field == "iterations" { "" } else { r#""iterations": 3, "# };
    Recipe::from_json(&format!(
        r#"{{"patchSize": 33, "scaleFactor": 9, "seed": "s", "{object}": {{{iterations}"{field}": {value}}}}}"#
    ))
}

#[test]
fn every_field_of_erosion_is_bounded() {
    for (object, field, values, bound) in BOUNDS {
        for value in *values {
            let error = read(object, field, value).expect_err("refused");
            assert_eq!((error.path.as_str(), error.value.as_str()), (&*format!("{object}.{field}"), *value));
            assert!(error.bound.contains(bound), "{error}");
        }
        // Both ends of the range belong to it.
        let ends = bound.split("..=");
        assert!(
            ends.clone().count() == 2 && ends.clone().all(|end| read(object, field, end).is_ok()),
            "{bound}"
        );
        for value in ["\"3\"", "[3]", "1e999"] {
            let Err(error) = read(object, field, value) else {
                panic!("{object}.{field} = {value} was accepted")
            };
            assert!(error.path.starts_with(object) || error.path == *object, "{error}");
        }
    }
}

#[test]
fn erosion_has_these_fields_and_no_others() {
    for object in ["hydraulic", "thermal", "thermalAfter"] {
        let error = read(object, "snow", "1").expect_err("refused").to_string();
        let known = BOUNDS.iter().filter(|(of, ..)| *of == object).map(|(_, field, ..)| field);
        assert!(known.clone().all(|field| error.contains(&format!("`{field}`"))), "{error}");
        // The unknown one, and those of the table.
        let quoted = error.split('`').count() / 2;
        assert_eq!(quoted, 1 + known.count(), "{error}");
    }
}

#[test]
fn times_of_blends_are_from_0_to_1() {
    for time in [0.0, 0.5, 1.0] {
        assert_eq!(Morph { time }.validate(), Ok(()));
    }
    for time in [-1e-9, 1.0 + 1e-9, f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        let error = Morph { time }.validate().expect_err("refused");
        assert_eq!((error.path.as_str(), error.value), ("time", time.to_string()));
        assert!(error.bound.contains("0..=1"), "{}", error.bound);
    }
}
