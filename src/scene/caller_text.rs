//! Checks of WGSL that the caller wrote. The caller's text comes first in the compiled text, so that error messages have the
//! caller's own line numbers.
//!
//! In the compiled text, all names of the crate start with [`PREFIX`], except for `Surface` and `View`.

use naga::front::wgsl::{ParseError, parse_str};
use naga::valid::{Capabilities, ModuleInfo, ValidationFlags, Validator};
use naga::{Block, Module, Span, Statement};

use crate::InputError;
use crate::scene::wgsl::prefix::declarations;

pub(crate) use crate::scene::wgsl::prefix::PREFIX;

/// WGSL that the caller wrote, and the complete text to parse: the caller's text, followed by the crate's.
pub(crate) struct CallerText<'a> {
    /// Start of the path in errors, before the line and the column.
    pub path: &'a str,
    pub source: &'a str,
    pub text: &'a str,
}

impl CallerText<'_> {
    /// Parses the complete text.
    ///
    /// # Errors
    /// [`InputError`] for a syntax error. Its path is `PATH:LINE:COLUMN`, with line and column counted from 1.
    pub fn parsed(&self) -> Result<Module, InputError> {
        let place = |error: &ParseError| -> Vec<Span> { error.labels().map(|(span, _)| span).collect() };
        parse_str(self.text)
            .map_err(|error| self.refused(place(&error).into_iter(), error.message().to_owned()))
    }

    /// Validates the parsed module.
    ///
    /// # Errors
    /// [`InputError`] for an invalid module, with a path as in [`CallerText::parsed`].
    pub fn validated(&self, module: &Module) -> Result<ModuleInfo, InputError> {
        let mut validator = Validator::new(ValidationFlags::all(), Capabilities::default());
        validator.validate(module).map_err(|error| {
            // naga reports the span of a function and of a position inside it. The shortest span is the most exact.
            let mut spans: Vec<Span> = error.spans().map(|(span, _)| *span).collect();
            spans.sort_by_key(|span| span.to_range().map_or(usize::MAX, |range| range.len()));
            self.refused(spans.into_iter(), chain(error.as_inner()))
        })
    }

    /// Whether a span starts in the caller's text.
    pub fn is_in(&self, at: &Span) -> bool {
        at.to_range().is_some_and(|range| range.start < self.source.len())
    }

    /// An error with the message `bound`, located at the first of `spans` that starts in the caller's text. If none does,
    /// the error is located at the end of the caller's text.
    pub fn refused(&self, spans: impl Iterator<Item = Span>, bound: String) -> InputError {
        let mut ranges = spans.filter_map(Span::to_range);
        let range = ranges.find(|range| range.start < self.source.len());
        let range = range.unwrap_or(self.source.len()..self.source.len());
        let before = &self.text[..range.start];
        let line = before.matches('\n').count() + 1;
        let column = before.rsplit('\n').next().map_or(0, |text| text.chars().count()) + 1;
        let quoted = self.text[range.start..range.end.min(self.source.len())].lines().next();
        let value: String = quoted.unwrap_or_default().chars().take(60).collect();
        InputError::new(format!("{}:{line}:{column}", self.path), value, bound)
    }

    /// Checks the parsed text of a caller-defined kind or output. It must not have entry points, override
    /// constants, discard statements or workgroup memory.
    ///
    /// # Errors
    /// [`InputError`] for the first violation.
    pub fn check(&self, module: &Module) -> Result<(), InputError> {
        let refuse = |at: Span, bound: &str| Err(self.refused(std::iter::once(at), bound.to_owned()));
        if let Some(entry) = module.entry_points.iter().find(|entry| !entry.name.starts_with(PREFIX)) {
            let at = self.source.find(&entry.name).unwrap_or(0);
            return refuse(
                span(at..at + entry.name.len()),
                "must not be an entry point: these are generated",
            );
        }
        for (handle, _) in module.overrides.iter() {
            let at = module.overrides.get_span(handle);
            if self.is_in(&at) {
                return refuse(at, "must not be an override constant");
            }
        }
        for (handle, variable) in module.global_variables.iter() {
            let at = module.global_variables.get_span(handle);
            if self.is_in(&at) && variable.space == naga::AddressSpace::WorkGroup {
                return refuse(at, "must not lie in workgroup memory, which these stages do not have");
            }
        }
        for (handle, function) in module.functions.iter() {
            if let Some(at) = discard_in(&function.body)
                && self.is_in(&module.functions.get_span(handle))
            {
                return refuse(
                    at,
                    "must not discard: parts that are cut out leave out pixels (KindPart::cut_out)",
                );
            }
        }
        Ok(())
    }

    /// Checks that every declared name starts with `name` and is longer than it. Case and underscores do not matter: for
    /// `grass`, the names `grass_bend`, `GRASS_HEIGHT` and `GrassBlade` pass. Also checks that the text has no
    /// directives, because it is combined with other texts.
    ///
    /// # Errors
    /// [`InputError`] for the first violation.
    pub fn check_declarations(&self, name: &str) -> Result<(), InputError> {
        let code = without_comments(self.source);
        let plain = |text: &str| text.replace('_', "").to_lowercase();
        for range in declarations(&code) {
            let declared = &code[range.clone()];
            let is_own =
                plain(declared).len() > plain(name).len() && plain(declared).starts_with(&plain(name));
            if !is_own || declared.starts_with(PREFIX) {
                let bound = format!("must begin with `{name}`, as every name that the text declares");
                return Err(self.refused(std::iter::once(span(range)), bound));
            }
        }
        for directive in ["enable", "requires", "diagnostic"] {
            let begins = code.trim_start().strip_prefix(directive);
            if begins.is_some_and(|rest| !rest.starts_with(|c: char| c.is_alphanumeric() || c == '_')) {
                let at = code.len() - code.trim_start().len();
                let bound = "must not begin with a directive, since the text stands beside others";
                return Err(self.refused(std::iter::once(span(at..at + directive.len())), bound.to_owned()));
            }
        }
        Ok(())
    }

    /// Checks that no name starts with [`PREFIX`], which is reserved for the crate. The check scans the text, because naga
    /// drops unused constants and aliases.
    pub fn check_names(&self) -> Result<(), InputError> {
        let is_part = |letter: char| letter.is_alphanumeric() || letter == '_';
        let code = without_comments(self.source);
        let begins = |(at, _): &(usize, &str)| !code[..*at].ends_with(is_part);
        let Some((at, _)) = code.match_indices(PREFIX).find(begins) else { return Ok(()) };
        let length = code[at..].find(|letter| !is_part(letter)).unwrap_or(code.len() - at);
        Err(self.refused([span(at..at + length)].into_iter(), OURS.to_owned()))
    }
}

