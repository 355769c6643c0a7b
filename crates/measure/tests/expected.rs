//! Metrics of real tracks and of synthetic groups, against values computed with SciPy, scikit-learn, geographiclib and PedPy.
//!
//! `data/README.md` tells where the tracks come from.

use measure::{Clock, Ground, Listing, PerFrame, Rows, Sample, Tracks, metrics, over_time, per_frame};
use serde_json::Value;
use space::parallel::Workers;
use space::{Space, Vector};
use std::collections::BTreeMap;
use std::error::Error;
use std::path::Path;

type Fine = Result<(), Box<dyn Error>>;

fn text(name: &str) -> Result<String, Box<dyn Error>> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data").join(name);
    std::fs::read_to_string(&path).map_err(|error| format!("{}: {error}", path.display()).into())
}

fn json(name: &str) -> Result<Value, Box<dyn Error>> {
    Ok(serde_json::from_str(&text(name)?)?)
}

/// The rows of a table, by the names of its columns; what is no number is NaN.
fn table(text: &str) -> Vec<BTreeMap<&str, f64>> {
    let mut lines = text.lines();
    let names: Vec<&str> = lines.next().unwrap_or("").split(',').collect();
    let row = |line: &'_ str| -> Vec<f64> { line.split(',').map(|cell| cell.parse().unwrap_or(f64::NAN)).collect() };
    lines.map(|line| names.iter().copied().zip(row(line)).collect()).collect()
}

/// Tracks in the plane of a table with frame, id, x and y.
fn tracks(text: &str, rate: f64) -> Result<Tracks<2>, Box<dyn Error>> {
    let rows = table(text);
    let mut names: Vec<i64> = rows.iter().map(|row| row["id"] as i64).collect();
    names.sort_unstable();
    names.dedup();
    let mut given = Rows::<2>::default();
    for row in &rows {
        given.frame.push(row["frame"] as i64);
        given.individual.push(names.binary_search(&(row["id"] as i64)).unwrap_or(0) as u32);
        given.position[0].push(row["x"]);
        given.position[1].push(row["y"]);
    }
    let names = names.iter().map(ToString::to_string).collect();
    Ok(Tracks::new(given, names, Clock::Rate(rate), Ground::Plane(Space::open()))?)
}

/// The id of a metric by its name in the tables of expected values.
const NAMES: [(&str, &str); 19] = [
    ("pol", "polarisation"),
    ("pol_weighted", "weighted_polarisation"),
    ("mean_angular_deviation_deg", "mean_angular_deviation"),
    ("mill_signed", "signed_angular_momentum"),
    ("mill", "angular_momentum"),
    ("mean_speed", "mean_speed"),
    ("nnd_mean", "nearest_neighbour_distance"),
    ("nnd_sd", "nearest_neighbour_distance_sd"),
    ("nnd_max", "nearest_neighbour_distance_max"),
    ("mean_dist_to_centroid", "mean_distance_to_centre"),
    ("mean_pair_distance", "mean_pair_distance"),
    ("dbscan_clusters", "dbscan_clusters"),
    ("dbscan_noise", "dbscan_noise"),
    ("dbscan_largest", "dbscan_largest"),
    ("single_link_clusters", "group_count"),
    ("single_link_largest", "largest_group_size"),
    ("hull_area", "hull_area"),
    ("hull_perimeter", "hull_perimeter"),
    ("hull_vertices", "hull_vertices"),
];

/// All metrics, with this distance where groups and clusters are told by one.
fn by_distance(distance: f64) -> Vec<Box<dyn measure::Measure<2>>> {
    let mut all = metrics::all::<2>();
    for metric in &mut all {
        for parameter in metric.card().parameters {
            if ["eps", "linking_distance"].contains(&parameter.name) {
                assert_eq!(metric.set(parameter.name, distance), Ok(()));
            }
        }
    }
    all
}

/// The deviation of a value: relative beyond 1, absolute below. NaN where only one of both is a number.
fn deviation(found: f64, expected: f64) -> f64 {
    if found.is_nan() && expected.is_nan() { 0.0 } else { (found - expected).abs() / expected.abs().max(1.0) }
}

