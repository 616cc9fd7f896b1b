//! The nearest spelling of a misspelt name.

/// Number of letters to change, insert, leave out or swap with their neighbour between two words.
fn distance(a: &str, b: &str) -> usize {
    let (a, b): (Vec<char>, Vec<char>) = (a.chars().collect(), b.chars().collect());
    let mut rows: Vec<Vec<usize>> = vec![(0..=b.len()).collect()];
    for i in 1..=a.len() {
        let mut row = vec![i];
        for j in 1..=b.len() {
            let change = usize::from(!a[i - 1].eq_ignore_ascii_case(&b[j - 1]));
            let mut best = (rows[i - 1][j] + 1).min(row[j - 1] + 1).min(rows[i - 1][j - 1] + change);
            if i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1] {
                best = best.min(rows[i - 2][j - 2] + 1);
            }
            row.push(best);
        }
        rows.push(row);
    }
    rows[a.len()][b.len()]
}

/// The known name that is most like `given`, if one is near enough to have been meant.
fn nearest<'a>(given: &str, known: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    let length = given.chars().count();
    let near = |name: &str| {
        let starts = length >= 3 && (name.starts_with(given) || given.starts_with(name));
        let changes = distance(given, name);
        // One letter in three may be wrong: more is another word.
        (starts || changes <= length.max(name.chars().count()) / 3).then_some(changes)
    };
    known.into_iter().filter_map(|name| Some((near(name)?, name))).min_by_key(|&(changes, _)| changes).map(|(_, n)| n)
}

/// Names that other programs and books have.
const ELSEWHERE: [(&str, &str); 14] = [
    ("nu", "poisson"),
    ("e", "young"),
    ("modulus", "young"),
    ("rho", "density"),
    ("mu", "friction"),
    ("dt", "step"),
    ("cfl", "courant"),
    ("t", "end"),
    ("tend", "end"),
    ("duration", "end"),
    ("v", "velocity"),
    ("v0", "velocity"),
    ("area", "section"),
    ("plane", "obstacle"),
];

/// `; did you mean …?`, or nothing.
#[must_use]
pub fn hint<'a>(given: &str, known: impl IntoIterator<Item = &'a str>) -> String {
    let known: Vec<&str> = known.into_iter().collect();
    let low = given.to_lowercase();
    let elsewhere = ELSEWHERE.iter().find(|(name, ours)| *name == low && known.contains(ours)).map(|(_, ours)| *ours);
    elsewhere.or_else(|| nearest(given, known)).map(|name| format!("; did you mean `{name}`?")).unwrap_or_default()
}

/// The names in a sentence, each in backquotes.
#[must_use]
pub fn list<'a>(names: impl IntoIterator<Item = &'a str>) -> String {
    names.into_iter().map(|name| format!("`{name}`")).collect::<Vec<_>>().join(", ")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn slips_are_found_and_strangers_are_not() {
        let known = ["young", "poisson", "density", "thickness"];
        for (given, meant) in
            [("poison", "poisson"), ("yuong", "young"), ("Density", "density"), ("thick", "thickness")]
        {
            assert_eq!(nearest(given, known), Some(meant));
        }
        assert_eq!(nearest("colour", known), None);
        assert_eq!(nearest("E", known), None);
        assert_eq!(nearest("z", ["x", "y"]), None);
    }

    #[test]
    fn swapped_letters_count_once() {
        assert_eq!(distance("lfet", "left"), 1);
        assert_eq!(distance("", "abc"), 3);
    }
}
