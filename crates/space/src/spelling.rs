//! The name that was meant.

/// The name nearest to `name` by edit distance, where one is near enough to have been meant: at most a third of the
/// letters differ (two in short names), or one begins with the other.
pub fn nearest<'a>(name: &str, among: impl Iterator<Item = &'a str>) -> Option<&'a str> {
    let begins = |a: &str, b: &str| b.len() >= 3 && a.to_lowercase().starts_with(&b.to_lowercase());
    let enough = (name.chars().count() / 3).max(2).min(name.chars().count());
    let far = |other: &str| {
        let distance = distance(name, other);
        // one that begins like the other comes after every slip of the keys and before all else
        if distance <= enough {
            Some(distance)
        } else {
            (begins(other, name) || begins(name, other)).then_some(usize::MAX)
        }
    };
    among.filter_map(|other| Some((far(other)?, other))).min_by_key(|&(far, _)| far).map(|(_, other)| other)
}

/// Levenshtein's distance, row by row, without regard to case.
fn distance(a: &str, b: &str) -> usize {
    let b: Vec<char> = b.chars().collect();
    let mut row: Vec<usize> = (0..=b.len()).collect();
    for (i, from) in a.chars().enumerate() {
        let mut diagonal = row[0];
        row[0] = i + 1;
        for (j, to) in b.iter().enumerate() {
            let changed = diagonal + usize::from(!from.eq_ignore_ascii_case(to));
            diagonal = row[j + 1];
            row[j + 1] = changed.min(row[j] + 1).min(diagonal + 1);
        }
    }
    row[b.len()]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_was_meant_and_what_was_not() {
        let of = |name: &str| nearest(name, ["couzin_2002", "camperi_2012", "radius", "count"].into_iter());
        assert_eq!(of("couzin2002"), Some("couzin_2002"));
        assert_eq!(of("Couzin"), Some("couzin_2002"));
        assert_eq!(of("raduis"), Some("radius"));
        assert_eq!(of("cuont"), Some("count"));
        assert_eq!(of("competing"), None);
        assert_eq!(of("x"), None);
        assert_eq!(of(""), None);
        assert_eq!(nearest("any", core::iter::empty()), None);
    }
}