#[track_caller]
fn close(what: &str, found: f64, expected: f64, tolerance: f64) {
    assert!(deviation(found, expected) <= tolerance, "{what}: found {found}, expected {expected}");
}

/// A value of one frame of a table by its name in the expected tables; `None` for what is not a metric of frames.
fn value(measured: &PerFrame, frame: usize, name: &str) -> Option<f64> {
    match name {
        "n" => Some(f64::from(measured.positions[frame])),
        "n_vel" => Some(f64::from(measured.velocities[frame])),
        "n_moving" => Some(f64::from(measured.headings[frame])),
        // the reference has no mean speed where nobody moves
        "mean_speed" if measured.headings[frame] == 0 => Some(f64::NAN),
        _ => {
            let id = NAMES.iter().find(|(other, _)| *other == name)?.1;
            let column = metrics::LIST.iter().position(|card| card.id == id)?;
            Some(measured.values[column][frame])
        }
    }
}

/// Compares the frames of a table of expected values, which have ten digits.
fn frames_agree(tracks: &Tracks<2>, distance: f64, expected: &str) -> Fine {
    let measured = per_frame(tracks, &by_distance(distance), &Workers::new(1));
    let rows = table(expected);
    assert!(!rows.is_empty());
    for row in rows {
        let frame = tracks.frames().binary_search(&(row["frame"] as i64)).map_err(|_| "a frame is missing")?;
        for (name, &expected) in row.iter().filter(|(name, _)| **name != "frame") {
            let found = value(&measured, frame, name).ok_or_else(|| format!("no metric for {name}"))?;
            close(&format!("{name} in frame {}", row["frame"]), found, expected, 1e-9);
        }
    }
    Ok(())
}

#[test]
fn frames_of_sticklebacks_and_pedestrians() -> Fine {
    frames_agree(&tracks(&text("sticklebacks5.csv")?, 1.0)?, 80.0, &text("sticklebacks5_frames.csv")?)?;
    for name in ["pedestrians_bottleneck", "pedestrians_unidirectional"] {
        frames_agree(&tracks(&text(&format!("{name}.csv"))?, 25.0)?, 1.0, &text(&format!("{name}_frames.csv"))?)?;
    }
    Ok(())
}

/// Compares means, standard deviations and extremes over the frames from the second on that have two individuals.
fn summaries_agree(measured: &PerFrame, summary: &Value) -> Fine {
    let frames = 1..measured.positions.len();
    let frames = || frames.clone().filter(|&frame| measured.positions[frame] > 1 && measured.velocities[frame] > 0);
    let expected = summary["summary_over_all_frames"].as_object().ok_or("no summary")?;
    for (name, expected) in expected {
        let values: Vec<f64> =
            frames().filter_map(|frame| value(measured, frame, name)).filter(|value| value.is_finite()).collect();
        let n = values.len() as f64;
        let mean = values.iter().sum::<f64>() / n;
        let sd = (values.iter().map(|value| (value - mean) * (value - mean)).sum::<f64>() / (n - 1.0)).sqrt();
        let least = values.iter().copied().fold(f64::INFINITY, f64::min);
        let most = values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        for (statistic, found) in [("frames", n), ("mean", mean), ("sd", sd), ("min", least), ("max", most)] {
            let expected = expected[statistic].as_f64().ok_or(statistic)?;
            close(&format!("{statistic} of {name}"), found, expected, 1e-9);
        }
    }
    Ok(())
}

/// Compares a listing by lag in frames.
fn lags_agree(found: &Listing, expected: &Value, value: &str) -> Fine {
    let expected = expected.as_object().ok_or("no lags")?;
    assert!(!expected.is_empty());
    for (lag, expected) in expected {
        let lag: f64 = lag.parse()?;
        let row = found.columns[1].iter().position(|&frames| frames == lag).ok_or("a lag is missing")?;
        close(&format!("{value} at {lag}"), found.columns[2][row], expected[value].as_f64().ok_or(value)?, 1e-9);
        assert_eq!(Some(found.columns[3][row]), expected["pairs"].as_f64(), "pairs at {lag}");
    }
    Ok(())
}

