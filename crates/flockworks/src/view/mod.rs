//! `flockworks view`: a page on loopback that shows a world while it runs, a run that was recorded, or a search.
//!
//! The messages are those of `docs/explanation/viewer-protocol.md`. Each connection has a session of its own, on a thread
//! of its own.

mod assets;
mod dropped;
mod requests;
mod session;

use crate::fault::{Fault, wrong};
use crate::kinds;
use crate::run::PROGRAM;
use axum::Router;
use axum::extract::ws::{CloseFrame, Message, WebSocket, WebSocketUpgrade};
use axum::extract::{DefaultBodyLimit, Path as Part, State};
use axum::http::{HeaderMap, HeaderValue, StatusCode, header};
use axum::response::{IntoResponse, Response};
use axum::routing::{get, post};
use clap::Args;
use lab::live::Course;
use lab::searched::Searched;
use serde_json::{Value as Json, json};
use session::{Outgoing, Session};
use std::io::Write;
use std::net::{IpAddr, Ipv4Addr, SocketAddr};
use std::path::{Path, PathBuf};
use std::sync::{Arc, PoisonError, RwLock};

/// Options of `view`.
#[derive(Args, Debug, Default)]
pub struct ViewOptions {
    /// A file of any kind, or the folder of a run or search; two runs are shown side by side. Without any, the gallery.
    #[arg(num_args = 0..=2)]
    pub what: Vec<PathBuf>,
    /// Port. Left out, a free one is chosen.
    #[arg(long, value_name = "N", default_value_t = 0)]
    pub port: u16,
    /// Address to listen on; left out, 127.0.0.1. With any but a loopback one, whoever reaches it can see and change what is
    /// shown.
    #[arg(long, value_name = "ADDRESS")]
    pub listen: Option<IpAddr>,
    /// Open the page in the browser.
    #[arg(long)]
    pub open: bool,
    /// Of a study, the cell to look at: its number, or levels as `variant=prob,N=6`. Left out, the first.
    #[arg(long, value_name = "CELL")]
    pub cell: Option<String>,
    /// Of a study, the trial to look at. Left out, the first.
    #[arg(long, value_name = "N")]
    pub trial: Option<usize>,
    /// Number of threads for a simulation.
    #[arg(long, value_name = "N", default_value_t = 1)]
    pub threads: usize,
}

