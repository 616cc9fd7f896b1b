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

/// Names of keys of a case and of arguments in Python, each with names that other programs and books have.
const ELSEWHERE: [(&str, &[&str]); 30] = [
    ("young", &["e", "modulus", "emod"]),
    ("poisson", &["nu", "pr"]),
    ("density", &["rho"]),
    ("friction", &["mu", "cof"]),
    ("section", &["area", "a"]),
    ("plane", &["stress", "state", "hypothesis"]),
    ("step", &["dt", "timestep", "time_step", "delta_t"]),
    ("courant", &["cfl", "safety"]),
    ("end", &["t", "tend", "t_end", "tmax", "t_max", "duration", "time", "until"]),
    ("velocity", &["v", "v0"]),
    ("initial_velocity", &["v", "v0", "velocity"]),
    ("displacement", &["u", "u0"]),
    ("initial_displacement", &["u", "u0", "displacement"]),
    ("obstacle", &["plane", "contact", "wall", "ground"]),
    ("obstacles", &["plane", "planes", "contact", "contacts", "wall", "walls", "ground"]),
    ("supports", &["bc", "bcs", "boundary", "boundary_conditions", "dirichlet", "constraints"]),
    ("tractions", &["loads", "pressure", "neumann", "forces"]),
    ("body_forces", &["gravity", "weight", "g"]),
    ("points", &["nodes", "vertices", "coordinates", "coords", "xy"]),
    ("cells", &["elements", "triangles", "connectivity", "faces"]),
    ("point", &["origin", "position", "x0"]),
    ("normal", &["direction", "n"]),
    ("components", &["dofs", "dof", "axes", "axis", "directions"]),
    ("value", &["pressure", "force", "f"]),
    ("store", &["file", "filename", "path", "output", "history"]),
    ("path", &["file", "filename", "name"]),
    ("overwrite", &["force", "replace", "exist_ok"]),
    ("threads", &["n_threads", "num_threads", "n_jobs", "workers"]),
    ("elements", &["n", "nx"]),
    ("length", &["l"]),
];

/// `; did you mean …?`, or nothing.
#[must_use]
pub fn hint<'a>(given: &str, known: impl IntoIterator<Item = &'a str>) -> String {
    let known: Vec<&str> = known.into_iter().collect();
    let low = given.to_lowercase();
    let meant = |(ours, others): &(&str, &[&str])| known.contains(ours) && others.contains(&low.as_str());
    let elsewhere = ELSEWHERE.iter().find(|entry| meant(entry)).map(|(ours, _)| *ours);
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
