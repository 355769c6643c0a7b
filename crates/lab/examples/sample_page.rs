//! Writes a sample page: `cargo run -p lab --example sample_page -- OUT.html`.
//!
//! Three groups circle in space among obstacles; one flock moves in a periodic plane. Nothing is simulated: the paths are
//! closed forms, so that the tests of the page know what it must show. With `strange` as the second argument: a page of
//! everything that can be wrong with what is to be shown.

use lab::report::{
    Axis, Border, Fact, Figure, Line, Lines, Moment, Outline, Page, Replay, Scenes, Seen, Stage, Table, html,
};
use std::f64::consts::TAU;
use std::process::ExitCode;

/// Members of each group in space.
const SCHOOLS: [usize; 3] = [60, 40, 20];
/// Members of the flock in the plane.
const FLOCK: usize = 150;
/// Frames of a recording.
const FRAMES: usize = 240;
/// Time between two frames, s.
const TIME_STEP: f64 = 0.25;

fn main() -> ExitCode {
    let Some(file) = std::env::args().nth(1) else { return ExitCode::from(2) };
    let page = match std::env::args().nth(2).as_deref() {
        None | Some("sample") => page(),
        Some("strange") => strange(),
        Some(_) => return ExitCode::from(2),
    };
    match std::fs::write(file, html(&page)) {
        Ok(()) => ExitCode::SUCCESS,
        Err(_) => ExitCode::from(70),
    }
}

/// A share between 0 and 1 that looks random and is always the same.
fn share(index: usize, slot: usize) -> f64 {
    let mixed = (index as f64 * 12.9898 + slot as f64 * 78.233).sin() * 43_758.545_3;
    mixed - mixed.floor()
}

/// Where a member of a school is, and its heading.
fn swimmer(index: usize, time: f64) -> (usize, [f64; 3], [f64; 3]) {
    let group = if index < SCHOOLS[0] { 0 } else { usize::from(index >= SCHOOLS[0] + SCHOOLS[1]) + 1 };
    let rate = [0.35, -0.28, 0.5][group];
    let angle = rate * time + 0.9 * share(index, 0) * TAU * if group == 2 { 0.12 } else { 1.0 };
    let radius = [14.0, 9.0, 17.0][group] + 3.0 * share(index, 1);
    let centre = [[20.0, 18.0, 9.0], [26.0, 22.0, 15.0], [20.0, 20.0, 5.0]][group];
    let (lift, beat) = (2.5 * share(index, 2) + 0.5, rate * 2.0);
    let phase = share(index, 3) * TAU;
    let position = [
        centre[0] + radius * angle.cos(),
        centre[1] + radius * angle.sin(),
        centre[2] + lift * (beat * time + phase).sin(),
    ];
    let velocity =
        [-radius * rate * angle.sin(), radius * rate * angle.cos(), lift * beat * (beat * time + phase).cos()];
    (group, position, unit(velocity))
}

/// Where a bird is in the periodic plane, and its heading.
fn bird(index: usize, time: f64) -> ([f64; 3], [f64; 3]) {
    // every bird begins with a heading of its own and takes on the common one
    let own = share(index, 6) * TAU;
    let (left, spent) = ((-time / 8.0).exp(), 8.0 * (1.0 - (-time / 8.0).exp()));
    let velocity = [1.1 + 2.0 * own.cos() * left, 0.5 * (time / 9.0).cos() + 2.0 * own.sin() * left, 0.0];
    let travelled = [1.1 * time + 2.0 * own.cos() * spent, 4.5 * (time / 9.0).sin() + 2.0 * own.sin() * spent];
    let wrapped = |axis: usize| (25.0 * share(index, 4 + axis) + travelled[axis]).rem_euclid(25.0);
    ([wrapped(0), wrapped(1), 0.0], unit(velocity))
}

fn unit(vector: [f64; 3]) -> [f64; 3] {
    let length = vector.iter().map(|value| value * value).sum::<f64>().sqrt();
    if length > 0.0 { vector.map(|value| value / length) } else { [0.0; 3] }
}

