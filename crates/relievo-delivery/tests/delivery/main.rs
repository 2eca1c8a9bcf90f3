//! The server and the client, over sockets.

mod fetcher;
mod host;
mod json;
mod load;
mod resume;
mod routes;
mod shared;
mod streamed;
mod terrain;
