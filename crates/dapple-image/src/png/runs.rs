//! Deflate of bytes that are nearly noise: each byte has a code of its frequency, and runs of one byte are matches.
//!
//! The format is RFC 1951 (P. Deutsch, 1996). In filtered rows of 16 bits half of the bytes are close to noise, where a
//! search for earlier matches finds next to nothing, while flat parts are runs of one byte. So there is no search, and
//! a match is always with the byte before. The lengths of codes are those of D. A. Huffman, "A Method for the
//! Construction of Minimum-Redundancy Codes", Proceedings of the IRE, 1952; where one would be too long, the
//! frequencies are made more alike.

/// The number of bytes with a code of their own frequencies.
const BLOCK: usize = 1 << 16;

/// The symbols of bytes, of the end of a block, and of lengths of matches.
const SYMBOLS: usize = 286;

/// The symbol of the end of a block.
const END: usize = 256;

/// The longest code in bits: the format allows 15, and four codes of 14 fit into a word beside seven bits.
const LONGEST: u32 = 14;

/// The length of the longest match.
const LONGEST_RUN: usize = 258;

/// The number of bytes that are looked at together: a shorter run is no match.
const STEP: usize = 8;

/// Compressed bytes of a part of a stream: blocks that are not the last, up to a whole byte.
pub(super) fn deflated(bytes: &[u8]) -> Vec<u8> {
    // A block takes no more than two bytes for each of its own, its codes, and a word that is written ahead.
    let mut out = Bits::new(2 * bytes.len() + 256 * (bytes.len() / BLOCK + 2));
    for first in (0..bytes.len()).step_by(BLOCK) {
        let end = bytes.len().min(first + BLOCK);
        let mut counts = Counts::new();
        walk(bytes, first..end, &mut counts);
        let codes = Codes::new(counts.all());
        codes.write(&mut out);
        walk(
            bytes,
            first..end,
            &mut Writer {
                codes: &codes,
                out: &mut out,
            },
        );
        out.put(codes.symbols[END]);
    }
    out.align()
}

/// A consumer of single bytes and runs: counts the symbols, or writes their codes.
trait Sink {
    fn literals(&mut self, bytes: [u8; STEP / 2]);
    fn literal(&mut self, byte: u8);
    /// A run of 3 to [`LONGEST_RUN`] bytes that are equal to the one before it.
    fn run(&mut self, length: usize);
}

/// Divides a range of bytes into single ones and runs.
#[inline(always)]
fn walk(bytes: &[u8], range: core::ops::Range<usize>, sink: &mut impl Sink) {
    let (mut at, end) = (range.start, range.end);
    while let Some(next) = bytes[at..end].first_chunk::<STEP>() {
        let before = if at > 0 { bytes[at - 1] } else { !next[0] };
        if *next == [before; STEP] {
            let most = &bytes[at..end.min(at + LONGEST_RUN)];
            let length = most.iter().take_while(|&&byte| byte == before).count();
            sink.run(length);
            at += length;
        } else {
            let [a, b, c, d, ..] = *next;
            sink.literals([a, b, c, d]);
            at += STEP / 2;
        }
    }
    bytes[at..end].iter().for_each(|&byte| sink.literal(byte));
}

/// The symbol of a length, its further bits, and their number.
fn symbol(length: usize) -> (usize, u32, u32) {
    if length == LONGEST_RUN {
        return (285, 0, 0);
    }
    let rest = length as u32 - 3;
    let extra = rest.max(4).ilog2() - 2;
    let symbol = 257 + 4 * extra + (rest >> extra);
    (symbol as usize, rest & ((1 << extra) - 1), extra)
}

/// The frequencies of the symbols of a block. Four neighboring bytes are counted apart, so that none waits for another.
struct Counts {
    bytes: [[u32; 256]; STEP / 2],
    lengths: [u32; SYMBOLS],
}

impl Counts {
    fn new() -> Self {
        Self {
            bytes: [[0; 256]; STEP / 2],
            lengths: [0; SYMBOLS],
        }
    }

    fn all(self) -> [u32; SYMBOLS] {
        let mut counts = self.lengths;
        for part in self.bytes {
            counts
                .iter_mut()
                .zip(part)
                .for_each(|(count, more)| *count += more);
        }
        counts[END] = 1;
        counts
    }
}

impl Sink for Counts {
    #[inline(always)]
    fn literals(&mut self, bytes: [u8; STEP / 2]) {
        for (counts, byte) in self.bytes.iter_mut().zip(bytes) {
            counts[usize::from(byte)] += 1;
        }
    }

    #[inline(always)]
    fn literal(&mut self, byte: u8) {
        self.bytes[0][usize::from(byte)] += 1;
    }

    #[inline(always)]
    fn run(&mut self, length: usize) {
        self.lengths[symbol(length).0] += 1;
    }
}

/// The code of a symbol, its first bit lowest, and its number of bits.
#[derive(Clone, Copy, Default)]
struct Code {
    bits: u32,
    length: u32,
}

/// The codes of a block.
struct Codes {
    symbols: [Code; SYMBOLS],
}

