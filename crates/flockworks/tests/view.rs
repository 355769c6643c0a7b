//! The viewer's server: what it serves, whom it refuses, and a conversation with a session.

#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, reason = "tests")]

use serde_json::{Value, json};
use std::io::{BufRead, BufReader, Read, Write};
use std::net::TcpStream;
use std::process::{Child, Command, Stdio};

struct Server {
    child: Child,
    port: u16,
}

impl Drop for Server {
    fn drop(&mut self) {
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

fn served(arguments: &[&str]) -> Server {
    let mut child = Command::new(env!("CARGO_BIN_EXE_flockworks"))
        .arg("view")
        .args(arguments)
        .stdout(Stdio::piped())
        .spawn()
        .unwrap();
    let mut line = String::new();
    BufReader::new(child.stdout.take().unwrap()).read_line(&mut line).unwrap();
    let port = line.trim().trim_start_matches("http://127.0.0.1:").trim_end_matches('/').parse().unwrap();
    Server { child, port }
}

fn study(name: &str) -> String {
    format!("{}/../../studies/{name}", env!("CARGO_MANIFEST_DIR"))
}

/// Sends a request and gives the connection back.
fn asked(port: u16, path: &str, headers: &str) -> TcpStream {
    let mut stream = TcpStream::connect(("127.0.0.1", port)).unwrap();
    stream.write_all(format!("GET {path} HTTP/1.1\r\n{headers}\r\n").as_bytes()).unwrap();
    stream
}

/// The answer to a request with `Connection: close`.
fn got(port: u16, path: &str, host: &str) -> String {
    let mut answer = Vec::new();
    let mut stream = asked(port, path, &format!("Host: {host}\r\nConnection: close\r\n"));
    stream.read_to_end(&mut answer).unwrap();
    String::from_utf8_lossy(&answer).into_owned()
}

/// A socket after its handshake, or the status line of the refusal.
fn socket(port: u16, origin: &str) -> Result<BufReader<TcpStream>, String> {
    let origin = if origin.is_empty() { String::new() } else { format!("Origin: {origin}\r\n") };
    let headers = format!(
        "Host: 127.0.0.1:{port}\r\n{origin}Upgrade: websocket\r\nConnection: Upgrade\r\n\
         Sec-WebSocket-Version: 13\r\nSec-WebSocket-Key: AAAAAAAAAAAAAAAAAAAAAA==\r\n"
    );
    let mut reader = BufReader::new(asked(port, "/ws", &headers));
    let mut status = String::new();
    reader.read_line(&mut status).unwrap();
    if !status.contains("101") {
        return Err(status);
    }
    let mut line = String::new();
    while line != "\r\n" {
        line.clear();
        reader.read_line(&mut line).unwrap();
    }
    Ok(reader)
}

fn say(socket: &mut BufReader<TcpStream>, kind: u8, bytes: &[u8]) {
    let mut frame = vec![0x80 | kind];
    match bytes.len() {
        n if n < 126 => frame.push(0x80 | n as u8),
        n if n < 65_536 => {
            frame.push(0x80 | 126);
            frame.extend((n as u16).to_be_bytes());
        }
        n => {
            frame.push(0x80 | 127);
            frame.extend((n as u64).to_be_bytes());
        }
    }
    // a mask of zeros changes nothing
    frame.extend([0; 4]);
    frame.extend(bytes);
    socket.get_mut().write_all(&frame).unwrap();
}

enum Heard {
    Text(Value),
    Frame(Vec<u8>),
    Closed,
}

fn hear(socket: &mut BufReader<TcpStream>) -> Heard {
    let mut head = [0; 2];
    if socket.read_exact(&mut head).is_err() {
        return Heard::Closed;
    }
    let length = match head[1] & 127 {
        126 => {
            let mut bytes = [0; 2];
            socket.read_exact(&mut bytes).unwrap();
            usize::from(u16::from_be_bytes(bytes))
        }
        127 => {
            let mut bytes = [0; 8];
            socket.read_exact(&mut bytes).unwrap();
            u64::from_be_bytes(bytes) as usize
        }
        short => usize::from(short),
    };
    let mut payload = vec![0; length];
    socket.read_exact(&mut payload).unwrap();
    match head[0] & 15 {
        1 => Heard::Text(serde_json::from_slice(&payload).unwrap()),
        2 => Heard::Frame(payload),
        8 => Heard::Closed,
        _ => hear(socket),
    }
}

fn tell(socket: &mut BufReader<TcpStream>, message: &Value) {
    say(socket, 1, message.to_string().as_bytes());
}

/// The next message of a kind; others are passed over.
fn until(socket: &mut BufReader<TcpStream>, is: &str) -> Value {
    loop {
        match hear(socket) {
            Heard::Text(message) if message["is"] == is => return message,
            Heard::Closed => panic!("closed before `{is}`"),
            Heard::Text(_) | Heard::Frame(_) => {}
        }
    }
}

fn frame(socket: &mut BufReader<TcpStream>) -> Vec<u8> {
    loop {
        match hear(socket) {
            Heard::Frame(bytes) => return bytes,
            Heard::Closed => panic!("closed before a frame"),
            Heard::Text(_) => {}
        }
    }
}

fn whole(bytes: &[u8], at: usize) -> u32 {
    u32::from_le_bytes(bytes[at..at + 4].try_into().unwrap())
}

#[test]
fn it_serves_its_page_to_this_machine_alone() {
    let server = served(&[]);
    let port = server.port;
    let host = format!("127.0.0.1:{port}");
    let page = got(port, "/", &host);
    assert!(page.starts_with("HTTP/1.1 200") && page.contains("text/html") && page.contains("Content-Security-Policy"));
    assert!(got(port, "/main.js", &host).contains("text/javascript"));
    assert!(got(port, "/none.js", &host).starts_with("HTTP/1.1 404"));
    let gallery = got(port, "/gallery.json", &format!("localhost:{port}"));
    assert_eq!(gallery.matches("\"id\":").count(), 9);
    // another site whose name leads here is not this one
    assert!(got(port, "/", "evil.example").starts_with("HTTP/1.1 403"));
    for origin in ["", "http://evil.example", "null", "http://127.0.0.1:1"] {
        assert!(socket(port, origin).is_err_and(|status| status.contains("403")), "{origin}");
    }
    assert!(socket(port, &format!("http://127.0.0.1:{port}")).is_ok());
}

#[test]
fn other_machines_are_let_in_where_that_is_told() {
    let server = served(&["--listen", "0.0.0.0"]);
    assert!(got(server.port, "/", "laboratory.example").starts_with("HTTP/1.1 200"));
    // still only its own page opens the socket, under the name by which it was asked for
    assert!(socket(server.port, &format!("http://127.0.0.1:{}", server.port)).is_ok());
    assert!(socket(server.port, "http://evil.example").is_err_and(|status| status.contains("403")));
}

#[test]
fn a_session_plays_and_changes_a_simulation() {
    let server = served(&[]);
    let mut socket = socket(server.port, &format!("http://127.0.0.1:{}", server.port)).unwrap();
    assert_eq!(until(&mut socket, "hello")["given"], json!([]));
    tell(&mut socket, &json!({ "do": "play" }));
    assert!(until(&mut socket, "problem")["text"].as_str().unwrap().contains("nothing is opened"));
    tell(&mut socket, &json!({ "do": "open", "gallery": "schooling" }));
    let scene = until(&mut socket, "scene");
    assert_eq!((&scene["dimensions"], &scene["kind"]), (&json!(3), &json!("live")));
    assert_eq!(scene["labels"][0]["column"], "behaviour");
    assert_eq!(until(&mut socket, "obstacles")["list"].as_array().unwrap().len(), 120);
    let first = frame(&mut socket);
    assert_eq!((whole(&first, 0), whole(&first, 4), whole(&first, 16)), (1, 0, 200));
    assert_eq!(first.len(), 24 + 200 * (4 * 6 + 1));
    assert!(until(&mut socket, "metrics")["rows"][0]["values"].as_array().unwrap().len() == 7);
    tell(&mut socket, &json!({ "do": "step", "count": 10 }));
    let later = frame(&mut socket);
    assert_eq!(whole(&later, 4), 10);
    // two frames are unseen: the next waits for the page
    tell(&mut socket, &json!({ "do": "step", "count": 5 }));
    tell(&mut socket, &json!({ "do": "seen", "number": 2 }));
    assert_eq!(whole(&frame(&mut socket), 4), 15);
    tell(&mut socket, &json!({ "do": "seen", "number": 3 }));
    let control = scene["controls"].as_array().unwrap().iter().find(|c| c["name"] == "speed").unwrap();
    assert_eq!((&control["unit"], &control["value"], &control["low"]), (&json!("radii/s"), &json!(6.0), &json!(0.1)));
    let path = &control["path"];
    tell(&mut socket, &json!({ "do": "set", "path": path, "value": 12 }));
    let event = until(&mut socket, "event");
    assert_eq!((&event["step"], event["what"].as_str().unwrap().ends_with(".speed = 12")), (&json!(15), true));
    tell(&mut socket, &json!({ "do": "set", "path": path, "value": -1 }));
    assert!(until(&mut socket, "problem")["text"].as_str().unwrap().contains("must be more than 0"));
    tell(&mut socket, &json!({ "do": "save" }));
    let saved = until(&mut socket, "file")["text"].as_str().unwrap().to_owned();
    assert!(saved.contains("speed = 12") && saved.contains("# 120 spheres"), "{saved}");
    let file = std::path::PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join("saved.toml");
    std::fs::write(&file, saved).unwrap();
    let check = Command::new(env!("CARGO_BIN_EXE_flockworks")).arg("check").arg(&file).output().unwrap();
    assert_eq!(check.status.code(), Some(0));
    tell(&mut socket, &json!({ "do": "play" }));
    assert_eq!(until(&mut socket, "status")["playing"], true);
}

#[test]
fn nonsense_is_answered_and_too_much_is_cut_off() {
    let server = served(&[&study("gallery/mill.toml")]);
    let origin = format!("http://127.0.0.1:{}", server.port);
    let mut first = socket(server.port, &origin).unwrap();
    assert_eq!(until(&mut first, "hello")["given"][0]["kind"], "scenario");
    tell(&mut first, &json!({ "do": "open", "given": 0 }));
    until(&mut first, "scene");
    for nonsense in [
        "",
        "{",
        "[]",
        "{\"do\":7}",
        "{\"do\":\"fly\"}",
        "{\"do\":\"speed\"}",
        "{\"do\":\"set\",\"path\":\"a\"}",
        "{\"do\":\"speed\",\"rate\":-5}",
        "{\"do\":\"seek\",\"frame\":3}",
        "{\"do\":\"open\",\"gallery\":\"none\"}",
        "{\"do\":\"go_on\"}",
        "{\"do\":\"set\",\"path\":\"space.dimensions\",\"value\":3}",
    ] {
        say(&mut first, 1, nonsense.as_bytes());
        until(&mut first, "problem");
    }
    // more steps than can ever be made are in nobody's way
    tell(&mut first, &json!({ "do": "step", "count": i64::MAX }));
    tell(&mut first, &json!({ "do": "fly" }));
    until(&mut first, "problem");
    tell(&mut first, &json!({ "do": "pause" }));
    // it still works
    tell(&mut first, &json!({ "do": "step", "count": 1 }));
    frame(&mut first);
    say(&mut first, 1, &vec![b' '; 100_000]);
    while !matches!(hear(&mut first), Heard::Closed) {}
    let mut second = socket(server.port, &origin).unwrap();
    until(&mut second, "hello");
    say(&mut second, 2, &[1, 2, 3]);
    while !matches!(hear(&mut second), Heard::Closed) {}
    assert!(socket(server.port, &origin).is_ok(), "the server is still there");
}

#[test]
fn a_recorded_run_is_scrubbed_both_ways() {
    let out = std::path::PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join("view-run");
    let _ = std::fs::remove_dir_all(&out);
    let run = Command::new(env!("CARGO_BIN_EXE_flockworks"))
        .args(["run", &study("schooling.toml"), "--quick", "--out", out.to_str().unwrap()])
        .output()
        .unwrap();
    assert_eq!(run.status.code(), Some(0));
    let server = served(&[out.to_str().unwrap()]);
    let mut socket = socket(server.port, &format!("http://127.0.0.1:{}", server.port)).unwrap();
    tell(&mut socket, &json!({ "do": "open", "given": 0 }));
    let scene = until(&mut socket, "scene");
    assert_eq!((&scene["kind"], &scene["frames"], &scene["every_steps"]), (&json!("run"), &json!(61), &json!(10)));
    let all = until(&mut socket, "metrics_all");
    assert_eq!(all["t"].as_array().unwrap().len(), 61);
    assert_eq!(all["groups"][0]["values"].as_array().unwrap().len(), 7);
    let zero = frame(&mut socket);
    let mut number = 1;
    let mut seek = |to: u64| {
        tell(&mut socket, &json!({ "do": "seen", "number": number }));
        tell(&mut socket, &json!({ "do": "seek", "frame": to }));
        number += 1;
        frame(&mut socket)
    };
    let last = seek(1000);
    assert_eq!(whole(&last, 4), 600);
    let again = seek(0);
    assert_eq!(zero[4..], again[4..], "the same frame but for its number");
    tell(&mut socket, &json!({ "do": "set", "path": "seed", "value": 3 }));
    assert!(until(&mut socket, "problem")["text"].as_str().unwrap().contains("does not change"));
}

#[test]
fn wrong_input_is_refused_before_anything_is_served() {
    let refused = |arguments: &[&str], part: &str| {
        let run = Command::new(env!("CARGO_BIN_EXE_flockworks")).arg("view").args(arguments).output().unwrap();
        let text = String::from_utf8(run.stderr).unwrap();
        assert_eq!(run.status.code(), Some(2), "{text}");
        assert!(text.contains(part), "`{part}` is not in: {text}");
    };
    refused(&["nothing.toml"], "cannot read");
    refused(&[env!("CARGO_TARGET_TMPDIR")], "not the folder of a run");
    refused(&["--threads", "0"], "--threads");
    let taken = std::net::TcpListener::bind(("127.0.0.1", 0)).unwrap();
    refused(&["--port", &taken.local_addr().unwrap().port().to_string()], "cannot listen");
}

/// The answer to a POST with `Connection: close`.
fn posted(port: u16, path: &str, origin: &str, body: &str) -> String {
    let mut stream = TcpStream::connect(("127.0.0.1", port)).unwrap();
    let head = format!(
        "POST {path} HTTP/1.1\r\nHost: 127.0.0.1:{port}\r\nOrigin: {origin}\r\nContent-Type: text/plain;charset=UTF-8\r\n\
         Content-Length: {}\r\nConnection: close\r\n\r\n{body}",
        body.len()
    );
    stream.write_all(head.as_bytes()).unwrap();
    let mut answer = Vec::new();
    stream.read_to_end(&mut answer).unwrap();
    String::from_utf8_lossy(&answer).into_owned()
}

fn body(answer: &str) -> Value {
    serde_json::from_str(answer.split_once("\r\n\r\n").unwrap().1).unwrap()
}

#[test]
fn a_study_is_told_cell_by_cell_and_any_trial_is_simulated_again() {
    let out = std::path::PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join("view-study");
    let _ = std::fs::remove_dir_all(&out);
    let run = Command::new(env!("CARGO_BIN_EXE_flockworks"))
        .args([
            "run",
            &study("compositions/weights.toml"),
            "--quick",
            "--trials",
            "1-2",
            "--set",
            "set.time.duration=70",
        ])
        .args(["--out", out.to_str().unwrap()])
        .output()
        .unwrap();
    assert_eq!(run.status.code(), Some(0), "{}", String::from_utf8_lossy(&run.stderr));
    let server = served(&[out.to_str().unwrap()]);
    let port = server.port;
    let host = format!("127.0.0.1:{port}");
    let overview = body(&got(port, "/search/0", &host));
    assert_eq!((&overview["kind"], overview["levels"].as_array().unwrap().len()), (&json!("study"), 15));
    let part = body(&got(port, "/search/0/part?reading=0", &host));
    let values = part["cells"][3]["values"].as_array().unwrap();
    assert!(values.len() == 2 && values.iter().all(Value::is_number), "{part}");
    assert!(got(port, "/search/0/part?reading=99", &host).contains("there are 3"));
    assert!(got(port, "/search/7", &host).starts_with("HTTP/1.1 404"));
    assert!(got(port, "/search/0", "evil.example").starts_with("HTTP/1.1 403"));
    let mut socket = socket(port, &format!("http://{host}")).unwrap();
    let hello = until(&mut socket, "hello");
    assert_eq!((&hello["given"][0]["kind"], &hello["given"][0]["of"]), (&json!("search"), &json!("study")));
    tell(&mut socket, &json!({ "do": "open", "given": 0, "at": { "cell": 3, "trial": 2 } }));
    let scene = until(&mut socket, "scene");
    assert_eq!((&scene["seed"], &scene["kind"]), (&json!(3), &json!("live")));
    tell(&mut socket, &json!({ "do": "open", "given": 0, "at": { "cell": 99, "trial": 2 } }));
    assert!(until(&mut socket, "problem")["text"].as_str().unwrap().contains("no cell 99"));
}

#[test]
fn files_and_sketches_are_taken_from_its_own_page_alone() {
    let server = served(&[]);
    let port = server.port;
    let own = format!("http://127.0.0.1:{port}");
    let mill = std::fs::read_to_string(study("gallery/mill.toml")).unwrap();
    let given = posted(port, "/given", &own, &format!("mill.toml\n{mill}"));
    assert_eq!(body(&given)["given"], 0, "{given}");
    for path in ["/given", "/sketch", "/sketch/save"] {
        assert!(posted(port, path, "http://evil.example", "a\nb").starts_with("HTTP/1.1 403"), "{path}");
        let wrong = body(&posted(port, path, &own, "a.toml\nkind = \"nonsense\""));
        assert!(wrong["problem"].is_string(), "{path}: {wrong}");
    }
    let corral = std::fs::read_to_string(study("gallery/corral.toml")).unwrap();
    let sketch = body(&posted(port, "/sketch", &own, &format!("corral.toml\n{corral}")));
    let mut items = sketch["items"].as_array().unwrap().clone();
    items.push(json!({ "is": "wall", "points": [[90, 42], [90, 58]] }));
    let asked = json!({ "as": "file", "name": "corral.toml", "base": corral, "items": items });
    let saved = body(&posted(port, "/sketch/save", &own, &asked.to_string()));
    let file = std::path::PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join("drawn.toml");
    std::fs::write(&file, saved["text"].as_str().unwrap()).unwrap();
    let check = Command::new(env!("CARGO_BIN_EXE_flockworks")).arg("check").arg(&file).output().unwrap();
    assert_eq!(check.status.code(), Some(0), "{}", String::from_utf8_lossy(&check.stderr));
}

/// Where everybody is in a frame, as bits.
fn places(frame: &[u8]) -> Vec<u32> {
    (0..2 * whole(frame, 16) as usize).map(|k| whole(frame, 24 + 4 * k)).collect()
}

/// Makes so many steps in a session that has shown `seen` frames, and gives the frame after them.
fn stepped(socket: &mut BufReader<TcpStream>, seen: u32, count: u64) -> Vec<u8> {
    tell(socket, &json!({ "do": "seen", "number": seen }));
    tell(socket, &json!({ "do": "step", "count": count }));
    frame(socket)
}

#[test]
fn a_formation_goes_on_when_it_is_told_to_and_its_times_give_the_same_trial() {
    let folder = std::path::PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join("view-formation");
    let _ = std::fs::remove_dir_all(&folder);
    std::fs::create_dir_all(&folder).unwrap();
    let program = |arguments: &[&str]| {
        let run = Command::new(env!("CARGO_BIN_EXE_flockworks")).current_dir(&folder).args(arguments).output().unwrap();
        (run.status.code(), String::from_utf8_lossy(&run.stdout).into_owned() + &String::from_utf8_lossy(&run.stderr))
    };
    let template = program(&["new", "formation"]).1.replace("duration = 100", "duration = 40");
    let manual = template.replace("per_wall = 3 }", "per_wall = 3, switch = \"manual\" }");
    assert_ne!(manual, template);
    std::fs::write(folder.join("manual.toml"), &manual).unwrap();
    // nobody says when to go on in a run
    let line = manual.lines().position(|line| line.contains("manual")).unwrap() + 1;
    let (code, told) = program(&["run", "manual.toml", "--quick", "--out", "none"]);
    assert_eq!(code, Some(2), "{told}");
    assert!(told.contains(&format!("manual.toml:{line}:")) && told.contains("`switch_at`"), "{told}");
    assert!(told.matches("error").count() == 1 && !folder.join("none").exists(), "{told}");
    let (code, told) = program(&["check", "manual.toml"]);
    assert!(code == Some(0) && told.contains("viewed and not run, for `robots`"), "{told}");

    let opened = |file: &str, at: Value| {
        let server = served(&[folder.join(file).to_str().unwrap()]);
        let mut socket = socket(server.port, &format!("http://127.0.0.1:{}", server.port)).unwrap();
        tell(&mut socket, &json!({ "do": "open", "given": 0, "at": at }));
        let scene = until(&mut socket, "scene");
        (server, socket, scene)
    };
    let (_server, mut told, scene) = opened("manual.toml", json!({}));
    assert_eq!((&scene["kind"], &scene["goes_on"], &scene["steps"]), (&json!("live"), &json!(true), &json!(200)));
    assert_eq!(
        scene["groups"][1],
        json!({ "name": "shepherds", "model": "", "title": "", "first": 4, "count": 6, "radius": 0.17 })
    );
    assert!(scene["title"].as_str().unwrap().contains("task corner, robots, trial 1"), "{scene}");
    let list = until(&mut told, "obstacles")["list"].as_array().unwrap().len();
    assert!(list > 4, "the arena, the path and its gates: {list}");
    assert_eq!(whole(&frame(&mut told), 16), 10, "targets and shepherds");
    let mut seen = Vec::new();
    for (number, count) in [(1, 45), (2, 60), (3, 50)] {
        seen.push(stepped(&mut told, number, count));
        tell(&mut told, &json!({ "do": "go_on" }));
        let event = until(&mut told, "event");
        assert_eq!(
            (&event["step"], &event["what"]),
            (&json!(whole(seen.last().unwrap(), 4)), &json!("next formation"))
        );
    }
    // the trial ends by itself: more steps than there are
    seen.push(stepped(&mut told, 4, 1000));
    let end = whole(&seen[3], 4);
    assert!(end <= 200, "{end}");
    tell(&mut told, &json!({ "do": "save" }));
    let saved = until(&mut told, "file")["text"].as_str().unwrap().to_owned();
    std::fs::write(folder.join("told.toml"), &saved).unwrap();
    assert!(saved.contains("switch_at = [9") && saved.contains("# What is there already"), "{saved}");

    // the same frames where the file gives the times
    let (_server, mut given, scene) = opened("told.toml", json!({}));
    assert!(scene["title"].as_str().unwrap().contains("robots, trial 1"), "{scene}");
    frame(&mut given);
    for (k, count) in [45, 60, 50, 1000].into_iter().enumerate() {
        let again = stepped(&mut given, k as u32 + 1, count);
        assert_eq!(again[4..], seen[k][4..], "frame {k}");
    }
    // and where a run tried it, which nobody watched
    let (code, ran) = program(&["run", "told.toml", "--quick", "--out", "ran"]);
    assert_eq!(code, Some(0), "{ran}");
    let (_server, mut ran, scene) = opened("ran", json!({ "task": 0, "method": 2, "trial": 1 }));
    assert_eq!(scene["frames"], json!(end + 1));
    frame(&mut ran);
    for (k, frame_of) in seen.iter().enumerate() {
        tell(&mut ran, &json!({ "do": "seen", "number": k + 1 }));
        tell(&mut ran, &json!({ "do": "seek", "frame": whole(frame_of, 4) }));
        assert_eq!(places(&frame(&mut ran)), places(frame_of), "frame {k}");
    }
    // without a word it is another trial
    let (_server, mut silent, _) = opened("manual.toml", json!({}));
    frame(&mut silent);
    assert_eq!(places(&stepped(&mut silent, 1, 45)), places(&seen[0]));
    assert_ne!(places(&stepped(&mut silent, 2, 60)), places(&seen[1]));
    // another method of the file may be chosen, and cannot go on
    tell(&mut silent, &json!({ "do": "set", "path": "method", "value": "walls" }));
    let scene = until(&mut silent, "scene");
    assert_eq!((&scene["goes_on"], scene["groups"].as_array().unwrap().len()), (&json!(false), 1));
    tell(&mut silent, &json!({ "do": "go_on" }));
    assert!(until(&mut silent, "problem")["text"].as_str().unwrap().contains("`walls` is no formation"));
    tell(&mut silent, &json!({ "do": "set", "path": "method", "value": "wals" }));
    assert!(until(&mut silent, "problem")["text"].as_str().unwrap().contains("no method"));
}

#[test]
fn a_decomposition_shows_its_approaches_and_simulates_any_trial_again() {
    let folder = std::path::PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join("view-decomposition");
    let _ = std::fs::remove_dir_all(&folder);
    std::fs::create_dir_all(&folder).unwrap();
    let program = |arguments: &[&str]| {
        let run = Command::new(env!("CARGO_BIN_EXE_flockworks")).current_dir(&folder).args(arguments).output().unwrap();
        assert_eq!(run.status.code(), Some(0), "{}", String::from_utf8_lossy(&run.stderr));
        String::from_utf8_lossy(&run.stdout).into_owned()
    };
    let stretch = "[interval.bend]\nabout = \"comes apart\"\nline = 1\nfrom = 40\nto = 60\nbehaviour.is.simple-split = {}\n\
                   [vary]\nangles = [0]\nlengths = [1]\nquick_trials = 1\n[scenario]\n";
    let template = program(&["new", "decomposition"]);
    let marked = template.replacen("[scenario]\n", stretch, 1);
    assert_ne!(marked, template);
    std::fs::write(folder.join("bend.toml"), marked).unwrap();
    program(&["run", "bend.toml", "--quick", "--out", "bend", "--set", "offsets=2"]);
    let server = served(&[folder.join("bend").to_str().unwrap()]);
    let port = server.port;
    let host = format!("127.0.0.1:{port}");
    let overview = body(&got(port, "/search/0", &host));
    let (clusters, approaches) = (overview["clusters"].as_array().unwrap(), overview["approaches"].as_array().unwrap());
    assert!(clusters.len() > 1 && overview["tried"] == overview["planned"], "{overview}");
    let counted: u64 = clusters.iter().map(|cluster| cluster["approaches"].as_u64().unwrap()).sum();
    assert_eq!(counted as usize, approaches.len());
    let numbers = overview["numbers"].as_array().unwrap().len();
    assert!(approaches.iter().all(|one| one["found"].as_array().unwrap().len() == numbers));
    let variations = &overview["intervals"][0]["variations"];
    assert_eq!((&variations[0]["angle"], &variations[1]["angle"]), (&json!(0.0), &json!(null)));
    let medoid = |cluster: &Value| approaches[cluster["medoid"].as_u64().unwrap() as usize]["approach"].clone();
    let first = medoid(&clusters[0]);
    let part = body(&got(port, &format!("/search/0/part?approach={first}&offset=0"), &host));
    assert!(part["drawing"]["built"].as_array().is_some_and(|lines| !lines.is_empty()), "{part}");
    assert!(got(port, "/search/0/part?approach=99999", &host).contains("there is no approach 99999"));
    assert!(got(port, "/search/0/part?interval=0&variation=2", &host).contains("there is no variation 2"));

    let mut watched = socket(port, &format!("http://{host}")).unwrap();
    tell(&mut watched, &json!({ "do": "open", "given": 0, "at": { "approach": first, "trial": 1 } }));
    let scene = until(&mut watched, "scene");
    assert!(scene["kind"] == "live" && scene["title"].as_str().unwrap().contains("approached at"), "{scene}");
    frame(&mut watched);
    let now = stepped(&mut watched, 1, 60);
    // the file that the run wrote of the medoid is the same trial
    let file = folder.join(format!("bend/environments/{}.toml", clusters[0]["name"].as_str().unwrap()));
    let other = served(&[file.to_str().unwrap()]);
    let mut written = socket(other.port, &format!("http://127.0.0.1:{}", other.port)).unwrap();
    tell(&mut written, &json!({ "do": "open", "given": 0 }));
    frame(&mut written);
    assert_eq!(stepped(&mut written, 1, 60)[4..], now[4..]);
    // another offset is another trial, and a variation is watched as well
    let mut moved = socket(port, &format!("http://{host}")).unwrap();
    tell(&mut moved, &json!({ "do": "open", "given": 0, "at": { "approach": first, "offset": 0, "trial": 1 } }));
    let beside = until(&mut moved, "obstacles");
    assert_ne!(beside["list"], json!([]));
    tell(&mut moved, &json!({ "do": "open", "given": 0, "at": { "interval": 0, "variation": 0, "trial": 2 } }));
    let scene = until(&mut moved, "scene");
    assert!(scene["title"].as_str().unwrap().contains("bend, turned by 0"), "{scene}");
}
