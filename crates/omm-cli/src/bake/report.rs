//! The report: one HTML page about a bake that opens from disk, without a network.

use std::fmt::{self, Write};
use std::io::Cursor;
use std::path::Path;

use base64::Engine;
use base64::prelude::BASE64_STANDARD;
use image::{DynamicImage, ImageFormat, RgbaImage};
use omm_bake::picture::{self, Layer};
use omm_model::opacity::OpacityState;
use sha2::{Digest, Sha256};

use super::Item;
use super::baked::{Baked, by_texture};
use super::statistics::Statistics;

const STYLE: &str = include_str!("report/page.css");
const SCRIPT: &str = include_str!("report/page.js");

/// So many primitives get pictures, those with most microtriangles: a picture may have some megabytes.
const MOST_PICTURES: usize = 64;

/// Text whose characters mean nothing to HTML: names come from outside.
struct Escaped<T>(T);

impl<T: fmt::Display> fmt::Display for Escaped<T> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.0.to_string().chars().try_for_each(|c| match c {
            '&' => f.write_str("&amp;"),
            '<' => f.write_str("&lt;"),
            '>' => f.write_str("&gt;"),
            '"' => f.write_str("&quot;"),
            '\'' => f.write_str("&#39;"),
            c => f.write_char(c),
        })
    }
}

/// A picture as a URI. The alpha of pictures is 1 everywhere, so it is left out.
fn data_uri(picture: RgbaImage) -> Result<String, image::ImageError> {
    let mut png = Cursor::new(Vec::new());
    DynamicImage::from(picture).to_rgb8().write_to(&mut png, ImageFormat::Png)?;
    Ok(format!("data:image/png;base64,{}", BASE64_STANDARD.encode(png.into_inner())))
}

