//! Laws of angles: of headings, and of the bearings at which others lie.

use crate::{Plain, angle, at_angle, dot, each, length, moved, nearest, others, unit, wrapped};
use core::f64::consts::{FRAC_PI_2, PI, TAU};

/// The angles of everyone's heading.
fn headings(now: &Plain) -> Vec<f64> {
    now.velocity.iter().map(|&velocity| angle(velocity)).collect()
}

/// Headings that approach those within a radius by a share of the differences; a leader keeps its own.
fn consensus(now: &Plain, leader: Option<usize>) -> Plain {
    let (radius, speed, dt) = (1.0, 0.05, 1.0);
    let theta = headings(now);
    each(now, |i| {
        let (mut differences, mut divisor) = (0.0, 1.0);
        for (j, _, distance) in others(now, i) {
            if distance < radius {
                differences += wrapped(theta[j] - theta[i]);
                divisor += 1.0;
            }
        }
        let turn = if leader == Some(i) { 0.0 } else { differences / divisor };
        (moved(now, i, now.velocity[i], dt), at_angle(theta[i] + turn).map(|c| c * speed))
    })
}

pub(crate) fn jadbabaie_2002_leaderless(now: &Plain) -> Plain {
    consensus(now, None)
}

pub(crate) fn jadbabaie_2002_leader(now: &Plain) -> Plain {
    consensus(now, Some(0))
}

pub(crate) fn warren_2018(now: &Plain) -> Plain {
    let (turning, hastening, near_decay, far_decay, range, dt) = (3.15, 3.61, 0.2, 1.3, 5.0, 0.05);
    let theta = headings(now);
    let speed: Vec<f64> = now.velocity.iter().map(|&velocity| length(velocity)).collect();
    each(now, |i| {
        let heading = unit(now.velocity[i]);
        let seen: Vec<_> =
            others(now, i).filter(|&(_, offset, distance)| distance < range && dot(heading, offset) >= 0.0).collect();
        let Some((.., least)) = nearest(seen.iter().copied()) else {
            return (moved(now, i, now.velocity[i], dt), now.velocity[i]);
        };
        let (mut turn, mut faster) = (0.0, 0.0);
        for &(j, _, distance) in &seen {
            let weight = f64::exp(-far_decay * (distance - least));
            turn += weight * (theta[j] - theta[i]).sin();
            faster += weight * (speed[j] - speed[i]);
        }
        let share = dt * f64::exp(-near_decay * least) / seen.len() as f64;
        let new_speed = f64::max(speed[i] + share * hastening * faster, 0.0);
        let velocity = at_angle(theta[i] + share * turning * turn).map(|c| c * new_speed);
        (moved(now, i, velocity, dt), velocity)
    })
}

/// A school whose fish turn by what the four nearest ask for, each with this share of the weight of the one before.
fn school(now: &Plain, share: f64) -> Plain {
    let (r_1, r_2, r_3, count, speed, dt) = (0.5, 2.0, 5.0, 4, 1.2, 0.5);
    let cos_half = (330f64.to_radians() / 2.0).cos();
    let theta = headings(now);
    each(now, |i| {
        let heading = unit(now.velocity[i]);
        let mut seen: Vec<_> = others(now, i)
            .filter(|&(_, offset, distance)| distance < r_3 && dot(heading, offset) >= cos_half * distance)
            .collect();
        seen.sort_by(|a, b| a.2.total_cmp(&b.2));
        let (mut sum, mut total, mut weight) = (0.0, 0.0, 1.0);
        for &(j, offset, distance) in seen.iter().take(count) {
            let bearing = wrapped(angle(offset) - theta[i]);
            let asked = if distance < r_1 {
                if bearing >= 0.0 { bearing - FRAC_PI_2 } else { bearing + FRAC_PI_2 }
            } else if distance < r_2 {
                wrapped(theta[j] - theta[i])
            } else {
                bearing
            };
            sum += weight * asked;
            total += weight;
            weight *= share;
        }
        let turn = if total > 0.0 { sum / total } else { TAU * (0.5 - now.draws(i).uniform(2)) };
        let velocity = at_angle(theta[i] + turn).map(|c| c * speed);
        (moved(now, i, velocity, dt), velocity)
    })
}

pub(crate) fn huth_wissel_a(now: &Plain) -> Plain {
    school(now, 1.0)
}

pub(crate) fn huth_wissel_d(now: &Plain) -> Plain {
    school(now, 0.5)
}

pub(crate) fn katz_herbert_read_2011(now: &Plain) -> Plain {
    let (r_rho, r_att, range, preferred, relaxation): (f64, f64, f64, f64, f64) = (1.0, 2.0, 8.0, 2.0, 1.0);
    let (speed_response, turning_response, slowest, fastest, dt) = (3.0, 3.0, 0.2, 6.0, 0.1);
    each(now, |i| {
        let (theta, speed) = (angle(now.velocity[i]), length(now.velocity[i]));
        let (mut along, mut across) = (0.0, 0.0);
        if let Some((_, offset, distance)) = nearest(others(now, i))
            && distance < range
        {
            let response = if distance < r_rho {
                (distance - r_rho) / r_rho
            } else if distance < r_att {
                0.0
            } else {
                (distance - r_att) / (range - r_att)
            };
            let (sin, cos) = (angle(offset) - theta).sin_cos();
            along = response * cos;
            // those behind do not draw aside
            if response <= 0.0 || cos >= 0.0 {
                across = response * sin;
            }
        }
        let faster = speed + dt * ((preferred - speed) / relaxation + speed_response * along);
        let new_speed = f64::clamp(faster, slowest, fastest);
        let velocity = at_angle(theta + dt * turning_response * across).map(|c| c * new_speed);
        (moved(now, i, velocity, dt), velocity)
    })
}

pub(crate) fn kunz_hemelrijk_2003(now: &Plain) -> Plain {
    let (r_r, r_p, r_a, form, weights, speed, dt) = (0.6, 2.0, 5.0, 1.5, [1.0, 0.5, 0.3], 1.0, 0.2);
    let (front, view, turning) = (30f64.to_radians(), PI - 60f64.to_radians() / 2.0, 60f64.to_radians());
    let theta = headings(now);
    each(now, |i| {
        let (mut sums, mut counts) = ([0.0; 3], [0.0; 3]);
        for (j, offset, distance) in others(now, i) {
            if distance >= r_a {
                continue;
            }
            let bearing = wrapped(angle(offset) - theta[i]);
            let (sin, cos) = bearing.sin_cos();
            let within = length([distance * cos / form, distance * sin * form]);
            let (zone, asked) = if within < r_r {
                let aside = FRAC_PI_2 * (1.0 - within / r_r);
                (0, if bearing >= 0.0 { -aside } else { aside })
            } else if bearing.abs() > view {
                continue;
            } else if distance < r_p && bearing.abs() >= front {
                (1, wrapped(theta[j] - theta[i]))
            } else {
                (2, bearing)
            };
            sums[zone] += asked;
            counts[zone] += 1.0;
        }
        let turn: f64 = (0..3).map(|zone| weights[zone] * sums[zone] / f64::max(counts[zone], 1.0)).sum();
        let velocity = at_angle(theta[i] + turn.clamp(-turning * dt, turning * dt)).map(|c| c * speed);
        (moved(now, i, velocity, dt), velocity)
    })
}
