//! A page in headless Chromium: it is served on localhost to a browser with a fresh profile, and posts its
//! results back.

use std::fs::File;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, ExitStatus, Stdio};
use std::time::{Duration, Instant};

use serde_json::Value;
use tiny_http::{Header, Method, Request, Response, Server};

/// The environment variable that selects the browser.
pub const VARIABLE: &str = "RELIEVO_CHROMIUM";

const NAMES: &[&str] = &["chromium", "chromium-browser", "google-chrome", "google-chrome-stable"];

/// WebGPU on SwiftShader, without a window or any of Chromium's services.
const FLAGS: &[&str] = &[
    "--headless=new",
    "--no-sandbox",
    "--enable-unsafe-webgpu",
    "--enable-features=Vulkan",
    "--use-vulkan=swiftshader",
    "--use-angle=swiftshader",
    "--ignore-gpu-blocklist",
    "--disable-quic",
    "--no-first-run",
    "--disable-background-networking",
    "--disable-component-update",
    "--disable-sync",
    // Containers have little shared memory.
    "--disable-dev-shm-usage",
];

/// The browser of the suite. A missing browser is a failure, with advice on what to do.
pub fn program() -> Result<PathBuf, String> {
    let path = std::env::var_os("PATH").unwrap_or_default();
    program_among(std::env::var_os(VARIABLE).map(PathBuf::from), std::env::split_paths(&path))
}

/// [`program`] for a value of the variable and the folders of a search path.
pub fn program_among(
    chosen: Option<PathBuf>,
    folders: impl Iterator<Item = PathBuf>,
) -> Result<PathBuf, String> {
    if let Some(chosen) = chosen.filter(|chosen| !chosen.as_os_str().is_empty()) {
        let missing = format!("{VARIABLE} = {}: there is no such program", chosen.display());
        return if chosen.is_file() { Ok(chosen) } else { Err(missing) };
    }
    let mut found = folders.flat_map(|folder| NAMES.iter().map(move |name| folder.join(name)));
    found.find(|path| path.is_file()).ok_or_else(|| {
        format!("no Chromium: run `scripts/setup.sh browser` (Debian: apt-get install chromium), or set {VARIABLE}")
    })
}

/// Opens the page `/` of `files`, paths and contents, in `program`, and returns what it posts to `/result`. If
/// it never posts a result, what it posted to `/note` shows how far it came.
///
/// # Errors
/// Without a result within `patience`, or when the browser ends: why, and what the browser wrote to stderr.
pub fn visit(program: &Path, files: &[(&str, &[u8])], patience: Duration) -> Result<Value, String> {
    visit_heard(program, &[], files, patience, &mut |_| ())
}

/// [`visit`] with further flags of the browser. `heard` is told what the page posts to `/note`, and the page waits for it.
///
/// # Errors
/// As for [`visit`].
pub fn visit_heard(
    program: &Path,
    flags: &[&str],
    files: &[(&str, &[u8])],
    patience: Duration,
    heard: &mut dyn FnMut(&str),
) -> Result<Value, String> {
    let folder = tempfile::tempdir().map_err(|error| error.to_string())?;
    let server = Server::http("127.0.0.1:0").map_err(|error| error.to_string())?;
    let port = server.server_addr().to_ip().map_or(0, |address| address.port());
    let log = folder.path().join("stderr");
    let address = format!("http://localhost:{port}/");
    let mut browser = Browser::start(program, flags, folder.path(), &log, &address)?;
    let result = result_of(&server, &mut browser, files, patience, heard);
    drop(browser);
    result.map_err(|why| {
        let said = std::fs::read(&log).unwrap_or_default();
        format!("{}: {why}; its stderr:\n{}", program.display(), String::from_utf8_lossy(&said))
    })
}

fn result_of(
    server: &Server,
    browser: &mut Browser,
    files: &[(&str, &[u8])],
    patience: Duration,
    heard: &mut dyn FnMut(&str),
) -> Result<Value, String> {
    let start = Instant::now();
    let mut note = "nothing".to_owned();
    while start.elapsed() < patience {
        if let Some(status) = browser.ended() {
            return Err(format!("ended with {status}; the page had last said: {note}"));
        }
        let waited = server.recv_timeout(Duration::from_millis(100)).map_err(|error| error.to_string())?;
        let Some(mut request) = waited else { continue };
        let path = request.url().to_owned();
        // A page's address may say what it shows.
        let path = path.split('?').next().unwrap_or_default();
        match (request.method(), path) {
            (Method::Post, "/result") => {
                let result = body(&mut request)?;
                answer(request, 204, "", &[]);
                return serde_json::from_str(&result).map_err(|error| format!("{error} in {result}"));
            }
            (Method::Post, "/note") => {
                note = body(&mut request)?;
                heard(&note);
                answer(request, 204, "", &[]);
            }
            _ => match files.iter().find(|(file, _)| *file == path) {
                Some((file, content)) => answer(request, 200, media_type(file), content),
                None => answer(request, 404, "text/plain", b"no such file"),
            },
        }
    }
    Err(format!("no result within {} s; the page had last said: {note}", patience.as_secs()))
}

fn body(request: &mut Request) -> Result<String, String> {
    let mut text = String::new();
    request.as_reader().read_to_string(&mut text).map_err(|error| error.to_string())?;
    Ok(text)
}

/// Answers a request; a browser that has ended is noticed elsewhere.
fn answer(request: Request, status: u16, media_type: &str, content: &[u8]) {
    let mut response = Response::from_data(content).with_status_code(status);
    if let Ok(header) = Header::from_bytes("Content-Type", media_type) {
        response.add_header(header);
    }
    let _ = request.respond(response);
}

fn media_type(path: &str) -> &'static str {
    match path.rsplit_once('.').map(|(_, extension)| extension) {
        None | Some("html") => "text/html; charset=utf-8",
        Some("js") => "text/javascript",
        Some("json") => "application/json",
        Some("wasm") => "application/wasm",
        Some(_) => "application/octet-stream",
    }
}

/// A running browser with all of its processes, which end with it.
struct Browser(Child);

impl Browser {
    fn start(
        program: &Path,
        flags: &[&str],
        profile: &Path,
        log: &Path,
        address: &str,
    ) -> Result<Self, String> {
        let mut command = Command::new(program);
        command
            .args(FLAGS)
            .args(flags)
            .arg(format!("--user-data-dir={}", profile.join("profile").display()))
            .arg(address)
            .env("HOME", profile)
            // It has a driver of its own.
            .env_remove("VK_ICD_FILENAMES")
            .env_remove("VK_DRIVER_FILES")
            .stdin(Stdio::null())
            .stdout(Stdio::null())
            .stderr(File::create(log).map_err(|error| error.to_string())?);
        #[cfg(unix)]
        std::os::unix::process::CommandExt::process_group(&mut command, 0);
        let child = command.spawn().map_err(|error| format!("{}: {error}", program.display()))?;
        Ok(Self(child))
    }

    fn ended(&mut self) -> Option<ExitStatus> {
        self.0.try_wait().ok().flatten()
    }
}

impl Drop for Browser {
    fn drop(&mut self) {
        #[cfg(unix)]
        if let Some(group) = i32::try_from(self.0.id()).ok().and_then(rustix::process::Pid::from_raw) {
            let _ = rustix::process::kill_process_group(group, rustix::process::Signal::KILL);
        }
        let _ = self.0.kill();
        let _ = self.0.wait();
    }
}
