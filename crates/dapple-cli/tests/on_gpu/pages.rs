//! The maps of a page of the studio on the GPU: the bytes of the CPU.

use dapple::recipe::{Images, Plan, Recipe, RendererError, ShaderOptions};
use dapple_gpu::{Gpu, GpuPlan};
use dapple_studio::{Output, Picture, RenderHost, Renderer, Request, Session, StudioError};
use serde_json::{Value, json};
use std::cell::{Cell, RefCell};

/// A recipe whose nodes all have shaders.
const RECIPE: &str = r##"
dapple = 1
[nodes.cells.worley]
frequency = 4.0
[nodes.raised.power]
input = "cells"
exponent = 0.35
[nodes.color.ramp]
input = "raised"
colors = ["#204060", "#f0e0d0"]
space = "linear"
[material]
height = "raised"
albedo = "color"
"##;

/// A page that may have a GPU.
struct Page {
    session: Session,
    renderer: Renderer,
    host: Host,
}

struct Host {
    gpu: Option<Gpu>,
    /// Number of plans on the GPU.
    n_plans: Cell<u32>,
    /// Errors of the GPU.
    errors: RefCell<Vec<String>>,
    pictures: RefCell<Vec<Picture>>,
}

impl RenderHost for Host {
    fn images(&self, _: &Recipe) -> Result<Images, StudioError> {
        Ok(Images::new())
    }

    fn on_gpu(&self, recipe: &Recipe, plan: &Plan) -> Option<Plan> {
        let gpu = self.gpu.as_ref()?;
        let shader = recipe.to_wgsl_with(plan, &ShaderOptions::default());
        shader.expect("all nodes have shaders");
        let on_gpu = GpuPlan::new(gpu, recipe, plan).expect("a plan on the GPU");
        self.n_plans.set(self.n_plans.get() + 1);
        Some(on_gpu.plan().clone())
    }

    fn gpu_failed(&self, error: &RendererError) {
        self.errors.borrow_mut().push(error.to_string());
    }

    fn now(&self) -> f64 {
        0.0
    }

    fn is_wanted(&self, _: u32) -> bool {
        true
    }

    fn put(&self, output: Output) {
        if let Output::Picture(picture) = output {
            self.pictures.borrow_mut().push(picture);
        }
    }
}

impl Page {
    fn open(gpu: Option<Gpu>) -> Self {
        let mut page = Self {
            session: Session::default(),
            renderer: Renderer::default(),
            host: Host {
                gpu,
                n_plans: Cell::new(0),
                errors: RefCell::default(),
                pictures: RefCell::default(),
            },
        };
        page.ask(json!({ "type": "open", "text": RECIPE }));
        page.ask(json!({
            "type": "view", "size": [512, 512], "maps": ["albedo", "normal", "orm"], "draft": true, "paused": false,
        }));
        page
    }

    fn ask(&mut self, message: Value) {
        let request: Request = serde_json::from_value(message).expect("a request");
        let replies = self.session.handle(&request, &|_| Ok(Images::new()));
        replies.expect("replies");
    }

    /// Sets an option of a node.
    fn set(&mut self, rev: usize, path: &[&str], value: f64) {
        let op = json!({ "op": "set", "path": path, "value": value });
        self.ask(json!({ "type": "patch", "rev": rev, "ops": [op] }));
    }

    /// Renders the maps, and returns the draft and the full images.
    fn draw(&mut self) -> Vec<Picture> {
        let job = self.session.job().expect("a job");
        self.renderer.draw(&job, &self.host);
        self.host.pictures.take()
    }
}

/// Opens a GPU. Without an adapter the tests pass, unless `DAPPLE_NO_SKIP=1` is set.
fn gpu() -> Option<Gpu> {
    let gpu = Gpu::headless();
    let may_skip = std::env::var_os("DAPPLE_NO_SKIP").is_none_or(|value| value != "1");
    assert!(gpu.is_ok() || may_skip, "{gpu:?}");
    gpu.ok().map(Gpu::upload_values)
}

#[test]
fn steps_of_a_slider_have_the_bytes_of_the_cpu_and_compile_nothing() {
    let Some(gpu) = gpu() else { return };
    let path = ["nodes", "raised", "power", "exponent"];
    let mut on_gpu = Page::open(Some(gpu.clone()));
    let mut on_cpu = Page::open(None);
    let mut compiled = Vec::new();
    for step in 0..6 {
        for page in [&mut on_gpu, &mut on_cpu] {
            page.set(step, &path, 0.31 + 0.07 * step as f64);
        }
        let [made, expected] = [&mut on_gpu, &mut on_cpu].map(Page::draw);
        assert!(expected.iter().any(|picture| picture.is_draft));
        assert!(made == expected, "step {step}");
        compiled.push(gpu.compiled_shaders());
    }
    assert_eq!(on_gpu.host.n_plans.get(), 6);
    assert!(on_gpu.host.errors.borrow().is_empty());
    // The self-test has a shader, too.
    assert!(compiled[0] > 1);
    assert_eq!(compiled, [compiled[0]; 6]);
}

#[test]
fn maps_are_rendered_on_the_cpu_while_shaders_compile_and_when_the_gpu_is_lost() {
    let Some(gpu) = gpu() else { return };
    let expected = Page::open(None).draw();
    let background = gpu.clone().compile_in_background();
    let mut page = Page::open(Some(background));
    assert!(page.draw() == expected);
    assert_eq!(page.host.errors.take(), ["the GPU compiles a shader"]);
    // Wait for the shaders.
    let mut page = Page::open(Some(gpu.clone()));
    assert!(page.draw() == expected);
    assert!(page.host.errors.take().is_empty());
    gpu.device().destroy();
    let mut page = Page::open(Some(gpu));
    assert!(page.draw() == expected);
    let errors = page.host.errors.take();
    assert!(
        matches!(&errors[..], [error] if error.starts_with("the GPU was lost")),
        "{errors:?}"
    );
}