/// Why a report cannot be written.
#[derive(Debug, thiserror::Error)]
pub(crate) enum ReportError {
    /// A picture cannot be encoded.
    #[error(transparent)]
    Picture(#[from] image::ImageError),
    /// Strings take whatever is written to them.
    #[error(transparent)]
    Text(#[from] fmt::Error),
}

/// The page about `baked`, which came from the file `source`.
pub(super) fn page(source: &Path, baked: &[Baked<'_>]) -> Result<String, ReportError> {
    let mut page = String::new();
    let file = source.file_name().unwrap_or_default().to_string_lossy();
    // No script but this one runs, and nothing is fetched, whatever a name may contain.
    let hash = BASE64_STANDARD.encode(Sha256::digest(SCRIPT));
    write!(
        page,
        "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n\
         <meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; img-src data:; style-src 'unsafe-inline'; \
         script-src 'sha256-{hash}'\">\n<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n\
         <title>Opacity micromaps of {file}</title>\n<style>\n{STYLE}</style>\n</head>\n<body>\n<main>\n\
         <h1>Opacity micromaps of {file}</h1>\n",
        file = Escaped(&file),
    )?;
    summary(&mut page, baked)?;
    table(&mut page, baked)?;
    atlases(&mut page, baked)?;
    let pictured = most_microtriangles(baked);
    for (number, one) in baked.iter().enumerate() {
        primitive(&mut page, number, one, pictured.contains(&number))?;
    }
    write!(page, "</main>\n<script>{SCRIPT}</script>\n</body>\n</html>\n")?;
    Ok(page)
}

/// The numbers of those that get pictures.
fn most_microtriangles(baked: &[Baked<'_>]) -> Vec<usize> {
    let mut numbers: Vec<_> = (0..baked.len()).collect();
    let microtriangles = |&number: &usize| baked.get(number).map(|one| one.statistics.triangle_states().total());
    numbers.sort_by_key(|number| std::cmp::Reverse(microtriangles(number)));
    numbers.truncate(MOST_PICTURES);
    numbers
}

/// The class of a state in the style sheet.
const fn class(state: OpacityState) -> &'static str {
    match state {
        OpacityState::Transparent => "transparent",
        OpacityState::Opaque => "opaque",
        OpacityState::UnknownTransparent => "unknown-transparent",
        OpacityState::UnknownOpaque => "unknown-opaque",
    }
}

/// A state's name, for people.
fn name(state: OpacityState) -> String {
    class(state).replace('-', " ")
}

/// A number with a thin space between groups of three digits.
fn grouped(number: u64) -> String {
    let digits = number.to_string();
    let groups: Vec<_> = digits.as_bytes().rchunks(3).rev().map(String::from_utf8_lossy).collect();
    groups.join("\u{202f}")
}

fn percent(part: u64, whole: u64) -> f64 {
    if whole == 0 { 0.0 } else { 100.0 * part as f64 / whole as f64 }
}

fn summary(page: &mut String, baked: &[Baked<'_>]) -> fmt::Result {
    let sum = |of: fn(&Statistics) -> u64| baked.iter().map(|one| of(&one.statistics)).sum::<u64>();
    let microtriangles = sum(|s| s.triangle_states().total());
    let known = percent(sum(|s| s.triangle_states().known()), microtriangles);
    page.push_str("<dl class=\"tiles\">");
    for (label, value) in [
        ("Primitives", grouped(baked.len() as u64)),
        ("Triangles", grouped(sum(Statistics::triangles))),
        ("Microtriangles", grouped(microtriangles)),
        ("Need no shader", format!("{known:.2} %")),
        ("Special indices", grouped(sum(|s| s.special_indices().total()))),
        ("Bytes of data", grouped(sum(Statistics::array_bytes))),
    ] {
        write!(page, "<div><dt>{label}</dt><dd>{value}</dd></div>")?;
    }
    page.push_str("</dl>\n<ul class=\"legend\" aria-label=\"Colours of the states\">");
    for (state, meaning) in [
        (OpacityState::Opaque, "every hit is accepted"),
        (OpacityState::Transparent, "every hit is ignored"),
        (OpacityState::UnknownOpaque, "a shader decides; opaque if two states are forced"),
        (OpacityState::UnknownTransparent, "a shader decides; transparent if two states are forced"),
    ] {
        write!(page, "<li><i class=\"{}\"></i><b>{}</b>: {meaning}</li>", class(state), name(state))?;
    }
    page.push_str("</ul>\n");
    Ok(())
}

/// The states side by side, known ones first.
fn coverage(page: &mut String, statistics: &Statistics) -> fmt::Result {
    let counts = statistics.triangle_states();
    let order = [
        OpacityState::Opaque,
        OpacityState::Transparent,
        OpacityState::UnknownOpaque,
        OpacityState::UnknownTransparent,
    ];
    let part = |state| percent(counts.of(state), counts.total());
    let label: Vec<_> = order.map(|state| format!("{} {:.2} %", name(state), part(state))).into();
    write!(page, "<div class=\"bar\" role=\"img\" aria-label=\"{0}\" title=\"{0}\">", label.join(", "))?;
    for state in order.into_iter().filter(|&state| counts.of(state) > 0) {
        write!(page, "<span class=\"{}\" style=\"width:{:.3}%\"></span>", class(state), part(state))?;
    }
    page.push_str("</div>");
    Ok(())
}

fn table(page: &mut String, baked: &[Baked<'_>]) -> fmt::Result {
    page.push_str(
        "<h2>Primitives</h2>\n<div class=\"panel scroll\"><table>\n<thead><tr><th scope=\"col\">Name</th>\
         <th scope=\"col\">Triangles</th><th scope=\"col\">Special</th><th scope=\"col\">Microtriangles</th>\
         <th scope=\"col\">Bytes</th><th scope=\"col\">Known</th><th scope=\"col\">States</th></tr></thead>\n<tbody>\n",
    );
    for (number, one) in baked.iter().enumerate() {
        let statistics = &one.statistics;
        write!(
            page,
            "<tr><td><a href=\"#p{number}\">{}</a></td><td>{}</td><td>{}</td><td>{}</td><td>{}</td><td>{:.2} %</td>\
             <td class=\"wide\">",
            Escaped(statistics.name()),
            grouped(statistics.triangles()),
            grouped(statistics.special_indices().total()),
            grouped(statistics.triangle_states().total()),
            grouped(statistics.array_bytes()),
            100.0 * statistics.known_fraction(),
        )?;
        coverage(page, statistics)?;
        page.push_str("</td></tr>\n");
    }
    page.push_str("</tbody></table></div>\n");
    Ok(())
}

/// An overview of each texture that more than one primitive reads.
fn atlases(page: &mut String, baked: &[Baked<'_>]) -> Result<(), ReportError> {
    for (texture, users) in by_texture(baked) {
        let [first, _, ..] = users.as_slice() else { continue };
        let layers: Vec<_> = users.iter().map(|one| Layer { input: one.input, output: &one.output }).collect();
        let picture = picture::atlas(first.input.texture, first.options.sampler, &layers);
        writeln!(page, "<h2>Texture {texture}, read by {} primitives</h2>", users.len())?;
        viewer(page, picture, &format!("All primitives that read texture {texture}"))?;
    }
    Ok(())
}

/// A picture that can be enlarged.
fn viewer(page: &mut String, picture: RgbaImage, caption: &str) -> Result<(), ReportError> {
    let (width, height) = picture.dimensions();
    writeln!(
        page,
        "<figure class=\"panel viewer\"><div class=\"tools\" role=\"toolbar\" aria-label=\"Zoom\">\
         <button data-action=\"out\" aria-label=\"Zoom out\">−</button><output aria-live=\"polite\"></output>\
         <button data-action=\"in\" aria-label=\"Zoom in\">+</button><button data-action=\"one\">1 : 1</button>\
         <button data-action=\"fit\">Fit</button></div>\
         <div class=\"stage\" tabindex=\"0\" role=\"group\" aria-label=\"Picture; plus, minus and arrow keys zoom and move\">\
         <img width=\"{width}\" height=\"{height}\" alt=\"{caption}\" src=\"{}\" draggable=\"false\"></div>\
         <figcaption>{caption}. Scroll or use the buttons to zoom, drag to move.</figcaption></figure>",
        data_uri(picture)?,
        caption = Escaped(caption),
    )?;
    Ok(())
}

fn primitive(page: &mut String, number: usize, one: &Baked<'_>, pictures: bool) -> Result<(), ReportError> {
    let Baked { item: Item { label, input, options, .. }, output, statistics, .. } = one;
    write!(page, "<section id=\"p{number}\">\n<h2>{}</h2>\n<p class=\"facts\">", Escaped(statistics.name()))?;
    if let Some(label) = label {
        write!(page, "<span>mesh <b>{}</b></span>", Escaped(label))?;
    }
    let sampler = options.sampler;
    write!(
        page,
        "<span>texture <b>{} × {}</b></span><span>filter <b>{:?}</b></span><span>address modes <b>{:?}, {:?}</b></span>\
         <span>cutoff <b>{}</b></span><span>data <b>{:?}</b></span></p>\n<div class=\"charts\">\n",
        input.texture.width(),
        input.texture.height(),
        sampler.filter,
        sampler.address_mode_u,
        sampler.address_mode_v,
        options.alpha_cutoff,
        options.format,
    )?;
    states(page, statistics)?;
    levels(page, statistics)?;
    page.push_str("</div>\n");
    if pictures {
        viewer(
            page,
            picture::overlay(input, options.sampler, output),
            "Microtriangles over the texture, coloured by state",
        )?;
        if let Some(close_up) = picture::close_up(input, options.sampler, output) {
            writeln!(
                page,
                "<figure class=\"panel\"><img class=\"still\" alt=\"A part of the contour, enlarged\" src=\"{}\">\
                 <figcaption>A part of the contour, enlarged until the edges of microtriangles are apart.</figcaption></figure>",
                data_uri(close_up)?
            )?;
        }
    } else {
        page.push_str(
            "<p class=\"quiet\">Without pictures: others have more microtriangles. Use --picture for all.</p>\n",
        );
    }
    page.push_str("</section>\n");
    Ok(())
}

/// A row of a histogram: a label, a bar of `part` of `most`, and a number.
fn row(page: &mut String, label: &str, class: &str, part: u64, most: u64, text: &str) -> fmt::Result {
    write!(page, "<dt>{label}</dt><dd class=\"track\" aria-hidden=\"true\">")?;
    if part > 0 {
        write!(page, "<span class=\"{class}\" style=\"width:{:.3}%\"></span>", percent(part, most))?;
    }
    write!(page, "</dd><dd>{text}</dd>")
}

fn states(page: &mut String, statistics: &Statistics) -> fmt::Result {
    let counts = statistics.triangle_states();
    let most = OpacityState::ALL.map(|state| counts.of(state)).into_iter().max().unwrap_or(0);
    page.push_str("<div class=\"panel\"><h3>Microtriangles by state</h3><dl class=\"rows\">");
    for state in OpacityState::ALL {
        let count = counts.of(state);
        let text = format!("{} ({:.2} %)", grouped(count), percent(count, counts.total()));
        row(page, &name(state), class(state), count, most, &text)?;
    }
    page.push_str("</dl></div>\n");
    Ok(())
}

fn levels(page: &mut String, statistics: &Statistics) -> fmt::Result {
    let special = statistics.special_indices().total();
    let counts = statistics.levels();
    let most = counts.values().copied().chain([special]).max().unwrap_or(0);
    page.push_str("<div class=\"panel\"><h3>Triangles by level</h3><dl class=\"rows\">");
    row(page, "special index", "level", special, most, &grouped(special))?;
    for (level, count) in counts {
        row(page, &format!("level {level}"), "level", count, most, &grouped(count))?;
    }
    page.push_str("</dl></div>\n");
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_cannot_become_markup() {
        let hostile = "</title><script>alert('1')</script>&\"";
        assert_eq!(
            Escaped(hostile).to_string(),
            "&lt;/title&gt;&lt;script&gt;alert(&#39;1&#39;)&lt;/script&gt;&amp;&quot;"
        );
    }

    #[test]
    fn the_style_sheet_has_the_colours_of_the_pictures() {
        for state in OpacityState::ALL {
            let [r, g, b] = picture::colour(state);
            let rule = format!("--{}: #{r:02x}{g:02x}{b:02x};", class(state));
            assert!(STYLE.contains(&rule), "{rule}");
        }
    }

    #[test]
    fn numbers_are_grouped() {
        assert_eq!([0, 999, 1000, 1_234_567].map(grouped), ["0", "999", "1\u{202f}000", "1\u{202f}234\u{202f}567"]);
        assert_eq!(percent(0, 0), 0.0);
    }
}
