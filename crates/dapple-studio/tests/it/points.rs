//! Tests of editing control points on the page.

use crate::render_host::Page;
use serde_json::{Value, json};
use std::time::Instant;

/// Returns a page that shows two maps of a cow texture, whose points are written in the text.
fn page(n_points: u32) -> Page {
    let text = format!(
        "dapple = 1\nextent = [2.0, 2.0]\n[nodes.hide.pups.cow]\nspacing = {{ count = {n_points} }}\n\n[material]\nheight = \"hide\"\n"
    );
    let mut page = Page::default();
    page.ask(json!({ "type": "doc", "rev": 0, "text": text }));
    page.ask(json!({
        "type": "view", "size": [512, 512], "maps": ["height", "albedo"], "draft": false, "paused": false,
    }));
    let ops = json!([{ "op": "make_points", "node": "hide" }]);
    let replies = page.ask(json!({ "type": "patch", "rev": 0, "ops": ops }));
    assert_eq!(replies[0]["type"], "edits", "{replies:?}");
    page.draw();
    page
}

/// Returns the request that is sent while a point is dragged.
fn moved(point: usize, [x, y]: [f64; 2], rev: u32) -> Value {
    let path = |key| json!(["nodes", "hide", "pups", "points", "points", point, key]);
    json!({
        "type": "patch", "rev": rev, "drag": true,
        "ops": [{ "op": "set", "path": path("x"), "value": x }, { "op": "set", "path": path("y"), "value": y }],
    })
}

#[test]
fn a_dragged_point_draws_what_its_text_draws_anew() {
    let mut page = page(90);
    for step in 1..6 {
        let place = 0.3 * f64::from(step);
        let replies = page.ask(moved(7, [place, 2.0 - place], step));
        let changes = replies[0]["changes"].as_array().unwrap();
        assert!(changes.len() == 1 && changes[0]["insert"].as_str().unwrap().len() < 60);
        let (_, pictures) = page.draw();
        let mut anew = Page::default();
        let text = page.session.document().text();
        anew.ask(json!({ "type": "doc", "rev": 0, "text": text }));
        anew.session.handle(
            &dapple_studio::Request::View(page.session.view().clone()),
            &|_| unreachable!("there are no images"),
        );
        let (_, expected) = anew.draw();
        let pixels = |pictures: Vec<dapple_studio::Picture>| {
            pictures.into_iter().map(|picture| picture.pixels)
        };
        assert!(pixels(pictures).eq(pixels(expected)), "step {step}");
    }
}

#[test]
fn one_of_700_points_is_changed_in_twice_the_time_of_reading_them() {
    let mut dragged = page(700);
    let mut read = Page::default();
    // Take the minimum of many runs, since other tests run at the same time.
    let [mut change, mut whole] = [f64::INFINITY; 2];
    let timed = |page: &mut Page, message: Value| {
        let start = Instant::now();
        page.ask(message);
        start.elapsed().as_secs_f64() * 1e3
    };
    for step in 1..=20 {
        let message = moved(350, [0.9 + 0.01 * f64::from(step), 1.1], step);
        change = change.min(timed(&mut dragged, message));
        let text = dragged.session.document().text();
        let message = json!({ "type": "doc", "rev": step, "text": text });
        whole = whole.min(timed(&mut read, message));
    }
    // Absolute times depend on the machine, so compare two times on the same machine. An edit parses the text once.
    // Parsing it twice, or comparing all pairs of points, would exceed this bound.
    println!("{change:.1} ms to change a point, {whole:.1} ms to read the text");
    assert!(
        change < 2.0 * whole,
        "{change:.1} ms to change a point, {whole:.1} ms to read the text"
    );
}
