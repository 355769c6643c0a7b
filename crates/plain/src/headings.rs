//! Laws of mean headings.

use crate::{Plain, add, each, moved, others, turned, turned_by, unit, unit_or};

/// The sum of the headings within a radius, the own one included.
fn summed(now: &Plain, i: usize, radius: f64) -> [f64; 2] {
    let mut sum = unit(now.velocity[i]);
    for (j, _, distance) in others(now, i) {
        if distance < radius {
            add(&mut sum, 1.0, unit(now.velocity[j]));
        }
    }
    unit_or(sum, unit(now.velocity[i]))
}

pub(crate) fn czirok_1997(now: &Plain) -> Plain {
    let (radius, speed, dt) = (1.0, 0.03, 1.0);
    each(now, |i| (moved(now, i, now.velocity[i], dt), summed(now, i, radius).map(|c| c * speed)))
}

pub(crate) fn smith_martin_2009(now: &Plain) -> Plain {
    let (radius, speed, dt) = (1.0, 0.03, 1.0);
    each(now, |i| (moved(now, i, now.velocity[i], dt), summed(now, i, radius).map(|c| c * speed)))
}

pub(crate) fn toner_tu_1998(now: &Plain) -> Plain {
    let (radius, speed, dt) = (1.0, 0.5, 1.0);
    each(now, |i| {
        let velocity = summed(now, i, radius).map(|c| c * speed);
        (moved(now, i, velocity, dt), velocity)
    })
}

pub(crate) fn gregoire_2003_vectorial(now: &Plain) -> Plain {
    let (alpha, beta, r_0, speed, dt) = (20.0, 0.5, 1.0, 0.05, 1.0);
    each(now, |i| {
        let within = others(now, i).filter(|&(.., distance)| distance < r_0);
        let velocity = pair_law(now, i, alpha, beta, within).map(|c| c * speed);
        (moved(now, i, velocity, dt), velocity)
    })
}

/// The heading that sums the velocities of these others and forces that keep them at a distance; away from a hard core before all.
pub(crate) fn pair_law(
    now: &Plain,
    i: usize,
    alpha: f64,
    beta: f64,
    others: impl IntoIterator<Item = (usize, [f64; 2], f64)>,
) -> [f64; 2] {
    let (r_hc, r_e, r_a) = (0.2, 0.5, 0.8);
    let (mut core, mut apart) = (false, [0.0; 2]);
    let mut sum = now.velocity[i].map(|c| alpha * c);
    for (j, offset, distance) in others {
        if distance < r_hc {
            core = true;
            add(&mut apart, -1.0, unit(offset));
        }
        let force = if distance < r_a { (distance - r_e) / (4.0 * (r_a - r_e)) } else { 1.0 };
        add(&mut sum, alpha, now.velocity[j]);
        add(&mut sum, beta * force, unit(offset));
    }
    unit_or(if core { apart } else { sum }, unit(now.velocity[i]))
}

pub(crate) fn boids_unit_heading(now: &Plain) -> Plain {
    let (radius, cohesion, alignment, separation, softening, speed, dt) = (1.0, 0.03, 0.05, 0.2, 1e-4, 0.05, 1.0);
    each(now, |i| {
        let heading = unit(now.velocity[i]);
        let (mut centre, mut matched, mut apart, mut count) = ([0.0; 2], [0.0; 2], [0.0; 2], 0.0);
        for (j, offset, distance) in others(now, i) {
            if distance < radius {
                add(&mut centre, 1.0, offset);
                add(&mut matched, 1.0, unit(now.velocity[j]));
                add(&mut apart, 1.0 / (distance * distance + softening), offset);
                count += 1.0;
            }
        }
        let mut sum = heading;
        if count > 0.0 {
            add(&mut sum, cohesion / count, centre);
            add(&mut sum, alignment / count, matched);
            add(&mut sum, -alignment, heading);
            add(&mut sum, -separation / count, apart);
        }
        let velocity = unit_or(sum, heading).map(|c| c * speed);
        (moved(now, i, velocity, dt), velocity)
    })
}

pub(crate) fn abm_flocking(now: &Plain) -> Plain {
    let (radius, near, cohesion, separation, alignment, speed, dt) = (5.0, 1.0, 0.03, 0.015, 0.05, 1.0, 1.0);
    each(now, |i| {
        let (mut sum, mut count) = ([0.0; 2], 0.0);
        for (j, offset, distance) in others(now, i) {
            if distance < radius {
                add(&mut sum, cohesion, offset);
                add(&mut sum, alignment, now.velocity[j]);
                if distance < near {
                    add(&mut sum, -separation, offset);
                }
                count += 1.0;
            }
        }
        let mut wanted = now.velocity[i];
        add(&mut wanted, 1.0 / f64::max(count, 1.0), sum);
        let velocity = unit_or(wanted, unit(now.velocity[i])).map(|c| c * speed);
        (moved(now, i, velocity, dt), velocity)
    })
}

pub(crate) fn codling_2007(now: &Plain) -> Plain {
    let (radius, social, speed, dt) = (5.0, 0.5, 1.0, 1.0);
    each(now, |i| {
        let estimate = unit(now.velocity[i]);
        let mut sum = [0.0; 2];
        for (j, _, distance) in others(now, i) {
            if distance < radius {
                add(&mut sum, 1.0, unit(now.velocity[j]));
            }
        }
        let crowd = unit(sum);
        let mut wanted = estimate;
        if crowd != [0.0; 2] {
            wanted = estimate.map(|c| (1.0 - social) * c);
            add(&mut wanted, social, crowd);
        }
        let velocity = unit_or(wanted, estimate).map(|c| c * speed);
        (moved(now, i, velocity, dt), velocity)
    })
}

pub(crate) fn control_boids(now: &Plain) -> Plain {
    let (radius, separation_radius, separation, alignment, cohesion, heading_weight) = (22.0, 8.0, 1.5, 1.0, 1.0, 1.0);
    let (saturation, deviation, turning, step, dt): (f64, f64, f64, f64, f64) = (6.0, 0.2, 0.5, 0.65, 1.0);
    each(now, |i| {
        let heading = unit(now.velocity[i]);
        let (mut apart, mut matched, mut centre, mut count) = ([0.0; 2], [0.0; 2], [0.0; 2], 0.0);
        for (j, offset, distance) in others(now, i) {
            if distance < radius {
                if distance < separation_radius && distance > 1e-12 {
                    add(&mut apart, -1.0 / (distance * distance), offset);
                }
                add(&mut matched, 1.0, unit(now.velocity[j]));
                add(&mut centre, 1.0, offset);
                count += 1.0;
            }
        }
        let social = f64::min(count / saturation, 1.0);
        let wandering = turned_by(heading, deviation * now.draws(i).normal(0));
        let mut wanted = wandering.map(|c| heading_weight * c);
        add(&mut wanted, separation, unit(apart));
        add(&mut wanted, social * alignment, unit(matched));
        add(&mut wanted, social * cohesion, unit(centre));
        let velocity = turned(heading, unit_or(wanted, heading), turning).map(|c| c * step / dt);
        (moved(now, i, velocity, dt), velocity)
    })
}
