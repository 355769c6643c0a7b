//! Tables as their producers write them, tables that leave something open, and things that are no tables.

use super::*;

/// A file of this test's own.
fn file(name: &str, bytes: &[u8]) -> PathBuf {
    let folder = std::env::temp_dir().join(format!("flockworks-tracks-{}", std::process::id()));
    std::fs::create_dir_all(&folder).unwrap();
    let path = folder.join(name);
    std::fs::create_dir_all(path.parent().unwrap()).unwrap();
    std::fs::write(&path, bytes).unwrap();
    path
}

fn ask(columns: &[(&str, &str)]) -> Ask {
    let columns = columns.iter().map(|&(role, name)| (role.to_owned(), name.to_owned())).collect();
    Ask { columns, ..Ask::default() }
}

fn at(fps: f64) -> Ask {
    Ask { fps: Some(Rate::Known(fps)), ..Ask::default() }
}

fn plane(recording: &Recording) -> &Tracks<2> {
    match &recording.table {
        Table::Plane(tracks) => tracks,
        Table::Space(_) => panic!("expected tracks in the plane"),
    }
}

fn reads(name: &str, text: &str, ask: &Ask) -> Recording {
    read(&file(name, text.as_bytes()), None, ask).unwrap_or_else(|error| panic!("{name}: {error}"))
}

fn refuses(name: &str, text: &[u8], ask: &Ask) -> String {
    let error = read(&file(name, text), None, ask).map(|recording| recording.understood).unwrap_err().to_string();
    assert!(error.contains(name), "the file is named: {error}");
    error
}

/// The place of an individual in a frame by their names.
fn place(recording: &Recording, frame: i64, name: &str) -> [f64; 2] {
    let tracks = plane(recording);
    let at = tracks.frames().iter().position(|&number| number == frame).unwrap();
    let who = tracks.names().iter().position(|other| other == name).unwrap();
    tracks.position(tracks.row(at, who as u32).unwrap()).0
}

#[test]
fn a_long_table_in_every_dress() {
    let rows = [(0, "b", 1.5, 2.0), (0, "a", 3.0, 4.0), (1, "b", 1.75, 2.0), (1, "a", 3.0, 4.5)];
    let dressed = |mark: &str, header: &str, comma: bool| {
        let number = |value: f64| if comma { value.to_string().replace('.', ",") } else { value.to_string() };
        let mut text = header.replace(',', mark) + "\n";
        for (frame, id, x, y) in rows {
            text += &[frame.to_string(), id.to_owned(), number(x), number(y)].join(mark);
            text += "\r\n";
        }
        text
    };
    let header = "frame,id,x,y";
    for (name, text, ask) in [
        ("commas.csv", dressed(",", header, false), at(2.0)),
        ("tabs.tsv", dressed("\t", header, false), at(2.0)),
        ("semicolons.csv", dressed(";", header, true), at(2.0)),
        ("blanks.txt", dressed("   ", header, false), at(2.0)),
        ("mark.csv", format!("\u{feff}{}", dressed(",", "Frame_Idx,Animal ID,pos_x,Y (cm)", false)), at(2.0)),
        ("comments.csv", format!("# fps: 2\n# units: cm\n\n{}", dressed(",", header, false)), Ask::default()),
        (
            "asked.csv",
            dressed(",", "a,b,c,d", false),
            Ask { fps: Some(Rate::Known(2.0)), ..ask(&[("frame", "a"), ("id", "b"), ("x", "3"), ("y", "d")]) },
        ),
        ("quoted.csv", dressed(",", header, false).replace(",b,", ",\"b\",").replace(",a,", ",\"a\","), at(2.0)),
    ] {
        let recording = reads(name, &text, &ask);
        assert_eq!(recording.understood.layout, "long", "{name}");
        assert_eq!(plane(&recording).names(), ["b", "a"], "{name}");
        assert_eq!(place(&recording, 1, "b"), [1.75, 2.0], "{name}");
        assert_eq!(plane(&recording).times(), [0.0, 0.5], "{name}");
        assert_eq!(recording.understood.rate, Some(2.0), "{name}");
    }
    let scaled = Ask { scale: 0.5, units: Some("cm".into()), ..at(2.0) };
    let recording = reads("scaled.csv", &dressed(",", header, false), &scaled);
    assert_eq!((place(&recording, 0, "a"), recording.understood.unit.as_str()), ([1.5, 2.0], "cm"));
}

