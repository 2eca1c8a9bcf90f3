//! The server and the client, over sockets.

mod fetcher;
mod host;
mod json;
mod random;
mod resume;
mod routes;
mod shared;
mod streamed;
mod terrain;