const OURS: &str = "must not begin with `relievo_`, as the crate's own names do";

/// The message of an error, followed by the messages of its causes, separated by colons.
fn chain(error: &dyn std::error::Error) -> String {
    let causes = std::iter::successors(Some(error), |error| error.source());
    causes.map(ToString::to_string).collect::<Vec<_>>().join(": ")
}

fn span(range: std::ops::Range<usize>) -> Span {
    Span::new(range.start as u32, range.end as u32)
}

/// The WGSL text with its comments replaced by spaces. All other bytes keep their offsets, and all lines keep their
/// numbers. The text must be valid.
pub(crate) fn without_comments(source: &str) -> String {
    let (mut code, mut rest) = (String::with_capacity(source.len()), source);
    while let Some(at) = rest.find("//").into_iter().chain(rest.find("/*")).min() {
        let (before, comment) = rest.split_at(at);
        let length = match comment.starts_with("//") {
            true => comment.find(LINE_ENDS).unwrap_or(comment.len()),
            false => block_comment(comment),
        };
        code.push_str(before);
        code.extend(comment[..length].bytes().map(|byte| if byte == b'\n' { '\n' } else { ' ' }));
        rest = &comment[length..];
    }
    code + rest
}

/// Characters that end a line comment.
const LINE_ENDS: &[char] = &['\n', '\r', '\u{b}', '\u{c}', '\u{85}', '\u{2028}', '\u{2029}'];

/// Length in bytes of the block comment at the start of `text`. Block comments nest.
fn block_comment(text: &str) -> usize {
    let (mut depth, mut at) = (0, 0);
    while let Some(mark) = text[at..].find("/*").into_iter().chain(text[at..].find("*/")).min() {
        depth += if text[at + mark..].starts_with("/*") { 1 } else { -1 };
        at += mark + 2;
        if depth == 0 {
            return at;
        }
    }
    text.len()
}

/// The span of the first discard statement in a block, nested blocks included; `None` if there is none.
pub(crate) fn discard_in(block: &Block) -> Option<Span> {
    block.span_iter().find_map(|(statement, span)| match statement {
        Statement::Kill => Some(*span),
        Statement::Block(block) => discard_in(block),
        Statement::If { accept, reject, .. } => discard_in(accept).or_else(|| discard_in(reject)),
        Statement::Switch { cases, .. } => cases.iter().find_map(|case| discard_in(&case.body)),
        Statement::Loop { body, continuing, .. } => discard_in(body).or_else(|| discard_in(continuing)),
        _ => None,
    })
}
