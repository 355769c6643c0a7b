//! Laws of way-points: the velocity is the step made.

use crate::{Plain, add, angle, at_angle, clip, each, moved, nearest, others, unit};
use core::f64::consts::{PI, TAU};

pub(crate) fn hamilton_2d(now: &Plain) -> Plain {
    let (step, r_rho, range) = (1.0, 2.0, 10.0);
    each(now, |i| {
        let towards = nearest(others(now, i)).filter(|&(.., distance)| distance > r_rho && distance < range);
        let made = towards.map_or([0.0; 2], |(_, offset, _)| unit(offset).map(|c| c * step));
        (moved(now, i, made, 1.0), made)
    })
}

pub(crate) fn viscido_lch(now: &Plain) -> Plain {
    let (step, decay) = (1.0, 0.375);
    each(now, |i| {
        let mut sum = [0.0; 2];
        for (_, offset, distance) in others(now, i) {
            add(&mut sum, 1.0 / (1.0 + decay * distance), offset);
        }
        let made = unit(sum).map(|c| c * step);
        (moved(now, i, made, 1.0), made)
    })
}

/// The direction to a point at a distance from the nearest one along a line, where that one is farther; else aside from the line.
fn by_the_line(now: &Plain, i: usize, (towards, far): ([f64; 2], f64), line: [f64; 2], distance: f64) -> [f64; 2] {
    if far > distance {
        let mut way_point = towards;
        add(&mut way_point, distance, line);
        return unit(way_point);
    }
    let side = if now.draws(i).uniform(0) < 0.5 { -1.0 } else { 1.0 };
    [-line[1] * side, line[0] * side]
}

pub(crate) fn viscido_ha(now: &Plain) -> Plain {
    let (step, r_rho) = (1.0, 2.0);
    each(now, |i| {
        let mut made = [0.0; 2];
        if let Some((k, towards, far)) = nearest(others(now, i))
            && let Some((_, line, _)) = nearest(others(now, k).filter(|&(j, ..)| j != i))
        {
            made = by_the_line(now, i, (towards, far), unit(line), r_rho).map(|c| c * step);
        }
        (moved(now, i, made, 1.0), made)
    })
}

pub(crate) fn ha_extended(now: &Plain) -> Plain {
    let (step, r_rho, exclusion, range) = (1.0, 2.0, 0.5, 1e9);
    each(now, |i| {
        let made = match nearest(others(now, i).filter(|&(.., distance)| distance < range)) {
            None => now.velocity[i],
            Some((first, towards, far)) => {
                // nobody here is beyond the range of one and within that of another
                let second = nearest(others(now, first).filter(|&(j, _, distance)| j != i && distance > exclusion));
                match second {
                    Some((_, line, _)) => by_the_line(now, i, (towards, far), unit(line), r_rho).map(|c| c * step),
                    None if far > r_rho => unit(towards).map(|c| c * step),
                    None => [0.0; 2],
                }
            }
        };
        (moved(now, i, made, 1.0), made)
    })
}

pub(crate) fn lch_member_pose(now: &Plain) -> Plain {
    let (step, range) = (0.1, 3000.0);
    each(now, |i| {
        let (mut sum, mut count) = ([0.0; 2], 0.0);
        for (_, offset, distance) in others(now, i) {
            if distance < range {
                add(&mut sum, 1.0, offset);
                count += 1.0;
            }
        }
        let made = if count > 0.0 { unit(sum.map(|c| c / count)).map(|c| c * step) } else { [0.0; 2] };
        (moved(now, i, made, 1.0), made)
    })
}

pub(crate) fn lch_member_bearing(now: &Plain) -> Plain {
    let (step, range) = (0.1, 3000.0);
    each(now, |i| {
        let mut sum = [0.0; 2];
        for (_, offset, distance) in others(now, i) {
            if distance < range {
                add(&mut sum, 1.0, unit(offset));
            }
        }
        let made = unit(sum).map(|c| c * step);
        (moved(now, i, made, 1.0), made)
    })
}

