//! Names of groups as names of HDF5 links.

/// The link name of a group: `%`, `/` and NUL, which a link name cannot hold, and the first dot of a
/// name that is a single dot, as `%25`, `%2F`, `%00` and `%2E`; the empty name as `%`.
pub(crate) fn encoded(name: &str) -> String {
    match name {
        "" => "%".to_string(),
        "." => "%2E".to_string(),
        _ => name.replace('%', "%25").replace('/', "%2F").replace('\0', "%00"),
    }
}

/// The group of a link name. Other codes than those of [`encoded`] stand for themselves, because other
/// programs do not encode.
pub(crate) fn decoded(link: &str) -> String {
    if link == "%" {
        return String::new();
    }
    let mut name = String::with_capacity(link.len());
    let mut rest = link;
    while let Some(at) = rest.find('%') {
        name.push_str(&rest[..at]);
        rest = &rest[at..];
        let codes = [("%25", '%'), ("%2F", '/'), ("%00", '\0'), ("%2E", '.')];
        let (length, meant) = codes
            .iter()
            .find(|(code, _)| rest.starts_with(code))
            .map_or((1, '%'), |(code, meant)| (code.len(), *meant));
        name.push(meant);
        rest = &rest[length..];
    }
    name.push_str(rest);
    name
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn what_links_cannot_hold() {
        for (name, link) in [("", "%"), (".", "%2E"), ("..", ".."), ("a/b", "a%2Fb"), ("5 %", "5 %25"), ("%", "%25")] {
            assert_eq!((encoded(name).as_str(), decoded(link).as_str()), (link, name));
        }
        assert_eq!(decoded("100% steel"), "100% steel");
    }

    proptest! {
        #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::default() })]

        #[test]
        fn names_come_back(name in "[%/.\\x000-9A-Fa-z é]{0,8}") {
            let link = encoded(&name);
            prop_assert!(!link.is_empty() && link != "." && !link.contains(['/', '\0']));
            prop_assert_eq!(decoded(&link), name);
        }
    }
}
