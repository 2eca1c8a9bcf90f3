//! Entropy coding of symbols and numbers with adaptive frequencies. A range coder of the crate `constriction` turns frequencies
//! into bytes.
//!
//! The same code writes and reads: a [`Coder`] gets each symbol, and returns it. A writer returns its argument. A reader
//! ignores the argument and returns what it has read.

use std::borrow::Borrow;
use std::num::NonZeroU32;

use constriction::stream::model::{DecoderModel, EncoderModel, EntropyModel};
use constriction::stream::queue::{DefaultRangeDecoder, DefaultRangeEncoder};
use constriction::stream::{Decode as _, Encode as _};

use crate::InputError;

/// Number of bits of a probability.
const PRECISION: usize = 16;

/// The sum of all probabilities.
const WHOLE: u32 = 1 << PRECISION;

/// Number of bits of an adaptive cumulative frequency.
const ADAPTED: u32 = 15;

/// Adaptive frequencies of the symbols of one alphabet, at most 256. Every symbol keeps a probability above 0.
#[derive(Debug, Clone)]
pub(super) struct Frequencies {
    /// Cumulative frequencies below each symbol, in 1/2¹⁵. The first is 0.
    below: Vec<u16>,
    seen: u32,
}

impl Frequencies {
    /// Equal frequencies of `symbols` symbols.
    pub fn new(symbols: usize) -> Self {
        let below = (0..symbols).map(|symbol| (symbol << ADAPTED).div_euclid(symbols) as u16);
        Self { below: below.collect(), seen: 0 }
    }

    /// Cumulative probability below a symbol, in 1/[`WHOLE`].
    fn cumulative(&self, symbol: usize) -> u32 {
        let symbols = self.below.len() as u32;
        match self.below.get(symbol) {
            Some(below) => ((u32::from(*below) * (WHOLE - symbols)) >> ADAPTED) + symbol as u32,
            None => WHOLE,
        }
    }

    /// Moves the frequencies towards a symbol that was coded; at first by larger steps.
    fn adapt(&mut self, symbol: usize) {
        let rate = match self.seen {
            0..8 => 3,
            8..32 => 4,
            32..128 => 5,
            128..512 => 6,
            _ => 7,
        };
        self.seen = self.seen.saturating_add(1);
        let (at_most, above) = self.below.split_at_mut(symbol + 1);
        at_most.iter_mut().for_each(|below| *below -= *below >> rate);
        above.iter_mut().for_each(|below| *below += ((1 << ADAPTED) - *below) >> rate);
    }
}

impl EntropyModel<PRECISION> for Frequencies {
    type Symbol = usize;
    type Probability = u32;
}

impl EncoderModel<PRECISION> for Frequencies {
    fn left_cumulative_and_probability(&self, symbol: impl Borrow<usize>) -> Option<(u32, NonZeroU32)> {
        let symbol = *symbol.borrow();
        let from = self.cumulative(symbol);
        Some((from, NonZeroU32::new(self.cumulative(symbol + 1).checked_sub(from)?)?))
    }
}

impl DecoderModel<PRECISION> for Frequencies {
    fn quantile_function(&self, quantile: u32) -> (usize, u32, NonZeroU32) {
        let (mut symbol, mut from) = (0, 0);
        loop {
            let to = self.cumulative(symbol + 1);
            if quantile < to || symbol + 1 == self.below.len() {
                return (symbol, from, NonZeroU32::MIN.saturating_add(to - from - 1));
            }
            (symbol, from) = (symbol + 1, to);
        }
    }
}

/// A number of bits, 1 to [`PRECISION`], of equal probability.
struct Even {
    bits: u32,
}

impl EntropyModel<PRECISION> for Even {
    type Symbol = u32;
    type Probability = u32;
}

impl EncoderModel<PRECISION> for Even {
    fn left_cumulative_and_probability(&self, symbol: impl Borrow<u32>) -> Option<(u32, NonZeroU32)> {
        let shift = PRECISION as u32 - self.bits;
        Some((symbol.borrow() << shift, NonZeroU32::new(1 << shift)?))
    }
}

