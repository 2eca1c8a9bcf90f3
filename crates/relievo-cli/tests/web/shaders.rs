//! The browser's compiler accepts every shader and module, and refuses some that are wrong on purpose.

use std::collections::HashSet;
use std::sync::OnceLock;
use std::time::{Duration, Instant};

use naga::{Expression, Function, Handle};
use serde_json::{Value, json};

use crate::harness::browser;
use crate::plan::{Written, is_varied, job_of, name_of};

/// A literal just above the largest f32.
const BEYOND_F32: &str = "const LARGEST = 3.40282347e38;
@group(0) @binding(0) var<storage, read_write> out: array<f32>;
@compute @workgroup_size(1) fn main() { out[0] = LARGEST; }";

/// An entry point whose only fault is an index of the wrong type.
const ILL_TYPED: &str = "@group(0) @binding(0) var<storage, read_write> out: array<f32>;
@compute @workgroup_size(1) fn main() { out[0] = 1u; }";

/// The results of one page load, which all tests of this file examine.
pub struct Said {
    written: Written,
    result: Value,
}

pub fn said() -> &'static Said {
    static SAID: OnceLock<Said> = OnceLock::new();
    SAID.get_or_init(|| {
        let written = Written::now();
        let jobs = [written.jobs(), modules(&written), faults()].concat();
        let limits = ["maxStorageBuffersPerShaderStage", "maxComputeInvocationsPerWorkgroup"];
        let plan = json!({ "jobs": jobs, "limits": limits }).to_string();
        let files = [("/", include_bytes!("shaders.html").as_slice()), ("/plan.json", plan.as_bytes())];
        let start = Instant::now();
        let program = browser::program().expect("the suite needs a browser");
        let result = browser::visit(&program, &files, Duration::from_secs(600)).expect("a result");
        println!("{} in {:.1} s", result["adapter"], start.elapsed().as_secs_f32());
        Said { written, result }
    })
}

/// Each module by itself, and each in front of a shader of another program.
fn modules(written: &Written) -> Vec<Value> {
    let mut jobs = Vec::new();
    for (name, source) in &written.modules {
        let path = format!("{}/tests/modules/{name}.wgsl", relievo_testing::root().display());
        let user = std::fs::read_to_string(&path).unwrap_or_else(|error| panic!("{path}: {error}"));
        jobs.push(json!({ "name": format!("module {name}"), "code": source, "pipelines": [] }));
        let pipeline = json!({ "label": format!("user of {name}"), "constants": {}, "compute": "main" });
        jobs.push(json!({
            "name": format!("user of {name}"),
            "code": format!("{source}\n{user}"),
            "pipelines": [pipeline],
        }));
    }
    let everything: Vec<_> = written.modules.iter().map(|(_, source)| source.as_str()).collect();
    jobs.push(json!({ "name": "all modules", "code": everything.join("\n"), "pipelines": [] }));
    jobs
}

/// Shaders that must be refused, with names that begin with `fault: `.
fn faults() -> Vec<Value> {
    let pipeline = |constants: Value| json!({ "label": "fault", "constants": constants, "compute": "main" });
    let storage = |kind: &str| json!([[{ "binding": 0, "visibility": 4, "buffer": { "type": kind } }]]);
    let fine = "@group(0) @binding(0) var<storage, read_write> out: array<f32>;
@compute @workgroup_size(1) fn main() { out[0] = 1.0; }";
    let job = |name: &str, code: &str, groups: Value, constants: Value| json!({ "name": format!("fault: {name}"), "code": code, "groups": groups, "pipelines": [pipeline(constants)] });
    vec![
        job("literal", BEYOND_F32, Value::Null, json!({})),
        job("type", ILL_TYPED, Value::Null, json!({})),
        job("nine buffers", &bound(9), Value::Null, json!({})),
        job("layout", fine, storage("read-only-storage"), json!({})),
        job("constant", fine, storage("storage"), json!({ "NOTHING": 1 })),
        job("none", fine, storage("storage"), json!({})),
        job("eight buffers", &bound(8), Value::Null, json!({})),
    ]
}

/// A shader that binds `buffers` storage buffers.
fn bound(buffers: u32) -> String {
    let declared: String = (0..buffers)
        .map(|at| format!("@group(0) @binding({at}) var<storage, read_write> b{at}: array<f32>;\n"))
        .collect();
    let written: String = (0..buffers).map(|at| format!("b{at}[0] = 1.0; ")).collect();
    format!("{declared}@compute @workgroup_size(1) fn main() {{ {written}}}")
}

fn jobs() -> &'static [Value] {
    let result = &said().result;
    result["jobs"].as_array().unwrap_or_else(|| panic!("the page failed: {result}"))
}

fn job(name: &str) -> &'static Value {
    jobs().iter().find(|job| job["name"] == name).unwrap_or_else(|| panic!("no job `{name}`"))
}

fn pipelines(job: &Value) -> &[Value] {
    job["pipelines"].as_array().expect("a list")
}

/// The messages of everything that the browser refused in a job.
fn refusals(job: &Value) -> Vec<String> {
    let messages = job["messages"].as_array().expect("a list").iter();
    let errors = messages.filter(|message| message["type"] == "error").map(|message| &message["message"]);
    let pipelines = pipelines(job).iter().map(|pipeline| &pipeline["error"]);
    (errors.chain([&job["error"], &job["layout"]]).chain(pipelines))
        .filter_map(Value::as_str)
        .map(str::to_owned)
        .collect()
}

fn assert_accepted(job: &Value) {
    assert_eq!(refusals(job), Vec::<String>::new(), "{}", job["name"]);
    for message in job["messages"].as_array().expect("a list") {
        println!("{}: {message}", job["name"]);
    }
}

