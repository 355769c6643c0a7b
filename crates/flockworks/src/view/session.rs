//! A session: one page, one world, and what the page asks for.

use super::{Given, Shared};
use crate::kinds;
use lab::live::{LiveError, Replayed, Shown, simulate};
use lab::searched::At;
use serde_json::{Value as Json, json};
use std::sync::Arc;
use std::sync::mpsc::{Receiver, RecvTimeoutError};
use std::time::{Duration, Instant};
use tokio::sync::mpsc::Sender;

/// What goes to the page.
pub(super) enum Outgoing {
    /// A message.
    Text(String),
    /// A frame.
    Frame(Vec<u8>),
}

/// Frames the page may not have seen yet; one more where it asked for something.
const UNSEEN: u32 = 2;
/// Time given to stepping before the page is looked after again.
const SLICE: Duration = Duration::from_millis(12);
/// Longest time between two messages about pace.
const STATUS: Duration = Duration::from_millis(250);
/// Share of the time that measuring may take.
const MEASURING: f64 = 0.1;
/// Longest wait of a session that has nothing to do.
const IDLE: Duration = Duration::from_millis(200);

/// A session.
pub(super) struct Session {
    shared: Arc<Shared>,
    page: Sender<Outgoing>,
    program: &'static str,
    shown: Option<Box<dyn Shown>>,
    /// Whether it is a recording.
    recorded: bool,
    playing: bool,
    looped: bool,
    /// Steps (frames) per second; 0 for as fast as possible.
    rate: f64,
    /// Steps that are due, with the part of one that is not yet.
    due: f64,
    /// Steps that were asked for by number and are not made yet.
    ahead: i64,
    focus: Option<u32>,
    number: u32,
    seen: u32,
    /// Whether the page does not know the moment shown, and whether it asked for what it does not know.
    stale: bool,
    asked: bool,
    /// The moment that was last explained: step and agent.
    explained: Option<(u64, u32)>,
    items: Option<Json>,
    clock: Instant,
    /// Whether the page does not know whether it plays, and how fast.
    untold: bool,
    /// When, and at which step, it was last found out how fast steps are made, and how fast that was.
    timed: Instant,
    timed_step: u64,
    reached: f64,
    measured: Instant,
    /// How long measuring took the last time.
    measuring: Duration,
    /// Whether the page is gone or too slow to be told what it must know.
    lost: bool,
}

