//! The plainest loops for a few laws: all pairs, 64-bit, two dimensions, default parameters, as a user would write them by hand.
//! They are what `bench models` measures the engine against, and a second opinion on the laws.

mod forces;
mod headings;
mod way_points;
mod zones;

/// Positions and velocities, one entry an agent.
#[derive(Clone, Debug, PartialEq)]
pub struct Plain {
    /// Positions.
    pub position: Vec<[f64; 2]>,
    /// Velocities.
    pub velocity: Vec<[f64; 2]>,
}

/// One step of a law.
pub type PlainStep = fn(&Plain) -> Plain;

/// The plain loop of a model, where there is one.
pub fn plain(model: &str) -> Option<PlainStep> {
    match model {
        "vicsek_1995" => Some(vicsek_1995),
        "couzin_2002" => Some(couzin_2002),
        "boids_rule_vectors" => Some(boids_rule_vectors),
        "cucker_smale_2007" => Some(cucker_smale_2007),
        "reynolds_opensteer" => Some(reynolds_opensteer),
        "viscido_snn" => Some(viscido_snn),
        "czirok_1997" => Some(headings::czirok_1997),
        "toner_tu_1998" => Some(headings::toner_tu_1998),
        "smith_martin_2009" => Some(headings::smith_martin_2009),
        "gregoire_2003_vectorial" => Some(headings::gregoire_2003_vectorial),
        "boids_unit_heading" => Some(headings::boids_unit_heading),
        "abm_flocking" => Some(headings::abm_flocking),
        "codling_2007" => Some(headings::codling_2007),
        "couzin_2005" => Some(zones::couzin_2005),
        "conradt_2009" => Some(zones::conradt_2009),
        "lopez_2012" => Some(zones::lopez_2012),
        "tien_2004" => Some(zones::tien_2004),
        "lukeman_2010" => Some(zones::lukeman_2010),
        "dong_2012" => Some(forces::dong_2012),
        "levine_2000" => Some(forces::levine_2000),
        "dorsogna_2006" => Some(forces::dorsogna_2006),
        "gazi_passino_2003" => Some(forces::gazi_passino_2003),
        "hamilton_2d" => Some(way_points::hamilton_2d),
        "viscido_lch" => Some(way_points::viscido_lch),
        "lch_member_pose" => Some(way_points::lch_member_pose),
        "lch_member_bearing" => Some(way_points::lch_member_bearing),
        "warburton_lazarus_1991" => Some(way_points::warburton_lazarus_1991),
        _ => None,
    }
}

/// What a law makes of member `i`: its new position and velocity.
fn each(now: &Plain, law: impl Fn(usize) -> ([f64; 2], [f64; 2])) -> Plain {
    let mut next = now.clone();
    for i in 0..now.position.len() {
        (next.position[i], next.velocity[i]) = law(i);
    }
    next
}

/// Everyone but `i`: the index, the offset and the distance.
fn others(now: &Plain, i: usize) -> impl Iterator<Item = (usize, [f64; 2], f64)> + '_ {
    let me = now.position[i];
    (0..now.position.len()).filter(move |&j| j != i).map(move |j| {
        let offset = [now.position[j][0] - me[0], now.position[j][1] - me[1]];
        (j, offset, (offset[0] * offset[0] + offset[1] * offset[1]).sqrt())
    })
}

/// A vector times a number onto another.
fn add(sum: &mut [f64; 2], factor: f64, vector: [f64; 2]) {
    sum[0] += factor * vector[0];
    sum[1] += factor * vector[1];
}

/// Moves `i` a time with a velocity.
fn moved(now: &Plain, i: usize, velocity: [f64; 2], dt: f64) -> [f64; 2] {
    [now.position[i][0] + velocity[0] * dt, now.position[i][1] + velocity[1] * dt]
}

/// The direction, or another one where there is none.
fn unit_or(vector: [f64; 2], other: [f64; 2]) -> [f64; 2] {
    let direction = unit(vector);
    if direction == [0.0; 2] { other } else { direction }
}

/// A heading turned to another by at most an angle.
fn turned(heading: [f64; 2], wanted: [f64; 2], limit: f64) -> [f64; 2] {
    let between =
        (heading[0] * wanted[1] - heading[1] * wanted[0]).atan2(heading[0] * wanted[0] + heading[1] * wanted[1]);
    if between.abs() <= limit || heading == [0.0; 2] {
        return wanted;
    }
    let (sin, cos) = limit.copysign(between).sin_cos();
    [heading[0] * cos - heading[1] * sin, heading[0] * sin + heading[1] * cos]
}

fn unit([x, y]: [f64; 2]) -> [f64; 2] {
    let length = (x * x + y * y).sqrt();
    if length > 1e-12 { [x / length, y / length] } else { [0.0, 0.0] }
}

fn clip([x, y]: [f64; 2], limit: f64) -> [f64; 2] {
    let length = (x * x + y * y).sqrt();
    if length > limit { [x * limit / length, y * limit / length] } else { [x, y] }
}

