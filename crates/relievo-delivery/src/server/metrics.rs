//! Counters for Prometheus.

use std::sync::atomic::AtomicI64;

use prometheus_client::encoding::text::encode;
use prometheus_client::metrics::counter::Counter;
use prometheus_client::metrics::family::Family;
use prometheus_client::metrics::gauge::Gauge;
use prometheus_client::registry::{Registry, Unit};

/// Counters of a server.
pub(super) struct Metrics {
    registry: Registry,
    answers: Family<Vec<(String, String)>, Counter>,
    bytes: Counter,
    mesh_hits: Counter,
    mesh_misses: Counter,
    connections: Gauge<i64, AtomicI64>,
}

impl Metrics {
    pub fn new() -> Self {
        let mut registry = Registry::with_prefix("relievo");
        let answers = Family::<Vec<(String, String)>, Counter>::default();
        let (bytes, mesh_hits, mesh_misses) = <(Counter, Counter, Counter)>::default();
        let connections = Gauge::<i64, AtomicI64>::default();
        registry.register("answers", "Answers by status", answers.clone());
        registry.register_with_unit("body", "Bytes of answers", Unit::Bytes, bytes.clone());
        registry.register("mesh_hits", "Meshes as JSON that were in memory", mesh_hits.clone());
        registry.register("mesh_misses", "Meshes as JSON that were made", mesh_misses.clone());
        registry.register("connections", "Open connections", connections.clone());
        Self { registry, answers, bytes, mesh_hits, mesh_misses, connections }
    }

    pub fn answered(&self, status: u16, bytes: u64) {
        self.answers.get_or_create(&vec![("status".to_owned(), status.to_string())]).inc();
        self.bytes.inc_by(bytes);
    }

    pub fn mesh_hit(&self) {
        self.mesh_hits.inc();
    }

    pub fn mesh_miss(&self) {
        self.mesh_misses.inc();
    }

    pub fn connected(&self, by: i64) {
        self.connections.inc_by(by);
    }

    /// All counters in Prometheus's text format.
    pub fn text(&self) -> String {
        let mut text = String::new();
        match encode(&mut text, &self.registry) {
            Ok(()) => text,
            Err(error) => error.to_string(),
        }
    }
}
