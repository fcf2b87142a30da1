//! Packs textures of control points into 32-bit words for shaders, which read them from a data texture.

use crate::{AxialWeight, Folding, LabelTexture, Layers, Octave, Pups, PupsError, Texture};

/// A scalar texture as data for shaders: a weighted sum of layers.
#[derive(Clone, Debug)]
pub struct ShaderLayers {
    /// The layers, from the coarsest to the finest.
    pub layers: Vec<ShaderLayer>,
    /// Upper clamp of the sum of the layers. `None` for a texture without layers.
    pub maximum: Option<f32>,
}

/// A layer of a texture as data for shaders.
#[derive(Clone, Debug)]
pub struct ShaderLayer {
    /// Control points and values as words; see [`Pups::shader_words`].
    pub words: Vec<u32>,
    /// Scale factor of positions.
    pub scale: f64,
    /// Factor of the layer's values, which are first clamped to `[0, 1]`.
    pub amplitude: f32,
    /// Folding of the values.
    pub folding: Folding,
}

impl Pups {
    /// Returns the control points and their values as words of the data texture for the shaders of `dapple-wgsl`.
    ///
    /// `values` has a value for each control point. If `is_label` is set, a position has the value of its strongest
    /// point instead of the weighted mean. The module `pups_2d` documents the order of the words. 64-bit numbers have
    /// their high word first.
    ///
    /// # Errors
    ///
    /// [`Count`](crate::PupsErrorKind::Count) if the number of values is not the number of control points.
    pub fn shader_words(&self, values: &[f32], is_label: bool) -> Result<Vec<u32>, PupsError> {
        PupsError::check_count("values", values.len(), self.n_points())?;
        Ok(self.words(|point| values[point], is_label))
    }

    fn words(&self, value: impl Fn(usize) -> f32, is_label: bool) -> Vec<u32> {
        let (net, bins) = (&*self.net, self.net.bins());
        let domain = &net.domain;
        let has_orientations = !net.shifts.is_empty();
        let flags = [domain.wrap[0], domain.wrap[1], has_orientations, is_label];
        let flags = (0..).zip(flags).map(|(bit, flag)| u32::from(flag) << bit);
        let (kind, dips, depth) = match net.options.weight {
            AxialWeight::Cubic => (0, 0, 0.0),
            AxialWeight::Quintic => (1, 0, 0.0),
            AxialWeight::Oscillating { dips, depth } => (2, dips, depth),
        };
        let [columns, rows] = bins.size();
        let mut words = vec![columns, rows, kind, flags.sum()];
        for pair in [domain.origin, domain.size, bins.per_unit()] {
            words.extend(doubles(pair.to_array()));
        }
        words.extend([dips, f32::to_bits(depth), 0, 0]);
        // The candidates of all bins, and the first candidate of each bin
        let lists: Vec<_> = (0..(columns * rows) as usize)
            .map(|bin| bins.candidates_in(bin))
            .collect();
        let first = words.len() + lists.len() + 1;
        let mut start = first;
        for list in &lists {
            words.push(start as u32);
            start += list.len();
        }
        words.push(start as u32);
        // The records, each at a whole texel
        let texel = start.div_ceil(4) as u32;
        let mut records = Vec::new();
        let mut texels = Vec::new();
        for record in 0..bins.centers.len() {
            texels.push(texel + records.len() as u32 / 4);
            let point = bins.points[record] as usize;
            self.push_record(record, value(point), &mut records);
        }
        words.extend(
            lists
                .iter()
                .flatten()
                .map(|&record| texels[record as usize]),
        );
        words.resize(start.next_multiple_of(4), 0);
        words.extend(records);
        words
    }

    /// Appends the words of a record: value, shift, center and axes of a control point or image.
    fn push_record(&self, record: usize, value: f32, words: &mut Vec<u32>) {
        let (net, bins) = (&*self.net, self.net.bins());
        let instance = &net.instances[bins.instances[record] as usize];
        let (blocks, exponents) = (net.blocks(instance), net.exponents(instance));
        // Fading axes come first in their block.
        let fades = |block: usize| exponents.get(block).is_some_and(|all| all[0] < 1.0);
        let n_fading = (0..blocks.len()).filter(|&block| fades(block)).count();
        let shift = net.shifts.get(bins.points[record] as usize);
        let [x, y] = shift.copied().unwrap_or_default();
        let counts = blocks.len() as u32 | (n_fading as u32) << 16;
        words.extend([value.to_bits(), x.to_bits(), y.to_bits(), counts]);
        words.extend(doubles(bins.centers[record].to_array()));
        for (index, block) in blocks.iter().enumerate() {
            let axes = block.x.iter().chain(&block.y);
            let faded = exponents.get(index).filter(|_| fades(index));
            let numbers = axes.chain(faded.into_iter().flatten());
            words.extend(numbers.map(|number| number.to_bits()));
        }
    }
}

/// Returns two 64-bit numbers as words, each with its high word first.
fn doubles(pair: [f64; 2]) -> impl Iterator<Item = u32> {
    let words = |number: f64| [(number.to_bits() >> 32) as u32, number.to_bits() as u32];
    pair.into_iter().flat_map(words)
}

impl From<&Texture> for ShaderLayer {
    fn from(texture: &Texture) -> Self {
        Self {
            words: texture.pups().words(|point| texture.values()[point], false),
            scale: 1.0,
            amplitude: 1.0,
            folding: Folding::Plain,
        }
    }
}

impl From<&LabelTexture> for ShaderLayer {
    fn from(texture: &LabelTexture) -> Self {
        let value = |point: usize| texture.values()[texture.labels()[point] as usize];
        Self {
            words: texture.pups().words(value, true),
            scale: 1.0,
            amplitude: 1.0,
            folding: Folding::Plain,
        }
    }
}

impl From<&Octave> for ShaderLayer {
    fn from(octave: &Octave) -> Self {
        Self {
            scale: octave.scale(),
            folding: octave.folding(),
            ..octave.texture().into()
        }
    }
}

impl ShaderLayers {
    pub(crate) fn single(layer: ShaderLayer) -> Self {
        Self {
            layers: vec![layer],
            maximum: None,
        }
    }
}

impl<'a, F> From<&'a Layers<F>> for ShaderLayers
where
    ShaderLayer: From<&'a F>,
{
    fn from(sum: &'a Layers<F>) -> Self {
        let layers = sum.layers().iter().zip(sum.amplitudes());
        let layers = layers.map(|(layer, &amplitude)| ShaderLayer {
            amplitude,
            ..layer.into()
        });
        Self {
            layers: layers.collect(),
            maximum: Some(sum.maximum()),
        }
    }
}
