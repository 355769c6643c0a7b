//! Laws of forces and of consensus.

use super::{Plain, add, each, moved, others, unit};

pub(super) fn dong_2012(now: &Plain) -> Plain {
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

pub(super) fn levine_2000(now: &Plain) -> Plain {
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

pub(super) fn dorsogna_2006(now: &Plain) -> Plain {
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

pub(super) fn gazi_passino_2003(now: &Plain) -> Plain {
    let (a, b, c, dt) = (1.0, 20.0, 0.2, 0.01);
    each(now, |i| {
        let mut velocity = [0.0; 2];
        for (_, offset, distance) in others(now, i) {
            add(&mut velocity, a - b * f64::exp(-distance * distance / c), offset);
        }
        (moved(now, i, velocity, dt), velocity)
    })
}