#[test]
fn the_device_has_default_limits() {
    let result = &said().result;
    assert_eq!(result["limits"]["maxStorageBuffersPerShaderStage"], 8, "{result}");
    assert_eq!(result["limits"]["maxComputeInvocationsPerWorkgroup"], 256);
    assert_eq!(result["uncaptured"], json!([]));
    assert_eq!(
        jobs().len(),
        said().written.shaders.len() + 2 * said().written.modules.len() + 1 + faults().len()
    );
}

#[test]
fn every_shader_compiles_with_every_value_of_its_constants() {
    let mut made = 0;
    for shader in &said().written.shaders {
        let name = name_of(shader);
        let job = job(&name);
        assert_accepted(job);
        // Every varied entry point occurs equally often, the others once; a vertex entry comes with each of its fragment entries.
        let entries = shader["entry_points"].as_array().expect("a list");
        let starts = entries.iter().filter(|entry| entry["stage"] != "vertex");
        let made_of = |entry: &Value| {
            let begin = format!("{name} {} ", name_of(entry));
            pipelines(job).iter().filter(|made| name_begins(made, &begin)).count()
        };
        let (varied, others): (Vec<_>, Vec<_>) = starts.partition(|entry| is_varied(entry));
        let sets = made_of(varied[0]);
        assert!(sets > 0 && varied.iter().all(|entry| made_of(entry) == sets), "{name}");
        assert!(others.iter().all(|entry| made_of(entry) == 1), "{name}");
        println!(
            "{name}: {} pipelines in {:.2} s",
            pipelines(job).len(),
            job["seconds"].as_f64().unwrap_or(0.0)
        );
        made += pipelines(job).len();
    }
    let planned: usize =
        (said().written.jobs().iter()).map(|job| job["pipelines"].as_array().map_or(0, Vec::len)).sum();
    assert_eq!(made, planned);
    println!("{made} pipelines of {} shaders", said().written.shaders.len());
}

/// A function whose code depends on the value of a constant is in a pipeline of each value: those of the entries that are varied.
#[test]
fn every_function_that_reads_a_constant_is_compiled_with_its_values() {
    let mut readers = 0;
    for (shader, source) in Written::now().shaders_with_sources() {
        let entries = shader["entry_points"].as_array().expect("a list");
        // A kernel has one entry.
        if entries.len() == 1 {
            continue;
        }
        let varied = varied_entries(&job_of(shader, source));
        let module = naga::front::wgsl::parse_str(source).expect("valid");
        let (mut reached, mut next) = (HashSet::new(), Vec::new());
        for entry in &module.entry_points {
            if varied.contains(&entry.name) {
                next.extend(called(&entry.function));
            } else {
                assert!(!reads(&entry.function), "{} reads a constant", entry.name);
            }
        }
        while let Some(function) = next.pop() {
            if reached.insert(function) {
                next.extend(called(&module.functions[function]));
            }
        }
        for (handle, function) in module.functions.iter().filter(|(_, function)| reads(function)) {
            assert!(reached.contains(&handle), "{}: {:?}", name_of(shader), function.name);
            readers += 1;
        }
    }
    assert!(readers > 20, "{readers}");
}

/// The entry points of the pipelines that are compiled with other values than the defaults.
fn varied_entries(job: &Value) -> HashSet<String> {
    let varied = pipelines(job).iter().filter(|pipeline| pipeline["constants"] != json!({}));
    let stages = varied.flat_map(|pipeline| ["vertex", "fragment"].map(|stage| &pipeline["render"][stage]));
    stages.filter_map(Value::as_str).map(str::to_owned).collect()
}

/// The functions whose results a function uses. All functions that read constants have results.
fn called(function: &Function) -> Vec<Handle<Function>> {
    let of = |(_, expression): (_, &Expression)| match expression {
        Expression::CallResult(called) => Some(*called),
        _ => None,
    };
    function.expressions.iter().filter_map(of).collect()
}

fn reads(function: &Function) -> bool {
    function.expressions.iter().any(|(_, expression)| matches!(expression, Expression::Override(_)))
}

fn name_begins(pipeline: &Value, begin: &str) -> bool {
    pipeline["label"].as_str().is_some_and(|label| label.starts_with(begin))
}

#[test]
fn every_module_compiles_alone_before_a_shader_and_with_all_others() {
    let modules = &said().written.modules;
    assert_eq!(
        modules.iter().map(|(name, _)| name.as_str()).collect::<Vec<_>>(),
        ["animation", "lod", "skinning", "surface", "terrain"]
    );
    for (name, _) in modules {
        assert_accepted(job(&format!("module {name}")));
        let user = job(&format!("user of {name}"));
        assert_accepted(user);
        assert_eq!(pipelines(user).len(), 1);
    }
    assert_accepted(job("all modules"));
}

#[test]
fn what_must_be_refused_is_refused_for_its_reason() {
    for (name, words) in [
        ("literal", "cannot be represented as 'f32'"),
        ("type", "u32"),
        ("nine buffers", "(9)"),
        ("layout", "not compatible with the type in the layout"),
        ("constant", "NOTHING"),
    ] {
        let job = job(&format!("fault: {name}"));
        let refused = refusals(job);
        println!("{name}: {refused:?}");
        assert!(refused.iter().any(|why| why.contains(words)), "{job}");
        assert!(pipelines(job)[0]["error"].is_string(), "{job}");
    }
    assert_accepted(job("fault: none"));
    assert_accepted(job("fault: eight buffers"));
}
