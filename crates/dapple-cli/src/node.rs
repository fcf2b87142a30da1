//! Builds options of subcommands from a recipe node. The node's schema provides their names, help texts, types, ranges
//! and defaults, so a new option of a node needs no code here.
//!
//! A table of [`Flag`]s lists the exceptions: flags with other names, values in nested tables, and options without a
//! flag.

use crate::args::numbers_of;
use crate::error::{Hint, usage};
use crate::words::{first_sentence, unknown, with_dashes, with_underscores};
use anyhow::Result;
use clap::builder::{PossibleValue, RangedI64ValueParser, StringValueParser, TypedValueParser};
use clap::parser::ValueSource;
use clap::{Arg, ArgMatches, Command, Error, FromArgMatches};
use dapple::recipe::{Node, Recipe};
use serde::de::DeserializeOwned;
use serde::ser::SerializeMap;
use serde::{Serialize, Serializer};
use serde_json::{Map, Value, json};
use std::ffi::OsStr;
use std::marker::PhantomData;
use std::sync::OnceLock;

/// A kind of node whose options become flags of a subcommand.
pub(crate) trait NodeFlags: Send + Sync + 'static {
    /// Name of the kind in recipes. If it is empty, paths of options begin with the name of a kind.
    const KIND: &'static str;

    /// Heading of the flags in the help; `None` for the flags of the subcommand itself.
    const HEADING: Option<&'static str> = Some("Texture");

    /// Flags that differ from the schema. Each other option at the top level of the node has a flag with the option's
    /// name.
    const FLAGS: &'static [Flag];

    /// Returns the options that have flags.
    fn options() -> Vec<NodeOption> {
        options(Self::KIND, Self::FLAGS)
    }
}

/// A flag that differs from the option in the schema.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Flag {
    /// Path of the option in the node, such as `scatter/jittered/jitter`.
    path: &'static str,
    /// Name of the flag, without dashes; `None` for an option without a flag.
    name: Option<&'static str>,
    default: FlagDefault,
    /// Help text instead of the schema's description.
    help: Option<&'static str>,
    /// Whether the flag accepts a list of numbers, for an option that may also be a name.
    is_list: bool,
    /// Flags that must not be given together with this one.
    conflicts: &'static [&'static str],
    /// Flag that must be given together with this one.
    requires: Option<&'static str>,
    /// Another flag and the values of it for which this flag has an effect; `None` if the flag always has an effect.
    only_with: Option<(&'static str, &'static [&'static str])>,
}

/// Default of a flag that is not given.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum FlagDefault {
    /// The schema's default.
    Schema,
    /// No value: the option is left out.
    None,
    /// A default of the subcommand, which differs from the node's.
    Value(&'static str),
}

impl Flag {
    /// Creates an entry for an option that has no flag.
    pub(crate) const fn none(path: &'static str) -> Self {
        Self {
            path,
            name: None,
            default: FlagDefault::Schema,
            help: None,
            is_list: false,
            conflicts: &[],
            requires: None,
            only_with: None,
        }
    }

    /// Creates an entry for a flag called `name`.
    pub(crate) const fn new(path: &'static str, name: &'static str) -> Self {
        Self {
            name: Some(name),
            ..Self::none(path)
        }
    }

    /// Sets the default value.
    pub(crate) const fn with_default(self, default: &'static str) -> Self {
        Self {
            default: FlagDefault::Value(default),
            ..self
        }
    }

    /// Sets the help text.
    pub(crate) const fn with_help(self, help: &'static str) -> Self {
        Self {
            help: Some(help),
            ..self
        }
    }

    /// Removes the default: without the flag, the option is left out.
    pub(crate) const fn without_default(self) -> Self {
        Self {
            default: FlagDefault::None,
            ..self
        }
    }

    /// Makes the flag accept a list of numbers.
    pub(crate) const fn of_numbers(self) -> Self {
        Self {
            is_list: true,
            ..self
        }
    }

    /// Sets the flags that must not be given together with this one.
    pub(crate) const fn conflicting(self, conflicts: &'static [&'static str]) -> Self {
        Self { conflicts, ..self }
    }

    /// Sets another flag and the values of it for which this flag has an effect. The flag has no default then, and its
    /// help text begins with these values.
    pub(crate) const fn only_with(
        self,
        flag: &'static str,
        values: &'static [&'static str],
    ) -> Self {
        Self {
            only_with: Some((flag, values)),
            ..self
        }
    }

    /// Sets the flag that must be given, too.
    pub(crate) const fn requiring(self, flag: &'static str) -> Self {
        Self {
            requires: Some(flag),
            ..self
        }
    }
}