fn vicsek_1995(now: &Plain) -> Plain {
    let (radius, speed, dt) = (1.0, 0.03, 1.0);
    let mut next = now.clone();
    for i in 0..now.position.len() {
        let me = now.position[i];
        let [mut x, mut y] = unit(now.velocity[i]);
        for j in 0..now.position.len() {
            let offset = [now.position[j][0] - me[0], now.position[j][1] - me[1]];
            if j != i && offset[0] * offset[0] + offset[1] * offset[1] < radius * radius {
                let heading = unit(now.velocity[j]);
                x += heading[0];
                y += heading[1];
            }
        }
        let mut wanted = unit([x, y]);
        if wanted == [0.0, 0.0] {
            wanted = unit(now.velocity[i]);
        }
        next.velocity[i] = [speed * wanted[0], speed * wanted[1]];
        next.position[i] = [me[0] + now.velocity[i][0] * dt, me[1] + now.velocity[i][1] * dt];
    }
    next
}

fn couzin_2002(now: &Plain) -> Plain {
    let (r_r, r_o, r_a, speed, dt): (f64, f64, f64, f64, f64) = (1.0, 6.0, 14.0, 3.0, 0.1);
    let cos_half = (270.0f64.to_radians() / 2.0).cos();
    let limit = 40.0f64.to_radians() * dt;
    let mut next = now.clone();
    for i in 0..now.position.len() {
        let me = now.position[i];
        let heading = unit(now.velocity[i]);
        let (mut repulsion, mut orientation, mut attraction) = ([0.0; 2], [0.0; 2], [0.0; 2]);
        let (mut repelled, mut oriented, mut attracted) = (0, 0, 0);
        for j in 0..now.position.len() {
            if j == i {
                continue;
            }
            let offset = [now.position[j][0] - me[0], now.position[j][1] - me[1]];
            let distance = (offset[0] * offset[0] + offset[1] * offset[1]).sqrt();
            if distance >= r_a {
                continue;
            }
            let direction = unit(offset);
            if distance < r_r {
                repulsion[0] -= direction[0];
                repulsion[1] -= direction[1];
                repelled += 1;
            } else if heading == [0.0; 2] || heading[0] * offset[0] + heading[1] * offset[1] >= cos_half * distance {
                if distance < r_o {
                    let other = unit(now.velocity[j]);
                    orientation[0] += other[0];
                    orientation[1] += other[1];
                    oriented += 1;
                } else {
                    attraction[0] += direction[0];
                    attraction[1] += direction[1];
                    attracted += 1;
                }
            }
        }
        let mut wanted = if repelled > 0 {
            unit(repulsion)
        } else {
            match (oriented > 0, attracted > 0) {
                (true, true) => unit([(orientation[0] + attraction[0]) / 2.0, (orientation[1] + attraction[1]) / 2.0]),
                (true, false) => unit(orientation),
                (false, true) => unit(attraction),
                (false, false) => heading,
            }
        };
        if wanted == [0.0, 0.0] {
            wanted = heading;
        }
        let between =
            (heading[0] * wanted[1] - heading[1] * wanted[0]).atan2(heading[0] * wanted[0] + heading[1] * wanted[1]);
        if between.abs() > limit && heading != [0.0; 2] {
            let (sin, cos) = limit.copysign(between).sin_cos();
            wanted = [heading[0] * cos - heading[1] * sin, heading[0] * sin + heading[1] * cos];
        }
        next.velocity[i] = [speed * wanted[0], speed * wanted[1]];
        next.position[i] = [me[0] + next.velocity[i][0] * dt, me[1] + next.velocity[i][1] * dt];
    }
    next
}

fn boids_rule_vectors(now: &Plain) -> Plain {
    let (radius, w_av, w_vm, w_fc, max_speed, dt): (f64, f64, f64, f64, f64, f64) = (10.0, 1.0, 1.0, 0.1, 2.0, 0.1);
    let mut next = now.clone();
    for i in 0..now.position.len() {
        let me = now.position[i];
        let (mut avoid, mut matched, mut centre, mut count) = ([0.0; 2], [0.0; 2], [0.0; 2], 0.0);
        for j in 0..now.position.len() {
            let offset = [now.position[j][0] - me[0], now.position[j][1] - me[1]];
            let distance = (offset[0] * offset[0] + offset[1] * offset[1]).sqrt();
            if j == i || distance >= radius {
                continue;
            }
            let direction = unit(offset);
            let weight = if distance > 1e-12 { (radius / distance).powi(2) } else { 0.0 };
            let heading = unit(now.velocity[j]);
            for a in 0..2 {
                avoid[a] -= weight * direction[a];
                matched[a] += heading[a];
                centre[a] += offset[a];
            }
            count += 1.0;
        }
        let mut velocity = now.velocity[i];
        if count > 0.0 {
            for a in 0..2 {
                velocity[a] += dt * (w_av * avoid[a] + w_vm * matched[a] + w_fc * centre[a]) / count;
            }
        }
        let velocity = clip(velocity, max_speed);
        next.velocity[i] = velocity;
        next.position[i] = [me[0] + velocity[0] * dt, me[1] + velocity[1] * dt];
    }
    next
}

