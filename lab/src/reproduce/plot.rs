//! A plot as vectors: curves over two axes, the same for the page and for a file.
//!
//! In the page lengths across are shares of the width, so that words keep their size in a narrow window; the curves lie in a nested
//! picture that is stretched.

use maud::{Markup, html};

/// A curve.
#[derive(Debug, Clone)]
pub struct Curve {
    /// For the legend.
    pub name: String,
    /// Index of its colour.
    pub colour: usize,
    /// Dashed: a truth or a command, not a measurement.
    pub dashed: bool,
    /// Its points.
    pub points: Vec<(f64, f64)>,
}

/// A plot.
#[derive(Debug, Clone)]
pub struct Plot {
    /// What the abscissa is, with its unit.
    pub across: &'static str,
    /// What the ordinate is, with its unit.
    pub up: &'static str,
    /// Ends of the abscissa.
    pub x: (f64, f64),
    /// Ends of the ordinate; curves beyond are cut.
    pub y: (f64, f64),
    /// Equal factors in the place of equal steps, of the abscissa and of the ordinate.
    pub logarithmic: (bool, bool),
    /// The curves, the first undermost.
    pub curves: Vec<Curve>,
    /// Places of the abscissa with a word.
    pub marks: Vec<(f64, &'static str)>,
    /// Whether the points are shown.
    pub dots: bool,
}

/// px down.
const HEIGHT: f64 = 290.0;
const TOP: f64 = 26.0;
const BOTTOM: f64 = 244.0;
/// Shares across.
const LEFT: f64 = 0.105;
const RIGHT: f64 = 0.985;
/// Steps of the stretched picture.
const GRID: f64 = 1000.0;
/// Points that a curve keeps, at most twice.
const POINTS: usize = 450;

/// Colours of a file, in which no style sheet of the page is: those of the page on paper.
const COLOURS: [&str; 9] =
    ["#0072b2", "#d55e00", "#009e73", "#b8549a", "#c98500", "#3fa3dc", "#000000", "#8a7a00", "#777777"];

impl Plot {
    /// The picture in the page; `label` says what it shows to whoever does not see it.
    pub fn inline(&self, label: &str) -> Markup {
        html! {
            ul.keys { @for curve in &self.curves { li { span.stroke.{ "c" (curve.colour) }.dashed[curve.dashed] {} (curve.name) } } }
            svg.chart role="img" aria-label=(label) height=(HEIGHT) width="100%" { (self.body()) }
        }
    }

    /// The picture as a file of its own, with its legend and a style inside.
    pub fn file(&self, title: &str) -> String {
        let width = 760.0;
        let rows = self.curves.len().div_ceil(3);
        let above = 44.0 + 18.0 * rows as f64;
        let height = HEIGHT + above;
        let picture = html! {
            svg xmlns="http://www.w3.org/2000/svg" width=(width) height=(height) viewBox={ "0 0 " (width) " " (height) } {
                title { (title) }
                style { (maud::PreEscaped(style())) }
                rect width="100%" height="100%" fill="#ffffff" {}
                text x="14" y="24" class="title" { (title) }
                @for (at, curve) in self.curves.iter().enumerate() {
                    @let x = 20.0 + (at % 3) as f64 * 245.0;
                    @let y = 46.0 + (at / 3) as f64 * 18.0;
                    line class={ "curve c" (curve.colour) (if curve.dashed { " dashed" } else { "" }) } x1=(x) x2=(x + 24.0) y1=(y - 4.0) y2=(y - 4.0) {}
                    text x=(x + 30.0) y=(y) { (curve.name) }
                }
                svg y=(above) width=(width) height=(HEIGHT) { (self.body()) }
            }
        };
        format!("<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n{}\n", picture.into_string())
    }