fn tank() -> Stage {
    Stage {
        dimensions: 3,
        low: [0.0; 3],
        high: [40.0, 40.0, 20.0],
        edges: [Border::Wall; 3],
        unit: "m".into(),
        groups: vec!["herring".into(), "sprat".into(), "mackerel".into()],
        radius: vec![0.4, 0.3, 0.55],
    }
}

fn plane() -> Stage {
    Stage {
        dimensions: 2,
        low: [0.0; 3],
        high: [25.0, 25.0, 0.0],
        edges: [Border::Seam; 3],
        unit: "m".into(),
        groups: vec!["starling".into()],
        radius: vec![0.0],
    }
}

fn rocks() -> Vec<Outline> {
    vec![
        Outline::Ball { centre: [20.0, 19.0, 4.0], radius: 4.0 },
        Outline::Ball { centre: [8.0, 33.0, 3.0], radius: 3.0 },
        Outline::Cuboid { low: [31.0, 5.0, 0.0], high: [36.0, 10.0, 12.0] },
    ]
}

fn time(frame: usize) -> f64 {
    frame as f64 * TIME_STEP
}

fn single(place: [f64; 3]) -> [f32; 3] {
    place.map(|value| value as f32)
}

fn replays() -> Vec<Figure> {
    let swimmers: usize = SCHOOLS.iter().sum();
    let frames = || (0..FRAMES).map(time);
    let in_tank = Replay {
        title: "Three schools in a tank with rocks".into(),
        about: "Each school circles at its own depth; the mackerel keep together and hunt the others.".into(),
        stage: tank(),
        time_unit: "s".into(),
        times: frames().collect(),
        group: (0..swimmers).map(|index| swimmer(index, 0.0).0).collect(),
        position: frames().map(|time| (0..swimmers).map(|index| single(swimmer(index, time).1)).collect()).collect(),
        heading: frames().map(|time| (0..swimmers).map(|index| single(swimmer(index, time).2)).collect()).collect(),
        obstacles: vec![rocks()],
    };
    let in_plane = Replay {
        title: "A flock in a periodic plane".into(),
        about: "Whoever leaves on one side comes back on the other; trails end at the seam.".into(),
        stage: plane(),
        time_unit: "s".into(),
        times: frames().collect(),
        group: vec![0; FLOCK],
        position: frames().map(|time| (0..FLOCK).map(|index| single(bird(index, time).0)).collect()).collect(),
        heading: frames().map(|time| (0..FLOCK).map(|index| single(bird(index, time).1)).collect()).collect(),
        obstacles: vec![],
    };
    vec![Figure::Replay(in_tank), Figure::Replay(in_plane)]
}

/// The values of a chart: `[lines][points]`, missing where the line has a gap.
fn chart(
    id: &str,
    title: &str,
    about: &str,
    y: Axis,
    names: &[&str],
    value: &dyn Fn(usize, f64) -> Option<f64>,
) -> Figure {
    let times: Vec<f64> = (0..=1200).map(|point| f64::from(point) * 0.05).collect();
    let line = |(index, name): (usize, &&str)| Line {
        name: (*name).into(),
        x: times.clone(),
        y: times.iter().map(|&time| value(index, time)).collect(),
    };
    Figure::Lines(Lines {
        id: id.into(),
        title: title.into(),
        about: about.into(),
        x: Axis { label: "Time".into(), unit: "s".into(), range: None },
        y,
        lines: names.iter().enumerate().map(line).collect(),
    })
}

fn axis(label: &str, unit: &str, range: Option<(f64, f64)>) -> Axis {
    Axis { label: label.into(), unit: unit.into(), range }
}