#[test]
fn three_coordinates_are_three() {
    let recording = reads("space.csv", "t,id,x,y,z\n0,1,1,2,3\n0.5,1,2,2,3\n", &Ask::default());
    let Table::Space(tracks) = &recording.table else { panic!("expected tracks in space") };
    assert_eq!(tracks.velocity(1).unwrap().0, [2.0, 0.0, 0.0]);
}

#[test]
fn wide_tables_with_names_and_without() {
    let named = reads("wide.csv", "frame,fish1_x,fish1_y,fish2_x,fish2_y\n0,1,2,3,4\n1,1,3,,\n", &at(1.0));
    assert_eq!((named.understood.layout.as_str(), plane(&named).names().len()), ("wide", 2));
    assert_eq!(place(&named, 0, "fish2"), [3.0, 4.0]);
    assert_eq!((named.understood.positions, named.understood.missing), (3, 0.25));
    let nameless = reads("nameless.csv", "0,1,2,3,4\n1,5,6,7,8\n2,5,6,NA,NaN\n", &at(1.0));
    assert_eq!(place(&nameless, 1, "2"), [7.0, 8.0]);
    let six = "0,1,2,3,4,5,6\n1,1,2,3,4,5,6\n";
    let open = refuses("six.csv", six.as_bytes(), &at(1.0));
    assert!(open.contains("3 individuals in the plane or 2 in space") && open.contains("wide=xy"), "{open}");
    let told = Ask { fps: Some(Rate::Known(1.0)), ..ask(&[("wide", "xy")]) };
    assert_eq!(plane(&reads("six.csv", six, &told)).names(), ["1", "2", "3"]);
}

#[test]
fn pedestrian_text_states_rate_and_unit() {
    let text = "# PeTrack project: a.pet\n# framerate: 25 fps\n# id frame x/m y/m z/m\n1\t0\t2.5\t3\t1.76\n1\t1\t2.6\t3\t1.76\n";
    let recording = reads("petrack.txt", text, &Ask::default());
    let understood = &recording.understood;
    assert_eq!(
        (understood.layout.as_str(), understood.rate, understood.unit.as_str()),
        ("pedestrian", Some(25.0), "m")
    );
    assert!(understood.notes[0].contains("z is the height"));
    let solid = read(&recording.path, None, &ask(&[("z", "z/m")])).unwrap();
    assert!(matches!(solid.table, Table::Space(_)));
    let old = "#framerate: 8.00\n#ID\tFR\tX\tY\tZ\tA\tB\tANGLE\tCOLOR\n7\t3\t1.5\t2\t0\t0.2\t0.2\t0\t200\n\
               7\t4\t1.6\t2\t0\t0.2\t0.2\t0\t200\n";
    let recording = reads("jpscore.txt", old, &Ask::default());
    assert_eq!((recording.understood.layout.as_str(), recording.understood.rate), ("pedestrian", Some(8.0)));
    let blanks = "#framerate: 16\n#ID frame x/cm y/cm z/cm\n7 3  10.5 20 170\n7 4 11 20 170\n";
    let recording = reads("jupedsim.txt", blanks, &Ask::default());
    assert_eq!((recording.understood.unit.as_str(), place(&recording, 4, "7")), ("cm", [11.0, 20.0]));
}