/// Something the command line named, or a file that was dropped on the page.
#[derive(Clone)]
pub(crate) enum Given {
    /// A file that runs live, a scenario for one: name and text.
    Scenario(String, String),
    /// The folder of a run or of tracks, which of its recordings, and the names of all where there are several.
    Run(PathBuf, usize, Vec<String>),
    /// A course out of a page: the name of that, and the course.
    Course(String, Arc<Course>),
    /// A search: name of its folder, kind, and what is known of it.
    Search(String, &'static str, Arc<dyn Searched>),
}

impl Given {
    /// As the page is told of it.
    fn told(&self) -> Json {
        match self {
            Self::Scenario(name, _) => json!({ "kind": "scenario", "name": name }),
            Self::Run(path, recording, recordings) => json!({
                "kind": "run", "name": path.display().to_string(), "recording": recording, "recordings": recordings,
            }),
            Self::Course(name, _) => json!({ "kind": "run", "name": name }),
            Self::Search(name, kind, _) => json!({ "kind": "search", "name": name, "of": kind }),
        }
    }
}

/// What all connections share.
pub(crate) struct Shared {
    given: RwLock<Vec<Given>>,
    /// Where files are kept that were dropped on the page.
    dropped: dropped::Kept,
    threads: usize,
    port: u16,
    /// Whether the user let other machines in.
    open_to_others: bool,
}

impl Shared {
    /// What was given, by its number.
    fn given(&self, number: usize) -> Option<Given> {
        // one who panicked while holding it has changed nothing
        self.given.read().unwrap_or_else(PoisonError::into_inner).get(number).cloned()
    }
    /// All that was given, as the page is told of it.
    fn told(&self) -> Vec<Json> {
        self.given.read().unwrap_or_else(PoisonError::into_inner).iter().map(Given::told).collect()
    }
    /// Adds what was given later; the number of the first.
    fn add(&self, more: Vec<Given>) -> usize {
        let mut given = self.given.write().unwrap_or_else(PoisonError::into_inner);
        let first = given.len();
        given.extend(more);
        first
    }
}

/// Largest message from the page, in bytes.
const LARGEST: usize = 64 << 10;
/// Largest file that may be dropped on the page, in bytes.
const LARGEST_FILE: usize = 8 << 20;
/// Messages that may wait for a slow page before it is given up.
const WAITING: usize = 512;

/// Serves the page until it is interrupted.
///
/// # Errors
/// What is wrong with the file or the folder, or a port that is taken.
pub fn view(options: &ViewOptions, out: &mut dyn Write) -> Result<(), Fault> {
    if options.threads == 0 {
        return wrong("--threads must be 1 or more, found 0");
    }
    let mut given = Vec::new();
    for path in &options.what {
        if path.is_dir() {
            given.extend(given_of(path, options.what.len() == 1)?);
        } else {
            let (kind, input) = kinds::read(&path.display().to_string(), &[])?;
            let (name, text) = kind.view(&input, options)?;
            given.push(Given::Scenario(name, text));
        }
    }
    let runtime = tokio::runtime::Builder::new_multi_thread()
        .worker_threads(1)
        .enable_all()
        .build()
        .map_err(|error| Fault::Ours(format!("cannot start the server: {error}")))?;
    runtime.block_on(serve(options, given, out))
}

/// What there is to look at in a folder.
///
/// # Errors
/// A folder that holds nothing to look at, or cannot be read.
fn given_of(path: &Path, alone: bool) -> Result<Vec<Given>, Fault> {
    let kind = kinds::of_folder(path)?;
    if !kind.records() {
        return Ok(vec![Given::Search(path.display().to_string(), kind.id(), kind.search(path)?.into())]);
    }
    let names = kind.names(path)?;
    // the recordings of one folder are shown as two folders are, side by side
    let shown = if alone { names.len().min(2) } else { 1 };
    let names = if names.len() > 1 { names } else { Vec::new() };
    Ok((0..shown).map(|recording| Given::Run(path.to_owned(), recording, names.clone())).collect())
}

async fn serve(options: &ViewOptions, given: Vec<Given>, out: &mut dyn Write) -> Result<(), Fault> {
    let listen = options.listen.unwrap_or(IpAddr::V4(Ipv4Addr::LOCALHOST));
    let address = SocketAddr::from((listen, options.port));
    let listener = tokio::net::TcpListener::bind(address)
        .await
        .map_err(|error| Fault::Input(format!("cannot listen on {address}: {error}; choose another --port")))?;
    let port = listener.local_addr().map_or(options.port, |address| address.port());
    let named = if listen.is_unspecified() { IpAddr::V4(Ipv4Addr::LOCALHOST) } else { listen };
    let address = format!("http://{}/", SocketAddr::from((named, port)));
    writeln!(out, "{address}\nCtrl-C ends it")?;
    let open_to_others = !listen.is_loopback();
    if open_to_others {
        writeln!(out, "Whoever reaches {listen} at port {port} can see and change what is shown.")?;
    }
    out.flush()?;
    if options.open {
        open(&address, out)?;
    }
    let (given, dropped) = (RwLock::new(given), dropped::Kept::new());
    let shared = Arc::new(Shared { given, dropped, threads: options.threads, port, open_to_others });
    let router = Router::new()
        .route("/", get(page))
        .route("/gallery.json", get(gallery))
        .route("/ws", get(socket))
        .route("/search/{given}", get(requests::overview))
        .route("/search/{given}/part", get(requests::part))
        .route("/given", post(requests::give))
        .route("/dropped", post(requests::dropped).layer(DefaultBodyLimit::max(dropped::LARGEST)))
        .route("/sketch", post(requests::sketch))
        .route("/sketch/save", post(requests::save))
        .route("/{name}", get(asset))
        .layer(DefaultBodyLimit::max(LARGEST_FILE))
        .with_state(shared);
    // a second Ctrl-C is not needed: nothing is written that could be lost
    let stop = async {
        let _ = tokio::signal::ctrl_c().await;
    };
    tokio::select! {
        served = async { axum::serve(listener, router).await } => {
            served.map_err(|error| Fault::Ours(format!("the server stopped: {error}")))
        }
        () = stop => Ok(()),
    }
}

/// Opens an address in the user's browser.
fn open(address: &str, out: &mut dyn Write) -> Result<(), Fault> {
    let program = if cfg!(target_os = "macos") { "open" } else { "xdg-open" };
    let silent = std::process::Stdio::null;
    let opened = std::process::Command::new(program).arg(address).stdout(silent()).stderr(silent()).spawn();
    if opened.is_err() {
        writeln!(out, "no browser could be opened; open the address by hand")?;
    }
    Ok(())
}

/// Whether a request comes to this server by a loopback name, so that no other site can pass its name off for it; by any
/// name where other machines are let in.
fn admitted(headers: &HeaderMap, shared: &Shared) -> bool {
    let host = headers.get(header::HOST).and_then(|host| host.to_str().ok());
    let own = own_hosts(shared.port);
    host.is_some_and(|host| shared.open_to_others || own.iter().any(|own| own == host))
}

fn own_hosts(port: u16) -> [String; 3] {
    [format!("127.0.0.1:{port}"), format!("localhost:{port}"), format!("[::1]:{port}")]
}

/// Whether a page of this server opened the socket.
fn own_page(headers: &HeaderMap, shared: &Shared) -> bool {
    let text = |name| headers.get(name).and_then(|value: &HeaderValue| value.to_str().ok());
    let from = text(header::ORIGIN).and_then(|origin| origin.strip_prefix("http://"));
    let own = own_hosts(shared.port);
    // where others are let in, the page comes from wherever the browser found it
    let same =
        |from: &str| own.iter().any(|own| own == from) || shared.open_to_others && text(header::HOST) == Some(from);
    from.is_some_and(same)
}

fn refused() -> Response {
    (StatusCode::FORBIDDEN, "this address is for pages of this machine only\n").into_response()
}

fn file(kind: &'static str, bytes: &'static [u8]) -> Response {
    let mut response = bytes.into_response();
    let headers = response.headers_mut();
    headers.insert(header::CONTENT_TYPE, HeaderValue::from_static(kind));
    headers.insert(header::CACHE_CONTROL, HeaderValue::from_static("no-store"));
    headers.insert(header::X_CONTENT_TYPE_OPTIONS, HeaderValue::from_static("nosniff"));
    response
}

async fn page(State(shared): State<Arc<Shared>>, headers: HeaderMap) -> Response {
    if !admitted(&headers, &shared) {
        return refused();
    }
    file("text/html; charset=utf-8", assets::PAGE)
}

async fn asset(State(shared): State<Arc<Shared>>, headers: HeaderMap, Part(name): Part<String>) -> Response {
    if !admitted(&headers, &shared) {
        return refused();
    }
    match assets::FILES.iter().find(|(known, ..)| *known == name) {
        Some(&(_, kind, bytes)) => file(kind, bytes),
        None => (StatusCode::NOT_FOUND, "no such file\n").into_response(),
    }
}

async fn gallery(State(shared): State<Arc<Shared>>, headers: HeaderMap) -> Response {
    if !admitted(&headers, &shared) {
        return refused();
    }
    let built = lab::gallery::LIST.iter().filter_map(|built| {
        let scenario = lab::scenario::build::read(built.id, built.text, &[]).ok()?.scenario;
        let models: Vec<&str> = scenario.group.0.iter().map(|(_, group)| group.model.id.as_str()).collect();
        let agents: usize = scenario.group.0.iter().map(|(_, group)| group.count).sum();
        Some(json!({
            "id": built.id, "title": scenario.title, "about": scenario.about,
            "dimensions": scenario.space.dimensions, "models": models, "agents": agents,
        }))
    });
    let text = serde_json::Value::Array(built.collect()).to_string();
    ([(header::CONTENT_TYPE, "application/json")], text).into_response()
}

async fn socket(State(shared): State<Arc<Shared>>, headers: HeaderMap, upgrade: WebSocketUpgrade) -> Response {
    if !admitted(&headers, &shared) || !own_page(&headers, &shared) {
        return refused();
    }
    upgrade.max_message_size(LARGEST).max_frame_size(LARGEST).on_upgrade(|socket| talk(socket, shared))
}

/// One connection: what the page says goes to the session, what the session says to the page.
async fn talk(mut socket: WebSocket, shared: Arc<Shared>) {
    let (to_page, mut from_session) = tokio::sync::mpsc::channel::<Outgoing>(WAITING);
    let (to_session, from_page) = std::sync::mpsc::channel::<String>();
    let session = Session::new(shared, to_page, PROGRAM);
    let thread = std::thread::Builder::new().name("session".into()).spawn(move || session.run(&from_page));
    if thread.is_err() {
        return;
    }
    loop {
        tokio::select! {
            said = socket.recv() => match said {
                Some(Ok(Message::Text(text))) => {
                    if to_session.send(text.to_string()).is_err() {
                        break;
                    }
                }
                Some(Ok(Message::Binary(_))) => {
                    let reason = CloseFrame { code: 1003, reason: "text messages only".into() };
                    let _ = socket.send(Message::Close(Some(reason))).await;
                    break;
                }
                Some(Ok(Message::Ping(_) | Message::Pong(_))) => {}
                Some(Ok(Message::Close(_)) | Err(_)) | None => break,
            },
            heard = from_session.recv() => {
                let message = match heard {
                    Some(Outgoing::Text(text)) => Message::Text(text.into()),
                    Some(Outgoing::Frame(bytes)) => Message::Binary(bytes.into()),
                    None => break,
                };
                if socket.send(message).await.is_err() {
                    break;
                }
            }
        }
    }
}
