//! Laws of the nearest few.

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
    let (count, alpha, beta, r_hc, r_e, r_a, speed, dt) = (6, 35.0, 5.0, 0.2, 0.5, 0.8, 0.05, 1.0);
    each(now, |i| {
        let (mut core, mut apart) = (false, [0.0; 2]);
        let mut sum = now.velocity[i].map(|c| alpha * c);
        for (j, offset, distance) in nearest(now, i, count) {
            if distance < r_hc {
                core = true;
                add(&mut apart, -1.0, unit(offset));
            }
            let force = if distance < r_a { (distance - r_e) / (4.0 * (r_a - r_e)) } else { 1.0 };
            add(&mut sum, alpha, now.velocity[j]);
            add(&mut sum, beta * force, unit(offset));
        }
        let heading = unit_or(if core { apart } else { sum }, unit(now.velocity[i]));
        let velocity = heading.map(|c| c * speed);
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