#[test]
fn idtracker_with_its_attributes() {
    file("idtracker/attributes.json", br#"{"version":"6.0.0","frames_per_second":28,"length_unit":null}"#);
    let text = "seconds,x1,y1,x2,y2\n0.000,10.1,20.2,30.3,40.4\n0.036,10.2,20.2,nan,nan\n0.071,10.3,20.2,30.5,40.4\n";
    let recording = reads("idtracker/trajectories.csv", text, &Ask::default());
    let understood = &recording.understood;
    assert_eq!((understood.layout.as_str(), understood.unit.as_str(), understood.individuals), ("idtracker", "px", 2));
    assert!((understood.rate.unwrap() - 28.0).abs() < 1e-9, "{understood:?}");
    assert_eq!(understood.positions, 5);
    let tidy = "frame,time,individual,x,y,probability\n0,0.0,1,10.1,20.2,1.0\n1,0.04,1,10.4,20.2,0.9\n2,0.08,1,10.4,20.2,0.9\n";
    let recording = reads("idtracker/trajectories_tidy.csv", tidy, &Ask::default());
    assert_eq!((recording.understood.layout.as_str(), recording.understood.rate), ("idtracker", Some(25.0)));
    assert_eq!(recording.understood.unit, "px");
    // where it knew no rate, it counts frames for seconds, or leaves times out
    let counted = tidy.replace("1,0.04", "1,1").replace("2,0.08", "2,2").replace("0,0.0,", "0,0,");
    assert!(refuses("counted/tidy.csv", counted.as_bytes(), &Ask::default()).contains("--fps F"));
    file("unknown/attributes_tidy.json", br#"{"version":"6.0.0","frames_per_second":null}"#);
    assert!(refuses("unknown/tidy.csv", tidy.as_bytes(), &Ask::default()).contains("--fps F"));
    assert_eq!(reads("unknown/tidy.csv", tidy, &at(28.0)).understood.rate, Some(28.0));
    // times and places side by side may be anybody's: nothing says px
    let anybody = text.replace("seconds", "time");
    let understood = reads("anybody/tracks.csv", &anybody, &Ask::default()).understood;
    assert_eq!((understood.layout.as_str(), understood.unit.as_str()), ("wide", "unit"));
}

#[test]
fn trex_has_a_file_for_each_individual() {
    let header = "frame,time,X#wcentroid (cm),Y#wcentroid (cm),SPEED#wcentroid (cm/s),missing";
    let of = |x: f64| format!("{header}\n0,0,{x},2,1.5,0\n1,0.04,inf,inf,inf,1\n2,0.08,{x},2.5,1.5,0\n");
    for (number, x) in [(0, 1.0), (2, 3.0), (10, 5.0)] {
        file(&format!("trex/video_fish{number}.csv"), of(x).as_bytes());
    }
    let folder = file("trex/notes.txt", b"-").with_file_name("");
    let recording = read(&folder, Some("trex"), &Ask::default()).unwrap();
    let understood = &recording.understood;
    assert_eq!((understood.layout.as_str(), understood.unit.as_str(), understood.rate), ("trex", "cm", Some(25.0)));
    assert_eq!(plane(&recording).names(), ["0", "2", "10"]);
    assert_eq!((place(&recording, 2, "10"), understood.frames, understood.positions), ([5.0, 2.5], 3, 6));
    let without = refuses("t_fish0.csv", b"frame,SPEED#wcentroid (cm/s),X#wcentroid (cm)\n0,1,2\n", &Ask::default());
    assert!(without.contains("without x and y"), "{without}");
}

#[test]
fn deeplabcut_has_body_parts() {
    let one = "scorer,net,net,net,net,net,net\nbodyparts,snout,snout,snout,tail,tail,tail\n\
               coords,x,y,likelihood,x,y,likelihood\n0,10,20,0.99,30,20,0.9\n1,11,20,0.2,31,20,0.9\n";
    let open = refuses("dlc.csv", one.as_bytes(), &at(30.0));
    assert!(open.contains("point=snout") && open.contains("point=mean"), "{open}");
    let asked = |point: &str| Ask { fps: Some(Rate::Known(30.0)), ..ask(&[("point", point)]) };
    let recording = reads("dlc.csv", one, &asked("mean"));
    assert_eq!(
        (recording.understood.layout.as_str(), place(&recording, 0, "individual")),
        ("deeplabcut", [20.0, 20.0])
    );
    let sure = Ask { confidence: Some(0.6), ..asked("snout") };
    assert_eq!((reads("dlc.csv", one, &sure).understood.doubtful, recording.understood.unit.as_str()), (1, "px"));
    let several = "scorer,net,net,net,net,net,net\nindividuals,m1,m1,m1,m2,m2,m2\nbodyparts,c,c,c,c,c,c\n\
                   coords,x,y,likelihood,x,y,likelihood\n0,1,2,0.9,3,4,0.9\n1,1,2,0.9,,,\n";
    let recording = reads("madlc.csv", several, &at(30.0));
    assert_eq!(plane(&recording).names(), ["m1", "m2"]);
    assert_eq!(place(&recording, 0, "m2"), [3.0, 4.0]);
}

#[test]
fn sleap_has_tracks_and_lost_identities() {
    let text = "track,frame_idx,instance.score,body.x,body.y,body.score\nmouse_1,0,0.9,100.5,200.25,0.98\n\
                mouse_2,0,0.9,300,400,0.9\n,1,0.5,9,9,0.5\nmouse_1,1,,102,201,\n";
    let recording = reads("sleap.csv", text, &at(30.0));
    assert_eq!((recording.understood.layout.as_str(), recording.understood.lost), ("sleap", 1));
    assert_eq!(place(&recording, 0, "mouse_1"), [100.5, 200.25]);
    assert!(recording.understood.lines().iter().any(|(what, text)| *what == "lost" && text.starts_with("1 ")));
}

#[test]
fn sleap_without_tracks() {
    let untracked = "track,frame_idx,instance.score,nose.x,nose.y,nose.score\n,0,0.9,1,2,0.8\n,1,0.9,2,2,0.8\n";
    assert!(refuses("untracked.csv", untracked.as_bytes(), &at(30.0)).contains("--columns id=none"));
    let alone = Ask { fps: Some(Rate::Known(30.0)), ..ask(&[("id", "none")]) };
    let recording = reads("untracked.csv", untracked, &alone);
    assert_eq!((recording.understood.individuals, recording.understood.positions), (1, 2));
    let two = untracked.replace(",1,0.9", ",0,0.9");
    assert!(refuses("two.csv", two.as_bytes(), &alone).contains("twice in frame 0"));
    let numbered = "frame_idx,inst0.nose.x,inst0.nose.y,inst1.nose.x,inst1.nose.y\n0,1,2,3,4\n1,1,2,3,4\n";
    assert!(refuses("numbered.csv", numbered.as_bytes(), &at(30.0)).contains("--layout wide"));
    let wide = Ask { layout: Some("wide".into()), ..at(30.0) };
    assert_eq!(reads("numbered.csv", numbered, &wide).understood.individuals, 2);
}

#[test]
fn animalta_wide_and_detailed() {
    let wide = "Frame;Time;X_Arena0_Ind0;Y_Arena0_Ind0;X_Arena0_Ind1;Y_Arena0_Ind1\n0;0.0;1.5;2;NA;NA\n1;0.03;1.6;2;5;6\n\
                2;0.07;1.7;2;5;6\n3;0.1;1.8;2;5;6\n";
    let recording = reads("animalta.csv", wide, &Ask::default());
    // the rate of the rounded times is 30
    assert_eq!((recording.understood.layout.as_str(), recording.understood.rate), ("animalta", Some(30.0)));
    assert_eq!(plane(&recording).names(), ["Arena0_Ind0", "Arena0_Ind1"]);
    let detailed = "Frame;Time;Arena;Ind;X;Y\n0;0.0;0;0;1;2\n0;0.0;0;1;3;4\n1;0.04;0;0;1;2\n1;0.04;0;1;3;4\n";
    let recording = reads("animalta2.csv", detailed, &Ask::default());
    assert_eq!(place(&recording, 1, "Arena0_Ind1"), [3.0, 4.0]);
}

#[test]
fn columns_that_are_named_are_used() {
    let text = "Frame;Time;X_Arena0_Ind0;Y_Arena0_Ind0\n0;0;1;2\n1;9;2;2\n2;1;3;2\n";
    // a hint that is given has to work
    assert!(refuses("ata.csv", text.as_bytes(), &Ask::default()).contains("--columns time=none"));
    let untimed = Ask { fps: Some(Rate::Known(5.0)), ..ask(&[("time", "none")]) };
    assert_eq!(reads("ata.csv", text, &untimed).understood.rate, Some(5.0));
    assert!(refuses("ata.csv", text.as_bytes(), &ask(&[("x", "px")])).contains("no column `px`"));
    let asked = Ask { layout: Some("animalta".into()), ..ask(&[("x", "px")]) };
    assert!(refuses("ata.csv", text.as_bytes(), &asked).contains("has no use for --columns x=px"));
}

#[test]
fn longitude_and_latitude_by_the_second() {
    let text = "id,utc,t,lon,lat\n3,2012-08-05 03:00:01,0,NA,NA\n2,2012-08-05 03:00:43,42.998,36.9225912,0.3513554\n\
                2,2012-08-05 03:00:44,43.998,36.9225903,0.3513564\n2,2012-08-05 03:00:44,44.2,36.93,0.36\n\
                14,2012-08-05 03:00:44,43.999,36.922913,0.350970\n2,2012-08-05 03:00:45,45,36.9225903,0.3513565\n";
    let recording = reads("baboons.csv", text, &Ask::default());
    let understood = &recording.understood;
    assert!(understood.geographic && matches!(plane(&recording).ground(), Ground::Globe));
    assert_eq!((understood.repeated, understood.individuals, understood.unit.as_str()), (1, 2, "m"));
    assert_eq!((understood.rate, understood.origin.as_deref()), (Some(1.0), Some("2012-08-05 03:00:01")));
    assert_eq!(place(&recording, 43, "2"), [36.9225903, 0.3513564]);
    // the other clock is not common to all: a rate must be said
    let open = read(&recording.path, None, &ask(&[("time", "t")])).unwrap_err().to_string();
    assert!(open.contains("--fps"), "{open}");
    let told = Ask { fps: Some(Rate::Known(1.0)), ..ask(&[("time", "t")]) };
    assert_eq!(read(&recording.path, None, &told).unwrap().understood.repeated, 1);
}

#[test]
fn times_without_a_steady_rate_are_kept() {
    let recording = reads("slow.csv", "time,id,x,y\n0,a,0,0\n1,a,2,0\n1.7,a,3.4,0\n2.9,a,5.8,0\n", &Ask::default());
    assert_eq!(recording.understood.rate, None);
    let tracks = plane(&recording);
    assert_eq!(tracks.times(), [0.0, 1.0, 1.7, 2.9]);
    assert!((1..4).all(|row| (tracks.velocity(row).unwrap().0[0] - 2.0).abs() < 1e-12));
    // a frame that is left out of a steady recording is a gap
    let recording =
        reads("gap.csv", "time,id,x,y\n0,a,0,0\n0.1,a,1,0\n0.2,a,2,0\n0.5,a,3,0\n0.6,a,4,0\n", &Ask::default());
    assert_eq!((recording.understood.rate, plane(&recording).frames()), (Some(10.0), &[0, 1, 2, 5, 6][..]));
    assert!(plane(&recording).velocity(3).is_none());
}

#[test]
fn the_unit_of_times_is_said_or_asked_for() {
    let table = |name: &str, each: i64, from: i64| {
        let rows: String = (0..4).map(|k| format!("{},a,{k},0\n", from + k * each)).collect();
        format!("{name},id,x,y\n{rows}")
    };
    let interval = |text: &str, ask: &Ask| plane(&reads("clock.csv", text, ask)).interval().unwrap();
    for (name, each, expected) in [("time_ms", 40, 0.04), ("t (min)", 1, 60.0), ("time [s]", 2, 2.0), ("time", 2, 2.0)]
    {
        assert!((interval(&table(name, each, 0), &Ask::default()) - expected).abs() < 1e-9, "{name}");
    }
    let since_1970 = table("time", 40, 1_344_135_643_000);
    assert!(refuses("clock.csv", since_1970.as_bytes(), &Ask::default()).contains("--columns clock=ms"));
    let asked = ask(&[("clock", "ms")]);
    assert!((interval(&since_1970, &asked) - 0.04).abs() < 1e-6);
    assert_eq!(reads("clock.csv", &since_1970, &asked).understood.origin.as_deref(), Some("2012-08-05 03:00:43"));
    assert!(refuses("clock.csv", since_1970.as_bytes(), &ask(&[("clock", "days")])).contains("no unit of time"));
}

#[test]
fn times_of_day_end_at_midnight() {
    let rows = |first: &str| format!("time,id,x,y\n{first},a,0,0\n00:00:01,a,1,0\n00:00:02,a,2,0\n00:00:03,a,3,0\n");
    let understood = reads("day.csv", &rows("00:00:00"), &Ask::default()).understood;
    assert_eq!((understood.origin.as_deref(), understood.duration), (Some("00:00:00"), 3.0));
    assert!(refuses("day.csv", rows("23:59:59").as_bytes(), &Ask::default()).contains("midnight"));
}

#[test]
fn individuals_with_clocks_of_their_own_need_ticks() {
    let rows: String = (0..9).map(|k| format!("{k},a,{k},0\n{k}.37,b,{k},1\n")).collect();
    let text = format!("time,id,x,y\n{rows}");
    assert!(refuses("clocks.csv", text.as_bytes(), &Ask::default()).contains("no common clock"));
    let understood = reads("clocks.csv", &text, &at(1.0)).understood;
    assert_eq!((understood.frames, understood.positions), (9, 18));
}

#[test]
fn one_moment_needs_no_rate() {
    let recording = reads("moment.csv", "id,x,y,vx,vy\n0,7,2,1,0.5\n1,3,4,0.5,0.75\n", &Ask::default());
    assert_eq!((recording.understood.frames, plane(&recording).velocity(1).unwrap().0), (1, [0.5, 0.75]));
}

#[test]
fn what_is_open_names_its_option() {
    let frames = "frame,id,x,y\n0,1,0,0\n1,1,1,0\n";
    for (name, text, ask, what) in [
        ("rate.csv", frames, Ask::default(), "--fps F"),
        ("twice.csv", "frame,id,x,y\n0,1,0,0\n0,1,1,0\n", at(1.0), "--keep-first"),
        ("clock.csv", "id,x,y\n1,0,0\n1,1,0\n", at(1.0), "--columns frame="),
        ("nobody.csv", "x,y\n1,0\n1,2\n", at(1.0), "--columns id="),
        ("strange.csv", "when,who,east,north\n1,2,3,4\n", at(1.0), "--columns frame=frame"),
        ("names.csv", frames, Ask { fps: Some(Rate::Known(1.0)), ..ask(&[("id", "idd")]) }, "did you mean `id`"),
        ("units.csv", "frame,id,x/m,y/cm\n0,1,0,0\n", at(1.0), "mixed units"),
        ("side.csv", "frame,id,x_m,y_m\n0,1,0,0\n", at(1.0), "--columns x=x_m,y=y_m"),
        ("both.csv", "frame,id,x,y,lon,lat\n0,1,0,0,1,1\n", at(1.0), "--columns longitude="),
        ("half.csv", "frame,id,x,y\n0.5,1,0,0\n", at(1.0), "time=frame"),
    ] {
        let error = refuses(name, text.as_bytes(), &ask);
        assert!(error.contains(what), "{name}: {error}");
    }
    let recording = reads("suffix.csv", "frame,id,x_mm,y_mm\n0,1,0,0\n0,2,1,0\n", &at(1.0));
    assert_eq!((plane(&recording).names().len(), recording.understood.unit.as_str()), (2, "mm"));
    let unknown = Ask { fps: Some(Rate::Unknown), ..Ask::default() };
    assert_eq!(reads("rate.csv", frames, &unknown).understood.time_unit, "frame");
    let first = Ask { keep_first: true, ..at(1.0) };
    assert_eq!(reads("twice.csv", "frame,id,x,y\n0,1,0,0\n0,1,1,0\n", &first).understood.repeated, 1);
    let few = Ask { individuals: 2, ..at(1.0) };
    let error = refuses("many.csv", b"frame,id,x,y\n0,1,0,0\n0,2,0,0\n0,3,0,0\n", &few);
    assert!(error.contains("--individuals"), "{error}");
    let layout = Ask { layout: Some("trx".into()), ..Ask::default() };
    assert!(read(&file("rate.csv", frames.as_bytes()), None, &layout).unwrap_err().to_string().contains("`trex`"));
}

#[test]
fn what_is_no_table_is_refused_in_a_sentence() {
    let long = [b"frame,id,x,y\n0,1,0,0\n0,2,".as_slice(), &vec![b'1'; 3 << 20]].concat();
    let head = [b"frame,id,x,y\n".as_slice(), &vec![b'1'; 3 << 20]].concat();
    let mut late = b"frame,id,x,y\n".to_vec();
    (0..100).for_each(|k| late.extend(format!("{k},1,0,0\n").bytes()));
    late.extend(b"100,1,\0\0\0\n");
    let strange = [b"frame,id,x,y\n0,\xff\xfe,0,0\n".as_slice()].concat();
    for (name, bytes, what) in [
        ("empty.csv", b"".as_slice(), "empty"),
        ("comments.csv", b"# nothing\n\n", "empty"),
        ("header.csv", b"frame,id,x,y\n", "no row"),
        ("word.csv", b"frame,id,x,y\n0,1,left,0\n", "line 2, column `x`: expected a number, found `left`"),
        ("short.csv", b"frame,id,x,y\n0,1,0,0\n1,1,0\n", "line 3 has 3 cells"),
        ("wrong.csv", b"frame,id,x,y\n0,1,0,0,9\n", "4 names of columns and 5 cells"),
        ("prose.txt", b"Once upon a time, there was a flock.\nIt flew.\n", "no table of tracks"),
        ("binary.csv", b"\x7fELF\x02\x01\x01\0\0\0", "binary data"),
        ("utf16.csv", b"\xff\xfef\0r\0a\0m\0e\0\n\0", "binary data"),
        ("bytes.csv", strange.as_slice(), "UTF-8"),
        ("late.csv", late.as_slice(), "binary data"),
        ("long.csv", long.as_slice(), "longer than"),
        ("head.csv", head.as_slice(), "longer than"),
        ("more.csv", b"frame,id,x,y\n0,1,2,3\n1,1,2,3,4\n", "line 3 has 5 cells, and the first row 4"),
        ("twice.csv", b"frame,id,x,x,y\n0,1,2,3,4\n", "--columns x=3 or --columns x=4"),
        ("far.csv", b"frame,id,x,y\n0,1,2e15,3\n", "beyond 1e15"),
        ("date.csv", b"time,id,x,y\n2012-02-30 03:00:00,1,2,3\n", "expected a time"),
        ("mark.parquet", b"PAR1", "Parquet"),
        ("cut.parquet", b"PAR1\x15\x04\x15\x10\x15\x14L\x15\x02", "Parquet"),
    ] {
        let error = refuses(name, bytes, &at(1.0));
        assert!(error.contains(what), "{name}: {error}");
        assert!(error.len() < 500, "one sentence: {error}");
    }
    assert!(
        read(Path::new("/nothing/here.csv"), None, &Ask::default()).unwrap_err().to_string().contains("cannot read")
    );
}

/// A Parquet table with each kind of number, as others write them.
fn parquet(compression: parquet::basic::Compression, dictionary: bool) -> Vec<u8> {
    use parquet::data_type::{ByteArray, ByteArrayType, DoubleType, FloatType, Int32Type, Int64Type};
    use parquet::file::properties::WriterProperties;
    use parquet::file::writer::SerializedFileWriter;
    use std::sync::Arc;
    let schema = "message schema {
        required int32 frame; optional binary id (UTF8); optional float x; optional double y;
        required int64 when (TIMESTAMP(MICROS,true)); optional int32 score;
    }";
    let schema = Arc::new(parquet::schema::parser::parse_message_type(schema).unwrap());
    let properties = WriterProperties::builder().set_compression(compression).set_dictionary_enabled(dictionary);
    let mut writer = SerializedFileWriter::new(Vec::new(), schema, Arc::new(properties.build())).unwrap();
    for block in 0..2 {
        let mut group = writer.next_row_group().unwrap();
        let mut next = |fill: &mut dyn FnMut(&mut parquet::file::writer::SerializedColumnWriter<'_>)| {
            let mut column = group.next_column().unwrap().unwrap();
            fill(&mut column);
            column.close().unwrap();
        };
        let ids = ["a", "b"].map(ByteArray::from);
        next(&mut |c| assert!(c.typed::<Int32Type>().write_batch(&[block, block], None, None).unwrap() <= 2));
        next(&mut |c| assert!(c.typed::<ByteArrayType>().write_batch(&ids, Some(&[1, 1]), None).unwrap() <= 2));
        next(&mut |c| assert!(c.typed::<FloatType>().write_batch(&[1.5, 2.5], Some(&[1, 1]), None).unwrap() <= 2));
        // of the second individual there is no y in the second block
        let (y, there): (&[f64], &[i16]) = if block == 0 { (&[3.0, 4.0], &[1, 1]) } else { (&[3.5], &[1, 0]) };
        next(&mut |c| assert!(c.typed::<DoubleType>().write_batch(y, Some(there), None).unwrap() <= 2));
        let micros = 1_344_135_643_000_000 + 500_000 * i64::from(block);
        next(&mut |c| assert!(c.typed::<Int64Type>().write_batch(&[micros, micros], None, None).unwrap() <= 2));
        next(&mut |c| assert!(c.typed::<Int32Type>().write_batch(&[7], Some(&[0, 1]), None).unwrap() <= 2));
        group.close().unwrap();
    }
    writer.into_inner().unwrap()
}

#[test]
fn parquet_of_others() {
    use parquet::basic::{Compression, GzipLevel, ZstdLevel};
    for (name, compression, dictionary) in [
        ("plain", Compression::UNCOMPRESSED, false),
        ("snappy", Compression::SNAPPY, true),
        ("gzip", Compression::GZIP(GzipLevel::default()), true),
        ("zstd", Compression::ZSTD(ZstdLevel::default()), false),
        ("lz4", Compression::LZ4_RAW, true),
    ] {
        let bytes = parquet(compression, dictionary);
        let name = format!("{name}.parquet");
        let recording = read(&file(&name, &bytes), None, &at(10.0)).unwrap();
        assert_eq!((recording.understood.positions, recording.understood.individuals), (3, 2), "{name}");
        assert_eq!((place(&recording, 0, "b"), place(&recording, 1, "a")), ([2.5, 4.0], [1.5, 3.5]), "{name}");
        let timed = read(&file(&name, &bytes), None, &ask(&[("frame", "none"), ("time", "when")])).unwrap();
        assert_eq!(timed.understood.origin.as_deref(), Some("2012-08-05 03:00:43"));
        assert_eq!(plane(&timed).times(), [0.0, 0.5]);
        // wherever it is cut off, it is refused
        for length in [bytes.len() - 1, bytes.len() / 2, 8] {
            let error = refuses("cut.parquet", &bytes[..length], &at(10.0));
            assert!(error.contains("damaged or truncated Parquet"), "{error}");
        }
    }
}