impl DecoderModel<PRECISION> for Even {
    fn quantile_function(&self, quantile: u32) -> (u32, u32, NonZeroU32) {
        let shift = PRECISION as u32 - self.bits;
        let symbol = quantile >> shift;
        (symbol, symbol << shift, NonZeroU32::MIN.saturating_add((1 << shift) - 1))
    }
}

/// Writes or reads symbols.
pub(super) trait Coder {
    /// Codes a symbol, and adapts its frequencies.
    ///
    /// # Errors
    /// When reading: [`InputError`] for bytes that no writer makes.
    fn symbol(&mut self, frequencies: &mut Frequencies, symbol: usize) -> Result<usize, InputError>;

    /// Codes the lowest `bits` bits of a value, 0 to 64.
    ///
    /// # Errors
    /// As [`Coder::symbol`].
    fn bits(&mut self, bits: u32, value: u64) -> Result<u64, InputError>;

    /// Codes a number below `count`, without frequencies.
    ///
    /// # Errors
    /// As [`Coder::symbol`], and [`InputError`] for a number that is not below `count`.
    fn below(&mut self, count: usize, number: usize) -> Result<usize, InputError> {
        let bits = usize::BITS - count.saturating_sub(1).leading_zeros();
        let number = self.bits(bits, number as u64)?;
        usize::try_from(number).ok().filter(|number| *number < count).ok_or_else(damaged)
    }
}

/// The error for a chunk that no writer makes.
pub(super) fn damaged() -> InputError {
    InputError::new("levels", "damaged", "must be a chunk that this format can have")
}

/// A writer of symbols.
pub(super) struct Writer(DefaultRangeEncoder);

impl Writer {
    pub fn new() -> Self {
        Self(DefaultRangeEncoder::new())
    }

    /// The bytes of all symbols.
    pub fn finish(self) -> Vec<u8> {
        let words = self.0.into_compressed().unwrap_or_else(|never| match never {});
        let mut bytes: Vec<u8> = words.iter().flat_map(|word| word.to_be_bytes()).collect();
        // A reader appends zeros.
        while bytes.last() == Some(&0) {
            bytes.pop();
        }
        bytes
    }
}

impl Coder for Writer {
    fn symbol(&mut self, frequencies: &mut Frequencies, symbol: usize) -> Result<usize, InputError> {
        self.0.encode_symbol(symbol, &*frequencies).map_err(|_| damaged())?;
        frequencies.adapt(symbol);
        Ok(symbol)
    }

    fn bits(&mut self, bits: u32, value: u64) -> Result<u64, InputError> {
        let mut left = bits;
        while left > 0 {
            let some = left.min(PRECISION as u32);
            left -= some;
            let part = (value >> left) as u32 & (WHOLE - 1) >> (PRECISION as u32 - some);
            self.0.encode_symbol(part, Even { bits: some }).map_err(|_| damaged())?;
        }
        Ok(value)
    }
}

/// A reader of symbols.
pub(super) struct Reader(DefaultRangeDecoder);

impl Reader {
    /// A reader of the bytes of one [`Writer`].
    pub fn new(bytes: &[u8]) -> Self {
        let word = |bytes: &[u8]| {
            let mut word = [0; 4];
            word[..bytes.len()].copy_from_slice(bytes);
            u32::from_be_bytes(word)
        };
        let words: Vec<u32> = bytes.chunks(4).map(word).collect();
        Self(DefaultRangeDecoder::from_compressed(words).unwrap_or_else(|never| match never {}))
    }
}

impl Coder for Reader {
    fn symbol(&mut self, frequencies: &mut Frequencies, _: usize) -> Result<usize, InputError> {
        let symbol = self.0.decode_symbol(&*frequencies).map_err(|_| damaged())?;
        frequencies.adapt(symbol);
        Ok(symbol)
    }

    fn bits(&mut self, bits: u32, _: u64) -> Result<u64, InputError> {
        let (mut left, mut value) = (bits, 0);
        while left > 0 {
            let some = left.min(PRECISION as u32);
            left -= some;
            let part = self.0.decode_symbol(Even { bits: some }).map_err(|_| damaged())?;
            value |= u64::from(part) << left;
        }
        Ok(value)
    }
}

/// Magnitudes from here on are coded without frequencies.
const LARGE: u64 = 1 << 20;

/// Number of classes of magnitudes: 0 to 3, two classes for each further octave below [`LARGE`], and the rest.
const CLASSES: usize = 4 + 2 * 18 + 1;

