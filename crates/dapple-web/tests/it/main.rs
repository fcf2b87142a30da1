//! Tests of the page without a server, through its public API, on the native platform.

use dapple_recipe::{Bake, BakeOptions, Images, MapKind, MapRows, Plan, PlanCache, Recipe};
use dapple_studio::{Output, RenderHost, Renderer, Session, StudioError, View};
use dapple_web::{Made, Page};
use serde_json::{Value, json};
use std::cell::RefCell;

fn page() -> Page {
    let mut page = Page::new(|| 0.0);
    let hello = messages(&made(&mut page)).remove(0);
    assert_eq!(
        [&hello["type"], &hello["mode"]],
        ["hello", "static"],
        "the first message"
    );
    page
}

fn hear(page: &mut Page, message: &Value) {
    page.receive(message.to_string().as_bytes());
}

/// Completes all pending work and returns the results.
fn made(page: &mut Page) -> Vec<Made> {
    while page.step() {}
    core::iter::from_fn(|| page.poll()).collect()
}

fn messages(made: &[Made]) -> Vec<Value> {
    let text = |made: &Made| match made {
        Made::Message(text) => serde_json::from_str(text).ok(),
        _ => None,
    };
    made.iter().filter_map(text).collect()
}

fn of_type(made: &[Made], name: &str) -> Vec<Value> {
    let mut messages = messages(made);
    messages.retain(|message| message["type"] == name);
    messages
}

/// The flags and pixels of all images except drafts.
fn pictures(made: &[Made]) -> Vec<(u8, &[u8])> {
    let pictures = made.iter().filter_map(|made| match made {
        Made::Picture(bytes) if bytes[30] & 1 == 0 => Some((bytes[30], &bytes[32..])),
        _ => None,
    });
    pictures.collect()
}

fn view(side: u32, maps: &[&str]) -> Value {
    json!({ "type": "view", "size": [side, side], "maps": maps, "paused": false })
}

/// A render host that collects the pixels of a job rendered in one piece.
struct AtOnce(RefCell<Vec<u8>>);

impl RenderHost for AtOnce {
    fn images(&self, _: &Recipe) -> Result<Images, StudioError> {
        Ok(Images::new())
    }

    fn now(&self) -> f64 {
        0.0
    }

    fn is_wanted(&self, _: u32) -> bool {
        true
    }

    fn put(&self, output: Output) {
        if let Output::Picture(picture) = output {
            self.0.borrow_mut().extend(picture.pixels);
        }
    }
}

#[test]
fn pieces_make_the_picture_that_is_drawn_at_once_after_a_draft() {
    let mut page = page();
    hear(
        &mut page,
        &json!({ "type": "open", "builtin": "flagstone" }),
    );
    hear(&mut page, &view(1024, &["height"]));
    let made = made(&mut page);
    assert_eq!(of_type(&made, "began").len(), 1);
    assert_eq!(of_type(&made, "graph").len(), 1);
    let rendered = of_type(&made, "rendered");
    let drafts: Vec<_> = rendered.iter().map(|message| &message["draft"]).collect();
    assert_eq!(drafts, [true, false]);
    let pictures = pictures(&made);
    let flags: Vec<_> = pictures.iter().map(|(flags, _)| *flags).collect();
    assert_eq!(flags, [0, 0, 0, 2]);
    let joined: Vec<u8> = pictures
        .iter()
        .flat_map(|(_, pixels)| *pixels)
        .copied()
        .collect();

    let world = AtOnce(RefCell::default());
    let mut session = Session::new();
    session.open(Recipe::builtin_text("flagstone").unwrap(), None);
    let mut job = session.job().unwrap();
    job.view = View {
        size: [1024; 2],
        maps: vec!["height".to_owned()],
        draft: false,
        paused: false,
        ..View::default()
    };
    Renderer::new(&PlanCache::new(0)).draw(&job, &world);
    assert_eq!(joined, world.0.into_inner());
}

