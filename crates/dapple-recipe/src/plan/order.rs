//! Sorts nodes topologically, by depth-first search, so that each node comes after its inputs.

use crate::{Node, Recipe, RecipeError, RecipeErrorKind};

/// Maximum number of nodes in a recipe. It is more than people write, and small enough to recurse along a chain of
/// nodes.
const MAX_NODES: usize = 1024;

/// Returns the names of all nodes, each after its inputs, and otherwise in the order of the recipe.
pub(crate) fn order(recipe: &Recipe) -> Result<Vec<&str>, RecipeError> {
    check_names(recipe)?;
    let mut order = Order {
        recipe,
        states: vec![State::New; recipe.nodes.len()],
        path: Vec::new(),
        names: Vec::new(),
    };
    for index in 0..recipe.nodes.len() {
        order.visit(index)?;
    }
    Ok(order.names)
}

/// Returns whether a text is a valid name of a node or a parameter.
pub(crate) fn is_name(text: &str) -> bool {
    let plain = |c: char| c.is_ascii_alphanumeric() || c == '_' || c == '-';
    text.starts_with(|c: char| c.is_ascii_alphabetic()) && text.chars().all(plain)
}

fn check_names(recipe: &Recipe) -> Result<(), RecipeError> {
    let count = recipe.nodes.len();
    if count > MAX_NODES {
        return Err(RecipeError::new(RecipeErrorKind::Count {
            what: "nodes",
            count,
            needed: "at most 1024",
        }));
    }
    for name in recipe.nodes.keys() {
        if !is_name(name) {
            return Err(RecipeError::new(RecipeErrorKind::Name {
                name: name.clone(),
            }));
        }
    }
    Ok(())
}

#[derive(Clone, Copy, PartialEq, Eq)]
enum State {
    New,
    /// The node is on the current path of the depth-first search, so reaching it again is a cycle.
    Open,
    Done,
}

struct Order<'a> {
    recipe: &'a Recipe,
    states: Vec<State>,
    path: Vec<usize>,
    names: Vec<&'a str>,
}

impl<'a> Order<'a> {
    /// Adds a node to the order, after its inputs. The recursion depth is at most the number of nodes.
    fn visit(&mut self, index: usize) -> Result<(), RecipeError> {
        let (name, node) = self.entry(index);
        match self.states[index] {
            State::Done => return Ok(()),
            State::Open => return Err(self.cycle(index)),
            State::New => {}
        }
        self.states[index] = State::Open;
        self.path.push(index);
        for input in node.inputs() {
            if let Some(wanted) = input.node() {
                let input = self.find(wanted).map_err(|error| error.within(name))?;
                self.visit(input)?;
            }
        }
        self.path.pop();
        self.states[index] = State::Done;
        self.names.push(name);
        Ok(())
    }

    fn entry(&self, index: usize) -> (&'a str, &'a Node) {
        let recipe: &'a Recipe = self.recipe;
        let (name, node) = &recipe.nodes.as_slice()[index..]
            .first()
            .expect("an index of a node");
        (name, node)
    }

    fn find(&self, name: &str) -> Result<usize, RecipeError> {
        self.recipe
            .nodes
            .get_index_of(name)
            .ok_or_else(|| unknown(self.recipe, name))
    }

    /// Returns the error for a cycle. The node at `index` was reached again while it was on the search path.
    fn cycle(&self, index: usize) -> RecipeError {
        let start = self
            .path
            .iter()
            .position(|&open| open == index)
            .unwrap_or(0);
        let way = self.path[start..].iter().chain([&index]);
        let names = way.map(|&index| self.entry(index).0.to_owned()).collect();
        RecipeError::new(RecipeErrorKind::Cycle { names })
    }
}

/// Returns the error for a name that no node has.
pub(crate) fn unknown(recipe: &Recipe, name: &str) -> RecipeError {
    let names = recipe.nodes.keys().map(String::as_str);
    RecipeError::new(RecipeErrorKind::UnknownNode {
        name: name.to_owned(),
    })
    .meant(name, names)
}