/// Values of a node's options, as given on the command line or by default.
#[derive(Clone, Debug)]
pub(crate) struct NodeArgs<K> {
    values: Vec<NodeValue>,
    kind: PhantomData<K>,
}

/// Value of an option, given or by default.
#[derive(Clone, Debug)]
pub(crate) struct NodeValue {
    pub(crate) path: String,
    /// Name of the flag, without dashes.
    pub(crate) flag: String,
    pub(crate) value: Value,
    /// Whether the value replaces the node's default, because it was given or the subcommand has another default.
    is_set: bool,
}

impl<K: NodeFlags> NodeArgs<K> {
    /// Returns whether the flag called `flag` was given.
    pub(crate) fn is_given(&self, flag: &str) -> bool {
        self.given().any(|value| value.flag == flag)
    }

    /// Returns the options that replace the node's defaults.
    pub(crate) fn given(&self) -> impl Iterator<Item = &NodeValue> {
        self.values.iter().filter(|value| value.is_set)
    }

    /// Returns the node with the given options.
    ///
    /// # Errors
    ///
    /// If a number is not finite.
    pub(crate) fn node(&self) -> Result<Node> {
        let mut options = json!({});
        for value in self.given() {
            value.check_finite()?;
            set(&mut options, &value.path, value.value.clone());
        }
        let mut node = Map::new();
        node.insert(K::KIND.to_owned(), options);
        Ok(serde_json::from_value(Value::Object(node))?)
    }

    /// Returns the value of a flag, given or by default; `None` for a flag without a value.
    ///
    /// # Errors
    ///
    /// If a number is not finite.
    pub(crate) fn get<T: DeserializeOwned>(&self, flag: &str) -> Result<Option<T>> {
        if let Some(value) = self.values.iter().find(|value| value.flag == flag) {
            value.check_finite()?;
            return Ok(Some(serde_json::from_value(value.value.clone())?));
        }
        let mut options = K::options().into_iter();
        let option = options.find(|option| option.flag == flag);
        let default = option.and_then(|option| option.parser().parse(&option.default_text()?).ok());
        Ok(default.map(serde_json::from_value).transpose()?)
    }

    /// Deserializes the given options to a type of the library. `chosen` are pairs of a flag and a name that replaces
    /// the flag's value.
    ///
    /// # Errors
    ///
    /// If a number is not finite.
    pub(crate) fn read<T: DeserializeOwned>(&self, chosen: &[(&str, &str)]) -> Result<T> {
        let mut table = json!({});
        for option in K::options() {
            let given = self.given().find(|value| value.flag == option.flag);
            let chosen = chosen.iter().find(|(flag, _)| *flag == option.flag);
            if let Some((_, name)) = chosen {
                set(&mut table, &option.path, option.tagged(json!(name)));
            } else if let Some(given) = given {
                given.check_finite()?;
                set(&mut table, &option.path, option.tagged(given.value.clone()));
            }
        }
        Ok(serde_json::from_value(table)?)
    }