#[test]
fn a_node_is_one_piece_and_a_small_picture_too() {
    let mut page = page();
    hear(
        &mut page,
        &json!({ "type": "open", "builtin": "flagstone" }),
    );
    let mut message = view(512, &[]);
    message["node"] = "grain".into();
    hear(&mut page, &message);
    assert_eq!(pictures(&made(&mut page)).len(), 1);
    hear(&mut page, &view(63, &["height"]));
    let small = made(&mut page);
    assert_eq!(pictures(&small).len(), 1);
    assert_eq!(of_type(&small, "rendered").len(), 1);
}

#[test]
fn the_newest_change_wins_between_pieces() {
    let mut page = page();
    hear(&mut page, &json!({ "type": "open", "builtin": "marble" }));
    hear(&mut page, &view(1024, &["height"]));
    assert!(
        page.step() && page.step(),
        "the rest of the picture is left"
    );
    hear(&mut page, &view(62, &["height"]));
    let made = made(&mut page);
    let mut full = of_type(&made, "rendered");
    full.retain(|message| message["draft"] == false);
    assert_eq!(full.len(), 1);
    let (_, last) = pictures(&made).pop().unwrap();
    assert_eq!(last.len(), 62 * 62 * 4);
}

#[test]
fn a_recipe_that_is_refused_is_not_drawn_on() {
    let mut page = page();
    let text = "dapple = 1\n[nodes.a.noise]\nfrequency = -1\n[material]\nheight = \"a\"\n";
    hear(&mut page, &json!({ "type": "open", "text": text }));
    hear(&mut page, &view(512, &["height"]));
    let made = made(&mut page);
    assert!(pictures(&made).is_empty());
    assert!(of_type(&made, "rendered").is_empty());
    assert_eq!(of_type(&made, "diagnostics").len(), 1);
}

#[test]
fn an_export_has_the_numbers_of_a_bake() {
    let mut page = page();
    hear(&mut page, &json!({ "type": "open", "builtin": "giraffe" }));
    let export = json!({ "type": "export", "size": [40, 40], "maps": ["height"], "format": "npy" });
    hear(&mut page, &export);
    let made = made(&mut page);
    let exported = of_type(&made, "exported").remove(0);
    assert_eq!(exported["files"][0]["name"], "giraffe_height.npy");
    let is_file = |made: &&Made| matches!(made, Made::File(_));
    let Some(Made::File(bytes)) = made.iter().find(is_file) else {
        panic!("the file follows its message");
    };
    let plan = Plan::new(&Recipe::builtin("giraffe").unwrap(), &Images::new(), 0.0).unwrap();
    let options = BakeOptions {
        size: [40; 2],
        maps: vec![MapKind::Height],
        ..BakeOptions::default()
    };
    let maps = Bake::new(&plan, &options).unwrap().whole_maps().unwrap();
    let MapRows::Gray(height) = &maps[0].1 else {
        panic!("a height is gray");
    };
    let numbers: Vec<u8> = height
        .pixels()
        .iter()
        .flat_map(|value| value.to_le_bytes())
        .collect();
    assert!(bytes.ends_with(&numbers));
}

#[test]
fn what_needs_a_server_is_refused_in_words() {
    let mut page = page();
    hear(
        &mut page,
        &json!({ "type": "open", "builtin": "flagstone" }),
    );
    made(&mut page);
    for message in [
        json!({ "type": "export", "maps": ["height"], "format": "exr" }),
        json!({ "type": "export", "preset": "unity" }),
        json!({ "type": "export", "size": [100_000, 8], "maps": ["height"] }),
        json!({ "type": "save", "text": "", "file": "a.toml", "seen": null }),
        json!({ "type": "open", "file": "a.toml" }),
        json!({ "type": "unheard of" }),
    ] {
        hear(&mut page, &message);
        let refused = of_type(&made(&mut page), "refused");
        assert_eq!(refused.len(), 1, "{message}");
    }
}
