//! Displays the progress of long work on standard error: a bar on a terminal, lines elsewhere.

#![expect(
    clippy::disallowed_methods,
    reason = "the time limits how often lines are printed, and no value depends on it"
)]

use crate::job::{Context, eprintln_if_possible};
use anyhow::Result;
#[cfg(feature = "studio")]
use anyhow::anyhow;
use core::ops::ControlFlow;
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use std::io::{self, IsTerminal};
#[cfg(feature = "studio")]
use std::sync::{
    Arc,
    atomic::{AtomicBool, Ordering},
};
use std::sync::{Mutex, PoisonError};
use std::time::{Duration, Instant};

/// Delay before a bar is shown.
const DELAY: Duration = Duration::from_millis(500);
/// Time between frames of a bar.
const TICK: Duration = Duration::from_millis(120);
/// Time between lines of text.
const PERIOD: Duration = Duration::from_secs(5);
/// Time between lines of JSON.
const PERIOD_JSON: Duration = Duration::from_millis(100);

dapple::raster::named! {
    /// The style of the progress display.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub(crate) enum Style {
        /// A bar on a terminal, and lines elsewhere.
        #[default]
        Auto = "auto",
        /// A line every few seconds.
        Lines = "lines",
        /// Lines of JSON, also for the files that were written.
        Json = "json",
    }
}

/// A progress bar, or a spinner for work of unknown length. It is removed on drop.
#[derive(Debug)]
pub(crate) struct Progress {
    bar: ProgressBar,
    label: &'static str,
    style: Style,
    /// Time of the next progress line; `None` if no lines are printed.
    next_line: Option<Mutex<Instant>>,
    /// Flag that requests a stop when it becomes true.
    #[cfg(feature = "studio")]
    stop: Option<Arc<AtomicBool>>,
}

/// Returns whether a stop was requested.
#[cfg(feature = "studio")]
fn is_set(stop: &Option<Arc<AtomicBool>>) -> bool {
    stop.as_ref()
        .is_some_and(|stop| stop.load(Ordering::SeqCst))
}

impl Progress {
    /// Shows a spinner.
    pub(crate) fn spinner(label: &'static str, context: &Context) -> Self {
        let style = ProgressStyle::with_template("{spinner} {msg} {elapsed}");
        Self::new(ProgressBar::no_length(), style, label, context)
    }

    /// Shows a bar for work of `length` steps.
    pub(crate) fn bar(label: &'static str, length: u64, context: &Context) -> Self {
        let style = ProgressStyle::with_template("{msg} {wide_bar} {percent:>3} % {eta}");
        Self::new(ProgressBar::new(length), style, label, context)
    }

    /// Sets the flag that requests a stop when it becomes true.
    #[cfg(feature = "studio")]
    pub(crate) fn until(mut self, stop: Arc<AtomicBool>) -> Self {
        self.stop = Some(stop);
        self
    }

    /// Returns an error if a stop was requested.
    ///
    /// # Errors
    ///
    /// If a stop was requested. The error says that the work was stopped.
    pub(crate) fn check(&self) -> Result<()> {
        #[cfg(feature = "studio")]
        if is_set(&self.stop) {
            return Err(anyhow!("the export was stopped"));
        }
        Ok(())
    }

    /// Returns a progress callback for libraries. It stops the work if a stop was requested.
    pub(crate) fn listener(
        &self,
    ) -> impl Fn(dapple::synth::Progress) -> ControlFlow<()> + Send + Sync + 'static {
        #[cfg(feature = "studio")]
        let stop = self.stop.clone();
        move |_| {
            #[cfg(feature = "studio")]
            if is_set(&stop) {
                return ControlFlow::Break(());
            }
            ControlFlow::Continue(())
        }
    }

    /// Sets the number of completed steps.
    pub(crate) fn set(&self, done: u64) {
        if done > 0 && done == self.bar.position() {
            return;
        }
        self.bar.set_position(done);
        let (Some(next), Some(length)) = (&self.next_line, self.bar.length()) else {
            return;
        };
        let (now, is_json) = (Instant::now(), self.style == Style::Json);
        let mut next = next.lock().unwrap_or_else(PoisonError::into_inner);
        if now < *next && !(is_json && done >= length) {
            return;
        }
        *next = now + if is_json { PERIOD_JSON } else { PERIOD };
        eprintln_if_possible(&line(self.label, done, length, is_json));
    }

    /// Adds to the number of completed steps.
    pub(crate) fn add(&self, more: u64) {
        self.set(self.bar.position() + more);
    }

    fn new(
        bar: ProgressBar,
        template: Result<ProgressStyle, indicatif::style::TemplateError>,
        label: &'static str,
        context: &Context,
    ) -> Self {
        bar.set_draw_target(ProgressDrawTarget::hidden());
        // The templates above are valid; otherwise, a plain bar is shown.
        if let Ok(template) = template {
            bar.set_style(template);
        }
        bar.set_message(label);
        let style = context.progress;
        let is_bar = style == Style::Auto && io::stderr().is_terminal();
        if !context.quiet && is_bar {
            let bar = bar.clone();
            std::thread::spawn(move || {
                std::thread::sleep(DELAY);
                if !bar.is_finished() {
                    bar.set_draw_target(ProgressDrawTarget::stderr());
                    bar.enable_steady_tick(TICK);
                }
            });
        }
        let first_line = match style {
            Style::Json => Instant::now(),
            Style::Auto | Style::Lines => Instant::now() + PERIOD,
        };
        Self {
            bar,
            label,
            style,
            next_line: (!context.quiet && !is_bar).then(|| Mutex::new(first_line)),
            #[cfg(feature = "studio")]
            stop: None,
        }
    }
}

/// Formats a progress line.
fn line(label: &str, done: u64, length: u64, is_json: bool) -> String {
    if is_json {
        return serde_json::json!({ "step": label, "done": done, "of": length }).to_string();
    }
    let percent = done.saturating_mul(100) / length.max(1);
    format!("{label}: {percent} %")
}

impl Drop for Progress {
    fn drop(&mut self) {
        self.bar.finish_and_clear();
    }
}

#[cfg(test)]
mod tests {
    use super::{Progress, Style, line};
    use crate::job::Context;

    #[test]
    fn a_bar_goes_to_its_end_and_is_finished_when_it_goes() {
        let context = Context {
            quiet: true,
            progress: Style::Auto,
            threads: 0,
            arguments: Vec::new(),
            options: Vec::new(),
        };
        let progress = Progress::bar("working", 10, &context);
        progress.set(7);
        progress.add(1);
        let bar = progress.bar.clone();
        assert_eq!((bar.position(), bar.is_finished()), (8, false));
        drop(progress);
        assert!(bar.is_finished(), "it went");
        drop(Progress::spinner("waiting", &context));
    }

    #[test]
    fn lines_say_how_much_is_done() {
        assert_eq!(line("baking", 3, 4, false), "baking: 75 %");
        assert_eq!(line("baking", 0, 0, false), "baking: 0 %");
        let json = r#"{"done":3,"of":4,"step":"baking"}"#;
        assert_eq!(line("baking", 3, 4, true), json);
    }
}
