//! What the page asks for beside its socket: searches and their parts, files that were dropped on it, sketches.

use super::{Given, Shared, ViewOptions, admitted, dropped, own_page, refused};
use crate::kinds;
use axum::body::Bytes;
use axum::extract::{Path as Part, RawQuery, State};
use axum::http::{HeaderMap, StatusCode, header};
use axum::response::{IntoResponse, Response};
use lab::live::LiveError;
use lab::searched::{At, Searched};
use lab::sketch::{self, Item, Target};
use serde_json::{Value as Json, json};
use std::sync::Arc;

/// An answer of JSON.
fn answer(value: &Json) -> Response {
    ([(header::CONTENT_TYPE, "application/json"), (header::CACHE_CONTROL, "no-store")], value.to_string())
        .into_response()
}

/// What is wrong with what a person gave. It is an answer like any other: browsers complain of refused requests themselves.
fn problem(text: &str) -> Response {
    answer(&json!({ "problem": text }))
}

/// Asks a search something, on a thread where that keeps nobody waiting.
async fn asked(
    shared: Arc<Shared>,
    headers: HeaderMap,
    given: usize,
    ask: impl FnOnce(&dyn Searched) -> Result<Json, LiveError> + Send + 'static,
) -> Response {
    if !admitted(&headers, &shared) {
        return refused();
    }
    let Some(Given::Search(_, _, search)) = shared.given(given) else {
        return (StatusCode::NOT_FOUND, "no such search\n").into_response();
    };
    match tokio::task::spawn_blocking(move || ask(&*search)).await {
        Ok(Ok(value)) => answer(&value),
        Ok(Err(error)) => problem(&error.to_string()),
        Err(error) => (StatusCode::INTERNAL_SERVER_ERROR, error.to_string()).into_response(),
    }
}

/// The overview of a search.
pub(super) async fn overview(
    State(shared): State<Arc<Shared>>,
    headers: HeaderMap,
    Part(given): Part<usize>,
) -> Response {
    asked(shared, headers, given, |search| Ok(search.overview())).await
}

/// A part of a search.
pub(super) async fn part(
    State(shared): State<Arc<Shared>>,
    headers: HeaderMap,
    Part(given): Part<usize>,
    RawQuery(words): RawQuery,
) -> Response {
    asked(shared, headers, given, move |search| search.part(&At::asked(&words.unwrap_or_default()))).await
}

/// Takes a file that was dropped on the page: name in the first line, text below. The answer is its number among what was given.
pub(super) async fn give(State(shared): State<Arc<Shared>>, headers: HeaderMap, body: String) -> Response {
    if !admitted(&headers, &shared) || !own_page(&headers, &shared) {
        return refused();
    }
    let (name, text) = body.split_once('\n').unwrap_or(("", &body));
    let name = if name.is_empty() { "dropped.toml" } else { name };
    let seen = || {
        let (kind, input) = kinds::read_text(name, text)?;
        kind.view(&input, &ViewOptions::default())
    };
    match seen() {
        Ok((name, text)) => {
            let number = shared.add(vec![Given::Scenario(name, text)]);
            answer(&json!({ "given": number, "all": shared.told() }))
        }
        Err(fault) => problem(&fault.to_string()),
    }
}

/// Takes files that were dropped on the page, as they are. The answer is the number of the first thing to look at among what was
/// given.
pub(super) async fn dropped(State(shared): State<Arc<Shared>>, headers: HeaderMap, body: Bytes) -> Response {
    if !admitted(&headers, &shared) || !own_page(&headers, &shared) {
        return refused();
    }
    let own = Arc::clone(&shared);
    match tokio::task::spawn_blocking(move || dropped::opened(&body, &own.dropped)).await {
        Ok(Ok((given, told))) => {
            let number = shared.add(given);
            answer(&json!({ "given": number, "all": shared.told(), "told": told }))
        }
        Ok(Err(fault)) => problem(&fault.to_string()),
        Err(error) => (StatusCode::INTERNAL_SERVER_ERROR, error.to_string()).into_response(),
    }
}

/// The sketch of a file: name in the first line, text below.
pub(super) async fn sketch(State(shared): State<Arc<Shared>>, headers: HeaderMap, body: String) -> Response {
    if !admitted(&headers, &shared) || !own_page(&headers, &shared) {
        return refused();
    }
    let (name, text) = body.split_once('\n').unwrap_or(("", &body));
    match sketch::open(name, text) {
        Ok(sketch) => answer(&sketch),
        Err(text) => problem(&text),
    }
}

/// Saves a sketch: `as`, `name`, `base`, `items`. The answer is the file.
pub(super) async fn save(State(shared): State<Arc<Shared>>, headers: HeaderMap, body: String) -> Response {
    if !admitted(&headers, &shared) || !own_page(&headers, &shared) {
        return refused();
    }
    let saved = || {
        let asked: Json = serde_json::from_str(&body).map_err(|error| format!("not JSON: {error}"))?;
        let text = |key: &str| asked.get(key).and_then(Json::as_str).unwrap_or_default();
        let target = Target::of(text("as")).ok_or("a sketch is saved as file, workspace, svg or geojson")?;
        let items = asked.get("items").and_then(Json::as_array).cloned().unwrap_or_default();
        let items: Vec<Item> = items.iter().map(Item::of).collect::<Result<_, _>>()?;
        sketch::save(target, text("name"), text("base"), &items)
    };
    match saved() {
        Ok(saved) => answer(&json!({ "name": saved.name, "text": saved.text, "left_out": saved.left_out })),
        Err(text) => problem(&text),
    }
}
