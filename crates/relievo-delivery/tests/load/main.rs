//! Many clients at once, and requests that are none. A program of its own, since it measures memory.

#[path = "../delivery/host.rs"]
#[allow(dead_code, reason = "other tests use the rest")]
mod host;
#[path = "../delivery/random.rs"]
mod random;
mod trials;

use host::{Host, models, options};

#[test]
fn two_hundred_clients_get_every_level_twice() {
    trials::two_hundred_clients(&Host::start(options(models())));
}

#[test]
fn a_thousand_malformed_requests_harm_nobody() {
    let mut limited = options(models());
    limited.limits.header_seconds = 1.0;
    trials::malformed_requests(&Host::start(limited));
}