pub(crate) fn lch_group_pose(now: &Plain) -> Plain {
    let (link, step, range) = (0.5, 0.1, 3000.0);
    let members = now.position.len();
    // who belongs together is the same for everyone who looks
    let linked = |i| others(now, i).filter(|&(.., distance)| distance <= link).map(|(j, ..)| j).collect();
    let links: Vec<Vec<usize>> = (0..members).map(linked).collect();
    each(now, |i| {
        let (mut offsets, mut left) = (vec![[0.0; 2]; members], vec![false; members]);
        for (j, offset, distance) in others(now, i) {
            (offsets[j], left[j]) = (offset, distance < range);
        }
        // the component that holds the lowest index comes first
        let (mut sum, mut largest) = ([0.0; 2], 0);
        for first in 0..members {
            if !left[first] {
                continue;
            }
            left[first] = false;
            let (mut component, mut next) = (vec![first], 0);
            while next < component.len() {
                for &j in &links[component[next]] {
                    if left[j] {
                        left[j] = false;
                        component.push(j);
                    }
                }
                next += 1;
            }
            if component.len() > largest {
                (sum, largest) = ([0.0; 2], component.len());
                component.iter().for_each(|&j| add(&mut sum, 1.0, offsets[j]));
            }
        }
        let made = if largest > 0 { unit(sum.map(|c| c / largest as f64)).map(|c| c * step) } else { [0.0; 2] };
        (moved(now, i, made, 1.0), made)
    })
}

pub(crate) fn warburton_lazarus_1991(now: &Plain) -> Plain {
    let (preferred, decay, withdrawal, step) = (2.0, 4.0, 1.0, 0.5);
    each(now, |i| {
        let (mut sum, mut count) = ([0.0; 2], 0.0);
        for (_, offset, distance) in others(now, i) {
            let tendency = if distance < preferred {
                -withdrawal * (1.0 - distance / preferred)
            } else {
                1.0 - f64::exp(-(distance - preferred) / decay)
            };
            add(&mut sum, tendency, unit(offset));
            count += 1.0;
        }
        let made = if count > 0.0 { clip(sum.map(|c| c / count), 1.0).map(|c| c * step) } else { [0.0; 2] };
        (moved(now, i, made, 1.0), made)
    })
}

pub(crate) fn lch_group_bearing(now: &Plain) -> Plain {
    let (splitting, step, range) = (10f64.to_radians(), 0.1, 3000.0);
    each(now, |i| {
        let mut inputs: Vec<(f64, usize)> = others(now, i)
            .filter(|&(.., distance)| distance < range)
            .map(|(j, offset, _)| (angle(offset), j))
            .collect();
        inputs.sort_by(|a, b| a.0.total_cmp(&b.0));
        let count = inputs.len();
        // in the plane a component is a run of bearings without a wide gap
        let splits = |k: usize| (inputs[(k + 1) % count].0 - inputs[k % count].0).rem_euclid(TAU) > splitting;
        let first = (0..count).find(|&k| splits(k)).map_or(0, |k| k + 1);
        let (mut component, mut largest): (Vec<(f64, usize)>, Vec<(f64, usize)>) = (Vec::new(), Vec::new());
        for k in first..first + count {
            component.push(inputs[k % count]);
            if k + 1 == first + count || splits(k) {
                // of components of one size that with the lowest index
                let lowest = |of: &[(f64, usize)]| of.iter().map(|&(_, j)| j).min();
                if component.len() > largest.len()
                    || (component.len() == largest.len() && lowest(&component) < lowest(&largest))
                {
                    largest = component;
                }
                component = Vec::new();
            }
        }
        let mut sum = [0.0; 2];
        largest.iter().for_each(|&(bearing, _)| add(&mut sum, 1.0, at_angle(bearing)));
        let made = unit(sum).map(|c| c * step);
        (moved(now, i, made, 1.0), made)
    })
}

pub(crate) fn snn_plus(now: &Plain) -> Plain {
    let (step, r_rho, range) = (1.0, 2.0, 25.0);
    each(now, |i| {
        let made = match nearest(others(now, i)) {
            Some((_, offset, distance)) if distance > r_rho && distance < range => unit(offset).map(|c| c * step),
            _ => [0.0; 2],
        };
        (moved(now, i, made, 1.0), made)
    })
}

pub(crate) fn rm_plus(now: &Plain) -> Plain {
    let step = 1.0;
    each(now, |i| {
        let made = at_angle(TAU * now.draws(i).uniform(0) - PI).map(|c| c * step);
        (moved(now, i, made, 1.0), made)
    })
}
