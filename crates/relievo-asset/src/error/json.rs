//! Converts JSON errors to an [`InputError`] with path, value and bound.

use serde_json::Value;

use super::InputError;

/// Largest number of characters of a value in an error message.
const SHOWN: usize = 60;

/// A JSON value as text for an error message, cut after `SHOWN` characters.
pub fn shown(value: &Value) -> String {
    let text = match value {
        Value::String(text) => text.clone(),
        value => value.to_string(),
    };
    match text.char_indices().nth(SHOWN) {
        Some((end, _)) => format!("{}…", &text[..end]),
        None => text,
    }
}

/// serde's message without the line and column at its end.
pub fn message(error: &serde_json::Error) -> String {
    let message = error.to_string();
    let end = format!(" at {}", place(error));
    message.strip_suffix(&end).unwrap_or(&message).to_owned()
}

/// The error for a text that cannot be parsed. Its `value` is the line and column of the mistake.
pub fn unreadable(path: &str, error: &serde_json::Error) -> InputError {
    InputError::new(path, place(error), message(error))
}

/// Position of an error in the text: line and column.
pub fn place(error: &serde_json::Error) -> String {
    format!("line {} column {}", error.line(), error.column())
}

/// The error for a value that its field does not accept, or for a field that is unknown or given twice. `None` for other errors
/// of serde.
pub fn refused_value(path: &str, value: &Value, error: &serde_json::Error) -> Option<InputError> {
    let message = message(error);
    let bound = match message.split_once("expected ") {
        _ if message.contains(" field `") => message,
        Some((_, "f32" | "f64" | "a JSON number")) => "must be a number".to_owned(),
        Some((_, "i32")) => "must be a whole number that fits i32".to_owned(),
        Some((_, "u32" | "u64" | "usize")) => "must be a whole number, and not negative".to_owned(),
        Some((_, "a string")) => "must be a string".to_owned(),
        Some((_, "a map")) => "must be an object".to_owned(),
        Some((_, "a sequence")) => "must be a list".to_owned(),
        Some((_, expected)) if expected.starts_with("struct ") => "must be an object".to_owned(),
        Some((_, expected)) => match expected.strip_prefix("any of: ") {
            Some(list) => format!("must be one of {}", list.trim_matches(['[', ']'])),
            None => format!("must be {expected}"),
        },
        None => return None,
    };
    Some(InputError::new(path, shown(value), bound))
}
