//! What somebody may have meant by a name that is none.

/// Names that are told at most.
const MOST: usize = 3;
/// Names less alike than this are not told.
const ALIKE: f64 = 0.8;
/// What counts that is like a part of a name, over what is like the whole.
const PART: f64 = 0.9;
/// What one slip counts at least: a letter too many, too few, wrong, or at its neighbour's place; short words have little else in common.
const SLIP: f64 = 0.85;

/// The names most like a word, best first: at most three, none that is quite different.
pub fn closest<'n>(word: &str, names: impl IntoIterator<Item = &'n str>) -> Vec<&'n str> {
    // a word of any length costs as much as a long name
    let word: String = word.chars().take(64).flat_map(char::to_lowercase).collect();
    let score = |name: &'n str| {
        let lower = name.to_lowercase();
        let part = if word.len() >= 3 && lower.contains(&word) { PART } else { 0.0 };
        // one word of several
        let word_of = |own: &str| PART * strsim::jaro_winkler(&word, own);
        let words = lower.split('_').filter(|own| own.len() >= 3).map(word_of).fold(part, f64::max);
        let slip = word.len() >= 3 && strsim::damerau_levenshtein(&word, &lower) == 1;
        (strsim::jaro_winkler(&word, &lower).max(words).max(if slip { SLIP } else { 0.0 }), name)
    };
    let mut found: Vec<_> = names.into_iter().map(score).filter(|(alike, _)| *alike >= ALIKE).collect();
    found.sort_by(|a, b| b.0.total_cmp(&a.0).then(a.1.cmp(b.1)));
    found.dedup_by_key(|(_, name)| *name);
    found.into_iter().take(MOST).map(|(_, name)| name).collect()
}

/// `; did you mean `a`, `b`?`, or nothing.
pub fn did_you_mean<'n>(word: &str, names: impl IntoIterator<Item = &'n str>) -> String {
    let found: Vec<String> = closest(word, names).iter().map(|name| format!("`{name}`")).collect();
    if found.is_empty() { String::new() } else { format!("; did you mean {}?", found.join(" or ")) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_like_a_word_come_best_first() {
        let names = ["sod", "modified_sod", "sonic_boom_2d", "cylinder", "free_cylinder"];
        assert!(closest("sodd", names).starts_with(&["sod", "modified_sod"]));
        assert!(closest("cylinder", names).starts_with(&["cylinder", "free_cylinder"]));
        assert_eq!(closest("qqq", names), [""; 0]);
        assert_eq!([closest("vkt", ["png", "vtk"]), closest("pgn", ["png", "exr"])], [["vtk"], ["png"]]);
        assert_eq!(did_you_mean("zzz", names), "");
        assert_eq!(did_you_mean("cylindr", ["cylinder", "box"]), "; did you mean `cylinder`?");
    }
}
