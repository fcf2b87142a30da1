//! How far the work is, on standard error: only on a terminal, and only if it takes a while.

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use std::io::{self, IsTerminal};
use std::time::Duration;

/// How long nothing is shown.
const DELAY: Duration = Duration::from_millis(500);
/// How often what is shown moves.
const TICK: Duration = Duration::from_millis(120);

/// A bar, or a spinner where nobody knows how long it takes. It goes away when this does.
#[derive(Debug)]
pub(crate) struct Progress {
    bar: ProgressBar,
}

impl Progress {
    /// Shows that something is worked on.
    pub(crate) fn spinner(label: &'static str, quiet: bool) -> Self {
        let style = ProgressStyle::with_template("{spinner} {msg} {elapsed}");
        Self::new(ProgressBar::no_length(), style, label, quiet)
    }

    /// Shows how much of `length` is done.
    pub(crate) fn bar(label: &'static str, length: u64, quiet: bool) -> Self {
        let style = ProgressStyle::with_template("{msg} {wide_bar} {percent:>3} % {eta}");
        Self::new(ProgressBar::new(length), style, label, quiet)
    }

    /// Says how much is done by now.
    pub(crate) fn set(&self, done: u64) {
        self.bar.set_position(done);
    }

    fn new(
        bar: ProgressBar,
        style: Result<ProgressStyle, indicatif::style::TemplateError>,
        label: &'static str,
        quiet: bool,
    ) -> Self {
        bar.set_draw_target(ProgressDrawTarget::hidden());
        // The templates above are right; if they were not, a plain bar would do.
        if let Ok(style) = style {
            bar.set_style(style);
        }
        bar.set_message(label);
        if !quiet && io::stderr().is_terminal() {
            let bar = bar.clone();
            std::thread::spawn(move || {
                std::thread::sleep(DELAY);
                if !bar.is_finished() {
                    bar.set_draw_target(ProgressDrawTarget::stderr());
                    bar.enable_steady_tick(TICK);
                }
            });
        }
        Self { bar }
    }
}

impl Drop for Progress {
    fn drop(&mut self) {
        self.bar.finish_and_clear();
    }
}

#[cfg(test)]
mod tests {
    use super::Progress;

    #[test]
    fn a_bar_goes_to_its_end_and_is_finished_when_it_goes() {
        let progress = Progress::bar("working", 10, true);
        progress.set(7);
        let bar = progress.bar.clone();
        assert_eq!((bar.position(), bar.is_finished()), (7, false));
        drop(progress);
        assert!(bar.is_finished(), "it went");
        drop(Progress::spinner("waiting", true));
    }
}