fn cucker_smale_2007(now: &Plain) -> Plain {
    let (strength, sigma, beta, dt): (f64, f64, f64, f64) = (1.0, 1.0, 0.4, 0.05);
    let mut next = now.clone();
    for i in 0..now.position.len() {
        let (me, mine) = (now.position[i], now.velocity[i]);
        let mut sum = [0.0; 2];
        for j in 0..now.position.len() {
            if j != i {
                let offset = [now.position[j][0] - me[0], now.position[j][1] - me[1]];
                let squared = offset[0] * offset[0] + offset[1] * offset[1];
                let weight = strength / (sigma * sigma + squared).powf(beta);
                sum[0] += weight * (now.velocity[j][0] - mine[0]);
                sum[1] += weight * (now.velocity[j][1] - mine[1]);
            }
        }
        next.velocity[i] = [mine[0] + dt * sum[0], mine[1] + dt * sum[1]];
        next.position[i] = [me[0] + dt * mine[0], me[1] + dt * mine[1]];
    }
    next
}

fn reynolds_opensteer(now: &Plain) -> Plain {
    let (sep_radius, sep_cos, w_sep) = (5.0, -0.707, 12.0);
    let (ali_radius, ali_cos, w_ali) = (7.5, 0.7, 8.0);
    let (coh_radius, coh_cos, w_coh) = (9.0, -0.15, 8.0);
    let (min_dist, max_force, max_speed, dt) = (1.5, 27.0, 9.0, 0.05);
    let mut next = now.clone();
    for i in 0..now.position.len() {
        let me = now.position[i];
        let heading = unit(now.velocity[i]);
        let (mut separation, mut alignment, mut cohesion) = ([0.0; 2], [0.0; 2], [0.0; 2]);
        let (mut separated, mut aligned, mut cohering) = (0.0, 0.0, 0.0);
        for j in 0..now.position.len() {
            if j == i {
                continue;
            }
            let offset = [now.position[j][0] - me[0], now.position[j][1] - me[1]];
            let squared = offset[0] * offset[0] + offset[1] * offset[1];
            let distance = squared.sqrt();
            let direction = unit(offset);
            let ahead = heading[0] * direction[0] + heading[1] * direction[1];
            let seen = |radius: f64, cos: f64| distance < min_dist || (distance < radius && ahead > cos);
            if seen(sep_radius, sep_cos) {
                if distance > 1e-12 {
                    separation[0] -= offset[0] / squared;
                    separation[1] -= offset[1] / squared;
                }
                separated += 1.0;
            }
            if seen(ali_radius, ali_cos) {
                let other = unit(now.velocity[j]);
                alignment[0] += other[0];
                alignment[1] += other[1];
                aligned += 1.0;
            }
            if seen(coh_radius, coh_cos) {
                cohesion[0] += offset[0];
                cohesion[1] += offset[1];
                cohering += 1.0;
            }
        }
        let mut force = [0.0; 2];
        let mut add = |weight: f64, direction: [f64; 2]| {
            force[0] += weight * direction[0];
            force[1] += weight * direction[1];
        };
        if separated > 0.0 {
            add(w_sep, unit([separation[0] / separated, separation[1] / separated]));
        }
        if aligned > 0.0 {
            add(w_ali, unit([alignment[0] / aligned - heading[0], alignment[1] / aligned - heading[1]]));
        }
        if cohering > 0.0 {
            add(w_coh, unit([cohesion[0] / cohering, cohesion[1] / cohering]));
        }
        let force = clip(force, max_force);
        let velocity = clip([now.velocity[i][0] + dt * force[0], now.velocity[i][1] + dt * force[1]], max_speed);
        next.velocity[i] = velocity;
        next.position[i] = [me[0] + dt * velocity[0], me[1] + dt * velocity[1]];
    }
    next
}

fn viscido_snn(now: &Plain) -> Plain {
    let (step, r_rep) = (1.0, 2.0);
    let mut next = now.clone();
    for i in 0..now.position.len() {
        let me = now.position[i];
        let (mut nearest, mut least) = ([0.0; 2], f64::INFINITY);
        for j in 0..now.position.len() {
            let offset = [now.position[j][0] - me[0], now.position[j][1] - me[1]];
            let distance = (offset[0] * offset[0] + offset[1] * offset[1]).sqrt();
            if j != i && distance < least {
                (nearest, least) = (offset, distance);
            }
        }
        let moved = if least > r_rep && least.is_finite() { unit(nearest).map(|c| c * step) } else { [0.0; 2] };
        next.velocity[i] = moved;
        next.position[i] = [me[0] + moved[0], me[1] + moved[1]];
    }
    next
}