/// Compares displacements and autocorrelations up to a lag in seconds.
fn motion_agrees(tracks: &Tracks<2>, max_lag: f64, summary: &Value) -> Fine {
    let lists = [
        ("mean_squared_displacement", "msd", "msd"),
        ("relative_mean_squared_displacement", "msd_relative_to_centroid", "msd"),
        ("heading_autocorrelation", "heading_autocorrelation", "c"),
    ];
    for (id, key, value) in lists {
        let mut metric = over_time::find::<2>(id)?;
        metric.set("max_lag", max_lag)?;
        metric.set("lags", 1e6)?;
        lags_agree(&metric.on(tracks)?, &summary[key], value)?;
    }
    Ok(())
}

#[test]
fn sticklebacks_over_time() -> Fine {
    let tracks = tracks(&text("sticklebacks5.csv")?, 1.0)?;
    let summary = json("sticklebacks5_summary.json")?;
    summaries_agree(&per_frame(&tracks, &by_distance(80.0), &Workers::new(2)), &summary)?;
    motion_agrees(&tracks, 200.0, &summary)
}

/// A group of a table with x, y, vx and vy.
fn group(text: &str) -> Sample<2> {
    let member = |row: &BTreeMap<&str, f64>| (Vector([row["x"], row["y"]]), Vector([row["vx"], row["vy"]]));
    Sample::new(Space::open(), table(text).iter().map(member))
}

#[test]
fn synthetic_groups() -> Fine {
    let all = json("synthetic_expected.json")?;
    for (name, bin) in [("s1_flock", 1.0), ("s2_mill", 2.0)] {
        let expected = &all[name];
        let sample = group(&text(&format!("{name}.csv"))?);
        let distance = expected["cluster_distance"].as_f64().ok_or("no distance")?;
        let found = by_distance(distance);
        let number = |key: &str| expected[key].as_f64().ok_or_else(|| key.to_owned());
        for (key, id) in NAMES.iter().filter(|(key, _)| expected.get(key).is_some()) {
            let metric = found.iter().find(|metric| metric.card().id == *id).ok_or(*id)?;
            close(&format!("{key} of {name}"), metric.on(&sample).unwrap_or(f64::NAN), number(key)?, 1e-9);
        }
        assert_eq!(sample.count(measure::Counted::Headings) as f64, number("n_moving")?);
        let nearest: Vec<u64> = sample.nearest_others(1).ok_or("too few")?.iter().map(|&(_, j)| u64::from(j)).collect();
        assert_eq!(serde_json::to_value(nearest)?, expected["nearest_neighbour_ids"]);
        for (threshold, clusters) in expected["single_link_clusters_by_threshold"].as_object().ok_or("none")? {
            assert_eq!(Some(sample.group_sizes(threshold.parse()?).len() as u64), clusters.as_u64(), "{threshold}");
        }
        for height in expected["single_link_merge_heights"].as_array().ok_or("none")? {
            let height = height.as_f64().ok_or("no height")?;
            let groups = |at: f64| sample.group_sizes(at).len();
            assert_eq!(groups(height * (1.0 - 1e-9)), groups(height * (1.0 + 1e-9)) + 1, "{height}");
        }
        for (key, clusters) in expected["dbscan_by_eps_minpts"].as_object().ok_or("none")? {
            let (eps, least) = key.split_once(',').ok_or("no pair")?;
            let labels = sample.dense_clusters(eps.parse()?, least.parse()?);
            let count = labels.iter().flatten().max().map_or(0, |last| last + 1);
            let noise = labels.iter().filter(|label| label.is_none()).count();
            assert_eq!(serde_json::to_value([count, noise])?, *clusters, "{key} of {name}");
        }
        correlation_agrees(&text(&format!("{name}.csv"))?, bin, &expected["velocity_correlation"])?;
    }
    Ok(())
}

