//! All reducers beside each other, with the sizes that B measures of levels on the wire (B table 5.1).

use std::io::Write as _;

use crate::distance::DistanceOptions;
use crate::reduce::Normals;
use crate::reduce::Reducer;
use flate2::Compression;
use flate2::write::GzEncoder;
use relievo::InputError;
use relievo::asset::Model;
use relievo::ops::skinning::at_rest;
use serde::Serialize;

use crate::measure::progress::Listener;
use crate::measure::reduction::{Run, Target};

/// The parts of the triangles at which reducers are compared.
const SHARES: [f64; 4] = [0.5, 0.2, 0.1, 0.02];

/// The connections of B table 5.1, in bits per second: 2 and 15.9 Mbit/s, of 2²⁰ bits.
const CONNECTIONS: [f64; 2] = [2.0 * 1_048_576.0, 15.9 * 1_048_576.0];

/// A level of a comparison.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ReducerLevel {
    /// The part of the triangles that was asked for.
    pub share: f64,
    /// Number of triangles.
    pub triangles: usize,
    /// Number of vertices.
    pub vertices: usize,
    /// Root mean square of the distances, in the model's units: the larger of both directions.
    pub error_rms: f64,
    /// The largest distance in either direction, in the model's units.
    pub error_max: f64,
    /// Bytes as the JSON of B table 4.5.
    pub json_bytes: usize,
    /// Bytes of that JSON, compressed by gzip.
    pub gzip_bytes: usize,
    /// The seconds that the JSON takes at 2 and at 15.9 Mbit/s.
    pub download_seconds: [f64; 2],
}

/// What a reducer makes of a model.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ReducerRow {
    /// The reducer's name.
    pub reducer: &'static str,
    /// The seconds that it took for all levels.
    pub seconds: f64,
    /// The levels, at 50, 20, 10 and 2 % of the triangles. Those at which no triangle is left are missing.
    pub levels: Vec<ReducerLevel>,
}

/// All reducers beside each other.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ReducerComparison {
    /// The model's name.
    pub model: String,
    /// The model itself: at a share of 1, without an error.
    pub whole: ReducerLevel,
    /// A row for each of [`Reducer::ALL`].
    pub reducers: Vec<ReducerRow>,
}

impl ReducerComparison {
    /// Reduces a model with every reducer to 50, 20, 10 and 2 % of its triangles, and measures the levels. Errors and sizes
    /// are the same in every run; seconds depend on the machine.
    ///
    /// # Errors
    /// [`InputError`] as [`crate::measure::reduction::reduction`].
    pub fn new(
        name: &str,
        model: &Model,
        normals: Normals,
        listener: Listener<'_>,
    ) -> Result<Self, InputError> {
        let whole = at_rest(model)?;
        let all: usize = whole.meshes.iter().map(|mesh| mesh.indices.len() / 3).sum();
        if all == 0 {
            return Err(InputError::new("model.triangles.len", 0, "must be at least 1"));
        }
        let (options, mut reducers) = (DistanceOptions::default(), Vec::new());
        for (reducer, parameters) in Reducer::ALL {
            let mut run = Run { whole: &whole, reducer: &parameters, normals, listener, seconds: 0.0 };
            let counts: Vec<usize> =
                SHARES.iter().filter_map(|share| Target::Share(*share).count(all)).collect();
            // Where a level has no triangle left, the others are measured one by one.
            let measured: Vec<_> = match run.measured(&counts, &options) {
                Ok(levels) => levels.into_iter().map(Some).collect(),
                Err(_) => counts.iter().map(|count| run.measured(&[*count], &options).ok()?.pop()).collect(),
            };
            let levels = SHARES.iter().zip(measured).filter_map(|(share, level)| {
                let level = level?;
                let errors = [level.distance.rms(), level.distance.max()];
                Some(ReducerLevel::new(*share, &level.reduced.model, errors))
            });
            reducers.push(ReducerRow { reducer, levels: levels.collect(), seconds: run.seconds });
        }
        let whole = ReducerLevel::new(1.0, &whole, [0.0; 2]);
        Ok(Self { model: name.to_owned(), whole, reducers })
    }