impl Session {
    pub(super) fn new(shared: Arc<Shared>, page: Sender<Outgoing>, program: &'static str) -> Self {
        let now = Instant::now();
        Self {
            shared,
            page,
            program,
            shown: None,
            recorded: false,
            playing: false,
            looped: false,
            rate: 0.0,
            due: 0.0,
            ahead: 0,
            focus: None,
            number: 0,
            seen: 0,
            stale: false,
            asked: false,
            explained: None,
            items: None,
            clock: now,
            untold: false,
            timed: now,
            timed_step: 0,
            reached: 0.0,
            measured: now,
            measuring: Duration::ZERO,
            lost: false,
        }
    }
    /// Talks to the page until it is gone.
    pub(super) fn run(mut self, from: &Receiver<String>) {
        self.tell(&json!({ "is": "hello", "program": self.program, "given": self.shared.told() }));
        while !self.lost {
            match from.recv_timeout(self.wait()) {
                Ok(text) => {
                    self.hear(&text);
                    // all that waits is heard before the next step
                    while let Ok(text) = from.try_recv() {
                        self.hear(&text);
                    }
                }
                Err(RecvTimeoutError::Timeout) => {}
                Err(RecvTimeoutError::Disconnected) => return,
            }
            self.play();
            self.show();
        }
    }
    /// How long to wait for the page before going on.
    fn wait(&self) -> Duration {
        if self.ahead > 0 {
            return Duration::ZERO;
        }
        if self.shown.is_none() || !self.playing {
            // a frame that could not be sent is sent as soon as the page has seen another, which it says
            return IDLE;
        }
        if self.rate == 0.0 {
            return Duration::ZERO;
        }
        Duration::from_secs_f64(((1.0 - self.due) / self.rate.abs()).clamp(0.0, 0.02))
    }
    /// Tells the page something that it must know.
    fn tell(&mut self, message: &Json) {
        self.lost |= self.page.try_send(Outgoing::Text(message.to_string())).is_err();
    }
    fn hear(&mut self, text: &str) {
        let answer = match serde_json::from_str::<Json>(text) {
            Ok(message) => self.obey(&message),
            Err(error) => Err(LiveError::Request(format!("not a message: {error}"))),
        };
        if let Err(error) = answer {
            self.tell(&json!({ "is": "problem", "text": error.to_string() }));
        }
    }
    fn obey(&mut self, message: &Json) -> Result<(), LiveError> {
        let wanted = |what: &str| LiveError::Request(what.to_owned());
        let verb = message.get("do").and_then(Json::as_str).ok_or_else(|| wanted("a message needs `do`"))?;
        let whole = |key: &str| message.get(key).and_then(Json::as_u64);
        if verb == "open" {
            return self.open(message);
        }
        if verb == "seen" {
            self.seen = whole("number").and_then(|n| u32::try_from(n).ok()).unwrap_or(self.seen).min(self.number);
            return Ok(());
        }
        let Some(shown) = &mut self.shown else { return Err(wanted("nothing is opened yet")) };
        self.untold |= matches!(verb, "play" | "pause" | "step" | "speed");
        self.asked |= matches!(verb, "set" | "focus");
        match verb {
            "play" => {
                self.playing = true;
                // the first step comes at once
                self.due = 1.0;
                self.clock = Instant::now();
            }
            "pause" => {
                self.stale |= self.ahead > 0;
                (self.playing, self.ahead) = (false, 0);
            }
            "step" => {
                let count =
                    message.get("count").and_then(Json::as_i64).ok_or_else(|| wanted("`step` needs a count"))?;
                self.playing = false;
                if self.recorded {
                    shown.advance(count)?;
                    self.stale = true;
                } else {
                    self.ahead = self.ahead.saturating_add(count.max(0));
                }
            }
            "speed" => {
                let rate = message.get("rate").and_then(Json::as_f64).filter(|rate| rate.is_finite());
                let rate = rate.ok_or_else(|| wanted("`speed` needs a rate"))?;
                if rate < 0.0 && !self.recorded {
                    return Err(wanted("a simulation goes forward only"));
                }
                (self.rate, self.due) = (rate.clamp(-10_000.0, 1e6), 0.0);
            }
            "loop" => self.looped = message.get("on").and_then(Json::as_bool).unwrap_or(false),
            "reset" => {
                shown.reset(whole("seed"))?;
                self.begin();
            }
            "seek" => {
                let frame = whole("frame").ok_or_else(|| wanted("`seek` needs a frame"))?;
                shown.seek(frame)?;
                self.stale = true;
            }
            "set" => {
                let path = message.get("path").and_then(Json::as_str).ok_or_else(|| wanted("`set` needs a path"))?;
                let value = message.get("value").ok_or_else(|| wanted("`set` needs a value"))?;
                let kept = shown.set(path, value)?;
                let (step, t, _) = shown.moment();
                let what = format!("{path} = {value}");
                let (scene, obstacles) = (shown.scene(), shown.obstacles());
                self.explained = None;
                self.stale = true;
                if !kept {
                    self.tell(&scene);
                    self.tell(&obstacles);
                }
                self.tell(&json!({ "is": "event", "step": step, "t": t, "what": what }));
            }
            "go_on" => {
                let what = shown.go_on()?;
                let (step, t, _) = shown.moment();
                self.tell(&json!({ "is": "event", "step": step, "t": t, "what": what }));
            }
            "focus" => {
                self.focus = whole("agent").and_then(|agent| u32::try_from(agent).ok());
                self.explained = None;
                self.stale = true;
            }
            "save" => {
                let text = shown.file()?;
                self.tell(&json!({ "is": "file", "text": text }));
            }
            other => return Err(LiveError::Request(format!("`{other}` is nothing that can be done"))),
        }
        Ok(())
    }
    fn open(&mut self, message: &Json) -> Result<(), LiveError> {
        let threads = self.shared.threads;
        let opened: (Box<dyn Shown>, bool) = if let Some(id) = message.get("gallery").and_then(Json::as_str) {
            let built =
                lab::gallery::find(id).ok_or_else(|| LiveError::Request(format!("the gallery has no `{id}`")))?;
            (simulate(built.id, built.text, &[], None, threads)?, false)
        } else {
            let at = message.get("given").and_then(Json::as_u64).unwrap_or(0) as usize;
            let place = At::of(message.get("at").unwrap_or(&Json::Null));
            match self.shared.given(at) {
                Some(Given::Scenario(name, text)) => (kinds::live(&name, &text, threads)?, false),
                Some(Given::Course(_, course)) => (Box::new(Replayed::new((*course).clone())?), true),
                Some(Given::Run(path, recording, _)) => {
                    let recording = place.perhaps("recording").unwrap_or(recording);
                    let kind = kinds::of_folder(&path).map_err(|fault| LiveError::Request(fault.to_string()))?;
                    (kind.show(&path, recording)?, true)
                }
                Some(Given::Search(_, _, search)) => search.watched(&place)?.shown(threads)?,
                None => return Err(LiveError::Request("the command line named nothing to open".into())),
            }
        };
        (self.shown, self.recorded) = (Some(opened.0), opened.1);
        self.rate = self.shown.as_ref().map_or(0.0, |shown| shown.natural_rate());
        (self.playing, self.focus) = (false, None);
        self.begin();
        Ok(())
    }
    /// Tells the page all it must know of what it looks at.
    fn begin(&mut self) {
        let Some(shown) = &self.shown else { return };
        let (scene, obstacles, all) = (shown.scene(), shown.obstacles(), shown.all_metrics());
        self.tell(&scene);
        self.tell(&obstacles);
        if let Some(all) = all {
            self.tell(&all);
        }
        (self.items, self.explained) = (None, None);
        (self.stale, self.due, self.ahead) = (true, 0.0, 0);
        self.measured = Instant::now() - Duration::from_secs(1);
    }
    /// Makes the steps that are due, as far as the time reaches.
    fn play(&mut self) {
        let elapsed = self.clock.elapsed();
        self.clock = Instant::now();
        let Some(shown) = &mut self.shown else { return };
        let began = Instant::now();
        while self.ahead > 0 && began.elapsed() <= SLICE {
            self.ahead = if shown.advance(1).is_ok() { self.ahead - 1 } else { 0 };
            // what was asked for is the moment after the last of them
            self.stale |= self.ahead == 0;
        }
        if !self.playing {
            return;
        }
        let fastest = self.rate == 0.0;
        self.due += elapsed.as_secs_f64() * self.rate.abs();
        let direction = if self.rate < 0.0 { -1 } else { 1 };
        while fastest || self.due >= 1.0 {
            match shown.advance(direction) {
                Ok(0) if self.looped && self.recorded => {
                    let turned = if direction > 0 { shown.seek(0) } else { shown.seek(u64::MAX) };
                    if turned.is_err() {
                        self.playing = false;
                        break;
                    }
                }
                Ok(0) | Err(_) => {
                    self.playing = false;
                    break;
                }
                Ok(_) => {}
            }
            self.due -= 1.0;
            self.stale = true;
            if began.elapsed() > SLICE {
                // what could not be done in time is not made up for
                self.due = self.due.min(1.0);
                break;
            }
        }
        if fastest {
            self.due = 0.0;
        }
        self.untold |= !self.playing;
    }
    /// Shows the page the moment, if it has seen the ones before.
    fn show(&mut self) {
        let unseen = self.number.wrapping_sub(self.seen);
        let Some(shown) = &mut self.shown else { return };
        let (step, t, frame) = shown.moment();
        if self.stale && unseen < UNSEEN + u32::from(self.asked) {
            (self.stale, self.asked) = (false, false);
            self.number += 1;
            let bytes = shown.frame(self.number);
            let moving = shown.obstacles_move().then(|| shown.obstacles());
            let items = shown.items().filter(|items| self.items.as_ref() != Some(items));
            let explanation = match self.focus {
                Some(agent) if self.explained != Some((step, agent)) => {
                    self.explained = Some((step, agent));
                    Some(match shown.explain(agent) {
                        Ok(explanation) => json!({ "is": "explain", "explanation": explanation }),
                        Err(error) => json!({ "is": "problem", "text": error.to_string() }),
                    })
                }
                _ => None,
            };
            self.lost |= self.page.try_send(Outgoing::Frame(bytes)).is_err();
            if let Some(moving) = moving {
                self.tell(&moving);
            }
            if let Some(items) = items {
                self.tell(&items);
                self.items = Some(items);
            }
            if let Some(explanation) = explanation {
                self.tell(&explanation);
            }
            self.measure();
        }
        if self.timed.elapsed() >= STATUS {
            self.reached = step.abs_diff(self.timed_step) as f64 / self.timed.elapsed().as_secs_f64();
            (self.timed, self.timed_step, self.untold) = (Instant::now(), step, true);
        }
        if std::mem::take(&mut self.untold) {
            self.tell(&json!({
                "is": "status", "playing": self.playing, "step": step, "t": t, "frame": frame,
                "rate": self.rate, "reached": self.reached,
            }));
        }
    }
    /// Measures the moment, where measuring does not take too large a share of the time.
    fn measure(&mut self) {
        if self.measured.elapsed().as_secs_f64() * MEASURING < self.measuring.as_secs_f64() {
            return;
        }
        let began = Instant::now();
        let metrics = self.shown.as_mut().and_then(|shown| shown.measure());
        (self.measuring, self.measured) = (began.elapsed(), Instant::now());
        if let Some(metrics) = metrics {
            self.tell(&metrics);
        }
    }
}
