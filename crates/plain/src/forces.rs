//! Laws of forces and of consensus.

use crate::{Plain, add, clip, each, moved, others, unit};

pub(crate) fn dong_2012(now: &Plain) -> Plain {
    let (radius, dt) = (2.0, 0.05);
    each(now, |i| {
        let mine = now.velocity[i];
        let mut sum = [0.0; 2];
        for (j, _, distance) in others(now, i) {
            if distance <= radius {
                add(&mut sum, 1.0, now.velocity[j]);
                add(&mut sum, -1.0, mine);
            }
        }
        let mut velocity = mine;
        add(&mut velocity, dt, sum);
        (moved(now, i, mine, dt), velocity)
    })
}

/// Size of the force of the Morse potential, away.
fn morse(distance: f64) -> f64 {
    let (c_r, l_r, c_a, l_a): (f64, f64, f64, f64) = (1.0, 0.5, 0.5, 2.0);
    c_r / l_r * (-distance / l_r).exp() - c_a / l_a * (-distance / l_a).exp()
}

pub(crate) fn levine_2000(now: &Plain) -> Plain {
    let (propulsion, drag, l_c, range, dt) = (1.0, 0.5, 1.0, 10.0, 0.05);
    each(now, |i| {
        let (mut along, mut force) = (unit(now.velocity[i]), [0.0; 2]);
        for (j, offset, distance) in others(now, i) {
            if distance < range {
                add(&mut along, f64::exp(-distance / l_c), unit(now.velocity[j]));
                add(&mut force, -morse(distance), unit(offset));
            }
        }
        add(&mut force, propulsion, unit(along));
        add(&mut force, -drag, now.velocity[i]);
        let mut velocity = now.velocity[i];
        add(&mut velocity, dt, force);
        (moved(now, i, velocity, dt), velocity)
    })
}

pub(crate) fn dorsogna_2006(now: &Plain) -> Plain {
    let (alpha, beta, range, dt) = (1.6, 0.5, 40.0, 0.01);
    each(now, |i| {
        let mine = now.velocity[i];
        let mut force = mine.map(|c| c * (alpha - beta * (mine[0] * mine[0] + mine[1] * mine[1])));
        for (_, offset, distance) in others(now, i) {
            if distance < range {
                add(&mut force, -morse(distance), unit(offset));
            }
        }
        let mut velocity = mine;
        add(&mut velocity, dt, force);
        (moved(now, i, velocity, dt), velocity)
    })
}

pub(crate) fn gazi_passino_2003(now: &Plain) -> Plain {
    let (a, b, c, dt) = (1.0, 20.0, 0.2, 0.01);
    each(now, |i| {
        let mut velocity = [0.0; 2];
        for (_, offset, distance) in others(now, i) {
            add(&mut velocity, a - b * f64::exp(-distance * distance / c), offset);
        }
        (moved(now, i, velocity, dt), velocity)
    })
}

pub(crate) fn olfati_saber_2006(now: &Plain) -> Plain {
    let (spacing, radius, epsilon, plateau, dt): (f64, f64, f64, f64, f64) = (7.0, 8.4, 0.1, 0.2, 0.02);
    let (a, b, position_gain, velocity_gain): (f64, f64, f64, f64) = (5.0, 5.0, 1.0, 1.0);
    let stretched = |length: f64| (1.0 + epsilon * length * length).sqrt();
    let norm = |stretch: f64| (stretch - 1.0) / epsilon;
    let (spacing, range) = (norm(stretched(spacing)), norm(stretched(radius)));
    let shift = (a - b).abs() / (4.0 * a * b).sqrt();
    each(now, |i| {
        let mine = now.velocity[i];
        let mut force = [0.0; 2];
        for (j, offset, distance) in others(now, i) {
            if distance < radius {
                let stretch = stretched(distance);
                let length = norm(stretch);
                let share = length / range;
                let weight = if share < plateau {
                    1.0
                } else {
                    (1.0 + (core::f64::consts::PI * (share - plateau) / (1.0 - plateau)).cos()) / 2.0
                };
                let excess = length - spacing + shift;
                let pair = ((a + b) * excess / (1.0 + excess * excess).sqrt() + a - b) / 2.0;
                add(&mut force, position_gain * weight * pair / stretch, offset);
                add(&mut force, velocity_gain * weight, now.velocity[j]);
                add(&mut force, -velocity_gain * weight, mine);
            }
        }
        let mut velocity = mine;
        add(&mut velocity, dt, force);
        (moved(now, i, velocity, dt), velocity)
    })
}

pub(crate) fn helbing_2005(now: &Plain) -> Plain {
    let (desired, tau, strength, decay, anisotropy, radius) = (1.34, 0.5, 3.0, 0.3, 0.2, 0.3);
    let (limit, range, dt) = (1.3, 10.0, 0.05);
    each(now, |i| {
        let heading = unit(now.velocity[i]);
        let mut force = heading.map(|c| c * desired / tau);
        add(&mut force, -1.0 / tau, now.velocity[i]);
        for (_, offset, distance) in others(now, i) {
            if distance < range {
                let direction = unit(offset);
                let ahead = (1.0 + heading[0] * direction[0] + heading[1] * direction[1]) / 2.0;
                let push = strength * f64::exp((radius + radius - distance) / decay);
                add(&mut force, -push * (anisotropy + (1.0 - anisotropy) * ahead), direction);
            }
        }
        let mut velocity = now.velocity[i];
        add(&mut velocity, dt, force);
        let velocity = clip(velocity, limit * desired);
        (moved(now, i, velocity, dt), velocity)
    })
}