    fn body(&self) -> Markup {
        html! {
            text.soft x="0.5%" y="14" { (self.up) }
            @for (value, words) in ticks(self.y, self.logarithmic.1) {
                @let y = px(self.down(value));
                line.grid x1=(across(LEFT)) x2=(across(RIGHT)) y1=(y) y2=(y) {}
                text x=(across(LEFT - 0.012)) y=(px(self.down(value) + 4.0)) text-anchor="end" { (words) }
            }
            @for (value, words) in ticks(self.x, self.logarithmic.0) {
                @let x = across(LEFT + (RIGHT - LEFT) * share(value, self.x, self.logarithmic.0));
                line.tick x1=(x) x2=(x) y1=(px(BOTTOM)) y2=(px(BOTTOM + 5.0)) {}
                text x=(x) y=(px(BOTTOM + 19.0)) text-anchor="middle" { (words) }
            }
            @for (value, word) in &self.marks {
                @let x = across(LEFT + (RIGHT - LEFT) * share(*value, self.x, self.logarithmic.0));
                line.mark x1=(x) x2=(x) y1=(px(TOP)) y2=(px(BOTTOM)) {}
                text.soft x=(x) y=(px(TOP - 5.0)) text-anchor="middle" { (word) }
            }
            line.base x1=(across(LEFT)) x2=(across(RIGHT)) y1=(px(BOTTOM)) y2=(px(BOTTOM)) {}
            text.soft x=(across(RIGHT)) y=(px(HEIGHT - 8.0)) text-anchor="end" { (self.across) }
            svg x=(across(LEFT)) width=(across(RIGHT - LEFT)) y=(px(TOP)) height=(px(BOTTOM - TOP)) viewBox={ "0 0 " (GRID) " " (GRID) } preserveAspectRatio="none" {
                @for curve in &self.curves {
                    path class={ "curve c" (curve.colour) (if curve.dashed { " dashed" } else { "" }) } d=(self.path(curve)) vector-effect="non-scaling-stroke" {}
                }
            }
            @if self.dots { @for curve in &self.curves { @for (x, y) in &curve.points { (self.dot(curve, *x, *y)) } } }
        }
    }

    fn dot(&self, curve: &Curve, x: f64, y: f64) -> Markup {
        let x = across(LEFT + (RIGHT - LEFT) * share(x, self.x, self.logarithmic.0));
        html! { circle class={ "dot c" (curve.colour) } cx=(x) cy=(px(self.down(y))) r="4" {} }
    }

    fn down(&self, value: f64) -> f64 {
        BOTTOM - (BOTTOM - TOP) * share(value, self.y, self.logarithmic.1)
    }

