//! A figure of curves, as SVG: panels side by side, both axes logarithmic.

use std::fmt::{self, Write};

/// One panel: times over something that grows.
#[derive(Clone, Debug)]
pub struct Panel {
    /// What the panel shows.
    pub title: String,
    /// What grows, to the right.
    pub across: String,
    /// What grew, and milliseconds; all above 0.
    pub points: Vec<(f64, f64)>,
    /// How values to the right are written.
    pub label: fn(f64) -> String,
}

const WIDTH: f64 = 300.0;
const HEIGHT: f64 = 250.0;
/// Space around a panel's plot: left, top, right, bottom.
const MARGIN: [f64; 4] = [54.0, 44.0, 22.0, 46.0];

/// The figure of `panels`, with the same scale of milliseconds in each.
///
/// A dashed line in each panel goes through the last point and grows in proportion to what is to the right.
///
/// # Errors
/// None: a string takes whatever is written to it.
pub fn figure(panels: &[Panel], caption: &str) -> Result<String, fmt::Error> {
    let times = panels.iter().flat_map(|panel| panel.points.iter().map(|&(_, time)| time));
    let low = times.clone().fold(f64::INFINITY, f64::min).log10().floor();
    let high = times.fold(f64::NEG_INFINITY, f64::max).log10().ceil().max(low + 1.0);
    let (width, height) = (WIDTH * panels.len() as f64, HEIGHT + 24.0);
    let mut svg = String::new();
    writeln!(
        svg,
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {width} {height}\" role=\"img\" aria-label=\"{caption}\" \
         font-family=\"system-ui, sans-serif\" font-size=\"11\" fill=\"#404850\">\n<title>{caption}</title>\n\
         <rect width=\"{width}\" height=\"{height}\" rx=\"8\" fill=\"#ffffff\"/>"
    )?;
    for (number, panel) in panels.iter().enumerate() {
        writeln!(svg, "<g transform=\"translate({} 0)\">", WIDTH * number as f64)?;
        draw(&mut svg, panel, [low, high])?;
        svg.push_str("</g>\n");
    }
    writeln!(svg, "<text x=\"{}\" y=\"{}\" fill=\"#707880\">{caption}</text>\n</svg>", MARGIN[0] / 2.0, height - 10.0)?;
    Ok(svg)
}

fn draw(svg: &mut String, panel: &Panel, [low, high]: [f64; 2]) -> fmt::Result {
    let [left, top, right, bottom] = MARGIN;
    let (right, bottom) = (WIDTH - right, HEIGHT - bottom);
    let [(first, _), .., (last, last_time)] = panel.points.as_slice() else { return Ok(()) };
    let x = |value: f64| left + (value / first).ln() / (last / first).ln() * (right - left);
    let y = |time: f64| bottom - (time.log10() - low) / (high - low) * (bottom - top);
    writeln!(
        svg,
        "<text x=\"{left}\" y=\"22\" font-size=\"13\" font-weight=\"600\" fill=\"#1c2024\">{}</text>\n\
         <text x=\"{}\" y=\"{}\" text-anchor=\"middle\">{}</text>\n<text x=\"{left}\" y=\"{}\" text-anchor=\"end\">ms</text>",
        panel.title,
        (left + right) / 2.0,
        bottom + 34.0,
        panel.across,
        top - 6.0
    )?;
    for power in low as i32..=high as i32 {
        let time = 10_f64.powi(power);
        let at = y(time);
        writeln!(
            svg,
            "<path d=\"M{left} {at:.1}H{right}\" stroke=\"#e4e7ea\"/><text x=\"{}\" y=\"{:.1}\" text-anchor=\"end\">{time}</text>",
            left - 6.0,
            at + 4.0
        )?;
    }
    // Every other value is labelled where they would touch.
    let step = panel.points.len().div_ceil(6);
    for &(value, _) in panel.points.iter().rev().step_by(step) {
        let (at, label) = (x(value), (panel.label)(value));
        writeln!(svg, "<text x=\"{at:.1}\" y=\"{}\" text-anchor=\"middle\">{label}</text>", bottom + 16.0)?;
    }
    // In proportion: as many decades up as to the right, down to the floor of the plot.
    let start = first.max(last * 10_f64.powf(low) / last_time);
    writeln!(
        svg,
        "<path d=\"M{:.1} {:.1}L{:.1} {:.1}\" stroke=\"#a0a8b0\" stroke-dasharray=\"4 4\" fill=\"none\"/>",
        x(start),
        y(last_time * start / last),
        x(*last),
        y(*last_time)
    )?;
    let points: Vec<_> = panel.points.iter().map(|&(value, time)| format!("{:.1},{:.1}", x(value), y(time))).collect();
    writeln!(svg, "<polyline points=\"{}\" fill=\"none\" stroke=\"#2ea84c\" stroke-width=\"2\"/>", points.join(" "))?;
    for &(value, time) in &panel.points {
        writeln!(svg, "<circle cx=\"{:.1}\" cy=\"{:.1}\" r=\"3\" fill=\"#2ea84c\"/>", x(value), y(time))?;
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn points_lie_within_their_panel() {
        let points = vec![(1.0, 0.02), (4.0, 3.0), (16.0, 700.0)];
        let panel = Panel { title: "t".into(), across: "n".into(), points, label: |n| n.to_string() };
        let svg = figure(&[panel.clone(), panel], "two").unwrap();
        assert_eq!(svg.matches("<g transform").count(), 2);
        assert_eq!(svg.matches("<circle").count(), 6);
        for circle in svg.split("<circle cx=\"").skip(1) {
            let (cx, rest) = circle.split_once("\" cy=\"").unwrap();
            let cy: f64 = rest.split_once('"').unwrap().0.parse().unwrap();
            assert!(
                (MARGIN[0]..=WIDTH).contains(&cx.parse().unwrap()) && (MARGIN[1]..=HEIGHT).contains(&cy),
                "{circle}"
            );
        }
        // From 10^-2 to 10^3 there are six lines.
        assert_eq!(svg.matches("stroke=\"#e4e7ea\"").count(), 12);
    }
}
