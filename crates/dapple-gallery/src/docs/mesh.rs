//! Renders the README image for `dapple-mesh`: the models of `dapple-models`.

use super::Documented;
use super::picture::{BANNER, row};
use crate::Panel;
use crate::figures::surface::stage::lit;
use crate::figures::surface::subject::{SUBJECTS, Subject};
use dapple_color::LinearRgb;

/// Number of triangles per model, enough for a small image.
const N_TRIANGLES: usize = 3000;

pub(super) const DOCUMENTED: Documented = Documented {
    folder: "crates/dapple-mesh",
    strips: &[],
    banner: || {
        let model = |subject: &Subject| -> anyhow::Result<Panel> {
            let mesh = (subject.model)(N_TRIANGLES)?;
            let clay = |_: &_| LinearRgb::gray(0.7);
            let picture = lit(&mesh, &subject.view, [BANNER; 2], clay)?;
            Ok(Panel::color(subject.name, picture))
        };
        let models: anyhow::Result<Vec<_>> = SUBJECTS.iter().map(model).collect();
        Ok(Panel::color("", row(&models?)?))
    },
};
