//! Tests of whole figures.

use super::*;
use resvg::tiny_skia::Pixmap;

/// A fit of any kind, made up: control points off the data, errors that grow.
struct Sample {
    dimension: usize,
    data: Vec<f64>,
    control: Vec<f64>,
    parameters: Vec<f64>,
    residuals: Vec<f64>,
    history: Vec<(usize, f64, f64)>,
    names: Vec<String>,
}

impl Sample {
    fn new(dimension: usize, data: Vec<f64>) -> Self {
        let count = data.len() / dimension.max(1);
        let last = count.saturating_sub(1).max(1) as f64;
        Self {
            dimension,
            control: data
                .iter()
                .enumerate()
                .map(|(i, v)| v * (1.0 + 0.02 * (i % 3) as f64))
                .collect(),
            data,
            parameters: (0..count).map(|i| i as f64 / last).collect(),
            residuals: (0..count).map(|i| 1.0e-9 * (1 + i % 1000) as f64).collect(),
            history: (0..20)
                .map(|i| (i, 0.5_f64.powi(i as i32), 0.3 * 0.5_f64.powi(i as i32)))
                .collect(),
            names: Vec::new(),
        }
    }

    fn circle(dimension: usize, count: usize) -> Self {
        let value = |i: usize, k: usize| (i as f64 * 6.3 / count as f64 + k as f64).sin();
        Self::new(
            dimension,
            (0..count).flat_map(|i| (0..dimension).map(move |k| value(i, k))).collect(),
        )
    }

    fn figure(&self) -> CurveFigure<'_> {
        CurveFigure {
            title: "<circle> & \"co\" \u{7}",
            caption: "made up, 10⁻³",
            dimension: self.dimension,
            coordinate_names: &self.names,
            parameter_name: "time",
            closed: true,
            data_points: &self.data,
            parameters: &self.parameters,
            control_points: &self.control,
            abscissae_of_control_points: &self.parameters,
            curve_samples: CurveSamples {
                parameters: &self.parameters,
                points: &self.data,
                beziers: None,
            },
            residuals: &self.residuals,
            extent: 2.0,
            history: &self.history,
            normal_history: &[],
            sequence: &[],
        }
    }

    fn svg(&self) -> String {
        checked(&self.figure())
    }
}

/// The figure, once it is seen to be well-formed and not too large.
fn checked(figure: &CurveFigure<'_>) -> String {
    let svg = curve_figure_svg(figure);
    let parsed = roxmltree::Document::parse(&svg).unwrap();
    assert_eq!(parsed.root_element().tag_name().name(), "svg");
    assert!(svg.len() < 1_000_000, "{} bytes", svg.len());
    assert!(!svg.contains("NaN") && !svg.contains("inf"));
    svg
}

#[test]
fn each_dimension_has_a_figure() {
    for dimension in [0, 1, 2, 3, 4, 6, 12, 13, 100] {
        let svg = Sample::circle(dimension, 50).svg();
        assert!(svg.contains("Error at each point") && svg.contains("Convergence"));
        assert_eq!(svg.contains("coordinates drawn"), dimension > 12);
    }
}

#[test]
fn the_same_input_gives_the_same_bytes() {
    for dimension in 1..5 {
        let sample = Sample::circle(dimension, 300);
        assert_eq!(sample.svg(), sample.svg());
    }
}

#[test]
fn names_and_title_are_shown_escaped() {
    let mut sample = Sample::circle(2, 30);
    sample.names = vec!["<a>".to_owned(), "b&b".to_owned()];
    let svg = sample.svg();
    for text in ["&lt;a&gt;", "b&amp;b", "&lt;circle&gt; &amp; &quot;co&quot; \u{fffd}"] {
        assert!(svg.contains(text), "{text}");
    }
}

#[test]
fn the_picture_holds_text_and_lines() {
    let svg = Sample::circle(2, 100).svg();
    let picture = Pixmap::decode_png(&svg_to_png(&svg, 1.0).unwrap()).unwrap();
    let colour_at = |x: u32, y: u32| picture.pixel(x, y).unwrap();
    // The title is the only dark thing in the first rows.
    let title = (0..60)
        .flat_map(|y| (0..300).map(move |x| (x, y)))
        .filter(|&(x, y)| colour_at(x, y).red() < 90)
        .count();
    assert!(title > 200, "{title}");
    let blue = picture.pixels().iter().filter(|p| p.blue() > 150 && p.red() < 40).count();
    assert!(blue > 500, "{blue}");
    assert!(picture.pixels().iter().all(|p| p.alpha() == 255));
}

#[test]
fn exact_pieces_are_drawn_as_curves() {
    let beziers = [0.0, 0.0, 1.0, 2.0, 2.0, 2.0, 3.0, 0.0];
    let sample = Sample::circle(2, 20);
    let mut figure = sample.figure();
    figure.curve_samples = CurveSamples { parameters: &[], points: &[], beziers: Some(&beziers) };
    assert!(checked(&figure).matches('C').count() > 1);
}

