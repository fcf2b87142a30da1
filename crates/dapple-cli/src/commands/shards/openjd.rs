//! Job templates of Open Job Description, for render farms.
//!
//! Reference: Open Job Description, *Template Schemas*, `jobtemplate-2023-09`, <https://github.com/OpenJobDescription>.

use super::{Args, text_of_path};
use crate::args::Size;
use crate::shards::List;
use anyhow::{Context as _, Result};
use serde::Serialize;
use std::path::{Component, Path, absolute};

/// Maximum number of characters in the name of a job.
const NAME_MAX: usize = 128;

/// A job template with its parameters and one step, which bakes the shards.
#[derive(Serialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct Template {
    specification_version: &'static str,
    name: String,
    parameter_definitions: [Parameter; 3],
    steps: [Step; 1],
}

/// A job parameter. Its value can be changed when the job is submitted.
#[derive(Serialize)]
#[serde(rename_all = "camelCase")]
struct Parameter {
    name: &'static str,
    #[serde(rename = "type")]
    kind: &'static str,
    #[serde(skip_serializing_if = "Option::is_none")]
    object_type: Option<&'static str>,
    #[serde(skip_serializing_if = "Option::is_none")]
    data_flow: Option<&'static str>,
    default: String,
}

#[derive(Serialize)]
#[serde(rename_all = "camelCase")]
struct Step {
    name: &'static str,
    parameter_space: Space,
    script: Script,
}

/// The parameter space of a step, which has one task for each combination of values.
#[derive(Serialize)]
#[serde(rename_all = "camelCase")]
struct Space {
    task_parameter_definitions: Vec<Range>,
}

/// A task parameter that takes all whole numbers of a range.
#[derive(Serialize)]
struct Range {
    name: &'static str,
    #[serde(rename = "type")]
    kind: &'static str,
    range: String,
}

#[derive(Serialize)]
struct Script {
    actions: Actions,
}

#[derive(Serialize)]
#[serde(rename_all = "camelCase")]
struct Actions {
    on_run: Action,
}

#[derive(Serialize)]
struct Action {
    command: &'static str,
    args: Vec<String>,
}

/// Builds a job template with a task for each shard. `options` are the arguments of every bake. The recipe, the output
/// directory and the command are job parameters.
///
/// # Errors
///
/// If a path is not valid UTF-8.
pub(super) fn template(args: &Args, options: Vec<String>, list: &List) -> Result<Template> {
    let [columns, rows] = list.grid()?;
    let mut ranges = vec![range("Column", 0, columns - 1), range("Row", 0, rows - 1)];
    let mut words = vec!["bake".to_owned(), "{{Param.Recipe}}".to_owned()];
    words.extend(options);
    let size = Size(list.shard);
    let overlap = match list.overlap {
        0 => String::new(),
        overlap => format!("+{overlap}"),
    };
    words.push(format!(
        "--shard={{{{Task.Param.Column}}}},{{{{Task.Param.Row}}}},{size}{overlap}"
    ));
    if let Some(count) = list.frames {
        ranges.push(range("Frame", 1, count));
        words.push(format!("--frame={{{{Task.Param.Frame}}}}/{count}"));
    }
    words.extend(["-o", "{{Param.Output}}"].map(str::to_owned));
    let on_run = Action {
        command: "{{Param.Dapple}}",
        args: words,
    };
    let name = format!("dapple {}", list.name);
    let name = name.chars().filter(|c| !c.is_control());
    Ok(Template {
        specification_version: "jobtemplate-2023-09",
        name: name.take(NAME_MAX).collect(),
        parameter_definitions: [
            recipe(&args.recipe)?,
            path("Output", ["DIRECTORY", "OUT"], &args.output)?,
            string("Dapple", "dapple"),
        ],
        steps: [Step {
            name: "Bake",
            parameter_space: Space {
                task_parameter_definitions: ranges,
            },
            script: Script {
                actions: Actions { on_run },
            },
        }],
    })
}

fn range(name: &'static str, first: u32, last: u32) -> Range {
    Range {
        name,
        kind: "INT",
        range: format!("{first}-{last}"),
    }
}

/// Returns the job parameter for the recipe, which is a file path or the name of a built-in recipe.
fn recipe(typed: &str) -> Result<Parameter> {
    match Path::new(typed).is_file() {
        true => path("Recipe", ["FILE", "IN"], Path::new(typed)),
        false => Ok(string("Recipe", typed)),
    }
}

/// Returns a job parameter for the path of a file or directory. Farms map such paths to the machines that run the job.
/// Templates allow path parameters only below their own directory, which is assumed to be the current one. Other paths
/// become absolute strings, which must be valid on every machine.
fn path(name: &'static str, what: [&'static str; 2], path: &Path) -> Result<Parameter> {
    let is_below = |part: Component<'_>| matches!(part, Component::Normal(_) | Component::CurDir);
    if path.components().all(is_below) {
        let [object, flow] = what;
        return Ok(Parameter {
            kind: "PATH",
            object_type: Some(object),
            data_flow: Some(flow),
            ..string(name, text_of_path(path)?)
        });
    }
    let path = absolute(path).with_context(|| path.display().to_string())?;
    Ok(string(name, text_of_path(&path)?))
}

/// Returns a job parameter of type string.
fn string(name: &'static str, default: &str) -> Parameter {
    Parameter {
        name,
        kind: "STRING",
        object_type: None,
        data_flow: None,
        default: default.to_owned(),
    }
}
