//! Generates the page that shows the figures: one HTML file that needs only the images next to it.
//!
//! It starts with an introduction to dapple and some of its best images, followed by thumbnails grouped by paper. A
//! thumbnail links to the full image; arrow keys go to adjacent images, and images that repeat can be shown tiled. Each
//! figure has its source and the command that renders it. Without scripts, thumbnails are plain links, and controls
//! that need scripts are hidden.

use crate::{Figure, Paper, papers};

/// A rendered figure, as listed on the page.
#[derive(Clone, Debug)]
pub struct Entry {
    /// The figure that was rendered.
    pub figure: &'static Figure,
    /// Images of the figure.
    pub images: Vec<Image>,
}

/// An image of a figure, as listed on the page.
#[derive(Clone, Debug)]
pub struct Image {
    /// Name of the image file next to the page.
    pub file: String,
    /// Label of the panel.
    pub label: String,
    /// Measurements of the image as text; empty without measurements.
    pub note: String,
    /// Whether copies of the image tile seamlessly along x and y.
    pub repeats: [bool; 2],
    /// Width and height in pixels.
    pub size: [u32; 2],
}

/// Images at the top of the page: the name of a figure and the label of its image. Images that were not rendered are
/// left out.
const FEATURED: [(&str, &str); 8] = [
    ("surface-fig-05", "octopus"),
    ("materials-fig-01", "cobblestones"),
    ("worley-fig-07", ""),
    ("materials-fig-01", "chipped-paint"),
    ("surface-fig-05", "bunny"),
    ("materials-fig-01", "stone-wall"),
    ("pups-fig-10", ""),
    ("materials-fig-01", "black-marble"),
];

/// Returns the page for the given figures. `root` is the path from the page's folder to the workspace root, and may
/// be empty.
#[must_use]
pub fn html(entries: &[Entry], root: &str) -> String {
    let (mut contents, mut sections) = (String::new(), String::new());
    for paper in papers() {
        let of_paper = |entry: &&Entry| entry.figure.name().starts_with(&format!("{}-", paper.key));
        let figures: Vec<_> = entries
            .iter()
            .filter(of_paper)
            .map(|entry| article(entry, root))
            .collect();
        if !figures.is_empty() {
            contents += &link(paper, figures.len());
            sections += &section(paper, &figures.concat());
        }
    }
    include_str!("page/template.html")
        .replace("{{root}}", &escape(root))
        .replace("{{featured}}", &featured(entries))
        .replace("{{contents}}", &contents)
        .replace("{{figures}}", &sections)
}

fn link(paper: &Paper, n_figures: usize) -> String {
    let (key, title) = (escape(paper.key), escape(paper.title));
    format!("<li><a href=\"#{key}\">{title}</a> <small>{n_figures}</small></li>\n")
}

/// Returns the images at the top, each a link to its figure.
fn featured(entries: &[Entry]) -> String {
    let image = |(name, label): (&str, &str)| {
        let entry = entries.iter().find(|entry| entry.figure.name() == name)?;
        let mut images = entry.images.iter();
        let image = images.find(|image| image.label.starts_with(label))?;
        let (file, alt) = (escape(&image.file), alt(entry.figure, image));
        let link = format!("<a href=\"#{name}\"><img src=\"{file}\" alt=\"{alt}\"></a>\n");
        Some(link)
    };
    FEATURED.into_iter().filter_map(image).collect()
}

/// Returns an image's description for readers who do not see it: its label, and the first sentence of the caption.
fn alt(figure: &Figure, image: &Image) -> String {
    let caption = figure.caption();
    let sentence = caption
        .split_once(". ")
        .map_or(&*caption, |(first, _)| first);
    let sentence = sentence.trim_end_matches('.').replace('`', "");
    match &*image.label {
        "" => escape(&sentence),
        label => escape(&format!("{label}: {sentence}")),
    }
}

fn section(paper: &Paper, figures: &str) -> String {
    let (key, title, reference) = (
        escape(paper.key),
        escape(paper.title),
        escape(paper.reference),
    );
    format!(
        "<section><h2 id=\"{key}\">{title}</h2><p class=\"ref\">{reference}</p>\n{figures}</section>\n"
    )
}