    /// Refuses flags that have no effect. `chosen` are pairs of a flag that others depend on and its value. `what`
    /// names the operation in the error message.
    ///
    /// # Errors
    ///
    /// If such a flag is given.
    pub(crate) fn check_used(&self, what: &str, chosen: &[(&str, &str)]) -> Result<()> {
        for option in K::options() {
            if let Some((flag, values)) = option.entry.only_with
                && self.is_given(&option.flag)
                && !chosen
                    .iter()
                    .any(|(other, value)| *other == flag && values.contains(value))
            {
                let message = format!("--{} has no effect on this {what}", option.flag);
                return Err(usage(message).hint(format!("add --{flag} {}", values.join(" or "))));
            }
        }
        Ok(())
    }
}

impl NodeValue {
    /// Refuses NaN and infinite numbers.
    ///
    /// # Errors
    ///
    /// If a number is not finite.
    pub(crate) fn check_finite(&self) -> Result<()> {
        // Serde writes NaN and infinite numbers as null.
        let parts = self.value.as_array();
        let parts = parts.map_or(std::slice::from_ref(&self.value), Vec::as_slice);
        match parts.contains(&Value::Null) {
            true => Err(usage(format!("--{} must be finite", self.flag))),
            false => Ok(()),
        }
    }
}

/// Sets a value in a nested table, whose path is separated by `/`. Missing tables on the path are created.
fn set(table: &mut Value, path: &str, value: Value) {
    let Some((first, rest)) = path.split_once('/') else {
        table[path] = value;
        return;
    };
    if !table[first].is_object() {
        table[first] = json!({});
    }
    set(&mut table[first], rest, value);
}

impl<K> Serialize for NodeArgs<K> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let mut map = serializer.serialize_map(Some(self.values.len()))?;
        for value in &self.values {
            map.serialize_entry(&with_underscores(&value.flag), &value.value)?;
        }
        map.end()
    }
}

impl<K: NodeFlags> clap::Args for NodeArgs<K> {
    fn augment_args(command: Command) -> Command {
        // Generate the schema only if the subcommand is invoked, since every start of the command defines all of them.
        command.defer(|command| {
            let options = K::options().into_iter();
            command.args(options.map(|option| option.arg(K::HEADING)))
        })
    }

    fn augment_args_for_update(command: Command) -> Command {
        Self::augment_args(command)
    }
}

impl<K: NodeFlags> FromArgMatches for NodeArgs<K> {
    fn from_arg_matches(matches: &ArgMatches) -> Result<Self, Error> {
        let value = |option: NodeOption| {
            let value = matches.get_one::<Value>(&option.flag)?.clone();
            let is_given = matches.value_source(&option.flag) == Some(ValueSource::CommandLine);
            Some(NodeValue {
                is_set: is_given || matches!(option.entry.default, FlagDefault::Value(_)),
                path: option.path,
                flag: option.flag,
                value,
            })
        };
        let options = K::options().into_iter();
        Ok(Self {
            values: options.filter_map(value).collect(),
            kind: PhantomData,
        })
    }

    fn update_from_arg_matches(&mut self, matches: &ArgMatches) -> Result<(), Error> {
        *self = Self::from_arg_matches(matches)?;
        Ok(())
    }
}

/// Returns the schema of recipes.
pub(crate) fn schema() -> &'static Value {
    static SCHEMA: OnceLock<Value> = OnceLock::new();
    SCHEMA.get_or_init(Recipe::schema)
}

/// An option of a node that has a flag.
pub(crate) struct NodeOption {
    path: String,
    /// Name of the flag, without dashes.
    pub(crate) flag: String,
    schema: &'static Value,
    pub(crate) help: String,
    /// The schema's default; null if the option has none.
    default: Value,
    /// The option's entry in the table of flags; an empty entry if it has none.
    entry: Flag,
    /// Whether the flag accepts lists of any length.
    any_length: bool,
    /// Whether the flag selects one of several tables, whose options have separate flags.
    is_choice: bool,
}

