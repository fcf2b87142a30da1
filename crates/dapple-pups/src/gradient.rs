//! Computes the gradient of a texture in closed form.
//!
//! With `W = Π A(u_r)` over the axes `r`, the gradient of a weight is `∇W = Σ_r A'(u_r) ∇u_r Π_{s≠r} A(u_s)`. Here
//! `∇u_r = −a_r` inside `[0, 1]`, and zero where the projection is clamped (`A'` is zero there anyway). With an
//! orientation, `w' = w^e`, so `∇w' = e w^(e−1) ∇w + w' ln w ∇e`. For an axis that fades, `∇A^e = e A^(e−1) ∇A`. For
//! equation 3, `∇T = Σ (T_i − T) ∇W_i / Σ W_i`.
//!
//! The gradient is computed in double precision, for one position at a time.

use crate::net::{AxisBlock, BLOCK, Instance, Net};
use crate::pups::LEAST_TOTAL;
use crate::{AxialWeight, Texture};
use dapple_raster::{FieldExt as _, Raster, RasterError, Window};
use glam::DVec2;

impl Texture {
    /// Returns the gradient of the value at `position`, per unit of x and of y.
    ///
    /// With orientations of strength ½ or more, the texture is not differentiable at the border of a support. There the
    /// result is the gradient of the side on which the weight is zero. At a position that is not finite, both
    /// components are NaN.
    ///
    /// # Examples
    ///
    /// ```
    /// use dapple_pups::{Pups, points::{Domain, white_noise}, hash::Seed, glam::DVec2};
    ///
    /// let points = white_noise(Domain::paper_torus(), 50, Seed(1))?;
    /// let texture = Pups::delaunay(&points)?.texture(vec![0.5; 50])?;
    /// assert_eq!(texture.gradient(DVec2::new(0.3, 0.1)), DVec2::ZERO);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    #[must_use]
    pub fn gradient(&self, position: impl Into<[f64; 2]>) -> DVec2 {
        self.gradient_at(position.into())
    }

    fn gradient_at(&self, position: [f64; 2]) -> DVec2 {
        let Some(local) = self.pups().local(position.into()) else {
            return DVec2::NAN;
        };
        let net = &self.pups().net;
        let value = f64::from(self.sample(position));
        let instances = &net.bins().instances;
        let values = self.values();
        // Sum the weights W_i, and (T_i − T) ∇W_i.
        let add = |(total, sum): (f64, DVec2), record: usize, weight: f32| {
            if weight == 0.0 {
                return (total, sum);
            }
            let instance = &net.instances[instances[record] as usize];
            // Recompute the weight in double precision, together with its gradient.
            let (weight, gradient) = weight_and_gradient(net, instance, local);
            // Equation 3, differentiated: ∇T = Σ (T_i − T) ∇W_i / Σ W_i.
            let rise = f64::from(values[instance.point as usize]) - value;
            (total + weight, sum + gradient * rise)
        };
        let (total, sum) = net.fold_weights(local, (0.0, DVec2::ZERO), add);
        // If all weights underflow, the texture has the nearest control point's value, which is locally constant.
        if total < f64::from(LEAST_TOTAL) {
            DVec2::ZERO
        } else {
            sum / total
        }
    }

    /// Renders the gradients at the pixel centers of a window, for example for normal maps.
    ///
    /// # Errors
    ///
    /// [`Empty`](dapple_raster::RasterErrorKind::Empty) or [`TooLarge`](dapple_raster::RasterErrorKind::TooLarge) if
    /// the size of the window is invalid.
    pub fn gradient_raster(&self, window: &Window) -> Result<Raster<[f32; 2]>, RasterError> {
        Raster::from_window(window, |position| {
            self.gradient(position).as_vec2().to_array()
        })
    }
}

/// Returns an instance's weight and the gradient of that weight.
fn weight_and_gradient(net: &Net, instance: &Instance, position: DVec2) -> (f64, DVec2) {
    let offset = position - instance.center;
    let mut weight = 1.0;
    let mut gradient = DVec2::ZERO;
    for (index, block) in net.blocks(instance).iter().enumerate() {
        let exponents = net.exponents(instance).get(index);
        for slot in 0..BLOCK {
            // A_r and its gradient (equation 1), with fading if the axis fades.
            let axial = axial(net.options.weight, block, slot, offset);
            let (value, slope) = match exponents.map(|exponents| exponents[slot]) {
                Some(exponent) if exponent < 1.0 => faded(axial, exponent.into()),
                _ => axial,
            };
            // Product rule: ∇(W A_r) = A_r ∇W + W ∇A_r.
            gradient = gradient * value + slope * weight;
            weight *= value;
        }
    }
    // Apply equation 4 if there are orientations.
    match net.shifts.get(instance.point as usize) {
        Some(&shift) => shifted(weight, gradient, DVec2::from(shift.map(f64::from)), offset),
        None => (weight, gradient),
    }
}

/// Returns the axial weight of an axis at an offset from the control point, and its gradient.
fn axial(weight: AxialWeight, block: &AxisBlock, slot: usize, offset: DVec2) -> (f64, DVec2) {
    let axis = DVec2::new(f64::from(block.x[slot]), f64::from(block.y[slot]));
    let u = (1.0 - axis.dot(offset)).clamp(0.0, 1.0);
    // Chain rule with ∇u = −a.
    (weight.value(u), axis * -weight.slope(u))
}

/// Applies fading to an axial weight and its gradient.
fn faded((value, slope): (f64, DVec2), exponent: f64) -> (f64, DVec2) {
    if value <= 0.0 {
        return (0.0, DVec2::ZERO);
    }
    // ∇A^e = e A^(e−1) ∇A.
    let faded = libm::pow(value, exponent);
    (faded, slope * (exponent * faded / value))
}

/// Applies an orientation (equation 4) to a weight and its gradient.
fn shifted(weight: f64, gradient: DVec2, shift: DVec2, offset: DVec2) -> (f64, DVec2) {
    let distance = offset.length();
    // The weight is unchanged where it is zero, and at the control point, where the angle is undefined.
    if distance == 0.0 || weight <= 0.0 {
        return (weight, gradient);
    }
    let direction = offset / distance;
    let k = shift.dot(direction);
    // The gradient of K: the component of the shift orthogonal to the direction, divided by the distance.
    let k_slope = (shift - direction * k) / distance;
    // Exponent e of equation 4 and its gradient, by the sign of K.
    let (exponent, slope) = if k >= 0.0 {
        (1.0 - k, -k_slope)
    } else {
        (1.0 / (1.0 + k), -k_slope / ((1.0 + k) * (1.0 + k)))
    };
    let shifted = libm::pow(weight, exponent);
    // ∇w' = e w^(e−1) ∇w + w' ln w ∇e.
    (
        shifted,
        gradient * (exponent * shifted / weight) + slope * (shifted * libm::log(weight)),
    )
}