/// Number of bits of a magnitude of at least [`LARGE`]: differences of 32-bit numbers.
const LARGE_BITS: u32 = 34;

/// Adaptive frequencies of whole numbers that are mostly small: residuals of predictions.
#[derive(Debug, Clone)]
pub(super) struct Numbers {
    classes: Frequencies,
}

impl Numbers {
    pub fn new() -> Self {
        Self { classes: Frequencies::new(CLASSES) }
    }

    /// Codes a number whose magnitude is below 2³⁴.
    ///
    /// # Errors
    /// As [`Coder::symbol`].
    pub fn code(&mut self, coder: &mut impl Coder, number: i64) -> Result<i64, InputError> {
        let magnitude = number.unsigned_abs();
        let class = coder.symbol(&mut self.classes, class(magnitude))?;
        // The sign follows the low bits of the magnitude.
        let (first, bits) = match class {
            0 => return Ok(0),
            1..4 => (class as u64, 0),
            _ if class == CLASSES - 1 => (0, LARGE_BITS),
            _ => {
                let top = 2 + (class as u32 - 4) / 2;
                ((2 + (class as u64 - 4) % 2) << (top - 1), top - 1)
            }
        };
        let rest = magnitude.wrapping_sub(first) << 1 | u64::from(number < 0);
        let rest = coder.bits(bits + 1, rest)?;
        let magnitude = (first + (rest >> 1)) as i64;
        Ok(if rest & 1 == 1 { -magnitude } else { magnitude })
    }
}

/// The class of a magnitude.
fn class(magnitude: u64) -> usize {
    match magnitude {
        0..4 => magnitude as usize,
        LARGE.. => CLASSES - 1,
        _ => {
            let top = magnitude.ilog2();
            4 + 2 * (top as usize - 2) + (magnitude >> (top - 1) & 1) as usize
        }
    }
}

/// A coarse scale of a number's magnitude, 0 to 7: the context of the number that follows.
pub(super) fn scale(number: i64) -> usize {
    ((u64::BITS - number.unsigned_abs().leading_zeros()) as usize).div_ceil(2).min(7)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn symbols_and_numbers_are_read_back() {
        let numbers: Vec<i64> = (0..34).flat_map(|bit| [1_i64 << bit, -(1 << bit), (1 << bit) - 1]).collect();
        let symbols: Vec<usize> = (0..2000).map(|at| (at * at) % 7 % 5).collect();
        let code = |coder: &mut dyn FnMut(&mut Frequencies, &mut Numbers)| {
            coder(&mut Frequencies::new(5), &mut Numbers::new());
        };
        let mut writer = Writer::new();
        code(&mut |frequencies, model| {
            for number in &numbers {
                model.code(&mut writer, *number).expect("written");
            }
            for symbol in &symbols {
                writer.symbol(frequencies, *symbol).expect("written");
                writer.below(*symbol + 3, *symbol).expect("written");
            }
            writer.bits(64, u64::MAX - 5).expect("written");
        });
        let bytes = writer.finish();
        let mut reader = Reader::new(&bytes);
        code(&mut |frequencies, model| {
            for number in &numbers {
                assert_eq!(model.code(&mut reader, 0), Ok(*number));
            }
            for symbol in &symbols {
                assert_eq!(reader.symbol(frequencies, 0), Ok(*symbol));
                assert_eq!(reader.below(*symbol + 3, 0), Ok(*symbol));
            }
            assert_eq!(reader.bits(64, 0), Ok(u64::MAX - 5));
        });
    }

    #[test]
    fn a_frequent_symbol_costs_little_and_none_becomes_impossible() {
        let (mut writer, mut frequencies) = (Writer::new(), Frequencies::new(41));
        for at in 0..8000 {
            writer.symbol(&mut frequencies, if at == 7000 { 40 } else { 3 }).expect("written");
        }
        let bytes = writer.finish().len();
        assert!(bytes < 60, "{bytes}");
        let sizes = (0..41).map(|symbol| frequencies.cumulative(symbol + 1) - frequencies.cumulative(symbol));
        assert!(sizes.clone().all(|size| size > 0) && sizes.sum::<u32>() == WHOLE);
    }
}