/// Returns the options of a kind of node that have flags: first the entries of the table in its order, then the
/// remaining options at the top level of the node.
fn options(kind: &str, flags: &'static [Flag]) -> Vec<NodeOption> {
    let kinds = variants(&schema()["$defs"]["Node"]);
    let mut kinds = kinds.filter_map(|variant| variant["properties"].get(kind));
    let node = match kind {
        "" => &schema()["$defs"]["Node"],
        _ => followed(kinds.next().unwrap_or(&Value::Null)),
    };
    let of_table = flags.iter().filter_map(|entry| {
        let mut option = NodeOption::new(node, entry)?;
        let mut dependent = flags.iter().filter_map(|flag| flag.only_with);
        option.is_choice = dependent.any(|(flag, _)| flag == option.flag);
        Some(option)
    });
    let is_free = |name: &str| {
        !flags
            .iter()
            .any(|flag| flag.path.split('/').next() == Some(name))
    };
    let others = node["properties"].as_object().into_iter().flatten();
    let others = others.filter(|(name, schema)| is_free(name) && schema["deprecated"] != true);
    let others = others.map(|(name, schema)| NodeOption::plain(name, schema, Flag::none("")));
    of_table.chain(others).collect()
}

/// Returns the description in a schema, or in the schema it refers to.
fn description(schema: &'static Value) -> Option<&'static str> {
    let own = schema["description"].as_str();
    own.or_else(|| followed(schema)["description"].as_str())
}

/// Returns the schema that a reference leads to. For an option that may be null, returns the schema of its other type.
pub(crate) fn followed(value: &'static Value) -> &'static Value {
    if let Some(path) = value["$ref"].as_str() {
        let found = schema().pointer(path.trim_start_matches('#'));
        return found.map_or(value, followed);
    }
    let mut others = variants(value).filter(|variant| variant["type"] != "null");
    match (others.next(), others.next()) {
        (Some(only), None) => followed(only),
        _ => value,
    }
}

/// Returns the schemas of the alternative forms of a value.
pub(crate) fn variants(value: &'static Value) -> impl Iterator<Item = &'static Value> {
    let lists = ["oneOf", "anyOf"]
        .into_iter()
        .filter_map(|key| value[key].as_array());
    lists.flatten()
}

/// Returns the schema of the table that has an entry called `name`: the value itself, or one of its alternative forms.
fn table_of(value: &'static Value, name: &str) -> &'static Value {
    let value = followed(value);
    let mut tables = std::iter::once(value).chain(variants(value).map(followed));
    let found = tables.find(|table| table["properties"].get(name).is_some());
    found.unwrap_or(&Value::Null)
}

impl NodeOption {
    /// Creates an option for an entry at the top level of a table.
    pub(crate) fn plain(name: &str, schema: &'static Value, entry: Flag) -> Self {
        Self {
            path: name.to_owned(),
            flag: entry.name.map_or_else(|| with_dashes(name), str::to_owned),
            schema,
            help: description(schema).unwrap_or_default().to_owned(),
            default: schema["default"].clone(),
            entry,
            any_length: false,
            is_choice: false,
        }
    }

    /// Makes the flag accept lists of any length if `other`, an option with the same flag, has lists of another length.
    pub(crate) fn widen(&mut self, other: &Self) {
        if self.parser().list_length() != other.parser().list_length() {
            self.any_length = true;
        }
    }

    /// Returns whether the option's values can be typed on a command line.
    pub(crate) fn is_simple(&self) -> bool {
        let schema = followed(self.schema);
        schema["type"] != "array" || schema["items"]["type"] != "array"
    }

    /// Creates the option for an entry of the table of flags; `None` if the entry has no flag.
    fn new(node: &'static Value, entry: &'static Flag) -> Option<Self> {
        let flag = entry.name?.to_owned();
        let (mut schema, mut default, mut help) = (node, &Value::Null, None);
        for part in entry.path.split('/') {
            let table = table_of(schema, part);
            schema = &table["properties"][part];
            // A value without a description is described by the variant that it belongs to.
            help = description(schema).or_else(|| table["description"].as_str());
            // The default is that of the option, or a part of the default of the table around it.
            let inherited = &default[part];
            default = match inherited {
                Value::Null => &schema["default"],
                inherited => inherited,
            };
        }
        Some(Self {
            path: entry.path.to_owned(),
            flag,
            schema,
            help: entry.help.or(help).unwrap_or_default().to_owned(),
            default: default.clone(),
            entry: *entry,
            any_length: false,
            is_choice: false,
        })
    }

    /// Returns the JSON that the node expects for a chosen value. A name that stands for a table becomes a table with
    /// one empty entry.
    fn tagged(&self, value: Value) -> Value {
        let table = value.as_str().map(|name| table_of(self.schema, name));
        match (table, value) {
            (Some(Value::Object(_)), Value::String(name)) => {
                let mut table = Map::new();
                table.insert(name, json!({}));
                Value::Object(table)
            }
            (_, value) => value,
        }
    }

    /// Returns the default as text for the help, as a user would type it; `None` if it has no simple form.
    fn default_text(&self) -> Option<String> {
        match (self.entry.default, &self.default) {
            (FlagDefault::Value(default), _) => Some(default.to_owned()),
            (FlagDefault::Schema, Value::String(word)) => Some(with_dashes(word)),
            (FlagDefault::Schema, Value::Number(number)) => {
                Some(number.as_f64().unwrap_or(0.0).to_string())
            }
            _ => None,
        }
    }

    /// Returns the help text. If the flag has an effect only for some values of another flag, the text lists these
    /// values and the default for them.
    fn help(&self, default: Option<&str>) -> String {
        let help = self.help.trim_end_matches('.').replace('`', "");
        let Some((_, values)) = self.entry.only_with else {
            return help;
        };
        let mut letters = help.chars();
        let first = letters.next().map(|letter| letter.to_ascii_lowercase());
        let help: String = first.into_iter().chain(letters).collect();
        let default = default.map_or_else(String::new, |value| format!(" [default: {value}]"));
        format!("{}: {help}{default}", values.join(", "))
    }

    /// Returns the clap definition of the flag.
    fn arg(&self, heading: Option<&'static str>) -> Arg {
        let parser = self.parser();
        let mut arg = Arg::new(self.flag.clone())
            .long(self.flag.clone())
            .help_heading(heading)
            .value_name(parser.value_name())
            .allow_hyphen_values(parser.is_list())
            .allow_negative_numbers(true)
            .value_parser(parser);
        let entry = &self.entry;
        if self.path.ends_with("gain") && entry.only_with.is_none() {
            arg = arg.visible_alias("persistence");
        }
        let default = self.default_text();
        arg = arg.help(self.help(default.as_deref()));
        if let Some(default) = default.filter(|_| !entry.is_list && entry.only_with.is_none()) {
            arg = arg.default_value(default);
        }
        if let Some(flag) = entry.requires {
            arg = arg.requires(flag);
        }
        arg.conflicts_with_all(entry.conflicts)
    }

    /// Returns the parser for the option's values, as its schema describes them.
    fn parser(&self) -> ValueParser {
        let schema = followed(self.schema);
        if self.entry.is_list {
            let mut lists = variants(schema).filter(|variant| variant["type"] == "array");
            return ValueParser::Numbers(lists.next().and_then(length));
        }
        let names = names(schema, self.is_choice);
        let bound = |key: &str| schema[key].as_f64();
        match schema["type"].as_str() {
            _ if !names.is_empty() => ValueParser::Name(names),
            Some("integer") => {
                let most = bound("maximum").unwrap_or(f64::from(u32::MAX)) as i64;
                ValueParser::Integer(bound("minimum").unwrap_or(0.0) as i64, most)
            }
            Some("array") if schema["items"]["type"] == "integer" => {
                ValueParser::WholeNumbers(length(schema))
            }
            Some("array") if self.any_length => ValueParser::Numbers(None),
            Some("array") => ValueParser::Numbers(length(schema)),
            _ => ValueParser::Number,
        }
    }
}

/// Returns the number of items of a list, from its schema; `None` if it may have any length.
fn length(list: &Value) -> Option<usize> {
    let count = list["minItems"].as_u64()?;
    (list["maxItems"].as_u64() == Some(count)).then_some(count as usize)
}

/// Returns the names that a value may have, each with its help text. `with_tables` includes names that stand for a
/// table.
fn names(value: &'static Value, with_tables: bool) -> Vec<(&'static str, String)> {
    let named = |variant: &'static Value| {
        let about = variant["description"].as_str().unwrap_or_default();
        let table = || variant["properties"].as_object()?.keys().next();
        let name = variant["const"].as_str();
        let name = name.or_else(|| table().filter(|_| with_tables).map(String::as_str));
        Some((name?, first_sentence(about)))
    };
    let listed = variants(value)
        .filter_map(|variant| variant["enum"].as_array())
        .flatten();
    let listed = listed
        .filter_map(Value::as_str)
        .map(|name| (name, String::new()));
    variants(value).filter_map(named).chain(listed).collect()
}

/// How a value is parsed, derived from its schema.
#[derive(Clone, Debug)]
enum ValueParser {
    /// One of several names, each with its help text.
    Name(Vec<(&'static str, String)>),
    /// An integer from a minimum to a maximum.
    Integer(i64, i64),
    Number,
    /// Comma-separated numbers: a fixed count, or any count if `None`.
    Numbers(Option<usize>),
    WholeNumbers(Option<usize>),
}

impl ValueParser {
    fn value_name(&self) -> &'static str {
        match self {
            Self::Name(_) => "NAME",
            Self::Integer(..) | Self::Number => "N",
            Self::Numbers(_) | Self::WholeNumbers(_) => "N,N,…",
        }
    }

    fn is_list(&self) -> bool {
        matches!(self, Self::Numbers(_) | Self::WholeNumbers(_))
    }

    /// Returns the required length of a list of numbers; `None` if any length is allowed, and for other values.
    fn list_length(&self) -> Option<usize> {
        match self {
            Self::Numbers(count) | Self::WholeNumbers(count) => *count,
            _ => None,
        }
    }

    fn parse(&self, text: &str) -> Result<Value, String> {
        match self {
            Self::Name(names) => {
                let word = with_underscores(text);
                let names: Vec<_> = names.iter().map(|(name, _)| *name).collect();
                match names.iter().find(|name| **name == word) {
                    Some(name) => Ok(json!(name)),
                    None => Err(unknown("value", text, &names, "")),
                }
            }
            Self::Numbers(count) => Ok(json!(numbers_of::<f64>(text, *count)?)),
            Self::WholeNumbers(count) => Ok(json!(numbers_of::<u32>(text, *count)?)),
            Self::Integer(..) | Self::Number => {
                let number = text.parse::<f64>();
                Ok(json!(number.map_err(|error| error.to_string())?))
            }
        }
    }
}

impl TypedValueParser for ValueParser {
    type Value = Value;

    fn parse_ref(
        &self,
        command: &Command,
        arg: Option<&Arg>,
        text: &OsStr,
    ) -> Result<Value, Error> {
        if let Self::Integer(least, most) = self {
            let parser = RangedI64ValueParser::<i64>::new().range(*least..=*most);
            return Ok(json!(parser.parse_ref(command, arg, text)?));
        }
        let parser = self.clone();
        let parser = StringValueParser::new().try_map(move |text| parser.parse(text.trim()));
        parser.parse_ref(command, arg, text)
    }

    fn possible_values(&self) -> Option<Box<dyn Iterator<Item = PossibleValue> + '_>> {
        let Self::Name(names) = self else { return None };
        let value = |(name, about): &(&'static str, String)| {
            let value = PossibleValue::new(with_dashes(name)).alias(*name);
            match about.is_empty() {
                true => value,
                false => value.help(about.clone()),
            }
        };
        Some(Box::new(names.iter().map(value)))
    }
}
