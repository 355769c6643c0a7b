//! Laws of the nearest few.

use crate::headings::pair_law;
use crate::{Plain, add, each, length, moved, others, unit, unit_or};

/// The `count` nearest others of `i`, the nearest first: the index, the offset and the distance.
fn nearest(now: &Plain, i: usize, count: usize) -> Vec<(usize, [f64; 2], f64)> {
    let mut list: Vec<(usize, [f64; 2], f64)> = Vec::with_capacity(count + 1);
    for other in others(now, i) {
        if list.len() == count && list.last().is_some_and(|last| last.2 <= other.2) {
            continue;
        }
        list.insert(list.partition_point(|nearer| nearer.2 <= other.2), other);
        list.truncate(count);
    }
    list
}

pub(crate) fn ballerini_2008(now: &Plain) -> Plain {
    let (count, speed, dt) = (7, 0.05, 1.0);
    each(now, |i| {
        let heading = unit(now.velocity[i]);
        let mut sum = heading;
        for (j, ..) in nearest(now, i, count) {
            add(&mut sum, 1.0, unit(now.velocity[j]));
        }
        (moved(now, i, now.velocity[i], dt), unit_or(sum, heading).map(|c| c * speed))
    })
}

pub(crate) fn camperi_2012(now: &Plain) -> Plain {
    let (count, alpha, beta, speed, dt) = (6, 35.0, 5.0, 0.05, 1.0);
    each(now, |i| {
        let velocity = pair_law(now, i, alpha, beta, nearest(now, i, count)).map(|c| c * speed);
        (moved(now, i, velocity, dt), velocity)
    })
}

pub(crate) fn niizato_gunji_2011(now: &Plain) -> Plain {
    let (radius, count, dissimilarity, speed, dt) = (1.0, 7, 0.1, 0.05, 1.0);
    each(now, |i| {
        let heading = unit(now.velocity[i]);
        let (mut sum, mut members) = (heading, 1.0);
        for (j, _, distance) in others(now, i) {
            if distance < radius {
                add(&mut sum, 1.0, unit(now.velocity[j]));
                members += 1.0;
            }
        }
        // those in the radius disagree
        if members > 1.0 && 1.0 - length(sum) / members > dissimilarity {
            sum = heading;
            for (j, ..) in nearest(now, i, count) {
                add(&mut sum, 1.0, unit(now.velocity[j]));
            }
        }
        (moved(now, i, now.velocity[i], dt), unit_or(sum, heading).map(|c| c * speed))
    })
}