fn charts() -> Vec<Figure> {
    let names = ["herring", "sprat", "mackerel"];
    let noise = |index: usize, time: f64| 0.04 * (7.3 * time + index as f64).sin() * (1.7 * time).cos();
    vec![
        chart(
            "polarisation",
            "Polarisation",
            "1 where all head the same way. Sprat were not counted from 20 to 26 s.",
            axis("Polarisation", "1", Some((0.0, 1.0))),
            &names,
            &|index, time| {
                let settled = 0.55 + 0.15 * index as f64;
                let gap = index == 1 && (20.0..26.0).contains(&time);
                (!gap)
                    .then_some(settled * (1.0 - (-time / (4.0 + 3.0 * index as f64)).exp()) + noise(index, time) + 0.05)
            },
        ),
        chart(
            "distance",
            "Nearest neighbour",
            "Mean distance to the nearest neighbour of the same group.",
            axis("Distance", "m", None),
            &names,
            &|index, time| Some(1.2 + 0.5 * index as f64 + 1.5 * (-time / 9.0).exp() + 3.0 * noise(index + 2, time)),
        ),
        chart(
            "speed",
            "Mean speed",
            "Over all members of a group.",
            axis("Speed", "m/s", None),
            &names,
            &|index, time| Some([5.1, 2.6, 9.0][index] + 2.0 * noise(index, time)),
        ),
        chart(
            "momentum",
            "Angular momentum",
            "About the centre of all; negative is clockwise.",
            axis("Angular momentum", "1", Some((-1.0, 1.0))),
            &["all"],
            &|_, time| Some((time / 8.0).sin() * 0.8 + noise(3, time)),
        ),
        chart(
            "contacts",
            "Contacts with rocks",
            "Since the start.",
            axis("Contacts", "1", None),
            &["all"],
            &|_, time| Some((time / 3.0).floor()),
        ),
        chart(
            "dissipation",
            "Dissipated power",
            "Per member, from the drag of the water.",
            axis("Power", "W", None),
            &["herring", "a species with quite a long name"],
            &|index, time| Some(1e-5 * (2.0 + index as f64 + 10.0 * noise(index, time))),
        ),
    ]
}

fn scenes() -> Vec<Figure> {
    let trail =
        |at: &dyn Fn(f64) -> [f64; 3], now: f64| (1..=16).rev().map(|back| at(now - 0.15 * f64::from(back))).collect();
    let in_tank = |now: f64| Moment {
        time: now,
        agents: (0..SCHOOLS.iter().sum())
            .map(|index| {
                let (group, position, heading) = swimmer(index, now);
                Seen { group, position, heading, trail: trail(&|time| swimmer(index, time).1, now) }
            })
            .collect(),
        items: (0..12)
            .map(|item| [4.0 + 30.0 * share(item, 8), 4.0 + 30.0 * share(item, 9), 18.0 * share(item, 10)])
            .collect(),
        obstacles: rocks(),
    };
    let in_plane = |now: f64| Moment {
        time: now,
        agents: (0..FLOCK)
            .map(|index| {
                let (position, heading) = bird(index, now);
                Seen { group: 0, position, heading, trail: trail(&|time| bird(index, time).0, now) }
            })
            .collect(),
        items: vec![],
        obstacles: vec![],
    };
    vec![
        Figure::Scenes(Scenes {
            title: "The tank at two moments".into(),
            about: "From above, from the front and from the side, all at one scale.".into(),
            stage: tank(),
            time_unit: "s".into(),
            moments: [10.0, 50.0].map(in_tank).to_vec(),
        }),
        Figure::Scenes(Scenes {
            title: "The flock at three moments".into(),
            about: "Dashed lines are seams: the plane closes on itself.".into(),
            stage: plane(),
            time_unit: "s".into(),
            moments: [0.0, 15.0, 59.75].map(in_plane).to_vec(),
        }),
    ]
}

