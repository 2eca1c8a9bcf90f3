//! Thesis B's JSON, and differences between levels.

use relievo::asset::Model;
use relievo::asset::package::{Package, PackageHeader};
use relievo::ops::skinning::at_rest;
use relievo_delivery::client::PackageStream;
use relievo_delivery::mesh_json::{MeshDifference, MeshJson};

use super::host::{Host, creature, models, options, rock};

/// The triangles of a mesh as positions, so that the order of vertices does not count.
fn triangles(positions: &[f32], indices: &[u32]) -> Vec<[[u32; 3]; 3]> {
    let corner = |vertex: u32| [0, 1, 2].map(|axis| positions[3 * vertex as usize + axis].to_bits());
    indices.chunks_exact(3).map(|corners| [corners[0], corners[1], corners[2]].map(corner)).collect()
}

#[test]
fn each_level_is_that_of_the_package() {
    let host = Host::start(options(models()));
    for (name, bytes) in [("rock", rock()), ("creature", creature())] {
        let whole = Model::from_rlv(bytes).expect("a package");
        let header = PackageHeader::read(bytes).expect("a header").0;
        for level in 0..header.levels.len() {
            let answer = host.get(&format!("/models/{name}/{level}.json"), &[]);
            let fields: Vec<String> = answer.json().as_object().expect("an object").keys().cloned().collect();
            let names = ["vertexPositions", "vertexNormals", "vertexTextureCoords", "indices"];
            assert_eq!(fields, names, "table 4.5");
            let mesh: MeshJson = serde_json::from_slice(&answer.body).expect("a mesh");
            mesh.validate().expect("valid");
            let own = &header.levels[header.levels.len() - 1 - level];
            assert_eq!([mesh.vertices(), mesh.triangles()], [own.vertices, own.triangles], "{name} {level}");
            if level == 0 {
                let rest = at_rest(&whole).expect("at rest");
                let all = rest
                    .meshes
                    .iter()
                    .flat_map(|mesh| triangles(mesh.positions.as_flattened(), &mesh.indices));
                assert!(
                    all.collect::<Vec<_>>() == triangles(&mesh.vertex_positions, &mesh.indices),
                    "{name}"
                );
            }
        }
    }
}

/// `RELIEVO_MODELS` names a folder with further models.
#[test]
fn a_difference_gives_the_finer_level_for_all_pairs() {
    let other = std::env::var_os("RELIEVO_MODELS").map(std::path::PathBuf::from);
    for folder in std::iter::once(models()).chain(other.as_deref()) {
        all_pairs(&Host::start(options(folder)));
    }
}

/// Thesis B's JSON, and the chunks of the package, of all models at the same time.
fn all_pairs(host: &Host) {
    std::thread::scope(|scope| {
        for model in host.site.catalog().models {
            scope.spawn(move || pairs_of(host, &model.name, &model.package));
        }
    });
}

fn pairs_of(host: &Host, name: &str, package: &str) {
    let bytes = &host.get(&format!("/{package}"), &[]).body;
    let count = PackageHeader::read(bytes).expect("a header").0.levels.len();
    let whole = |level: usize| -> MeshJson {
        serde_json::from_slice(&host.get(&format!("/models/{name}/{level}.json"), &[]).body).expect("a mesh")
    };
    let levels: Vec<_> = (0..count).map(whole).collect();
    for from in 1..count {
        for to in 0..from {
            let answer = host.get(&format!("/models/{name}/{from}-{to}.json"), &[]);
            let difference: MeshDifference = serde_json::from_slice(&answer.body).expect("a difference");
            let mut mesh = levels[from].clone();
            mesh.apply(&difference).expect("it fits");
            assert!(mesh == levels[to], "{name}: {from} to {to}");
        }
    }
    chunks(bytes);
    println!("{name}: {} differences", count * (count - 1) / 2);
}

/// The chunks from each level to each finer one give the hash of the finer one.
fn chunks(bytes: &[u8]) {
    let header = PackageHeader::read(bytes).expect("a header").0;
    let count = header.levels.len();
    for from in 0..count {
        for to in 0..=from {
            // What a client has, then what a request for the difference brings.
            let end = header.levels[count - 1 - from].chunk.end;
            let mut stream = PackageStream::resumed(&bytes[..end]).expect("a beginning");
            assert_eq!(stream.level(), Some(from));
            if let Some(range) = stream.missing(to) {
                stream.push(range.start, &bytes[range.start as usize..range.end as usize]).expect("sound");
            }
            assert_eq!((stream.level(), stream.missing(to)), (Some(to), None));
            let mut package = Package::new(&stream.complete()).expect("a package");
            for level in &header.levels[..count - to] {
                package.add_level(stream.chunk(&level.chunk).expect("complete")).expect("sound");
            }
            assert_eq!(package.hash().expect("a hash"), header.levels[count - 1 - to].hash);
        }
    }
}

#[test]
fn differences_that_do_not_fit_are_refused_and_change_nothing() {
    let mesh = MeshJson::of_package(rock(), 5).expect("a level");
    let finer = MeshJson::of_package(rock(), 4).expect("a level");
    let sound = finer.difference_from(&mesh).expect("finer");
    let refused = |change: &dyn Fn(&mut MeshDifference)| {
        let mut own = sound.clone();
        change(&mut own);
        let mut changed = mesh.clone();
        let error = changed.apply(&own).expect_err("refused");
        assert!(changed == mesh);
        error.path
    };
    assert_eq!(
        refused(&|own| own.vertex_normals.truncate(own.vertex_normals.len() - 1)),
        "vertexNormals.len"
    );
    assert_eq!(
        refused(&|own| own.vertex_positions.truncate(own.vertex_positions.len() - 1)),
        "vertexPositions.len"
    );
    assert_eq!(refused(&|own| own.indices.truncate(own.indices.len() - 1)), "indices.len");
    assert_eq!(refused(&|own| own.indices[7] = u32::MAX), "indices[7]");
    assert_eq!(refused(&|own| own.substituted.push(u32::MAX)), "substituted[0]");
    assert!(mesh.difference_from(&finer).is_err());
    assert_eq!(MeshJson::of_package(rock(), 99).expect_err("no such level").path, "level");
    // Attributes that change are substituted.
    let mut moved = finer.clone();
    moved.vertex_positions[4] += 1.0;
    let difference = moved.difference_from(&mesh).expect("finer");
    assert_eq!(difference.substituted, [1]);
    let mut changed = mesh.clone();
    changed.apply(&difference).expect("it fits");
    assert!(changed == moved);
}
