//! `relievo priorities`

use serde_json::Value;

use crate::harness::relievo;

fn run(more: &[&str]) -> (String, Value) {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let file = folder.path().join("priorities.json");
    let file_name = file.to_str().expect("UTF-8");
    let run = relievo(
        &[&["priorities", "--model", "builtin", "--clip", "walk", "--json", file_name], more].concat(),
    );
    assert_eq!(run.code, Some(0), "{}", run.stderr);
    (run.stdout, serde_json::from_slice(&std::fs::read(file).expect("written")).expect("JSON"))
}

fn number(value: &Value) -> f64 {
    value.as_f64().expect("a number")
}

#[test]
fn the_table_is_sorted_and_adds_up() {
    let chosen = ["--weights", "0.5,0.1,0.1,0.1,0.1,0.1"];
    for more in [&[][..], &["--weights", "analyze"], &chosen, &["--wrap", "clamp"]] {
        let (text, json) = run(more);
        let keys = json["keys"].as_array().expect("a list");
        // The table has a heading of two lines.
        assert_eq!(text.lines().count(), keys.len() + 2);
        assert!(keys.len() > 1000);
        let weights = json["weights"].as_object().expect("an object");
        assert!((weights.values().map(number).sum::<f64>() - 1.0).abs() < 1e-9);
        for pair in keys.windows(2) {
            assert!(number(&pair[0]["priority"]) >= number(&pair[1]["priority"]));
        }
        for key in keys {
            let sum: f64 =
                weights.iter().map(|(term, weight)| number(weight) * number(&key["terms"][term])).sum();
            assert!((sum - number(&key["priority"])).abs() < 1e-6, "{key}");
        }
        let first = text.lines().nth(2).expect("a row");
        assert!(first.contains(keys[0]["name"].as_str().expect("a name")), "{first}");
    }
    let (_, json) = run(&chosen);
    assert_eq!(json["weights"]["translation"], 0.5);
}

#[test]
fn bad_weights_are_refused() {
    for (weights, words) in [
        ("1,2,3", &["weights", "1,2,3", "analyze"][..]),
        ("0.5,0.5,0.5,0,0,0", &["weights", "1.5", "sum to 1"]),
        ("-1,2,0,0,0,0", &["weights.translation", "-1"]),
        ("a,b,c,d,e,f", &["weights"]),
    ] {
        let run = relievo(&["priorities", "--model", "builtin", "--clip", "walk", "--weights", weights]);
        assert_eq!((run.code, run.stderr.lines().count()), (Some(2), 1), "{}", run.stderr);
        assert!(words.iter().all(|word| run.stderr.contains(word)), "{words:?} not in: {}", run.stderr);
        assert!(run.stdout.is_empty());
    }
}
