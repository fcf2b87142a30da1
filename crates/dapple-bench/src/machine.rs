//! Describes the machine that a run was measured on, for the results page.

use std::fmt;
use std::process::Command;

/// The machine's processor, number of threads, vector instructions and compiler.
#[derive(Clone, Debug)]
pub(crate) struct Machine {
    /// Processor model, as the operating system reports it.
    pub(crate) processor: String,
    /// Number of threads that can run at the same time.
    pub(crate) n_threads: usize,
    /// Widest vector instructions that run-time dispatch can choose.
    pub(crate) vectors: &'static str,
    /// Compiler version.
    pub(crate) compiler: String,
}

impl Machine {
    /// Describes the machine that this program runs on. Unknown properties are "unknown".
    pub(crate) fn this() -> Self {
        Self {
            processor: processor().unwrap_or_else(|| "an unknown processor".to_owned()),
            n_threads: std::thread::available_parallelism().map_or(1, usize::from),
            vectors: vectors(),
            compiler: compiler().unwrap_or_else(|| "an unknown rustc".to_owned()),
        }
    }
}

impl fmt::Display for Machine {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self {
            processor,
            n_threads,
            vectors,
            compiler,
        } = self;
        let (os, architecture) = (std::env::consts::OS, std::env::consts::ARCH);
        write!(
            f,
            "{processor}, {n_threads} threads, {vectors}, {architecture} {os}, {compiler}"
        )
    }
}

/// Returns the model in `/proc/cpuinfo`, if that file exists.
fn processor() -> Option<String> {
    #[expect(
        clippy::disallowed_methods,
        reason = "a benchmark names the machine, which Linux tells in a file"
    )]
    let text = std::fs::read_to_string("/proc/cpuinfo").ok()?;
    model_name(&text)
}

/// Returns the first `model name` in the text of `/proc/cpuinfo`, followed by family and model. These identify a
/// processor whose name a virtual machine has shortened.
fn model_name(cpuinfo: &str) -> Option<String> {
    let field = |name: &str| {
        cpuinfo.lines().find_map(|line| {
            let (key, value) = line.split_once(':')?;
            (key.trim() == name).then(|| value.trim().to_owned())
        })
    };
    let name = field("model name")?;
    match (field("cpu family"), field("model")) {
        (Some(family), Some(model)) => Some(format!("{name} (family {family}, model {model})")),
        _ => Some(name),
    }
}

/// Returns the widest vector instructions of the processor among those that the crates dispatch on.
fn vectors() -> &'static str {
    #[cfg(target_arch = "x86_64")]
    {
        if is_x86_feature_detected!("avx512f") {
            "AVX-512"
        } else if is_x86_feature_detected!("avx2") {
            "AVX2"
        } else {
            "SSE2 or SSE4.2"
        }
    }
    #[cfg(not(target_arch = "x86_64"))]
    {
        "the vectors of its target"
    }
}

/// Returns the output of `rustc --version`; under cargo this is the compiler that built the program.
fn compiler() -> Option<String> {
    let output = Command::new("rustc").arg("--version").output().ok()?;
    let text = String::from_utf8(output.stdout).ok()?;
    (!text.trim().is_empty()).then(|| text.trim().to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn model_name_reads_the_first_processor() {
        let text = "processor : 0\ncpu family : 25\nmodel\t\t: 17\nmodel name\t: Fast 9000\n\nprocessor : 1\nmodel name : Other\n";
        assert_eq!(
            model_name(text).as_deref(),
            Some("Fast 9000 (family 25, model 17)"),
            "name, family, model"
        );
        assert_eq!(
            model_name("model name : Fast\n").as_deref(),
            Some("Fast"),
            "the name alone is enough"
        );
        assert_eq!(
            model_name("Hardware : BCM2835\n"),
            None,
            "other files have no such field"
        );
    }
}