/// Compares the velocity correlation of one frame whose velocities are given.
fn correlation_agrees(text: &str, bin: f64, expected: &Value) -> Fine {
    let rows = table(text);
    let column = |name: &str| rows.iter().map(|row| row[name]).collect::<Vec<f64>>();
    let given = Rows::<2> {
        frame: vec![0; rows.len()],
        individual: (0..rows.len() as u32).collect(),
        position: [column("x"), column("y")],
        velocity: Some([column("vx"), column("vy")]),
        body: None,
    };
    let names = (0..rows.len()).map(|k| k.to_string()).collect();
    let tracks = Tracks::new(given, names, Clock::Rate(1.0), Ground::Plane(Space::open()))?;
    let mut metric = over_time::find::<2>("velocity_correlation")?;
    metric.set("bin_width", bin)?;
    let found = metric.on(&tracks)?;
    for expected in expected["bins"].as_array().ok_or("no bins")? {
        let low = expected["r_lo"].as_f64().ok_or("r_lo")?;
        let row = found.columns[0].iter().position(|&r| (r - low).abs() < 1e-9).ok_or("a bin is missing")?;
        close(&format!("C({low})"), found.columns[2][row], expected["c"].as_f64().ok_or("c")?, 1e-9);
        assert_eq!(Some(found.columns[3][row]), expected["pairs"].as_f64());
    }
    Ok(())
}

/// Tracks of GPS fixes: the first fix of an animal in a second counts. Frames are numbered by the order of seconds.
fn fixes(text: &str) -> Result<(Tracks<2>, Vec<String>), Box<dyn Error>> {
    let cells: Vec<Vec<&str>> = text.lines().skip(1).map(|line| line.split(',').collect()).collect();
    let mut seconds: Vec<&str> = cells.iter().map(|row| row[1]).collect();
    seconds.sort_unstable();
    seconds.dedup();
    let mut names: Vec<&str> = cells.iter().map(|row| row[0]).collect();
    names.sort_unstable();
    names.dedup();
    let mut given = Rows::<2>::default();
    let mut taken = std::collections::BTreeSet::new();
    for row in &cells {
        let frame = seconds.binary_search(&row[1]).unwrap_or(0) as i64;
        let individual = names.binary_search(&row[0]).unwrap_or(0) as u32;
        let place = (row[3].parse(), row[4].parse());
        if let (Ok(longitude), Ok(latitude)) = place
            && taken.insert((frame, individual))
        {
            given.frame.push(frame);
            given.individual.push(individual);
            given.position[0].push(longitude);
            given.position[1].push(latitude);
        }
    }
    let names = names.iter().map(|&name| name.to_owned()).collect();
    let tracks = Tracks::new(given, names, Clock::Rate(1.0), Ground::Globe)?;
    Ok((tracks, seconds.iter().map(|&second| second.to_owned()).collect()))
}

#[test]
fn baboons_on_the_globe() -> Fine {
    let (tracks, seconds) = fixes(&text("baboons.csv")?)?;
    let expected = json("baboons_summary.json")?;
    let metrics = by_distance(10.0);
    for (second, expected) in expected["baboons"]["frames"].as_object().ok_or("no frames")? {
        let frame = seconds.iter().position(|other| other == second).ok_or("a second is missing")?;
        let frame = tracks.frames().binary_search(&(frame as i64)).map_err(|_| "a frame is missing")?;
        let sample = tracks.sample(frame);
        let found = |id: &str| {
            let metric = metrics.iter().find(|metric| metric.card().id == id);
            metric.and_then(|metric| metric.on(&sample)).unwrap_or(f64::NAN)
        };
        assert_eq!(Some(sample.len() as u64), expected["n"].as_u64());
        let lengths = [
            ("nnd_mean_m", "nearest_neighbour_distance"),
            ("nnd_sd_m", "nearest_neighbour_distance_sd"),
            ("max_pair_distance_m", "max_pair_distance"),
            ("mean_pair_distance_m", "mean_pair_distance"),
            ("hull_area_geodesic_m2", "hull_area"),
            ("hull_perimeter_geodesic_m", "hull_perimeter"),
            ("dbscan_clusters", "dbscan_clusters"),
            ("dbscan_noise", "dbscan_noise"),
            ("single_link_clusters", "group_count"),
        ];
        for (name, id) in lengths {
            let expected = expected[name].as_f64().ok_or(name)?;
            close(&format!("{name} at {second}"), found(id), expected, 1e-6);
        }
        let plane = sample.hull().ok_or("no hull")?.area;
        close("hull in the local plane", plane, expected["hull_area_local_plane_m2"].as_f64().ok_or("none")?, 1e-4);
    }
    Ok(())
}

