//! Laws that hold for every listed metric over time.

use super::sketch::{Fine, tracks};
use super::*;
use crate::{Bounds, Kind, Tracks};
use space::Space;

/// Each metric with every parameter that must be given.
fn given<const D: usize>() -> Vec<Box<dyn MeasureTracks<D>>> {
    let mut metrics = all::<D>();
    for (k, metric) in metrics.iter_mut().enumerate() {
        for (p, parameter) in metric.card().parameters.iter().enumerate() {
            if parameter.default.is_none() {
                let value = if parameter.bounds == Bounds::Any { 0.2 * (p as f64 + 1.0) } else { 2.0 + k as f64 % 3.0 };
                assert_eq!(metric.set(parameter.name, value), Ok(()));
            }
        }
    }
    metrics
}

/// Walks that wind, meet, rest and have gaps.
fn walks<const D: usize>(space: Space<f64, D>, frames: i64, individuals: u32) -> Result<Tracks<D>, crate::TracksError> {
    tracks(space, 4.0, frames, individuals, |frame, k| {
        let t = frame as f64 / (1.0 + f64::from(k % 3));
        let axis = |a: usize| {
            4.0 + 2.0 * (0.3 * t + f64::from(k) * 1.7 + a as f64).sin() + 0.3 * f64::from(k) * (a as f64 - 0.5)
        };
        ((frame + i64::from(k)) % 13 != 5).then(|| core::array::from_fn(axis))
    })
}

fn tables_are_as_the_cards_say<const D: usize>() -> Fine {
    for space in [Space::open(), Space::periodic([12.0; D]), Space::walled([12.0; D])] {
        for (frames, individuals) in [(0, 0), (1, 1), (2, 1), (2, 3), (60, 1), (60, 2), (60, 7)] {
            let tracks = walks::<D>(space, frames, individuals)?;
            for metric in given::<D>() {
                let card = metric.card();
                if !card.dimensions.contains(&D) {
                    assert!(metric.on(&tracks).is_err(), "{}", card.id);
                    continue;
                }
                let Ok(found) = metric.on(&tracks) else { continue };
                assert_eq!(found.columns.len(), card.fields.len(), "{}", card.id);
                for (field, column) in card.fields.iter().zip(&found.columns) {
                    assert_eq!(column.len(), found.len(), "{}", card.id);
                    let fits = |value: &f64| match field.kind {
                        Kind::Number => !value.is_infinite(),
                        Kind::Count => *value >= 0.0 && value.fract() == 0.0,
                        Kind::Frame => tracks.frames().contains(&(*value as i64)),
                        Kind::Individual => *value >= -1.0 && *value < f64::from(individuals),
                        Kind::Group => *value == 0.0,
                        Kind::Label(words) => (*value as usize) < words.len(),
                    };
                    assert!(column.iter().all(fits), "{} of {}: {column:?}", field.name, card.id);
                }
            }
        }
    }
    Ok(())
}

#[test]
fn tables_on_a_line() -> Fine {
    tables_are_as_the_cards_say::<1>()
}

#[test]
fn tables_in_the_plane() -> Fine {
    tables_are_as_the_cards_say::<2>()
}

#[test]
fn tables_in_space() -> Fine {
    tables_are_as_the_cards_say::<3>()
}

#[test]
fn every_metric_finds_something_somewhere() -> Fine {
    let mut silent: Vec<&str> = LIST.iter().map(|card| card.id).collect();
    for tracks in [walks::<2>(Space::open(), 200, 7)?, walks(Space::periodic([12.0; 2]), 200, 7)?] {
        let tracks = tracks.with_groups(vec!["a".into(), "b".into()], vec![0, 0, 0, 1, 1, 1, 1])?;
        for mut metric in given::<2>() {
            // a line and a rectangle where the walks are, and near neighbours
            let here =
                [("x1", 0.0), ("y1", 4.0), ("x2", 9.0), ("y2", 4.1), ("moving_speed", 0.4), ("linking_distance", 1.5)];
            for (name, value) in here {
                let known = metric.card().parameters.iter().any(|parameter| parameter.name == name);
                assert_eq!(metric.set(name, value).is_ok(), known);
            }
            if metric.on(&tracks).is_ok_and(|found| !found.is_empty()) {
                silent.retain(|id| *id != metric.card().id);
            }
        }
    }
    assert_eq!(silent, [""; 0]);
    Ok(())
}

#[test]
fn each_id_is_the_name_of_its_file_and_found_by_it() {
    let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("src/over_time");
    for card in LIST {
        assert!(folder.join(card.id).with_extension("rs").is_file(), "{}", card.id);
        assert!(find::<2>(card.id).is_ok_and(|metric| metric.card().id == card.id));
        assert!(!crate::metrics::LIST.iter().any(|other| other.id == card.id), "{} is twice", card.id);
        let texts = [card.title, card.definition, card.variant, card.source, card.edge];
        assert!(texts.iter().all(|text| !text.is_empty()), "{}", card.id);
    }
    let error = find::<2>("velocity_corelation").err().map(|error| error.to_string());
    assert!(error.is_some_and(|error| error.ends_with("did you mean `velocity_correlation`?")));
}

#[test]
fn parameters_are_checked() {
    for mut metric in all::<2>() {
        for parameter in metric.card().parameters {
            assert!(metric.set(parameter.name, f64::NAN).is_err());
            let negative = metric.set(parameter.name, -1.0);
            assert_eq!(negative.is_ok(), parameter.bounds == Bounds::Any, "{}", parameter.name);
        }
        assert!(metric.set("nothing", 1.0).is_err());
    }
}