#[test]
fn many_points_stay_small_and_are_accounted_for() {
    for dimension in [1, 2, 3, 6] {
        let svg = Sample::circle(dimension, 100_000).svg();
        assert!(svg.contains(" data point drawn"), "{dimension}");
    }
    let noise: Vec<f64> = (0..1_000_000_u64).map(|i| (i * 7919 % 100_003) as f64).collect();
    assert!(Sample::new(2, noise).svg().contains("Every 125th data point drawn"));
}

#[test]
fn many_kept_curves_are_thinned() {
    let sample = Sample::circle(2, 20_000);
    let mut figure = sample.figure();
    let kept: Vec<_> = (0..100)
        .map(|iteration| SequenceCurve { iteration, curve: figure.curve_samples })
        .collect();
    figure.sequence = &kept;
    let svg = checked(&figure);
    assert!(svg.contains("8 of 100 kept iterations drawn"));
    assert!(svg.contains("iteration 99") && svg.contains("iteration 0"));
}

#[test]
fn extreme_coordinates_are_drawn() {
    let shape = |centre: f64, size: f64, dimension: usize| {
        let mut sample = Sample::circle(dimension, 40);
        sample.data.iter_mut().for_each(|v| *v = centre + size * *v);
        sample.control = sample.data.clone();
        sample
    };
    for dimension in [1, 2, 3, 5] {
        for (centre, size) in [
            (0.0, 1.0e300),
            (0.0, f64::MAX),
            (0.0, 1.0e-300),
            (0.0, 5.0e-324),
            (1.0e9, 1.0e-3),
            (1.0e9, 1.0e-8),
            (-1.0e300, 0.0),
            (1.0e-300, 0.0),
            (7.0, 0.0),
            (f64::INFINITY, 1.0),
            (f64::NAN, 1.0),
        ] {
            let svg = shape(centre, size, dimension).svg();
            assert!(svg_to_png(&svg, 0.2).is_ok(), "{centre} {size} {dimension}");
        }
    }
    assert!(shape(1.0e9, 1.0e-3, 2).svg().contains("+ 1\u{a0}000\u{a0}000\u{a0}000"));
}

#[test]
fn few_and_mismatched_inputs_are_drawn() {
    for dimension in [1, 2, 3, 7] {
        for count in [0, 1, 2] {
            Sample::circle(dimension, count).svg();
        }
        let sample = Sample::circle(dimension, 30);
        let mut figure = sample.figure();
        figure.data_points = &sample.data[1..];
        figure.control_points = &sample.data[..1];
        figure.parameters = &sample.parameters[..3];
        figure.abscissae_of_control_points = &[];
        figure.residuals = &sample.residuals[..2];
        figure.curve_samples.beziers = Some(&[1.0, f64::NAN, 3.0]);
        figure.extent = f64::NAN;
        checked(&figure);
        figure.curve_samples.points = &[];
        figure.history = &[];
        checked(&figure);
    }
}

#[test]
fn one_entry_and_zero_residuals_look_sane() {
    let mut sample = Sample::circle(2, 30);
    sample.residuals.fill(0.0);
    sample.history = vec![(0, 0.0, 0.0)];
    let svg = sample.svg();
    assert!(svg.contains("all errors are 0") && svg.contains("all residuals are 0"));
    sample.history = vec![(3, 1.0e-4, 2.0e-5)];
    sample.residuals[4] = 1.0e-12;
    sample.residuals[5] = 1.0;
    let svg = sample.svg();
    assert!(svg.contains("28 of 30 errors below"));
    sample.residuals = vec![f64::NAN, f64::INFINITY, -1.0, 5.0e-324, 1.0e308];
    sample.history = vec![(usize::MAX, f64::NAN, f64::INFINITY), (0, -1.0, 1.0e-320)];
    sample.svg();
}

#[test]
fn a_wild_control_polygon_does_not_shrink_the_curve() {
    let mut sample = Sample::circle(2, 30);
    sample.control[10] = 1.0e12;
    assert!(sample.svg().contains("reach beyond the picture"));
}

#[test]
fn endless_text_is_cut() {
    let long = "word ".repeat(200_000);
    let sample = Sample::circle(2, 30);
    let mut figure = sample.figure();
    let names = [long.clone(), "x".repeat(100_000)];
    figure.title = &long;
    figure.caption = &long;
    figure.coordinate_names = &names;
    assert!(checked(&figure).len() < 60_000);
}

#[test]
fn a_figure_of_huge_values_differs_in_its_labels_alone() {
    for dimension in 1..=4 {
        let plain = Sample::circle(dimension, 30);
        let mut huge = Sample::circle(dimension, 30);
        for x in huge.data.iter_mut().chain(&mut huge.control).chain(&mut huge.parameters) {
            *x *= 1.0e307;
        }
        let marks = |sample: &Sample| -> Vec<String> {
            let svg = checked(&sample.figure());
            let parsed = roxmltree::Document::parse(&svg).unwrap();
            parsed.descendants().filter_map(|n| n.attribute("d")).map(str::to_owned).collect()
        };
        assert_eq!(marks(&plain), marks(&huge), "dimension {dimension}");
        assert!(huge.svg().contains("307"), "dimension {dimension}");
    }
}

#[test]
fn a_graph_over_the_parameter_has_its_name() {
    assert!(Sample::circle(1, 30).svg().contains(">time<"));
}
