//! Editing a control point and redrawing the changed parts, compared with building and drawing the texture from
//! scratch.
//!
//! Edits alternate: a point moves by a fraction of the mean point spacing, a point is added, and that point is
//! removed. Confirmed: the image updated by edits has the same bits as an image rendered from scratch.

use super::{SIDE, image, window};
use crate::harness::{Bench, Done, Side};
use crate::row::{Case, Goal, Unit};
use crate::sets;
use anyhow::{Result, ensure};
use dapple_hash::{hash1, unit_f64};
use dapple_points::PointIdx;
use dapple_points::glam::DVec2;
use dapple_pups::{
    Changed, ControlPoint, ControlPoints, EditablePups, PupsError, PupsField, control_points,
};
use dapple_raster::{Raster, Window};

const EDIT_40K: Case = Case {
    group: "pups",
    case: "edit and what it changes, 40 k points",
    peer: "ours, all anew",
    unit: Unit::Ms,
    must: Goal::Faster(50.0),
    note: "points moved, added and removed in turn; the image has 1000×1000 pixels",
};

const EDIT_700: Case = Case {
    case: "edit and what it changes, 700 points",
    must: Goal::Faster(5.0),
    ..EDIT_40K
};

pub(super) fn run(bench: &mut Bench) -> Result<()> {
    edits(bench, &EDIT_40K, 40_000)?;
    edits(bench, &EDIT_700, 700)
}

/// A texture that is being edited, and its image.
struct Edited {
    pups: EditablePups,
    window: Window,
    image: Raster<f32>,
    n_edits: i64,
}

impl Edited {
    fn new(n_points: u32) -> Result<Self> {
        let points = sets::poisson_disk(n_points)?;
        let values = sets::values(points.len());
        let of_point = |(at, value): (&DVec2, f32)| ControlPoint {
            x: at.x,
            y: at.y,
            value: Some(value),
            ..ControlPoint::default()
        };
        let options = ControlPoints {
            domain: *points.domain(),
            points: points
                .positions()
                .iter()
                .zip(values)
                .map(of_point)
                .collect(),
            ..ControlPoints::default()
        };
        let window = window(SIDE)?;
        let image = anew(&options, &window)?;
        Ok(Self {
            pups: EditablePups::new(options, sets::SEED)?,
            window,
            image,
            n_edits: 0,
        })
    }

    /// Applies the next edit and returns what it changed.
    fn edit(&mut self) -> Result<Vec<Changed>, PupsError> {
        self.n_edits += 1;
        let random = |lane| {
            unit_f64(hash1(
                sets::SEED.child("bench edits", 0),
                [self.n_edits],
                lane,
            ))
        };
        let n_points = self.pups.points().len();
        let anywhere = DVec2::new(random(0), random(1));
        match self.n_edits % 3 {
            0 => {
                let point = PointIdx((random(2) * n_points as f64) as u32);
                let ControlPoint { x, y, .. } = self.pups.points()[point.index()];
                let step = (anywhere - 0.5) / (n_points as f64).sqrt();
                self.pups.move_to(point, DVec2::new(x, y) + step)
            }
            1 => self.pups.insert(ControlPoint {
                x: anywhere.x,
                y: anywhere.y,
                value: Some(random(2) as f32),
                ..ControlPoint::default()
            }),
            _ => self.pups.remove(PointIdx(n_points as u32 - 1)),
        }
    }

    /// Redraws the changed parts of the image.
    fn draw(&mut self, changed: &[Changed]) -> Result<(), PupsError> {
        for window in self.pups.windows(changed, &self.window) {
            let mut part = Raster::filled(window.size, 0.0)?;
            self.pups.render(&window, part.view_mut())?;
            let [column, row] = window.first.map(|first| first as usize);
            let rows = self.image.pixels_mut().chunks_exact_mut(SIDE as usize);
            for (pixels, y) in rows.skip(row).zip(0..window.size[1]) {
                pixels[column..column + window.size[0] as usize].copy_from_slice(part.row(y));
            }
        }
        Ok(())
    }
}

/// Builds a texture from scratch and returns its image.
fn anew(options: &ControlPoints, window: &Window) -> Result<Raster<f32>> {
    let mut image = image(SIDE)?;
    match control_points(options, sets::SEED)? {
        PupsField::Numbers(field) => field.render(window, image.view_mut())?,
        PupsField::Colors(_) => {}
    }
    Ok(image)
}

fn edits(bench: &mut Bench, case: &Case, n_points: u32) -> Result<()> {
    if !bench.wants(case) {
        return Ok(());
    }
    let edited = Edited::new(n_points)?;
    let (options, window) = (edited.pups.options().clone(), edited.window);
    let ours = Side::new((edited, Ok(())), |(edited, done)| {
        *done = edited.edit().and_then(|changed| edited.draw(&changed));
    });
    let theirs = Side::new(None, |image| *image = Some(anew(&options, &window)));
    bench.beside(case, 31, ours.times(30), theirs, |(edited, done), image| {
        if let Err(error) = done {
            anyhow::bail!("an edit was refused: {error}");
        }
        ensure!(
            image.as_ref().is_some_and(Result::is_ok),
            "no texture was made anew"
        );
        let bits = |image: &Raster<f32>| image.map(|value| value.to_bits());
        let expected = anew(edited.pups.options(), &window)?;
        ensure!(
            bits(&edited.image) == bits(&expected),
            "the image that edits kept up to date is not the one made anew"
        );
        Ok(Done::both(1))
    })
}
