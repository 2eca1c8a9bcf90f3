//! Lists of names in error messages.

/// Largest number of names that a message lists.
const LISTED: usize = 20;

/// The `bound` of an [`InputError`](crate::InputError) for a value that must be one of `names` or an index into `names`. `what`
/// is the plural of the named things, such as `bones`.
#[doc(hidden)]
pub fn name_or_index<'a>(what: &str, names: impl ExactSizeIterator<Item = &'a str>) -> String {
    let count = names.len();
    if count == 0 {
        return format!("the model has no {what}");
    }
    let listed: Vec<_> = names.take(LISTED).map(|name| format!("{name:?}")).collect();
    let more = match count - listed.len() {
        0 => String::new(),
        left => format!(" … and {left} more"),
    };
    format!("must be one of {}{more}, or an index below {count}", listed.join(", "))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn long_lists_end_with_a_count() {
        let names: Vec<String> = (0..57).map(|at| format!("b{at}")).collect();
        let bound = |count: usize| name_or_index("bones", names[..count].iter().map(String::as_str));
        assert_eq!(bound(0), "the model has no bones");
        assert_eq!(bound(2), r#"must be one of "b0", "b1", or an index below 2"#);
        assert!(bound(20).ends_with(r#""b19", or an index below 20"#), "{}", bound(20));
        assert!(bound(57).ends_with(r#""b19" … and 37 more, or an index below 57"#), "{}", bound(57));
    }
}