/// A metric over time with these parameters.
fn over(tracks: &Tracks<2>, id: &str, parameters: &[(&str, f64)]) -> Result<Listing, Box<dyn Error>> {
    let mut metric = over_time::find::<2>(id)?;
    for &(name, value) in parameters {
        metric.set(name, value)?;
    }
    Ok(metric.on(tracks)?)
}

#[test]
fn people_through_a_door_as_pedpy_counts_them() -> Fine {
    let expected = json("pedestrians_pedpy.json")?;
    let tracks = tracks(&text("pedestrians_bottleneck_line.csv")?, 25.0)?;
    let door = [("x1", -0.4), ("y1", 0.0), ("x2", 0.4), ("y2", 0.0)];
    let crossings = over(&tracks, "line_crossings", &door)?;
    let frames = expected["crossing_frame_by_id"].as_object().ok_or("no crossings")?;
    assert_eq!(crossings.len(), frames.len());
    for (name, frame) in frames {
        let individual = tracks.names().iter().position(|other| other == name).ok_or("nobody")?;
        let row = crossings.columns[0].iter().position(|&other| other == individual as f64).ok_or("no crossing")?;
        assert_eq!(Some(crossings.columns[1][row]), frame.as_f64(), "{name}");
    }
    let flow = over(&tracks, "flow", &[door.as_slice(), &[("window", 4.0), ("speed_frames", 5.0)]].concat())?;
    close("flow of all", flow.columns[3][0], expected["mean_flow"].as_f64().ok_or("no flow")?, 1e-9);
    for (k, window) in expected["windows"].as_array().ok_or("no windows")?.iter().enumerate() {
        let number = |key: &str| window[key].as_f64().ok_or_else(|| key.to_owned());
        close(&format!("flow in window {k}"), flow.columns[3][k + 1], number("flow")?, 1e-9);
        close(&format!("speed in window {k}"), flow.columns[5][k + 1], number("mean_speed")?, 1e-9);
    }
    Ok(())
}

#[test]
fn people_before_a_door_as_pedpy_counts_them() -> Fine {
    let expected = json("pedestrians_pedpy.json")?;
    let tracks = tracks(&text("pedestrians_bottleneck_area.csv")?, 25.0)?;
    let area = [("x1", -0.4), ("y1", 0.5), ("x2", 0.4), ("y2", 1.3)];
    // the wall with the door is at y = 0
    let floor = over(&tracks, "voronoi_density", &[area.as_slice(), &[("floor_y1", 0.0)]].concat())?;
    let open = over(&tracks, "voronoi_density", &area)?;
    let classic = over(&tracks, "classic_density", &area)?;
    for (row, &frame) in tracks.frames().iter().enumerate() {
        let number = |key: &str| expected[key][frame.to_string()].as_f64();
        close("Voronoi density", floor.columns[2][row], number("voronoi_density").ok_or("none")?, 1e-9);
        if let Some(number) = number("classic_density") {
            close("classic density", classic.columns[2][row], number, 1e-9);
        }
    }
    // one cell reaches the wall in the first frame, and none in the others
    assert!(deviation(open.columns[2][0], floor.columns[2][0]) > 1e-6);
    close("Voronoi density without the wall", open.columns[2][1], floor.columns[2][1], 1e-9);
    for (name, speed) in expected["speeds_at_500"].as_object().ok_or("no speeds")? {
        let individual = tracks.names().iter().position(|other| other == name).ok_or("nobody")?;
        let place = tracks.position(tracks.row(1, individual as u32).ok_or("not there")?).0;
        let around =
            [("x1", place[0] - 0.01), ("y1", place[1] - 0.01), ("x2", place[0] + 0.01), ("y2", place[1] + 0.01)];
        // every fifth frame is in the table
        let found = over(&tracks, "speed_in_area", &[around.as_slice(), &[("speed_frames", 1.0)]].concat())?;
        close(&format!("speed of {name}"), found.columns[2][1], speed.as_f64().ok_or("none")?, 1e-9);
    }
    Ok(())
}
