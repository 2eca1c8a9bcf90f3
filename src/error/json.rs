//! Errors of JSON as path, value and bound.

use serde_json::Value;

use super::InputError;

/// The longest text of a value in a message, in characters.
const SHOWN: usize = 60;

/// A value as messages show it.
pub(crate) fn shown(value: &Value) -> String {
    let text = match value {
        Value::String(text) => text.clone(),
        value => value.to_string(),
    };
    match text.char_indices().nth(SHOWN) {
        Some((end, _)) => format!("{}…", &text[..end]),
        None => text,
    }
}

/// What serde says, without the place in the text.
pub(crate) fn message(error: &serde_json::Error) -> String {
    let message = error.to_string();
    let end = format!(" at {}", place(error));
    message.strip_suffix(&end).unwrap_or(&message).to_owned()
}

/// The error of a text that cannot be read at all: the place stands for the value.
pub(crate) fn unreadable(path: &str, error: &serde_json::Error) -> InputError {
    InputError::new(path, place(error), message(error))
}

fn place(error: &serde_json::Error) -> String {
    format!("line {} column {}", error.line(), error.column())
}
