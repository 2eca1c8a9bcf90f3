//! Connections of a server: limits, timeouts, an orderly end.

use std::net::SocketAddr;
use std::pin::{Pin, pin};
use std::sync::Arc;
use std::time::Duration;

use axum::Router;
use axum::http::{HeaderValue, Method, StatusCode, header};
use futures_util::future::BoxFuture;
use hyper::server::conn::http1::Builder;
use hyper_util::rt::{TokioIo, TokioTimer};
use hyper_util::server::graceful::GracefulShutdown;
use hyper_util::service::TowerToHyperService;
use relievo::InputError;
use tokio::net::TcpListener;
use tokio::sync::Semaphore;
use tokio_io_timeout::TimeoutStream;
use tower_http::catch_panic::CatchPanicLayer;
use tower_http::cors::{AllowOrigin, CorsLayer};
use tower_http::timeout::TimeoutLayer;
use tower_http::trace::TraceLayer;

use super::ServeError;
use super::options::{Limits, ServeOptions};
use super::routes::answer;
use super::site::Site;

/// Seconds that open connections may take to end after the server was told to stop.
const PATIENCE: Duration = Duration::from_secs(10);

/// Seconds that a browser may remember what another origin may ask for.
const REMEMBERED: Duration = Duration::from_secs(86400);

/// A server that listens.
pub struct Server {
    listener: TcpListener,
    site: Site,
}

impl Server {
    /// Listens at the address of the site's options. Needs a runtime of tokio with several threads.
    ///
    /// # Errors
    /// [`ServeError::Io`] for an address that is not one, or that is in use.
    pub async fn bind(site: &Site) -> Result<Self, ServeError> {
        let address = &site.0.options.listen;
        let listener = TcpListener::bind(address).await.map_err(|error| ServeError::io(address, error))?;
        Ok(Self { listener, site: site.clone() })
    }

    /// The address that the server listens at.
    ///
    /// # Errors
    /// [`ServeError::Io`] if the system does not tell.
    pub fn address(&self) -> Result<SocketAddr, ServeError> {
        self.listener.local_addr().map_err(|error| ServeError::io("listen", error))
    }

    /// Answers requests until `stop` completes. Then no further connections are accepted, and open ones may end within ten
    /// seconds.
    ///
    /// # Errors
    /// [`InputError`] for an origin that cannot be a header.
    pub async fn run(self, stop: impl Future<Output = ()> + Send) -> Result<(), ServeError> {
        self.answers(pin!(stop)).await
    }

    fn answers<'a>(
        self,
        mut stop: Pin<&'a mut (dyn Future<Output = ()> + Send + 'a)>,
    ) -> BoxFuture<'a, Result<(), ServeError>> {
        Box::pin(async move {
            let Self { listener, site } = self;
            let limits = site.0.options.limits.clone();
            let places = Arc::new(Semaphore::new(limits.connections));
            let router = router(&site)?;
            let graceful = GracefulShutdown::new();
            loop {
                let free = places.clone();
                let next = async {
                    // The semaphore is never closed.
                    let place = free.acquire_owned().await.ok();
                    (place, listener.accept().await)
                };
                let (place, accepted) = tokio::select! {
                    next = next => next,
                    () = &mut stop => break,
                };
                let stream = match accepted {
                    Ok((stream, _)) => stream,
                    Err(error) => {
                        // Too many open files, for example: other connections must end first.
                        tracing::warn!(%error, "a connection cannot be accepted");
                        tokio::time::sleep(Duration::from_millis(50)).await;
                        continue;
                    }
                };
                let connection = connection(&limits);
                let mut stream = TimeoutStream::new(stream);
                let idle = Some(Duration::from_secs_f64(limits.idle_seconds));
                stream.set_read_timeout(idle);
                stream.set_write_timeout(idle);
                let service = TowerToHyperService::new(router.clone());
                let watcher = graceful.watcher();
                let site = site.clone();
                tokio::spawn(async move {
                    site.0.metrics.connected(1);
                    let served = connection.serve_connection(TokioIo::new(Box::pin(stream)), service);
                    if let Err(error) = watcher.watch(served).await {
                        tracing::debug!(%error, "a connection ended");
                    }
                    site.0.metrics.connected(-1);
                    drop(place);
                });
            }
            drop(listener);
            tokio::select! {
                () = graceful.shutdown() => {}
                () = tokio::time::sleep(PATIENCE) => tracing::warn!("some connections were cut off"),
            }
            Ok(())
        })
    }
}

fn connection(limits: &Limits) -> Builder {
    let mut builder = Builder::new();
    builder
        .timer(TokioTimer::new())
        .header_read_timeout(Duration::from_secs_f64(limits.header_seconds))
        .max_buf_size(limits.header_bytes);
    builder
}

fn router(site: &Site) -> Result<Router, ServeError> {
    let ServeOptions { limits, origins, .. } = &site.0.options;
    let timeout = Duration::from_secs_f64(limits.answer_seconds);
    Ok(Router::new()
        .fallback(answer)
        .with_state(site.clone())
        .layer(TimeoutLayer::with_status_code(StatusCode::GATEWAY_TIMEOUT, timeout))
        .layer(CatchPanicLayer::new())
        .layer(cors(origins)?)
        .layer(TraceLayer::new_for_http()))
}

/// Which pages of other origins may read the answers.
fn cors(origins: &[String]) -> Result<CorsLayer, ServeError> {
    let allowed = match origins.iter().any(|origin| origin == "*") {
        true => AllowOrigin::any(),
        false => {
            let value = |(at, origin): (usize, &String)| {
                let refused =
                    |_| InputError::new(format!("origins[{at}]"), origin, "must be a header's value");
                HeaderValue::from_str(origin).map_err(refused)
            };
            AllowOrigin::list(origins.iter().enumerate().map(value).collect::<Result<Vec<_>, _>>()?)
        }
    };
    let asked =
        [header::AUTHORIZATION, header::IF_MATCH, header::IF_NONE_MATCH, header::IF_RANGE, header::RANGE];
    let told = [
        header::ACCEPT_RANGES,
        header::CONTENT_ENCODING,
        header::CONTENT_LENGTH,
        header::CONTENT_RANGE,
        header::ETAG,
        header::RETRY_AFTER,
    ];
    Ok(CorsLayer::new()
        .allow_origin(allowed)
        .allow_methods([Method::GET, Method::HEAD])
        .allow_headers(asked)
        .expose_headers(told)
        .max_age(REMEMBERED))
}