    /// The comparison as Markdown: a row for the model, and one for each reducer and level.
    pub fn table(&self) -> String {
        let mut text = format!(
            "{}: {} triangles. Errors are distances between the surfaces, both ways, in the model's units; sizes are those of \
             the levels as JSON in KiB, download times are of the JSON at 2 and 15.9 Mbit/s.\n\n\
             | reducer | share | triangles | vertices | rms | largest | KiB | gzip KiB | 2 Mbit/s | 15.9 Mbit/s | seconds for all |\n\
             |---|---:|---:|---:|---:|---:|---:|---:|---:|---:|---:|\n",
            self.model, self.whole.triangles
        );
        text += &self.whole.row("none", None);
        for row in &self.reducers {
            row.levels.iter().for_each(|level| text += &level.row(row.reducer, Some(row.seconds)));
        }
        text
    }
}

impl ReducerLevel {
    fn new(share: f64, model: &Model, [error_rms, error_max]: [f64; 2]) -> Self {
        let json = json(model);
        let mut gzip = GzEncoder::new(Vec::new(), Compression::default());
        // Writing to memory does not fail.
        let packed = gzip.write_all(json.as_bytes()).and_then(|()| gzip.finish());
        Self {
            share,
            triangles: model.meshes.iter().map(|mesh| mesh.indices.len() / 3).sum(),
            vertices: model.meshes.iter().map(|mesh| mesh.vertices()).sum(),
            error_rms,
            error_max,
            json_bytes: json.len(),
            gzip_bytes: packed.map_or(0, |packed| packed.len()),
            download_seconds: CONNECTIONS.map(|bits| 8.0 * json.len() as f64 / bits),
        }
    }

    fn row(&self, reducer: &str, seconds: Option<f64>) -> String {
        let [slow, fast] = self.download_seconds;
        let [json, gzip] = [self.json_bytes, self.gzip_bytes].map(|bytes| bytes as f64 / 1024.0);
        let seconds = seconds.map_or(String::new(), |seconds| format!("{seconds:.3}"));
        format!(
            "| {reducer} | {} % | {} | {} | {:.4e} | {:.4e} | {json:.1} | {gzip:.1} | {slow:.4} s | {fast:.4} s | {seconds} |\n",
            100.0 * self.share,
            self.triangles,
            self.vertices,
            self.error_rms,
            self.error_max,
        )
    }
}

/// A mesh as B sends it (B table 4.5).
#[derive(Serialize)]
#[serde(rename_all = "camelCase")]
struct Sent {
    vertex_positions: Vec<f32>,
    vertex_normals: Vec<f32>,
    vertex_texture_coords: Vec<f32>,
    indices: Vec<u32>,
}

/// All meshes of a model as one, in the JSON of B table 4.5.
fn json(model: &Model) -> String {
    let mut sent = Sent {
        vertex_positions: Vec::new(),
        vertex_normals: Vec::new(),
        vertex_texture_coords: Vec::new(),
        indices: Vec::new(),
    };
    let mut first = 0;
    for mesh in &model.meshes {
        sent.vertex_positions.extend_from_slice(mesh.positions.as_flattened());
        sent.vertex_normals.extend_from_slice(mesh.normals.as_flattened());
        sent.vertex_texture_coords.extend_from_slice(mesh.uv.as_flattened());
        sent.indices.extend(mesh.indices.iter().map(|index| first + index));
        first += mesh.vertices() as u32;
    }
    // Numbers are finite, so that JSON can represent them.
    serde_json::to_string(&sent).unwrap_or_default()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sizes_are_those_of_bs_table() {
        let triangle = "v 0 0 0\nv 1 0 0\nv 0 0.5 0\nvn 0 0 1\nf 1//1 2//1 3//1\n";
        let model = Model::from_obj(triangle.as_bytes(), None).expect("valid");
        let text = json(&model);
        let expected = r#"{"vertexPositions":[0.0,0.0,0.0,1.0,0.0,0.0,0.0,0.5,0.0],"vertexNormals":[0.0,0.0,1.0,0.0,0.0,1.0,0.0,0.0,1.0],"vertexTextureCoords":[0.0,0.0,0.0,0.0,0.0,0.0],"indices":[0,1,2]}"#;
        assert_eq!(text, expected);
        let level = ReducerLevel::new(1.0, &model, [0.0; 2]);
        assert_eq!((level.triangles, level.vertices, level.json_bytes), (1, 3, text.len()));
        assert!((40..text.len()).contains(&level.gzip_bytes), "{}", level.gzip_bytes);
        // The bunny of table 5.1: 92.3 KB in 0.3605 and 0.0453 s.
        let seconds = CONNECTIONS.map(|bits| 8.0 * 92.3 * 1024.0 / bits);
        assert!((seconds[0] - 0.3605).abs() < 1e-4 && (seconds[1] - 0.0453).abs() < 1e-4, "{seconds:?}");
    }
}