    fn path(&self, curve: &Curve) -> String {
        let mut path = String::new();
        let mut begun = false;
        for (x, y) in thinned(&curve.points, self.x) {
            if !y.is_finite() {
                begun = false;
                continue;
            }
            let (x, y) = (share(x, self.x, self.logarithmic.0), share(y, self.y, self.logarithmic.1));
            let word = if begun { 'L' } else { 'M' };
            // A curve that leaves the picture is cut at half a height beyond it.
            path += &format!("{word}{:.1} {:.1}", GRID * x, GRID * (1.0 - y.clamp(-0.5, 1.5)));
            begun = true;
        }
        path
    }
}

/// Within the picture, of every stretch of time the first point and the least and the greatest.
fn thinned(points: &[(f64, f64)], ends: (f64, f64)) -> Vec<(f64, f64)> {
    let inside: Vec<(f64, f64)> = points.iter().copied().filter(|(x, _)| *x >= ends.0 && *x <= ends.1).collect();
    if inside.len() <= 2 * POINTS {
        return inside;
    }
    let stretch = inside.len().div_ceil(POINTS);
    let mut kept = Vec::with_capacity(2 * POINTS + 2);
    for part in inside.chunks(stretch) {
        let by = |a: &&(f64, f64), b: &&(f64, f64)| a.1.total_cmp(&b.1);
        let (low, high) = (part.iter().min_by(by), part.iter().max_by(by));
        let mut both: Vec<(f64, f64)> = low.into_iter().chain(high).copied().collect();
        both.sort_by(|a, b| a.0.total_cmp(&b.0));
        both.dedup();
        kept.extend(both);
    }
    kept.extend(inside.last());
    kept
}

fn share(value: f64, ends: (f64, f64), logarithmic: bool) -> f64 {
    if logarithmic { (value / ends.0).ln() / (ends.1 / ends.0).ln() } else { (value - ends.0) / (ends.1 - ends.0) }
}

/// Round numbers between two ends, and how they are written.
fn ticks(ends: (f64, f64), logarithmic: bool) -> Vec<(f64, String)> {
    if logarithmic {
        let (first, last) = (ends.0.log10().ceil() as i32, ends.1.log10().floor() as i32);
        return (first..=last).map(|power| (10f64.powi(power), grouped(10f64.powi(power)))).collect();
    }
    let rough = (ends.1 - ends.0) / 5.0;
    let unit = 10f64.powf(rough.log10().floor());
    let step = [1.0, 2.0, 2.5, 5.0, 10.0].map(|m| m * unit).into_iter().find(|step| *step >= rough).unwrap_or(rough);
    let first = (ends.0 / step - 1e-9).ceil() as i64;
    let last = (ends.1 / step + 1e-9).floor() as i64;
    let quarter = i32::from((2.4..2.6).contains(&(step / unit)));
    let decimals = (quarter - (step.log10() + 1e-9).floor() as i32).max(0) as usize;
    (first..=last).map(|n| (n as f64 * step, format!("{:.*}", decimals, n as f64 * step).replace('-', "−"))).collect()
}

fn grouped(value: f64) -> String {
    if value >= 1e6 {
        format!("{}\u{a0}M", value / 1e6)
    } else if value >= 1e3 {
        format!("{}\u{a0}k", value / 1e3)
    } else {
        format!("{value}")
    }
}

fn across(share: f64) -> String {
    format!("{:.2}%", 100.0 * share)
}

fn px(value: f64) -> String {
    format!("{value:.1}")
}

/// The style of a file.
fn style() -> String {
    let mut style = String::from(
        "text{font:12px sans-serif;fill:#1d2327}.title{font-size:15px;font-weight:600}.soft{fill:#5b656c}\
         .curve{fill:none;stroke-width:1.6;stroke-linejoin:round}.dashed{stroke-dasharray:6 4}.grid{stroke:#e9ecec}.base,.tick{stroke:#5b656c}\
         .mark{stroke:#5b656c;stroke-dasharray:2 4}",
    );
    for (at, colour) in COLOURS.iter().enumerate() {
        style += &format!(".curve.c{at}{{stroke:{colour}}}.dot.c{at}{{fill:{colour}}}");
    }
    style
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ticks_are_round_and_within() {
        let words = |ends| ticks(ends, false).into_iter().map(|(_, words)| words).collect::<Vec<_>>();
        assert_eq!(words((0.0, 1000.0)), ["0", "200", "400", "600", "800", "1000"]);
        assert_eq!(words((0.0, 1100.0)), ["0", "250", "500", "750", "1000"]);
        assert_eq!(words((0.0, 1.2)), ["0.00", "0.25", "0.50", "0.75", "1.00"]);
        assert_eq!(words((-0.5, 0.5)), ["−0.4", "−0.2", "0.0", "0.2", "0.4"].map(str::to_owned));
        assert_eq!(words((15.0, 16.0)), ["15.0", "15.2", "15.4", "15.6", "15.8", "16.0"]);
        assert_eq!(
            ticks((50.0, 2e4), true).into_iter().map(|t| t.1).collect::<Vec<_>>(),
            ["100", "1\u{a0}k", "10\u{a0}k"]
        );
    }

    #[test]
    fn thinning_keeps_every_peak() {
        let points: Vec<(f64, f64)> = (0..100_000).map(|k| (k as f64, if k == 54_321 { 9.0 } else { 0.1 })).collect();
        let kept = thinned(&points, (0.0, 1e5));
        assert!(kept.len() < 1200 && kept.iter().any(|p| p.1 > 8.0), "{} points", kept.len());
        assert!(kept.windows(2).all(|pair| pair[0].0 <= pair[1].0), "in order");
    }
}