fn article(entry: &Entry, root: &str) -> String {
    let figure = entry.figure;
    let name = escape(&figure.name());
    let caption = with_code(&escape(&figure.caption()));
    let number = match figure.number {
        "extra" => "Extra".to_owned(),
        number => format!("Figure {}", escape(number)),
    };
    let width = match entry.images.len() {
        0 | 1 => "",
        2 | 3 => " class=\"wide\"",
        _ => " class=\"full\"",
    };
    let thumbnails = entry.images.iter();
    let images: String = thumbnails.map(|image| thumbnail(figure, image)).collect();
    let parameters: String = figure.parameters.iter().copied().map(parameter).collect();
    let code = code(figure, root);
    format!(
        "<article id=\"{name}\"{width}><div class=\"images\">{images}</div>\
         <div class=\"text\"><p><b>{number}.</b> {caption}</p><dl>{parameters}</dl>{code}\
         <p class=\"small\"><a href=\"#{name}\">{name}</a></p></div></article>\n"
    )
}

fn thumbnail(figure: &Figure, image: &Image) -> String {
    let (file, label) = (escape(&image.file), escape(&image.label));
    let [width, height] = image.size;
    let alt = alt(figure, image);
    let note = match image.note.trim_end() {
        "" => String::new(),
        note => format!("<pre class=\"note\">{}</pre>", escape(note)),
    };
    let (class, tiles) = match image.repeats {
        [false, false] => ("", ""),
        [true, false] => (" class=\"repeats-x\"", "2 × 1"),
        [false, true] => (" class=\"repeats-y\"", "1 × 2"),
        [true, true] => (" class=\"repeats\"", "2 × 2"),
    };
    let (style, tiled) = match tiles {
        "" => (String::new(), String::new()),
        tiles => (
            format!(" style=\"--tile: url('{file}')\""),
            format!("<label><input type=\"checkbox\">{tiles}</label>"),
        ),
    };
    format!(
        "<figure{class}><a class=\"zoom\" href=\"{file}\"><img src=\"{file}\" alt=\"{alt}\" width=\"{width}\" \
         height=\"{height}\" loading=\"lazy\"{style}></a>\
         <figcaption><span>{label}</span>{tiled}</figcaption>{note}</figure>"
    )
}

fn parameter((name, value): (&str, &str)) -> String {
    format!(
        "<div><dt>{}</dt><dd>{}</dd></div>",
        escape(name),
        escape(value)
    )
}

/// Returns the HTML of a figure's code section: the command that renders it, the commands that open similar recipes,
/// and its source.
fn code(figure: &Figure, root: &str) -> String {
    let recipes = figure.parameters.iter().filter(|(name, _)| *name == RECIPE);
    let studio = recipes.map(|(_, recipe)| command(&format!("dapple studio {recipe}")));
    let gallery = command(&format!("cargo xtask gallery {}", figure.name()));
    let commands = gallery + &studio.collect::<String>();
    let path = escape(&figure.source.path.replace('\\', "/"));
    let file = escape(root) + &path;
    let text = escape(figure.source.text);
    format!(
        "{commands}\
         <details><summary>Source</summary><a href=\"{file}\">{path}</a>\
         <div class=\"code\"><pre>{text}</pre>{COPY}</div></details>"
    )
}

fn command(line: &str) -> String {
    let line = escape(line);
    format!("<div class=\"code\"><pre class=\"command\">{line}</pre>{COPY}</div>")
}

/// Name of the parameter whose value is a built-in recipe.
const RECIPE: &str = "recipe";

/// HTML of a button that copies the text before it.
const COPY: &str = "<button class=\"scripted\" data-copy>Copy</button>";

/// Replaces each pair of backticks by an HTML code element.
fn with_code(text: &str) -> String {
    let mut parts = text.split('`');
    let first = parts.next().unwrap_or_default().to_owned();
    (0..).zip(parts).fold(first, |html, (number, part)| {
        html + ["<code>", "</code>"][number % 2] + part
    })
}

/// Escapes text for use in an HTML element or in a double-quoted attribute.
fn escape(text: &str) -> String {
    let mut escaped = String::with_capacity(text.len());
    for character in text.chars() {
        match character {
            '&' => escaped.push_str("&amp;"),
            '<' => escaped.push_str("&lt;"),
            '>' => escaped.push_str("&gt;"),
            '"' => escaped.push_str("&quot;"),
            other => escaped.push(other),
        }
    }
    escaped
}

#[cfg(test)]
mod tests {
    use super::{escape, with_code};

    #[test]
    fn code_in_captions_becomes_elements() {
        assert_eq!(
            with_code("run `a b`, then `c`"),
            "run <code>a b</code>, then <code>c</code>"
        );
        assert_eq!(with_code("no code"), "no code");
    }

    #[test]
    fn text_is_escaped() {
        assert_eq!(escape("a<b>&\"c\""), "a&lt;b&gt;&amp;&quot;c&quot;");
    }
}