impl Codes {
    fn new(mut counts: [u32; SYMBOLS]) -> Self {
        let mut lengths = code_lengths(&counts);
        while lengths.iter().any(|&length| length > LONGEST) {
            counts
                .iter_mut()
                .for_each(|count| *count = count.div_ceil(2));
            lengths = code_lengths(&counts);
        }
        // Codes ascend with their length, and with the symbol where lengths are equal.
        let mut symbols = [Code::default(); SYMBOLS];
        let mut code = 0;
        for length in 1..=LONGEST {
            for (symbol, _) in symbols
                .iter_mut()
                .zip(lengths)
                .filter(|(_, own)| *own == length)
            {
                let bits = u32::reverse_bits(code) >> (32 - length);
                *symbol = Code { bits, length };
                code += 1;
            }
            code <<= 1;
        }
        Self { symbols }
    }

    /// Writes the beginning of a block: that its codes follow, and their lengths.
    ///
    /// Lengths are written with 4 bits each, which is a code of its own with 16 symbols of one length.
    fn write(&self, out: &mut Bits) {
        const ORDER: [u32; 19] = [
            16, 17, 18, 0, 8, 7, 9, 6, 10, 5, 11, 4, 12, 3, 13, 2, 14, 1, 15,
        ];
        let plain = |bits: u32, length: u32| Code { bits, length };
        out.put(plain(0b100, 3));
        out.put(plain(SYMBOLS as u32 - 257, 5));
        // A single code of distances, of one bit.
        out.put(plain(0, 5));
        out.put(plain(ORDER.len() as u32 - 4, 4));
        ORDER
            .iter()
            .for_each(|&of| out.put(plain(if of < 16 { 4 } else { 0 }, 3)));
        let lengths = self.symbols.iter().map(|code| code.length).chain([1]);
        lengths.for_each(|length| out.put(plain(length.reverse_bits() >> 28, 4)));
    }
}

/// The lengths of the codes of least length in all, for at least two symbols with a count; 0 for those without.
fn code_lengths(counts: &[u32; SYMBOLS]) -> [u32; SYMBOLS] {
    let used = counts
        .iter()
        .copied()
        .zip(0..)
        .filter(|&(count, _)| count > 0);
    let mut leaves: Vec<(u32, usize)> = used.collect();
    leaves.sort_unstable();
    // The nodes of the tree: its leaves, and then the pairs of the two least, which come in the order of their counts.
    let n_leaves = leaves.len();
    let mut nodes: Vec<u32> = leaves.iter().map(|&(count, _)| count).collect();
    let mut parents = vec![0; 2 * n_leaves - 1];
    let (mut leaf, mut pair) = (0, n_leaves);
    for parent in n_leaves..parents.len() {
        let mut sum = 0;
        for _ in 0..2 {
            let is_leaf = leaf < n_leaves && (pair == parent || nodes[leaf] <= nodes[pair]);
            let least = if is_leaf { &mut leaf } else { &mut pair };
            parents[*least] = parent;
            sum += nodes[*least];
            *least += 1;
        }
        nodes.push(sum);
    }
    let mut depths = vec![0; parents.len()];
    for node in (0..parents.len() - 1).rev() {
        depths[node] = depths[parents[node]] + 1;
    }
    let mut lengths = [0; SYMBOLS];
    leaves
        .iter()
        .zip(depths)
        .for_each(|(&(_, symbol), depth)| lengths[symbol] = depth);
    lengths
}

/// Writes the codes of bytes and runs.
struct Writer<'a> {
    codes: &'a Codes,
    out: &'a mut Bits,
}

impl Sink for Writer<'_> {
    #[inline(always)]
    fn literals(&mut self, bytes: [u8; STEP / 2]) {
        for byte in bytes {
            self.out.add(self.codes.symbols[usize::from(byte)]);
        }
        self.out.flush();
    }

    #[inline(always)]
    fn literal(&mut self, byte: u8) {
        self.out.put(self.codes.symbols[usize::from(byte)]);
    }

    #[inline(always)]
    fn run(&mut self, length: usize) {
        let (symbol, bits, length) = symbol(length);
        self.out.add(self.codes.symbols[symbol]);
        self.out.add(Code { bits, length });
        // The distance, always 1.
        self.out.put(Code { bits: 0, length: 1 });
    }
}

/// Bits that are written into bytes, from the lowest to the highest.
struct Bits {
    bytes: Vec<u8>,
    /// The number of bytes that are done.
    n_bytes: usize,
    word: u64,
    n_bits: u32,
}

impl Bits {
    /// Bits in at most `limit` bytes.
    fn new(limit: usize) -> Self {
        Self {
            bytes: vec![0; limit],
            n_bytes: 0,
            word: 0,
            n_bits: 0,
        }
    }

    /// Adds bits to the word; it holds 64 with the up to 7 that are in it after each flush.
    #[inline(always)]
    fn add(&mut self, code: Code) {
        self.word |= u64::from(code.bits) << self.n_bits;
        self.n_bits += code.length;
    }

    /// Writes the whole bytes of the word.
    #[inline(always)]
    fn flush(&mut self) {
        self.bytes[self.n_bytes..][..8].copy_from_slice(&self.word.to_le_bytes());
        let n_whole = self.n_bits / 8;
        self.n_bytes += n_whole as usize;
        self.word >>= 8 * n_whole;
        self.n_bits %= 8;
    }

    #[inline(always)]
    fn put(&mut self, code: Code) {
        self.add(code);
        self.flush();
    }

    /// All bytes, with an empty block at their end that fills up the last one.
    fn align(mut self) -> Vec<u8> {
        self.put(Code { bits: 0, length: 3 });
        let n_bytes = self.n_bytes + usize::from(self.n_bits > 0);
        self.bytes.truncate(n_bytes);
        self.bytes.extend([0, 0, 0xff, 0xff]);
        self.bytes
    }
}
