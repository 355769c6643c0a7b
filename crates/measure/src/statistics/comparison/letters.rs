//! The letters of groups that do not differ.

/// For each group the letters it shares with every group it does not differ from: a compact letter display.
///
/// Two groups share a letter exactly if `different` does not hold for them. The group of the highest mean has an `a`.
/// Insert and absorb (Piepho 2004, J. Comput. Graph. Stat. 13:456): begin with one letter for all, split each letter
/// that joins two different groups, and drop a letter whose groups all share another one. After `z` come `aa`, `ab`, ...
/// separated from others by a space.
pub fn letters(means: &[f64], different: impl Fn(usize, usize) -> bool) -> Vec<String> {
    let count = means.len();
    let mut columns: Vec<Vec<bool>> = vec![vec![true; count]];
    for (a, b) in super::pairs_below(count).filter(|&(a, b)| different(a, b)) {
        let (split, kept): (Vec<_>, Vec<_>) = columns.into_iter().partition(|column| column[a] && column[b]);
        columns = kept;
        for column in split {
            for without in [a, b] {
                let mut narrower = column.clone();
                narrower[without] = false;
                columns.push(narrower);
            }
        }
        columns = absorb(columns);
    }
    let mut order: Vec<usize> = (0..count).collect();
    order.sort_by(|&a, &b| means[b].total_cmp(&means[a]));
    // letters are given out from the highest mean down
    columns.sort_by_key(|column| order.iter().map(|&group| !column[group]).collect::<Vec<_>>());
    let names: Vec<String> = (0..columns.len()).map(name).collect();
    let separator = if names.len() > 26 { " " } else { "" };
    let of = |group: usize| {
        let own = columns.iter().zip(&names).filter(|(column, _)| column[group]).map(|(_, name)| name.as_str());
        own.collect::<Vec<_>>().join(separator)
    };
    (0..count).map(of).collect()
}

/// The columns without those that are part of another one.
fn absorb(columns: Vec<Vec<bool>>) -> Vec<Vec<bool>> {
    let within = |a: &[bool], b: &[bool]| a.iter().zip(b).all(|(&a, &b)| !a || b);
    let mut kept: Vec<Vec<bool>> = Vec::new();
    for column in columns {
        if kept.iter().any(|other| within(&column, other)) {
            continue;
        }
        kept.retain(|other| !within(other, &column));
        kept.push(column);
    }
    kept
}

/// `a` to `z`, then `aa`, `ab`, ...
fn name(number: usize) -> String {
    let letter = char::from(b'a' + (number % 26) as u8);
    if number < 26 { letter.to_string() } else { format!("{}{letter}", name(number / 26 - 1)) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_usual_displays() {
        let among = |pairs: &'static [(usize, usize)]| move |a: usize, b: usize| pairs.contains(&(a.min(b), a.max(b)));
        assert_eq!(letters(&[3.0, 2.0, 1.0], among(&[])), ["a", "a", "a"]);
        assert_eq!(letters(&[3.0, 2.0, 1.0], among(&[(0, 2)])), ["a", "ab", "b"]);
        assert_eq!(letters(&[1.0, 2.0, 3.0], among(&[(0, 1), (0, 2), (1, 2)])), ["c", "b", "a"]);
        // Piepho's point: letters need not be runs of ordered means
        assert_eq!(letters(&[4.0, 3.0, 2.0, 1.0], among(&[(0, 1), (2, 3)])), ["ab", "cd", "ac", "bd"]);
        assert_eq!(letters(&[], |_, _| true), [""; 0]);
        assert_eq!(letters(&[1.0], |_, _| true), ["a"]);
    }

    #[test]
    fn share_a_letter_exactly_where_not_different() {
        // every relation over five groups
        for relation in 0u32..1 << 10 {
            let pairs: Vec<_> = super::super::pairs_below(5).collect();
            let different = |a: usize, b: usize| {
                let place = pairs.iter().position(|&pair| pair == (a.min(b), a.max(b)));
                place.is_some_and(|place| relation >> place & 1 == 1)
            };
            let shown = letters(&[5.0, 4.0, 3.0, 2.0, 1.0], different);
            for &(a, b) in &pairs {
                let share = shown[a].chars().any(|letter| shown[b].contains(letter));
                assert_eq!(share, !different(a, b), "{relation:b}: {shown:?}");
            }
        }
    }

    #[test]
    fn many_letters() {
        let shown = letters(&(0..30).map(f64::from).collect::<Vec<_>>(), |_, _| true);
        assert_eq!([&shown[29], &shown[4], &shown[3], &shown[0]], ["a", "z", "aa", "ad"]);
    }
}
