//! Converts the bytes of an input to numbers.

/// The remaining bytes of an input. After the last byte, zeros follow.
pub(super) struct Bytes<'a>(pub(super) &'a [u8]);

impl Bytes<'_> {
    pub(super) fn byte(&mut self) -> u8 {
        let [byte] = self.take();
        byte
    }

    /// Returns an arbitrary number. Special values, at which code may branch, are frequent.
    pub(super) fn number(&mut self) -> f64 {
        const SPECIAL: [f64; 16] = [
            0.0,
            -0.0,
            1.0,
            -1.0,
            0.5,
            2.0,
            1e-6,
            1e-12,
            1e9,
            1e300,
            f64::MIN_POSITIVE,
            f64::EPSILON,
            f64::MAX,
            f64::NAN,
            f64::INFINITY,
            f64::NEG_INFINITY,
        ];
        match self.byte() {
            kind @ 0..16 => SPECIAL[usize::from(kind)],
            16..32 => f64::from_bits(u64::from_le_bytes(self.take())),
            32..64 => f64::from(f32::from_bits(u32::from_le_bytes(self.take()))),
            64..128 => f64::from(i8::from_le_bytes(self.take())),
            128..=255 => f64::from(u16::from_le_bytes(self.take())) / 65536.0,
        }
    }

    pub(super) fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    fn take<const N: usize>(&mut self) -> [u8; N] {
        let mut taken = [0; N];
        let n = N.min(self.0.len());
        taken[..n].copy_from_slice(&self.0[..n]);
        self.0 = &self.0[n..];
        taken
    }
}