fn page() -> Page {
    let fact = |label: &str, value: &str| Fact { label: label.into(), value: value.into() };
    let csv: String = (0..=1200).fold("time,group,polarisation\n".into(), |mut csv: String, point| {
        csv.push_str(&format!("{},herring,{}\n", point as f64 * 0.05, share(point, 12)));
        csv
    });
    let mut figures = replays();
    figures.extend(charts());
    figures.extend(scenes());
    Page {
        title: "Three schools among rocks, and a flock that closes on itself".into(),
        lead: vec![
            "A sample page: every kind of figure that a report can hold, drawn from closed forms. Three schools of fish \
             circle in a tank; a flock of starlings finds a common heading in a periodic plane."
                .into(),
            "Look for the order that sets in within the first ten seconds, and for the sprat, which turn the other way."
                .into(),
        ],
        methods: vec![
            "Members of a school move on circles of 9 m to 20 m radius with a vertical beat. Positions were recorded every \
             0.25 s and measures computed every 0.05 s. Nothing was drawn at random: the apparent disorder is a fixed \
             function of a member\u{2019}s number."
                .into(),
        ],
        summary: vec![
            fact("Members", "120 fish, 150 birds"),
            fact("Duration", "60\u{202f}s"),
            fact("Time step", "0.05\u{202f}s"),
            fact("Final polarisation, herring", "0.601"),
            fact("Final polarisation, mackerel", "0.897"),
            fact("Contacts with rocks", "20"),
            fact("Seed", "2026"),
        ],
        figures,
        tables: vec![
            Table {
                file: "metrics.csv".into(),
                about: "Measures by time and group, in long form.".into(),
                csv,
            },
            Table {
                file: "events.csv".into(),
                about: "What happened, and when.".into(),
                csv: "time,event\n3.0,\"contact, rock 1\"\n6.0,\"said \"\"hello\"\"\"\n".into(),
            },
        ],
        command: "flockworks run three_schools.toml --seed 2026 --threads 2".into(),
        source: "kind = \"scenario\"\ntitle = \"Three schools among rocks\"\nseed = 2026\n\n[time]\nstep = 0.05\nend = 60\n\n\
                 [space]\nsize = [40, 40, 20]  # m\nboundary = \"walls\"\n\n[group.herring]\ncount = 60\nbody = { radius = 0.4 }\n"
            .into(),
        made_by: "Made by flockworks 0.1.0, seed 2026".into(),
    }
}

