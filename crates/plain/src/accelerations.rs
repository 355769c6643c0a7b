//! Laws of accelerations: of forces between pairs, and of the accelerations of others.

use crate::{Plain, add, dot, each, moved, others, unit, unit_or};

/// A flock that agrees on velocity with those within a radius and keeps a distance of one to them.
fn stable_flock(now: &Plain, radius: f64) -> Plain {
    let dt = 0.01;
    each(now, |i| {
        let mine = now.velocity[i];
        let mut acceleration = [0.0; 2];
        for (j, offset, distance) in others(now, i) {
            if distance < radius {
                add(&mut acceleration, 1.0, now.velocity[j]);
                add(&mut acceleration, -1.0, mine);
                add(&mut acceleration, 2.0 / distance - 2.0 / distance.powi(3), unit(offset));
            }
        }
        let mut velocity = mine;
        add(&mut velocity, dt, acceleration);
        (moved(now, i, velocity, dt), velocity)
    })
}

pub(crate) fn tanner_2003_fixed(now: &Plain) -> Plain {
    stable_flock(now, f64::INFINITY)
}

pub(crate) fn tanner_2003_dynamic(now: &Plain) -> Plain {
    stable_flock(now, 2.0)
}

pub(crate) fn shimoyama_1996(now: &Plain) -> Plain {
    let (mass, drag, propulsion, tau, anisotropy): (f64, f64, f64, f64, f64) = (1.0, 1.0, 1.0, 1.0, 1.0);
    let (c, r_c, centre_strength, range, dt) = (1.0, 1.0, 0.5, 10.0, 0.05);
    let mut next = now.next();
    for i in 0..now.position.len() {
        let axis = [now.state[0][i], now.state[1][i]];
        let (mut force, mut centre, mut count) = ([0.0; 2], [0.0; 2], 0.0);
        for (_, offset, distance) in others(now, i) {
            if distance < range {
                let direction = unit(offset);
                // forces stay finite
                let share = f64::max(distance / r_c, 0.001);
                let strength = c * (1.0 / share - 1.0 / (share * share)) * (-share).exp();
                add(&mut force, strength * (1.0 + anisotropy * dot(axis, direction)), direction);
                add(&mut centre, 1.0, offset);
                count += 1.0;
            }
        }
        if count > 0.0 {
            add(&mut force, centre_strength / count, unit(centre));
        }
        add(&mut force, -drag, now.velocity[i]);
        add(&mut force, propulsion, axis);
        let mut velocity = now.velocity[i];
        add(&mut velocity, dt / mass, force);
        next.velocity[i] = velocity;
        next.position[i] = moved(now, i, velocity, dt);
        let heading = unit(now.velocity[i]);
        let mut turned = axis;
        add(&mut turned, dt / tau, heading);
        add(&mut turned, -dt / tau * dot(axis, heading), axis);
        [next.state[0][i], next.state[1][i]] = unit(turned);
    }
    next
}

pub(crate) fn szabo_2008(now: &Plain) -> Plain {
    let (radius, strategy, speed, dt) = (1.0, 0.5, 0.1, 1.0);
    let change = |j: usize| [now.velocity[j][0] - now.state[0][j], now.velocity[j][1] - now.state[1][j]];
    let mut next = each(now, |i| {
        let (mut velocities, mut changes, mut count) = (now.velocity[i], change(i), 1.0);
        for (j, _, distance) in others(now, i) {
            if distance < radius {
                add(&mut velocities, 1.0, now.velocity[j]);
                add(&mut changes, 1.0, change(j));
                count += 1.0;
            }
        }
        let mut sum = velocities.map(|c| strategy / count * c);
        add(&mut sum, (1.0 - strategy) / count, changes);
        let velocity = unit_or(sum, unit(now.velocity[i])).map(|c| c * speed);
        (moved(now, i, velocity, dt), velocity)
    });
    for (i, &[x, y]) in now.velocity.iter().enumerate() {
        (next.state[0][i], next.state[1][i]) = (x, y);
    }
    next
}
