//! The picture of the README of the workspace: some figures in a row.

use super::Documented;
use super::picture::{of_figures, row};
use crate::Panel;

pub(super) const DOCUMENTED: Documented = Documented {
    folder: "",
    strips: &[],
    banner: || {
        let figures = [
            ("pups-fig-02", 0),
            ("pups-fig-05", 2),
            ("pups-fig-08", 0),
            ("pups-fig-extra-colors", 0),
            ("pups-fig-14", 3),
            ("pups-fig-15", 0),
        ];
        let row = row(&of_figures(&figures, 171)?)?;
        Ok(Panel::color("", row))
    },
};