/// Everything that can be wrong with what is to be shown.
fn strange() -> Page {
    let hostile = "</script><script>globalThis.escaped=1</script><img src=x onerror=globalThis.escaped=1>\u{1f41f}";
    let unbroken = "a-name-without-any-place-to-break-it-".repeat(6);
    let line = |name: &str, x: &[f64], y: &[Option<f64>]| Line { name: name.into(), x: x.to_vec(), y: y.to_vec() };
    let lines = |id: &str, lines: Vec<Line>| {
        let axis = || axis(hostile, "1", Some((f64::NAN, 1.0)));
        Figure::Lines(Lines { id: id.into(), title: id.into(), about: hostile.into(), x: axis(), y: axis(), lines })
    };
    let stage = |dimensions: usize, high: [f64; 3], edges: Border| Stage {
        dimensions,
        low: [0.0; 3],
        high,
        edges: [edges; 3],
        unit: "1".into(),
        groups: vec![hostile.into()],
        radius: vec![f64::NAN],
    };
    let rod = Outline::Segment { from: [1.0; 3], to: [4.0, 2.0, 0.0] };
    let shapes = vec![
        Outline::Cuboid { low: [1.0; 3], high: [2.0; 3] },
        Outline::Ball { centre: [f64::NAN; 3], radius: 1.0 },
        Outline::Polygon(vec![[5.0, 5.0, 0.0], [7.0, 5.0, 0.0], [6.0, 8.0, 0.0]]),
        Outline::Polygon(vec![]),
        rod,
    ];
    let replay = |title: &str, stage: Stage, times: Vec<f64>, agents: usize| {
        let place = |frame: usize, agent: usize| match (frame + agent) % 5 {
            4 => [f32::NAN; 3],
            place => [place as f32 * 2.0, agent as f32, 0.5],
        };
        let heading = |agent: usize| if agent.is_multiple_of(2) { [0.0; 3] } else { [0.0, 0.6, 0.8] };
        let frames = 0..times.len();
        Figure::Replay(Replay {
            title: title.into(),
            about: String::new(),
            stage,
            time_unit: String::new(),
            group: (0..agents).map(|agent| agent % 9).collect(),
            position: frames.clone().map(|frame| (0..agents).map(|agent| place(frame, agent)).collect()).collect(),
            heading: frames.clone().map(|_| (0..agents).map(heading).collect()).collect(),
            obstacles: frames.map(|_| shapes.clone()).collect(),
            times,
        })
    };
    let scenes = |title: &str, stage: Stage| {
        let agent = |index: usize| Seen {
            group: index,
            position: [index as f64, 2.0, if index == 3 { f64::NAN } else { 0.5 }],
            heading: [0.0, 1.0, 0.0],
            trail: vec![[f64::NAN; 3], [0.0; 3]],
        };
        let full = Moment {
            time: -1.5e-7,
            agents: (0..9).map(agent).collect(),
            items: vec![[f64::INFINITY; 3], [1.0; 3]],
            obstacles: shapes.clone(),
        };
        let empty = Moment { time: f64::NAN, agents: vec![], items: vec![], obstacles: vec![] };
        Figure::Scenes(Scenes {
            title: title.into(),
            about: String::new(),
            stage,
            time_unit: "1".into(),
            moments: vec![full, empty],
        })
    };
    let names: Vec<String> = (0..23).map(|index| format!("line {index}")).collect();
    let many =
        names.iter().enumerate().map(|(i, name)| line(name, &[0.0, 1.0], &[Some(i as f64), Some(2.0 * i as f64)]));
    Page {
        title: hostile.into(),
        lead: vec![unbroken.clone()],
        methods: vec![hostile.into()],
        summary: vec![Fact { label: unbroken.clone(), value: unbroken.clone() }],
        figures: vec![
            replay("No frames", stage(2, [10.0; 3], Border::Wall), vec![], 3),
            replay("No agents", stage(3, [10.0; 3], Border::Seam), vec![0.0, 1.0], 0),
            replay("A line", stage(1, [10.0, 0.0, 0.0], Border::Wall), vec![0.0, 1.0, 2.0], 7),
            replay("No extent", stage(3, [0.0; 3], Border::Wall), vec![0.0, f64::NAN], 7),
            replay("A plane with obstacles that move", stage(2, [10.0, 5.0, 0.0], Border::Open), vec![1.0, 1.0], 12),
            lines("none", vec![]),
            lines("empty", vec![line("a", &[], &[])]),
            lines("one", vec![line("a", &[1.0], &[Some(1.0)])]),
            lines("missing", vec![line("a", &[1.0, 2.0], &[None, None])]),
            lines("equal", vec![line(&unbroken, &[1.0, 2.0], &[Some(3.0), Some(3.0)]), line(hostile, &[1.0], &[None])]),
            lines("huge", vec![line("a", &[0.0, 1.0, 2.0], &[Some(-f64::MAX), Some(f64::MAX), Some(f64::NAN)])]),
            lines(
                "apart",
                vec![line("a", &[0.0, 1.0], &[Some(1.0), Some(2.0)]), line("b", &[0.3, 0.6], &[Some(2.0), None])],
            ),
            lines("nowhere", vec![line("a", &[f64::NAN, f64::INFINITY], &[Some(1.0), Some(2.0)])]),
            lines("many", many.collect()),
            scenes("A line", stage(1, [10.0, 0.0, 0.0], Border::Seam)),
            scenes("No extent", stage(2, [0.0; 3], Border::Wall)),
            scenes("A corridor", stage(2, [100.0, 1.0, 0.0], Border::Wall)),
            scenes("A shaft", stage(3, [1.0, 1.0, 200.0], Border::Seam)),
        ],
        tables: vec![Table { file: hostile.into(), about: unbroken.clone(), csv: String::new() }],
        command: unbroken.repeat(3),
        source: hostile.into(),
        made_by: unbroken,
    }
}
