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

/// Adaptive frequencies of the symbols of one alphabet, at most 256. Every symbol keeps a probability above 0.
#[derive(Debug, Clone)]
pub(super) struct Frequencies {
    /// Cumulative probability below each symbol, in 1/[`WHOLE`]. The first is 0.
    below: Vec<u16>,
    seen: u32,
}

impl Frequencies {
    /// Equal frequencies of `symbols` symbols.
    pub fn new(symbols: usize) -> Self {
        let below = (0..symbols).map(|symbol| (symbol * WHOLE as usize / symbols) as u16);
        Self { below: below.collect(), seen: 0 }
    }

    /// Cumulative probability below a symbol, in 1/[`WHOLE`].
    fn cumulative(&self, symbol: usize) -> u32 {
        self.below.get(symbol).map_or(WHOLE, |below| u32::from(*below))
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
        // A cumulative probability stays between these bounds, so that each symbol keeps 1/`WHOLE`.
        let most = (WHOLE as usize - self.below.len()) as u16;
        let (at_most, above) = self.below.split_at_mut(symbol + 1);
        (0_u16..).zip(at_most).for_each(|(least, below)| *below -= (*below - least) >> rate);
        let first = symbol as u16 + 1;
        (first..).zip(above).for_each(|(least, below)| *below += (most + least - *below) >> rate);
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
        // Sums of 16 bits are added for several symbols at once.
        let quantile = quantile as u16;
        let symbol: u16 = self.below[1..].iter().map(|below| u16::from(*below <= quantile)).sum();
        let symbol = usize::from(symbol);
        let from = self.cumulative(symbol);
        let size = self.cumulative(symbol + 1) - from;
        (symbol, from, NonZeroU32::MIN.saturating_add(size - 1))
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

/// A writer. Symbols and bits are two streams: bits need no arithmetic.
pub(super) struct Writer {
    symbols: DefaultRangeEncoder,
    bits: Vec<u8>,
    /// Number of bits.
    count: usize,
}

/// Number of bytes of the length of the symbols.
const LENGTH: usize = 4;

impl Writer {
    pub fn new() -> Self {
        Self { symbols: DefaultRangeEncoder::new(), bits: Vec::new(), count: 0 }
    }

    /// The bytes of all symbols and bits: the length of the symbols, the symbols, the bits. A reader appends zeros.
    pub fn finish(self) -> Vec<u8> {
        let words = self.symbols.into_compressed().unwrap_or_else(|never| match never {});
        let symbols: Vec<u8> = words.iter().flat_map(|word| word.to_be_bytes()).collect();
        let length = symbols.len() - symbols.iter().rev().take_while(|byte| **byte == 0).count();
        [&(length as u32).to_le_bytes(), &symbols[..length], &self.bits].concat()
    }
}

impl Coder for Writer {
    fn symbol(&mut self, frequencies: &mut Frequencies, symbol: usize) -> Result<usize, InputError> {
        self.symbols.encode_symbol(symbol, &*frequencies).map_err(|_| damaged())?;
        frequencies.adapt(symbol);
        Ok(symbol)
    }

    fn bits(&mut self, bits: u32, value: u64) -> Result<u64, InputError> {
        for bit in 0..bits {
            let place = self.count % 8;
            if place == 0 {
                self.bits.push(0);
            }
            if let Some(last) = self.bits.last_mut() {
                *last |= ((value >> bit & 1) as u8) << place;
            }
            self.count += 1;
        }
        Ok(value)
    }
}

/// A reader of the bytes of one [`Writer`].
pub(super) struct Reader<'a> {
    symbols: DefaultRangeDecoder,
    bits: &'a [u8],
    /// Number of bits that were read.
    count: usize,
}

impl<'a> Reader<'a> {
    /// # Errors
    /// [`InputError`] for a length of symbols that exceeds the bytes.
    pub fn new(bytes: &'a [u8]) -> Result<Self, InputError> {
        let (length, rest) = bytes.split_first_chunk::<LENGTH>().ok_or_else(damaged)?;
        let length = u32::from_le_bytes(*length) as usize;
        let (symbols, bits) = rest.split_at_checked(length).ok_or_else(damaged)?;
        let word = |bytes: &[u8]| {
            let mut word = [0; 4];
            word[..bytes.len()].copy_from_slice(bytes);
            u32::from_be_bytes(word)
        };
        let words: Vec<u32> = symbols.chunks(4).map(word).collect();
        let symbols = DefaultRangeDecoder::from_compressed(words).unwrap_or_else(|never| match never {});
        Ok(Self { symbols, bits, count: 0 })
    }

    /// Reads up to 56 bits.
    fn few(&mut self, bits: u32) -> u64 {
        let mut word = [0; 8];
        let rest = self.bits.get(self.count / 8..).unwrap_or_default();
        match rest.first_chunk() {
            Some(whole) => word = *whole,
            None => word[..rest.len()].copy_from_slice(rest),
        }
        let value = u64::from_le_bytes(word) >> (self.count % 8) & ((1 << bits) - 1);
        self.count = self.count.saturating_add(bits as usize);
        value
    }
}

impl Coder for Reader<'_> {
    fn symbol(&mut self, frequencies: &mut Frequencies, _: usize) -> Result<usize, InputError> {
        let symbol = self.symbols.decode_symbol(&*frequencies).map_err(|_| damaged())?;
        frequencies.adapt(symbol);
        Ok(symbol)
    }

    fn bits(&mut self, bits: u32, _: u64) -> Result<u64, InputError> {
        let low = self.few(bits.min(32));
        Ok(if bits > 32 { low | self.few(bits - 32) << 32 } else { low })
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
        let mut reader = Reader::new(&bytes).expect("a length");
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
