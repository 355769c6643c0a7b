//! Laws of members with bodies, in a world without walls.

use crate::{Plain, add, each, moved, nearest, others, turned, turned_by, unit, unit_or};
use core::f64::consts::PI;

pub(crate) fn control_random(now: &Plain) -> Plain {
    let (deviation, step, dt) = (0.6, 1.0, 1.0);
    each(now, |i| {
        let heading = turned_by(unit(now.velocity[i]), deviation * now.draws(i).normal(0));
        let velocity = heading.map(|c| c * step / dt);
        (moved(now, i, velocity, dt), velocity)
    })
}

pub(crate) fn control_snn(now: &Plain) -> Plain {
    let (radius, r_rho, step, turning, deviation, dt) = (7.0, 2.0, 1.0, 0.5, 0.1, 1.0);
    each(now, |i| {
        let heading = unit(now.velocity[i]);
        let (wanted, moves) = match nearest(others(now, i)).filter(|&(.., distance)| distance < radius) {
            None => (turned_by(heading, deviation * now.draws(i).normal(0)), true),
            Some((_, offset, distance)) if distance > r_rho => (unit(offset), true),
            Some(_) => (heading, false),
        };
        let velocity = turned(heading, wanted, turning).map(|c| c * step / dt);
        // who stays keeps the velocity, which bears its heading
        (if moves { moved(now, i, velocity, dt) } else { now.position[i] }, velocity)
    })
}

pub(crate) fn contact_only(now: &Plain) -> Plain {
    let (body, touch, alignment, repulsion, most, speed, dt): (f64, f64, f64, f64, f64, f64, f64) =
        (0.5, 0.1, 1.0, 0.5, PI, 0.2, 1.0);
    let mut next = each(now, |i| {
        let heading = unit(now.velocity[i]);
        let (mut wanted, mut touches) = (heading, false);
        for (j, offset, distance) in others(now, i) {
            if distance < 2.0 * body + touch {
                add(&mut wanted, alignment, unit(now.velocity[j]));
                add(&mut wanted, -repulsion, unit(offset));
                touches = true;
            }
        }
        if !touches && now.state[0][i] > 0.0 {
            wanted = turned_by(heading, most * (2.0 * now.draws(i).uniform(0) - 1.0));
        }
        let velocity = unit_or(wanted, heading).map(|c| c * speed);
        (moved(now, i, velocity, dt), velocity)
    });
    // a move that would touch is not made: one by one, against new places of those before and old ones of those behind
    let members = now.position.len();
    for i in 0..members {
        let squared = |[x, y]: [f64; 2], j: usize| {
            let other = if j < i { next.position[j] } else { now.position[j] };
            (x - other[0]).powi(2) + (y - other[1]).powi(2)
        };
        let stopped = (0..members).filter(|&j| j != i).any(|j| {
            let after = squared(next.position[i], j);
            // who touches already may move away
            after < (2.0 * body).powi(2) && after <= squared(now.position[i], j)
        });
        if stopped {
            next.position[i] = now.position[i];
        }
        next.state[0][i] = f64::from(stopped);
    }
    next
}
